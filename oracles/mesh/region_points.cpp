#include "oracles/mesh/region_points.h"

#include <numeric>
#include <utility>

#include "oracles/mesh/solids.h"
#include "oracles/surface/input_surface.h"

namespace tetproof::oracles {
namespace {

bool contains(const ExactPoints& points, const Tet& tet, Index point) {
  for (std::size_t k = 0; k < 4; ++k) {
    Tet with = tet;
    with[k] = point;
    if (exact::orient3d(points, with[0], with[1], with[2], with[3]) < 0) return false;
  }
  return true;
}

}  // namespace

std::vector<std::vector<Index>> tetrahedra_around(const ExactPoints& points,
                                                  const TetComplex& complex,
                                                  std::span<const Index> which) {
  std::vector<std::vector<Index>> around(which.size());
  if (which.empty()) return around;
  std::vector<BoxTree::Box> boxes;
  for (const Index& v : which) boxes.push_back(box_around(points, {&v, 1}));
  const BoxTree tree(std::move(boxes));
  std::vector<Index> near;
  for (Index t = 0; t < complex.tetrahedra.size(); ++t) {
    const Tet& tet = complex.tetrahedra[t];
    near.clear();
    tree.query(box_around(points, tet), near);
    for (const Index n : near) {
      if (contains(points, tet, which[n])) around[n].push_back(t);
    }
  }
  return around;
}

RegionPoints::RegionPoints(const std::vector<RegionPoint>& given, const TetComplex& complex)
    : first_(static_cast<Index>(complex.points->size())) {
  if (given.empty()) return;
  std::vector<Position> positions;
  for (Index v = 0; v < first_; ++v) positions.push_back(complex.points->nearest(v));
  for (const RegionPoint& p : given) positions.push_back(p.point);
  points_.assign(positions);
  std::vector<Index> which(given.size());
  std::iota(which.begin(), which.end(), first_);
  around_ = tetrahedra_around(points_, complex, which);
}

bool RegionPoints::is_within(Index n, std::vector<Face> faces) const {
  const Index v = first_ + n;
  return RayTarget(points_, std::move(faces)).surrounds({&v, 1});
}

}  // namespace tetproof::oracles
