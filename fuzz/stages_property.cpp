#include <algorithm>
#include <bit>
#include <cmath>

#include "corpus/generators/random.h"
#include "fuzz/feature_size.h"
#include "fuzz/properties.h"
#include "fuzz/stages.h"
#include "mesher/base/check.h"
#include "mesher/chamfer/chamfer.h"
#include "mesher/chamfer/filter.h"
#include "mesher/chamfer/test_plc_angles.h"
#include "mesher/enrich/enrichment.h"
#include "mesher/geometry/box_tree.h"
#include "mesher/improve/improve.h"
#include "mesher/improve/quality.h"
#include "mesher/tetmesh/numbering.h"
#include "property_tests/leniency.h"

namespace tetproof::fuzz {
namespace {

using delmesher::Surface;
using delmesher::predicates::Vec3;

Leniency too_precise("stopped-features-below-2^-40", 0.05);
Leniency no_room("acute-features-below-2^-40", 0.05);
Leniency turned("acute-by-what-half-an-ulp-turns", 0.03);

// A property of one stage: failed checks inside the mesher are findings, and so is a stop for want
// of precision if there is room.
template <class Body>
Finding guarded(const char* stage, const Surface& surface, Body&& body) {
  try {
    return body();
  } catch (const delmesher::base::Stopped& stopped) {
    if (stopped.status.limit != delmesher::Limit::precision || roomy(surface)) {
      return std::string(stage) + " stop: " + stopped.status.message;
    }
    too_precise.take();
    return {};
  } catch (const delmesher::base::InternalError& error) {
    return std::string(stage) + " check: " + error.what();
  }
}

// Points on triangles are rounded to dyadic parameters; the angles are measured in doubles.
constexpr double kDegreesLost = 0.02;
// The filter compares distances in doubles: 4 ulp of the diagonal.
constexpr double kDistanceRoundings = 0x1p-50;

double length(const delmesher::predicates::PointStore& points,
              const std::array<delmesher::base::VertexId, 2>& ends) {
  const Vec3 p = points.nearest(ends[0]), q = points.nearest(ends[1]);
  return std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
}

// An edge is chamfered by no more than a third of itself from either end.
Finding distances_fit(const Stages& s, const delmesher::chamfer::ChamferResult& result) {
  for (std::uint32_t e = 0; e < s.topology.edge_count(); ++e) {
    if (s.topology.edge_is_flat[e] != 0) continue;
    const auto ends = s.topology.edge_vertices(e);
    const double most = length(s.points, ends) * (1.0 / 3 + 0x1p-50);
    if (result.vertex_distance[ends[0]] > most || result.vertex_distance[ends[1]] > most) {
      return "chamfer distance: more than a third of an edge";
    }
  }
  return {};
}

Finding chamfered(const Surface& surface, double cosine_squared, double degrees) {
  Stages s(surface);
  delmesher::chamfer::ChamferOptions options;
  options.cosine_squared = cosine_squared;
  const auto result = chamfer(s.topology, s.points, s.predicates, options, s.control);
  if (Finding f = distances_fit(s, result); !f.empty()) return f;
  const auto report = delmesher::chamfer::plc_angles::measure(result.plc, s.points);
  if (!report.defect.empty()) return "chamfer complex: " + report.defect;
  if (!(report.smallest() < degrees - kDegreesLost)) return {};
  // Chamfers are laid out in doubles. If a segment is not long beside an ulp of the model (in
  // facets and at angles so narrow that the filter drops them by default), roundings of its ends
  // turn the angles at it. Other segments have no excuse.
  if (!(report.smallest_if_turned < degrees - kDegreesLost)) {
    turned.take();
  } else if (!roomy(surface)) {
    no_room.take();
  } else {
    return "chamfer angle: " + std::to_string(report.smallest()) + " degrees are left of " +
           std::to_string(degrees);
  }
  return {};
}

// Kept triangles of facets that share no vertex are not closer than the tolerance.
Finding kept_is_apart(const FeatureSizes& sizes,
                      const delmesher::surface::SurfaceTopology& topology,
                      const std::vector<std::uint8_t>& kept, double tolerance) {
  const auto is_kept = [&](std::uint32_t t) { return kept[topology.facet_of[t]] != 0; };
  for (std::uint32_t i = 0; i < topology.triangles.size(); ++i) {
    for (std::uint32_t j = 0; is_kept(i) && j < i; ++j) {
      if (!is_kept(j) || !sizes.closer(i, j, tolerance)) continue;
      if (!sizes.facets_touch(i, j)) return "filter distance: kept facets closer than allowed";
    }
  }
  return {};
}

// Adds explicit points in the bounding box, for cavities of recovery to hold; none where doubles
// are so coarse that they might lie on facets.
void add_volume_points(const Surface& surface, Random& random, Stages& s,
                       delmesher::cdt::CdtInput& input) {
  delmesher::geometry::Box box;
  for (const auto& p : surface.vertices) box.extend({p, p});
  for (std::size_t i = 0; i < 3; ++i) {
    const double largest = std::max(std::fabs(box.lo[i]), std::fabs(box.hi[i]));
    if (!(largest < 0x1p1000) || !(box.hi[i] - box.lo[i] > 0x1p-20 * largest)) return;
  }
  for (int count = random.integer(0, 40); count > 0; --count) {
    input.vertices.push_back(s.points.add_explicit(random.between(box.lo[0], box.hi[0]),
                                                   random.between(box.lo[1], box.hi[1]),
                                                   random.between(box.lo[2], box.hi[2])));
  }
}

// The surface and random points in the volume.
delmesher::cdt::CdtInput with_volume_points(const Surface& surface, Stages& s) {
  delmesher::cdt::CdtInput input = delmesher::enrich::plain_input(s.topology);
  Random random(surface.vertices.size() ^ std::bit_cast<std::uint64_t>(surface.vertices.back()[0]));
  add_volume_points(surface, random, s, input);
  return input;
}

std::vector<std::uint8_t> used_points(const delmesher::tetmesh::ConformingMesh& mesh,
                                      const Stages& s) {
  std::vector<std::uint8_t> used(s.points.size(), 0);
  for (const auto& t : mesh.tetrahedra) {
    for (const auto v : t) used[v] = 1;
  }
  return used;
}

// The tetrahedra with their vertices in the order in which the improvement takes and delivers them:
// what doubles tell of one that is flat except for roundings depends on it.
delmesher::tetmesh::ConformingMesh as_measured(const delmesher::tetmesh::ConformingMesh& given,
                                               const Stages& s) {
  const auto [point, topology] = numbered(given, s.points);
  return mesh_of(topology, point);
}

// The worst quality of the tetrahedra inside, as they will be written.
delmesher::improve::Quality worst_inside(const delmesher::tetmesh::ConformingMesh& mesh,
                                         const Stages& s) {
  delmesher::improve::Quality worst = delmesher::improve::kNotCounted;
  for (std::size_t n = 0; n < mesh.tetrahedra.size(); ++n) {
    if (mesh.region[n] == delmesher::tetmesh::kOutside) continue;
    const auto& t = mesh.tetrahedra[n];
    const auto at = [&](int i) { return s.points.nearest(t[i]); };
    worst = worse(worst, delmesher::improve::quality(at(0), at(1), at(2), at(3)));
  }
  return worst;
}

// The faces fit, the tetrahedra are positive on exact coordinates, and no vertex of the surface is
// lost.
Finding is_sound(const delmesher::tetmesh::ConformingMesh& mesh, Stages& s) {
  for (const auto& t : mesh.tetrahedra) {
    if (s.predicates.orient3d(t[0], t[1], t[2], t[3]) <= 0)
      return "improve orientation: not positive";
  }
  const std::vector<std::uint8_t> used = used_points(mesh, s);
  for (std::size_t v = 0; v < s.topology.vertex_half_edge.size(); ++v) {
    if (used[v] == 0) return "improve vertices: one of the surface is in no tetrahedron";
  }
  delmesher::tetmesh::MeshTopology(mesh.tetrahedra, mesh.region, mesh.boundary, s.points.size())
      .validate();
  return {};
}

float squared_sine(double degrees) {
  return static_cast<float>(1 - delmesher::predicates::cosine_squared(degrees));
}

}  // namespace

Finding improvement_holds(const Surface& surface) {
  judging({&too_precise});
  return guarded("improve", surface, [&]() -> Finding {
    Stages s(surface);
    const delmesher::cdt::CdtInput input = with_volume_points(surface, s);
    const delmesher::cdt::CdtResult cdt =
        constrained_delaunay_tetrahedrization(input, s.points, s.predicates, s.control);
    const auto before = worst_inside(as_measured(cdt.mesh, s), s);
    const delmesher::improve::ImproveOptions options;
    const auto result =
        improve(cdt.mesh, &s.topology, {}, options, s.points, s.predicates, s.control);
    if (Finding f = is_sound(result.mesh, s); !f.empty()) return f;
    const auto after = worst_inside(result.mesh, s);
    const float flattest = squared_sine(delmesher::improve::kFlattestDihedral);
    if (after.dihedral < std::min(before.dihedral, flattest)) {
      return "improve dihedral: flatter than before";
    }
    if (after.face < std::min(before.face, squared_sine(options.delta))) {
      return "improve face angle: smaller than before";
    }
    return {};
  });
}

Finding recovery_holds(const Surface& surface) {
  judging({&too_precise});
  return guarded("recovery", surface, [&]() -> Finding {
    Stages s(surface);
    delmesher::cdt::CdtInput input = with_volume_points(surface, s);
    input.validate = true;
    const delmesher::cdt::CdtResult result =
        constrained_delaunay_tetrahedrization(input, s.points, s.predicates, s.control);
    if (result.counters.facet_restarts > 0) return "recovery theory: a facet failed at first";
    std::vector<std::uint8_t> used(s.points.size(), 0);
    for (const auto& t : result.mesh.tetrahedra) {
      for (const auto v : t) used[v] = 1;
    }
    const bool all = std::all_of(input.vertices.begin(), input.vertices.end(),
                                 [&](delmesher::base::VertexId v) { return used[v] != 0; });
    return all ? Finding() : "recovery vertices: one is in no tetrahedron";
  });
}

Finding chamfer_holds(const Surface& surface) {
  judging({&too_precise, &no_room, &turned});
  return guarded("chamfer", surface, [&]() -> Finding {
    if (Finding f = chamfered(surface, 0.25, 60); !f.empty()) return f;
    return chamfered(surface, 0, 90);
  });
}

Finding filter_holds(const Surface& surface) {
  judging({&too_precise});
  return guarded("filter", surface, [&]() -> Finding {
    Stages s(surface);
    FeatureSizes sizes;
    if (!sizes.assign(surface).empty()) return "filter input: the oracles cannot read it";
    const double diagonal = sizes.surface().diagonal(), apart = sizes.smallest();
    for (const double tau : {1e-4, 0.02}) {
      const auto result =
          delmesher::chamfer::filter_input(s.topology, s.points, tau * diagonal, s.control);
      if (result.facet_kept.size() != s.topology.facet_triangles.size()) {
        return "filter result: wrong size";
      }
      const bool all = std::all_of(result.facet_kept.begin(), result.facet_kept.end(),
                                   [](std::uint8_t kept) { return kept != 0; });
      if (!all && apart > (tau + kDistanceRoundings) * diagonal) {
        return "filter reason: drops facets although no features are closer than the tolerance";
      }
      Finding f = kept_is_apart(sizes, s.topology, result.facet_kept,
                                (tau - kDistanceRoundings) * diagonal);
      if (!f.empty()) return f;
    }
    return {};
  });
}

}  // namespace tetproof::fuzz
