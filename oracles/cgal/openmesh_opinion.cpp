#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/System/omstream.hh>
#include <algorithm>

#include "oracles/cgal/surface_opinion.h"

namespace tetproof::oracles {
namespace {

struct DoubleTraits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
};
using Mesh = OpenMesh::TriMesh_ArrayKernelT<DoubleTraits>;

// Adds the triangles one by one. The kernel rejects a triangle that would make the surface
// non-manifold at an edge or a vertex. A refusal may depend on the order, so a refused triangle is
// tried again once the fan has grown.
std::size_t add_triangles(const Polyhedron& surface,
                          const std::vector<Mesh::VertexHandle>& vertices, Mesh& mesh) {
  std::vector<std::size_t> waiting(surface.triangles.size());
  for (std::size_t t = 0; t < waiting.size(); ++t) waiting[t] = t;
  for (std::size_t before = waiting.size() + 1; !waiting.empty() && waiting.size() < before;) {
    before = waiting.size();
    std::erase_if(waiting, [&](std::size_t t) {
      const auto& [a, b, c] = surface.triangles[t];
      return mesh.add_face(vertices[a], vertices[b], vertices[c]).is_valid();
    });
  }
  return waiting.empty() ? surface.triangles.size() : waiting.front();
}

}  // namespace

SurfaceOpinion openmesh_surface_opinion(const Polyhedron& surface) {
  SurfaceOpinion opinion;
  opinion.decides_intersections = false;
  if (surface.triangles.empty()) {
    opinion.reason = "no triangles";
    return opinion;
  }
  for (const auto& [a, b, c] : surface.triangles) {
    if (std::max({a, b, c}) >= surface.vertices.size() || a == b || b == c || c == a) {
      opinion.reason = "a triangle without three vertices";
      return opinion;
    }
  }
  omerr().disable();  // handles report rejections
  Mesh mesh;
  std::vector<Mesh::VertexHandle> vertices;
  for (const Position& p : surface.vertices) {
    vertices.push_back(mesh.add_vertex(Mesh::Point(p[0], p[1], p[2])));
  }
  const std::size_t refused = add_triangles(surface, vertices, mesh);
  omerr().enable();
  opinion.manifold = refused == surface.triangles.size();
  if (!opinion.manifold) {
    opinion.reason = "triangle " + std::to_string(refused) + " does not fit";
    return opinion;
  }
  for (const auto v : mesh.vertices()) {
    if (mesh.is_isolated(v) || mesh.is_manifold(v)) continue;
    opinion.manifold = false;
    opinion.reason = "vertex " + std::to_string(v.idx()) + " is not a manifold";
    return opinion;
  }
  opinion.closed = true;
  for (const auto e : mesh.edges()) {
    if (!mesh.is_boundary(e)) continue;
    opinion.closed = false;
    opinion.reason = "open";
    break;
  }
  return opinion;
}

}  // namespace tetproof::oracles
