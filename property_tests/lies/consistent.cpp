// Lies that change mesh and record together, so that both agree.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "property_tests/lies/told.h"

namespace tetproof::lies {
namespace {

using namespace oracles;  // NOLINT
using delmesher::ExactPoint;
using delmesher::ExactRecord;
using delmesher::Options;

// A run with other options, told to be the honest one.
template <class Change>
void claim_for(Told& told, Change change) {
  Options options = honest_options();
  change(options);
  const ExactRecord::Parameters promised = told.record.parameters;
  Told other = run_of(options);
  told.sample = other.sample;
  told.record = other.record;
  told.record.parameters = promised;
}

// The plain constrained Delaunay tetrahedrization as the final mesh, in file and record.
void put_plain_final(Told& told) {
  Options options = honest_options();
  const Told plain = run_of(options, Task::cdt);
  ASSERT_EQ(plain.record.points.size(), told.sample.input.vertices.size());
  told.record.final = plain.record.final;
  told.record.final_facets = plain.record.final_facets;
  told.record.mesh_vertices = plain.record.mesh_vertices;
  told.sample.mesh = plain.sample.mesh;
}

// Tetrahedron t of the final mesh is split at a new point near its centroid, in file and record.
void split_in_both(Told& told, std::size_t t) {
  ExactPoints points;
  points.assign(told.record.points);
  const Tet tet = told.sample.mesh.tetrahedra[t];
  Position centre{};
  for (const Index v : tet) {
    for (int axis = 0; axis < 3; ++axis) centre[axis] += told.sample.mesh.vertices[v][axis] / 4;
  }
  const auto in_file = static_cast<Index>(told.sample.mesh.vertices.size());
  const auto in_record = static_cast<Index>(told.record.points.size());
  told.sample.mesh.vertices.push_back(centre);
  told.record.mesh_vertices.push_back(in_record);
  told.record.points.push_back(explicit_points(std::span(&centre, 1))[0]);
  std::array<Index, 4> recorded;
  for (int i = 0; i < 4; ++i) recorded[i] = told.record.mesh_vertices[tet[i]];
  std::array<Index, 4> sorted = recorded;
  std::sort(sorted.begin(), sorted.end());
  auto& final = told.record.final;
  const auto found = std::find_if(final.begin(), final.end(), [&](const ExactRecord::Tet& other) {
    std::array<Index, 4> corners = other.vertices;
    std::sort(corners.begin(), corners.end());
    return corners == sorted;
  });
  ASSERT_NE(found, final.end());
  const bool inside = found->inside;
  final.erase(found);
  const std::int64_t region = told.sample.mesh.regions[t];
  for (int i = 0; i < 4; ++i) {
    Tet part = tet;
    std::array<Index, 4> recorded_part = recorded;
    part[i] = in_file;
    recorded_part[i] = in_record;
    final.push_back({recorded_part, inside});
    if (i == 0) {
      told.sample.mesh.tetrahedra[t] = part;
    } else {
      told.sample.mesh.tetrahedra.push_back(part);
      told.sample.mesh.regions.push_back(region);
    }
  }
}

// The refined mesh is the outer box, cut into six; nothing of the surface is left in it.
void empty_box(ExactRecord& r, std::uint8_t filtered) {
  ExactPoints points;
  points.assign(r.points);
  std::set<Index> used;
  for (const auto& tet : r.refined) used.insert(tet.vertices.begin(), tet.vertices.end());
  std::array<Index, 8> corner;
  for (int n = 0; n < 8; ++n) {
    double best = -HUGE_VAL;
    for (const Index v : used) {
      const Position& p = points.nearest(v);
      const double here =
          (n & 1 ? 1 : -1) * p[0] + (n & 2 ? 1 : -1) * p[1] + (n & 4 ? 1 : -1) * p[2];
      if (here > best) corner[n] = v;
      best = std::max(best, here);
    }
  }
  r.refined.clear();
  const int orders[6][3] = {{1, 2, 4}, {2, 4, 1}, {4, 1, 2}, {2, 1, 4}, {1, 4, 2}, {4, 2, 1}};
  for (const auto& order : orders) {
    const int b = order[0], c = b + order[1];
    std::array<Index, 4> tet = {corner[0], corner[b], corner[c], corner[7]};
    if (exact::orient3d(points, tet[0], tet[1], tet[2], tet[3]) < 0) std::swap(tet[2], tet[3]);
    r.refined.push_back({tet, false});
  }
  r.refined_facets.clear();
  r.segments.clear();
  r.corners.clear();
  r.chamfer_points.clear();
  r.balls.clear();
  for (auto& facet : r.facets) facet.filtered = filtered;
}

// A face in the middle of a facet is taken out, and artificial segments fence the hole. The record
// says that their ends were made for a corner.
void fence_a_hole(ExactRecord& r) {
  std::set<Index> on_segments;
  for (const auto& chain : r.segments)
    on_segments.insert(chain.vertices.begin(), chain.vertices.end());
  for (std::size_t n = 0; n < r.refined_facets.size(); ++n) {
    const auto [a, b, c, id] = r.refined_facets[n];
    if (on_segments.contains(a) + on_segments.contains(b) + on_segments.contains(c) > 0) continue;
    r.refined_facets.erase(r.refined_facets.begin() + static_cast<std::ptrdiff_t>(n));
    for (const auto& [p, q] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
      r.segments.push_back({true, id, {q, p}});
      r.chamfer_points.push_back({p, r.corners.at(0).vertex});
    }
    return;
  }
  ADD_FAILURE() << "no face away from all segments";
}

// Removes all faces and artificial segments of one facet.
void take_facet_out(ExactRecord& r) {
  const Index id = r.facets[kept_facet(r)].id;
  std::erase_if(r.refined_facets, [id](const auto& face) { return face[3] == id; });
  std::erase_if(r.segments,
                [id](const auto& chain) { return chain.artificial && chain.facet == id; });
}

// Mesh and record of the wedge alone, all of their indices as if the slab had been there.
void leave_slab_out(Told& told) {
  delmesher::Surface wedge = samples::wedge_and_slab();
  constexpr Index kWedge = 6, kWedgeTriangles = 8;
  const auto slab = static_cast<Index>(wedge.vertices.size()) - kWedge;
  wedge.vertices.resize(kWedge);
  wedge.triangles.resize(kWedgeTriangles);
  const delmesher::Result run = delmesher::tetrahedralize(wedge, honest_options());
  ASSERT_TRUE(run.status.ok());
  const auto moved = [&](Index v) { return v < kWedge ? v : v + slab; };
  ExactRecord& r = told.record;
  const ExactRecord::Parameters promised = r.parameters;
  const std::vector<ExactPoint> input(r.points.begin(), r.points.begin() + kWedge + slab);
  std::vector<ExactRecord::Facet> facets = r.facets;
  r = run.exact;
  r.parameters = promised;
  for (auto& facet : facets) facet.filtered = facet.id < kWedgeTriangles ? 0 : 1;
  r.facets = facets;
  for (ExactPoint& p : r.points) {
    if (p.kind == ExactPoint::Kind::explicit_point) continue;
    p.i = moved(p.i);
    p.j = moved(p.j);
    if (p.kind == ExactPoint::Kind::on_triangle) p.k = moved(p.k);
  }
  r.points.erase(r.points.begin(), r.points.begin() + kWedge);
  r.points.insert(r.points.begin(), input.begin(), input.end());
  const auto move_tets = [&](std::vector<ExactRecord::Tet>& tets) {
    for (auto& tet : tets) {
      for (Index& v : tet.vertices) v = moved(v);
    }
  };
  move_tets(r.refined);
  move_tets(r.final);
  move_tets(r.unrepaired);
  for (auto* faces : {&r.refined_facets, &r.final_facets, &r.unrepaired_facets}) {
    for (auto& face : *faces) {
      for (int i = 0; i < 3; ++i) face[i] = moved(face[i]);
    }
  }
  for (auto& chain : r.segments) {
    for (Index& v : chain.vertices) v = moved(v);
  }
  for (auto& corner : r.corners) corner.vertex = moved(corner.vertex);
  for (auto& made : r.chamfer_points) made = {moved(made[0]), moved(made[1])};
  for (auto& ball : r.balls) {
    ball.vertex = moved(ball.vertex);
    for (Index& v : ball.tetrahedron) v = moved(v);
  }
  for (Index& v : r.mesh_vertices) v = moved(v);
  told.sample.mesh = samples::to_mesh(run.mesh);
}

// Makes the final mesh not Delaunay: outside, the face between two tetrahedra is replaced by an
// edge. If `hide`, the record says that local operations did that, and that the mesh before them
// had no tetrahedra outside.
void flip_and_hide(Told& told, bool hide) {
  // In the wedge and the slab nothing can be flipped.
  for (const samples::NamedSurface& model : samples::surfaces(1)) {
    Options options = honest_options();
    options.region = delmesher::Region::hull;
    if (model.name == "pebble") told = run_of(options, Task::cdt, model.surface);
  }
  ExactRecord& r = told.record;
  ExactPoints points;
  points.assign(r.points);
  std::set<std::set<Index>> constraints;
  for (const auto& [a, b, c, id] : r.final_facets) constraints.insert({a, b, c});
  for (std::size_t s = 0; s < r.final.size(); ++s) {
    for (std::size_t t = 0; t < s; ++t) {
      if (r.final[s].inside || r.final[t].inside) continue;
      const auto& p = r.final[s].vertices;
      std::vector<Index> common, apices;
      for (const Index v : p) {
        const auto& q = r.final[t].vertices;
        (std::find(q.begin(), q.end(), v) != q.end() ? common : apices).push_back(v);
      }
      if (common.size() != 3 || constraints.contains({common.begin(), common.end()})) continue;
      for (const Index v : r.final[t].vertices) {
        if (std::find(common.begin(), common.end(), v) == common.end()) apices.push_back(v);
      }
      std::vector<ExactRecord::Tet> three;
      bool convex = true;
      int turned = 0;
      for (int i = 0; i < 3; ++i) {
        std::array<Index, 4> tet = {common[i], common[(i + 1) % 3], apices[1], apices[0]};
        const int sign = exact::orient3d(points, tet[0], tet[1], tet[2], tet[3]);
        // The edge between the apices passes through the face if all three turn the same way.
        turned += sign;
        convex = convex && std::abs(turned) == i + 1;
        if (sign < 0) std::swap(tet[0], tet[1]);
        three.push_back({tet, r.final[s].inside});
      }
      if (!convex) continue;
      std::set<std::set<Index>> gone;
      for (const std::size_t n : {s, t}) {
        gone.insert({r.final[n].vertices.begin(), r.final[n].vertices.end()});
      }
      std::vector<ExactRecord::Tet> rest = r.final;
      rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(s));
      rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(t));
      std::set<Index> used;
      for (const auto& tet : rest) used.insert(tet.vertices.begin(), tet.vertices.end());
      if (!used.contains(apices[0]) || !used.contains(apices[1])) continue;
      r.final = rest;
      r.final.insert(r.final.end(), three.begin(), three.end());
      if (hide) {
        r.unrepaired = rest;
        std::erase_if(r.unrepaired, [](const auto& tet) { return !tet.inside; });
      }
      std::vector<Index> written(r.points.size(), kNone);
      for (Index i = 0; i < r.mesh_vertices.size(); ++i) written[r.mesh_vertices[i]] = i;
      MeshFile& mesh = told.sample.mesh;
      for (std::size_t n = mesh.tetrahedra.size(); n-- > 0;) {
        std::set<Index> corners;
        for (const Index v : mesh.tetrahedra[n]) corners.insert(r.mesh_vertices[v]);
        if (!gone.contains(corners)) continue;
        mesh.tetrahedra.erase(mesh.tetrahedra.begin() + static_cast<std::ptrdiff_t>(n));
        mesh.regions.erase(mesh.regions.begin() + static_cast<std::ptrdiff_t>(n));
      }
      for (const auto& tet : three) {
        Tet here = tet.vertices;
        for (Index& v : here) v = written[v];
        mesh.tetrahedra.push_back(here);
        mesh.regions.push_back(tet.inside ? 1 : 0);
      }
      return;
    }
  }
  ADD_FAILURE() << "nothing to flip";
}

// Gives every facet a label of its own, in the input, the record and the file.
void give_labels(Told& told) {
  auto& labels = told.sample.input.labels;
  labels.assign(told.sample.input.triangles.size(), 0);
  std::map<Index, std::int32_t> of_facet;
  for (auto& facet : told.record.facets) {
    facet.label = static_cast<std::int32_t>(facet.id) + 1;
    for (const Index t : facet.triangles) labels[t] = facet.label;
    of_facet[facet.id] = facet.label;
  }
  auto& mesh = told.sample.mesh;
  for (std::size_t n = 0; n < mesh.boundary.size(); ++n) {
    mesh.labels[n] = of_facet.at(mesh.facets[n]);
  }
}

const Lie kConsistent[] = {
    {"a run with delta 3", "refined-angles",
     [](Told& t) { claim_for(t, [](Options& o) { o.delta = 3; }); }},
    {"a run without empty balls", "refined-encroachment",
     [](Told& t) { claim_for(t, [](Options& o) { o.gabriel = false; }); }},
    {"a run with corners below 90 degrees chamfered", "refined-chamfer-need",
     [](Told& t) { claim_for(t, [](Options& o) { o.acute = o.corner = 90; }); }},
    {"a run with a finer filter", "refined-filter",
     [](Told& t) {
       t.record.parameters.tolerance *= 0.1 / t.promise.tau;
       t.promise.tau = 0.1;
     }},
    {"a run with a coarser filter", "refined-filter",
     [](Told& t) { claim_for(t, [](Options& o) { o.tau = 0.06; }); }},
    {"a run with chamfers wider than promised", "refined-chamfer-need",
     [](Told& t) { t.promise.chamfer_radius = 0x1p-8; }},
    {"a run with chamfers wider than promised, by their points", "refined-chamfer-extent",
     [](Told& t) { t.promise.chamfer_radius = 0x1p-8; }},
    {"a run with edges longer than promised", "refined-edges",
     [](Told& t) { t.promise.max_edge = 0x1p-4; }},
    {"a run of more vertices than were allowed", "promise",
     [](Told& t) { t.promise.max_vertices = 20; }, "passed"},
    {"a run of more tetrahedra than were allowed", "promise",
     [](Told& t) { t.promise.budget = static_cast<double>(t.sample.mesh.tetrahedra.size()) - 1; },
     "passed"},
    {"a run without the size field that was promised", "refined-sizes",
     [](Told& t) {
       t.promise.size_field = {{t.sample.input.vertices[0], 0x1p-6}};
     }},
    {"a run of the other region", "promise",
     [](Told& t) { t.promise.region = delmesher::Region::hull; }},
    {"a run that stopped before the last step", "promise",
     [](Told& t) {
       Options options = honest_options();
       options.approximate = true;
       const Promise promise = t.promise;
       t = run_of(options);
       t.promise = promise;
     }},
    {"the last step without the points of the refined mesh", "enrichment",
     [](Told& t) { put_plain_final(t); }},
    {"the same, as if to repair rounding", "repairs",
     [](Told& t) {
       const ExactRecord before = t.record;
       put_plain_final(t);
       t.record.unrepaired = before.final;
       t.record.unrepaired_facets = before.final_facets;
     }},
    {"a point of no origin in the volume", "enrichment",
     [](Told& t) { split_in_both(t, t.sample.mesh.tetrahedra.size() / 2); }},
    {"a point of no origin that was not put where it is", "exact-constrained-delaunay",
     [](Told& t) { split_in_both(t, t.sample.mesh.tetrahedra.size() / 2); }},
    {"a cavity away from all facets, its faces said to be on one", "exact-conformity",
     [](Told& t) {
       // Three points, each inside a tetrahedron that the last one made: a tetrahedron of them and
       // one vertex has no edge on the surface.
       const auto& tets = t.sample.mesh.tetrahedra;
       split_in_both(t, tets.size() / 2);
       split_in_both(t, tets.size() - 2);
       split_in_both(t, tets.size() - 1);
       auto& cavity = t.record.final[t.record.final.size() - 3];
       cavity.inside = false;
       for (int i = 0; i < 4; ++i) {
         const auto [a, b, c] = face_of(cavity.vertices, i);
         t.record.final_facets.push_back({a, b, c, t.record.facets.front().id});
       }
     }},
    {"all facets dropped for their chamfers, an empty box refined", "refined-filter",
     [](Told& t) { empty_box(t.record, 2); }},
    {"all facets dropped for each other, an empty box refined", "refined-filter",
     [](Told& t) { empty_box(t.record, 1); }},
    {"all facets kept, an empty box refined", "refined-segments",
     [](Told& t) { empty_box(t.record, 0); }},
    {"a hole in a facet, fenced by artificial segments", "refined-chamfer-cuts",
     [](Told& t) { fence_a_hole(t.record); }},
    {"a facet without faces", "refined-chamfer-cuts", [](Told& t) { take_facet_out(t.record); }},
    {"a facet dropped with all that is on it", "refined-filter",
     [](Told& t) {
       t.record.facets[kept_facet(t.record)].filtered = 2;
       take_facet_out(t.record);
     }},
    {"a run with a filter, told to have none", "refined-filter",
     [](Told& t) { t.promise.tau = t.record.parameters.tolerance = 0; }},
    {"no filter, and all facets dropped, an empty box refined", "refined-filter",
     [](Told& t) {
       empty_box(t.record, 1);
       t.promise.tau = t.record.parameters.tolerance = 0;
     }},
    {"a mesh with Steiner points told to be a plain tetrahedrization", "origins",
     [](Told& t) {
       run_hull(t);
       t.promise.task = Task::cdt;
     }},
    {"outside left out before repairs and not Delaunay after them", "unrepaired-hull",
     [](Told& t) { flip_and_hide(t, true); }},
    {"a flip that is not Delaunay", "exact-constrained-delaunay",
     [](Told& t) { flip_and_hide(t, false); }},
    {"other facets before repairs that never were", "unrepaired-facets",
     [](Told& t) {
       t.record.unrepaired = t.record.final;
       t.record.unrepaired_facets = t.record.final_facets;
       t.record.unrepaired_facets.pop_back();
     }},
    {"a component left out of everything", "exact-conformity", leave_slab_out},
    {"all of the hull called inside", "exact-interior",
     [](Told& t) {
       run_hull(t);
       for (auto& tet : t.record.final) tet.inside = true;
       std::fill(t.sample.mesh.regions.begin(), t.sample.mesh.regions.end(), 1);
     }},
    {"labels of two facets exchanged in file and record", "boundary-list",
     [](Told& t) {
       give_labels(t);
       std::swap(t.record.facets.front().label, t.record.facets.back().label);
       std::map<Index, std::int32_t> of_facet;
       for (const auto& facet : t.record.facets) of_facet[facet.id] = facet.label;
       auto& mesh = t.sample.mesh;
       for (std::size_t n = 0; n < mesh.boundary.size(); ++n) {
         mesh.labels[n] = of_facet.at(mesh.facets[n]);
       }
     }},
    {"facets exchanged in file and record", "exact-facets",
     [](Told& t) {
       const Index a = t.record.final_facets.front()[3], b = t.record.final_facets.back()[3];
       const auto other = [a, b](Index id) { return id == a ? b : id == b ? a : id; };
       for (auto& face : t.record.final_facets) face[3] = other(face[3]);
       for (Index& id : t.sample.mesh.facets) id = other(id);
     }},
    {"the outside of a hull left out in file and record", "exact-hull",
     [](Told& t) {
       run_hull(t);
       std::erase_if(t.record.final, [](const auto& tet) { return !tet.inside; });
       auto& mesh = t.sample.mesh;
       std::vector<Tet> kept;
       for (std::size_t n = 0; n < mesh.tetrahedra.size(); ++n) {
         if (mesh.regions[n] == 1) kept.push_back(mesh.tetrahedra[n]);
       }
       mesh.tetrahedra = kept;
       mesh.regions.assign(kept.size(), 1);
     }},
    {"a vertex of the mesh put where another one is", "exact-orientation",
     [](Told& t) {
       const Index v = t.record.mesh_vertices.back();
       const Index w = t.record.mesh_vertices[t.record.mesh_vertices.size() - 2];
       t.record.points[v] = t.record.points[w];
       t.sample.mesh.vertices.back() = t.sample.mesh.vertices[t.sample.mesh.vertices.size() - 2];
     }},
    {"the final mesh told to be that of --approximate", "same-mesh",
     [](Told& t) {
       t.promise.approximate = true;
       t.record.final.clear();
       t.record.final_facets.clear();
     }},
    {"tetrahedra doubled in file and record", "exact-complex",
     [](Told& t) {
       t.sample.mesh.tetrahedra.push_back(t.sample.mesh.tetrahedra.front());
       t.sample.mesh.regions.push_back(t.sample.mesh.regions.front());
       for (const auto& tet : t.record.final) {
         if (!tet.inside) continue;
         t.record.final.push_back(tet);
         return;
       }
     }},
    {"a tetrahedron inside left out of file and record", "exact-conformity",
     [](Told& t) {
       const Tet gone = t.sample.mesh.tetrahedra.back();
       t.sample.mesh.tetrahedra.pop_back();
       t.sample.mesh.regions.pop_back();
       std::set<Index> corners;
       for (const Index v : gone) corners.insert(t.record.mesh_vertices[v]);
       for (auto& tet : t.record.final) {
         if (std::set<Index>(tet.vertices.begin(), tet.vertices.end()) == corners) {
           tet.inside = false;
         }
       }
     }},
    {"all numbers of the file and the record moved by a sixteenth", "sidecar",
     [](Told& t) {
       for (Position& p : t.sample.mesh.vertices) p[0] += 0x1p-4;
       for (ExactPoint& p : t.record.points) {
         if (p.kind == ExactPoint::Kind::explicit_point) p.x += 0x1p-4;
       }
     }},
    {"a Steiner point on an edge moved to its end, in file and record", "exact-orientation",
     [](Told& t) {
       ExactPoints points;
       for (std::size_t i = 0; i < t.record.mesh_vertices.size(); ++i) {
         ExactPoint& p = t.record.points[t.record.mesh_vertices[i]];
         if (p.kind != ExactPoint::Kind::on_segment) continue;
         p.x = 1;
         points.assign(t.record.points);
         t.sample.mesh.vertices[i] = points.nearest(t.record.mesh_vertices[i]);
         return;
       }
     }},
};

}  // namespace

std::span<const Lie> consistent() {
  return kConsistent;
}

}  // namespace tetproof::lies
