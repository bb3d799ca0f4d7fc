// Lies of a record: relaxed promises; sections swapped, emptied, duplicated, cut short, out of
// date; records of other runs; and lies that change mesh and record together, so that both agree.
// Each has to be caught by the oracle meant for it. At the end they are printed as a table.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "mesher/delmesher.h"
#include "oracles/verify.h"
#include "property_tests/samples.h"
#include "property_tests/score_table.h"

namespace tetproof {
namespace {

using namespace oracles;  // NOLINT
using delmesher::ExactPoint;
using delmesher::ExactRecord;
using delmesher::Options;

// A run as it is told, and what was asked for.
struct Told {
  samples::Sample sample;
  ExactRecord record;
  Promise promise;
  unsigned version = kRecordVersion;
};

// The filter takes the slab apart, the wedge is chamfered.
Options honest_options() {
  Options options;
  options.want_exact = true;
  options.gabriel = true;
  options.tau = 0x1p-9;
  return options;
}

Told run_of(const Options& options, Task task = Task::mesh,
            const delmesher::Surface& surface = samples::wedge_and_slab()) {
  const delmesher::Result result = task == Task::cdt
                                       ? delmesher::constrained_delaunay(surface, options)
                                       : delmesher::tetrahedralize(surface, options);
  EXPECT_TRUE(result.status.ok()) << result.status.message;
  return {{samples::to_polyhedron(surface), samples::to_mesh(result.mesh)},
          result.exact,
          promise_of(options, task)};
}

const Told& honest() {
  static const Told told = run_of(honest_options());
  return told;
}

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
void split_in_both(Told& told, std::size_t t, Index w) {
  ExactPoints points;
  points.assign(told.record.points);
  const Tet tet = told.sample.mesh.tetrahedra[t];
  Position centre{};
  for (const Index v : tet) {
    for (int axis = 0; axis < 3; ++axis) centre[axis] += told.sample.mesh.vertices[v][axis] / 4;
  }
  const auto in_file = static_cast<Index>(told.sample.mesh.vertices.size());
  const auto in_record = w != kNone ? w : static_cast<Index>(told.record.points.size());
  told.sample.mesh.vertices.push_back(centre);
  told.record.mesh_vertices.push_back(in_record);
  if (w == kNone) told.record.points.push_back(explicit_points(std::span(&centre, 1))[0]);
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

std::size_t kept_facet(const ExactRecord& r) {
  for (std::size_t f = 0; f < r.facets.size(); ++f) {
    if (r.facets[f].filtered == 0) return f;
  }
  ADD_FAILURE() << "no facet was kept";
  return 0;
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

// A run of the hull, told as it was.
void run_hull(Told& told, Task task = Task::mesh) {
  Options options = honest_options();
  options.region = delmesher::Region::hull;
  told = run_of(options, task);
}

// The constrained Delaunay tetrahedrization of the hull, told as it was.
void run_cdt(Told& told) {
  run_hull(told, Task::cdt);
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
// edge. The record says that this came with a repair of a mesh that had nothing outside.
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

// Every input triangle with a label of its own facet.
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

struct Lie {
  const char* name;
  const char* oracle;  // the one meant to catch it
  void (*tell)(Told&);
};

void PrintTo(const Lie& lie, std::ostream* stream) {
  *stream << lie.name;
}

const Lie kRelaxed[] = {
    {"delta relaxed to nothing", "promise", [](Told& t) { t.record.parameters.delta = 0x1p-20; }},
    {"threshold of corners relaxed", "promise", [](Told& t) { t.record.parameters.acute = 1; }},
    {"threshold of two edges relaxed", "promise", [](Told& t) { t.record.parameters.corner = 0; }},
    {"no empty balls", "promise", [](Told& t) { t.record.parameters.gabriel = false; }},
    {"another region", "promise",
     [](Told& t) { t.record.parameters.region = delmesher::Region::hull; }},
    {"tolerance doubled", "promise", [](Told& t) { t.record.parameters.tolerance *= 2; }},
    {"tolerance relaxed to nothing", "promise", [](Told& t) { t.record.parameters.tolerance = 0; }},
    {"tolerance raised for a budget, by no power of two", "promise",
     [](Told& t) {
       t.promise.budget = 1000;
       t.record.parameters.tolerance *= 3;
     }},
    {"tolerance raised beyond what a budget may", "promise",
     [](Told& t) {
       t.promise.budget = 1000;
       t.record.parameters.tolerance *= 256;
     }},
    {"threshold of one corner relaxed", "promise",
     [](Told& t) { t.record.corners.front().threshold = 30; }},
    {"threshold of one corner above a right angle", "promise",
     [](Told& t) { t.record.corners.front().threshold = 179; }},
    {"corner tightened without empty balls", "promise",
     [](Told& t) {
       t.promise.gabriel = t.record.parameters.gabriel = false;
       t.record.corners.front().threshold = 90;
     }},
    {"radii of 2^60", "refined-chamfer-need",
     [](Told& t) {
       for (auto& corner : t.record.corners) corner.radius = 0x1p60;
     }},
    {"a radius half as large again", "refined-chamfer-need",
     [](Told& t) { t.record.corners.front().radius *= 1.5; }},
    {"a radius of nothing", "refined-chamfer-need",
     [](Told& t) { t.record.corners.front().radius = 0; }},
    {"all relaxed at once", "promise",
     [](Told& t) {
       t.record.parameters = {};
       t.record.parameters.tolerance = 0x1p60;
     }},
    {"delta that is no number", "sidecar",
     [](Told& t) { t.record.parameters.delta = std::nan(""); }},
    {"delta infinite", "sidecar", [](Told& t) { t.record.parameters.delta = HUGE_VAL; }},
    {"delta that the mesh does not have", "refined-angles",
     [](Told& t) { t.record.parameters.delta = 30; }},
    {"threshold of corners infinite", "sidecar",
     [](Told& t) { t.record.parameters.acute = HUGE_VAL; }},
    {"threshold of corners above a right angle", "promise",
     [](Told& t) { t.record.parameters.acute = t.record.parameters.corner = 120; }},
    {"threshold of one corner that is no number", "sidecar",
     [](Told& t) { t.record.corners.front().threshold = std::nan(""); }},
    {"tolerance that is no number", "sidecar",
     [](Told& t) {
       t.promise.budget = 1000;
       t.record.parameters.tolerance = std::nan("");
     }},
    {"tolerance negative", "promise",
     [](Told& t) { t.record.parameters.tolerance = -t.record.parameters.tolerance; }},
    {"tolerance denormal", "promise", [](Told& t) { t.record.parameters.tolerance = 0x1p-1070; }},
    {"a radius that is no number", "sidecar",
     [](Told& t) { t.record.corners.front().radius = std::nan(""); }},
    {"a radius negative", "refined-chamfer-need",
     [](Told& t) { t.record.corners.front().radius *= -1; }},
    {"a radius denormal", "refined-chamfer-extent",
     [](Told& t) { t.record.corners.front().radius = 0x1p-1070; }},
    {"empty balls that the mesh does not have", "refined-encroachment",
     [](Told& t) {
       Options options = honest_options();
       options.gabriel = false;
       t = run_of(options);
       t.record.parameters.gabriel = true;
     }},
    {"an old version", "promise", [](Told& t) { t.version = 2; }},
    {"version 1, which lacks what could be asked", "promise",
     [](Told& t) {
       t.version = 1;
       t.record.parameters = {};
       t.record.chamfer_points.clear();
       t.record.balls.clear();
     }},
};

const Lie kSections[] = {
    {"no facets", "promise", [](Told& t) { t.record.facets.clear(); }},
    {"no segments", "promise", [](Told& t) { t.record.segments.clear(); }},
    {"no refined mesh", "promise", [](Told& t) { t.record.refined.clear(); }},
    {"no faces on facets in the refined mesh", "promise",
     [](Told& t) { t.record.refined_facets.clear(); }},
    {"no final mesh", "promise", [](Told& t) { t.record.final.clear(); }},
    {"no faces on facets in the final mesh", "promise",
     [](Told& t) { t.record.final_facets.clear(); }},
    {"no written vertices", "promise", [](Told& t) { t.record.mesh_vertices.clear(); }},
    {"no points made by chamfering", "promise", [](Told& t) { t.record.chamfer_points.clear(); }},
    {"no corners", "refined-chamfer-need", [](Told& t) { t.record.corners.clear(); }},
    {"no balls", "refined-steiner-balls", [](Told& t) { t.record.balls.clear(); }},
    {"one ball fewer", "refined-steiner-balls", [](Told& t) { t.record.balls.pop_back(); }},
    {"one ball twice", "refined-steiner-balls",
     [](Told& t) { t.record.balls.push_back(t.record.balls.front()); }},
    {"a ball of a flat tetrahedron", "refined-steiner-balls",
     [](Told& t) {
       auto& corners = t.record.balls.front().tetrahedron;
       corners[3] = corners[2];
     }},
    {"a ball for an input vertex", "refined-steiner-balls",
     [](Told& t) {
       t.record.balls.push_back(t.record.balls.front());
       t.record.balls.back().vertex = 0;
     }},
    {"a corner fewer", "refined-chamfer-need", [](Told& t) { t.record.corners.pop_back(); }},
    {"a corner twice", "refined-chamfer-need",
     [](Told& t) { t.record.corners.push_back(t.record.corners.front()); }},
    {"a corner that is not acute", "refined-chamfer-need",
     [](Told& t) {
       t.record.corners.push_back({1, 60, 0x1p-4});
     }},
    {"a point made by chamfering fewer", "refined-chamfer-cuts",
     [](Told& t) { t.record.chamfer_points.pop_back(); }},
    {"a point made for two corners", "refined-chamfer-cuts",
     [](Told& t) {
       t.record.chamfer_points.push_back(t.record.chamfer_points.front());
       auto& made = t.record.chamfer_points.back();
       made[1] = made[1] == 0 ? 3 : 0;
     }},
    {"refined mesh instead of the final one", "exact-conformity",
     [](Told& t) {
       t.record.final = t.record.refined;
       t.record.final_facets = t.record.refined_facets;
     }},
    {"final mesh instead of the refined one", "refined-delaunay",
     [](Told& t) { t.record.refined = t.record.final; }},
    {"every tetrahedron of the refined mesh called outside", "refined-contained",
     [](Told& t) {
       for (auto& tet : t.record.refined) tet.inside = false;
     }},
    {"one tetrahedron of the refined mesh called outside", "refined-contained",
     [](Told& t) {
       std::find_if(t.record.refined.begin(), t.record.refined.end(), [](const auto& tet) {
         return tet.inside;
       })->inside = false;
     }},
    {"a facet twice, another one not at all", "facet-list",
     [](Told& t) { t.record.facets.back() = t.record.facets.front(); }},
    {"a facet without its triangles", "facet-list",
     [](Told& t) { t.record.facets.front().triangles.clear(); }},
    {"a triangle twice in its facet", "facet-list",
     [](Told& t) {
       auto& triangles = t.record.facets.front().triangles;
       triangles.push_back(triangles.front());
     }},
    {"facets of a plain tetrahedrization exchanged", "facet-list",
     [](Told& t) {
       run_cdt(t);
       std::swap(t.record.facets.front().id, t.record.facets.back().id);
     }},
    {"a segment cut short", "refined-segments",
     [](Told& t) {
       for (auto& chain : t.record.segments) {
         if (!chain.artificial && chain.vertices.size() > 2) return chain.vertices.pop_back();
       }
     }},
    {"a segment in two pieces", "refined-segments",
     [](Told& t) {
       for (std::size_t n = 0; n < t.record.segments.size(); ++n) {
         auto chain = t.record.segments[n];
         if (chain.artificial || chain.vertices.size() < 3) continue;
         t.record.segments[n].vertices.resize(2);
         chain.vertices.erase(chain.vertices.begin());
         t.record.segments.push_back(chain);
         return;
       }
     }},
    {"a segment twice", "refined-segments",
     [](Told& t) { t.record.segments.push_back(t.record.segments.front()); }},
    {"tetrahedra of balls exchanged", "refined-steiner-balls",
     [](Told& t) {
       auto& balls = t.record.balls;
       std::swap(balls.front().tetrahedron, balls.back().tetrahedron);
     }},
    {"all tetrahedra of the final mesh turned over", "exact-orientation",
     [](Told& t) {
       for (auto& tet : t.record.final) std::swap(tet.vertices[0], tet.vertices[1]);
     }},
    {"two input vertices exchanged", "sidecar",
     [](Told& t) { std::swap(t.record.points[0], t.record.points[1]); }},
    {"labels of facets exchanged", "refined-segments",
     [](Told& t) { t.record.facets[kept_facet(t.record)].label = 17; }},
};

const Lie kForeign[] = {
    {"file of another run, every written vertex point 0", "same-mesh",
     [](Told& t) {
       Options options = honest_options();
       t.sample.mesh = run_of(options, Task::cdt).sample.mesh;
       t.record.mesh_vertices.assign(t.sample.mesh.vertices.size(), 0);
     }},
    {"the same, seen by the rounding", "rounding",
     [](Told& t) {
       Options options = honest_options();
       t.sample.mesh = run_of(options, Task::cdt).sample.mesh;
       t.record.mesh_vertices.assign(t.sample.mesh.vertices.size(), 0);
     }},
    {"file of a plain tetrahedrization, its vertices right", "same-mesh",
     [](Told& t) {
       Options options = honest_options();
       const Told plain = run_of(options, Task::cdt);
       t.sample.mesh = plain.sample.mesh;
       t.record.mesh_vertices = plain.record.mesh_vertices;
     }},
    {"two written vertices exchanged in the record", "rounding",
     [](Told& t) { std::swap(t.record.mesh_vertices[0], t.record.mesh_vertices[5]); }},
    {"a written vertex 6 ulp off", "rounding",
     [](Told& t) {
       // The ulp is that of the largest coordinate, 3. Vertices that are not of the input may move
       // at all.
       for (std::size_t i = 0; i < t.record.mesh_vertices.size(); ++i) {
         if (t.record.mesh_vertices[i] < t.sample.input.vertices.size()) continue;
         t.sample.mesh.vertices[i][0] += 6 * 0x1p-51;
         return;
       }
     }},
    {"a tetrahedron of the record turned to another of the same four points", "same-mesh",
     [](Told& t) {
       for (auto& tet : t.record.final) {
         if (!tet.inside) continue;
         tet.vertices[0] = t.record.final.back().vertices[3];
         return;
       }
     }},
    {"a tetrahedron of the file called outside in the record", "same-mesh",
     [](Told& t) {
       std::find_if(t.record.final.begin(), t.record.final.end(), [](const auto& tet) {
         return tet.inside;
       })->inside = false;
     }},
    {"a listed boundary triangle with another label", "same-mesh",
     [](Told& t) {
       t.sample.input.labels.assign(t.sample.input.triangles.size(), 0);
       t.sample.mesh.labels.assign(t.sample.mesh.boundary.size(), 0);
       t.sample.mesh.labels.back() = 4;
     }},
    {"no boundary triangles in the file", "same-mesh",
     [](Told& t) {
       t.sample.mesh.boundary.clear();
       t.sample.mesh.labels.clear();
       t.sample.mesh.facets.clear();
     }},
    {"a boundary triangle in the file turned inwards", "same-mesh",
     [](Told& t) {
       auto& face = t.sample.mesh.boundary.front();
       std::swap(face[0], face[1]);
     }},
    {"facets of boundary triangles in the file exchanged", "same-mesh",
     [](Told& t) { std::swap(t.sample.mesh.facets.front(), t.sample.mesh.facets.back()); }},
    {"facets of boundary triangles cut short", "same-mesh",
     [](Told& t) { t.sample.mesh.facets.pop_back(); }},
    {"a face of the hull listed as boundary", "same-mesh",
     [](Told& t) {
       run_hull(t);
       std::set<std::set<Index>> seen;
       for (const Tet& tet : t.sample.mesh.tetrahedra) {
         for (int i = 0; i < 4; ++i) {
           const Face face = face_of(tet, i);
           const std::set<Index> corners(face.begin(), face.end());
           if (!seen.insert(corners).second) seen.erase(corners);
         }
       }
       for (const Face& face : t.sample.mesh.boundary) seen.erase({face.begin(), face.end()});
       const std::vector<Index> face(seen.begin()->begin(), seen.begin()->end());
       t.sample.mesh.boundary.push_back({face[0], face[1], face[2]});
       t.sample.mesh.labels.push_back(0);
       t.sample.mesh.facets.push_back(0);
     }},
    {"all tetrahedra of the file turned over, in a format without convention", "orientation",
     [](Told& t) {
       t.sample.mesh.either_orientation = true;
       for (Tet& tet : t.sample.mesh.tetrahedra) std::swap(tet[0], tet[1]);
     }},
    {"inside and outside exchanged in the file", "same-mesh",
     [](Told& t) {
       run_hull(t);
       for (auto& region : t.sample.mesh.regions) region = 1 - region;
     }},
    {"half of the inside renamed in the file", "same-mesh",
     [](Told& t) {
       auto& regions = t.sample.mesh.regions;
       std::fill_n(regions.begin(), regions.size() / 2, 7);
     }},
    {"sides left out of a file of the hull", "same-mesh",
     [](Told& t) {
       run_hull(t);
       t.sample.mesh.regions.clear();
     }},
    {"sides of a file cut short", "same-mesh",
     [](Told& t) {
       run_hull(t);
       t.sample.mesh.regions.resize(t.sample.mesh.regions.size() / 2);
     }},
    {"a face on a facet fewer in the record", "same-mesh",
     [](Told& t) { t.record.final_facets.pop_back(); }},
};

// Mesh and record agree in all of these.
const Lie kConsistent[] = {
    {"a run with delta 3", "refined-angles",
     [](Told& t) { claim_for(t, [](Options& o) { o.delta = 3; }); }},
    {"a run without empty balls", "refined-encroachment",
     [](Told& t) { claim_for(t, [](Options& o) { o.gabriel = false; }); }},
    {"a run with corners below 90 degrees chamfered", "refined-chamfer-need",
     [](Told& t) {
       claim_for(t, [](Options& o) { o.acute = o.corner = 90; });
       for (auto& corner : t.record.corners) corner.threshold = 60;
     }},
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
     [](Told& t) { split_in_both(t, t.sample.mesh.tetrahedra.size() / 2, kNone); }},
    {"a point of no origin that was not put where it is", "exact-constrained-delaunay",
     [](Told& t) { split_in_both(t, t.sample.mesh.tetrahedra.size() / 2, kNone); }},
    {"a cavity away from all facets, its faces said to be on one", "exact-conformity",
     [](Told& t) {
       // Three points, each inside a tetrahedron that the last one made: a tetrahedron of them and
       // one vertex has no edge on the surface.
       const auto& tets = t.sample.mesh.tetrahedra;
       split_in_both(t, tets.size() / 2, kNone);
       split_in_both(t, tets.size() - 2, kNone);
       split_in_both(t, tets.size() - 1, kNone);
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
};

class Lies : public testing::TestWithParam<Lie> {};

TEST_P(Lies, AreCaughtByTheOracleMeantForThem) {
  Told told = honest();
  const auto verdict = [](const Told& t) {
    VerifyReport report;
    EXPECT_EQ(verify(t.sample.input, t.sample.mesh, &t.record,
                     {.stage = t.promise.approximate         ? Stage::refined
                               : t.promise.task == Task::cdt ? Stage::final
                                                             : Stage::both,
                      .promised = t.promise,
                      .record_version = t.version},
                     report),
              "");
    return report;
  };
  static const VerifyReport good = verdict(told);
  ASSERT_TRUE(samples::exact_or_rounded(good)) << to_text(good);
  GetParam().tell(told);
  judge("wedge and slab", GetParam().name, GetParam().oracle, verdict(told));
}

std::string lie_name(const testing::TestParamInfo<Lie>& tested) {
  std::string name = tested.param.name;
  for (char& c : name) {
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  }
  return name;
}

INSTANTIATE_TEST_SUITE_P(Relaxed, Lies, testing::ValuesIn(kRelaxed), lie_name);
INSTANTIATE_TEST_SUITE_P(Sections, Lies, testing::ValuesIn(kSections), lie_name);
INSTANTIATE_TEST_SUITE_P(Foreign, Lies, testing::ValuesIn(kForeign), lie_name);
INSTANTIATE_TEST_SUITE_P(Consistent, Lies, testing::ValuesIn(kConsistent), lie_name);

VerifyReport verdict_on(const Told& told) {
  VerifyReport report;
  EXPECT_EQ(verify(told.sample.input, told.sample.mesh, &told.record,
                   {.stage = Stage::both, .promised = told.promise}, report),
            "");
  return report;
}

std::map<std::string, double> figures_of(const VerifyReport& report, const std::string& oracle) {
  const OracleReport* found = report.find(oracle);
  EXPECT_NE(found, nullptr) << oracle;
  if (found == nullptr) return {};
  return {found->figures.begin(), found->figures.end()};
}

// The figures of an honest run, apart from that it passes.
TEST(Truths, FiguresAreThoseOfTheRun) {
  const ExactRecord& r = honest().record;
  const VerifyReport report = verdict_on(honest());
  // The largest coordinate is 3.
  EXPECT_GT(report.deviation, 0);
  EXPECT_DOUBLE_EQ(report.deviation_ulps, report.deviation / 0x1p-51);
  std::set<Index> refined, created;
  for (const auto& tet : r.refined) refined.insert(tet.vertices.begin(), tet.vertices.end());
  for (const auto& tet : r.unrepaired.empty() ? r.final : r.unrepaired) {
    for (const Index v : tet.vertices) {
      if (v >= honest().sample.input.vertices.size() && !refined.contains(v)) created.insert(v);
    }
  }
  EXPECT_EQ(figures_of(report, "enrichment").at("new on the surface"),
            static_cast<double>(created.size()));
}

// Chamfers that obey a bound pass.
TEST(Truths, ChamfersWithinTheirBoundPass) {
  Options options = honest_options();
  options.chamfer_radius = 0x1p-5;
  const Told told = run_of(options);
  EXPECT_FALSE(told.record.chamfer_points.empty());
  const VerifyReport report = verdict_on(told);
  EXPECT_TRUE(samples::exact_or_rounded(report)) << to_text(report);
}

// A cut point is the same point from either end of its edge.
TEST(Truths, CutPointsMayBeGivenFromEitherEnd) {
  Told told = honest();
  std::size_t turned = 0;
  for (ExactPoint& p : told.record.points) {
    if (p.kind != ExactPoint::Kind::on_segment) continue;
    if (mpq_class(1) - mpq_class(p.x) != mpq_class(1 - p.x)) continue;
    std::swap(p.i, p.j);
    p.x = 1 - p.x;
    ++turned;
  }
  EXPECT_GT(turned, 0U);
  const VerifyReport report = verdict_on(told);
  EXPECT_TRUE(samples::exact_or_rounded(report)) << to_text(report);
}

// The edges to the apex of this pyramid rise at 45 degrees over the diagonals of its base: angles
// of a segment and a facet that are as large as they have to be, and none is called smaller.
TEST(Truths, AnAngleAtTheThresholdIsNotBelowIt) {
  delmesher::Surface pyramid;
  pyramid.vertices = {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 1}};
  pyramid.triangles = {{0, 3, 1}, {1, 3, 2}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
  Options options = honest_options();
  options.acute = 45;
  const Told told = run_of(options, Task::mesh, pyramid);
  EXPECT_TRUE(told.record.corners.empty());
  const VerifyReport report = verdict_on(told);
  EXPECT_TRUE(samples::exact_or_rounded(report)) << to_text(report);
  const auto figures = figures_of(report, "refined-chamfer-angles");
  EXPECT_EQ(figures.at("below the threshold by rounding"), 0);
}

}  // namespace
}  // namespace tetproof
