// The input of the plane as its checks see it: exact vertices, segments cut where vertices lie on
// them, and what is inside by counting crossings.
#pragma once

#include <array>
#include <vector>

#include "mesher/delmesher_plane.h"
#include "oracles/plane_grid.h"
#include "oracles/plane_points.h"

namespace tetproof {

class PlaneGraph {
 public:
  using Index = PlanePoints::Index;
  using Point = PlanePoints::Point;
  // Part of a segment between two input vertices on it, from its first end to its second.
  struct Piece {
    Index a, b, segment;
  };

  // Segments refer to vertices of the graph.
  explicit PlaneGraph(const delmesher::PlanarGraph& graph);

  const delmesher::PlanarGraph& given() const { return graph_; }
  // The input vertices alone.
  PlanePoints& points() { return points_; }
  const Point& vertex(Index v) const { return points_.all()[v]; }
  // Segment by segment, each in order; of segments given twice only the first.
  const std::vector<Piece>& pieces() const { return pieces_; }
  const std::vector<std::vector<Index>>& pieces_at() const { return pieces_at_; }  // per vertex
  const std::vector<std::vector<Index>>& pieces_of() const { return pieces_of_; }  // per segment
  double largest() const { return largest_; }                                      // coordinate
  double diagonal() const { return diagonal_; }  // of the bounding box

  // Is what is on its two sides not the same?
  bool separates(Index segment) const;
  // Does parity decide what is inside, everywhere?
  bool closed_rings() const { return rings_; }
  // If the segments are one simple closed curve, twice the area within; else negative.
  const mpq_class& area_of_ring() const { return ring_area_; }
  // Parity of separating segments on a ray to the right. For points on no segment.
  bool inside_by_ray(const Point& c);
  bool on_segment(const std::array<double, 2>& at);
  // Distance from an input vertex to the nearest vertex or segment that it is not on, if that is
  // at most `most`; else something larger.
  double feature_size(Index v, double most);

  // Calls meet(segment) or meet(vertex) for those whose boxes meet the given one, and others. One
  // at a time: meet may not search again (feature_size, inside_by_ray and on_segment do).
  template <class Meet>
  void near_segments(const PlaneGrid::Box& box, Meet&& meet) {
    near_.visit(box, [&](Index item) {
      if (item < graph_.segments.size()) meet(item);
    });
  }
  template <class Meet>
  void near_vertices(const PlaneGrid::Box& box, Meet&& meet) {
    near_.visit(box, [&](Index item) {
      if (item >= graph_.segments.size()) meet(static_cast<Index>(item - graph_.segments.size()));
    });
  }

 private:
  void cut_into_pieces();
  void find_rings();
  std::vector<Index> round_the_ring() const;

  const delmesher::PlanarGraph& graph_;
  PlanePoints points_;
  PlaneGrid near_;  // the segments, then the vertices
  std::vector<Piece> pieces_;
  std::vector<std::vector<Index>> pieces_at_, pieces_of_;
  double largest_ = 0, diagonal_ = 0;
  bool rings_ = false;
  mpq_class ring_area_ = -1;
};

// The smallest box of some points, a little larger so that rounding hides nothing.
PlaneGrid::Box box_of(const std::vector<const PlanePoints::Point*>& points, double margin);

}  // namespace tetproof
