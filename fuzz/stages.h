// A valid surface prepared for single stages of the mesher.
#pragma once

#include "mesher/base/control.h"
#include "mesher/delmesher.h"
#include "mesher/predicates/predicates.h"
#include "mesher/surface/topology.h"
#include "mesher/surface/validity.h"

namespace tetproof::fuzz {

struct Stages {
  explicit Stages(const delmesher::Surface& surface)
      : control(options),
        topology(
            delmesher::surface::build_topology(oriented(surface, control), points, predicates)) {}

  static delmesher::Surface oriented(const delmesher::Surface& surface,
                                     delmesher::base::Control& control) {
    const auto validity = delmesher::surface::check_validity(surface, true, control);
    return delmesher::surface::oriented_outwards(surface, validity);
  }

  delmesher::Options options;
  delmesher::base::Control control;
  delmesher::predicates::PointStore points;
  delmesher::predicates::Predicates predicates{points};
  delmesher::surface::SurfaceTopology topology;
};

// Are doubles fine enough for the surface? Its features are farther apart than this share of its
// largest coordinate: thousands of roundings, unless stated otherwise.
bool roomy(const delmesher::Surface& surface, double share = 0x1p-40);

}  // namespace tetproof::fuzz
