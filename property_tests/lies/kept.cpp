// Lies about a kept surface.
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "property_tests/lies/told.h"

namespace tetproof::lies {
namespace {

using namespace oracles;  // NOLINT
using delmesher::Options;

void keep(Told& told) {
  Options options;
  options.want_exact = true;
  options.surface = delmesher::SurfaceChoice::keep;
  options.strict = true;
  told = run_of(options);
  ASSERT_FALSE(told.record.unrepaired.empty());
}

// A triangle and the one across an edge in the same plane; a facet of the wedge or slab has two.
std::pair<std::size_t, std::size_t> flat_pair(const Told& told) {
  for (const auto& facet : told.record.facets) {
    if (facet.triangles.size() == 2) return {facet.triangles[0], facet.triangles[1]};
  }
  ADD_FAILURE() << "no facet has two triangles";
  return {};
}

// The other diagonal of a parallelogram.
void exchange_diagonal(Told& told) {
  const auto [s, t] = flat_pair(told);
  auto &one = told.sample.input.triangles[s], &two = told.sample.input.triangles[t];
  const auto is_in = [](const auto& triangle, Index v) {
    return std::ranges::find(triangle, v) != triangle.end();
  };
  while (is_in(two, one[0])) std::rotate(one.begin(), one.begin() + 1, one.end());
  while (is_in(one, two[0])) std::rotate(two.begin(), two.begin() + 1, two.end());
  const Index apex = one[0], other = two[0], left = one[1], right = one[2];
  one = {apex, left, other};
  two = {apex, other, right};
}

// The surface may be kept, but not with this option.
void keep_although(Told& told, void (*change)(Options&)) {
  keep(told);
  Options options;
  change(options);
  told.promise = promise_of(options);
}

const Lie kKept[] = {
    {"kept but for triangles with no edge longer than promised", "kept",
     [](Told& t) {
       t = honest();
       t.record.refined.clear();
       t.record.refined_facets.clear();
       t.record.segments.clear();
       Options options;
       options.max_edge = 100;
       t.promise = promise_of(options);
       t.promise.strict = true;
     }},
    {"kept with an angle promised", "promise",
     [](Told& t) { keep_although(t, [](Options& o) { o.delta = 10; }); }},
    {"kept without slivers' treatment", "promise",
     [](Told& t) { keep_although(t, [](Options& o) { o.slivers = false; }); }},
    {"kept without simpler bridges", "promise",
     [](Told& t) { keep_although(t, [](Options& o) { o.simplify_bridges = false; }); }},
    {"kept in the paper's order", "promise",
     [](Told& t) { keep_although(t, [](Options& o) { o.as_paper.order = true; }); }},
    {"kept where the chamfered surface was wanted", "promise",
     [](Told& t) { keep_although(t, [](Options& o) { o.want_chamfered = true; }); }},
    {"kept where it was to be split", "promise",
     [](Told& t) {
       keep_although(t, [](Options& o) { o.surface = delmesher::SurfaceChoice::split; });
     }},
    {"a surface that was split told to be kept", "kept",
     [](Told& t) {
       keep(t);
       const Told split = honest();
       t.sample.mesh = split.sample.mesh;
       t.record = split.record;
     }},
    {"another diagonal kept than the input has", "kept",
     [](Told& t) {
       keep(t);
       exchange_diagonal(t);
     }},
    {"a face kept as another triangle of its facet", "exact-second-kernel",
     [](Told& t) {
       keep(t);
       const auto [s, other] = flat_pair(t);
       for (auto& face : t.record.final_facets) {
         if (face[3] == s) face[3] = static_cast<std::uint32_t>(other);
       }
     }},
    {"a face kept as a triangle of another facet", "exact-facets",
     [](Told& t) {
       keep(t);
       const auto [s, other] = flat_pair(t);
       for (auto& face : t.record.final_facets) {
         if (face[3] != s && face[3] != other) {
           face[3] = static_cast<std::uint32_t>(s);
           break;
         }
       }
     }},
    {"a tetrahedron before the surface was cleared turned over", "unrepaired-complex",
     [](Told& t) {
       keep(t);
       auto& tet = t.record.unrepaired.front().vertices;
       std::swap(tet[0], tet[1]);
     }},
    {"a refined mesh beside a kept surface", "promise",
     [](Told& t) {
       keep(t);
       t.record.refined = t.record.unrepaired;
     }},
};

}  // namespace

std::span<const Lie> kept() {
  return kKept;
}

}  // namespace tetproof::lies
