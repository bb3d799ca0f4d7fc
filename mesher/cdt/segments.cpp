#include "mesher/cdt/segments.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "mesher/base/check.h"
#include "mesher/base/epoch.h"
#include "mesher/base/flat_map.h"
#include "mesher/predicates/exact_point.h"
#include "mesher/predicates/placement.h"
#include "mesher/predicates/vector.h"

namespace delmesher::cdt {
namespace {

// Relative to the shorter part of a split: how far a point may be from its target so that its
// parameter is short.
constexpr double kPlacementTolerance = 0x1p-20;
// Edges are only said to run along each other up to this distance, relative to the length of a
// part.
constexpr double kBeside = 0x1p-6;
// Parts of an edge, as a share of it, below which short ends are accepted around an acute vertex.
constexpr double kDeep = 0x1p-6;

Vec3 scaled_difference(const Vec3& a, const Vec3& b, double scale) {
  return {(a[0] - b[0]) / scale, (a[1] - b[1]) / scale, (a[2] - b[2]) / scale};
}
// ------------------------------------------------------------------------------ placing a point

// Where to split: fractions of the edge from both its ends; the point is anchored at `anchor`.
struct Target {
  std::array<double, 2> from;
  int anchor;        // end whose fraction counts
  double tolerance;  // as a fraction of the edge
  double low = 0;    // added to the fraction: more than 53 bits, with no tolerance then
};

// Fraction of the edge between two nodes, from the end where it is more accurate.
double fraction_between(const ChainNode& a, const ChainNode& b) {
  return b.from[0] <= a.from[1] ? b.from[0] - a.from[0] : a.from[1] - b.from[1];
}

// The point at fraction `step` behind node a.
Target target_behind(const ChainNode& a, const ChainNode& b, double step) {
  const double rest = fraction_between(a, b) - step;
  Target t;
  // Each fraction from the nearer neighbour: exact cancellation is not to be expected.
  t.from[0] = step <= rest ? a.from[0] + step : b.from[0] - rest;
  t.from[1] = step <= rest ? a.from[1] - step : b.from[1] + rest;
  t.anchor = t.from[0] <= t.from[1] ? 0 : 1;
  t.tolerance = kPlacementTolerance * std::min(step, rest);
  return t;
}

// Something is nearer to the edge than points on it can be placed.
[[noreturn]] void stop_beside(const Chains& chains, std::uint32_t edge) {
  const std::array<VertexId, 2> end = chains.topology().edge_vertices(edge);
  stop_at_precision("edge " + std::to_string(end[0]) + "-" + std::to_string(end[1]));
}

class Placer {
 public:
  Placer(Chains& chains, PointStore& points, Predicates& predicates)
      : chains_(chains), points_(points), predicates_(predicates) {}

  // Adds the point and its node; falls back to the middle if the target cannot be met strictly
  // between the neighbours. Returns the new node.
  std::uint32_t split(std::uint32_t node, const Target& target) {
    const ChainNode a = chains_.node(node), b = chains_.next(node);
    const double width = fraction_between(a, b);
    std::array<Target, 3> tries = {target, target_behind(a, b, width / 2),
                                   target_behind(a, b, width / 2)};
    tries[2].tolerance = 0;
    for (const Target& t : tries) {
      const VertexId v = add(a.edge, t);
      if (predicates_.dot_sign(a.vertex, v, b.vertex) < 0) {
        return chains_.insert_after(node, v, fractions(v, t));
      }
      points_.pop_back();
    }
    // Parts of an edge become that short beside something nearer than doubles can say where.
    const double place = std::max(std::min(a.from[0], a.from[1]), std::min(b.from[0], b.from[1]));
    DELMESHER_CHECK(width <= 0x1p-50 * place, "a subsegment cannot be split");
    stop_beside(chains_, a.edge);
  }

 private:
  VertexId add(std::uint32_t edge, const Target& t) {
    const SurfaceTopology& s = chains_.topology();
    const std::array<VertexId, 2> end = s.edge_vertices(edge);
    const double f = t.from[t.anchor];
    const double u = shortest_dyadic(f - t.tolerance, f + t.tolerance);
    const VertexId p = end[1 - t.anchor], q = end[t.anchor];
    // q + u (p - q) + low (p - q): a point of a triangle with two equal corners has two parameters.
    const VertexId v =
        t.low == 0 ? points_.add_on_segment(p, q, u) : points_.add_on_triangle(p, p, q, u, t.low);
    const std::array<std::uint32_t, 2> h = s.edge_half_edges(edge);
    std::array<PlaneId, 2> planes = {s.facet_plane[s.facet_of_half_edge(h[0])],
                                     s.facet_plane[s.facet_of_half_edge(h[1])]};
    std::sort(planes.begin(), planes.end());
    const std::size_t count = planes[0] == planes[1] ? 1 : 2;
    points_.set_supports(v, {planes.data(), count}, {&edge, 1});
    return v;
  }
  std::array<double, 2> fractions(VertexId v, const Target& t) const {
    const double u = points_.definition(v).u;
    return t.anchor == 0 ? std::array<double, 2>{u, 1 - u} : std::array<double, 2>{1 - u, u};
  }

  Chains& chains_;
  PointStore& points_;
  Predicates& predicates_;
};

// ------------------------------------------------------------------------------------- recovery

class SegmentRecovery {
 public:
  SegmentRecovery(Tetrahedrization& mesh, Chains& chains, PointStore& points, Control& control)
      : mesh_(mesh),
        predicates_(mesh.predicates()),
        chains_(chains),
        points_(points),
        control_(control),
        placer_(chains, points, mesh.predicates()) {}

  std::vector<VertexId> run() {
    find_missing();
    if (queue_.empty()) return {};
    find_acute_vertices();
    for (std::uint32_t n = 0; n < chains_.size(); ++n) {
      centre_.push_back(chains_.is_subsegment(n) ? initial_centre(chains_.node(n).edge)
                                                 : kNoCentre);
      if (chains_.is_subsegment(n)) remember(n);
    }
    for (std::size_t i = 0; i < queue_.size(); ++i) {
      control_.poll(points_.size());
      recover(queue_[i]);
      if (i >= (1U << 16)) {  // the finished part of the queue
        queue_.erase(queue_.begin(), queue_.begin() + (1 << 16));
        i -= 1U << 16;
      }
    }
    return std::move(added_);
  }

 private:
  // The end of the original edge around which a subsegment's splits lie on common spheres.
  enum Centre : std::uint8_t { kEnd0 = 0, kEnd1 = 1, kNoCentre = 2, kBothEnds = 3 };

  void remember(std::uint32_t n) {
    subsegments_.set(pair_key(chains_.node(n).vertex, chains_.next(n).vertex), n);
  }

  // Puts all missing subsegments in the queue: each is looked for around the end that has fewer
  // subsegments, so that no vertex of high degree is visited more than a few times.
  void find_missing() {
    std::vector<std::array<std::uint32_t, 2>> by_vertex;  // vertex, node
    for (std::uint32_t n = 0; n < chains_.size(); ++n) {
      if (!chains_.is_subsegment(n)) continue;
      const VertexId a = chains_.node(n).vertex, b = chains_.next(n).vertex;
      by_vertex.push_back({chains_.valence(b) < chains_.valence(a) ? b : a, n});
    }
    std::sort(by_vertex.begin(), by_vertex.end());
    std::vector<std::uint32_t> seen(points_.size(), kNone);  // vertex -> whose neighbour it is
    VertexId around = kNone;
    for (const auto& [v, n] : by_vertex) {
      control_.poll(points_.size());
      if (v != around) {
        around = v;
        for (const TetId t : mesh_.star(v)) {
          for (int i = 0; i < 4; ++i) {
            if (mesh_.vertex(t, i) != kInfinite) seen[mesh_.vertex(t, i)] = v;
          }
        }
      }
      const VertexId a = chains_.node(n).vertex, b = chains_.next(n).vertex;
      if (seen[a == v ? b : a] != v) queue_.push_back(n);
    }
    std::sort(queue_.begin(), queue_.end());
  }

  // Vertices at which two constrained edges meet at less than 90 degrees. Seven directions always
  // contain such a pair.
  void find_acute_vertices() {
    const SurfaceTopology& s = chains_.topology();
    std::vector<std::vector<std::uint32_t>> others(s.vertex_half_edge.size());
    acute_.assign(others.size(), 0);
    for (std::uint32_t e = 0; e < s.edge_count(); ++e) {
      if (s.edge_is_flat[e] != 0) continue;
      const std::array<VertexId, 2> end = s.edge_vertices(e);
      for (int k = 0; k < 2; ++k) {
        if (acute_[end[k]] != 0) continue;
        others[end[k]].push_back(end[1 - k]);
        if (others[end[k]].size() == 7) acute_[end[k]] = 1;
      }
    }
    for (VertexId v = 0; v < others.size(); ++v) {
      const std::vector<std::uint32_t>& o = others[v];
      for (std::size_t i = 0; i < o.size() && acute_[v] == 0; ++i) {
        for (std::size_t j = 0; j < i && acute_[v] == 0; ++j) {
          acute_[v] = predicates_.dot_sign(o[i], v, o[j]) > 0 ? 1 : 0;
        }
      }
    }
  }

  Centre initial_centre(std::uint32_t edge) const {
    const std::array<VertexId, 2> end = chains_.topology().edge_vertices(edge);
    const bool acute0 = acute_[end[0]] != 0, acute1 = acute_[end[1]] != 0;
    return acute0 ? (acute1 ? kBothEnds : kEnd0) : (acute1 ? kEnd1 : kNoCentre);
  }

  void recover(std::uint32_t n) {
    VertexId a = chains_.node(n).vertex, b = chains_.next(n).vertex;
    if (find_edge(mesh_, chains_, a, b) != kNone) return;
    if (chains_.valence(b) < chains_.valence(a)) std::swap(a, b);
    const Centre centre = static_cast<Centre>(centre_[n]);
    const std::uint32_t m = placer_.split(n, choose_target(n, centre, a, b));
    centre_[n] = centre == kBothEnds ? kEnd0 : centre;
    centre_.push_back(centre == kBothEnds ? kEnd1 : centre);
    remember(n);
    remember(m);
    const VertexId v = chains_.node(m).vertex;
    added_.push_back(v);
    DELMESHER_CHECK(mesh_.insert(v, mesh_.incident(a)), "a vertex lies on a constrained edge");
    queue_.push_back(n);
    queue_.push_back(m);
    requeue_destroyed(v);
  }

  // Queues the subsegments that the last insertion has removed: edges of the cavity that are not
  // on its boundary.
  void requeue_destroyed(VertexId v) {
    kept_.clear();
    for (const TetId t : mesh_.created()) {
      const int f = mesh_.index_of(t, v);
      for (int k = 0; k < 3; ++k) {
        // Each edge of the boundary has two faces, which traverse it in both directions.
        const VertexId a = mesh_.vertex(t, kFace[f][k]), b = mesh_.vertex(t, kFace[f][(k + 1) % 3]);
        if (a < b) kept_.push_back(pair_key(a, b));
      }
    }
    std::sort(kept_.begin(), kept_.end());
    for (const TetId t : mesh_.cavity()) {
      for (const auto& e : kEdge) {
        const VertexId a = mesh_.vertex(t, e[0]), b = mesh_.vertex(t, e[1]);
        if (chains_.valence(a) == 0 || chains_.valence(b) == 0) continue;
        const std::uint64_t key = pair_key(a, b);
        if (std::binary_search(kept_.begin(), kept_.end(), key)) continue;
        const std::uint32_t n = subsegments_.get(key, kNone);
        if (n == kNone) continue;
        if (queue_.back() != n) queue_.push_back(n);
      }
    }
  }

  // ---- the splitting rule

  Target choose_target(std::uint32_t n, Centre centre, VertexId a, VertexId b) {
    const ChainNode &u = chains_.node(n), &w = chains_.next(n);
    const double width = fraction_between(u, w);
    const Target middle = target_behind(u, w, width / 2);
    if (centre == kBothEnds) return middle;
    const VertexId reference = find_reference(a, b);
    if (reference == kNone) return middle;
    const double length = chains_.length(u.edge);
    const Vec3 r = points_.nearest(reference);
    if (centre == kNoCentre) {
      bool soon = false;
      if (Target t{}; target_opposite(u, w, reference, t, soon)) return t;
      if (soon) return middle;
      const double to_u = safe_distance(r, points_.nearest(u.vertex)) / length;
      const double to_w = safe_distance(r, points_.nearest(w.vertex)) / length;
      const double step = std::min(to_u, to_w);
      // Written so that a NaN means the middle, here and below.
      if (!(step > 0 && step <= width / 2)) return middle;
      return target_behind(u, w, to_u <= to_w ? step : width - step);
    }
    return on_sphere(u, w, centre, reference, middle);
  }

  // Opposite a reference on an edge that runs along this one. By their distances from different
  // ends, points of edges at a distance d would not face each other: each new point would be the
  // reference of the next one on the other edge, a distance d farther on. Facing each other they
  // are done with, if they do so up to d^2 / L: farther from its place, a point is in the diametral
  // ball of a part of length L of the other edge, and a part between two other edges may be missing
  // for good. Hence the reference's projection, with twice as many bits where it takes them, and
  // only where the edges are parallel enough for the projection back to be as near. `soon` says
  // that they will be when this part has been halved a few times.
  bool target_opposite(const ChainNode& u, const ChainNode& w, VertexId reference, Target& t,
                       bool& soon) const {
    const Vec3 along = points_.difference(u.vertex, w.vertex);
    const double part = safe_distance(along, {});
    const Vec3 to_reference = points_.difference(u.vertex, reference);
    const Vec3 d = scaled_difference(along, {}, part),
               f = scaled_difference(to_reference, {}, part);
    const double place = dot(d, f), squared_off = dot(cross(d, f), cross(d, f));
    if (!(place > 0 && place < 1 && squared_off < kBeside * kBeside)) return false;
    const double parallel = std::sqrt(squared_off) / 16;
    if (!runs_along(u.edge, reference, parallel)) {
      constexpr double kSoon = 256;
      soon = runs_along(u.edge, reference, kSoon * parallel);
      return false;
    }
    const std::array<VertexId, 2> end = chains_.topology().edge_vertices(u.edge);
    t = target_behind(u, w, place * fraction_between(u, w));
    const VertexId apex = end[t.anchor], other = end[1 - t.anchor];
    // In units of a power of two near the length: squares may overflow otherwise.
    int exponent = 0;
    std::frexp(chains_.length(u.edge), &exponent);
    Dyadic whole = squared_distance(apex, other), share = product(apex, reference, other);
    if (share.sign() <= 0) return false;
    whole.exponent -= 2 * exponent;
    share.exponent -= 2 * exponent;
    double& fraction = t.from[t.anchor];
    fraction = round_to_double(share).value / round_to_double(whole).value;
    t.from[1 - t.anchor] = 1 - fraction;
    t.tolerance = std::min(t.tolerance, squared_off / 16 * part / chains_.length(u.edge));
    if (t.tolerance > fraction * 0x1p-50) return true;
    t.tolerance = 0;
    t.low = round_to_double(share - whole * Dyadic::from_double(fraction)).value /
            round_to_double(whole).value;
    return true;
  }
  // Is v on another edge whose direction differs by at most this sine?
  bool runs_along(std::uint32_t edge, VertexId v, double sine) const {
    const SurfaceTopology& s = chains_.topology();
    if (const std::uint32_t n = chains_.node_of(v); n != kNone) {
      return sine_between(edge, chains_.node(n).edge) <= sine;
    }
    const std::uint32_t start = v < s.vertex_half_edge.size() ? s.vertex_half_edge[v] : kNone;
    if (start == kNone) return false;
    std::uint32_t h = start;
    do {
      const std::uint32_t other = s.edge_of[h];
      if (s.edge_is_flat[other] == 0 && sine_between(edge, other) <= sine) return true;
      h = s.opposite[SurfaceTopology::previous(h)];
    } while (h != start);
    return false;
  }
  double sine_between(std::uint32_t e, std::uint32_t f) const {
    const auto direction = [&](std::uint32_t edge) {
      const std::array<VertexId, 2> end = chains_.topology().edge_vertices(edge);
      return scaled_difference(points_.nearest(end[1]), points_.nearest(end[0]),
                               chains_.length(edge));
    };
    return norm(cross(direction(e), direction(f)));
  }

  // (v - a) . (b - a)
  Dyadic product(VertexId a, VertexId v, VertexId b) const {
    const DyadicPoint origin = exact_point(points_, a), p = exact_point(points_, v),
                      q = exact_point(points_, b);
    Dyadic sum;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      sum = sum + (p[axis] - origin[axis]) * (q[axis] - origin[axis]);
    }
    return sum;
  }

  // Where the sphere around the acute end through the reference meets the subsegment. All points
  // around an acute vertex must be on the same spheres up to less than the angles there, hence all
  // 53 bits of the parameter, anchored at that vertex.
  Target on_sphere(const ChainNode& u, const ChainNode& w, int centre, VertexId reference,
                   const Target& middle) {
    const double length = chains_.length(u.edge);
    const VertexId apex = chains_.topology().edge_vertices(u.edge)[centre];
    const double radius = distance_from_apex(apex, reference) / length;
    const ChainNode& near = centre == 0 ? u : w;
    const ChainNode& far = centre == 0 ? w : u;
    const double step = radius - near.from[centre], rest = far.from[centre] - radius;
    const double width = fraction_between(u, w);
    // Points on different spheres that halve their parts instead may be each other's references,
    // all the way down to the apex; at some depth they have to meet on one.
    const bool deep = width < kDeep;
    const double least = (deep ? 0.02 : 0.2) * width;
    if (!(step >= least && rest >= least)) return middle;
    Target t;
    t.anchor = centre;
    t.tolerance = 0;
    t.from[centre] = radius;
    t.from[1 - centre] = 1 - radius;
    sharpen(t, u.edge, reference);
    const Vec3 p = points_.nearest(near.vertex), q = points_.nearest(far.vertex);
    Vec3 x;
    for (int k = 0; k < 3; ++k) x[k] = p[k] + (q[k] - p[k]) * (step / width);
    if (!deep && rest * length < safe_distance(x, points_.nearest(reference))) return middle;
    return t;
  }

  // By the chain's own parameter where possible: coordinates are too coarse far from the origin.
  double distance_from_apex(VertexId apex, VertexId v) const {
    const std::uint32_t n = chains_.node_of(v);
    if (n != kNone) {
      const std::uint32_t edge = chains_.node(n).edge;
      const std::array<VertexId, 2> end = chains_.topology().edge_vertices(edge);
      for (int k = 0; k < 2; ++k) {
        if (end[k] == apex) return chains_.node(n).from[k] * chains_.length(edge);
      }
    }
    return safe_distance(points_.nearest(apex), points_.nearest(v));
  }

  // At angles below 2^-40 a radius of 53 bits is not enough for two points to be on the same sphere
  // up to less than their distance d. An edge of length L between two others that run along it
  // (shells inside each other) even needs it up to d^2 / L: a sphere through its ends that keeps
  // clear of the one point meets the other. Then the target gets twice as many bits, by exact
  // Newton steps for |apex + t (end - apex)| = |reference - apex|.
  void sharpen(Target& target, std::uint32_t edge, VertexId reference) {
    const std::array<VertexId, 2> end = chains_.topology().edge_vertices(edge);
    const VertexId apex = end[target.anchor], other = end[1 - target.anchor];
    double& fraction = target.from[target.anchor];
    const double length = chains_.length(edge);
    const Vec3 d = scaled_difference(points_.nearest(other), points_.nearest(apex), length);
    const Vec3 f =
        scaled_difference(points_.nearest(reference), points_.nearest(apex), fraction * length);
    const double squared_sine = dot(cross(d, f), cross(d, f));
    if (!(squared_sine < 0x1p-20)) return;
    // Below that no two points can be matched by the parameters a point has, and splitting goes on
    // for ever. Edges of doubles of about the same size never come so close to each other.
    if (squared_sine < 0x1p-212) ++hopeless_;
    if (hopeless_ == 1024) stop_beside(chains_, edge);
    const Dyadic squared_radius = squared_distance(apex, reference);
    const Dyadic squared_length = squared_distance(apex, other);
    // In units of a power of two near the length: squares may overflow otherwise.
    int exponent = 0;
    const double mantissa = std::frexp(length, &exponent);
    for (int step = 0; step < 2; ++step) {
      fraction += target.low;
      const Dyadic t = Dyadic::from_double(fraction);
      Dyadic difference = squared_radius - squared_length * t * t;
      if (difference.sign() != 0) difference.exponent -= 2 * exponent;
      target.low = round_to_double(difference).value / (2 * fraction * mantissa * mantissa);
    }
  }
  Dyadic squared_distance(VertexId a, VertexId b) const { return product(a, b, b); }

  // Does the segment ab meet the closed triangle pqr (not coplanar)?
  bool meets(VertexId a, VertexId b, VertexId p, VertexId q, VertexId r) {
    const int side_a = predicates_.orient3d(p, q, r, a);
    const int side_b = predicates_.orient3d(p, q, r, b);
    if (side_a * side_b > 0 || (side_a == 0 && side_b == 0)) return false;
    const int x = predicates_.orient3d(a, b, p, q);
    const int y = predicates_.orient3d(a, b, q, r);
    if (x * y < 0) return false;
    const int z = predicates_.orient3d(a, b, r, p);
    return x * z >= 0 && y * z >= 0;
  }

  // Among the vertices of the tetrahedra that the segment ab crosses and that lie in its diametral
  // ball, the one that sees it under the largest circumcircle. In doubles: it only guides.
  VertexId find_reference(VertexId a, VertexId b) {
    const Vec3 p = points_.nearest(a), q = points_.nearest(b);
    const double length = safe_distance(p, q);
    VertexId best = kNone;
    double best_sine = 2;
    if (mark_.size() < mesh_.capacity()) mark_.resize(mesh_.capacity() * 3 / 2, 0);
    next_epoch(epoch_, mark_);
    crossed_.clear();
    for (const TetId t : mesh_.star(a)) visit(t);
    for (std::size_t n = 0; n < crossed_.size(); ++n) {
      control_.poll(points_.size());
      const TetId t = crossed_[n];
      for (int i = 0; i < 4; ++i) {
        const VertexId v = mesh_.vertex(t, i);
        if (v != a && v != b) consider(v, p, q, length, best, best_sine);
        const TetId next = mesh_.neighbor(t, i);
        if (mark_[next] == epoch_ || mesh_.is_ghost(next)) continue;
        const VertexId x = mesh_.vertex(t, kFace[i][0]), y = mesh_.vertex(t, kFace[i][1]),
                       z = mesh_.vertex(t, kFace[i][2]);
        if (x == a || y == a || z == a) continue;
        if (meets(a, b, x, y, z)) visit(next);
      }
    }
    return best;
  }
  void visit(TetId t) {
    if (mesh_.is_ghost(t)) return;
    mark_[t] = epoch_;
    crossed_.push_back(t);
  }
  void consider(VertexId v, const Vec3& p, const Vec3& q, double length, VertexId& best,
                double& best_sine) const {
    if (v == best) return;
    const Vec3 x = points_.nearest(v);
    const Vec3 f = scaled_difference(p, x, length), g = scaled_difference(q, x, length);
    if (!(dot(f, g) < 0)) return;
    const Vec3 normal = cross(f, g);
    const double sine = dot(normal, normal) / (dot(f, f) * dot(g, g));
    if (sine < best_sine || (sine == best_sine && v < best)) {
      best = v;
      best_sine = sine;
    }
  }

  Tetrahedrization& mesh_;
  Predicates& predicates_;
  Chains& chains_;
  PointStore& points_;
  Control& control_;
  Placer placer_;
  FlatMap subsegments_;               // end vertices -> node
  std::vector<std::uint8_t> acute_;   // per input vertex
  std::vector<std::uint8_t> centre_;  // per node
  std::vector<std::uint32_t> queue_;  // nodes whose subsegment may be missing
  std::vector<VertexId> added_;
  std::vector<std::uint64_t> kept_;
  std::vector<std::uint32_t> mark_;
  std::uint32_t epoch_ = 0;
  std::vector<TetId> crossed_;
  std::uint32_t hopeless_ = 0;
};

}  // namespace

std::vector<VertexId> recover_segments(Tetrahedrization& mesh, Chains& chains, PointStore& points,
                                       Control& control) {
  return SegmentRecovery(mesh, chains, points, control).run();
}

VertexId split_in_the_middle(Chains& chains, std::uint32_t node, PointStore& points,
                             Predicates& predicates) {
  const ChainNode &a = chains.node(node), &b = chains.next(node);
  const Target middle = target_behind(a, b, fraction_between(a, b) / 2);
  return chains.node(Placer(chains, points, predicates).split(node, middle)).vertex;
}

}  // namespace delmesher::cdt
