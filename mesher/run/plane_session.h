// The state that all stages of one run on one graph share.
#pragma once

#include "mesher/base/control.h"
#include "mesher/delmesher.h"
#include "mesher/plane/plane_predicates.h"
#include "mesher/predicates/points.h"

namespace delmesher::plane {

struct Session {
  Session(const PlaneOptions& run_options, Control& run_control)
      : options(run_options), control(run_control) {}

  const PlaneOptions& options;
  Control& control;
  PointStore points;  // the input vertices, the corners of the box, then what the stages append
  PlanePredicates predicates{points};
};

}  // namespace delmesher::plane
