// Invalid twins: surfaces with one defect more than a valid one, and that as small as doubles
// allow.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "corpus/generate/random.h"
#include "mesher/delmesher.h"

namespace tetproof {

struct Twin {
  std::string name;  // "intersecting", "open", "degenerate", ...
  delmesher::Surface surface;
  delmesher::Defect::Kind reason;  // certified: the first defect of the surface
};

// What can be made of a valid surface: just intersecting (a vertex one double too far), open by one
// ulp (one corner of one triangle beside the others), degenerate (a triangle of collinear corners),
// one triangle turned over.
std::vector<Twin> make_twins(const delmesher::Surface& surface, Random& random);

// As `delmesher check` words it.
const char* reason_text(delmesher::Defect::Kind reason);

}  // namespace tetproof
