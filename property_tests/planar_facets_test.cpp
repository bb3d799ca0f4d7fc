// Facets that are planar but for rounding, from surface to verdict: rotated and jittered solids
// keep every promise with as few facets as before, and lies about the planes of a record are caught
// by the oracle meant for it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <set>

#include "mesher/delmesher.h"
#include "mesher/surface/test_surfaces.h"
#include "oracles/verify.h"
#include "property_tests/samples.h"
#include "property_tests/score_table.h"

namespace tetproof {
namespace {

using namespace oracles;  // NOLINT
namespace test_surfaces = delmesher::surface::test_surfaces;
using delmesher::ExactPoint;
using delmesher::ExactRecord;
using delmesher::Options;
using delmesher::Surface;

// In doubles; then applies `round` to every coordinate.
Surface rotated(const Surface& surface, const std::function<double(double)>& round) {
  Surface s = test_surfaces::rotated(surface);
  for (Position& p : s.vertices) {
    for (double& x : p) x = round(x);
  }
  return s;
}

double as_it_is(double x) {
  return x;
}
double to_single(double x) {
  const double large = std::ldexp(x < 0 ? -1.5 : 1.5, std::ilogb(x) + 29);
  return (x + large) - large;
}
double to_six_digits(double x) {
  return std::round(x * 1e6) / 1e6;
}

// Stairs of four steps with a square hole through the second: flat faces of many triangles, concave
// edges.
Surface stairs() {
  return samples::to_surface(samples::grid_sample(4, 1, [](int x, int y, int z) {
                               return (x != 1 || y != 1) && z <= x;
                             }).input);
}

struct Told {
  samples::Sample sample;
  ExactRecord record;
  Promise promise;
  unsigned version = kRecordVersion;
  delmesher::Statistics statistics;
};

Told run_with(const Surface& surface, Options options) {
  options.want_exact = true;
  const delmesher::Result result = delmesher::tetrahedralize(surface, options);
  EXPECT_TRUE(result.status.ok()) << result.status.message;
  return {{samples::to_polyhedron(surface), samples::to_mesh(result.mesh)},
          result.exact,
          promise_of(options),
          kRecordVersion,
          result.statistics};
}

Told run_of(const Surface& surface, double planar = delmesher::kPlanarAuto) {
  Options options;
  options.planar = planar;
  return run_with(surface, options);
}

VerifyReport verdict_on(const Told& told, bool with_record = true) {
  VerifyReport report;
  EXPECT_EQ(verify(told.sample.input, told.sample.mesh, with_record ? &told.record : nullptr,
                   {.stage = with_record ? Stage::both : Stage::final,
                    .promised = told.promise,
                    .record_version = told.version},
                   report),
            "");
  return report;
}

// ------------------------------------------------------------------------------------- what holds

struct Rounding {
  const char* name;
  double (*round)(double);
};
void PrintTo(const Rounding& rounding, std::ostream* out) {
  *out << rounding.name;
}

class Rotated : public testing::TestWithParam<Rounding> {};
INSTANTIATE_TEST_SUITE_P(By, Rotated,
                         testing::Values(Rounding{"doubles", as_it_is},
                                         Rounding{"single", to_single},
                                         Rounding{"decimals", to_six_digits}),
                         [](const auto& tested) { return std::string(tested.param.name); });

TEST_P(Rotated, PartsKeepTheirFacetsAndEveryPromise) {
  // The first is verified with its record, which takes the longest.
  const std::vector<Surface> parts = {stairs(), samples::random_voxels(3)};
  for (const Surface& part : parts) {
    const Told straight = run_of(part), turned = run_of(rotated(part, GetParam().round));
    EXPECT_EQ(straight.statistics.planar_groups, 0U);
    EXPECT_GT(turned.statistics.planar_groups, 0U);
    EXPECT_GT(turned.statistics.given_facets, straight.statistics.facets);
    EXPECT_EQ(turned.statistics.facets, straight.statistics.facets);
    EXPECT_FALSE(turned.record.planes.empty());
    // Half as many again would be no surprise for other coordinates; facets of noise cost ten times
    // as much.
    EXPECT_LT(turned.statistics.final.tetrahedra, 2 * straight.statistics.final.tetrahedra);
    for (const bool with_record : {&part == &parts.front(), false}) {
      const VerifyReport report = verdict_on(turned, with_record);
      EXPECT_FALSE(failed(report, {.promised = turned.promise})) << to_text(report);
      EXPECT_TRUE(!with_record || samples::as_promised(report, turned.promise)) << to_text(report);
    }
    // All vertices are in the mesh as given.
    std::vector<Position> written = turned.sample.mesh.vertices;
    std::sort(written.begin(), written.end());
    for (const Position& p : turned.sample.input.vertices) {
      EXPECT_TRUE(std::binary_search(written.begin(), written.end(), p));
    }
  }
}

// Facets that were flat still are, up to the changes of their vertices, and nothing else changes.
void expect_the_facets_of(const Surface& part, const Surface& changed) {
  const Told straight = run_of(part), told = run_of(changed);
  EXPECT_GT(told.statistics.planar_groups, 0U);
  EXPECT_GT(told.statistics.given_facets, straight.statistics.facets);
  EXPECT_EQ(told.statistics.facets, straight.statistics.facets);
  const VerifyReport report = verdict_on(told);
  const OracleReport* again = report.find("exact-second-kernel");
  ASSERT_NE(again, nullptr);
  EXPECT_GT(again->checked, told.record.points.size() + told.record.final.size());
  EXPECT_TRUE(samples::as_promised(report, told.promise)) << to_text(report);
}

TEST(Jittered, ByAnUlpFacetsStay) {
  Surface jittered = stairs();
  std::mt19937 random(11);
  for (auto& p : jittered.vertices) {
    for (double& x : p) {
      const auto step = static_cast<int>(random() % 3) - 1;
      if (step != 0) x = std::nextafter(x, step * HUGE_VAL);
    }
  }
  expect_the_facets_of(stairs(), jittered);
}

TEST(Split, AtRoundedPointsFacetsStay) {
  Surface split = rotated(stairs(), as_it_is);
  std::mt19937 random(12);
  for (int n = 0; n < 12; ++n) {
    const std::size_t t = random() % split.triangles.size();
    const auto [a, b, c] = split.triangles[t];
    const double u = 0.2 + 0.1 * static_cast<double>(random() % 4), v = 0.17;
    std::array<double, 3> p{};
    for (std::size_t i = 0; i < 3; ++i) {
      p[i] =
          u * split.vertices[a][i] + v * split.vertices[b][i] + (1 - u - v) * split.vertices[c][i];
    }
    const auto m = static_cast<std::uint32_t>(split.vertices.size());
    split.vertices.push_back(p);
    split.triangles[t] = {a, b, m};
    split.triangles.push_back({b, c, m});
    split.triangles.push_back({c, a, m});
  }
  expect_the_facets_of(stairs(), split);
}

// Refined as with planar facets, and put back: the surface as given, at hardly more tetrahedra.
TEST_P(Rotated, WithPlanarZeroTheSurfaceIsKeptToTheLastBit) {
  const Told straight = run_of(stairs()), told = run_of(rotated(stairs(), GetParam().round), 0);
  EXPECT_GT(told.statistics.planar_groups, 0U);
  EXPECT_FALSE(told.record.planes.empty());
  EXPECT_LT(told.statistics.final.tetrahedra, 3 * straight.statistics.final.tetrahedra);
  std::set<std::uint32_t> refined, final;
  for (const auto& face : told.record.refined_facets) refined.insert(face[3]);
  for (const auto& face : told.record.final_facets) final.insert(face[3]);
  EXPECT_EQ(final.size(), told.statistics.given_facets);
  EXPECT_LT(refined.size(), final.size());
  const VerifyReport report = verdict_on(told);
  EXPECT_TRUE(samples::exact_or_rounded(report)) << to_text(report);
  EXPECT_TRUE(samples::as_promised(report, told.promise)) << to_text(report);
  // More than was promised is a pass, too.
  Told more = told;
  more.promise.planar = delmesher::kPlanarAuto;
  const VerifyReport of_more = verdict_on(more);
  EXPECT_TRUE(samples::as_promised(of_more, more.promise)) << to_text(of_more);
}

// Its two ends are fans of needles on an ellipse.
Surface flat_prism(std::uint32_t n, double height, double width) {
  return test_surfaces::prism(test_surfaces::ellipse(n, width), height);
}

struct Part {
  Surface surface;
  std::uint64_t most;  // tetrahedra
};

void expect_kept(const Part& part, bool anew) {
  const Told told = run_of(part.surface, 0);
  EXPECT_EQ(told.statistics.planar_anew, anew);
  EXPECT_FALSE(told.statistics.planar_given_up);
  EXPECT_FALSE(told.record.planes.empty());
  EXPECT_LT(told.statistics.final.tetrahedra, part.most);
  const VerifyReport report = verdict_on(told);
  EXPECT_TRUE(samples::exact_or_rounded(report)) << to_text(report);
  EXPECT_TRUE(samples::as_promised(report, told.promise)) << to_text(report);
}

// By local operations edges find no place. With every bend refined, it takes 9 925 tetrahedra.
TEST(PlanarZero, WhatDoesNotGoBackIsTetrahedrizedAnew) {
  expect_kept({rotated(flat_prism(36, 0.05, 0.5), to_single), 4000}, true);
}

// There are edges that cross a facet's edge at which tetrahedra are flatter than the surface bends
// there, or that vertices of the stand-in were moved by more than those are thick. Tetrahedrized
// anew, they take 175, 251 and 1 468 tetrahedra.
TEST(PlanarZero, EdgesComeBackThroughFlatTetrahedra) {
  for (const Part& part : {Part{rotated(flat_prism(12, 0.5, 0.3), as_it_is), 120},
                           Part{rotated(flat_prism(16, 2, 1), as_it_is), 200},
                           Part{rotated(flat_prism(12, 2, 0.05), to_single), 1200}}) {
    expect_kept(part, false);
  }
}

// The cavity of a crossing reaches other faces of the facet, or there is no room for one before
// vertices of the facet have moved, or other edges have come back. Tetrahedrized anew, these take
// 597, 533, 702 and 3 461 tetrahedra.
TEST(PlanarZero, EdgesComeBackOverOtherFacesOfTheirFacet) {
  for (const Part& part : {Part{rotated(flat_prism(12, 0.1, 0.05), as_it_is), 500},
                           Part{rotated(flat_prism(8, 0.1, 0.05), as_it_is), 450},
                           Part{rotated(flat_prism(16, 2, 0.3), to_single), 600},
                           Part{rotated(flat_prism(16, 0.02, 0.05), as_it_is), 3000}}) {
    expect_kept(part, false);
  }
}

// With all of the points that their return takes, these have 1 828, 394 and 703 tetrahedra.
TEST(PlanarZero, PointsOnEdgesThatCameBackAreSpared) {
  for (const Part& part : {Part{rotated(flat_prism(16, 0.02, 0.05), as_it_is), 1000},
                           Part{rotated(flat_prism(16, 2, 0.3), to_single), 380},
                           Part{rotated(flat_prism(24, 0.1, 0.05), to_single), 600}}) {
    expect_kept(part, false);
  }
}

// Between edges that come back, tetrahedra may be positive as doubles, but not exactly.
// Tetrahedrized anew, these take 2 682 and 3 712 tetrahedra.
TEST(PlanarZero, FlatTetrahedraFitTheSurfaceAsGiven) {
  for (const Part& part : {Part{rotated(flat_prism(8, 0.02, 1), as_it_is), 2600},
                           Part{rotated(flat_prism(24, 0.02, 1), as_it_is), 3200}}) {
    expect_kept(part, false);
  }
}

// What comes back makes no edge longer than what is wanted, and fits into a mesh of the hull.
TEST(PlanarZero, KeepsLongestEdgeAndHull) {
  for (const double max_edge : {0.7, 0.3}) {
    for (const delmesher::Region region : {delmesher::Region::interior, delmesher::Region::hull}) {
      Options options;
      options.planar = 0;
      options.max_edge = max_edge;
      options.region = region;
      const Told told = run_with(rotated(stairs(), to_single), options);
      EXPECT_GT(told.statistics.planar_groups, 0U) << "refined without planar facets";
      const VerifyReport report = verdict_on(told);
      EXPECT_TRUE(samples::as_promised(report, told.promise)) << to_text(report);
    }
  }
}

// ------------------------------------------------------------------------------------------- lies

const Told& honest() {
  static const Told told = run_of(rotated(stairs(), to_single));
  return told;
}

const Told& as_given() {
  static const Told told = run_of(rotated(stairs(), to_single), 0);
  return told;
}

std::size_t moved_vertex(const ExactRecord& record) {
  for (std::size_t v = 0; v < record.points.size(); ++v) {
    if (record.points[v].kind == ExactPoint::Kind::on_planes) return v;
  }
  ADD_FAILURE() << "no vertex was moved";
  return 0;
}

// Puts a point before others; all numbers of points follow.
void insert_point(ExactRecord& r, Index at, const ExactPoint& point) {
  const auto move = [at](auto& list) {
    for (Index& v : list) v += v >= at ? 1 : 0;
  };
  for (ExactPoint& p : r.points) {
    if (p.kind == ExactPoint::Kind::explicit_point || p.kind == ExactPoint::Kind::on_planes)
      continue;
    std::array<Index, 3> corners = {p.i, p.j, p.k};
    move(corners);
    p.i = corners[0];
    p.j = corners[1];
    p.k = corners[2];
  }
  r.points.insert(r.points.begin() + at, point);
  for (auto& chain : r.segments) move(chain.vertices);
  for (auto& made : r.chamfer_points) move(made);
  for (auto* tets : {&r.refined, &r.final, &r.unrepaired}) {
    for (auto& tet : *tets) move(tet.vertices);
  }
  for (auto* faces : {&r.refined_facets, &r.final_facets, &r.unrepaired_facets}) {
    for (auto& face : *faces) {
      for (int i = 0; i < 3; ++i) face[i] += face[i] >= at ? 1 : 0;
    }
  }
  for (auto& ball : r.balls) {
    ball.vertex += ball.vertex >= at ? 1 : 0;
    move(ball.tetrahedron);
  }
  move(r.mesh_vertices);
}

// The first point on an edge of the surface as given that the mesh before the edges came back did
// not use.
ExactPoint& point_that_came_with_an_edge(ExactRecord& r) {
  std::set<Index> before;
  for (const auto& tet : r.unrepaired) before.insert(tet.vertices.begin(), tet.vertices.end());
  for (const auto& face : r.final_facets) {
    for (int k = 0; k < 3; ++k) {
      ExactPoint& p = r.points[face[k]];
      if (p.kind == ExactPoint::Kind::on_segment && !before.contains(face[k])) return p;
    }
  }
  ADD_FAILURE() << "no edge needed a point";
  return r.points.back();
}

struct Lie {
  const char* name;
  const char* oracle;  // the one meant to catch it
  void (*tell)(Told&);
  const char* before = "";  // for the table: its fate before its row was there
};
void PrintTo(const Lie& lie, std::ostream* out) {
  *out << lie.name;
}

const Lie kLies[] = {
    {"facets are planar, promised was the surface as given", "exact-conformity",
     [](Told& t) { t.promise.planar = 0; }},
    {"the surface as given, refined as one of a larger bound", "promise",
     [](Told& t) {
       t = as_given();
       t.record.parameters.planar *= 1000;
     }},
    {"the surface as given, a face on a facet of the refined one", "exact-facets",
     [](Told& t) {
       t = as_given();
       std::set<std::uint32_t> listed;
       for (const auto& facet : t.record.facets) listed.insert(facet.id);
       for (auto& face : t.record.final_facets) {
         if (!listed.contains(face[3])) face[3] = *listed.begin();
       }
     }},
    {"the surface as given, its mesh before the edges came back", "exact-conformity",
     [](Told& t) {
       t = as_given();
       t.record.final = t.record.unrepaired;
       t.record.final_facets = t.record.unrepaired_facets;
     }},
    {"the surface as given, no bound for its refinement", "promise",
     [](Told& t) {
       t = as_given();
       t.record.parameters.planar = 0;
     }},
    {"the surface as given, a point of an edge that came back on another one", "exact-conformity",
     [](Told& t) {
       t = as_given();
       ExactPoint& p = point_that_came_with_an_edge(t.record);
       for (p.j = 0; p.j == p.i || t.record.points[p.j].kind != ExactPoint::Kind::on_planes;) ++p.j;
     }},
    {"the surface as given, a tetrahedron left out beside an edge that came back", "exact-volume",
     [](Told& t) {
       t = as_given();
       t.record.final.pop_back();
     }},
    {"the surface as given, the facets of that told to be the refined ones", "facet-list",
     [](Told& t) {
       t = as_given();
       std::set<std::uint32_t> listed;
       for (auto& facet : t.record.facets) {
         listed.insert(facet.id);
         facet.triangles.resize(1);
       }
       for (const auto& face : t.record.final_facets) {
         if (listed.insert(face[3]).second) t.record.facets.push_back({face[3], 0, 0, {face[3]}});
       }
     }},
    {"the surface as given, its stand-in farther away than told", "stand-in",
     [](Told& t) {
       t = as_given();
       t.record.parameters.planar *= 0x1p-20;
     }},
    {"the surface as given in all of the hull, which is not there", "exact-hull",
     [](Told& t) {
       t = as_given();
       t.promise.region = delmesher::Region::hull;
     }},
    {"the surface as given, told as version 4", "promise",
     [](Told& t) {
       t = as_given();
       t.version = 4;
     }},
    {"planar facets, and nothing outside them", "exact-hull",
     [](Told& t) { std::erase_if(t.record.final, [](const auto& tet) { return !tet.inside; }); }},
    {"a bound a thousand times as large", "promise",
     [](Told& t) { t.record.parameters.planar *= 1000; }},
    {"no bound for the planes", "promise", [](Told& t) { t.record.parameters.planar = 0; }},
    {"an infinite bound", "sidecar", [](Told& t) { t.record.parameters.planar = HUGE_VAL; }},
    {"a bound that is no number", "sidecar",
     [](Told& t) { t.record.parameters.planar = std::nan(""); }},
    {"a bound smaller than what was done", "stand-in",
     [](Told& t) { t.record.parameters.planar *= 0x1p-20; }},
    {"version 3, which has no planes", "promise", [](Told& t) { t.version = 3; }},
    {"a plane moved along its normal", "stand-in",
     [](Told& t) {
       for (int axis = 0; axis < 3; ++axis) {
         t.record.planes[0].through[0][axis] += 1e-3 * t.record.planes[0].normal[axis];
       }
     }},
    {"a plane tilted", "stand-in", [](Told& t) { t.record.planes[0].normal[0] += 1e-3; }},
    {"all planes gone", "sidecar", [](Told& t) { t.record.planes.clear(); }},
    {"a plane without a normal", "sidecar",
     [](Told& t) {
       t.record.planes[0].spanned = false;
       t.record.planes[0].normal = {0, 0, 0};
     }},
    {"a plane that is not finite", "sidecar",
     [](Told& t) { t.record.planes[0].through[0][1] = HUGE_VAL; }},
    {"a vertex on one plane thrice", "sidecar",
     [](Told& t) {
       ExactPoint& p = t.record.points[moved_vertex(t.record)];
       p.j = p.k = p.i;
     }},
    {"a vertex moved away as plain numbers", "sidecar",
     [](Told& t) {
       const std::size_t v = moved_vertex(t.record);
       ExactPoint& p = t.record.points[v];
       const Position& x = t.sample.input.vertices[v];
       p = {ExactPoint::Kind::explicit_point, 0, 0, 0, x[0] + 1e-9, x[1], x[2]};
     }},
    {"a vertex that is another's meeting point", "stand-in",
     [](Told& t) {
       const std::size_t v = moved_vertex(t.record);
       std::size_t w = v + 1;
       while (t.record.points[w].kind != ExactPoint::Kind::on_planes) ++w;
       t.record.points[v] = t.record.points[w];
     }},
    {"another triangulation across a sharp edge", "stand-in",
     [](Told& t) {
       t.record.triangles = t.sample.input.triangles;
       std::swap(t.record.triangles.front(), t.record.triangles.back());
     }},
    {"a point on planes that is no vertex", "sidecar",
     [](Told& t) { t.record.points.push_back(t.record.points[moved_vertex(t.record)]); }},
    {"too few triangles", "sidecar",
     [](Told& t) {
       t.record.triangles = t.sample.input.triangles;
       t.record.triangles.pop_back();
     }},
    {"the moved vertices written", "rounding",
     [](Told& t) {
       ExactPoints points;
       points.assign(t.record.points, t.record.planes);
       for (std::size_t i = 0; i < t.record.mesh_vertices.size(); ++i) {
         t.sample.mesh.vertices[i] = points.nearest(t.record.mesh_vertices[i]);
       }
     }},
    {"a vertex on a plane that does not exist", "sidecar",
     [](Told& t) { t.record.points[moved_vertex(t.record)].k = 4294967295U; }},
    {"a moved vertex told to be as given", "facet-list",
     [](Told& t) {
       const std::size_t v = moved_vertex(t.record);
       const Position& x = t.sample.input.vertices[v];
       t.record.points[v] = {ExactPoint::Kind::explicit_point, 0, 0, 0, x[0], x[1], x[2]};
     }},
    {"planes of two facets exchanged", "sidecar",
     [](Told& t) { std::swap(t.record.planes.front(), t.record.planes.back()); }},
    {"facets made planar within less than promised now", "promise",
     [](Told& t) { t.promise.planar = 1e-12; }},
    {"two facets told to be one", "facet-list",
     [](Told& t) {
       auto& facets = t.record.facets;
       auto& first = facets.front().triangles;
       first.insert(first.end(), facets.back().triangles.begin(), facets.back().triangles.end());
       facets.pop_back();
     }},
    {"a vertex of no triangle moved", "stand-in",
     [](Told& t) {
       const auto v = static_cast<Index>(t.sample.input.vertices.size());
       t.sample.input.vertices.push_back({0, 0, 0});
       ExactPoint moved = t.record.points[moved_vertex(t.record)];
       insert_point(t.record, v, moved);
     },
     "passed"},
    {"a vertex moved none of whose facets has two triangles", "stand-in",
     [](Told& t) {
       delmesher::Surface s;
       s.vertices = {{1, 1, 1}, {3, 1, 1}, {1, 3, 1}, {1, 1, 3}};
       s.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
       t = run_of(s);
       ExactRecord& r = t.record;
       const auto first = static_cast<Index>(r.planes.size());
       for (std::size_t axis = 0; axis < 3; ++axis) {
         ExactRecord::Plane plane;
         plane.normal[axis] = 1;
         plane.through[0] = {1 - 0x1p-12, 1 - 0x1p-12, 1 - 0x1p-12};
         r.planes.push_back(plane);
       }
       r.points[0] = {ExactPoint::Kind::on_planes, first, first + 1, first + 2, 0, 0, 0};
       r.parameters.planar = 0x1p-19;
     },
     "passed"},
    {"moved triangles that bound nothing", "sidecar",
     [](Told& t) {
       t.record.triangles = t.sample.input.triangles;
       t.record.triangles.back()[0] = 4294967295U;
     },
     "called an invalid input"},
    {"labels merged", "boundary-list",
     [](Told& t) {
       t.sample.input.labels.assign(t.sample.input.triangles.size(), 1);
       t.sample.input.labels[0] = 2;
     }},
};

class PlanarLies : public testing::TestWithParam<Lie> {};

TEST_P(PlanarLies, AreCaughtByTheOracleMeantForThem) {
  static const VerifyReport good = verdict_on(honest());
  ASSERT_TRUE(samples::as_promised(good, honest().promise)) << to_text(good);
  ASSERT_EQ(good.verdict, Verdict::deviating);
  Told told = honest();
  GetParam().tell(told);
  judge("rotated stairs", GetParam().name, GetParam().oracle, verdict_on(told), GetParam().before);
}

INSTANTIATE_TEST_SUITE_P(Planes, PlanarLies, testing::ValuesIn(kLies), [](const auto& tested) {
  std::string name = tested.param.name;
  for (char& c : name) {
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  }
  return name;
});

// The mesh bends the box at its waist, so that edges between its walls are missing. United, the
// walls around the box would be one facet, whose normals cancel: none at all.
TEST(PlanarFile, WallsAroundABoxAreNoFacet) {
  samples::Sample stretched = samples::cube();
  const auto stretch = [](std::vector<Position>& vertices) {
    for (Position& p : vertices) p[2] *= 4;
  };
  stretch(stretched.input.vertices);
  stretch(stretched.mesh.vertices);
  samples::Sample bent = stretched;
  for (Position& p : bent.mesh.vertices) {
    if (p[2] == 2) p[0] += 0.125;
  }
  VerifyReport report;
  ASSERT_EQ(verify(stretched.input, stretched.mesh, nullptr, {}, report), "");
  EXPECT_EQ(report.verdict, Verdict::exact) << to_text(report);
  ASSERT_EQ(verify(bent.input, bent.mesh, nullptr, {.promised = {.planar = Promise::kPlanarAuto}},
                   report),
            "");
  EXPECT_EQ(report.verdict, Verdict::broken) << to_text(report);
}

// A vertex inside a face is 1e-6 off its plane. No planar facet explains that, since the face is
// planar as given: it is a deviation.
TEST(PlanarFile, AVertexOffItsFacetIsNoPlanarFacet) {
  samples::Sample sample = samples::cube();
  for (Position& p : sample.mesh.vertices) {
    if (p == Position{0.5, 0.5, 1}) p[2] += 1e-6;
  }
  VerifyReport report;
  const VerifyOptions options{.promised = {.planar = Promise::kPlanarAuto}};
  ASSERT_EQ(verify(sample.input, sample.mesh, nullptr, options, report), "");
  EXPECT_EQ(report.verdict, Verdict::deviating);
  EXPECT_TRUE(failed(report, options));
}

// A box with all faces bent along their diagonals: two triangles are one facet wherever the mesh
// has the other diagonal.
TEST(PlanarFile, FacetsThatWereUnitedAreCounted) {
  Surface box = samples::to_surface(samples::cube().input);
  std::mt19937 random(5);
  for (auto& p : box.vertices) {
    for (double& x : p) x += static_cast<double>(random() % 1024) * 0x1p-36;
  }
  ASSERT_EQ(box.triangles.size(), 12U);
  const Told told = run_of(box);
  ASSERT_EQ(told.statistics.given_facets, 12U);
  ASSERT_EQ(told.sample.mesh.vertices.size(), 8U);
  std::set<std::pair<std::uint32_t, std::uint32_t>> missing;
  for (const auto& [a, b, c] : box.triangles) {
    for (const auto& edge : {std::minmax(a, b), std::minmax(b, c), std::minmax(c, a)}) {
      missing.emplace(edge.first, edge.second);
    }
  }
  for (const auto& t : told.sample.mesh.tetrahedra) {
    for (const std::uint32_t a : t) {
      for (const std::uint32_t b : t) missing.erase({a, b});
    }
  }
  ASSERT_FALSE(missing.empty());
  const VerifyReport report = verdict_on(told, false);
  const OracleReport* conformity = report.find("conformity");
  ASSERT_NE(conformity, nullptr);
  EXPECT_TRUE(std::ranges::any_of(conformity->figures, [&](const auto& figure) {
    return figure.first == "facets united" && figure.second == static_cast<double>(missing.size());
  })) << to_text(report);
}

// A plate of the width 2 and the length 4 whose top has a ridge along the middle.
Surface ridge(double height) {
  Surface s;
  for (const double y : {0.0, 4.0}) {
    for (const auto& [x, z] :
         {std::pair(-1.0, 0.0), {1.0, 0.0}, {1.0, 1.0}, {0.0, 1 + height}, {-1.0, 1.0}}) {
      s.vertices.push_back({x, y, z});
    }
  }
  for (std::uint32_t i = 0; i < 5; ++i) {
    const std::uint32_t j = (i + 1) % 5;
    s.triangles.push_back({i, j + 5, j});
    s.triangles.push_back({i, i + 5, j + 5});
  }
  for (std::uint32_t i = 1; i < 4; ++i) {
    s.triangles.push_back({0, i, i + 1});
    s.triangles.push_back({5, i + 6, i + 5});
  }
  return s;
}

// A ridge that the mesh does not have, in a file without record: the promise decides.
TEST(PlanarFile, ARidgeAboveTheBoundIsMissed) {
  Told told = run_of(ridge(1e-3), 1e-3);
  ASSERT_GT(told.statistics.planar_groups, 0U);
  const VerifyReport good = verdict_on(told, false);
  EXPECT_FALSE(failed(good, {.promised = told.promise})) << to_text(good);
  EXPECT_EQ(good.verdict, Verdict::deviating);
  EXPECT_GE(good.deviation, 4e-4);
  told.promise.planar = 1e-5;
  const VerifyReport report = verdict_on(told, false);
  EXPECT_TRUE(failed(report, {.promised = told.promise})) << to_text(report);
  // Nor does it help that a record names the two sides of the ridge as one facet.
  const VerifyReport named = verdict_on(told, true);
  ASSERT_NE(named.find("conformity"), nullptr);
  EXPECT_FALSE(named.find("conformity")->passed()) << to_text(named);
}

// A ridge that the mesh has elsewhere is off the surface, though a record names all triangles as
// one facet.
TEST(PlanarFile, ARecordMakesNoFacetOfABody) {
  Told told = run_of(ridge(1e-3), 0);
  ASSERT_TRUE(samples::exact_or_rounded(verdict_on(told)));
  for (Position& p : told.sample.mesh.vertices) {
    if (p[2] == 1 + 1e-3 && p[1] > 0) p[0] += 1e-3;
  }
  ExactRecord::Facet all = told.record.facets.front();
  for (const ExactRecord::Facet& facet : told.record.facets) {
    if (facet.id == all.id) continue;
    all.triangles.insert(all.triangles.end(), facet.triangles.begin(), facet.triangles.end());
  }
  told.record.facets = {all};
  told.promise.planar = 0.01;
  const VerifyReport report = verdict_on(told);
  EXPECT_EQ(report.slab, 0);
  EXPECT_TRUE(failed(report, {.promised = told.promise}));
}

}  // namespace
}  // namespace tetproof
