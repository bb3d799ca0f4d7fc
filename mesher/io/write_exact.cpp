#include "mesher/io/exact_file.h"

namespace delmesher::io {
namespace {

void write_point(TextSink& out, const ExactPoint& p) {
  switch (p.kind) {
    case ExactPoint::Kind::explicit_point:
      out.text("E ");
      out.hex(p.x);
      out.text(" ");
      out.hex(p.y);
      out.text(" ");
      out.hex(p.z);
      break;
    case ExactPoint::Kind::on_segment:
      out.text("S ");
      out.integers(p.i, p.j);
      out.hex(p.x);
      break;
    case ExactPoint::Kind::on_triangle:
      out.text("T ");
      out.integers(p.i, p.j, p.k);
      out.hex(p.x);
      out.text(" ");
      out.hex(p.y);
      break;
    case ExactPoint::Kind::on_planes:
      out.text("P ");
      out.integers(p.i, p.j);
      out.integer(p.k);
      break;
  }
  out.text("\n");
}

void write_plane(TextSink& out, const ExactRecord::Plane& plane) {
  out.text(plane.spanned ? "T" : "N");
  const auto numbers = [&](const std::array<double, 3>& x) {
    for (const double value : x) {
      out.text(" ");
      out.hex(value);
    }
  };
  if (!plane.spanned) numbers(plane.normal);
  numbers(plane.through[0]);
  if (plane.spanned) {
    numbers(plane.through[1]);
    numbers(plane.through[2]);
  }
  out.text("\n");
}

void write_list(TextSink& out, const std::vector<std::uint32_t>& list) {
  out.integer(list.size());
  for (std::uint32_t value : list) {
    out.text(" ");
    out.integer(value);
  }
  out.text("\n");
}

void write_tets(TextSink& out, const char* name, const std::vector<ExactRecord::Tet>& tets) {
  out.section(name, tets.size());
  for (const auto& tet : tets) {
    for (std::uint32_t v : tet.vertices) out.integers(v);
    out.text(tet.inside ? "1\n" : "0\n");
  }
}

void write_triangles(TextSink& out, const char* name,
                     const std::vector<std::array<std::uint32_t, 4>>& triangles) {
  out.section(name, triangles.size());
  for (const auto& [a, b, c, facet] : triangles) {
    out.integers(a, b, c);
    out.integer(facet);
    out.text("\n");
  }
}

void write_parameters(TextSink& out, const ExactRecord::Parameters& p) {
  out.section("parameters", 1);
  for (const double value : {p.delta, p.acute, p.corner, p.tolerance}) {
    out.hex(value);
    out.text(" ");
  }
  out.text(p.region == Region::hull ? "1 " : "0 ");
  out.text(p.gabriel ? "1 " : "0 ");
  out.hex(p.planar);
  out.text("\n");
}

// Origin, planes, triangles and points.
void write_meshed_surface(TextSink& out, const ExactRecord& record) {
  out.section("origin", 1);
  out.hex(record.origin[0]);
  out.text(" ");
  out.hex(record.origin[1]);
  out.text(" ");
  out.hex(record.origin[2]);
  out.text("\n");
  out.section("planes", record.planes.size());
  for (const ExactRecord::Plane& plane : record.planes) write_plane(out, plane);
  out.section("triangles", record.triangles.size());
  for (const auto& [a, b, c] : record.triangles) {
    out.integers(a, b);
    out.integer(c);
    out.text("\n");
  }
  out.section("points", record.points.size());
  for (const ExactPoint& p : record.points) write_point(out, p);
}

// Facets, segments and corners.
void write_complex(TextSink& out, const ExactRecord& record) {
  out.section("facets", record.facets.size());
  for (const auto& facet : record.facets) {
    out.integers(facet.id, facet.label, static_cast<int>(facet.filtered));
    write_list(out, facet.triangles);
  }
  out.section("segments", record.segments.size());
  for (const auto& chain : record.segments) {
    // The facet of an input edge means nothing: "-".
    out.text(chain.artificial ? "A " : "I - ");
    if (chain.artificial) out.integers(chain.facet);
    write_list(out, chain.vertices);
  }
  out.section("corners", record.corners.size());
  for (const auto& corner : record.corners) {
    out.integers(corner.vertex);
    out.hex(corner.distance);
    out.text("\n");
  }
}

void write_chamfer_points(TextSink& out, const ExactRecord& record) {
  out.section("chamfer_points", record.chamfer_points.size());
  for (const auto& [point, vertex] : record.chamfer_points) {
    out.integers(point);
    out.integer(vertex);
    out.text("\n");
  }
}

void write_balls(TextSink& out, const ExactRecord& record) {
  out.section("balls", record.balls.size());
  for (const auto& ball : record.balls) {
    out.integers(ball.vertex);
    for (std::uint32_t v : ball.tetrahedron) out.integers(v);
    out.text("\n");
  }
}

}  // namespace

WriteStatus write_exact(OutputSet& outputs, const std::string& path, const ExactRecord& record) {
  WriteStatus status;
  TextSink* opened = outputs.open(path, status);
  if (opened == nullptr) return status;
  TextSink& out = *opened;
  out.section("delmesher-exact", kExactVersion);
  write_parameters(out, record.parameters);
  write_meshed_surface(out, record);
  write_complex(out, record);
  write_tets(out, "refined", record.refined);
  write_triangles(out, "refined_facets", record.refined_facets);
  write_tets(out, "final", record.final);
  write_triangles(out, "final_facets", record.final_facets);
  out.section("mesh_vertices", record.mesh_vertices.size());
  for (std::uint32_t v : record.mesh_vertices) {
    out.integer(v);
    out.text("\n");
  }
  write_chamfer_points(out, record);
  write_balls(out, record);
  write_tets(out, "unrepaired", record.unrepaired);
  write_triangles(out, "unrepaired_facets", record.unrepaired_facets);
  out.text("end\n");
  return status;
}

}  // namespace delmesher::io
