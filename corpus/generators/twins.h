// Invalid twins: surfaces with one defect more than a valid one, as small as doubles allow.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "corpus/generators/random.h"
#include "mesher/delmesher.h"

namespace tetproof {

struct Twin {
  std::string name;  // "intersecting", "open", "degenerate", ...
  delmesher::Surface surface;
  delmesher::Defect::Kind reason;  // certified: the first defect of the surface
};

// The twins of a valid surface: just intersecting (a vertex one double too far; where no vertex can
// meet anything, a part that touches a vertex), open by one ulp (one corner of one triangle beside
// the others), degenerate (a triangle of collinear corners), one triangle turned over. A twin that
// cannot be made is left out.
std::vector<Twin> make_twins(const delmesher::Surface& surface, Random& random);

// As `delmesher check` words it.
const char* reason_text(delmesher::Defect::Kind reason);

}  // namespace tetproof
