#include "oracles/cgal/surface_opinion.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Polygon_mesh_processing/shape_predicates.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <array>
#include <cmath>
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

}  // namespace

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
