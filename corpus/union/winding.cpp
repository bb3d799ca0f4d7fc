#include "corpus/union/winding.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <span>

#include "corpus/union/unite.h"
#include "oracles/base/union_find.h"
#include "oracles/surface/input_surface.h"

namespace tetproof::unite {
namespace {

using oracles::BoxTree;
using oracles::UnionFind;

Exact::Point_2 projected(const Exact::Point_3& p, int axis) {
  return {p.cartesian((axis + 1) % 3), p.cartesian((axis + 2) % 3)};
}

BoxTree::Box box_of(const CGAL::Bbox_3& b) {
  return {{b.xmin(), b.ymin(), b.zmin()}, {b.xmax(), b.ymax(), b.zmax()}};
}

// Counts what rays along the axes go through.
class Rays {
 public:
  explicit Rays(const Arrangement& arrangement);
  int winding_in_front(Index piece);

 private:
  struct Ray {
    Exact::Point_3 from;
    int axis, direction;  // 1 or -1
    Index piece;          // where it starts
  };
  std::array<Exact::Point_3, 3> corners(Index piece) const {
    const auto& [a, b, c] = arrangement_.pieces[piece].corners;
    return {arrangement_.points[a], arrangement_.points[b], arrangement_.points[c]};
  }
  // The sign of the coordinate of the normal.
  int facing(Index piece, int axis) const;
  int best_axis(Index piece) const;
  Exact::Point_3 somewhere_inside(Index piece);
  std::optional<int> crossing(const Ray& ray, Index piece) const;
  std::optional<int> count(const Ray& ray) const;

  const Arrangement& arrangement_;
  BoxTree tree_;
  std::mt19937_64 random_{1};
};

std::vector<BoxTree::Box> boxes_of(const Arrangement& arrangement) {
  std::vector<BoxTree::Box> boxes;
  boxes.reserve(arrangement.pieces.size());
  for (const Piece& piece : arrangement.pieces) {
    CGAL::Bbox_3 box;
    for (const Index v : piece.corners) box += arrangement.points[v].bbox();
    boxes.push_back(box_of(box));
  }
  return boxes;
}

Rays::Rays(const Arrangement& arrangement)
    : arrangement_(arrangement), tree_(boxes_of(arrangement)) {}

int Rays::facing(Index piece, int axis) const {
  const auto [p, q, r] = corners(piece);
  return CGAL::orientation(projected(p, axis), projected(q, axis), projected(r, axis));
}

// Doubles choose the order in which the axes are tried.
int Rays::best_axis(Index piece) const {
  std::array<Position, 3> x;
  for (std::size_t k = 0; k < 3; ++k) {
    x[k] = arrangement_.points.approximate(arrangement_.pieces[piece].corners[k]);
  }
  Position size;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t u = (k + 1) % 3, v = (k + 2) % 3;
    size[k] = std::fabs((x[1][u] - x[0][u]) * (x[2][v] - x[0][v]) -
                        (x[1][v] - x[0][v]) * (x[2][u] - x[0][u]));
  }
  std::array<int, 3> order = {0, 1, 2};
  std::sort(order.begin(), order.end(), [&](int a, int b) { return size[a] > size[b]; });
  const auto found =
      std::find_if(order.begin(), order.end(), [&](int axis) { return facing(piece, axis) != 0; });
  if (found == order.end()) throw InternalError("a piece without area");
  return *found;
}

Exact::Point_3 Rays::somewhere_inside(Index piece) {
  const auto [p, q, r] = corners(piece);
  const auto weight = [&] { return Exact::FT(static_cast<int>(1 + random_() % 1024)); };
  const Exact::FT a = weight(), b = weight(), c = weight();
  return CGAL::barycenter(p, a, q, b, r, c);
}

// What going through a piece adds to the winding number at the start of the ray: nothing if the ray
// misses it; no answer if it meets its border.
std::optional<int> Rays::crossing(const Ray& ray, Index piece) const {
  const std::array<Exact::Point_3, 3> x = corners(piece);
  const Exact::Point_2 from = projected(ray.from, ray.axis);
  const std::array<Exact::Point_2, 3> y = {projected(x[0], ray.axis), projected(x[1], ray.axis),
                                           projected(x[2], ray.axis)};
  bool left = false, right = false, on = false;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto side = CGAL::orientation(y[k], y[(k + 1) % 3], from);
    left = left || side == CGAL::LEFT_TURN;
    right = right || side == CGAL::RIGHT_TURN;
    on = on || side == CGAL::COLLINEAR;
  }
  if (left && right) return 0;
  // The piece faces the axis if its projection is counter-clockwise.
  const int outwards = left ? ray.direction : -ray.direction;
  const int side = CGAL::orientation(x[0], x[1], x[2], ray.from);
  if (!on && side == 0) throw InternalError("pieces meet inside");
  if (!on) return side * outwards < 0 ? outwards * arrangement_.pieces[piece].times : 0;
  return {};
}

std::optional<int> Rays::count(const Ray& ray) const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  BoxTree::Box along = box_of(ray.from.bbox());
  (ray.direction > 0 ? along.high : along.low)[ray.axis] = ray.direction * kInfinity;
  std::vector<Index> found;
  tree_.query(along, found);
  int sum = 0;
  for (const Index other : found) {
    if (other == ray.piece) continue;
    const std::optional<int> through = crossing(ray, other);
    if (!through) return {};
    sum += *through;
  }
  return sum;
}

int Rays::winding_in_front(Index piece) {
  constexpr int kAttempts = 1000;
  const int axis = best_axis(piece), direction = facing(piece, axis);
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    const Ray ray = {somewhere_inside(piece), axis, direction, piece};
    if (const std::optional<int> sum = count(ray)) return *sum;
  }
  throw InternalError("every ray meets an edge");
}

}  // namespace

OpenEdges find_open_edges(std::span<const Piece> pieces) {
  OpenEdges open;
  Edges(triangles_of(pieces)).for_each([&](std::span<const EdgeUse> uses) {
    std::int64_t sum = 0;
    for (const EdgeUse& use : uses) {
      const int times = pieces[use.triangle].times;
      sum += use.forward ? times : -times;
    }
    if (sum != 0 && open.count++ == 0) open.place = uses[0].low;
  });
  return open;
}

std::vector<int> windings_in_front(const Arrangement& arrangement, Poll& poll) {
  UnionFind patches(arrangement.pieces.size());
  Edges(triangles_of(arrangement.pieces)).for_each([&](std::span<const EdgeUse> uses) {
    if (uses.size() == 2) patches.unite(uses[0].triangle, uses[1].triangle);
  });
  Rays rays(arrangement);
  std::vector<int> windings(arrangement.pieces.size());
  for (Index i = 0; i < windings.size(); ++i) {
    poll();
    const Index first = patches.find(i);
    windings[i] = first == i ? rays.winding_in_front(i) : windings[first];
  }
  return windings;
}

}  // namespace tetproof::unite
