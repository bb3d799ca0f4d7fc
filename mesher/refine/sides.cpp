// Which tetrahedra are inside the solid (section 5.5), asked for one at a time during refinement.
//
// Away from the removed part of the surface (chamfered or filtered) the surface is a union of
// subfacets, so no open tetrahedron meets it there and a side is passed on from tetrahedron to
// tetrahedron: kept across an ordinary face, changed across a subfacet of the input. Only
// tetrahedra near the removed part need the exact test against the whole surface.
#include <algorithm>
#include <cmath>

#include "mesher/base/parallel.h"
#include "mesher/predicates/vector.h"
#include "mesher/refine/refiner.h"

namespace delmesher {
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

}  // namespace

// May the tetrahedron touch the removed part? Conservative.
bool Refiner::near_removed(TetId t) const {
  if (removed_.empty()) return false;
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
  return !removed_.query(
      box, [&](std::uint32_t i) { return beyond_a_face(corner, error, options_.removed[i]); });
}

std::uint8_t Refiner::classify_exactly(Solid& solid, const VertexId* v) {
  switch (solid.classify({v[0], v[1], v[2], v[3]})) {
    case Side::outside:
      return kOutside;
    case Side::inside:
      return kInside;
    case Side::straddling:
      break;
  }
  return kStraddling;
}

// What side_of() would do for each of them, shared among threads. The notes of a tetrahedron are
// written by one of them and read by no other.
void Refiner::classify_near_removed() {
  constexpr std::size_t kChunk = 256;
  if (control_.threads() == 1 || removed_.empty()) return;
  struct Mine {
    Mine(const PointStore& points, const Solid& solid)
        : predicates(points), own(solid, predicates) {}
    Predicates predicates;
    Solid own;
  };
  PerWorker<Mine> mine(control_, points_, solid_);
  for_items(control_, dt_.capacity(), kChunk, [&](Worker& worker, std::size_t n) {
    const auto t = static_cast<TetId>(n);
    if (!dt_.alive(t) || dt_.is_ghost(t) || note(t, kSide) != kUnknown || !near_removed(t)) return;
    note(t, kSide) = classify_exactly(mine[worker].own, dt_.vertices(t));
  });
  mine.for_each([&](const Mine& m) { predicates_.counters += m.predicates.counters; });
}

// The side seen through face i of a tetrahedron away from the removed part, kUnknown if the
// neighbour cannot tell.
std::uint8_t Refiner::side_through(TetId t, int i) const {
  const TetId u = dt_.neighbor(t, i);
  const std::uint8_t beyond = dt_.is_ghost(u) ? std::uint8_t{kOutside} : note(u, kSide);
  if (beyond == kUnknown || beyond == kStraddling) return kUnknown;
  const std::uint32_t s = subfacet_on(t, i);
  const bool crosses =
      s != kNone && subfacets_[s].alive && plc_.facets[subfacets_[s].facet].input_facet != kNone;
  if (!crosses) return beyond;
  return beyond == kInside ? kOutside : kInside;
}

// Requires empty queues: every subfacet is a face of the tetrahedrization.
std::uint8_t Refiner::side_of(TetId start) {
  if (note(start, kSide) != kUnknown) return note(start, kSide);
  if (near_removed(start))
    return note(start, kSide) = classify_exactly(solid_, dt_.vertices(start));
  // Search for a tetrahedron that knows, through those that do not, then tell all that were asked.
  std::vector<TetId> asked = {start};
  note(start, kSide) = kAsked;
  std::uint8_t found = kUnknown;
  std::size_t n = 0;
  for (; n < asked.size() && found == kUnknown; ++n) {
    const TetId t = asked[n];
    for (int i = 0; i < 4 && found == kUnknown; ++i) {
      const TetId u = dt_.neighbor(t, i);
      if (!dt_.is_ghost(u) && note(u, kSide) == kAsked) continue;
      if (!dt_.is_ghost(u) && note(u, kSide) == kUnknown) {
        if (near_removed(u)) {
          note(u, kSide) = classify_exactly(solid_, dt_.vertices(u));
        } else {
          note(u, kSide) = kAsked;
          asked.push_back(u);
          continue;
        }
      }
      found = side_through(t, i);
    }
  }
  // Nobody knows (an island among straddling ones): the test on one of them serves all.
  const TetId source = asked[n - 1];
  if (found == kUnknown) found = classify_exactly(solid_, dt_.vertices(source));
  for (const TetId t : asked) note(t, kSide) = kUnknown;
  note(source, kSide) = found;
  std::vector<TetId> tell = {source};
  while (!tell.empty()) {
    const TetId t = tell.back();
    tell.pop_back();
    for (int i = 0; i < 4; ++i) {
      const TetId u = dt_.neighbor(t, i);
      if (dt_.is_ghost(u) || note(u, kSide) != kUnknown || near_removed(u)) continue;
      note(u, kSide) = side_through(u, dt_.mirror(t, i));
      tell.push_back(u);
    }
  }
  return note(start, kSide);
}

}  // namespace delmesher
