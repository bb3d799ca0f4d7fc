#include "mesher/refine/sides.h"

#include <algorithm>
#include <cmath>

#include "mesher/base/check.h"
#include "mesher/base/parallel.h"
#include "mesher/geometry/vector.h"

namespace delmesher::refine {
namespace {

// Is the box certainly beyond the plane of a face of the tetrahedron, whose corners are known up to
// an error per coordinate?
bool beyond_a_face(const std::array<Vec3, 4>& corner, double error, const Box& box) {
  constexpr double kRounding = 0x1p-48;  // more than enough for these few operations
  for (const auto& [i, j, k] : kFace) {
    const Vec3 u = subtract(corner[j], corner[i]), v = subtract(corner[k], corner[i]);
    const Vec3 n = cross(u, v);
    // The least of n . (x - corner i) over the box, and the greatest magnitudes that enter it.
    double least = 0, reach = 0, size = 0;
    for (int a = 0; a < 3; ++a) {
      const double lo = box.lo[a] - corner[i][a], hi = box.hi[a] - corner[i][a];
      least += n[a] > 0 ? n[a] * lo : n[a] * hi;
      reach = std::max({reach, std::fabs(lo), std::fabs(hi), std::fabs(corner[i][a])});
      size = std::max({size, std::fabs(u[a]), std::fabs(v[a])});
    }
    const double off = error + kRounding * reach;  // of any difference of coordinates
    if (least > 16 * size * size * off + 32 * size * reach * (off + kRounding * size)) return true;
  }
  return false;
}

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

bool Sides::near_removed(TetId t) const {
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
  return !removed_boxes_.query(
      box, [&](std::uint32_t i) { return beyond_a_face(corner, error, removed_[i]); });
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
  };
  PerWorker<Mine> mine(control, points_, solid_);
  for_items(control, dt_.capacity(), kChunk, [&](Worker& worker, std::size_t n) {
    const auto t = static_cast<TetId>(n);
    if (!dt_.alive(t) || dt_.is_ghost(t) || state(t) != State::unknown || !near_removed(t)) return;
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
  if (near_removed(start)) {
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
        if (near_removed(u)) {
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
      if (dt_.is_ghost(u) || state(u) != State::unknown || near_removed(u)) continue;
      set(u, through(u, dt_.mirror(t, i)));
      telling.push_back(u);
    }
  }
}

void Sides::validate() const {
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
      DELMESHER_CHECK(near_removed(t) || (!dt_.is_ghost(u) && near_removed(u)),
                      "two tetrahedra disagree about the surface between them");
    }
  }
}

}  // namespace delmesher::refine
