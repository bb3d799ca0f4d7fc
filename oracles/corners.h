// Which corners of the input are acute (section 4), found on the input alone.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "oracles/input_surface.h"

namespace tetproof::oracles {

// Where a threshold has no exact cosine, which side its rounding is on.
enum class Doubt : std::uint8_t {
  acute,     // an angle as good as at the threshold counts as below it
  not_acute  // it does not
};

// Compares angles with a threshold in degrees by their squared cosines, which are rational. 60 and
// 90 degrees are exact.
class AngleBound {
 public:
  AngleBound(double degrees, Doubt doubt);
  // Is the angle whose cosine has this sign, and this square over `norms`, below it?
  bool above(const ExactNumber& cosine, const ExactNumber& norms) const {
    return cosine > 0 && beyond(cosine * cosine, norms);
  }
  bool beyond(const ExactNumber& squared_cosine, const ExactNumber& norms) const {
    return squared_cosine * ExactNumber(mpz_class(bound_.get_den())) >
           ExactNumber(mpz_class(bound_.get_num())) * norms;
  }
  // Is it certainly not, as far as intervals tell?
  bool surely_not_above(const Interval& cosine, const Interval& norms) const {
    return cosine.sign() == -1 || surely_not_beyond(cosine * cosine, norms);
  }
  bool surely_not_beyond(const Interval& squared_cosine, const Interval& norms) const {
    return (squared_cosine - rough_bound_ * norms).sign() == -1;
  }

 private:
  mpq_class bound_;
  Interval rough_bound_;
};

// The thresholds in force, in degrees.
struct CornerThresholds {
  std::function<double(Index vertex)> at;        // of edges and facets, and of two facets
  std::function<double(Index vertex)> of_edges;  // of two edges
};

// Sign of the turn from the direction v -> p to v -> q, projected onto the facet and seen from
// outside: positive to the left.
int left_turn(const ExactPoints& points, const InputSurface::Facet& facet, Index v, Index p,
              Index q);

// The surface of those facets that are present.
class AcuteCorners {
 public:
  using Present = std::function<bool(Index facet)>;

  AcuteCorners(const ExactPoints& points, const InputSurface& surface);

  // Edges of the surface at a vertex, present or not.
  const std::vector<Index>& edges_at(Index v) const { return edges_at_[v]; }
  // The triangles at a vertex.
  const std::vector<Index>& triangles_at(Index v) const { return triangles_at_[v]; }
  static bool edge_present(const InputSurface::Edge& edge, const Present& present) {
    return present(edge.left) || present(edge.right);
  }

  // Two facets that are present meet below the stricter threshold of the edge's ends.
  bool edge_is_acute(Index e, const Present& present, const CornerThresholds& thresholds,
                     Doubt doubt) const;
  // What makes the vertex acute; empty if nothing does.
  std::string why_acute(Index v, const Present& present, const CornerThresholds& thresholds,
                        Doubt doubt) const;

  // Is an edge of the boundary of one of the facets present at v, not incident to v, closer to v
  // than this? (The local feature size of section 4.1, by facets.) Names it; empty if none is.
  std::string nearer_than(double distance, Index v, const Present& present) const;
  // The local feature size itself, at most `most`; rounded.
  double local_feature_size(Index v, const Present& present, double most) const;

 private:
  bool edge_meets_facet(Index v, Index edge, const Present& present, const AngleBound& bound) const;
  bool is_flat(Index t, int i) const {
    return surface_.facet_of_triangle()[surface_.neighbour(t, i)] ==
           surface_.facet_of_triangle()[t];
  }
  const IntervalVector& rough_normal(Index facet) const {
    return surface_.facets()[facet].rough_normal;
  }
  template <class Visit>
  void boundary_near(Index v, double distance, const Present& present, Visit visit) const;

  const ExactPoints& points_;
  const InputSurface& surface_;
  std::vector<std::vector<Index>> edges_at_, triangles_at_;
  std::unique_ptr<BoxTree> edge_tree_;
};

}  // namespace tetproof::oracles
