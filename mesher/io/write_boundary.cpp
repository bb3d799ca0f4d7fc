// The boundary of a mesh as a surface: STL, PLY and OFF.
#include <cmath>
#include <limits>
#include <string>

#include "mesher/io/named_sets.h"
#include "mesher/io/write_formats.h"

namespace delmesher::io {
namespace {

using Point = std::array<double, 3>;

// For viewers; nobody decides by it. Zero if doubles see no area.
Point unit_normal(const Point& a, const Point& b, const Point& c) {
  Point u, v;
  for (std::size_t k = 0; k < 3; ++k) {
    u[k] = b[k] - a[k];
    v[k] = c[k] - a[k];
  }
  Point n = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
  const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  if (!(length > 0) || !std::isfinite(length)) return {0, 0, 0};
  for (double& x : n) x /= length;
  return n;
}

// Only the vertices of the boundary, in their order.
struct OwnVertices {
  explicit OwnVertices(const TetMesh& mesh) : number(mesh.vertices.size(), kUnused) {
    for (const auto& triangle : mesh.boundary) {
      for (const std::uint32_t v : triangle) number[v] = 0;
    }
    for (std::uint32_t v = 0; v < number.size(); ++v) {
      if (number[v] == kUnused) continue;
      number[v] = static_cast<std::uint32_t>(vertices.size());
      vertices.push_back(v);
    }
  }
  static constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> vertices, number;
};

void points(TextSink& out, const TetMesh& mesh, const OwnVertices& own) {
  for (const std::uint32_t v : own.vertices) {
    out.point(mesh.vertices[v]);
    out.text("\n");
  }
}

void triangle(TextSink& out, const TetMesh& mesh, const OwnVertices& own, std::size_t i) {
  out.text("3");
  for (const std::uint32_t v : mesh.boundary[i]) {
    out.text(" ");
    out.integer(own.number[v]);
  }
}

}  // namespace

void write_boundary_stl(TextSink& out, const NamedMesh& named) {
  const TetMesh& mesh = named.mesh;
  for (const auto& [label, triangles] : triangles_of_labels(mesh)) {
    const std::string name = label_name(named.names, label);
    out.text("solid " + name + "\n");
    for (const std::size_t i : triangles) {
      const auto& [a, b, c] = mesh.boundary[i];
      out.text("facet normal ");
      out.point(unit_normal(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]));
      out.text("\nouter loop\n");
      for (const std::uint32_t v : mesh.boundary[i]) {
        out.text("vertex ");
        out.point(mesh.vertices[v]);
        out.text("\n");
      }
      out.text("endloop\nendfacet\n");
    }
    out.text("endsolid " + name + "\n");
  }
}

void write_boundary_ply(TextSink& out, const NamedMesh& named) {
  const TetMesh& mesh = named.mesh;
  const OwnVertices own(mesh);
  out.text("ply\nformat ascii 1.0\ncomment delmesher\n");
  for (const auto& [label, triangles] : triangles_of_labels(mesh)) {
    if (!named.names.contains(label)) continue;
    out.text("comment label " + std::to_string(label) + " " + label_name(named.names, label) +
             "\n");
  }
  out.text("element vertex ");
  out.integer(own.vertices.size());
  out.text("\nproperty double x\nproperty double y\nproperty double z\nelement face ");
  out.integer(mesh.boundary.size());
  out.text("\nproperty list uchar int vertex_indices\nproperty int label\nend_header\n");
  points(out, mesh, own);
  for (std::size_t i = 0; i < mesh.boundary.size(); ++i) {
    triangle(out, mesh, own, i);
    out.text(" ");
    out.integer(mesh.boundary_labels[i]);
    out.text("\n");
  }
}

void write_boundary_off(TextSink& out, const NamedMesh& named) {
  const TetMesh& mesh = named.mesh;
  const OwnVertices own(mesh);
  out.text("OFF\n");
  out.integers(own.vertices.size(), mesh.boundary.size());
  out.text("0\n");
  points(out, mesh, own);
  for (std::size_t i = 0; i < mesh.boundary.size(); ++i) {
    triangle(out, mesh, own, i);
    out.text("\n");
  }
}

}  // namespace delmesher::io
