// The parameters in force when the refinement ended: as asked for, or stricter.
#pragma once

#include <cstdint>
#include <vector>

#include "mesher/base/ids.h"
#include "mesher/base/namespaces.h"

namespace delmesher::results {

struct InForce {
  double tau = 0;                // fraction of the diagonal
  double acute = 0, corner = 0;  // degrees
  bool gabriel = false;          // empty diametral balls
  // Per input vertex, 0 where corners are chamfered up to 90 degrees; empty: nowhere.
  const std::vector<double>* vertex_cosine_squared = nullptr;

  bool tightened(VertexId v) const {
    return !vertex_cosine_squared->empty() && (*vertex_cosine_squared)[v] == 0;
  }
};

}  // namespace delmesher::results
