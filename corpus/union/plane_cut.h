// Triangles of one plane, cut together.
#pragma once

#include <array>
#include <span>
#include <unordered_map>
#include <vector>

#include "corpus/union/arrangement.h"
#include "corpus/union/plane_triangulation.h"
#include "corpus/union/points.h"
#include "corpus/union/poll.h"

namespace tetproof::unite {

// Where a triangle meets another one that is not in its plane: a segment, or a point (twice).
struct Chord {
  Index from, to;
};

// A constrained Delaunay triangulation, projected along an axis. The sides of the triangles and
// their chords are the constraints, and where they cross is a new point.
class PlaneCut {
 public:
  // `members` are triangles of one plane.
  PlaneCut(const Soup& soup, std::span<const Index> members, Cancelled cancelled, Points& points);
  void add(const std::vector<Chord>& chords);
  // Numbers the crossings, and appends the pieces of the members.
  void append_to(std::vector<Piece>& pieces, Poll& poll);

 private:
  struct VertexInfo {
    Index number = kNone;
  };
  struct FaceInfo {
    int times = 0;                             // of those that face up
    Index upwards = kNone, downwards = kNone;  // the first members here that face so
    Index seen = kNone;                        // by this member last
    std::vector<Index> members;                // here, with Cancelled::kept
  };
  using Triangulation = PlaneTriangulation<VertexInfo, FaceInfo, CGAL::Exact_intersections_tag>;
  using Corners = std::array<Exact::Point_2, 3>;

  Exact::Point_2 at(Index point) const { return projected(points_[point], axis_); }
  Exact::Point_3 lifted(const Exact::Point_2& p) const;
  Triangulation::Vertex_handle vertex(Index point);
  void constrain(Index from, Index to);
  Corners corners_of(Index member) const;
  void number_crossings();
  void cover(Index member, Poll& poll);
  static bool is_on_side(const Triangulation::Face_handle& face, int edge, const Corners& corners);
  void append(const Triangulation::Face_handle& face, std::vector<Piece>& pieces) const;

  const Soup& soup_;
  std::span<const Index> members_;
  const Cancelled cancelled_;
  Points& points_;
  int axis_;  // "up" is along it
  // The plane: normal . (x - origin) = 0.
  std::array<Exact::FT, 3> origin_, normal_;
  Triangulation triangulation_;
  std::unordered_map<Index, Triangulation::Vertex_handle> vertices_;
  Triangulation::Vertex_handle near_;  // the last one that was inserted
};

}  // namespace tetproof::unite
