// The state that all stages of one run on one surface share.
#pragma once

#include <cstddef>

#include "mesher/base/control.h"
#include "mesher/delmesher.h"
#include "mesher/geometry/local_frame.h"
#include "mesher/geometry/size_field.h"
#include "mesher/predicates/predicates.h"
#include "mesher/run/meshed_surface.h"

namespace delmesher::run {

struct Session {
  Session(const Options& run_options, Control& run_control, const LocalFrame& run_frame = {})
      : options(run_options), control(run_control), frame(run_frame) {}

  const Options& options;
  Control& control;
  const LocalFrame frame;  // of all coordinates but those that are written
  PointStore points;       // the input vertices, then what the stages append
  Predicates predicates{points};
  MeshedSurface surface;
  SizeField sizes;
  double diagonal = 0;  // of the input's bounding box, in its units

  // Are edges inside to be no longer than someone said?
  bool bounds_edges() const { return options.max_edge > 0 || !sizes.empty(); }
  std::size_t input_vertices() const { return surface.topology().vertex_half_edge.size(); }
};

}  // namespace delmesher::run
