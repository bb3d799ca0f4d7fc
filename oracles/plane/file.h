// Files of the plane, read by the oracles' own readers: planar graphs as delmesher reads them
// (Triangle's .poly, OFF, OBJ, rings), triangulations as it writes them (.node with .ele and
// .poly, .vtu, .msh, .off), and the record of `delmesher plane --exact`.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "mesher/delmesher_plane.h"

namespace tetproof::oracles {

struct PlaneFile {
  std::vector<std::array<double, 2>> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  bool names_sides = true;           // the format says which triangles are inside
  std::vector<std::uint8_t> inside;  // per triangle; empty: the file says nothing
  // Per triangle, of the input's regions; empty: the file says nothing about them.
  std::vector<double> attributes{};
  bool has_attributes = false;  // the format has them
  std::string lacks{};          // a file of the format that is not there
  bool lists_edges = false;     // the file lists the edges that tile the segments
  std::vector<std::array<std::uint32_t, 2>> edges;
  std::vector<std::int32_t> markers;    // per edge
  bool names_segments = false;          // the format has a segment for every edge
  std::vector<std::uint32_t> segments;  // per edge, of the input; empty: the file says nothing
  bool lists_holes = false;             // the file lists the holes and the regions of the input
  std::vector<std::array<double, 2>> holes;
  std::vector<delmesher::PlanarGraph::Region> regions;
};

// All throw ReadError.
//
// The numbers of segments are those of the mesher: in a .poly as listed, else in the order of
// their first appearance at the triangles, cut as formats.md says.
delmesher::PlanarGraph read_plane_graph(const std::string& path);
PlaneFile read_plane_file(const std::string& path);
delmesher::PlaneRecord read_plane_sidecar(const std::string& path, unsigned* version = nullptr);

// The file that a run of the library would write.
PlaneFile plane_file_of(const delmesher::PlaneMesh& mesh);

}  // namespace tetproof::oracles
