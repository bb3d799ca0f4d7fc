#include "mesher/plane/steiner_points.h"

#include <algorithm>
#include <cmath>

#include "mesher/geometry/placement.h"

namespace delmesher::plane {
namespace {

double square(double x) {
  return x * x;
}

}  // namespace

SteinerPoints::SteinerPoints(const InputGraph& graph, const Chamfered& chamfered,
                             const Triangulation& mesh, PointStore& points,
                             PlanePredicates& predicates, bool circumcentres)
    : graph_(graph),
      mesh_(mesh),
      points_(points),
      predicates_(predicates),
      circumcentres_(circumcentres),
      corner_of_(points.size(), kNone),
      carrier_(points.size(), kNone) {
  for (const Gap& gap : chamfered.gaps) {
    if (gap.b >= graph.vertices) corner_of_[gap.b] = gap.a;
  }
  for (PieceId id = kBoxPieces; id < graph.pieces.size(); ++id) {
    for (const VertexId v : chamfered.ends[id]) {
      if (v != kNone && v >= graph.vertices) carry(v, id);
    }
  }
}

void SteinerPoints::carry(VertexId v, PieceId piece) {
  if (v >= carrier_.size()) carrier_.resize(std::size_t{v} + 1, kNone);
  carrier_[v] = piece;
}

VertexId SteinerPoints::on_subsegment(EdgeId e) {
  const VertexId a = mesh_.origin(e), b = mesh_.target(e);
  const PieceId id = mesh_.piece(e);
  const Approximation& pa = points_.approximation(a);
  const Approximation& pb = points_.approximation(b);
  const double dx = pb.x - pa.x, dy = pb.y - pa.y;
  const double length = norm(dx, dy);
  const double room = kFloor * std::max(magnitude(points_, a), magnitude(points_, b));
  if (!(length > 2 * std::max(room, graph_.unit * 0x1p21))) return kNone;
  const Vec3 middle = {pa.x + dx / 2, pa.y + dy / 2, 0};
  if (id < kBoxPieces) {
    // On the side: one coordinate is constant.
    return points_.add_explicit(to_unit(graph_, middle[0]), to_unit(graph_, middle[1]), 0);
  }
  const Piece& piece = graph_.pieces[id];
  const VertexId p =
      points_.add(place_on_segment(points_, piece.a, piece.b, middle, length * 0x1p-21));
  if (!(predicates_.dot(a, p, b) < 0)) {
    points_.pop_back();
    return kNone;
  }
  carry(p, id);
  return p;
}

// The chamfered corner that a new point would come close to, if any: the cut points around one lie
// on a circle, whose centre it is. The corner itself instead makes no needles when its segments
// come back, and happens once per corner, so that it does not touch termination.
VertexId SteinerPoints::corner_near(const std::array<VertexId, 3>& v, const Vec3& place,
                                    const Shape& shape) {
  for (const VertexId u : v) {
    const VertexId corner = u < corner_of_.size() ? corner_of_[u] : kNone;
    if (corner == kNone || mesh_.has_vertex(corner)) continue;
    const Approximation& a = points_.approximation(corner);
    const double distance = norm(place[0] - a.x, place[1] - a.y) * shape.scale;
    if (square(distance) < shape.shortest_squared &&
        predicates_.in_circle(v[0], v[1], v[2], corner) > 0) {
      return corner;
    }
  }
  return kNone;
}

SteinerPoints::Candidate SteinerPoints::at(const Vec3& place) {
  if (!std::isfinite(place[0]) || !std::isfinite(place[1])) return {};
  return {points_.add_explicit(place[0], place[1], 0), false};
}

SteinerPoints::Candidate SteinerPoints::in_triangle(const std::array<VertexId, 3>& v,
                                                    const Goal& goal) {
  const Shape shape = shape_of(points_, v[0], v[1], v[2]);
  // The new point comes near the shortest edge: only there room between doubles is needed.
  const double size =
      std::max(magnitude(points_, v[static_cast<std::size_t>(next(shape.sharpest))]),
               magnitude(points_, v[static_cast<std::size_t>(previous(shape.sharpest))]));
  // It is placed on a grid of a millionth of that edge or two.
  const double room = std::max(size * kFloor, graph_.unit * 0x1p22);
  if (!(shape.shortest_squared > square(room * shape.scale))) return {};
  if (circumcentres_) {
    const Candidate candidate = at(shape.place(points_, v, shape.circumcentre));
    if (candidate.vertex != kNone) {
      if (predicates_.in_circle(v[0], v[1], v[2], candidate.vertex) > 0) return candidate;
      take_back(candidate);
    }
  }
  const Vec3 place = shape.place(points_, v, goal.reach(shape));
  const VertexId corner = circumcentres_ ? kNone : corner_near(v, place, shape);
  if (corner != kNone) return {corner, true};
  return at(place);
}

}  // namespace delmesher::plane
