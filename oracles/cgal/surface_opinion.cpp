#include "oracles/cgal/surface_opinion.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/intersections.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "oracles/cgal/near_triangles.h"

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

class Triangles {
 public:
  // Vertices at one place are one in a complex. There, two triangles may be the same.
  Triangles(const Polyhedron& given, bool complex) : complex_(complex) {
    std::map<Position, Index> numbers;
    for (Position p : given.vertices) {
      for (double& x : p) x += 0;  // -0 is 0
      positions_.push_back(p);
      points_.emplace_back(p[0], p[1], p[2]);
    }
    for (Corners corners : given.triangles) {
      for (Index& v : corners) {
        if (complex) v = numbers.try_emplace(positions_[v], v).first->second;
      }
      corners_.push_back(corners);
    }
  }

  // The first that is flat, or the first two that meet elsewhere than in common corners.
  std::string defect() const {
    for (std::size_t t = 0; t < corners_.size(); ++t) {
      const auto& [a, b, c] = corners_[t];
      if (CGAL::collinear(points_[a], points_[b], points_[c])) {
        return "triangle " + std::to_string(t) + " is flat";
      }
    }
    constexpr std::pair kNobody(kNone, kNone);
    std::pair<Index, Index> found = kNobody;
    for_each_near_pair(positions_, corners_, [&](Index t, Index u) {
      if (std::pair(t, u) < found && meet_elsewhere(t, u)) found = {t, u};
    });
    if (found == kNobody) return {};
    return "triangles " + std::to_string(found.first) + " and " + std::to_string(found.second) +
           " intersect";
  }

 private:
  using Corners = std::array<Index, 3>;

  Kernel::Triangle_3 triangle(std::size_t t) const {
    const auto& [a, b, c] = corners_[t];
    return {points_[a], points_[b], points_[c]};
  }
  // The corners of t that u has not, then those that it has.
  Corners apart_first(Index t, Index u) const {
    Corners corners{};
    std::size_t apart = 0, common = 3;
    for (const Index v : corners_[t]) {
      const bool is_common = std::ranges::count(corners_[u], v) > 0;
      corners[is_common ? --common : apart++] = v;
    }
    return corners;
  }
  bool meet_elsewhere(Index t, Index u) const {
    const Corners p = apart_first(t, u), q = apart_first(u, t);
    const auto common = static_cast<std::size_t>(
        std::ranges::count_if(p, [&](Index v) { return std::ranges::count(q, v) > 0; }));
    const auto at = [&](Index v) -> const Kernel::Point_3& { return points_[v]; };
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
        return !complex_;
    }
  }

  bool complex_;
  std::vector<Position> positions_;
  std::vector<Kernel::Point_3> points_;
  std::vector<Corners> corners_;
};

}  // namespace

std::string cgal_complex_defect(const Polyhedron& complex) {
  const std::string reason = defect_of_lists(complex);
  return reason.empty() ? Triangles(complex, true).defect() : reason;
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
  opinion.reason = Triangles(surface, false).defect();
  opinion.free_of_intersections = opinion.reason.empty();
  return opinion;
}

}  // namespace tetproof::oracles
