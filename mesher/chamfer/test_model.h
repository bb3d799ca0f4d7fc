// A surface with all that chamfering needs, for tests.
#pragma once

#include "mesher/chamfer/chamfer.h"

namespace delmesher::chamfer {

struct Model {
  explicit Model(const Surface& surface)
      : predicates(points),
        control(control_options),
        topology(build_topology(surface, points, predicates)) {}

  ChamferResult run(const ChamferOptions& options) {
    return chamfer(topology, points, predicates, options, control);
  }

  Limits control_options;
  PointStore points;
  Predicates predicates;
  Control control;
  SurfaceTopology topology;
};

inline ChamferOptions below(double angle) {
  ChamferOptions options;
  options.cosine_squared = cosine_squared(angle);
  return options;
}

// The surface's own complex: nothing is acute below 0 degrees.
inline ChamferOptions untouched() {
  ChamferOptions options;
  options.cosine_squared = 1;
  return options;
}

}  // namespace delmesher::chamfer
