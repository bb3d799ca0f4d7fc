#include "oracles/mesh/solids.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "oracles/base/edge_key.h"

namespace tetproof::oracles {
namespace {

std::vector<BoxTree::Box> boxes_of(const ExactPoints& points, const std::vector<Face>& faces) {
  std::vector<BoxTree::Box> boxes;
  for (const Face& face : faces) boxes.push_back(box_around(points, face));
  return boxes;
}

}  // namespace

bool looks_up(const ExactPoints& points, const Face& face) {
  const ExactVector n = exact::area2(points, face[0], face[1], face[2]);
  const int up = sgn(n[2]), x = sgn(n[0]);
  return up != 0 ? up > 0 : x != 0 ? x > 0 : sgn(n[1]) > 0;
}

RayTarget::RayTarget(const ExactPoints& points, std::vector<Face> faces)
    : points_(&points),
      faces_(std::move(faces)),
      tree_(std::make_unique<BoxTree>(boxes_of(points, faces_))),
      parts_(points, faces_) {}

// The ray begins just beyond the face, on the side to which it was moved or goes up.
bool RayTarget::surrounds(const Face& face, bool behind, Index own) const {
  const bool from_above = looks_up(*points_, face) != behind;
  return (above(face, own).count + (!from_above && own != kNone ? 1 : 0)) % 2 != 0;
}

bool RayTarget::surrounds(std::span<const Index> corners) const {
  return above(corners).count % 2 != 0;
}

RayCrossings RayTarget::above(std::span<const Index> corners, Index except) const {
  return crossings_above(*points_, faces_, *tree_, parts_, corners, except);
}

Solids::Solids(const ExactPoints& points, const std::vector<Face>& faces,
               const std::vector<std::vector<std::int32_t>>& labels)
    : points_(points), faces_(faces) {
  std::map<std::int32_t, std::vector<Index>> of_label;
  for (Index n = 0; n < faces.size(); ++n) {
    const std::set<std::int32_t> different(labels[n].begin(), labels[n].end());
    for (const std::int32_t label : different) of_label[label].push_back(n);
  }
  for (const auto& [label, numbers] : of_label) add(label, numbers);
}

// If it is closed.
void Solids::add(std::int32_t label, const std::vector<Index>& numbers) {
  std::map<std::uint64_t, unsigned> edges;
  std::vector<Face> faces;
  for (const Index n : numbers) {
    faces.push_back(faces_[n]);
    for (std::size_t k = 0; k < 3; ++k) ++edges[edge_key(faces_[n][k], faces_[n][(k + 1) % 3])];
  }
  if (std::ranges::any_of(edges, [](const auto& edge) { return edge.second % 2 != 0; })) return;
  Solid solid{label, RayTarget(points_, std::move(faces)), numbers, {}};
  exact::Volume6 volume6;
  for (Index n = 0; n < solid.target.faces().size(); ++n) {
    const Face& face = solid.target.faces()[n];
    const ExactNumber& volume = volume6.from_origin(points_, face);
    // Seen from outside counter-clockwise, and so clockwise from an origin inside.
    if (solid.target.surrounds(face, true, n)) {
      solid.volume += volume;
    } else {
      solid.volume -= volume;
    }
  }
  solids_.push_back(std::move(solid));
}

Index Solids::own(const Solid& solid, Index face) const {
  const auto at = std::ranges::lower_bound(solid.faces, face);
  return at != solid.faces.end() && *at == face ? static_cast<Index>(at - solid.faces.begin())
                                                : kNone;
}

// Of equal ones the first.
template <class Surrounds>
std::optional<std::int32_t> Solids::smallest(const Surrounds& surrounds) const {
  const Solid* best = nullptr;
  for (const Solid& solid : solids_) {
    if (best != nullptr && !(difference(solid.volume, best->volume, 0) < 0)) continue;
    if (surrounds(solid)) best = &solid;
  }
  return best != nullptr ? std::optional(best->label) : std::nullopt;
}

std::optional<std::int32_t> Solids::beside(Index n, bool behind) const {
  return smallest(
      [&](const Solid& solid) { return solid.target.surrounds(faces_[n], behind, own(solid, n)); });
}

std::optional<std::int32_t> Solids::around(std::span<const Index> corners) const {
  return smallest([&](const Solid& solid) { return solid.target.surrounds(corners); });
}

}  // namespace tetproof::oracles
