// Refinement of tetrahedra by largest radius-edge ratio (section 5.4), with off-centres and sliver
// treatment (5.7).
#include <algorithm>
#include <bit>
#include <cmath>
#include <string>

#include "mesher/base/check.h"
#include "mesher/base/spatial_sort.h"
#include "mesher/predicates/vector.h"
#include "mesher/refine/refiner.h"

namespace delmesher {
namespace {

// The proof of termination needs a radius-edge ratio above 2, that is an angle below asin(1/4)
// (design: the paper's 20.7 is the planar bound).
constexpr double kGuaranteedDelta = 14.4775;
// Section 5.7: shortest edge over smallest distance of opposite edges.
constexpr double kSliverRatio = 7.2;
// Volume points are snapped to a grid of this fraction of the shortest edge, so that their
// coordinates are short. Any point of the circumball may split a tetrahedron (section 5.6).
constexpr double kGridFraction = 1.0 / 1024;
// Relative slack that rounding may use up: a tetrahedron that close to the bound counts as bad.
constexpr double kSlack = 1e-12;
// Off-centres (Uengoer 2004) a little nearer than necessary, so that the new face passes with a
// margin.
constexpr double kOffcentreFactor = 0.95;

struct Shape {
  std::array<Vec3, 4> p;          // relative to vertex 0
  std::array<double, 6> length2;  // squared, by kEdge
  int shortest = 0;
  Vec3 center;     // circumcentre relative to vertex 0
  double radius2;  // squared circumradius; infinite or NaN if flat
  double volume6;  // six times the volume
};

Shape shape_of(const std::array<Vec3, 4>& p) {
  Shape s;
  s.p = p;
  for (int e = 0; e < 6; ++e) {
    const Vec3 d = subtract(p[kEdge[e][1]], p[kEdge[e][0]]);
    s.length2[e] = dot(d, d);
    if (s.length2[e] < s.length2[s.shortest]) s.shortest = e;
  }
  return s;
}

// Fills in center, radius2 and volume6.
void add_circumsphere(Shape& s) {
  const Vec3 bc = cross(s.p[2], s.p[3]);
  const Vec3 ca = cross(s.p[3], s.p[1]);
  const Vec3 ab = cross(s.p[1], s.p[2]);
  s.volume6 = dot(s.p[1], bc);
  const double scale = 0.5 / s.volume6;
  for (int k = 0; k < 3; ++k) {
    s.center[k] = scale * (s.length2[0] * bc[k] + s.length2[1] * ca[k] + s.length2[2] * ab[k]);
  }
  s.radius2 = dot(s.center, s.center);
}

// Is the squared cosine of every face's smallest angle, opposite its shortest edge, below the
// bound? Not if NaN. Without branches on the order of lengths, which is random.
bool angles_above(const Shape& s, double max_cosine_squared) {
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
double opposite_edges_distance2(const Shape& s) {
  double smallest = HUGE_VAL;
  for (int e = 0; e < 3; ++e) {
    const Vec3 u = subtract(s.p[kEdge[e][1]], s.p[kEdge[e][0]]);
    const Vec3 v = subtract(s.p[kEdge[5 - e][1]], s.p[kEdge[5 - e][0]]);
    const Vec3 n = cross(u, v);
    smallest = std::min(smallest, s.volume6 * s.volume6 / dot(n, n));
  }
  return smallest;
}

// 1 to 254, growing with the squared radius-edge ratio by kLevels per doubling: within a level the
// last queued goes first, so that successive insertions share what is in the processor's caches.
constexpr int kLevelBits = 2;
std::uint8_t level_of(double ratio2) {
  const auto bits = std::bit_cast<std::uint64_t>(ratio2) >> (52 - kLevelBits);
  constexpr std::uint64_t kLowest = std::uint64_t{1023 - 2} << kLevelBits;  // a quarter
  if (!(ratio2 > 0.25)) return ratio2 <= 0.25 ? 1 : 254;
  return static_cast<std::uint8_t>(std::min<std::uint64_t>(bits - kLowest + 1, 254));
}

}  // namespace

// Judged in doubles; when in doubt a tetrahedron is bad, which costs at most a split.
void Refiner::queue_if_bad(TetId t) {
  if (dt_.is_ghost(t)) return;
  if (options_.region == Region::interior && note(t, kSide) == kOutside) return;
  std::array<Vec3, 4> p;
  double error = 0;
  const Vec3 origin = points_.nearest(dt_.vertex(t, 0));
  for (int i = 0; i < 4; ++i) {
    const VertexId v = dt_.vertex(t, i);
    p[i] = relative(v, origin);
    error = std::max(error, points_.approximation(v).error);
  }
  Shape s = shape_of(p);
  const double shortest2 = s.length2[s.shortest];
  const double slack = kSlack + 32 * error / std::sqrt(shortest2);
  bool bad = !angles_above(s, goal_.max_cosine_squared - slack);
  if (!bad && goal_.slivers) {
    s.volume6 = dot(p[1], cross(p[2], p[3]));
    bad = shortest2 > kSliverRatio * kSliverRatio * opposite_edges_distance2(s);
  }
  if (!bad && options_.max_edge > 0) {
    bad = *std::max_element(s.length2.begin(), s.length2.end()) >
          options_.max_edge * options_.max_edge;
  }
  if (!bad) return;
  add_circumsphere(s);
  queue_tetrahedron(t, level_of(s.radius2 / shortest2));
}

void Refiner::queue_tetrahedron(TetId t, std::uint8_t level) {
  note(t, kWaiting) = level;
  bad_[level].push_back(t);
  worst_ = std::max(worst_, std::size_t{level});
}

TetId Refiner::next_bad() {
  constexpr std::size_t kAhead = 8;  // entries, of which nine in ten are dead
  for (; worst_ > 0; --worst_) {
    if (worst_ < sorted_) {
      sorted_ = worst_;
      sort_level(sorted_);
    }
    std::vector<TetId>& level = bad_[worst_];
    while (!level.empty()) {
      const TetId t = level.back();
      if (level.size() > kAhead) dt_.prefetch(level[level.size() - 1 - kAhead]);
      if (dt_.alive(t) && note(t, kWaiting) == worst_) return t;
      level.pop_back();
    }
  }
  return kNone;
}

// In a spatial order, without the dead.
void Refiner::sort_level(std::size_t n) {
  std::vector<TetId>& level = bad_[n];
  std::vector<TetId> waiting;
  std::vector<Vec3> place;
  for (const TetId t : level) {
    if (!dt_.alive(t) || note(t, kWaiting) != n) continue;
    waiting.push_back(t);
    place.push_back(points_.nearest(dt_.vertex(t, 0)));
  }
  std::vector<std::uint32_t> order(waiting.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  spatial_sort(order, place);
  level.clear();
  for (const std::uint32_t i : order) level.push_back(waiting[i]);
}

void Refiner::clear_bad() {
  for (std::vector<TetId>& level : bad_) level = {};
  worst_ = 0;
}

void Refiner::judge_fresh() {
  for (const TetId t : fresh_) {
    note(t, kWaiting) = 0;
    if (dt_.alive(t)) queue_if_bad(t);
  }
  fresh_.clear();
}

bool Refiner::reach(const Goal& goal, std::size_t cap) {
  goal_ = goal;
  // An isosceles triangle with unit base and apex angle delta has height cot(delta / 2) / 2, and
  // cot^2(delta / 2) = (1 + cos delta) / (1 - cos delta).
  const double cosine = std::sqrt(goal.max_cosine_squared);
  offcentre2_ = (1 + cosine) / (1 - cosine) / 4;
  sorted_ = bad_.size();
  for (TetId t = 0; t < dt_.capacity(); ++t) {
    control_.poll(points_.size());
    note(t, kWaiting) = 0;
    if (dt_.alive(t)) queue_if_bad(t);
  }
  for (;;) {
    control_.poll(points_.size());
    drain();
    judge_fresh();
    const TetId t = next_bad();
    if (t == kNone) return true;
    if (points_.size() > cap) break;
    if (options_.region == Region::interior && side_of(t) == kOutside) {
      note(t, kWaiting) = 0;
    } else {
      split_tetrahedron(t);
    }
  }
  clear_bad();
  return false;
}

// First what is guaranteed to end; then, with a cap on insertions, what is not: slivers and angles
// above the bound. Where a cap strikes, the guaranteed goal is reached once more, so that it holds
// in any case.
void Refiner::refine_tetrahedra() {
  refining_ = true;
  constexpr std::size_t kUnlimited = ~std::size_t{0};
  constexpr std::size_t kCapFactor = 4;
  const Goal guaranteed{cosine_squared(std::min(options_.delta, kGuaranteedDelta)), false};
  const Goal wanted{cosine_squared(options_.delta), options_.slivers};
  reach(guaranteed, kUnlimited);
  if (!wanted.slivers && options_.delta <= kGuaranteedDelta) return;
  if (!reach(wanted, kCapFactor * points_.size())) reach(guaranteed, kUnlimited);
}

void Refiner::split_tetrahedron(TetId t) {
  const Vec3 origin = points_.nearest(dt_.vertex(t, 0));
  std::array<Vec3, 4> p;
  for (int i = 0; i < 4; ++i) p[i] = relative(dt_.vertex(t, i), origin);
  Shape s = shape_of(p);
  add_circumsphere(s);
  guard(s.length2[s.shortest], origin);
  const double grid = std::sqrt(s.length2[s.shortest]) * kGridFraction;
  const auto absolute = [&](const Vec3& x) {
    return Vec3{origin[0] + x[0], origin[1] + x[1], origin[2] + x[2]};
  };
  if (std::isfinite(s.radius2)) {
    // From the midpoint of the shortest edge towards the circumcentre, not farther than where the
    // new triangle on that edge just meets the angle bound.
    const Vec3& a = s.p[kEdge[s.shortest][0]];
    const Vec3& b = s.p[kEdge[s.shortest][1]];
    const Vec3 middle = {(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2};
    const Vec3 d = subtract(s.center, middle);
    const double far2 = dot(d, d);
    const double reach2 = kOffcentreFactor * kOffcentreFactor * offcentre2_ * s.length2[s.shortest];
    if (reach2 < far2) {
      const double f = std::sqrt(reach2 / far2);
      const Vec3 off = {middle[0] + f * d[0], middle[1] + f * d[1], middle[2] + f * d[2]};
      if (try_volume_point(t, absolute(off), grid)) return;
    }
    if (try_volume_point(t, absolute(s.center), grid)) return;
  }
  // Too flat for its circumcentre to be computed: its centroid is inside the circumball.
  Vec3 centroid{};
  for (const Vec3& q : s.p) {
    for (int k = 0; k < 3; ++k) centroid[k] += q[k] / 4;
  }
  if (try_volume_point(t, absolute(centroid), grid)) return;
  // No double is in the circumball: the solid is a few roundings thick there.
  const VertexId* v = dt_.vertices(t);
  const VertexId* corner =
      std::find_if(v, v + 4, [&](VertexId w) { return w < topology_.vertex_half_edge.size(); });
  stop_at_precision(corner != v + 4 ? "vertex " + std::to_string(*corner) : "a tetrahedron inside");
}

// Inserts the snapped point unless it encroaches, in which case what it encroaches upon is queued.
// False if the point is not inside the circumball.
bool Refiner::try_volume_point(TetId t, const Vec3& center, double grid) {
  const Vec3 p = snap_to_grid(center, grid);
  const VertexId v = points_.add_explicit(p[0], p[1], p[2]);
  const VertexId* w = dt_.vertices(t);
  if (predicates_.insphere_perturbed(w[0], w[1], w[2], w[3], v) <= 0) {
    points_.pop_back();
    return false;
  }
  if (!find_free_cavity(v, t, true)) {
    points_.pop_back();  // t waits on
    return true;
  }
  in_volume_.push_back(v);
  if (options_.want_balls) ball_.push_back({w[0], w[1], w[2], w[3]});
  commit(v);
  new_subfacets_.clear();
  after_insertion();
  return true;
}

}  // namespace delmesher
