#include "oracles/mesh/places.h"

namespace tetproof::oracles {

std::vector<Index> groups_over(const Neighbours& neighbours,
                               const std::vector<std::uint8_t>& open) {
  std::vector<Index> group(open.size(), kNone);
  std::vector<Index> waiting;
  for (Index first = 0; first < open.size(); ++first) {
    if (group[first] != kNone) continue;
    group[first] = first;
    waiting.assign(1, first);
    while (!waiting.empty()) {
      const Index t = waiting.back();
      waiting.pop_back();
      for (Index i = 0; i < 4; ++i) {
        const Index across = neighbours.across[4 * t + i];
        if ((open[t] >> i & 1U) == 0 || across == kNone) continue;
        const Index next = across / 4;
        if ((open[next] >> across % 4 & 1U) == 0 || group[next] != kNone) continue;
        group[next] = first;
        waiting.push_back(next);
      }
    }
  }
  return group;
}

// A ray is cast from one tetrahedron of every group. Let two positive tetrahedra that the surface
// does not enter have a common face. A triangle that contains the middle of this face lies in its
// plane, or it would enter one of them. So if nothing of the surface near the face lies in its
// plane, nothing crosses the way from one centroid through the middle of the face to the other, and
// both are on the same side.
//
// A face of a mesh enters none of its tetrahedra, so only the rest of the surface beside the faces
// on it is tested, and these faces are walls.
void Places::find() const {
  const std::vector<Tet>& tets = complex_.tetrahedra;
  const ExactPoints& points = *complex_.points;
  const Cover cover = cover_ ? cover_() : Cover{};
  InputSurface::PlaneSides known;
  std::vector<std::uint8_t> open(tets.size());
  places_.assign(tets.size(), Place::outside);
  for (std::size_t t = 0; t < tets.size(); ++t) {
    const InputSurface::Contact contact =
        cover.rest ? surface_.contact(points, tets[t], *cover.rest, cover.triangles, known)
                   : surface_.contact(points, tets[t], known);
    const auto& [a, b, c, d] = tets[t];
    if (contact.enters) {
      places_[t] = Place::crossed;
    } else if (exact::orient3d(points, a, b, c, d) > 0) {
      const unsigned walls = cover.walls.empty() ? 0U : cover.walls[t];
      open[t] = static_cast<std::uint8_t>(~(contact.covered | walls));
    }
  }
  const std::vector<Index> group = groups_over(neighbours_, open);
  for (std::size_t t = 0; t < tets.size(); ++t) {
    if (places_[t] == Place::crossed) continue;
    if (group[t] != t) {
      places_[t] = places_[group[t]];
      continue;
    }
    const int parity = surface_.inside(points, tets[t]);
    places_[t] = parity == 1 ? Place::inside : parity == 0 ? Place::outside : Place::crossed;
  }
}

}  // namespace tetproof::oracles
