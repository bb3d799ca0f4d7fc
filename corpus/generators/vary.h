// Exact copies of surfaces, for metamorphic tests of any mesher: what they bound is the same solid
// to the last bit, except for an exact motion or scale (reports/relations.h). Whoever meshes one
// can mesh the others.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "corpus/generators/random.h"
#include "mesher/delmesher.h"

namespace tetproof {

// About z by a quarter of a turn; about the diagonal (1, 1, 1) by a third.
delmesher::Surface quarter_turned(const delmesher::Surface& surface);
delmesher::Surface third_turned(const delmesher::Surface& surface);

// Times 2^exponent; nothing if a coordinate has no double there.
std::optional<delmesher::Surface> scaled(const delmesher::Surface& surface, int exponent);

// Vertices and triangles in another order, each triangle beginning with another corner perhaps.
delmesher::Surface renumbered(const delmesher::Surface& surface, Random& random);

// A vertex more, at the midpoint of an edge chosen at random among those whose midpoints are
// doubles; nothing if there are none.
std::optional<delmesher::Surface> split_exactly(const delmesher::Surface& surface, Random& random);

struct ExactCopy {
  std::string suffix;                         // t1, t2, s1, s2, n1, e1
  std::optional<delmesher::Surface> surface;  // nothing if doubles do not have it
};

// Two turns, two scales (2^10 and 2^-10, about those from one unit of length to the next), another
// numbering, an edge split. The same for the same surface on every machine.
std::vector<ExactCopy> exact_copies(const delmesher::Surface& surface);

}  // namespace tetproof
