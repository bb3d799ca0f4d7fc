// The input polyhedron as the oracles see it: facets, edges between facets, exact volume, and
// whether a point is inside.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "oracles/base/box_tree.h"
#include "oracles/base/exact_points.h"
#include "oracles/base/triangle_sums.h"
#include "oracles/base/vectors.h"
#include "oracles/files/polyhedron.h"
#include "oracles/surface/ray_parts.h"

namespace tetproof::oracles {

// All functions take points whose first vertices.size() are the polyhedron's. Mesh vertices of the
// same ExactPoints can then be compared with them exactly.
class InputSurface {
 public:
  struct Edge {  // an edge of the polyhedron between two different facets
    Index from, to;
    Index left, right;  // facets to the left of from -> to and of to -> from, seen from outside
  };
  struct Facet {
    Index id;  // smallest triangle index
    std::int32_t label;
    std::int64_t euler = 0;         // of the union of its closed triangles, flat edges included
    std::array<Index, 3> span{};    // the corners of its largest triangle
    IntervalVector rough_normal{};  // encloses the normal, in units of length
    // If it was made of facets that are not in one plane: the sum of its area vectors. Exact
    // numbers of all facets would take more memory than all the rest.
    std::shared_ptr<const ExactVector> sum{};
    double largest = 0;  // coordinate of its corners, without sign
    // The width of the slab that it lies in, in input units, if it was made of several.
    double slab = 0;

    // Outwards; exact, and of any length: where the record has a plane through the facet's corners,
    // that plane's normal, whose numbers are far smaller.
    ExactVector normal(const ExactPoints& points) const;
    // Its area vector, or that of its largest triangle, twice; exact, in squares of units.
    ExactVector area2(const ExactPoints& points) const;
    // The side of the plane through span[0] on which a vertex lies: 1 outside, 0 on it, -1 inside.
    int side(const ExactPoints& points, Index v) const;
    // The sign of the cosine of the angle between the normals of a triangle and of this facet.
    int facing(const ExactPoints& points, const std::array<Index, 3>& triangle) const;

   private:
    // A plane of the record through the corners, and whether its normal points outwards (1) or
    // inwards (-1); 0 if there is none or intervals do not tell.
    std::pair<Index, int> plane_of(const ExactPoints& points) const;
  };

  // Empty on success, else why the polyhedron bounds no solid (open, not orientable, no volume).
  std::string assign(const Polyhedron& polyhedron, const ExactPoints& points);

  // Makes one facet of the two on either side of each of these edges; other edges between the two
  // are not edges any more. Facets of different labels stay apart, and those that no slab of width
  // `thin` (input units) along one of them contains. Each facet made so lies in a slab, across the
  // sum of its area vectors. Returns the width of the widest, in input units, rounded up; infinite
  // if such a sum is zero, or if a triangle faces against it and is not a needle thinner than
  // `thin`: walls around a hollow, or two sides of a plate, are not a facet.
  double unite_facets(const std::vector<Index>& across, double thin, const ExactPoints& points);

  // The same for given facets, by a number for each triangle: a facet is a connected set of
  // triangles of one number and one label.
  double group_facets(const std::vector<Index>& group, double thin, const ExactPoints& points);

  // A triangle no wider than `thin` (input units) is in the plane of any facet beside it, and so
  // are triangles like that beside each other: to which of two facets such needles belong, a mesh
  // has decided. `missing` finds the edges of a surface that a mesh does not have; on that surface
  // each needle is a facet of its own. Needles that only missing edges separate go to the facet
  // that only missing edges separate from them. If there is none, they stay in theirs or, if they
  // were in several, become one; if there are several, they stay apart. Returns what group_facets
  // does.
  using MissingEdges = std::function<std::vector<Index>(const InputSurface&)>;
  double move_needles(const MissingEdges& missing, double thin, const ExactPoints& points);

  // Does a slab of this width (input units), along the plane of one of the two, contain the facet
  // and one of the same label that has an edge in common with it, both facing the same way?
  bool is_flat_with_another(Index facet, double width, const ExactPoints& points) const;

  const std::vector<std::array<Index, 3>>& triangles() const { return triangles_; }
  const std::vector<Facet>& facets() const { return facets_; }
  const std::vector<Index>& facet_of_triangle() const { return facet_of_triangle_; }
  // The triangles of each facet, one facet after another, and where each facet's begin (and the
  // last one's end).
  struct Members {
    std::vector<Index> triangles, first;
    std::span<const Index> of(Index facet) const {
      return std::span(triangles).subspan(first[facet], first[facet + 1] - first[facet]);
    }
  };
  Members members() const;
  // Twice the sum of the area vectors of some faces less that of some triangles.
  std::array<ExactSum, 3> excess2(const ExactPoints& points, TriangleSpan faces,
                                  std::span<const Index> triangles) const;
  // Triangles that edges connect, by the first of each set.
  std::vector<std::vector<Index>> components() const;
  // The triangle across the edge from corner i to corner i + 1.
  Index neighbour(Index triangle, int i) const { return neighbours_[triangle][i]; }
  const std::vector<Edge>& edges() const { return edges_; }
  // Where a facet is, rounding moves a point by at most half of this in each coordinate, however
  // large the surface is elsewhere: the unit in the last place of its largest coordinate, or of the
  // largest one as given, if that is larger. At an edge that of the smaller facet.
  double ulp_on(Index facet, double largest_given = 0) const {
    return unit_in_last_place(std::max(facets_[facet].largest, largest_given));
  }
  double ulp_on(const Edge& edge, double largest_given = 0) const {
    return std::min(ulp_on(edge.left, largest_given), ulp_on(edge.right, largest_given));
  }
  const std::vector<Index>& used_vertices() const { return used_vertices_; }
  const ExactSum& volume6() const { return volume6_; }
  double diagonal() const { return diagonal_; }
  double largest_coordinate() const { return largest_coordinate_; }
  // Appends the triangles whose boxes meet the query.
  void triangles_near(const BoxTree::Box& box, std::vector<Index>& found) const {
    tree_->query(box, found);
  }

  // Is the centroid of these points (of any ExactPoints with the polyhedron's vertices first)
  // inside, by parity? 1 inside, 0 outside, -1 exactly on the surface.
  int inside(const ExactPoints& points, std::span<const Index> corners) const;

  // A cache: on which side of a facet's plane a point lies. Many tetrahedra ask the same.
  using PlaneSides = std::unordered_map<std::uint64_t, int>;
  struct Contact {
    bool enters = false;  // an input triangle meets the interior
    // If none does, bit i is set wherever a triangle that touches the face opposite to corner i
    // lies in its plane, and perhaps elsewhere.
    std::uint8_t covered = 0;
  };
  // How the surface, all of whose facets are planar, meets a tetrahedron (positively oriented).
  Contact contact(const ExactPoints& points, const std::array<Index, 4>& tetrahedron,
                  PlaneSides& known) const {
    return contact(points, tetrahedron, *tree_, {}, known);
  }
  // The same with some parts of the surface, by boxes around them and the triangle of each box; no
  // triangles: all, in order.
  Contact contact(const ExactPoints& points, const std::array<Index, 4>& tetrahedron,
                  const BoxTree& parts, std::span<const Index> triangles, PlaneSides& known) const;

 private:
  std::string find_neighbours();
  void orient_components(const ExactPoints& points);
  void build_facets(const Polyhedron& polyhedron, const ExactPoints& points);
  void unite_polygons(const Polyhedron& polyhedron, const ExactPoints& points,
                      const std::function<void(Index, Index)>& unite) const;
  ExactVector area2(const ExactPoints& points, Index t) const;
  void number_facets(const std::function<Index(Index)>& representative,
                     const std::function<std::int32_t(Index)>& label, bool planar,
                     const ExactPoints& points);
  void find_normals(bool planar, const ExactPoints& points);
  void count_euler();
  // Is the triangle's height over its longest edge at most this?
  bool is_thin(Index t, double thin, const ExactPoints& points) const;
  double widest_slab(const std::vector<std::uint8_t>& asked, double thin,
                     const ExactPoints& points);
  // How far some vertices are below (negative) and above a facet's plane, in input units.
  std::pair<double, double> heights(const Facet& facet, std::span<const Index> triangles,
                                    const ExactPoints& points) const;
  void build_edges();
  void measure(const ExactPoints& points);
  // The side of a facet's plane on which a vertex lies, or 2 where doubles do not tell.
  static int rough_side(const ExactPoints& points, const Facet& facet, Index v);
  // Does the plane of the facet of these triangles enter the tetrahedron? Adds to contact.covered.
  bool plane_enters(const ExactPoints& points, const std::array<Index, 4>& tetrahedron,
                    std::span<const Index> triangles, PlaneSides& known, Contact& contact) const;

  std::vector<std::array<Index, 3>> triangles_;
  std::vector<std::array<Index, 3>> neighbours_;  // across edge corner i -> i + 1
  std::vector<Facet> facets_;
  std::vector<Index> facet_of_triangle_;
  std::vector<Edge> edges_;
  std::vector<Index> used_vertices_;
  ExactSum volume6_;
  double diagonal_ = 0, largest_coordinate_ = 0;
  std::shared_ptr<const BoxTree> tree_;
  std::shared_ptr<const RayParts> parts_;
};

// What the upward ray from the centroid of some points, moved by (e, e^2) for an infinitesimal e,
// crosses of some triangles, whose boxes are in the tree, but of parts that count for nothing;
// without triangle `except`, whose centroid it then is.
struct RayCrossings {
  std::uint64_t count = 0;
  std::int64_t winding = 0;  // those seen counter-clockwise from above less the others
  bool on_triangle = false;  // the centroid is on one, and nothing was counted
};
RayCrossings crossings_above(const ExactPoints& points,
                             const std::vector<std::array<Index, 3>>& triangles,
                             const BoxTree& tree, const RayParts& parts,
                             std::span<const Index> corners, Index except = kNone);

// The smallest box that certainly contains the points.
BoxTree::Box box_around(const ExactPoints& points, std::span<const Index> corners);
BoxTree::Box enlarged(BoxTree::Box box, double by);

}  // namespace tetproof::oracles
