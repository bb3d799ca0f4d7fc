#include "oracles/cgal/surface_opinion.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Polygon_mesh_processing/shape_predicates.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace tetproof::oracles {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
namespace processing = CGAL::Polygon_mesh_processing;

// A defect of the lists that neither library accepts; empty if there is none.
std::string defect_of_lists(const Polyhedron& surface) {
  if (surface.triangles.empty()) return "no triangles";
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    for (const Index v : surface.triangles[t]) {
      if (v >= surface.vertices.size()) {
        return "triangle " + std::to_string(t) + " refers to no vertex";
      }
    }
  }
  for (std::size_t v = 0; v < surface.vertices.size(); ++v) {
    for (const double x : surface.vertices[v]) {
      if (!std::isfinite(x)) return "vertex " + std::to_string(v) + " is not finite";
    }
  }
  return {};
}

// Adds the triangles one by one, which CGAL's mesh rejects where an edge would get a third triangle
// or two that are not consistently oriented. False if it rejects one, perhaps for the order in
// which they come, or if two fans of triangles meet at a vertex: then more edges end there than the
// vertex itself can reach.
bool add_triangles(const Polyhedron& surface, const std::vector<Kernel::Point_3>& points,
                   Mesh& mesh) {
  mesh.reserve(static_cast<Mesh::size_type>(points.size()),
               static_cast<Mesh::size_type>(3 * surface.triangles.size() / 2),
               static_cast<Mesh::size_type>(surface.triangles.size()));
  for (const Kernel::Point_3& p : points) mesh.add_vertex(p);
  for (const auto& [a, b, c] : surface.triangles) {
    if (a == b || b == c || c == a) return false;
    const auto face =
        mesh.add_face(Mesh::Vertex_index(a), Mesh::Vertex_index(b), Mesh::Vertex_index(c));
    if (face == Mesh::null_face()) return false;
  }
  std::size_t reached = 0;
  for (const auto v : mesh.vertices()) {
    if (!mesh.is_isolated(v)) reached += mesh.degree(v);
  }
  return reached == mesh.number_of_halfedges();
}

// The same by functions that take several times as long, and that see all triangles at once.
bool assemble(const Polyhedron& surface, const std::vector<Kernel::Point_3>& points, Mesh& mesh) {
  std::vector<std::array<std::size_t, 3>> polygons;
  for (const auto& t : surface.triangles) polygons.push_back({t[0], t[1], t[2]});
  if (!processing::is_polygon_soup_a_polygon_mesh(polygons)) return false;
  processing::polygon_soup_to_polygon_mesh(points, polygons, mesh);
  return true;
}

// Two triangles that are a closed component by themselves: not every release calls that an
// intersection.
void add_pairs_of_same_corners(const Mesh& mesh,
                               std::vector<std::pair<Mesh::Face_index, Mesh::Face_index>>& pairs) {
  for (const auto face : mesh.faces()) {
    const auto first = mesh.halfedge(face), second = mesh.next(first), third = mesh.next(second);
    const auto other = mesh.face(mesh.opposite(first));
    if (other == mesh.face(mesh.opposite(second)) && other == mesh.face(mesh.opposite(third))) {
      pairs.emplace_back(face, other);
    }
  }
}

// Triangles of a complex, by vertices of which no two are at one place.
class Complex {
 public:
  explicit Complex(const Polyhedron& given) {
    std::map<Position, std::size_t> vertex;
    for (const auto& triangle : given.triangles) {
      std::array<std::size_t, 3>& corners = corners_.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) {
        Position p = given.vertices[triangle[k]];
        for (double& x : p) x += 0;  // -0 is 0
        corners[k] = vertex.try_emplace(p, points_.size()).first->second;
        if (corners[k] == points_.size()) points_.emplace_back(p[0], p[1], p[2]);
      }
    }
  }

  std::string defect() const {
    std::vector<Box> boxes;
    for (std::size_t t = 0; t < corners_.size(); ++t) {
      const auto& [a, b, c] = corners_[t];
      if (CGAL::collinear(points_[a], points_[b], points_[c])) {
        return "triangle " + std::to_string(t) + " is flat";
      }
      boxes.emplace_back(points_[a].bbox() + points_[b].bbox() + points_[c].bbox(), &corners_[t]);
    }
    std::string found;
    CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const Box& x, const Box& y) {
      const std::size_t t = number(x), u = number(y);
      if (!found.empty() || !meet_elsewhere(t, u)) return;
      found = "triangles " + std::to_string(t) + " and " + std::to_string(u) + " intersect";
    });
    return found;
  }

 private:
  using Corners = std::array<std::size_t, 3>;
  using Box = CGAL::Box_intersection_d::Box_with_handle_d<double, 3, const Corners*>;

  std::size_t number(const Box& box) const {
    return static_cast<std::size_t>(box.handle() - corners_.data());
  }
  Kernel::Triangle_3 triangle(std::size_t t) const {
    const auto& [a, b, c] = corners_[t];
    return {points_[a], points_[b], points_[c]};
  }
  // The corners of t that u has not, then those that it has.
  std::array<std::size_t, 3> apart_first(std::size_t t, std::size_t u) const {
    std::array<std::size_t, 3> corners = corners_[t];
    std::stable_partition(corners.begin(), corners.end(),
                          [&](std::size_t v) { return std::ranges::count(corners_[u], v) == 0; });
    return corners;
  }
  bool meet_elsewhere(std::size_t t, std::size_t u) const {
    const std::array<std::size_t, 3> p = apart_first(t, u), q = apart_first(u, t);
    const auto common = static_cast<std::size_t>(
        std::ranges::count_if(p, [&](std::size_t v) { return std::ranges::count(q, v) > 0; }));
    const auto at = [&](std::size_t v) { return points_[v]; };
    switch (common) {
      case 0:
        return CGAL::do_intersect(triangle(t), triangle(u));
      case 1:  // the sides opposite to the common corner
        return CGAL::do_intersect(triangle(u), Kernel::Segment_3(at(p[0]), at(p[1]))) ||
               CGAL::do_intersect(triangle(t), Kernel::Segment_3(at(q[0]), at(q[1])));
      case 2:
        return CGAL::coplanar(at(p[1]), at(p[2]), at(p[0]), at(q[0])) &&
               CGAL::coplanar_orientation(at(p[1]), at(p[2]), at(p[0]), at(q[0])) == CGAL::POSITIVE;
      default:
        return false;
    }
  }

  std::vector<Kernel::Point_3> points_;
  std::vector<std::array<std::size_t, 3>> corners_;
};

}  // namespace

std::string cgal_complex_defect(const Polyhedron& complex) {
  const std::string reason = defect_of_lists(complex);
  return reason.empty() ? Complex(complex).defect() : reason;
}

SurfaceOpinion cgal_surface_opinion(const Polyhedron& surface, const SurfaceQuestions& questions) {
  SurfaceOpinion opinion;
  opinion.reason = defect_of_lists(surface);
  if (!opinion.reason.empty()) return opinion;
  std::vector<Kernel::Point_3> points;
  for (const Position& p : surface.vertices) points.emplace_back(p[0], p[1], p[2]);
  Mesh mesh;
  opinion.manifold = add_triangles(surface, points, mesh);
  if (!opinion.manifold) {
    mesh.clear();
    opinion.manifold = assemble(surface, points, mesh);
  }
  if (!opinion.manifold) {
    opinion.reason = "not a consistently oriented manifold";
    return opinion;
  }
  opinion.closed = CGAL::is_closed(mesh);
  if (!opinion.closed) {
    opinion.reason = "open";
    return opinion;
  }
  opinion.decides_intersections = questions.intersections;
  if (!questions.intersections) return opinion;
  for (const auto face : mesh.faces()) {
    if (!processing::is_degenerate_triangle_face(face, mesh)) continue;
    opinion.reason = "triangle " + std::to_string(static_cast<std::size_t>(face)) + " is flat";
    return opinion;
  }
  std::vector<std::pair<Mesh::Face_index, Mesh::Face_index>> pairs;
  processing::self_intersections(mesh, std::back_inserter(pairs));
  add_pairs_of_same_corners(mesh, pairs);
  opinion.free_of_intersections = pairs.empty();
  if (!pairs.empty()) {
    const auto [a, b] = *std::min_element(pairs.begin(), pairs.end());
    opinion.reason = "triangles " + std::to_string(static_cast<std::size_t>(a)) + " and " +
                     std::to_string(static_cast<std::size_t>(b)) + " intersect";
  }
  return opinion;
}

}  // namespace tetproof::oracles
