#include "mesher/plane/mending.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "mesher/geometry/box_tree.h"
#include "mesher/predicates/signs_of_doubles.h"

namespace delmesher::plane {
namespace {

using Point = std::array<double, 2>;
using Ends = std::array<std::uint32_t, 2>;
using geometry::Box;
using geometry::BoxTree;

const Point& point(const PlanarGraph& graph, std::uint32_t v) {
  return graph.vertices[v];
}

Box box_of(const Point& p, const Point& q) {
  Box box;
  box.extend({{p[0], p[1], 0}, {p[0], p[1], 0}});
  box.extend({{q[0], q[1], 0}, {q[0], q[1], 0}});
  return box;
}

BoxTree tree_of_segments(const PlanarGraph& graph) {
  std::vector<Box> boxes;
  boxes.reserve(graph.segments.size());
  for (const auto& [a, b] : graph.segments) {
    boxes.push_back(box_of(point(graph, a), point(graph, b)));
  }
  return BoxTree(boxes);
}

BoxTree tree_of_vertices(const PlanarGraph& graph) {
  std::vector<Box> boxes;
  boxes.reserve(graph.vertices.size());
  for (const Point& p : graph.vertices) boxes.push_back(box_of(p, p));
  return BoxTree(boxes);
}

enum class Meeting : std::uint8_t { none, same, overlap, crossing };

// Points on a line come in the order of their coordinates.
Meeting meeting(const PlanarGraph& graph, const Ends& s, const Ends& t) {
  const Point &a = point(graph, s[0]), &b = point(graph, s[1]), &c = point(graph, t[0]),
              &d = point(graph, t[1]);
  if (a == b || c == d) return Meeting::none;
  const int at_c = orient2d_sign(a, b, c), at_d = orient2d_sign(a, b, d);
  if (at_c * at_d > 0) return Meeting::none;
  if (at_c != 0 || at_d != 0) {
    return at_c * at_d < 0 && orient2d_sign(c, d, a) * orient2d_sign(c, d, b) < 0
               ? Meeting::crossing
               : Meeting::none;
  }
  const auto [s_low, s_high] = std::minmax(a, b);
  const auto [t_low, t_high] = std::minmax(c, d);
  if (s_low == t_low && s_high == t_high) return Meeting::same;
  return std::max(s_low, t_low) < std::min(s_high, t_high) ? Meeting::overlap : Meeting::none;
}

bool is_inside(const PlanarGraph& graph, const Ends& s, const Point& p) {
  const auto [low, high] = std::minmax(point(graph, s[0]), point(graph, s[1]));
  return low < p && p < high && orient2d_sign(low, high, p) == 0;
}

double squared(double x) {
  return x * x;
}

class Mender {
 public:
  Mender(PlanarGraph graph, std::vector<std::string>& done, base::Control& control)
      : graph_(std::move(graph)), done_(done), control_(control) {}

  PlanarGraph run(double weld_distance) {
    weld(weld_distance);
    drop_without_length();
    drop_repeated();
    constexpr int kRounds = 64;
    std::uint64_t crossings = 0, overlaps = 0;
    for (int round = 0; cut(crossings, overlaps); ++round) {
      if (round == kRounds) {
        throw base::Stopped{{StatusCode::limit_reached,
                             "rounded crossings make new ones without end: coordinates are too "
                             "coarse for the graph",
                             Limit::precision}};
      }
      if (weld_distance > 0) weld(weld_distance);
      drop_without_length();
      drop_repeated();
    }
    note(merged_, "vertex", "vertices", " merged with others");
    note(short_, "segment", "segments", " without length dropped");
    note(crossings, "crossing", "crossings", " made a vertex, rounded");
    note(overlaps, "overlap", "overlaps", " of segments cut out");
    note(repeated_, "segment", "segments", " dropped that were there before");
    return std::move(graph_);
  }

 private:
  void note(std::uint64_t count, const char* one, const char* more, const char* what) {
    if (count > 0) done_.push_back(std::to_string(count) + " " + (count == 1 ? one : more) + what);
  }

  // Vertices become the first one within the distance; the numbers of others stay in order.
  void weld(double distance) {
    const BoxTree tree = tree_of_vertices(graph_);
    const auto n = static_cast<std::uint32_t>(graph_.vertices.size());
    std::vector<std::uint32_t> first(n), number(n);
    std::vector<Point> vertices;
    for (std::uint32_t v = 0; v < n; ++v) {
      control_.poll();
      const Point& p = graph_.vertices[v];
      Box near = box_of(p, p);
      for (std::size_t k = 0; k < 2; ++k) {
        near.lo[k] -= distance;
        near.hi[k] += distance;
      }
      first[v] = v;
      tree.query(near, [&](std::uint32_t w) {
        const Point& q = graph_.vertices[w];
        const bool close =
            p == q || squared(p[0] - q[0]) + squared(p[1] - q[1]) <= squared(distance);
        if (w < first[v] && first[w] == w && close) first[v] = w;
        return true;
      });
      number[v] = first[v] == v ? static_cast<std::uint32_t>(vertices.size()) : number[first[v]];
      if (first[v] == v) vertices.push_back(p);
    }
    merged_ += n - vertices.size();
    graph_.vertices = std::move(vertices);
    for (auto& segment : graph_.segments) segment = {number[segment[0]], number[segment[1]]};
  }

  // The segments for which `keep(number)` is true.
  template <class Keep>
  void keep_segments(const Keep& keep) {
    std::uint32_t kept = 0;
    for (std::uint32_t s = 0; s < graph_.segments.size(); ++s) {
      if (!keep(s)) continue;
      graph_.segments[kept] = graph_.segments[s];
      if (!graph_.markers.empty()) graph_.markers[kept] = graph_.markers[s];
      if (!graph_.partitions.empty()) graph_.partitions[kept] = graph_.partitions[s];
      ++kept;
    }
    graph_.segments.resize(kept);
    if (!graph_.markers.empty()) graph_.markers.resize(kept);
    if (!graph_.partitions.empty()) graph_.partitions.resize(kept);
  }

  void drop_without_length() {
    const std::size_t before = graph_.segments.size();
    keep_segments([&](std::uint32_t s) { return graph_.segments[s][0] != graph_.segments[s][1]; });
    short_ += before - graph_.segments.size();
  }

  // Of rings, a segment that an even number of them have divides the inside, as in a file of rings.
  void drop_repeated() {
    std::map<Ends, std::pair<std::uint32_t, std::uint32_t>> seen;  // the first, and how many bound
    const bool rings = graph_.insideness == Insideness::nested;
    if (rings) graph_.partitions.resize(graph_.segments.size(), 0);
    for (std::uint32_t s = 0; s < graph_.segments.size(); ++s) {
      const auto [a, b] = graph_.segments[s];
      const auto found = seen.try_emplace(Ends{std::min(a, b), std::max(a, b)}, s, 0).first;
      if (rings && graph_.partitions[s] == 0) ++found->second.second;
    }
    if (rings) {
      for (const auto& [ends, count] : seen) graph_.partitions[count.first] = count.second % 2 == 0;
    }
    const std::size_t before = graph_.segments.size();
    keep_segments([&](std::uint32_t s) {
      const auto [a, b] = graph_.segments[s];
      return seen.at({std::min(a, b), std::max(a, b)}).first == s;
    });
    repeated_ += before - graph_.segments.size();
  }

  // On cd, in the boxes of both.
  Point crossing(const Ends& s, const Ends& t) const {
    const Point &a = point(graph_, s[0]), &b = point(graph_, s[1]), &c = point(graph_, t[0]),
                &d = point(graph_, t[1]);
    const auto height = [&](const Point& p) {
      return std::fabs((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]));
    };
    const double at_c = height(c), at_d = height(d), sum = at_c + at_d;
    const double share = sum > 0 && std::isfinite(sum) ? at_c / sum : 0.5;
    Point p;
    for (std::size_t k = 0; k < 2; ++k) {
      p[k] = std::clamp(c[k] + share * (d[k] - c[k]), std::min(c[k], d[k]), std::max(c[k], d[k]));
      p[k] = std::clamp(p[k], std::min(a[k], b[k]), std::max(a[k], b[k])) + 0.0;
    }
    return p;
  }

  // Cuts segments where they cross or overlap; false if none do.
  bool cut(std::uint64_t& crossings, std::uint64_t& overlaps) {
    std::vector<std::vector<std::uint32_t>> on(graph_.segments.size());
    std::map<Point, std::uint32_t> number;
    for (std::uint32_t v = 0; v < graph_.vertices.size(); ++v) number[graph_.vertices[v]] = v;
    const std::size_t given = graph_.vertices.size();
    bool any = false;
    std::vector<bool> is_cut(graph_.segments.size(), false);
    tree_of_segments(graph_).pairs([&](std::uint32_t i, std::uint32_t j) {
      control_.poll(graph_.vertices.size());
      const Ends s = graph_.segments[i], t = graph_.segments[j];
      const Meeting how = meeting(graph_, s, t);
      if (how == Meeting::none) return true;
      any = is_cut[i] = is_cut[j] = true;
      if (how == Meeting::crossing) {
        const Point p = crossing(s, t);
        const auto next = static_cast<std::uint32_t>(graph_.vertices.size());
        const auto [found, fresh] = number.try_emplace(p, next);
        if (fresh) graph_.vertices.push_back(p);
        on[i].push_back(found->second);
        on[j].push_back(found->second);
      }
      (how == Meeting::crossing ? crossings : overlaps) += 1;
      return true;
    });
    if (!any) return false;
    // Pieces are off the segment by rounding: vertices on it become theirs.
    const BoxTree vertices = tree_of_vertices(graph_);
    for (std::uint32_t i = 0; i < on.size(); ++i) {
      if (!is_cut[i]) continue;
      const Ends s = graph_.segments[i];
      vertices.query(box_of(point(graph_, s[0]), point(graph_, s[1])), [&](std::uint32_t v) {
        if (v < given && is_inside(graph_, s, point(graph_, v))) on[i].push_back(v);
        return true;
      });
    }
    replace_by_pieces(on);
    return true;
  }

  void replace_by_pieces(std::vector<std::vector<std::uint32_t>>& on) {
    PlanarGraph pieces;
    for (std::uint32_t i = 0; i < on.size(); ++i) {
      const auto [a, b] = graph_.segments[i];
      const Point &from = point(graph_, a), &to = point(graph_, b);
      const auto along = [&](std::uint32_t v) {
        const Point& p = point(graph_, v);
        return (p[0] - from[0]) * (to[0] - from[0]) + (p[1] - from[1]) * (to[1] - from[1]);
      };
      std::sort(on[i].begin(), on[i].end(), [&](std::uint32_t v, std::uint32_t w) {
        return along(v) != along(w) ? along(v) < along(w) : v < w;
      });
      on[i].push_back(b);
      std::uint32_t last = a;
      for (const std::uint32_t v : on[i]) {
        if (v == last) continue;
        pieces.segments.push_back({last, v});
        if (!graph_.markers.empty()) pieces.markers.push_back(graph_.markers[i]);
        if (!graph_.partitions.empty()) pieces.partitions.push_back(graph_.partitions[i]);
        last = v;
      }
    }
    graph_.segments = std::move(pieces.segments);
    graph_.markers = std::move(pieces.markers);
    graph_.partitions = std::move(pieces.partitions);
  }

  PlanarGraph graph_;
  std::vector<std::string>& done_;
  base::Control& control_;
  std::uint64_t merged_ = 0, short_ = 0, repeated_ = 0;
};

}  // namespace

std::array<std::vector<std::array<std::uint32_t, 2>>, kGraphDefects> defects_of(
    const PlanarGraph& graph, base::Control& control) {
  constexpr std::size_t kMost = 1'000'000;
  std::array<std::vector<Ends>, kGraphDefects> found;
  const auto add = [&](GraphDefect kind, std::uint32_t i, std::uint32_t j) {
    auto& list = found[static_cast<std::size_t>(kind)];
    if (list.size() < kMost) list.push_back({std::min(i, j), std::max(i, j)});
  };
  std::vector<std::uint32_t> order(graph.vertices.size());
  std::iota(order.begin(), order.end(), std::uint32_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t v, std::uint32_t w) {
    return point(graph, v) < point(graph, w);
  });
  for (std::size_t k = 1; k < order.size(); ++k) {
    if (point(graph, order[k - 1]) == point(graph, order[k])) {
      add(GraphDefect::equal_vertices, order[k - 1], order[k]);
    }
  }
  for (std::uint32_t s = 0; s < graph.segments.size(); ++s) {
    const auto [a, b] = graph.segments[s];
    if (point(graph, a) == point(graph, b)) add(GraphDefect::no_length, s, s);
  }
  tree_of_segments(graph).pairs([&](std::uint32_t i, std::uint32_t j) {
    control.poll();
    const Meeting how = meeting(graph, graph.segments[i], graph.segments[j]);
    if (how == Meeting::overlap) add(GraphDefect::overlap, i, j);
    if (how == Meeting::crossing) add(GraphDefect::crossing, i, j);
    return true;
  });
  for (auto& list : found) std::sort(list.begin(), list.end());
  return found;
}

PlanarGraph mended(const PlanarGraph& graph, double weld, std::vector<std::string>& done,
                   base::Control& control) {
  return Mender(graph, done, control).run(weld);
}

}  // namespace delmesher::plane
