// What is wanted of the tetrahedra.
#pragma once

#include "mesher/geometry/size_field.h"
#include "mesher/improve/improve.h"
#include "mesher/improve/quality.h"

namespace delmesher::improve {

struct Goals {
  Quality target;  // tetrahedra as good as this are left alone
  // Squared sines: no face angle below `promised` and no dihedral angle flatter than `floor` is
  // made, unless one as bad was there.
  float promised = 0, floor = 0;
  double max_edge = 0;                        // no edge longer than this is made; 0: any
  const SizeField* sizes = nullptr;           // nor than these allow; null: any
  std::span<const double> region_edges = {};  // the same as max_edge by region; empty: none
  bool as_given = false;     // tetrahedra are positive on the surface as given, too
  bool everywhere = false;   // tetrahedra outside count as well
  float nearly_good = 0.6F;  // the score that is enough where something else is gained

  bool bounds_edges() const { return max_edge > 0 || sizes != nullptr || !region_edges.empty(); }
  // In tetrahedra of a region; 0: any.
  double max_edge_in(RegionId region) const {
    const double own = region < region_edges.size() ? region_edges[region] : 0;
    return own > 0 && (max_edge == 0 || own < max_edge) ? own : max_edge;
  }
};

Goals goals_of(const ImproveOptions& options);

}  // namespace delmesher::improve
