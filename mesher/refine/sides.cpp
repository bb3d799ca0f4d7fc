#include "mesher/refine/sides.h"

#include <algorithm>
#include <cmath>

#include "mesher/base/check.h"
#include "mesher/base/parallel.h"
#include "mesher/geometry/vector.h"

namespace delmesher::refine {
namespace {

// A tetrahedron whose corners are known up to an error per coordinate.
class RoundedTetrahedron {
 public:
  RoundedTetrahedron(const std::array<Vec3, 4>& corner, double error)
      : corner_(corner), error_(error) {}

  // Is the box certainly beyond the plane of a face?
  bool is_beyond_a_face(const Box& box) {
    constexpr double kRounding = 0x1p-48;  // more than enough for these few operations
    if (std::ranges::any_of(corner_, [&](const Vec3& x) { return box.overlaps({x, x}); })) {
      return false;
    }
    if (!has_normals_) find_normals();
    for (std::size_t f = 0; f < 4; ++f) {
      const Vec3 &x = corner_[static_cast<std::size_t>(kFace[f][0])], &n = normal_[f];
      // The least of n . (y - x) over the box, and the greatest magnitudes that enter it.
      double least = 0, reach = 0;
      for (std::size_t a = 0; a < 3; ++a) {
        const double lo = box.lo[a] - x[a], hi = box.hi[a] - x[a];
        least += n[a] > 0 ? n[a] * lo : n[a] * hi;
        reach = std::max({reach, std::fabs(lo), std::fabs(hi), std::fabs(x[a])});
      }
      const double size = size_[f];
      const double off = error_ + kRounding * reach;  // of any difference of coordinates
      if (least > 16 * size * size * off + 32 * size * reach * (off + kRounding * size)) {
        return true;
      }
    }
    return false;
  }

 private:
  void find_normals() {
    for (std::size_t f = 0; f < 4; ++f) {
      const auto at = [&](int k) -> const Vec3& {
        return corner_[static_cast<std::size_t>(kFace[f][k])];
      };
      const Vec3 u = subtract(at(1), at(0)), v = subtract(at(2), at(0));
      normal_[f] = cross(u, v);
      size_[f] = 0;
      for (std::size_t a = 0; a < 3; ++a) {
        size_[f] = std::max({size_[f], std::fabs(u[a]), std::fabs(v[a])});
      }
    }
    has_normals_ = true;
  }

  const std::array<Vec3, 4>& corner_;
  double error_;
  bool has_normals_ = false;
  std::array<Vec3, 4> normal_;
  std::array<double, 4> size_;  // of the edges that make the normal
};

Sides::State state_of(Side side) {
  return side == Side::inside    ? Sides::State::inside
         : side == Side::outside ? Sides::State::outside
                                 : Sides::State::straddling;
}

}  // namespace

Sides::Sides(const Plc& plc, const SurfaceTopology& topology, const PointStore& points,
             Tetrahedrization& dt, const Subfacets& subfacets, std::span<const Box> removed)
    : plc_(plc),
      points_(points),
      dt_(dt),
      subfacets_(subfacets),
      removed_(removed),
      removed_boxes_(removed),
      solid_(topology, dt.predicates(), removed) {}

bool Sides::near_removed(TetId t, std::uint32_t& last_near) const {
  if (removed_boxes_.empty()) return false;
  std::array<Vec3, 4> corner;
  double error = 0;
  for (int i = 0; i < 4; ++i) {
    const Approximation& p = points_.approximation(dt_.vertex(t, i));
    corner[i] = {p.x, p.y, p.z};
    error = std::max(error, p.error);
  }
  Box box = Box::around(corner);
  for (int k = 0; k < 3; ++k) {
    box.lo[k] -= error;
    box.hi[k] += error;
  }
  // What the last one was near, its neighbours are.
  RoundedTetrahedron tetrahedron(corner, error);
  const auto is_far = [&](std::uint32_t i) {
    if (tetrahedron.is_beyond_a_face(removed_[i])) return true;
    last_near = i;
    return false;
  };
  return (removed_[last_near].overlaps(box) && !is_far(last_near)) ||
         !removed_boxes_.query(box, is_far);
}

bool Sides::on_surface(TetId t, int i) const {
  const std::uint32_t s = subfacets_.on_face(t, i);
  return s != kNone && plc_.facets[subfacets_[s].facet].input_facet != kNone;
}

Sides::State Sides::common_of_cavity() const {
  State common = State::unknown;
  bool first = true;
  for (const TetId t : dt_.cavity()) {
    if (dt_.is_ghost(t)) continue;
    const State known = state(t);
    if (first) common = known;
    if (known != common) common = State::unknown;
    first = false;
  }
  return common == State::straddling ? State::unknown : common;
}

// The notes of a tetrahedron are written by one of the threads and read by no other.
void Sides::classify_near_removed(Control& control) {
  constexpr std::size_t kChunk = 256;
  if (control.threads() == 1 || removed_boxes_.empty()) return;
  struct Mine {
    Mine(const PointStore& points, const Solid& solid)
        : predicates(points), own(solid, predicates) {}
    Predicates predicates;
    Solid own;
    std::uint32_t last_near = 0;
  };
  PerWorker<Mine> mine(control, points_, solid_);
  for_items(control, dt_.capacity(), kChunk, [&](Worker& worker, std::size_t n) {
    const auto t = static_cast<TetId>(n);
    if (!dt_.alive(t) || dt_.is_ghost(t) || state(t) != State::unknown ||
        !near_removed(t, mine[worker].last_near)) {
      return;
    }
    const VertexId* v = dt_.vertices(t);
    set(t, state_of(mine[worker].own.classify({v[0], v[1], v[2], v[3]})));
  });
  mine.for_each([&](const Mine& m) { dt_.predicates().counters += m.predicates.counters; });
}

// The exact test; most tetrahedra that are not cut have the side from a neighbour.
Sides::State Sides::classify(TetId t) {
  const VertexId* v = dt_.vertices(t);
  const std::array<VertexId, 4> corners = {v[0], v[1], v[2], v[3]};
  const Solid::Cut cut = solid_.cut(corners);
  if (cut.straddles) return State::straddling;
  for (int i = 0; i < 4; ++i) {
    const bool is_known = on_surface(t, i) || (cut.faces >> i & 1U) == 0;
    const State side = is_known ? through(t, i) : State::unknown;
    if (side != State::unknown) return side;
  }
  return solid_.is_inside(corners) ? State::inside : State::outside;
}

// The side seen through face i of a tetrahedron away from the removed part, unknown if the
// neighbour cannot tell.
Sides::State Sides::through(TetId t, int i) const {
  const TetId u = dt_.neighbor(t, i);
  const State beyond = dt_.is_ghost(u) ? State::outside : state(u);
  if (beyond != State::inside && beyond != State::outside) return State::unknown;
  if (!on_surface(t, i)) return beyond;
  return beyond == State::inside ? State::outside : State::inside;
}

Side Sides::of(TetId t) {
  State known = state(t);
  if (known == State::unknown) known = find_out(t);
  return known == State::inside    ? Side::inside
         : known == State::outside ? Side::outside
                                   : Side::straddling;
}

Sides::State Sides::find_out(TetId start) {
  if (near_removed(start, last_near_)) {
    set(start, classify(start));
    return state(start);
  }
  // Walk over tetrahedra without a known side until one has one, then note it in all of them.
  std::vector<TetId> asked = {start};
  set(start, State::asked);
  State found = State::unknown;
  std::size_t n = 0;
  for (; n < asked.size() && found == State::unknown; ++n) {
    const TetId t = asked[n];
    for (int i = 0; i < 4 && found == State::unknown; ++i) {
      const TetId u = dt_.neighbor(t, i);
      if (!dt_.is_ghost(u) && state(u) == State::asked) continue;
      if (!dt_.is_ghost(u) && state(u) == State::unknown) {
        if (near_removed(u, last_near_)) {
          set(u, classify(u));
        } else {
          set(u, State::asked);
          asked.push_back(u);
          continue;
        }
      }
      found = through(t, i);
    }
  }
  // Nobody knows (an island among straddling ones): the test on one of them serves all.
  const TetId source = asked[n - 1];
  if (found == State::unknown) found = classify(source);
  for (const TetId t : asked) set(t, State::unknown);
  set(source, found);
  tell(source);
  return state(start);
}

// Passes the side of a tetrahedron on to all that do not know theirs, as far as they are connected.
void Sides::tell(TetId source) {
  std::vector<TetId> telling = {source};
  while (!telling.empty()) {
    const TetId t = telling.back();
    telling.pop_back();
    for (int i = 0; i < 4; ++i) {
      const TetId u = dt_.neighbor(t, i);
      if (dt_.is_ghost(u) || state(u) != State::unknown || near_removed(u, last_near_)) {
        continue;
      }
      set(u, through(u, dt_.mirror(t, i)));
      telling.push_back(u);
    }
  }
}

void Sides::validate() const {
  std::uint32_t last_near = 0;
  for (TetId t = 0; t < dt_.capacity(); ++t) {
    if (!dt_.alive(t) || dt_.is_ghost(t)) continue;
    const State here = state(t);
    DELMESHER_CHECK(here < State::asked,
                    "a tetrahedron is still marked as being asked for its side");
    if (here != State::inside && here != State::outside) continue;
    for (int i = 0; i < 4; ++i) {
      const State seen = through(t, i);
      if (seen == State::unknown || seen == here) continue;
      const TetId u = dt_.neighbor(t, i);
      DELMESHER_CHECK(
          near_removed(t, last_near) || (!dt_.is_ghost(u) && near_removed(u, last_near)),
          "two tetrahedra disagree about the surface between them");
    }
  }
}

}  // namespace delmesher::refine
