// MEDIT, TetGen and .tet; the other formats have files of their own.
#include "mesher/io/write_formats.h"

#include <algorithm>

namespace delmesher::io {
namespace {

void write_planar_within(TextSink& out, const TetMesh& mesh) {
  if (mesh.planar_within == 0) return;
  out.text("# PlanarWithin ");
  out.number(mesh.planar_within);
  out.text("\n");
}

}  // namespace

void write_medit(TextSink& out, const NamedMesh& named) {
  const TetMesh& mesh = named.mesh;
  out.text("MeshVersionFormatted 2\nDimension 3\nVertices\n");
  out.integer(named.nodes());
  out.text("\n");
  for (std::size_t i = 0; i < named.nodes(); ++i) {
    out.point(named.node(i));
    out.text(" 0\n");
  }
  out.text(named.second_order() ? "TrianglesP2\n" : "Triangles\n");
  out.integer(mesh.boundary.size());
  out.text("\n");
  for (std::size_t i = 0; i < mesh.boundary.size(); ++i) {
    for (const std::uint32_t v : named.triangle(i)) out.integers(v + 1);
    out.integer(mesh.boundary_labels[i]);
    out.text("\n");
  }
  out.text(named.second_order() ? "TetrahedraP2\n" : "Tetrahedra\n");
  out.integer(mesh.tetrahedra.size());
  out.text("\n");
  for (std::size_t i = 0; i < mesh.tetrahedra.size(); ++i) {
    for (const std::uint32_t v : named.tetrahedron(i)) out.integers(v + 1);
    out.integer(region(mesh, i));
    out.text("\n");
  }
  // No keyword of the format carries a second number per triangle, and some readers refuse unknown
  // keywords even after End; comments are skipped by all.
  out.text("End\n# TriangleFacets ");
  out.integer(mesh.boundary.size());
  out.text("\n");
  for (std::uint32_t facet : mesh.boundary_facets) {
    out.text("# ");
    out.integer(facet);
    out.text("\n");
  }
  write_planar_within(out, mesh);
}

void write_tetgen(TextSink& node, TextSink& ele, TextSink& face, const TetMesh& mesh) {
  node.integer(mesh.vertices.size());
  node.text(" 3 0 0\n");
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    node.integers(i);
    node.point(mesh.vertices[i]);
    node.text("\n");
  }
  write_planar_within(node, mesh);
  ele.integer(mesh.tetrahedra.size());
  ele.text(" 4 1\n");
  for (std::size_t i = 0; i < mesh.tetrahedra.size(); ++i) {
    ele.integers(i);
    for (std::uint32_t v : mesh.tetrahedra[i]) ele.integers(v);
    ele.integer(region(mesh, i));
    ele.text("\n");
  }
  face.integer(mesh.boundary.size());
  face.text(" 1\n");
  for (std::size_t i = 0; i < mesh.boundary.size(); ++i) {
    face.integers(i);
    for (std::uint32_t v : mesh.boundary[i]) face.integers(v);
    face.integers(mesh.boundary_labels[i]);
    face.integer(mesh.boundary_facets[i]);
    face.text("\n");
  }
}

void write_tet(TextSink& out, const TetMesh& mesh) {
  const auto inner = static_cast<std::size_t>(
      std::count_if(mesh.inside.begin(), mesh.inside.end(), [](auto flag) { return flag != 0; }));
  const std::size_t outer = mesh.tetrahedra.size() - inner;
  out.integer(mesh.vertices.size());
  out.text(" vertices\n");
  out.integer(inner);
  out.text(outer == 0 ? " tets\n" : " inner tets\n");
  if (outer != 0) {
    out.integer(outer);
    out.text(" outer tets\n");
  }
  for (const auto& v : mesh.vertices) {
    out.point(v);
    out.text("\n");
  }
  for (const bool wanted : {true, false}) {
    for (std::size_t i = 0; i < mesh.tetrahedra.size(); ++i) {
      if ((mesh.inside[i] != 0) != wanted) continue;
      const auto& [a, b, c, d] = mesh.tetrahedra[i];
      out.text("4 ");
      out.integers(a, b, c);
      out.integer(d);
      out.text("\n");
    }
  }
}

}  // namespace delmesher::io
