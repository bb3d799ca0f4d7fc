#include "oracles/mesh/region_points.h"

#include <algorithm>
#include <utility>

#include "oracles/mesh/solids.h"
#include "oracles/surface/input_surface.h"

namespace tetproof::oracles {

RegionPoints::RegionPoints(const std::vector<RegionPoint>& given, const TetComplex& complex)
    : first_(static_cast<Index>(complex.points->size())), around_(given.size()) {
  if (given.empty()) return;
  std::vector<Position> positions;
  for (Index v = 0; v < first_; ++v) positions.push_back(complex.points->nearest(v));
  for (const RegionPoint& p : given) positions.push_back(p.point);
  points_.assign(positions);
  std::vector<BoxTree::Box> boxes;
  for (Index n = 0; n < given.size(); ++n) {
    const Index v = first_ + n;
    boxes.push_back(box_around(points_, {&v, 1}));
  }
  const BoxTree tree(std::move(boxes));
  std::vector<Index> near;
  for (Index t = 0; t < complex.tetrahedra.size(); ++t) {
    const Tet& tet = complex.tetrahedra[t];
    near.clear();
    tree.query(box_around(points_, tet), near);
    for (const Index n : near) {
      if (contains(tet, first_ + n)) around_[n].push_back(t);
    }
  }
}

bool RegionPoints::contains(const Tet& tet, Index point) const {
  for (std::size_t k = 0; k < 4; ++k) {
    Tet with = tet;
    with[k] = point;
    if (exact::orient3d(points_, with[0], with[1], with[2], with[3]) < 0) return false;
  }
  return true;
}

bool RegionPoints::is_within(Index n, std::vector<Face> faces) const {
  const Index v = first_ + n;
  return RayTarget(points_, std::move(faces)).surrounds({&v, 1});
}

}  // namespace tetproof::oracles
