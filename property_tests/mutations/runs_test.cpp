// Damage to a run of the mesher with chamfers, artificial segments, Steiner points of all kinds and
// filtered facets.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "mesher/delmesher.h"
#include "oracles/mesh/tet_complex.h"
#include "property_tests/mutations/damages.h"
#include "property_tests/score_table.h"

namespace tetproof {
namespace {

using namespace mutations;  // NOLINT
using namespace oracles;    // NOLINT
using delmesher::ExactPoint;
using delmesher::ExactRecord;
using samples::Sample;

struct MesherRun {
  Sample sample;
  ExactRecord record;
  Promise promise;
};

// The filter takes the slab apart.
MesherRun mesher_run() {
  const delmesher::Surface s = samples::wedge_and_slab();
  delmesher::Options options = samples::split_surface();
  options.want_exact = true;
  options.gabriel = true;
  options.improve = false;
  options.tau = 0x1p-9;
  const delmesher::Result result = delmesher::tetrahedralize(s, options);
  EXPECT_TRUE(result.status.ok()) << result.status.message;
  return {{samples::to_polyhedron(s), samples::to_mesh(result.mesh)},
          result.exact,
          promise_of(options)};
}

const MesherRun& good_run() {
  static const MesherRun run = mesher_run();
  return run;
}

Index first_volume_vertex(const ExactRecord& r) {
  return r.balls.at(r.balls.size() / 2).vertex;
}

std::size_t artificial_chain(const ExactRecord& r, std::size_t length) {
  for (std::size_t n = 0; n < r.segments.size(); ++n) {
    if (r.segments[n].artificial && r.segments[n].vertices.size() >= length) return n;
  }
  ADD_FAILURE() << "no such artificial segment";
  return 0;
}

std::size_t input_chain(const ExactRecord& r, std::size_t length) {
  for (std::size_t n = 0; n < r.segments.size(); ++n) {
    if (!r.segments[n].artificial && r.segments[n].vertices.size() >= length) return n;
  }
  ADD_FAILURE() << "no such segment";
  return 0;
}

Index chamfer_point(const ExactRecord& r, ExactPoint::Kind kind) {
  for (const auto& [point, vertex] : r.chamfer_points) {
    if (r.points[point].kind == kind) return point;
  }
  ADD_FAILURE() << "no such chamfer point";
  return 0;
}

void move_towards(ExactRecord& r, Index v, const std::array<Index, 2>& ends, double share) {
  ExactPoints points;
  points.assign(r.points);
  double* to[3] = {&r.points[v].x, &r.points[v].y, &r.points[v].z};
  for (int axis = 0; axis < 3; ++axis) {
    const double target = (points.nearest(ends[0])[axis] + points.nearest(ends[1])[axis]) / 2;
    *to[axis] += share * (target - *to[axis]);
  }
}

// Moves a volume vertex almost to the midpoint of an edge of a segment that it shares a tetrahedron
// with.
void encroach(ExactRecord& r) {
  std::set<std::pair<Index, Index>> edges;
  for (const auto& chain : r.segments) {
    for (std::size_t i = 1; i < chain.vertices.size(); ++i) {
      edges.insert({chain.vertices[i - 1], chain.vertices[i]});
    }
  }
  for (const auto& ball : r.balls) {
    for (const auto& tet : r.refined) {
      if (std::count(tet.vertices.begin(), tet.vertices.end(), ball.vertex) == 0) continue;
      for (const Index a : tet.vertices) {
        for (const Index b : tet.vertices) {
          if (edges.contains({a, b})) return move_towards(r, ball.vertex, {a, b}, 0.9375);
        }
      }
    }
  }
  ADD_FAILURE() << "no volume vertex beside a segment";
}

// Replaces two tetrahedra by the three around the edge between their apexes.
bool flip_some_face(const ExactRecord& r, std::vector<ExactRecord::Tet>& tets) {
  ExactPoints points;
  points.assign(r.points);
  TetComplex complex{&points, {}, {}, 0, 0};
  std::set<Face> constraints;
  for (const auto& [a, b, c, id] : r.final_facets) {
    Face face = {a, b, c};
    std::sort(face.begin(), face.end());
    constraints.insert(face);
  }
  for (const auto& tet : tets) complex.tetrahedra.push_back(tet.vertices);
  Neighbours neighbours;
  check_complex(complex, neighbours);
  for (Index i = 0; i < neighbours.across.size(); ++i) {
    const Index j = neighbours.across[i];
    if (j == kNone) continue;
    const Face f = face_of(complex.tetrahedra[i / 4], static_cast<int>(i % 4));
    Face sorted = f;
    std::sort(sorted.begin(), sorted.end());
    const Index p = complex.tetrahedra[i / 4][i % 4], q = complex.tetrahedra[j / 4][j % 4];
    bool convex = !constraints.contains(sorted);
    for (int k = 0; k < 3; ++k) {
      convex = convex && exact::orient3d(points, p, q, f[k], f[(k + 1) % 3]) > 0;
    }
    const auto& [a, b, c, d] = complex.tetrahedra[i / 4];
    if (!convex || exact::insphere(points, a, b, c, d, q) == 0) continue;
    const bool inside = tets[i / 4].inside;
    tets[i / 4] = {{p, q, f[0], f[1]}, inside};
    tets[j / 4] = {{p, q, f[1], f[2]}, inside};
    tets.push_back({{p, q, f[2], f[0]}, inside});
    return true;
  }
  return false;
}

const RecordDamage kRefinedDamages[] = {
    {"face no longer Delaunay", "refined-delaunay",
     [](auto& r) {
       const auto& tet = r.balls.at(0).tetrahedron;
       move_towards(r, first_volume_vertex(r), {tet[0], tet[0]}, 0x1p-3);
     }},
    {"angle shrunk below delta", "refined-angles",
     [](auto& r) {
       ExactPoints points;
       points.assign(r.points);
       for (const auto& tet : r.refined) {  // pull a volume vertex onto its neighbour, inside
         if (!tet.inside) continue;
         for (const Index v : tet.vertices) {
           const bool volume = std::any_of(r.balls.begin(), r.balls.end(),
                                           [v](const auto& ball) { return ball.vertex == v; });
           if (!volume) continue;
           const Index w = tet.vertices[0] == v ? tet.vertices[1] : tet.vertices[0];
           return move_towards(r, v, {w, w}, 0.9);
         }
       }
     }},
    {"promise of a larger angle", "refined-angles", [](auto& r) { r.parameters.delta = 40; }},
    {"tetrahedron missing at the outer box", "refined-hull",
     [](auto& r) {
       std::map<Face, std::vector<std::size_t>> of;
       for (std::size_t t = 0; t < r.refined.size(); ++t) {
         for (int i = 0; i < 4; ++i) {
           Face face = face_of(r.refined[t].vertices, i);
           std::sort(face.begin(), face.end());
           of[face].push_back(t);
         }
       }
       const auto outer = std::find_if(of.begin(), of.end(),
                                       [](const auto& face) { return face.second.size() == 1; });
       r.refined.erase(r.refined.begin() + static_cast<std::ptrdiff_t>(outer->second[0]));
     }},
    {"tetrahedron called inside that is not", "refined-contained",
     [](auto& r) {
       for (auto& tet : r.refined) tet.inside = true;
     }},
    {"face on another facet", "refined-facets",
     [](auto& r) { r.refined_facets[3][3] = (r.refined_facets[3][3] + 2) % 8; }},
    {"face torn out of a facet", "refined-facets",
     [](auto& r) { r.refined_facets.erase(r.refined_facets.begin() + 5); }},
    {"face listed twice", "refined-facets",
     [](auto& r) { r.refined_facets.push_back(r.refined_facets[7]); }},
    {"face turned over", "refined-facets",
     [](auto& r) { std::swap(r.refined_facets[7][0], r.refined_facets[7][1]); }},
    {"segment skips a vertex", "refined-segments",
     [](auto& r) {
       auto& chain = r.segments[input_chain(r, 3)].vertices;
       chain.erase(chain.begin() + 1);
     }},
    {"segment dropped", "refined-segments",
     [](auto& r) {
       r.segments.erase(r.segments.begin() + static_cast<std::ptrdiff_t>(input_chain(r, 2)));
     }},
    {"segment listed twice", "refined-segments",
     [](auto& r) { r.segments.push_back(r.segments[input_chain(r, 2)]); }},
    {"edge called chamfered that is not acute", "refined-chamfer-need",
     [](auto& r) {
       r.segments.erase(r.segments.begin() + static_cast<std::ptrdiff_t>(input_chain(r, 2)));
     }},
    {"artificial segment in another facet", "refined-segments",
     [](auto& r) {
       auto& chain = r.segments[artificial_chain(r, 2)];
       for (const auto& facet : r.facets) {
         if (facet.id != chain.facet && !facet.filtered) {
           chain.facet = facet.id;
           return;
         }
       }
     }},
    {"artificial segment bent", "refined-segments",
     [](auto& r) {
       const auto& chain = r.segments[artificial_chain(r, 3)].vertices;
       auto& p = r.points[chain[1]];
       ASSERT_EQ(p.kind, ExactPoint::Kind::on_triangle);
       p.x += 0x1p-9;
     }},
    {"chamfered corner not told", "refined-segments", [](auto& r) { r.corners.pop_back(); }},
    {"chamfer opened too wide along an edge", "refined-segments",
     [](auto& r) {
       for (auto& corner : r.corners) corner.distance *= 0.75;
     }},
    {"chamfer opened too wide inside a facet", "refined-chamfer-extent",
     [](auto& r) {
       for (auto& corner : r.corners) corner.distance *= 0.75;
     }},
    {"chamfer point for another corner", "refined-chamfer-extent",
     [](auto& r) { r.chamfer_points[0][1] = r.chamfer_points[0][1] == 0 ? 5 : 0; }},
    {"chamfer point outside its facet", "refined-chamfer-extent",
     [](auto& r) { r.points[chamfer_point(r, ExactPoint::Kind::on_triangle)].x = -0.25; }},
    {"promise of 90-degree corners", "refined-chamfer-angles",
     [](auto& r) { r.parameters.acute = 90; }},
    {"cut point moved until an angle is too small", "refined-chamfer-angles",
     [](auto& r) {
       // The cut on one edge three times as far as on the others.
       const Index point = chamfer_point(r, ExactPoint::Kind::on_segment);
       auto& p = r.points[point];
       for (const auto& [made, vertex] : r.chamfer_points) {
         if (made == point) p.x = p.i == vertex ? 1 - 3 * (1 - p.x) : 3 * p.x;
       }
     }},
    {"vertex moved into the ball of a segment", "refined-encroachment",
     [](auto& r) { encroach(r); }},
    {"Steiner point told to be for another ball", "refined-steiner-balls",
     [](auto& r) { r.balls.front().tetrahedron = r.balls.back().tetrahedron; }},
    {"facet that the filter dropped called kept", "refined-filter",
     [](auto& r) {
       for (auto& facet : r.facets) facet.filtered = false;
     }},
    {"facet called dropped that is near nothing", "refined-filter",
     [](auto& r) { std::ranges::find(r.facets, 0, &ExactRecord::Facet::filtered)->filtered = 1; }},
    {"facets called dropped for chamfers where nothing is sharp", "refined-filter",
     [](auto& r) {
       for (auto& facet : r.facets) facet.filtered *= 2;
     }},
    {"promise of a larger tolerance", "refined-filter",
     [](auto& r) { r.parameters.tolerance *= 256; }},
    {"facet called dropped that was not", "refined-facets",
     [](auto& r) {
       for (auto& facet : r.facets) {
         if (!facet.filtered) {
           facet.filtered = true;
           return;
         }
       }
     }},
    {"triangle listed with another facet", "refined-segments",
     [](auto& r) { r.facets[0].triangles.push_back(r.facets[1].triangles[0]); }},
};

class RefinedDamages : public testing::TestWithParam<RecordDamage> {};

TEST_P(RefinedDamages, AreCaughtByTheOracleMeantForThem) {
  MesherRun mutant = good_run();
  VerifyOptions options{.stage = Stage::refined, .promised = mutant.promise};
  static const VerifyReport good = run(mutant.sample, &mutant.record, options);
  ASSERT_TRUE(samples::exact_or_rounded(good)) << to_text(good);
  GetParam().apply(mutant.record);
  judge("refined wedge and slab", GetParam().name, GetParam().oracle,
        run(mutant.sample, &mutant.record, options));
}

INSTANTIATE_TEST_SUITE_P(All, RefinedDamages, testing::ValuesIn(kRefinedDamages),
                         test_name<RecordDamage>);

// A segment inside a facet whose inner vertices change places goes back and forth.
TEST(RefinedDamage, ASegmentThatTurnsBackIsSaidToDoSo) {
  MesherRun mutant = good_run();
  auto& chain = mutant.record.segments[artificial_chain(mutant.record, 4)].vertices;
  std::swap(chain[1], chain[2]);
  const VerifyReport report =
      run(mutant.sample, &mutant.record, {.stage = Stage::refined, .promised = mutant.promise});
  const auto& findings = report.find("refined-segments")->findings;
  EXPECT_TRUE(std::ranges::any_of(findings, [](const std::string& finding) {
    return finding.find("turns back") != std::string::npos;
  })) << to_text(report);
}

// The figures of the filter and the chamfer agree with the record, and the distance of a chamfer is
// at most a third of the local feature size (section 4.1).
TEST(RefinedFigures, AreThoseOfTheRecord) {
  const MesherRun& good = good_run();
  const VerifyReport report =
      run(good.sample, &good.record, {.stage = Stage::refined, .promised = good.promise});
  std::array<std::uint64_t, 3> facets{};
  for (const auto& facet : good.record.facets) ++facets.at(facet.filtered);
  EXPECT_GT(facets[1], 0U);
  const OracleReport& filter = *report.find("refined-filter");
  EXPECT_EQ(filter.figure("dropped facets"), facets[1] + facets[2]);
  EXPECT_EQ(filter.figure("dropped for what chamfering made of them"), facets[2]);
  EXPECT_EQ(filter.figure("tolerance"), good.record.parameters.tolerance);
  const OracleReport& need = *report.find("refined-chamfer-need");
  EXPECT_GT(good.record.corners.size(), 0U);
  EXPECT_EQ(need.figure("corners"), good.record.corners.size());
  const double distance = need.figure("largest distance over local feature size").value();
  EXPECT_GT(distance, 0);
  EXPECT_LE(distance, (1 + 1e-9) / 3);
}

// A tetrahedron with an edge of 1.2 across from one of 1.5, ten apart. No features are closer than
// the tolerance of 0.7. But bridges in the narrow corners, which are to be a third of 1.2 from
// their vertices and 0.15 / 1.5 of that long, are far below a sixteenth of it.
TEST(RefinedFigures, FacetsDroppedForTheirChamfersAreAccountedFor) {
  delmesher::Surface s;
  s.vertices = {{0, 0, 0}, {0, 0, 1.2}, {10, 0, 0}, {10, 1.5, 0}};
  s.triangles = {{0, 3, 2}, {0, 2, 1}, {0, 1, 3}, {1, 2, 3}};
  delmesher::Options options = samples::split_surface();
  options.want_exact = true;
  options.tau = 0.07;
  const delmesher::Result result = delmesher::tetrahedralize(s, options);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  std::array<std::uint64_t, 3> facets{};
  for (const auto& facet : result.exact.facets) ++facets.at(facet.filtered);
  EXPECT_EQ(facets[1], 0U);
  ASSERT_EQ(facets[2], 2U);
  const Sample sample = {samples::to_polyhedron(s), samples::to_mesh(result.mesh)};
  const VerifyReport report =
      run(sample, &result.exact, {.stage = Stage::refined, .promised = promise_of(options)});
  const OracleReport& filter = *report.find("refined-filter");
  EXPECT_TRUE(filter.passed()) << to_text(report);
  // Nothing is close among what the first step kept, which is the tetrahedron with its four corners
  // and six edges, and what the second dropped has a reason.
  EXPECT_EQ(filter.checked, 4U + 6U + facets[2]);
  EXPECT_EQ(filter.figure("dropped facets"), facets[2]);
  EXPECT_EQ(filter.figure("dropped for what chamfering made of them"), facets[2]);
}

TEST(ConstrainedDamage, AFlippedFaceIsCaught) {
  MesherRun mutant = good_run();
  const VerifyReport good = run(mutant.sample, &mutant.record, {.promised = mutant.promise});
  ASSERT_TRUE(samples::exact_or_rounded(good)) << to_text(good);
  ASSERT_NE(good.find("exact-constrained-delaunay"), nullptr);
  ASSERT_TRUE(mutant.record.unrepaired.empty());
  ASSERT_TRUE(flip_some_face(mutant.record, mutant.record.final));
  judge("final wedge and slab", "face flipped", "exact-constrained-delaunay",
        run(mutant.sample, &mutant.record, {.promised = mutant.promise}));
}

TEST(ConstrainedDamage, AfterRepairsOnlyWhatWasBeforeIsAGate) {
  MesherRun mutant = good_run();
  mutant.record.unrepaired = mutant.record.final;
  ASSERT_TRUE(flip_some_face(mutant.record, mutant.record.final));
  const VerifyReport counted = run(mutant.sample, &mutant.record, {.promised = mutant.promise});
  EXPECT_TRUE(counted.find("exact-constrained-delaunay")->passed()) << to_text(counted);
  EXPECT_GT(counted.find("exact-constrained-delaunay")->figures[0].second, 0);
  // There was nothing to be repaired.
  judge("final wedge and slab", "face flipped as if to repair", "repairs", counted);
  mutant = good_run();
  mutant.record.unrepaired = mutant.record.final;
  ASSERT_TRUE(flip_some_face(mutant.record, mutant.record.unrepaired));
  judge("final wedge and slab", "face flipped before repairs", "unrepaired-constrained-delaunay",
        run(mutant.sample, &mutant.record, {.promised = mutant.promise}));
}

TEST(ConstrainedDamage, FacesOnFacetsBeforeRepairsAreChecked) {
  MesherRun mutant = good_run();
  mutant.record.unrepaired = mutant.record.final;
  mutant.record.unrepaired_facets = mutant.record.final_facets;
  const VerifyReport good = run(mutant.sample, &mutant.record, {.promised = mutant.promise});
  ASSERT_TRUE(samples::exact_or_rounded(good)) << to_text(good);
  ASSERT_NE(good.find("unrepaired-facets"), nullptr);
  mutant.record.unrepaired_facets.pop_back();
  judge("final wedge and slab", "face on a facet before repairs missing", "unrepaired-facets",
        run(mutant.sample, &mutant.record, {.promised = mutant.promise}));
  mutant = good_run();
  mutant.record.unrepaired = mutant.record.final;
  mutant.record.unrepaired_facets = mutant.record.final_facets;
  for (auto& tet : mutant.record.unrepaired) tet.inside = true;
  judge("final wedge and slab", "no surface before repairs", "unrepaired-conformity",
        run(mutant.sample, &mutant.record, {.promised = mutant.promise}));
}

}  // namespace
}  // namespace tetproof
