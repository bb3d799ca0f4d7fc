// Lies: promises in the record that are laxer than those of the options.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "oracles/files/edge_nodes.h"
#include "property_tests/lies/told.h"

namespace tetproof::lies {
namespace {

using namespace oracles;  // NOLINT
using delmesher::ExactRecord;
using delmesher::Options;

// The chamfers of a small radius, with the distances that wider ones would have.
void told_wider(Told& t) {
  Options options = honest_options();
  options.chamfer_radius = 0x1p-6;
  const auto wide = t.record.corners;
  t = run_of(options);
  t.promise.chamfer_radius = 0;
  ASSERT_EQ(t.record.corners.size(), wide.size());
  t.record.corners = wide;
}

// A bar between two slanted ends. At its edge from 0 to 4 two sides meet at 75 degrees, and the
// ends of that edge are acute in any case, below 60 degrees.
delmesher::Surface slanted_bar() {
  const Position a{0, 0, 0}, b{0.396484375, 0.3046875, 0.29736328125},
      c{0.7998046875, 0, 0.599853515625}, d{0.396484375, -0.3046875, 0.29736328125};
  delmesher::Surface s;
  s.vertices = {a, b, c, d};
  for (const Position& p : {a, b, c, d}) s.vertices.push_back({p[0], p[1], 4 - p[2]});
  for (const auto& [i, j, k, l] : std::initializer_list<std::array<Index, 4>>{
           {0, 1, 2, 3}, {4, 7, 6, 5}, {0, 3, 7, 4}, {3, 2, 6, 7}, {2, 1, 5, 6}, {1, 0, 4, 5}}) {
    s.triangles.push_back({i, j, k});
    s.triangles.push_back({i, k, l});
  }
  return s;
}

// A run in which sides were dropped for narrow gaps that cutting off edges leaves.
void run_without_sides(Told& t) {
  Options options = honest_options();
  options.chamfer_radius = 0.01;
  options.tau = 0.002;
  options.acute = 90;
  t = run_of(options, Task::mesh, slanted_bar());
  EXPECT_GT(std::ranges::count(t.record.facets, 2, &ExactRecord::Facet::filtered), 0);
}

const Lie kRelaxed[] = {
    {"delta relaxed to nothing", "promise", [](Told& t) { t.record.parameters.delta = 0x1p-20; }},
    {"threshold of corners relaxed", "promise", [](Told& t) { t.record.parameters.acute = 1; }},
    {"threshold of two edges relaxed", "promise", [](Told& t) { t.record.parameters.corner = 0; }},
    {"no empty balls", "promise", [](Told& t) { t.record.parameters.gabriel = false; }},
    {"ten-node tetrahedra promised, the file has linear ones", "edge-nodes",
     [](Told& t) { t.promise.second_order = true; }, "passed"},
    {"linear tetrahedra promised, the file has ten-node ones", "edge-nodes",
     [](Told& t) {
       MeshFile& mesh = t.sample.mesh;
       for (const Tet& tet : mesh.tetrahedra) {
         for (const auto& [i, j] : kNodeEnds) {
           const Position &p = mesh.vertices[tet[i]], &q = mesh.vertices[tet[j]];
           mesh.edge_nodes.push_back(
               {{tet[i], tet[j]}, {p[0] / 2 + q[0] / 2, p[1] / 2 + q[1] / 2, p[2] / 2 + q[2] / 2}});
         }
       }
     },
     "passed"},
    {"another region", "promise",
     [](Told& t) { t.record.parameters.region = delmesher::Region::hull; }},
    {"tolerance doubled", "promise", [](Told& t) { t.record.parameters.tolerance *= 2; }},
    {"tolerance relaxed to nothing", "promise", [](Told& t) { t.record.parameters.tolerance = 0; }},
    {"tolerance doubled for a budget", "promise",
     [](Told& t) {
       t.promise.budget = 1e6;
       t.record.parameters.tolerance *= 2;
     }},
    {"chamfers up to right angles without empty balls", "promise",
     [](Told& t) {
       t.promise.gabriel = t.record.parameters.gabriel = false;
       t.record.parameters.acute = t.record.parameters.corner = 90;
     }},
    {"chamfers up to right angles, but not at corners of two edges", "promise",
     [](Told& t) { t.record.parameters.acute = 90; }},
    {"radii of 2^60", "refined-chamfer-need",
     [](Told& t) {
       for (auto& corner : t.record.corners) corner.distance = 0x1p60;
     }},
    {"a distance half as large again", "refined-chamfer-need",
     [](Told& t) { t.record.corners.front().distance *= 1.5; }},
    {"a distance of nothing", "refined-chamfer-need",
     [](Told& t) { t.record.corners.front().distance = 0; }},
    {"all relaxed at once", "promise",
     [](Told& t) {
       t.record.parameters = {};
       t.record.parameters.tolerance = 0x1p60;
     }},
    {"delta that is not a number", "sidecar",
     [](Told& t) { t.record.parameters.delta = std::nan(""); }},
    {"delta infinite", "sidecar", [](Told& t) { t.record.parameters.delta = HUGE_VAL; }},
    {"delta that the mesh does not have", "refined-angles",
     [](Told& t) { t.record.parameters.delta = 30; }},
    {"threshold of corners infinite", "sidecar",
     [](Told& t) { t.record.parameters.acute = HUGE_VAL; }},
    {"threshold of corners above a right angle", "promise",
     [](Told& t) { t.record.parameters.acute = t.record.parameters.corner = 120; }},
    {"tolerance that is not a number", "sidecar",
     [](Told& t) { t.record.parameters.tolerance = std::nan(""); }},
    {"tolerance negative", "promise",
     [](Told& t) { t.record.parameters.tolerance = -t.record.parameters.tolerance; }},
    {"tolerance denormal", "promise", [](Told& t) { t.record.parameters.tolerance = 0x1p-1070; }},
    {"a distance that is not a number", "sidecar",
     [](Told& t) { t.record.corners.front().distance = std::nan(""); }},
    {"a distance negative", "refined-chamfer-need",
     [](Told& t) { t.record.corners.front().distance *= -1; }},
    {"a distance denormal", "refined-chamfer-extent",
     [](Told& t) { t.record.corners.front().distance = 0x1p-1070; }},
    {"empty balls that the mesh does not have", "refined-encroachment",
     [](Told& t) {
       Options options = honest_options();
       options.gabriel = false;
       t = run_of(options);
       t.record.parameters.gabriel = true;
     }},
    {"a threshold of two edges stricter than asked for", "promise",
     [](Told& t) { t.record.parameters.corner += 1; }, "passed"},
    {"delta stricter than asked for", "promise", [](Told& t) { t.record.parameters.delta += 0.01; },
     "caught by refined-angles"},
    {"threshold of corners between what was asked for and a right angle", "promise",
     [](Told& t) { t.record.parameters.acute = 61; }},
    {"a bound of planar facets, of which there are none", "promise",
     [](Told& t) { t.record.parameters.planar = 0x1p-40; }, "passed"},
    {"a denormal bound of planar facets, of which there are none", "promise",
     [](Told& t) { t.record.parameters.planar = 0x1p-1074; }, "passed"},
    {"a bound of planar facets below nothing", "promise",
     [](Told& t) { t.record.parameters.planar = -0x1p-30; }},
    {"a facet dropped beside an edge that is not acute", "refined-filter",
     [](Told& t) {
       run_without_sides(t);
       t.promise.acute = t.record.parameters.acute = 60;
     },
     "passed"},
    {"chamfers up to right angles, which the mesh does not have", "refined-chamfer-angles",
     [](Told& t) { t.record.parameters.acute = t.record.parameters.corner = 90; }},
    {"a distance a ten-thousandth smaller", "refined-chamfer-extent",
     [](Told& t) { t.record.corners.front().distance *= 0.9999; }},
    {"distances up to the radius that was promised, not where the cuts are", "refined-segments",
     [](Told& t) {
       Options options = honest_options();
       options.chamfer_radius = 0x1p-5;
       t = run_of(options);
       for (auto& corner : t.record.corners) {
         corner.distance = std::min(1.05 * corner.distance, 0x1p-5);
       }
     },
     "passed"},
    {"chamfers of a small radius, told to be as wide as they might be", "refined-segments",
     told_wider, "caught by refined-filter"},
    {"the same, seen by the points of bridges", "refined-chamfer-extent", told_wider,
     "caught by refined-filter"},
    {"delta denormal", "promise", [](Told& t) { t.record.parameters.delta = 0x1p-1070; }},
    // Done in the mesher's own way, and told to be as the paper says.
    {"chamfers beyond a third of the way to the link", "refined-chamfer-need",
     [](Told& t) { t.promise.link = true; }},
    {"chamfers that no triangle bounds", "refined-chamfer-need",
     [](Told& t) { t.promise.bridges = true; }},
    {"Steiner points nearer to the shortest edge than the circumcentre", "refined-steiner-balls",
     [](Told& t) { t.promise.steiner_point = true; }},
    {"a ball of another tetrahedron, its centre elsewhere", "refined-steiner-balls",
     [](Told& t) {
       Options options = honest_options();
       options.as_paper.steiner_point = true;
       t = run_of(options);
       ExactPoints points;
       points.assign(t.record.points);
       for (auto& ball : t.record.balls) {
         for (Index v = 0; v < points.size(); ++v) {
           const auto [a, b, c, d] = ball.tetrahedron;
           const bool other = v != a && v != b && v != c && v != d && v != ball.vertex;
           const int sign = exact::orient3d(points, v, b, c, d);
           if (!other || sign * exact::insphere(points, v, b, c, d, ball.vertex) <= 0) continue;
           ball.tetrahedron[0] = v;
           return;
         }
       }
       ADD_FAILURE() << "no other ball has the vertex inside";
     }},
    {"points on artificial segments left out", "enrichment",
     [](Told& t) { t.promise.kept_points = true; }},
    {"one side of a close pair kept", "refined-filter",
     [](Told& t) { t.promise.filter_pairs = true; }},
    {"dropped for chamfers below tau, told to be below a 16th of it", "refined-filter",
     [](Told& t) {
       Options options = honest_options();
       options.tau = 0x1p-5;
       options.as_paper.filter_chamfered = true;
       t = run_of(options);
       t.promise.filter_chamfered = false;
     }},
    {"dropped for a gap that is not long", "refined-filter",
     [](Told& t) {
       Options options = honest_options();
       options.tau = 2 / std::hypot(200, 200, 3);
       options.as_paper.filter_chamfered = true;
       t = run_of(options, oracles::Task::mesh,
                  samples::triangular_prism({{{0, 0}, {200, 0}, {200, 3}}}, 0, 200));
       t.promise.filter_chamfered = false;
     }},
    {"left as it was, though it was to be enriched", "enrichment",
     [](Told& t) {
       t = run_of(honest_options(), oracles::Task::mesh,
                  {{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}},
                   {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}},
                   {}});
       t.promise.enrichment = true;
     }},
    {"chamfers up to right angles without a guard", "promise",
     [](Told& t) {
       t.promise.no_guard = true;
       t.record.parameters.acute = t.record.parameters.corner = 90;
     }},
    {"empty balls that were not asked for, without chamfers up to right angles", "promise",
     [](Told& t) { t.promise.gabriel = false; }, "passed"},
    {"empty balls without a guard, not asked for", "promise",
     [](Told& t) {
       t.promise.no_guard = true;
       t.promise.gabriel = false;
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

}  // namespace

std::span<const Lie> relaxed() {
  return kRelaxed;
}

}  // namespace tetproof::lies
