#include "mesher/delaunay/planar.h"

#include <algorithm>

#include "mesher/base/check.h"
#include "mesher/base/epoch.h"

namespace delmesher::delaunay {
namespace {

using Index = std::uint32_t;

// Position of (x, y) along the Hilbert curve on a 2^16 x 2^16 grid.
std::uint32_t hilbert_key(std::uint32_t x, std::uint32_t y) {
  std::uint32_t key = 0;
  for (std::uint32_t s = 1U << 15; s != 0; s >>= 1) {
    const bool right = (x & s) != 0, upper = (y & s) != 0;
    key = 4 * key + ((right ? 3U : 0U) ^ (upper ? 1U : 0U));
    if (!upper) {
      if (right) {
        x = ~x;
        y = ~y;
      }
      std::swap(x, y);
    }
  }
  return key;
}

// Incremental construction by cavities (Bowyer and Watson). The outside is covered by ghost
// triangles that share one vertex at infinity, so that no case is special. Works on local indices
// 0 .. n-1; n is the vertex at infinity. Triangle t has corners 3t .. 3t+2, counter-clockwise, and
// side i is opposite corner i.
class PlanarBuilder {
 public:
  PlanarBuilder(Predicates& predicates, const FacetPlane& plane, std::span<const VertexId> ids)
      : predicates_(predicates),
        plane_(plane),
        ids_(ids),
        infinite_(static_cast<Index>(ids.size())),
        created_from_(ids.size() + 1, kNone) {
    corner_.reserve(6 * ids.size());
    neighbor_.reserve(6 * ids.size());
  }

  PlanarTriangulation run() {
    std::vector<Index> order = insertion_order();
    start(order);
    for (std::size_t i = 3; i < order.size(); ++i) insert(order[i]);
    return result();
  }

 private:
  int orient(Index a, Index b, Index c) {
    return plane_.axis_sign * predicates_.orient2d(plane_.axis, ids_[a], ids_[b], ids_[c]);
  }
  bool in_circle(Index a, Index b, Index c, Index p) {
    return predicates_.insphere_perturbed(ids_[a], ids_[b], ids_[c], plane_.off_plane, ids_[p]) > 0;
  }

  // Biased randomized order: rounds of doubling size, along the Hilbert curve within a round.
  std::vector<Index> insertion_order() const {
    const Index n = infinite_;
    std::vector<Index> order(n);
    for (Index i = 0; i < n; ++i) order[i] = i;
    if (n <= kSortFrom) return order;
    std::vector<std::uint64_t> key(n);
    const std::array<int, 2> axes = {(plane_.axis + 1) % 3, (plane_.axis + 2) % 3};
    std::array<double, 2> low, extent;
    for (int k = 0; k < 2; ++k) {
      auto less = [&](VertexId a, VertexId b) {
        return coordinate(a, axes[k]) < coordinate(b, axes[k]);
      };
      const auto [lo, hi] = std::minmax_element(ids_.begin(), ids_.end(), less);
      low[k] = coordinate(*lo, axes[k]);
      extent[k] = coordinate(*hi, axes[k]) / 2 - low[k] / 2;  // halves: no overflow
    }
    for (Index i = 0; i < n; ++i) {
      std::array<std::uint32_t, 2> cell = {0, 0};
      for (int k = 0; k < 2; ++k) {
        if (!(extent[k] > 0)) continue;
        const double f = (coordinate(ids_[i], axes[k]) / 2 - low[k] / 2) / extent[k];
        cell[k] = static_cast<std::uint32_t>(std::clamp(f, 0.0, 1.0) * 65535);
      }
      key[i] = (std::uint64_t{round_of(i, n)} << 32) | hilbert_key(cell[0], cell[1]);
    }
    std::sort(order.begin(), order.end(),
              [&](Index a, Index b) { return key[a] != key[b] ? key[a] < key[b] : a < b; });
    return order;
  }
  double coordinate(VertexId v, int axis) const {
    const Approximation& a = predicates_.points().approximation(v);
    return axis == 0 ? a.x : axis == 1 ? a.y : a.z;
  }
  static std::uint32_t round_of(Index i, Index n) {
    std::uint32_t rounds = 0;
    for (Index m = n; m > kSortFrom; m /= 4) ++rounds;
    std::uint64_t h = (i + 1) * 0x9e3779b97f4a7c15ULL;
    h ^= h >> 29;
    h *= 0xbf58476d1ce4e5b9ULL;
    h ^= h >> 32;
    while (rounds > 0 && (h & 3) == 0) {
      --rounds;
      h >>= 2;
    }
    return rounds;
  }

  // One triangle and its three ghosts. Moves a third corner off the first two's line to order[2].
  void start(std::vector<Index>& order) {
    DELMESHER_CHECK(order.size() >= 3, "a planar triangulation of fewer than three points");
    std::size_t k = 2;
    int side = 0;
    while (k < order.size() && (side = orient(order[0], order[1], order[k])) == 0) ++k;
    DELMESHER_CHECK(side != 0, "a planar triangulation of collinear points");
    std::rotate(order.begin() + 2, order.begin() + static_cast<std::ptrdiff_t>(k),
                order.begin() + static_cast<std::ptrdiff_t>(k) + 1);
    if (side < 0) std::swap(order[0], order[1]);
    const std::array<Index, 3> v = {order[0], order[1], order[2]};
    const Index t = create(v[0], v[1], v[2]);
    for (Index i = 0; i < 3; ++i) {
      glue(3 * t + i, 3 * create(v[(i + 2) % 3], v[(i + 1) % 3], infinite_) + 2);
    }
    for (Index i = 0; i < 3; ++i) {  // ghost t+1+i: (v[i+2], v[i+1], infinite)
      glue(3 * (t + 1 + i), 3 * (t + 1 + (i + 2) % 3) + 1);
    }
    last_ = t;
  }

  Index create(Index a, Index b, Index c) {
    Index t;
    if (free_.empty()) {
      t = static_cast<Index>(mark_.size());
      corner_.resize(corner_.size() + 3);
      neighbor_.resize(neighbor_.size() + 3, kNone);
      mark_.push_back(0);
    } else {
      t = free_.back();
      free_.pop_back();
    }
    corner_[3 * t] = a;
    corner_[3 * t + 1] = b;
    corner_[3 * t + 2] = c;
    return t;
  }
  void glue(Index s, Index o) {
    neighbor_[s] = o;
    neighbor_[o] = s;
  }
  static Index after(Index s) { return s % 3 == 2 ? s - 2 : s + 1; }
  static Index before(Index s) { return s % 3 == 0 ? s + 2 : s - 1; }
  // Side of the vertex at infinity in triangle t (the side opposite it), kNone if t is finite.
  Index infinite_side(Index t) const {
    for (Index s = 3 * t; s < 3 * t + 3; ++s) {
      if (corner_[s] == infinite_) return s;
    }
    return kNone;
  }

  // A triangle that contains p, or a ghost behind whose hull edge p strictly lies.
  Index locate(Index p) {
    Index t = last_;
    if (const Index s = infinite_side(t); s != kNone) t = neighbor_[s] / 3;
    Index from = kNone;
    for (;;) {
      Index exit = kNone;
      for (Index s = 3 * t; s < 3 * t + 3 && exit == kNone; ++s) {
        if (s != from && orient(corner_[after(s)], corner_[before(s)], p) < 0) exit = s;
      }
      if (exit == kNone) return t;
      from = neighbor_[exit];
      t = from / 3;
      if (corner_[from] == infinite_) return t;
    }
  }

  bool conflicts(Index t, Index p) {
    const Index s = infinite_side(t);
    if (s == kNone) {
      return in_circle(corner_[3 * t], corner_[3 * t + 1], corner_[3 * t + 2], p);
    }
    const int side = orient(corner_[after(s)], corner_[before(s)], p);
    if (side != 0) return side > 0;
    // On the line of a hull edge: p is on the edge itself iff it is in the circle behind it.
    return conflicts(neighbor_[s] / 3, p);
  }

  void insert(Index p) {
    next_epoch(epoch_, mark_);
    cavity_.assign(1, locate(p));
    border_.clear();
    mark_[cavity_[0]] = epoch_;
    for (std::size_t i = 0; i < cavity_.size(); ++i) {
      const Index t = cavity_[i];
      for (Index s = 3 * t; s < 3 * t + 3; ++s) {
        const Index u = neighbor_[s] / 3;
        if (mark_[u] == epoch_) continue;
        if (conflicts(u, p)) {
          mark_[u] = epoch_;
          cavity_.push_back(u);
        } else {
          border_.push_back({corner_[after(s)], corner_[before(s)], neighbor_[s]});
        }
      }
    }
    fill(p);
  }

  // Replaces the cavity by the fan of p over its border.
  void fill(Index p) {
    free_.insert(free_.end(), cavity_.rbegin(), cavity_.rend());
    for (const Border& b : border_) {
      const Index t = create(b.from, b.to, p);
      glue(3 * t + 2, b.outer);
      created_from_[b.from] = t;
    }
    for (const Border& b : border_) {
      glue(3 * created_from_[b.from], 3 * created_from_[b.to] + 1);
      last_ = created_from_[b.from];
    }
  }

  PlanarTriangulation result() const {
    std::vector<std::uint8_t> dead(mark_.size(), 0);
    for (const Index t : free_) dead[t] = 1;
    std::vector<Index> number(mark_.size(), kNone);
    PlanarTriangulation out;
    out.triangles.reserve(2 * ids_.size());
    for (Index t = 0; t < mark_.size(); ++t) {
      if (dead[t] != 0 || infinite_side(t) != kNone) continue;
      number[t] = static_cast<Index>(out.triangles.size());
      out.triangles.push_back(
          {ids_[corner_[3 * t]], ids_[corner_[3 * t + 1]], ids_[corner_[3 * t + 2]]});
    }
    out.neighbors.resize(out.triangles.size());
    for (Index t = 0; t < mark_.size(); ++t) {
      if (number[t] == kNone) continue;
      for (Index i = 0; i < 3; ++i) {
        const Index s = neighbor_[3 * t + i];
        out.neighbors[number[t]][i] = number[s / 3] == kNone ? kNone : 3 * number[s / 3] + s % 3;
      }
    }
    return out;
  }

  static constexpr Index kSortFrom = 24;  // fewer points are inserted as they come

  struct Border {
    Index from, to, outer;  // directed edge, cavity on its left; side of the triangle beyond it
  };

  Predicates& predicates_;
  const FacetPlane& plane_;
  std::span<const VertexId> ids_;
  Index infinite_;
  Index last_ = 0;
  std::uint32_t epoch_ = 0;
  std::vector<Index> corner_, neighbor_, free_, cavity_;
  std::vector<std::uint32_t> mark_;
  std::vector<Border> border_;
  std::vector<Index> created_from_;  // first corner of a border edge -> triangle made on it
};

}  // namespace

PlanarTriangulation triangulate_planar(Predicates& predicates, const FacetPlane& plane,
                                       std::span<const VertexId> vertices) {
  if (vertices.size() == 3) {  // by far the most frequent
    PlanarTriangulation out;
    const int side =
        plane.axis_sign * predicates.orient2d(plane.axis, vertices[0], vertices[1], vertices[2]);
    DELMESHER_CHECK(side != 0, "a planar triangulation of collinear points");
    out.triangles.push_back({vertices[0], vertices[1], vertices[2]});
    if (side < 0) std::swap(out.triangles[0][1], out.triangles[0][2]);
    out.neighbors.push_back({kNone, kNone, kNone});
    return out;
  }
  return PlanarBuilder(predicates, plane, vertices).run();
}

}  // namespace delmesher::delaunay
