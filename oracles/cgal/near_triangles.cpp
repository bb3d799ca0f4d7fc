#include "oracles/cgal/near_triangles.h"

#include <CGAL/Bbox_3.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

#include "oracles/base/box.h"
#include "oracles/base/steps.h"
#include "oracles/base/vectors.h"

namespace tetproof::oracles {
namespace {

using Triangle = std::array<Index, 3>;

constexpr std::ptrdiff_t kPlainScan = 2000;  // boxes, as CGAL has it for triangles
constexpr std::size_t kHub = 32;             // with fewer triangles, all pairs at a vertex are few
constexpr Index kLeafSize = 4;
constexpr int kRounds = 16;

Position plus(const Position& p, const Position& q, double factor) {
  return {p[0] + factor * q[0], p[1] + factor * q[1], p[2] + factor * q[2]};
}

Position unit(const Position& p) {
  return plus({}, p, 1 / length(p));
}

CGAL::Bbox_3 cgal_box(const Box& box) {
  return {box.low[0], box.low[1], box.low[2], box.high[0], box.high[1], box.high[2]};
}

// A few points, and the one nearest to the origin of all simplices that at most three of them span.
struct Simplex {
  std::array<Position, 4> corners;
  std::size_t size = 0;

  void add(const Position& p) { corners[size++] = p; }
};
struct Nearest {
  Simplex simplex;
  Position point;
  double squared = HUGE_VAL;
};
Nearest nearest_to_origin(const Simplex& given) {
  Nearest best;
  const auto try_point = [&](const Position& p, std::initializer_list<Position> corners) {
    if (!(dot(p, p) < best.squared)) return;
    best = {{}, p, dot(p, p)};
    for (const Position& corner : corners) best.simplex.add(corner);
  };
  for (std::size_t i = 0; i < given.size; ++i) {
    const Position& a = given.corners[i];
    try_point(a, {a});
    for (std::size_t j = 0; j < i; ++j) {
      const Position &b = given.corners[j], u = minus(b, a);
      const double uu = dot(u, u), au = dot(a, u), t = -au / uu;
      if (t > 0 && t < 1) try_point(plus(a, u, t), {a, b});
      for (std::size_t k = 0; k < j; ++k) {
        const Position &c = given.corners[k], v = minus(c, a);
        const double vv = dot(v, v), uv = dot(u, v), av = dot(a, v);
        const double whole = uu * vv - uv * uv;
        const double r = (uv * av - vv * au) / whole, s = (uv * au - uu * av) / whole;
        if (r > 0 && s > 0 && r + s < 1) try_point(plus(plus(a, u, r), v, s), {a, b, c});
      }
    }
  }
  return best;
}

class NearPairs {
 public:
  NearPairs(std::span<const Position> points, std::span<const Triangle> triangles,
            const std::function<void(Index, Index)>& visit)
      : points_(points), triangles_(triangles), visit_(visit) {}

  void run() {
    if (triangles_.empty()) return;
    find_hubs();
    for (const Triangle& triangle : triangles_) {
      Box& box = boxes_.emplace_back();
      for (const Index v : triangle) box.add(points_[v]);
    }
    order_.resize(triangles_.size());
    std::iota(order_.begin(), order_.end(), Index{0});
    nodes_.emplace_back();
    build(0, 0, static_cast<Index>(order_.size()));
    corners_.reserve(3 * order_.size());
    for (const Index t : order_) {
      for (const Index v : triangles_[t]) corners_.push_back(points_[v]);
    }
    visit_within(0);
  }

 private:
  struct Node {
    Box box;
    Index first, last;
    Index child = 0;    // and the next; 0: a leaf
    bool star = false;  // all have the same hub
  };

  bool is_hub(Index v) const { return valence_[v] > kHub; }

  void find_hubs() {
    valence_.assign(points_.size(), 0);
    for (const Triangle& triangle : triangles_) {
      for (const Index v : triangle) ++valence_[v];
    }
    std::map<Index, std::vector<Index>> stars;
    hub_.assign(triangles_.size(), kNone);
    for (Index t = 0; t < triangles_.size(); ++t) {
      for (const Index v : triangles_[t]) {
        if (!is_hub(v)) continue;
        stars[v].push_back(t);
        if (hub_[t] == kNone || valence_[v] > valence_[hub_[t]]) hub_[t] = v;
      }
    }
    for (const auto& [hub, star] : stars) compare_arcs(hub, star);
  }

  // Two triangles at a vertex meet elsewhere if their arcs meet, as seen from there.
  void compare_arcs(Index hub, const std::vector<Index>& star) {
    using Arc = CGAL::Box_intersection_d::Box_with_handle_d<double, 3, const Index*>;
    std::vector<Arc> arcs;
    for (const Index& t : star) {
      std::vector<Position> ends;
      for (const Index v : triangles_[t]) {
        if (v == hub) continue;
        const Position u = minus(points_[v], points_[hub]);
        ends.push_back(unit(plus({}, u, 1 / largest_component(u))));
      }
      arcs.emplace_back(cgal_box(box_of_arc(ends.front(), ends.back())), &t);
    }
    CGAL::box_self_intersection_d(arcs.begin(), arcs.end(), [&](const Arc& a, const Arc& b) {
      ++steps;
      const Index t = *a.handle(), u = *b.handle();
      if (first_common_hub(t, u) == hub) visit_(std::min(t, u), std::max(t, u));
    });
  }

  // Around the shorter arc between two points of the unit sphere, by chords of pieces: each is
  // within 1 - sqrt(1 - (chord / 2)^2) of its chord. All roundings are below 2^-40, unless the
  // ends are nearly opposite; then the arc may be anywhere.
  static Box box_of_arc(const Position& from, const Position& to) {
    constexpr int kPieces = 8;
    Box box;
    box.add(from);
    double reach = 0;
    bool known = true;
    Position before = from;
    for (int i = 1; i <= kPieces; ++i) {
      const Position p = between(from, to, static_cast<double>(i) / kPieces);
      known = known && length(p) > 0x1p-8;
      const Position next = unit(p);
      const double square = dot(minus(next, before), minus(next, before)) / 4;
      reach = std::max(reach, square / (1 + std::sqrt(1 - std::min(square, 1.0))));
      box.add(next);
      before = next;
    }
    if (!known) return box_around({}, 3);
    Box larger;
    for (const Position& corner : {box.low, box.high}) {
      larger.add(box_around(corner, reach + 0x1p-40));
    }
    return larger;
  }

  Index first_common_hub(Index t, Index u) const {
    Index found = kNone;
    for (const Index v : triangles_[t]) {
      if (is_hub(v) && std::ranges::count(triangles_[u], v) > 0) found = std::min(found, v);
    }
    return found;
  }

  // A star stays together until nothing else is with it.
  void build(std::size_t node, Index first, Index last) {
    const auto begin = order_.begin() + first, end = order_.begin() + last;
    Box box;
    for (auto t = begin; t != end; ++t) box.add(boxes_[*t]);
    const Index hub = hub_[*begin];
    const bool star =
        hub != kNone && std::all_of(begin, end, [&](Index t) { return hub_[t] == hub; });
    nodes_[node] = {box, first, last, 0, star};
    if (last - first <= kLeafSize) return;
    const auto place = [&](Index t) {
      if (!star && hub_[t] != kNone) return points_[hub_[t]];
      return between(boxes_[t].low, boxes_[t].high, 0.5);
    };
    Box places;
    for (auto t = begin; t != end; ++t) places.add(place(*t));
    std::size_t axis = 0;
    const auto width = [&](std::size_t k) { return places.high[k] - places.low[k]; };
    for (std::size_t k = 1; k < 3; ++k) axis = width(k) > width(axis) ? k : axis;
    const auto key = [&](Index t) {
      const Index whole =
          star || hub_[t] == kNone ? t + static_cast<Index>(points_.size()) : hub_[t];
      return std::pair(place(t)[axis], whole);
    };
    auto middle = begin + (last - first) / 2;
    std::nth_element(begin, middle, end, [&](Index t, Index u) { return key(t) < key(u); });
    const auto pivot = key(*middle);
    middle = std::partition(begin, end, [&](Index t) { return key(t) < pivot; });
    if (middle == begin) {
      middle = std::partition(begin, end, [&](Index t) { return key(t) <= pivot; });
    }
    const auto cut = static_cast<Index>(middle - order_.begin());
    const auto child = static_cast<Index>(nodes_.size());
    nodes_[node].child = child;
    nodes_.resize(nodes_.size() + 2);
    build(child, first, cut);
    build(child + 1, cut, last);
  }

  void try_pair(Index i, Index j) {
    const Index t = order_[i], u = order_[j];
    ++steps;
    if (meet(boxes_[t], boxes_[u]) && first_common_hub(t, u) == kNone) {
      visit_(std::min(t, u), std::max(t, u));
    }
  }

  void visit_within(Index n) {
    const Node node = nodes_[n];
    if (node.star) return;
    if (node.child == 0) {
      for (Index i = node.first; i < node.last; ++i) {
        for (Index j = node.first; j < i; ++j) try_pair(i, j);
      }
      return;
    }
    visit_within(node.child);
    visit_within(node.child + 1);
    visit_between(node.child, node.child + 1);
  }

  void visit_between(Index m, Index n) {
    const Node &a = nodes_[m], &b = nodes_[n];
    ++steps;
    if (!meet(a.box, b.box)) return;
    if (a.child == 0 && b.child == 0) {
      for (Index i = a.first; i < a.last; ++i) {
        for (Index j = b.first; j < b.last; ++j) try_pair(i, j);
      }
      return;
    }
    if (are_apart(a, b)) return;
    if (b.child == 0 || (a.child != 0 && a.last - a.first >= b.last - b.first)) {
      visit_between(a.child, n);
      visit_between(a.child + 1, n);
    } else {
      visit_between(m, b.child);
      visit_between(m, b.child + 1);
    }
  }

  std::span<const Position> corners_of(const Node& node) const {
    return std::span(corners_).subspan(3 * node.first, 3 * (node.last - node.first));
  }

  // Is a plane strictly between all corners of one and all of the other? Gilbert, Johnson and
  // Keerthi's way to the nearest point of their differences, in doubles; another sum decides.
  bool are_apart(const Node& a, const Node& b) const {
    const std::span<const Position> ours = corners_of(a), theirs = corners_of(b);
    Simplex simplex;
    simplex.add(minus(theirs[0], ours[0]));
    double most = 0;
    for (int round = 0; round < kRounds; ++round) {
      steps += (ours.size() + theirs.size()) / 4;
      const Nearest nearest = nearest_to_origin(simplex);
      most = std::max(most, nearest.squared);
      if (!(nearest.squared > most * 0x1p-60)) return false;  // they touch
      const Position& along = nearest.point;
      const auto is_lower = [&](const Position& p, const Position& q) {
        return dot(along, p) < dot(along, q);
      };
      const Position& p = *std::max_element(ours.begin(), ours.end(), is_lower);
      const Position& q = *std::min_element(theirs.begin(), theirs.end(), is_lower);
      if (dot(along, minus(q, p)) > 0) return surely_beyond(along, p, ours, theirs);
      simplex = nearest.simplex;
      simplex.add(minus(q, p));
    }
    return false;
  }

  // Each height over a point among them is a sum of three products of rounded differences, off by
  // at most 2^-50 of the sum of their sizes, but for underflow. A difference may overflow.
  static bool surely_beyond(const Position& along, const Position& origin,
                            std::span<const Position> ours, std::span<const Position> theirs) {
    const Position direction = plus({}, along, 1 / largest_component(along));
    if (!is_finite(direction)) return false;
    double size = 0, highest = -HUGE_VAL, lowest = HUGE_VAL;
    const auto height = [&](const Position& p) {
      const Position u = minus(p, origin);
      size += is_finite(u) ? 0 : HUGE_VAL;
      size = std::max(size, std::fabs(direction[0] * u[0]) + std::fabs(direction[1] * u[1]) +
                                std::fabs(direction[2] * u[2]));
      return dot(direction, u);
    };
    for (const Position& p : ours) highest = std::max(highest, height(p));
    for (const Position& p : theirs) lowest = std::min(lowest, height(p));
    return lowest - highest > size * 0x1p-48 + 0x1p-1000;
  }

  std::span<const Position> points_;
  std::span<const Triangle> triangles_;
  const std::function<void(Index, Index)>& visit_;
  std::vector<std::size_t> valence_;  // of each vertex
  std::vector<Index> hub_;            // of each triangle, or kNone
  std::vector<Box> boxes_;
  std::vector<Index> order_;  // that of the leaves
  std::vector<Node> nodes_;
  std::vector<Position> corners_;  // three of each triangle, in that order
};

// Those whose boxes meet. False if they are too many.
bool visit_boxes(std::span<const Position> points, std::span<const Triangle> triangles,
                 const std::function<void(Index, Index)>& visit) {
  using Boxed = CGAL::Box_intersection_d::Box_with_handle_d<double, 3, const Triangle*>;
  struct TooMany {};
  std::vector<Boxed> boxes;
  for (const Triangle& triangle : triangles) {
    Box box;
    for (const Index v : triangle) box.add(points[v]);
    boxes.emplace_back(cgal_box(box), &triangle);
  }
  std::size_t left = kMostBoxPairs * triangles.size();
  try {
    const auto take = [&](const Boxed& a, const Boxed& b) {
      ++steps;
      if (left-- == 0) throw TooMany();
      const auto t = static_cast<Index>(a.handle() - triangles.data()),
                 u = static_cast<Index>(b.handle() - triangles.data());
      visit(std::min(t, u), std::max(t, u));
    };
    CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), take, kPlainScan);
  } catch (const TooMany&) {
    return false;
  }
  return true;
}

}  // namespace

void for_each_near_pair(std::span<const Position> points, std::span<const Triangle> triangles,
                        const std::function<void(Index, Index)>& visit) {
  if (!visit_boxes(points, triangles, visit)) NearPairs(points, triangles, visit).run();
}

}  // namespace tetproof::oracles
