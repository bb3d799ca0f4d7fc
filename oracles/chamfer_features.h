// The size of the features that chamfering makes (section 7, second step), worked out from the
// input alone, by the construction of section 4.2.
#pragma once

#include "oracles/corners.h"

namespace tetproof::oracles {

// The chamfers of the surface that the present facets form. Lengths are in input units, rounded.
class ChamferFeatures {
 public:
  // `limit`: the largest chamfer distance; 0: none. The arguments must outlive this.
  ChamferFeatures(const ExactPoints& points, const InputSurface& surface,
                  const AcuteCorners& corners, const CornerThresholds& thresholds, double limit)
      : points_(points),
        surface_(surface),
        corners_(corners),
        thresholds_(thresholds),
        limit_(limit) {}

  // The smallest feature that chamfering makes at a vertex: the shortest distance between two
  // points, edges or facets that it separates. These are the sides of a bridge, cut points of two
  // edges, a cut point and a facet, and the borders of the strips cut off on both sides of an acute
  // edge. Infinite if the vertex is not acute.
  double smallest(Index v, const AcuteCorners::Present& present) const;

 private:
  struct Sector {
    Index facet;
    double angle;
  };
  double distance(Index v, const AcuteCorners::Present& present) const;
  std::vector<Sector> sectors(Index v, const AcuteCorners::Present& present) const;
  double step(Index v, Index facet, const AcuteCorners::Present& present) const;
  double strip(Index edge, Index facet, const AcuteCorners::Present& present) const;

  const ExactPoints& points_;
  const InputSurface& surface_;
  const AcuteCorners& corners_;
  const CornerThresholds& thresholds_;
  double limit_;
};

}  // namespace tetproof::oracles
