// The quality of a mesh of the plane from the file as written, in the same way for every mesher.
#pragma once

#include <cstdint>
#include <string>

#include "oracles/plane/file.h"

namespace tetproof {

// Of the triangles inside, where the file tells them apart. Angles in degrees.
struct PlaneQuality {
  std::uint64_t triangles = 0, vertices = 0;  // vertices in use
  double min_angle = 0, max_angle = 0, mean_min_angle = 0, mean_max_angle = 0;
  double shortest_edge = 0, area = 0;
  std::uint64_t inverted = 0, flat = 0;  // exact signs of the doubles as written
  std::uint64_t crowded_edges = 0;       // of more than two triangles
};

// \throw std::runtime_error if a triangle refers to a vertex that does not exist.
PlaneQuality measure_plane(const oracles::PlaneFile& mesh);

// Keys as in the `final` object of the mesher's --stats; crowded edges are crowded_faces, as those
// of meshes in space.
std::string to_json(const PlaneQuality& quality);

}  // namespace tetproof
