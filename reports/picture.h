// A picture of the place that an oracle names: what the mesh and the input have there.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "oracles/files/mesh_file.h"
#include "oracles/surface/input_surface.h"

namespace tetproof {

// What a sentence of an oracle names, by the words that all of them use: "tetrahedron 7 (1 2 3 4)",
// "face (1 2 3)", "vertex 5" are of the mesh, "input vertex 5", "input edge 1-2", "facet 9" (by the
// number of a triangle) of the input; "at (x, y, z)" is a point.
struct Place {
  std::vector<oracles::Index> vertices, input_vertices, input_triangles;
  std::vector<std::vector<oracles::Index>> cells;  // faces and tetrahedra, by their vertices
  std::vector<oracles::Position> points;

  bool empty() const {
    return vertices.empty() && input_vertices.empty() && input_triangles.empty() && points.empty();
  }
};

Place place_of(const std::string& sentence);

// The first sentence that names a place, of the oracles of a verdict (`tetproof verify --json`)
// that have failed; empty if there is none. Nothing if it is not such a verdict.
std::optional<std::string> sentence_with_place(const std::string& verdict_json);

// The picture that a campaign has put into a verdict; empty if there is none.
std::string picture_in(const std::string& verdict_json);

// SVG: what the sentence names in red, the triangles of the input there in blue, edges of
// tetrahedra there in grey, with a caption that says where it is and how large. Empty if the
// sentence names nothing that exists.
std::string picture_of(const oracles::Polyhedron& input, const oracles::MeshFile& mesh,
                       const std::string& sentence);

}  // namespace tetproof
