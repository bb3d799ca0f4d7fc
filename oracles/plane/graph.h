// The planar graph of the input as the checks see it: exact vertices, segments cut where vertices
// lie on them, and the inside by counting crossings.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "mesher/delmesher_plane.h"
#include "oracles/plane/boxes.h"
#include "oracles/plane/points.h"
#include "oracles/plane/slabs.h"

namespace tetproof {

class PlaneGraph {
 public:
  using Index = PlanePoints::Index;
  using Point = PlanePoints::Point;
  // The part of a segment between two consecutive input vertices on it, in the segment's direction.
  struct Piece {
    Index a, b, segment;
  };

  // Segments refer to vertices of the graph.
  explicit PlaneGraph(const delmesher::PlanarGraph& graph);
  PlaneGraph(const PlaneGraph&) = delete;
  PlaneGraph& operator=(const PlaneGraph&) = delete;

  const delmesher::PlanarGraph& given() const { return graph_; }
  // The input vertices alone.
  PlanePoints& points() { return points_; }
  const Point& vertex(Index v) const { return points_.all()[v]; }
  // Segment by segment, each in order. A segment that is given twice has pieces only once.
  const std::vector<Piece>& pieces() const { return pieces_; }
  const std::vector<std::vector<Index>>& pieces_at() const { return pieces_at_; }  // per vertex
  const std::vector<std::vector<Index>>& pieces_of() const { return pieces_of_; }  // per segment
  double largest() const { return largest_; }                                      // coordinate
  // The unit in the last place of the largest coordinate: the measure of roundings, whatever a file
  // or a record has beyond the input.
  double ulp() const;
  double diagonal() const { return diagonal_; }  // of the bounding box

  // Does the inside change to the outside across the segment? (Some inputs have others, between two
  // faces of the same side.)
  bool separates(Index segment) const;
  // Does parity decide the inside, everywhere?
  bool closed_rings() const { return rings_; }
  // Twice the area within if the segments are one simple closed curve; else negative.
  const mpq_class& area_of_ring() const { return ring_area_; }
  // By the parity of separating segments on a ray to the right. The point must be on no segment.
  bool inside_by_ray(const Point& c);
  bool on_segment(const std::array<double, 2>& at);
  // The distance from an input vertex to the nearest vertex or segment that it is not on, in input
  // units, if it is at most `most`; else some larger number.
  double feature_size(Index v, double most);

  // Calls meet(segment) or meet(vertex) for each whose box meets the given one.
  template <class Meet>
  void near_segments(const PlaneBoxes::Box& box, Meet&& meet) {
    segments_.visit(box, meet);
  }
  template <class Meet>
  void near_vertices(const PlaneBoxes::Box& box, Meet&& meet) {
    vertices_.visit(box, meet);
  }

 private:
  void cut_into_pieces();
  void find_rings();
  std::vector<Index> round_the_ring() const;

  const delmesher::PlanarGraph& graph_;
  PlanePoints points_;
  PlaneBoxes segments_, vertices_;
  std::vector<Piece> pieces_;
  std::vector<std::vector<Index>> pieces_at_, pieces_of_;
  std::optional<PlaneSlabs> separating_;  // once somebody asks
  double largest_ = 0, diagonal_ = 0;
  bool rings_ = false;
  mpq_class ring_area_ = -1;
};

// The smallest box of some points, a little larger so that rounding hides nothing.
PlaneBoxes::Box plane_box(const std::vector<const PlanePoints::Point*>& points, double margin);

}  // namespace tetproof
