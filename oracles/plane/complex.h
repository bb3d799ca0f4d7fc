// One of the two meshes of a record of the plane, on the record's exact points, and the laws that
// both obey. No other file asks whether a mesh is one: the rooms of the refined and of the final
// mesh (plane_refined.h, plane_final.h) take these laws for granted.
#pragma once

#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "mesher/delmesher_plane.h"
#include "oracles/plane/graph.h"
#include "oracles/verdict/promise.h"
#include "oracles/verdict/report.h"

namespace tetproof::oracles {

using PlaneEdge = std::pair<PlanePoints::Index, PlanePoints::Index>;

// The segment of an edge that is on the outer rectangle alone.
inline constexpr PlanePoints::Index kOuterRectangle = 0xffffffffU;

PlaneEdge undirected(PlanePoints::Index a, PlanePoints::Index b);
std::string triangle_name(std::size_t t);

// Triangles and listed edges refer to points; the mesh keeps references to all three.
class PlaneComplex {
 public:
  using Index = PlanePoints::Index;
  using Point = PlanePoints::Point;
  using Triangle = delmesher::PlaneRecord::Triangle;
  using ListedEdge = delmesher::PlaneRecord::Edge;
  static constexpr Index kNone = 0xffffffffU;

  PlaneComplex(const std::vector<Triangle>& triangles, const std::vector<ListedEdge>& edges,
               PlanePoints& points);

  const std::vector<Triangle>& triangles() const { return triangles_; }
  // As often as the record lists them.
  const std::vector<ListedEdge>& listed() const { return listed_; }
  // Directed edges, each with the triangle on its left.
  const std::map<PlaneEdge, Index>& left_of() const { return left_of_; }
  bool has(const PlaneEdge& edge) const;
  // The triangle on the right of a directed edge, or kNone at the border.
  Index right_of(const PlaneEdge& edge) const;
  // Listed edges (undirected), each with its input segment.
  const std::map<PlaneEdge, Index>& segment_of() const { return segment_of_; }
  // The triangles at a point; none where the mesh does not have it.
  const std::vector<Index>& at(Index v) const;

  PlanePoints& exact() const { return exact_; }
  const Point& point(Index v) const { return exact_.all()[v]; }
  Point centroid(const Triangle& triangle) const;
  // Twice the area, negative if the triangle is clockwise.
  mpq_class doubled_area(const Triangle& triangle) const;
  PlaneBoxes::Box box(const Triangle& triangle) const;
  // A triangle that contains the point, possibly on its border, or kNone.
  Index triangle_with(const Point& p);

 private:
  const std::vector<Triangle>& triangles_;
  const std::vector<ListedEdge>& listed_;
  PlanePoints& exact_;
  std::map<PlaneEdge, Index> left_of_, segment_of_;
  std::map<Index, std::vector<Index>> at_;
  PlaneBoxes boxes_;  // of the triangles
};

// A record of the plane whose points have been read, with its two meshes.
struct RecordedPlane {
  PlaneGraph& input;
  const delmesher::PlaneRecord& record;
  const Promise& promise;
  PlanePoints& exact;  // of the record; the vertices of the input come first
  PlaneComplex refined, final;

  const std::vector<PlanePoints::Point>& points() const { return exact.all(); }
  const delmesher::PlanarGraph& graph() const { return input.given(); }
  bool hull() const { return promise.region == delmesher::Region::hull; }
};

// The part of a segment that an edge covers, in the segment's parameter.
struct SegmentPart {
  mpq_class from, to;
  bool operator<(const SegmentPart& other) const {
    return from != other.from ? from < other.from : to < other.to;
  }
};

// Per segment, the edges that the record says are on it, in the segment's order. The oracle counts
// them, and fails for those that are not.
std::vector<std::vector<SegmentPart>> parts_of(const PlaneComplex& mesh, const PlaneGraph& input,
                                               OracleReport& oracle);

// Adds to the report, with the prefix before each name:
// - complex: no directed edge has two triangles; the border is a rectangle around the input, whose
//   area the triangles have; all edges of the border are listed; listed edges are edges, once each,
//   on a segment or on the rectangle;
// - orientation: every triangle is counter-clockwise;
// - delaunay: every edge that is not listed is locally Delaunay.
// False if it is not a complex at all (is_hopeless); then nothing else is checked.
bool check_plane_complex(const PlaneComplex& mesh, const PlaneGraph& input,
                         const std::string& prefix, VerifyReport& report);

}  // namespace tetproof::oracles
