// Parts of the reader of planar straight-line graphs; see formats.md. read_plane() is public.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "mesher/delmesher_files.h"
#include "mesher/io/parse_surface.h"
#include "mesher/io/readers.h"

namespace delmesher::io {

// read_plane() of a file's bytes; `node_file` returns the .node file beside a .poly without
// vertices.
PlaneReadResult parse_plane(std::string_view bytes, const std::string& path,
                            const NodeFile& node_file = nullptr,
                            const std::function<bool()>& go_on = {});

// Is it a graph of the plane, not a surface: a .poly of dimension 2, or rings?
bool is_plane(std::string_view bytes, const std::string& path);
// Of a file; false if it cannot be read, and of standard input.
bool is_plane_file(const std::string& path);

// --- the single formats; they throw ParseError and ReadingStopped

// Shewchuk's Triangle: vertices, segments, holes, regions. Equal points are one vertex, too.
void read_triangle_poly(std::string_view text, const NodeFile& node_file, Polling& polling,
                        PlaneReadResult& result);
// Rings of "x y" lines, separated by blank lines or lines that begin with '>' (GMT). Equal points
// are one vertex. An edge that occurs an even number of times divides the inside (a border).
void read_polygons(std::string_view text, Polling& polling, PlaneReadResult& result);
// The outline of a flat surface, and the edges where its labels change. Lines divide the inside; if
// there are no faces, they bound it.
PlanarGraph outline(const Surface& surface,
                    const std::vector<std::array<std::uint32_t, 2>>& lines = {});

}  // namespace delmesher::io
