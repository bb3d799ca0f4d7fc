// The parameters in force when the refinement ended: as asked for, or stricter.
#pragma once

#include "mesher/base/namespaces.h"

namespace delmesher::results {

struct InForce {
  double tau = 0;                // fraction of the diagonal
  double acute = 0, corner = 0;  // degrees
  bool gabriel = false;          // empty diametral balls
};

}  // namespace delmesher::results
