#include <algorithm>
#include <cmath>
#include <limits>

#include "fuzz/properties.h"
#include "fuzz/stages.h"
#include "mesher/base/check.h"
#include "mesher/chamfer/chamfer.h"
#include "mesher/chamfer/filter.h"
#include "mesher/chamfer/plc_angles.h"
#include "mesher/surface/feature_size.h"

namespace tetproof::fuzz {
namespace {

using delmesher::Surface;
using delmesher::Vec3;

// A property of one stage: failed checks inside the mesher are findings, and so is a stop for want
// of precision where there is room.
template <class Body>
Finding guarded(const char* stage, const Surface& surface, Body&& body) {
  try {
    return body();
  } catch (const delmesher::Stopped& stopped) {
    return roomy(surface) ? std::string(stage) + " stop: " + stopped.status.message : "";
  } catch (const delmesher::InternalError& error) {
    return std::string(stage) + " check: " + error.what();
  }
}

// Points on triangles are rounded to dyadic parameters; the angles are measured in doubles.
constexpr double kDegreesLost = 0.02;

double length(const delmesher::PointStore& points, const std::array<delmesher::VertexId, 2>& ends) {
  const Vec3 p = points.nearest(ends[0]), q = points.nearest(ends[1]);
  return std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
}

// An edge is chamfered by no more than a third of itself from either end.
Finding distances_fit(const Stages& s, const delmesher::ChamferResult& result) {
  for (std::uint32_t e = 0; e < s.topology.edge_count(); ++e) {
    if (s.topology.edge_is_flat[e] != 0) continue;
    const auto ends = s.topology.edge_vertices(e);
    const double most = length(s.points, ends) * (1.0 / 3 + 1e-6);
    if (result.vertex_distance[ends[0]] > most || result.vertex_distance[ends[1]] > most) {
      return "chamfer distance: more than a third of an edge";
    }
  }
  return {};
}

Finding chamfered(const Surface& surface, double cosine_squared, double degrees) {
  Stages s(surface);
  delmesher::ChamferOptions options;
  options.cosine_squared = cosine_squared;
  const auto result = chamfer(s.topology, s.points, s.predicates, options, s.control);
  if (Finding f = distances_fit(s, result); !f.empty()) return f;
  const auto report = delmesher::plc_angles::measure(result.plc, s.points);
  if (!report.defect.empty()) return "chamfer complex: " + report.defect;
  // Chamfers are laid out in doubles: where that makes them shorter than an ulp of the model (in
  // facets and at angles that narrow, which the filter drops by default) they are at any angle.
  constexpr double kShortest = 0x1p-50;
  if (report.smallest() < degrees - kDegreesLost && report.smallest_segment > kShortest &&
      roomy(surface)) {
    return "chamfer angle: " + std::to_string(report.smallest()) + " degrees are left of " +
           std::to_string(degrees);
  }
  return {};
}

// Kept triangles of facets that share no vertex are not closer than the tolerance.
Finding kept_is_apart(const Stages& s, const std::vector<std::uint8_t>& kept, double tolerance) {
  const auto& t = s.topology;
  const auto corners = [&](std::uint32_t i) {
    const auto& c = t.triangles[i];
    return std::array<Vec3, 3>{s.points.nearest(c[0]), s.points.nearest(c[1]),
                               s.points.nearest(c[2])};
  };
  std::vector<std::vector<std::uint32_t>> vertices(t.facet_triangles.size());
  for (std::uint32_t i = 0; i < t.triangles.size(); ++i) {
    for (const auto v : t.triangles[i]) vertices[t.facet_of[i]].push_back(v);
  }
  for (auto& list : vertices) std::sort(list.begin(), list.end());
  for (std::uint32_t i = 0; i < t.triangles.size(); ++i) {
    for (std::uint32_t j = 0; j < i; ++j) {
      const auto f = t.facet_of[i], g = t.facet_of[j];
      if (kept[f] == 0 || kept[g] == 0 || f == g) continue;
      std::vector<std::uint32_t> common;
      std::set_intersection(vertices[f].begin(), vertices[f].end(), vertices[g].begin(),
                            vertices[g].end(), std::back_inserter(common));
      if (!common.empty()) continue;
      const double d = delmesher::triangle_triangle_distance(corners(i), corners(j));
      if (d < tolerance * (1 - 1e-9)) return "filter distance: kept facets closer than allowed";
    }
  }
  return {};
}

}  // namespace

Finding chamfer_holds(const Surface& surface) {
  return guarded("chamfer", surface, [&]() -> Finding {
    if (Finding f = chamfered(surface, 0.25, 60); !f.empty()) return f;
    return chamfered(surface, 0, 90);
  });
}

Finding filter_holds(const Surface& surface) {
  return guarded("filter", surface, [&]() -> Finding {
    Stages s(surface);
    Vec3 low = surface.vertices[surface.triangles[0][0]], high = low;
    for (const auto& t : surface.triangles) {
      for (const auto v : t) {
        for (std::size_t i = 0; i < 3; ++i) {
          low[i] = std::min(low[i], surface.vertices[v][i]);
          high[i] = std::max(high[i], surface.vertices[v][i]);
        }
      }
    }
    const double diagonal = std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
    const double apart = smallest_local_feature_size(s.topology, s.points, s.control);
    for (const double tau : {1e-4, 0.02}) {
      const auto result = filter_input(s.topology, s.points, tau * diagonal, s.control);
      if (result.facet_kept.size() != s.topology.facet_triangles.size()) {
        return "filter result: wrong size";
      }
      const bool all = std::all_of(result.facet_kept.begin(), result.facet_kept.end(),
                                   [](std::uint8_t kept) { return kept != 0; });
      if (!all && apart > tau * diagonal * (1 + 1e-9)) {
        return "filter reason: drops facets although no features are closer than the tolerance";
      }
      if (Finding f = kept_is_apart(s, result.facet_kept, tau * diagonal); !f.empty()) return f;
    }
    return {};
  });
}

}  // namespace tetproof::fuzz
