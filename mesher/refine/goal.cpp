#include "mesher/refine/goal.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>

#include "mesher/predicates/predicates.h"
#include "mesher/refine/tetrahedron_shape.h"

namespace delmesher::refine {
namespace {

// Section 5.7: shortest edge over smallest distance of opposite edges.
constexpr double kSliverRatio = 7.2;
// Relative slack that rounding may use up: a tetrahedron that close to the bound counts as bad.
constexpr double kSlack = 1e-12;

// Is the squared cosine of every face's smallest angle, opposite its shortest edge, below the
// bound? Not if NaN. Without branches on the order of lengths, which is random.
bool angles_above(const TetrahedronShape& s, double max_cosine_squared) {
  constexpr int kFaceEdges[4][3] = {{3, 4, 5}, {1, 2, 5}, {0, 2, 4}, {0, 1, 3}};
  bool above = true;
  for (const auto& face : kFaceEdges) {
    const double a = s.length2[face[0]], b = s.length2[face[1]], c = s.length2[face[2]];
    const double low = std::min(a, b), high = std::max(a, b);
    const double shortest = std::min(low, c), other = std::max(low, c);
    const double sum = high + other - shortest;
    above &= sum * sum < 4 * max_cosine_squared * high * other;
  }
  return above;
}

// Smallest squared distance between the lines of opposite edges.
double opposite_edges_distance2(const TetrahedronShape& s) {
  double smallest = HUGE_VAL;
  for (int e = 0; e < 3; ++e) {
    const Vec3 u = subtract(s.p[kEdge[e][1]], s.p[kEdge[e][0]]);
    const Vec3 v = subtract(s.p[kEdge[5 - e][1]], s.p[kEdge[5 - e][0]]);
    const Vec3 n = cross(u, v);
    smallest = std::min(smallest, s.volume6 * s.volume6 / dot(n, n));
  }
  return smallest;
}

// The level of a squared radius-edge ratio, 2^kLevelBits levels per doubling. Within a level the
// last queued goes first (BadTetrahedra), so that successive insertions share the contents of the
// processor's caches.
constexpr int kLevelBits = 2;
std::uint8_t level_of(double ratio2) {
  const auto bits = std::bit_cast<std::uint64_t>(ratio2) >> (52 - kLevelBits);
  constexpr std::uint64_t kLowest = std::uint64_t{1023 - 2} << kLevelBits;  // a quarter
  if (!(ratio2 > 0.25)) return ratio2 <= 0.25 ? 1 : Goal::kWorst;
  return static_cast<std::uint8_t>(std::min<std::uint64_t>(bits - kLowest + 1, Goal::kWorst));
}

}  // namespace

Goal::Goal(double delta, bool slivers, double max_edge, const SizeField* sizes)
    : max_cosine_squared_(cosine_squared(delta)),
      slivers_(slivers),
      max_edge_(max_edge),
      sizes_(sizes != nullptr && !sizes->empty() ? sizes : nullptr) {
  // An isosceles triangle with unit base and the angle delta opposite has height cot(delta / 2) /
  // 2, and cot^2(delta / 2) = (1 + cos delta) / (1 - cos delta).
  const double cosine = std::sqrt(max_cosine_squared_);
  offcentre2_ = (1 + cosine) / (1 - cosine) / 4;
}

bool Goal::has_edge_above_sizes(const PointStore& points, const VertexId* v) const {
  return std::any_of(std::begin(kEdge), std::end(kEdge), [&](const auto& e) {
    return sizes_->is_too_long(points.nearest(v[e[0]]), points.nearest(v[e[1]]));
  });
}

std::uint8_t Goal::badness(const PointStore& points, const VertexId* v) const {
  TetrahedronShape s = shape_of(points, v);
  double error = 0;
  for (int i = 0; i < 4; ++i) error = std::max(error, points.approximation(v[i]).error);
  const double shortest2 = s.shortest2();
  const double slack = kSlack + 32 * error / std::sqrt(shortest2);
  bool bad = !angles_above(s, max_cosine_squared_ - slack);
  if (!bad && slivers_) {
    s.volume6 = dot(s.p[1], cross(s.p[2], s.p[3]));
    bad = shortest2 > kSliverRatio * kSliverRatio * opposite_edges_distance2(s);
  }
  if (!bad && max_edge_ > 0) {
    bad = *std::max_element(s.length2.begin(), s.length2.end()) > max_edge_ * max_edge_;
  }
  if (!bad && sizes_ != nullptr) bad = has_edge_above_sizes(points, v);
  if (!bad) return 0;
  add_circumsphere(s);
  return level_of(s.radius2 / shortest2);
}

}  // namespace delmesher::refine
