// Lies of a record: relaxed promises; sections swapped, emptied, duplicated, cut short, out of
// date; records of other runs; and lies that change mesh and record together, so that both agree.
// Each has to be caught by the oracle meant for it. At the end they are printed as a table.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
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

// What is told of a run, and what was asked for.
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

Told run_of(const Options& options, Task task = Task::mesh) {
  const delmesher::Surface surface = samples::wedge_and_slab();
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

// A face in the middle of a facet is taken out, and the hole fenced by artificial segments, whose
// ends are told to be made for a corner.
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

// All that is on one facet goes: faces and artificial segments.
void take_facet_out(ExactRecord& r) {
  const Index id = r.facets[kept_facet(r)].id;
  std::erase_if(r.refined_facets, [id](const auto& face) { return face[3] == id; });
  std::erase_if(r.segments,
                [id](const auto& chain) { return chain.artificial && chain.facet == id; });
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
       // Of the largest coordinate, 3; vertices that are not of the input may move at all.
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
    EXPECT_EQ(
        verify(t.sample.input, t.sample.mesh, &t.record,
               {.stage = Stage::both, .promised = t.promise, .record_version = t.version}, report),
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

}  // namespace
}  // namespace tetproof
