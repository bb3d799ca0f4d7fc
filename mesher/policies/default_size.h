// Policy: how long edges are where nothing says so.
#pragma once

#include <cstdint>
#include <string>

#include "mesher/delmesher.h"

namespace delmesher::policies {

// What the number of tetrahedra with a size follows from.
struct Part {
  double volume = 0, area = 0;
};
Part part_of(const TetMesh& mesh);

// May Options::size be chosen? Not where another option says how long edges are or how many
// tetrahedra are wanted, where edges of the surface are not to be halved, or come back at the end
// (--planar 0), nor of a mesh that is not the final one.
bool may_choose_size(const Options& options);

// Angles alone leave a bar of 10 x 1 x 1 with 19 tetrahedra, with which it bends 9 % as far as it
// should; this size takes 637 and gives 69 % (linear elements, own weight). It is the thickness of
// the part, twice its volume by its area, between a twentieth and a tenth of the diagonal. 0 where
// the mesh has at least half of the tetrahedra that the size would make, and where the part is
// thinner than a tenth of it: all of those would have dihedral angles below 6 degrees.
struct DefaultSize {
  double size = 0;
  std::uint64_t most_vertices = 0;  // twelve times as many as that should take
};
DefaultSize default_size(const Result& without_size);

// Why the mesh with that size is no better for a solver than the one without: it has more defects,
// or of ten tetrahedra more than one has a dihedral angle below 5 degrees. Empty if it is.
std::string why_not(const Result& sized, const Result& without_size);

}  // namespace delmesher::policies
