// Input filtering (section 7): drops whole facets responsible for a local feature size below a
// tolerance.
#pragma once

#include <optional>
#include <vector>

#include "mesher/chamfer/acuteness.h"
#include "mesher/chamfer/chamfer.h"
#include "mesher/chamfer/kept_surface.h"

namespace delmesher::chamfer {

struct FilterResult {
  std::vector<std::uint8_t> facet_kept;     // per facet
  std::vector<std::uint8_t> kept_at_first;  // the same after the first step
  std::uint64_t dropped_triangles = 0;
  std::uint64_t rounds = 0;  // how often something was dropped
};

// First step: drops facets until no two kept facets, edges or vertices that do not touch are closer
// than `tolerance` (absolute distance). The closest pairs come first. After a facet has been
// dropped, only the elements whose closest partner went with it are examined again.
FilterResult filter_input(const SurfaceTopology& topology, const PointStore& points,
                          double tolerance, Control& control);

// First step as the paper has it: a facet goes exactly if one of its vertices or edges, or its
// inside, is closer than the tolerance to an element of the whole surface that does not touch it.
FilterResult filter_all_pairs(const SurfaceTopology& topology, const PointStore& points,
                              double tolerance, Control& control);

// Features made by chamfering may be as small as this share of the tolerance, because chamfering
// makes smaller ones: a chamfer is a third of the local feature size, and a bridge across a corner
// of angle a is 2 sin(a / 2) times as long as the chamfer. Measured on 131 models from which the
// first step drops something at tau = 1e-4: without a second step 80 % of the triangles stay on
// average, with 1/16 79 %, with 1 71 %.
inline constexpr double kChamferedFraction = 1.0 / 16;

// So many times a gap between two chamfered edges that is narrower than the tolerance may fit along
// them. The refinement makes elements as small as the gap all along it, 4 or 5 tetrahedra each time
// it fits. The facets that it is left out for get some dozens of bad tetrahedra in the last step,
// however long it is, so that only the longest are worth it (measured: docs/measurements).
inline constexpr double kLongGap = 500;

struct FilterOptions {
  double tolerance = 0;     // an absolute distance; 0: nothing is dropped
  bool all_pairs = false;   // first step: filter_all_pairs()
  bool both_sides = false;  // second step: both sides of a feature that is too small
  double chamfered_fraction = kChamferedFraction;
};

// The input of the refinement: the kept facets, chamfered.
struct ChamferedSurface {
  FilterResult filter;
  ChamferResult chamfer;
};

// Both steps of section 7 around the chamfering of section 4, for the driver to alternate:
//   drop_close(); do chamfer(); while (drop_small()); finish()
// Once more with a larger tolerance, after raise(). Appends the points of the last chamfering to
// the store; those of earlier ones are taken back.
class FilteredSurface {
 public:
  // options.facet_kept is not looked at.
  FilteredSurface(const SurfaceTopology& topology, PointStore& points, Predicates& predicates,
                  ChamferOptions options, const FilterOptions& filter, Control& control);

  void raise(double tolerance);
  // The first step.
  void drop_close();
  const FilterResult& filter() const { return result_.filter; }
  // Of what the first step has left: at vertices that chamfer() will find acute, the corners beyond
  // three at each.
  double crowded_corners();
  // Chamfers the kept facets: at first all, later only the places that drop_small() has changed.
  // After raise(), only if something was dropped or the tolerance matters to flat vertices.
  void chamfer();
  // How often it did.
  std::uint64_t times_chamfered() const { return times_chamfered_; }
  // The second step: drops facets that are responsible for edges of the chamfered surface shorter
  // than chamfered_fraction * tolerance, for elements of it that are closer than that, or for a gap
  // narrower than the tolerance that fits kLongGap times along both of its edges. Of two elements
  // one side is dropped, or both (FilterOptions). False if there was nothing to drop.
  bool drop_small();
  // Chamfers all that is kept, unless chamfer() just did.
  const ChamferedSurface& finish();
  // The same; the object is empty then.
  ChamferedSurface result();

 private:
  void mark_changed(const std::vector<FacetId>& dropped);
  void forget_chamfer();
  bool is_as_chamfered() const;
  const KeptSurface& kept();
  const Acuteness& acute();

  const SurfaceTopology& topology_;
  PointStore& points_;
  Predicates& predicates_;
  Control& control_;
  ChamferOptions options_;
  FilterOptions filter_;
  const std::size_t first_point_;
  // Per vertex. `changed_`: did the last drop change the points made for it? At first all are 1.
  // `active_`: did it change those of a neighbour, too, so that the vertex must be chamfered
  // again? Empty as long as nothing was dropped.
  std::vector<std::uint8_t> changed_, active_;
  std::optional<KeptSurface> kept_;  // by options_.facet_kept; empty until needed
  std::optional<Acuteness> acute_;   // of it, where active_
  bool is_chamfered_ = false;        // is result_.chamfer of all that is kept?
  std::uint64_t times_chamfered_ = 0;
  ChamferedSurface result_;
};

}  // namespace delmesher::chamfer
