// Angles, shapes and counts of a mesh in doubles, as robustly as floating point allows (Shewchuk
// 2013).
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "mesher/base/control.h"
#include "mesher/delmesher/statistics.h"

namespace delmesher::output {

// Statistics over the tetrahedra given; `interior` and `vertices` are only reported. A face shared
// by two of the tetrahedra counts once in the face angles' means and histogram: bit i of
// `repeated_faces` tells that face i (opposite vertex i) is one of an earlier tetrahedron; if that
// is empty, the faces are compared. Flat tetrahedra count with dihedral angles 0 and 180, and with
// gamma and SICN 0.
MeshStatistics mesh_statistics(std::span<const std::array<double, 3>> coordinates,
                               std::span<const std::array<std::uint32_t, 4>> tetrahedra,
                               std::span<const std::uint8_t> repeated_faces, std::uint64_t vertices,
                               std::uint64_t interior, Control& control);

}  // namespace delmesher::output
