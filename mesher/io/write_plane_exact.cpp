// The sidecar of the plane.
#include "mesher/io/write_plane.h"
#include "mesher/io/write_plane_formats.h"

namespace delmesher::io {
namespace {

void write_triangles(TextSink& out, const char* name,
                     const std::vector<PlaneRecord::Triangle>& triangles) {
  out.section(name, triangles.size());
  for (const auto& triangle : triangles) {
    for (const std::uint32_t v : triangle.vertices) out.integers(v);
    out.integer(static_cast<int>(triangle.side));
    line(out);
  }
}

void write_edges(TextSink& out, const char* name, const std::vector<PlaneRecord::Edge>& edges) {
  out.section(name, edges.size());
  for (const auto& edge : edges) {
    out.integers(edge.vertices[0], edge.vertices[1]);
    out.integer(edge.segment);
    line(out);
  }
}

}  // namespace

WriteStatus write_plane_exact(OutputSet& outputs, const std::string& path,
                              const PlaneRecord& record) {
  WriteStatus status;
  TextSink* out = outputs.open(path, status);
  if (out == nullptr) return status;
  out->text("delmesher-plane-exact 1\n");
  out->section("points", record.points.size());
  for (const ExactPoint& p : record.points) {
    if (p.kind == ExactPoint::Kind::explicit_point) {
      out->text("E ");
      out->hex(p.x);
      out->text(" ");
      out->hex(p.y);
    } else {
      out->text("S ");
      out->integers(p.i, p.j);
      out->hex(p.x);
    }
    line(*out);
  }
  out->section("corners", record.corners.size());
  for (const auto& corner : record.corners) {
    out->integers(corner.vertex);
    out->hex(corner.distance);
    line(*out);
  }
  out->section("dropped", record.dropped.size());
  for (const std::uint32_t segment : record.dropped) {
    out->integer(segment);
    line(*out);
  }
  out->text("bounds ");
  out->hex(record.delta);
  out->text(" ");
  out->hex(record.acute);
  line(*out);
  write_triangles(*out, "refined", record.refined);
  write_edges(*out, "refined_edges", record.refined_edges);
  write_triangles(*out, "final", record.final);
  write_edges(*out, "final_edges", record.final_edges);
  out->section("mesh_vertices", record.mesh_vertices.size());
  for (const std::uint32_t v : record.mesh_vertices) {
    out->integer(v);
    line(*out);
  }
  out->text("end\n");
  return status;
}

}  // namespace delmesher::io
