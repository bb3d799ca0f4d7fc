// The quality of a mesh from the file as written, in the same way for every mesher. The oracles
// measure angles and shapes (oracles/mesh/angles.h, shapes.h).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "oracles/files/mesh_file.h"

namespace tetproof {

// Angles in degrees. Face angles count every triangle once, even if two tetrahedra share it.
struct AngleStatistics {
  double min_face_angle = 0, max_face_angle = 0, min_dihedral = 0, max_dihedral = 0;
  double mean_min_face_angle = 0, mean_max_face_angle = 0;  // per face, as in the paper's Fig. 11
  double mean_min_dihedral = 0, mean_max_dihedral = 0;      // per tetrahedron
  std::array<std::uint64_t, 12> face_angle_histogram{};     // 15-degree bins
  std::array<std::uint64_t, 12> dihedral_histogram{};
  // Tetrahedra with a dihedral angle below 5 and below 10 degrees.
  std::uint64_t below_5 = 0, below_10 = 0;
  // The 1 % quantile of the tetrahedra's smallest dihedral angles.
  double dihedral_percent = 0;
};

// Shapes of tetrahedra: gamma, 3 times the inradius over the circumradius, and Gmsh's signed
// inverse condition number, which is negative for inverted tetrahedra.
struct ShapeStatistics {
  double min_gamma = 0, mean_gamma = 0, gamma_percent = 0;  // the last is the 1 % quantile
  double min_sicn = 0, mean_sicn = 0;
};

struct PartQuality {
  std::uint64_t tetrahedra = 0, vertices = 0, faces = 0;  // vertices in use
  std::uint64_t crowded_faces = 0;                        // of more than two tetrahedra
  double shortest_edge = 0, volume = 0;                   // in (cubic) units of the file
  AngleStatistics angles;
  ShapeStatistics shapes;
};

struct MeshQuality {
  PartQuality all;                    // every tetrahedron of the file
  std::optional<PartQuality> inside;  // only if the file separates inside from outside
  std::uint64_t unused_vertices = 0;
  std::uint64_t inverted = 0, flat = 0;  // exact signs of the doubles as written
  std::uint64_t repeated_corners = 0;    // tetrahedra with a vertex twice (also flat)
  bool left_handed = false;              // most are negative: then the others count as inverted
};

// Tetrahedra of region 1 are inside, if the only other regions of the file are 0 and 2: the
// convention of our own files. Other regions tell nothing about inside and outside: then all are.
// \throw std::runtime_error if a tetrahedron refers to a vertex that does not exist.
std::vector<std::array<std::uint32_t, 4>> inside_of(const oracles::MeshFile& mesh);
MeshQuality measure(const oracles::MeshFile& mesh);

// Keys as in the `final` object of the mesher's --stats, and `inside` with the same ones.
std::string to_json(const MeshQuality& quality);

}  // namespace tetproof
