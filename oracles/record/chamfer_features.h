// The size of the features that chamfering makes (section 7, second step), worked out from the
// input alone, by the construction of section 4.2.
#pragma once

#include <algorithm>
#include <array>

#include "oracles/surface/corners.h"

namespace tetproof::oracles {

// What was promised of the chamfers.
struct ChamferShape {
  double limit = 0;           // the largest chamfer radius (--chamfer-radius); 0: none
  bool to_link = false;       // a third of the way to the link, not to the facets' boundary
  bool per_triangle = false;  // a bridge in every triangle, however wide
};

// The chamfers of the surface that the present facets form. Lengths are in input units, rounded.
class ChamferFeatures {
 public:
  // The arguments must outlive this.
  ChamferFeatures(const ExactPoints& points, const InputSurface& surface,
                  const AcuteCorners& corners, const CornerThresholds& thresholds,
                  const ChamferShape& shape)
      : points_(points),
        surface_(surface),
        corners_(corners),
        thresholds_(thresholds),
        shape_(shape) {}

  // Two points, edges or facets that chamfering separates.
  struct Feature {
    double size;  // the shortest distance between them
    // How often a gap of their distance fits along them, at most: the integral of ds / distance.
    // 0 if only points, or edges as short as the distance, are so close.
    double times;
    // Whose boundaries or corners they are; kNone: fewer. All kNone: of each facet at the vertex.
    std::array<Index, 4> facets{kNone, kNone, kNone, kNone};
    // Could it go with that facet, which is at the vertex?
    bool is_of(Index facet) const {
      return facets[0] == kNone || std::find(facets.begin(), facets.end(), facet) != facets.end();
    }
  };
  // The features that chamfering makes at a vertex: the sides of a bridge, cut points of two edges
  // and the rest of these edges, a cut point and a facet, and the borders of the strips cut off on
  // both sides of an acute edge. None if the vertex is not acute.
  std::vector<Feature> at(Index v, const AcuteCorners::Present& present) const;

 private:
  struct Sector {
    Index facet;
    double angle;
  };
  void add_edges(Index v, const AcuteCorners::Present& present, std::vector<Feature>& list) const;
  void add_strips(Index e, const AcuteCorners::Present& present, std::vector<Feature>& list) const;
  double distance(Index v, const AcuteCorners::Present& present) const;
  double step_of(double sector) const;
  std::vector<Sector> sectors(Index v, const AcuteCorners::Present& present) const;
  double step(Index v, Index facet, const AcuteCorners::Present& present) const;
  double strip(Index edge, Index facet, const AcuteCorners::Present& present) const;
  double strip_in_triangle(Index t, const AcuteCorners::Present& present) const;
  Index triangle_beside(Index edge, Index facet) const;

  const ExactPoints& points_;
  const InputSurface& surface_;
  const AcuteCorners& corners_;
  const CornerThresholds& thresholds_;
  ChamferShape shape_;
};

}  // namespace tetproof::oracles
