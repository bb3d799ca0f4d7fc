#include "mesher/plane/chamfer.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "mesher/base/check.h"
#include "mesher/base/epoch.h"
#include "mesher/geometry/placement.h"
#include "mesher/plane/line.h"
#include "mesher/predicates/predicates.h"

namespace delmesher::plane {
namespace {

class Chamferer {
 public:
  Chamferer(const InputGraph& graph, PointStore& points, PlanePredicates& predicates,
            const ChamferOptions& options, Spared& spared, Control& control)
      : graph_(graph),
        base_(graph.base),
        points_(points),
        predicates_(predicates),
        spatial_(points),
        options_(options),
        spared_(spared),
        control_(control),
        seen_(base_.size(), 0) {}

  // No double is beside a corner with a chamfer below that, whose points are placed to 2^-20 of it.
  static constexpr double kLeastDistance = 0x1p-1040;

  Chamfered run() {
    constexpr std::uint64_t kRounds = 50;
    spared_.piece.resize(graph_.pieces.size(), 0);
    spared_.vertex.resize(graph_.vertices, 0);
    do {
      ++result_.rounds;
      while (!find_corners()) {
      }
    } while (options_.tau > 0 && result_.rounds < kRounds && drop_narrow());
    cut();
    return std::move(result_);
  }

 private:
  bool kept(PieceId p) const { return p != kNone && spared_.piece[p] == 0; }

  Point point(VertexId v) const {
    const Approximation& a = points_.approximation(v);
    return {a.x, a.y};
  }

  // False if a corner was spared, which may change others.
  bool find_corners() {
    bool all = true;
    distance_.assign(graph_.vertices, -1);
    for (VertexId v = 0; v < graph_.vertices; ++v) {
      control_.poll(points_.size());
      if (spared_.vertex[v] != 0 || !acute(v)) continue;
      const auto found = feature_size_.find(v);
      double r = found != feature_size_.end()
                     ? found->second
                     : feature_size_.emplace(v, feature_size(v)).first->second;
      r /= 3;
      if (options_.max_radius > 0) r = std::min(r, options_.max_radius);
      if (r < kLeastDistance) {
        spare(v);
        all = false;
      }
      distance_[v] = r;
    }
    return all;
  }

  // The vertex and its pieces are left to the last step.
  void spare(VertexId v) {
    spared_.vertex[v] = 1;
    for (PieceId p = kBoxPieces; p < graph_.pieces.size(); ++p) {
      const Piece& piece = graph_.pieces[p];
      if ((piece.a == v || piece.b == v) && kept(p)) drop(p);
    }
  }

  void drop(PieceId p) {
    spared_.piece[p] = 1;
    ++spared_.count;
  }

  // Do two neighbouring segments form a sharp corner on a side that will be refined?
  bool acute(VertexId v) {
    base_.star(v, star_);
    spokes_.clear();
    for (const EdgeId e : star_) {
      const EdgeId spoke = edge_of(triangle_of(e), previous(index_of(e)));  // from v to origin(e)
      const bool inside = options_.everywhere || graph_.inside[triangle_of(e)] != 0;
      if (kept(base_.piece(spoke))) {
        spokes_.push_back({base_.origin(e), inside});
      } else if (!spokes_.empty()) {
        spokes_.back().inside = spokes_.back().inside || inside;
      } else {
        before_first_ = before_first_ || inside;
      }
    }
    if (!spokes_.empty()) spokes_.back().inside = spokes_.back().inside || before_first_;
    before_first_ = false;
    if (spokes_.size() < 2) return false;
    for (std::size_t k = 0; k < spokes_.size(); ++k) {
      const VertexId u = spokes_[k].to, w = spokes_[(k + 1) % spokes_.size()].to;
      if (spokes_[k].inside && angle_below(u, v, w)) return true;
    }
    return false;
  }

  // Is the angle from vu counter-clockwise to vw below the threshold?
  //
  // In doubles where they are certain. Let e = 2^-53, and U the exact |u| |w|. Differences are
  // rounded, so the computed dot is off by at most 4 e U (not of itself: its products may cancel),
  // its square by 9 e U^2; the threshold, at most U^2, by 10 e of itself; and their difference is
  // rounded. Together less than 21 e U^2, and 2^-48 U^2 is 32 e U^2, also as computed. Coordinates
  // of the store are at most about 1: where `scale` is not tiny no underflow counts beside that.
  bool angle_below(VertexId u, VertexId v, VertexId w) {
    if (predicates_.dot(u, v, w) <= 0 || predicates_.orient(v, u, w) <= 0) return false;
    const Point a = point(u), b = point(v), c = point(w);
    const double ux = a[0] - b[0], uy = a[1] - b[1], wx = c[0] - b[0], wy = c[1] - b[1];
    const double dot = ux * wx + uy * wy;
    const double uu = ux * ux + uy * uy, ww = wx * wx + wy * wy, scale = uu * ww;
    const double excess = dot * dot - options_.cosine_squared * uu * ww;
    if (scale > 0x1p-900 && std::fabs(excess) > scale * 0x1p-48) return excess > 0;
    return spatial_.angle_below(u, v, w, options_.cosine_squared);
  }

  // Distance from v to the nearest vertex or segment that it is not an end of. The nearest one can
  // be seen from v: a walk through the triangles around that does not pass segments.
  double feature_size(VertexId v) {
    const Point p = point(v);
    double best = HUGE_VAL;
    const auto meet = [&](VertexId u) {
      if (!graph_.is_box_corner(u)) best = std::min(best, distance(p, point(u)));
    };
    next_epoch(epoch_, seen_);
    base_.star(v, star_);
    for (const EdgeId e : star_) {
      meet(base_.origin(e));
      seen_[triangle_of(e)] = epoch_;
    }
    std::vector<EdgeId>& stack = star_;
    while (!stack.empty()) {
      const EdgeId e = stack.back();
      stack.pop_back();
      const double d = Line{point(base_.origin(e)), point(base_.target(e))}.distance_to(p);
      if (base_.piece(e) != kNone) {
        if (base_.piece(e) >= kBoxPieces) best = std::min(best, d);
        continue;
      }
      const EdgeId f = base_.twin(e);
      if (!(d < best) || seen_[triangle_of(f)] == epoch_) continue;
      seen_[triangle_of(f)] = epoch_;
      meet(base_.opposite(f));
      stack.push_back(edge_of(triangle_of(f), next(index_of(f))));
      stack.push_back(edge_of(triangle_of(f), previous(index_of(f))));
    }
    return best;
  }

  // A piece without the parts that are cut off.
  Line middle(PieceId id) const {
    const Piece& piece = graph_.pieces[id];
    const Line whole{point(piece.a), point(piece.b)};
    const double length = whole.length();
    const auto cut_at = [&](VertexId v) {
      return v < graph_.vertices && distance_[v] > 0 && length > 0 ? distance_[v] / length : 0.0;
    };
    return {whole.at(cut_at(piece.a)), whole.at(1 - cut_at(piece.b))};
  }

  bool share_vertex(const Piece& p, const Piece& q) const {
    for (const VertexId v : {p.a, p.b}) {
      if ((v == q.a || v == q.b) && !(v < graph_.vertices && distance_[v] > 0)) return true;
    }
    return false;
  }

  // The squares that fit into the part of a channel along s on one side of where it is narrowest.
  // Its width is convex along s, so between two widths there are at least as many as beside a
  // straight line.
  static double squares(const Line& s, const Line& t, double narrowest, double end, double width) {
    const double length = s.length();
    double sum = 0, from = narrowest, w = width;
    while (from != end) {
      double to = end;
      if (t.distance_to(s.at(end)) > 2 * w) {
        double near = from, away = end;
        for (int k = 0; k < 60; ++k) {
          const double half = (near + away) / 2;
          (t.distance_to(s.at(half)) <= 2 * w ? near : away) = half;
        }
        if (near == from) break;  // as wide as long
        to = near;
      }
      const double wider = std::max(t.distance_to(s.at(to)), w);
      sum += std::fabs(to - from) * length / ((w + wider) / 2);
      from = to;
      w = wider;
    }
    return sum;
  }

  // How narrow the channel between two pieces is: length over width of the narrow part, where it is
  // at most four times as wide as at its narrowest, or of all squares that fit into it. A wedge
  // whose point was rounded away is long at every width.
  double narrowness(PieceId p, PieceId q) const {
    Line s = middle(p), t = middle(q);
    if (s.length() > t.length()) std::swap(s, t);
    const double x0 = t.nearest(s.a), x1 = t.nearest(s.b);
    double best = 0, width = HUGE_VAL;
    const auto consider = [&](double x) {
      const double d = t.distance_to(s.at(x));
      if (d < width) {
        width = d;
        best = x;
      }
    };
    for (const double x :
         {0.0, 1.0, s.nearest(t.at(x0)), s.nearest(t.at(x1)), s.nearest(t.a), s.nearest(t.b)}) {
      consider(x);
    }
    const auto size = [](const Point& x) { return std::max(std::fabs(x[0]), std::fabs(x[1])); };
    if (!(width > kFloor * size(s.at(best)))) return HUGE_VAL;
    const double length = s.length();
    // A width between pieces with ends far away is known to no more than this.
    const double blur = kFloor * std::max({size(s.a), size(s.b), size(t.a), size(t.b)});
    if (!(width > blur)) return length * options_.tau > blur ? HUGE_VAL : 0;
    if (length * options_.tau <= width) return length / width;  // not narrow, whatever it is
    // The distance from a line to a convex set is convex along the line: bisection.
    const auto end = [&](double x) {
      if (t.distance_to(s.at(x)) <= 4 * width) return x;
      double near = best, away = x;
      for (int k = 0; k < 40; ++k) {
        const double half = (near + away) / 2;
        (t.distance_to(s.at(half)) <= 4 * width ? near : away) = half;
      }
      return near;
    };
    return std::max((end(1) - end(0)) * length / width,
                    squares(s, t, best, 0, width) + squares(s, t, best, 1, width));
  }

  // Calls meet(piece) for the kept pieces that lie close beside the piece of an edge, on the side
  // of its triangle: across edges that come near to it, or leave its ends under a small angle.
  template <class Meet>
  void along_channel(EdgeId start, Meet&& meet) {
    constexpr int kMost = 64;  // triangles
    const VertexId a = base_.origin(start), b = base_.target(start);
    const Line side{point(a), point(b)};
    const double reach = 8 * options_.tau * side.length();
    const auto near = [&](VertexId v, VertexId other) {
      if (v == a || v == b) return false;
      const bool touching = other == a || other == b;
      const double d = side.distance_to(point(v));
      return d <= reach || (touching && d <= 8 * options_.tau * distance(point(v), point(other)));
    };
    next_epoch(epoch_, seen_);
    std::vector<EdgeId>& stack = star_;
    stack.assign(1, start);
    for (int count = 0; !stack.empty() && count < kMost; ++count) {
      const EdgeId from = stack.back();
      stack.pop_back();
      for (const int i : {next(index_of(from)), previous(index_of(from))}) {
        const EdgeId e = edge_of(triangle_of(from), i);
        if (kept(base_.piece(e))) {
          meet(base_.piece(e));
          continue;
        }
        const VertexId u = base_.origin(e), w = base_.target(e);
        const EdgeId f = base_.twin(e);
        if (f == kNone || seen_[triangle_of(f)] == epoch_) continue;
        if (!near(u, w) && !near(w, u)) {
          if (u == a || u == b || w == a || w == b) continue;
          if (side.distance_to_line({point(u), point(w)}) > reach) continue;
        }
        seen_[triangle_of(f)] = epoch_;
        stack.push_back(f);
      }
    }
  }

  // Drops the longer of the two pieces along every channel that is too narrow, the narrowest first;
  // false if there was none.
  bool drop_narrow() {
    struct Pair {
      double narrowness;
      PieceId p, q;
    };
    std::vector<Pair> pairs;
    std::vector<std::pair<std::array<PieceId, 2>, double>> channels;  // seen from both sides
    const auto consider = [&](PieceId p, PieceId q) {
      if (p < kBoxPieces || q < kBoxPieces || p == q || !kept(p) || !kept(q)) return;
      if (share_vertex(graph_.pieces[p], graph_.pieces[q])) return;
      const double n = narrowness(p, q);
      const std::array<PieceId, 2> pair = {std::min(p, q), std::max(p, q)};
      if (n * options_.tau > 1) {
        pairs.push_back({n, pair[0], pair[1]});
      } else {
        channels.push_back({pair, n});
      }
    };
    for (TriangleId t = 0; t < base_.size(); ++t) {
      control_.poll(points_.size());
      for (int i = 0; i < 3; ++i) {
        const EdgeId e = edge_of(t, i);
        const PieceId p = base_.piece(e);
        if (p != kNone && p >= kBoxPieces && kept(p))
          along_channel(e, [&](PieceId q) { consider(p, q); });
      }
    }
    std::sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) {
      return a.narrowness != b.narrowness ? a.narrowness > b.narrowness
             : a.p != b.p                 ? a.p < b.p
                                          : a.q < b.q;
    });
    for (const Pair& pair : pairs) {
      if (!kept(pair.p) || !kept(pair.q)) continue;
      const auto length = [&](PieceId p) {
        return distance(point(graph_.pieces[p].a), point(graph_.pieces[p].b));
      };
      drop(length(pair.p) > length(pair.q) ? pair.p : pair.q);
    }
    std::sort(channels.begin(), channels.end());
    channels.erase(std::unique(channels.begin(), channels.end()), channels.end());
    result_.channel_squares = 0;
    for (const auto& [pair, n] : channels) {
      if (kept(pair[0]) && kept(pair[1])) result_.channel_squares += n;
    }
    return !pairs.empty();
  }

  void cut() {
    std::vector<std::uint8_t> attached(graph_.vertices, 0);  // 1: has pieces, 2: has kept ones
    result_.ends.assign(graph_.pieces.size(), {kNone, kNone});
    for (PieceId id = 0; id < graph_.pieces.size(); ++id) {
      const Piece& piece = graph_.pieces[id];
      if (id >= kBoxPieces) {
        for (const VertexId v : {piece.a, piece.b}) {
          attached[v] = static_cast<std::uint8_t>(attached[v] | (kept(id) ? 3 : 1));
        }
      }
      if (!kept(id)) {
        result_.gaps.push_back({piece.a, piece.b, id});
        continue;
      }
      result_.ends[id] = {cut_point(id, piece.a), cut_point(id, piece.b)};
      result_.cut_pieces += result_.ends[id][0] != piece.a || result_.ends[id][1] != piece.b;
    }
    result_.vertex_kept.assign(graph_.vertices, 0);
    for (VertexId v = 0; v < graph_.vertices; ++v) {
      const bool alone = attached[v] == 1;  // all its pieces are dropped
      if (distance_[v] > 0) {
        result_.corners.push_back({v, distance_[v]});
      } else {
        result_.vertex_kept[v] = !alone && spared_.vertex[v] == 0;
      }
    }
  }

  // The end of a piece at its vertex v: v, or a new point beside it.
  VertexId cut_point(PieceId id, VertexId v) {
    if (v >= graph_.vertices || !(distance_[v] > 0)) return v;
    const Piece& piece = graph_.pieces[id];
    const Point p = point(v), q = point(v == piece.a ? piece.b : piece.a);
    const double t = distance_[v] / distance(p, q);
    const double dx = t * (q[0] - p[0]), dy = t * (q[1] - p[1]);
    const Vec3 target = {p[0] + dx, p[1] + dy, 0};
    // Far from the origin doubles are coarser than the distance asks for.
    const Vec3 rest = {dx - (target[0] - p[0]), dy - (target[1] - p[1]), 0};
    const VertexId c = points_.add(
        place_on_segment(points_, piece.a, piece.b, target, distance_[v] * 0x1p-20, true, rest));
    result_.gaps.push_back({v, c, id});
    return c;
  }

  struct Spoke {
    VertexId to;
    bool inside;  // something between it and the next one is
  };

  const InputGraph& graph_;
  const Triangulation& base_;
  PointStore& points_;
  PlanePredicates& predicates_;
  Predicates spatial_;
  const ChamferOptions& options_;
  Spared& spared_;
  Control& control_;
  Chamfered result_;
  std::vector<double> distance_;  // per input vertex; negative: not acute
  std::map<VertexId, double> feature_size_;
  std::vector<EdgeId> star_;
  std::vector<Spoke> spokes_;
  bool before_first_ = false;
  std::vector<std::uint32_t> seen_;  // per triangle: epoch of the last visit
  std::uint32_t epoch_ = 0;
};

}  // namespace

Chamfered chamfer(const InputGraph& graph, PointStore& points, PlanePredicates& predicates,
                  const ChamferOptions& options, Spared& spared, Control& control) {
  return Chamferer(graph, points, predicates, options, spared, control).run();
}

}  // namespace delmesher::plane
