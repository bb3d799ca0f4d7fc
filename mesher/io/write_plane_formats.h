// The writers of single formats of the plane that have files of their own, for meshes that
// write_plane has checked, and their common parts.
#pragma once

#include <array>

#include "mesher/delmesher_plane.h"
#include "mesher/io/output.h"
#include "mesher/io/write_formats.h"

namespace delmesher::io {

using Point2 = std::array<double, 2>;

// The region number of a triangle, by its side.
inline int region(const PlaneMesh& mesh, std::size_t t) {
  return mesh.inside[t] != 0 ? kRegionInside : kRegionOutside;
}

inline void point(TextSink& out, const Point2& p) {
  out.number(p[0]);
  out.text(" ");
  out.number(p[1]);
}

inline void line(TextSink& out) {
  out.text("\n");
}

// As text, or as bytes.
void write_plane_gmsh(TextSink& out, const PlaneMesh& mesh, bool ascii, MshVersion version);
void write_plane_vtu(TextSink& out, const PlaneMesh& mesh, bool ascii);
void write_svg(TextSink& out, const PlaneMesh& mesh);

}  // namespace delmesher::io
