// Lies about local operations: the mesh before them, and the improved mesh.
#include <gtest/gtest.h>

#include <algorithm>
#include <span>
#include <utility>

#include "property_tests/lies/told.h"

namespace tetproof::lies {
namespace {

using namespace oracles;  // NOLINT
using delmesher::ExactPoint;
using delmesher::ExactRecord;
using delmesher::Options;
using delmesher::Region;

void improve(Told& told, Region region = Region::interior) {
  Options options = honest_options();
  options.gabriel = false;
  options.improve = true;
  options.region = region;
  told = run_of(options);
  ASSERT_FALSE(told.record.unrepaired.empty());
  ASSERT_FALSE(told.record.unrepaired_facets.empty());
}

// Splits a tetrahedron of the record, but not of the file, at a new point with these barycentric
// coordinates. Near a face that makes flat tetrahedra.
void split(ExactRecord& r, std::vector<ExactRecord::Tet>& tets, std::size_t n,
           const std::array<double, 4>& weights) {
  ExactPoints points;
  ASSERT_EQ(points.assign(r.points), "");
  const ExactRecord::Tet tet = tets[n];
  Position x{};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      x[axis] += weights[i] * points.nearest(tet.vertices[i])[axis];
    }
  }
  const auto fresh = static_cast<Index>(r.points.size());
  r.points.push_back(explicit_points(std::span(&x, 1))[0]);
  for (std::size_t i = 0; i < 4; ++i) {
    ExactRecord::Tet part = tet;
    part.vertices[i] = fresh;
    i == 0 ? void(tets[n] = part) : tets.push_back(part);
  }
}

std::size_t some(const std::vector<ExactRecord::Tet>& tets, bool inside) {
  const auto found = std::find_if(tets.begin(), tets.end(),
                                  [inside](const auto& tet) { return tet.inside == inside; });
  return static_cast<std::size_t>(found - tets.begin());
}

constexpr std::array<double, 4> kMiddle = {0.25, 0.25, 0.25, 0.25}, kBad = {0.3, 0.3, 0.3, 0.1},
                                kNearFace = {0.334, 0.333, 0.332999999, 0.000000001};

void make_many_bad(Told& told) {
  const std::size_t count = told.record.final.size();
  for (std::size_t n = 0; n < count; ++n) {
    if (told.record.final[n].inside) split(told.record, told.record.final, n, kBad);
  }
}

const Lie kImproved[] = {
    {"a point of no origin before the improvement", "enrichment",
     [](Told& t) {
       improve(t);
       split(t.record, t.record.unrepaired, some(t.record.unrepaired, true), kMiddle);
     }},
    {"a flat tetrahedron before, to excuse others", "unrepaired-constrained-delaunay",
     [](Told& t) {
       improve(t);
       split(t.record, t.record.unrepaired, some(t.record.unrepaired, true), kNearFace);
     }},
    {"a tetrahedron before turned over, to excuse others", "unrepaired-complex",
     [](Told& t) {
       improve(t);
       auto& tet = t.record.unrepaired[some(t.record.unrepaired, true)].vertices;
       std::swap(tet[0], tet[1]);
     }},
    {"inside and outside exchanged before", "unrepaired-conformity",
     [](Told& t) {
       improve(t);
       for (auto& tet : t.record.unrepaired) tet.inside = !tet.inside;
     }},
    {"a tetrahedron before called outside, so that it does not count", "unrepaired-conformity",
     [](Told& t) {
       improve(t);
       t.record.unrepaired[some(t.record.unrepaired, true)].inside = false;
     }},
    {"a plain tetrahedrization as the mesh before", "enrichment",
     [](Told& t) {
       improve(t);
       Options options = honest_options();
       const Told plain = run_of(options, Task::cdt);
       t.record.unrepaired = plain.record.final;
       t.record.unrepaired_facets = plain.record.final_facets;
     }},
    {"a face before that is on no facet", "unrepaired-facets",
     [](Told& t) {
       improve(t);
       const auto [a, b, c] =
           face_of(t.record.unrepaired[some(t.record.unrepaired, true)].vertices, 0);
       t.record.unrepaired_facets.push_back({a, b, c, t.record.facets.front().id});
     }},
    {"a face before turned over", "unrepaired-facets",
     [](Told& t) {
       improve(t);
       auto& face = t.record.unrepaired_facets.front();
       std::swap(face[0], face[1]);
     },
     "passed"},
    {"no faces before, where they were others", "unrepaired-facets",
     [](Told& t) {
       improve(t);
       t.record.unrepaired_facets.clear();
     }},
    {"a tetrahedron before of a point that does not exist", "sidecar",
     [](Told& t) {
       improve(t);
       t.record.unrepaired.front().vertices[2] = 4294967295U;
     }},
    {"a mesh that was made worse outside, where that counts", "improvement",
     [](Told& t) {
       improve(t, Region::hull);
       split(t.record, t.record.final, some(t.record.final, false), kNearFace);
     }},
    {"many tetrahedra are bad where some were", "improvement",
     [](Told& t) {
       improve(t);
       make_many_bad(t);
     }},
    {"the same, where a budget allows shorter edges", "improvement",
     [](Told& t) {
       improve(t);
       t.promise.budget = 1e6;
       t.promise.size = Promise::kSizeAuto;
       make_many_bad(t);
     }},
    {"an improvement that was not asked for", "repairs",
     [](Told& t) {
       improve(t);
       t.promise.improve = false;
     }},
    {"the improved mesh on surface points that were rounded", "exact-conformity",
     [](Told& t) {
       improve(t);
       ExactPoints points;
       ASSERT_EQ(points.assign(t.record.points), "");
       for (Index v = 0; v < points.size(); ++v) {
         if (points.is_double(v)) continue;
         const Position x = points.nearest(v);
         t.record.points[v] = explicit_points(std::span(&x, 1))[0];
       }
     }},
};

}  // namespace

std::span<const Lie> improved() {
  return kImproved;
}

}  // namespace tetproof::lies
