// Lies about the planes of a record, each caught by the oracle meant for it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "property_tests/lie.h"
#include "property_tests/planar/runs.h"
#include "property_tests/score_table.h"

namespace tetproof::planar {
namespace {

using namespace oracles;  // NOLINT
using delmesher::ExactPoint;
using delmesher::ExactRecord;
using delmesher::Options;
using delmesher::Surface;

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

// A bridge on two feet: flat faces with long, narrow triangles.
Surface bridge() {
  Surface s;
  s.vertices = {{75, 84.5, 8},  {125, 84.5, 8}, {75, 94.5, 8}, {120, 84.5, 5},
                {125, 94.5, 8}, {75, 84.5, 0},  {80, 84.5, 5}, {125, 84.5, 0},
                {125, 94.5, 0}, {80, 94.5, 5},  {75, 94.5, 0}, {120, 94.5, 5},
                {120, 84.5, 0}, {80, 94.5, 0},  {80, 84.5, 0}, {120, 94.5, 0}};
  s.triangles = {{0, 1, 2},   {1, 0, 3},   {2, 1, 4},    {2, 5, 0},   {0, 6, 3},   {1, 3, 7},
                 {1, 8, 4},   {4, 9, 2},   {10, 5, 2},   {5, 6, 0},   {6, 11, 3},  {3, 12, 7},
                 {7, 8, 1},   {4, 8, 11},  {4, 11, 9},   {9, 10, 2},  {10, 13, 5}, {14, 6, 5},
                 {9, 11, 6},  {11, 12, 3}, {12, 8, 7},   {11, 8, 15}, {13, 10, 9}, {5, 13, 14},
                 {14, 13, 6}, {6, 13, 9},  {15, 12, 11}, {15, 8, 12}};
  return s;
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

// A bar whose faces are planar except for 2^-22, told as a bar that was made planar: an exact one,
// whose record and mesh are put onto the surface as given.
Told bar() {
  Surface exact;
  samples::add_box(exact, {0, 0, 0}, {8, 1, 1});
  Told told = run_of(exact, 0);
  ExactRecord& r = told.record;
  for (Index v = 0; v < exact.vertices.size(); ++v) {
    Position& x = told.sample.input.vertices[v];
    ExactPoint& p = r.points[v];
    p = {ExactPoint::Kind::on_planes, 0, 0, 0, 0, 0, 0};
    const auto plane_at = [&](std::size_t axis) {
      return static_cast<Index>(2 * axis + (x[axis] == 0 ? 0 : 1));
    };
    p.i = plane_at(0);
    p.j = plane_at(1);
    p.k = plane_at(2);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      x[axis] += 0x1p-24 * static_cast<double>((5 * v + 3 * axis) % 7);
    }
  }
  for (std::size_t side = 0; side < 6; ++side) {
    ExactRecord::Plane plane;
    plane.normal[side / 2] = 1;
    plane.through[0][side / 2] = side % 2 == 0 ? 0 : side / 2 == 0 ? 8 : 1;
    r.planes.push_back(plane);
  }
  r.parameters.planar = 0x1p-20;
  told.promise.planar = Promise::kPlanarAuto;
  return told;
}

// Writes the vertices where the record has them on the surface as given.
void write_as_given(Told& told) {
  std::vector<ExactPoint> definitions = told.record.points;
  const std::vector<ExactPoint> given = explicit_points(told.sample.input.vertices);
  std::copy(given.begin(), given.end(), definitions.begin());
  ExactPoints points;
  ASSERT_EQ(points.assign(definitions), "");
  for (std::size_t i = 0; i < told.record.mesh_vertices.size(); ++i) {
    told.sample.mesh.vertices[i] = points.nearest(told.record.mesh_vertices[i]);
  }
  Position low = told.sample.input.vertices[0], high = low;
  for (const Position& x : told.sample.input.vertices) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], x[axis]);
      high[axis] = std::max(high[axis], x[axis]);
    }
  }
  told.record.parameters.tolerance =
      told.promise.tau * std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
}

using Lie = LieAbout<Told>;

const Lie kLies[] = {
    {"facets are planar, promised was the surface as given", "exact-conformity",
     [](Told& t) { t.promise.planar = 0; }},
    {"the surface as given, refined as one of a larger bound", "promise",
     [](Told& t) {
       t = as_given();
       t.record.parameters.planar *= 1000;
     }},
    {"facets are planar, promised was --approximate of the surface as given", "promise",
     [](Told& t) {
       Options options;
       options.approximate = true;
       t = run_with(rotated(stairs(), to_single), options);
       t.promise.planar = 0;
     },
     "passed"},
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
    {"planar facets, not improved, and nothing outside them", "exact-hull",
     [](Told& t) {
       std::erase_if(t.record.final, [](const auto& tet) { return !tet.inside; });
       t.promise.improve = false;
     }},
    {"a bound a thousand times as large", "promise",
     [](Told& t) { t.record.parameters.planar *= 1000; }},
    {"a bound just above the most that auto may state", "promise",
     [](Told& t) {
       t.record.parameters.planar =
           1.001 * Promise::kMostAutomatic / 2 * t.statistics.bbox_diagonal;
     },
     "allowed more where coordinates have few digits"},
    {"a bound in the file smaller than what was done", "conformity",
     [](Told& t) { t.sample.mesh.planar_within *= 0x1p-20; }, "the file said nothing"},
    {"no bound for the planes", "promise", [](Told& t) { t.record.parameters.planar = 0; }},
    {"an infinite bound", "sidecar", [](Told& t) { t.record.parameters.planar = HUGE_VAL; }},
    {"a bound that is not a number", "sidecar",
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
    {"a vertex moved to where planes meet far away", "sidecar",
     [](Told& t) {
       const std::size_t v = moved_vertex(t.record);
       const auto first = static_cast<Index>(t.record.planes.size());
       ExactRecord::Plane plane;
       plane.through[0] = t.sample.input.vertices[v];
       for (const Position normal : {Position{1, 0, 0}, {0, 1, 0}, {1, 0, 0x1p-60}}) {
         plane.normal = normal;
         if (normal[2] != 0) plane.through[0][0] += 1;
         t.record.planes.push_back(plane);
       }
       t.record.points[v] = {ExactPoint::Kind::on_planes, first, first + 1, first + 2, 0, 0, 0};
     },
     "caught by stand-in, after long"},
    {"another triangulation across a sharp edge", "stand-in",
     [](Told& t) {
       t.record.triangles = t.sample.input.triangles;
       std::swap(t.record.triangles.front(), t.record.triangles.back());
     }},
    {"a point on planes that is not a vertex", "sidecar",
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
    {"points of a kept edge given beside others, parallel before they were put back", "conformity",
     [](Told& t) {
       t = bar();
       for (const auto& [a, b, c, id] : t.record.final_facets) {
         for (const Index v : {a, b, c}) {
           ExactPoint& p = t.record.points[v];
           // Of the edge from (0 0 0) to (8 0 0): from its first end along that from (0 1 0).
           if (p.kind != ExactPoint::Kind::on_segment || p.i + p.j != 1) continue;
           const double along = p.i == 0 ? 1 - p.x : p.x;
           p = {ExactPoint::Kind::on_triangle, 0, 2, 3, 1, along, 0};
         }
       }
       write_as_given(t);
     },
     "passed"},
    {"the surface as given, with the small angles of that, promised was another", "improvement",
     [](Told& t) {
       t = run_of(rotated(bridge(), to_single), 0);
       t.promise.planar = Promise::kPlanarAuto;
     },
     "passed"},
    {"a plane that no vertex is on", "sidecar",
     [](Told& t) { t.record.planes.push_back(t.record.planes.front()); }, "passed"},
    {"labels merged", "boundary-list",
     [](Told& t) {
       t.sample.input.labels.assign(t.sample.input.triangles.size(), 1);
       t.sample.input.labels[0] = 2;
     }},
};

// What the last lie but one is told of.
TEST(PlanarTruths, ABarPutOntoTheSurfaceAsGivenPasses) {
  Told told = bar();
  write_as_given(told);
  const VerifyReport report = verdict_on(told);
  EXPECT_TRUE(samples::as_promised(report)) << to_text(report);
}

class PlanarLies : public testing::TestWithParam<Lie> {};

TEST_P(PlanarLies, AreCaughtByTheOracleMeantForThem) {
  static const VerifyReport good = verdict_on(honest());
  ASSERT_TRUE(samples::as_promised(good)) << to_text(good);
  ASSERT_EQ(good.verdict, Verdict::deviating);
  Told told = honest();
  GetParam().tell(told);
  judge("rotated stairs", GetParam().name, GetParam().oracle, verdict_on(told), GetParam().before);
}

INSTANTIATE_TEST_SUITE_P(Planes, PlanarLies, testing::ValuesIn(kLies), test_name<Lie>);

}  // namespace
}  // namespace tetproof::planar
