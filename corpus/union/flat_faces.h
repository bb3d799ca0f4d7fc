// Faces that lie on each other but for roundings, triangulated together.
#pragma once

#include <functional>
#include <map>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "corpus/union/arrangement.h"
#include "corpus/union/plane_triangulation.h"
#include "corpus/union/points.h"
#include "corpus/union/poll.h"

namespace tetproof::unite {

// A triangle whose sides go through other vertices.
struct BentFace {
  Index triangle;
  // From one vertex to the next, the face on the left; no two between the same vertices.
  std::vector<std::pair<Index, Index>> boundary;
};

// A constrained Delaunay triangulation of the vertices as they are seen along an axis, whatever
// their heights. The sides of the faces are the constraints.
class FlatFaces {
 public:
  using Segment = std::pair<Index, Index>;  // the lower vertex first

  FlatFaces(std::span<const Position> vertices, int axis) : positions_(vertices), axis_(axis) {}
  void add(BentFace face) { faces_.push_back(std::move(face)); }
  void add_vertex(Index v) { extra_.push_back(v); }
  void add_segment(const Segment& s) { segments_.insert(s); }

  // Calls bend(segment, vertex, share) for segments that are seen to go through a vertex there.
  // Where two cross between vertices, that is vertex_at(segment, share). Returns whether there were
  // none.
  [[nodiscard]] bool triangulate(const std::function<void(const Segment&, Index, double)>& bend,
                                 const std::function<Index(const Segment&, double)>& vertex_at);
  // Of what triangulate() found to be in order. False if a boundary does not go round its face.
  [[nodiscard]] bool append_to(std::vector<Piece>& pieces, Poll& poll);

 private:
  struct FaceInfo {
    std::vector<std::pair<Index, bool>> members;  // triangles here; do they face up?
    Index seen = kNone;                           // by this triangle last
  };
  struct VertexInfo {
    Index number = kNone;
  };
  using Triangulation = PlaneTriangulation<VertexInfo, FaceInfo, CGAL::Exact_intersections_tag>;
  using VertexHandle = Triangulation::Vertex_handle;
  using FaceHandle = Triangulation::Face_handle;

  Exact::Point_2 seen(Index v) const {
    const Position& p = positions_[v];
    return projected({p[0], p[1], p[2]}, axis_);
  }
  VertexHandle vertex(Index v);
  bool faces_up(const BentFace& face) const;
  FaceHandle left_of(Index from, Index to) const;
  bool cover(const BentFace& face, Poll& poll);

  std::span<const Position> positions_;
  int axis_;  // "up" is along it
  std::vector<BentFace> faces_;
  std::vector<Index> extra_;
  std::set<Segment> segments_;
  Triangulation triangulation_;
  std::map<Index, VertexHandle> vertices_;
};

}  // namespace tetproof::unite
