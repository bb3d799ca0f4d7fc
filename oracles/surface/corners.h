// Finds the acute corners of the input (section 4), on the input alone.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "oracles/base/buckets.h"
#include "oracles/base/parallel.h"
#include "oracles/surface/input_surface.h"

namespace tetproof::oracles {

// The side to which a threshold without exact cosine is rounded.
enum class Doubt : std::uint8_t {
  acute,     // an angle within rounding of the threshold counts as below it
  not_acute  // such an angle does not
};

// Compares angles with a threshold in degrees by their squared cosines, which are rational. The
// thresholds of 60 and 90 degrees are exact.
class AngleBound {
 public:
  AngleBound(double degrees, Doubt doubt);
  // Is the angle below the threshold? Its cosine is `cosine` over the square root of `norms`.
  // `beyond` is for angles known to be at most 90 degrees.
  bool above(const ExactNumber& cosine, const ExactNumber& norms) const {
    return cosine > 0 && beyond(cosine * cosine, norms);
  }
  bool beyond(const ExactNumber& squared_cosine, const ExactNumber& norms) const {
    return squared_cosine * ExactNumber(mpz_class(bound_.get_den())) >
           ExactNumber(mpz_class(bound_.get_num())) * norms;
  }
  // Is it certainly not below, as far as intervals tell?
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
  double with_facets;  // of an edge and a facet, of two facets
  double of_edges;
};
CornerThresholds thresholds_of(const delmesher::ExactRecord::Parameters& parameters);

// Sign of the turn from the direction v -> p to v -> q, projected onto the facet and seen from
// outside: positive to the left.
int left_turn(const ExactPoints& points, const InputSurface::Facet& facet, Index v, Index p,
              Index q);

// The acute corners of the surface that the present facets form.
class AcuteCorners {
 public:
  using Present = std::function<bool(Index facet)>;

  AcuteCorners(const ExactPoints& points, const InputSurface& surface);

  // Edges of the surface at a vertex, present or not.
  std::span<const Index> edges_at(Index v) const { return edges_at_.of(v); }
  // The triangles at a vertex.
  std::span<const Index> triangles_at(Index v) const { return triangles_at_.of(v); }
  // Boxes around the edges of the surface.
  const BoxTree& edge_tree() const;
  static bool edge_present(const InputSurface::Edge& edge, const Present& present) {
    return present(edge.left) || present(edge.right);
  }

  // Do two present facets meet at the edge below the threshold?
  bool edge_is_acute(Index e, const Present& present, const CornerThresholds& thresholds,
                     Doubt doubt) const;
  // The reason why the vertex is acute; empty if it is not.
  std::string why_acute(Index v, const Present& present, const CornerThresholds& thresholds,
                        Doubt doubt) const;

  // Names an edge that is closer to v than `distance` (input units), does not meet v, and is on the
  // boundary of a present facet at v (the local feature size of section 4.1, by facets). Empty if
  // there is none.
  std::string nearer_than(double distance, Index v, const Present& present) const;
  // The local feature size itself, at most `most`, in input units; rounded.
  double local_feature_size(Index v, const Present& present, double most) const;
  // The distance from the edge to the vertices of the facet's boundary that are not its ends, at
  // most `most`, in input units; rounded. Other edges of a facet are no nearer than their ends or
  // than those of this one.
  double distance_to_rest(Index e, Index facet, double most) const;
  // The distance to the link: to the opposite edges of the triangles at v of present facets, in
  // input units; rounded. Infinite if there are none.
  double distance_to_link(Index v, const Present& present) const;

 private:
  bool edge_meets_facet(Index v, Index edge, const Present& present, const AngleBound& bound) const;
  bool is_flat(Index t, int i) const {
    return surface_.facet_of_triangle()[surface_.neighbour(t, i)] ==
           surface_.facet_of_triangle()[t];
  }
  const IntervalVector& rough_normal(Index facet) const {
    return surface_.facets()[facet].rough_normal;
  }
  // Edges whose boxes meet the box of these vertices, widened by the distance.
  std::vector<Index> edges_near(std::span<const Index> vertices, double distance) const;
  template <class Visit>
  void boundary_near(Index v, double distance, const Present& present, Visit visit) const;

  const ExactPoints& points_;
  const InputSurface& surface_;
  Buckets edges_at_, triangles_at_;
  // Made by the first question about distances: most surfaces have no acute corner.
  mutable Once tree_once_;
  mutable std::unique_ptr<BoxTree> edge_tree_;
};

}  // namespace tetproof::oracles
