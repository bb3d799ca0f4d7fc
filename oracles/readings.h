// How a file may be read as a mesh of the input.
#pragma once

#include <optional>
#include <vector>

#include "oracles/mesh/conformity.h"
#include "oracles/plan.h"

namespace tetproof::oracles {

// The readings of a file are the rows of one table (readings.cpp), tried in its order. The first
// one under which the mesh conforms counts, and the report names it.
class Readings {
 public:
  // `surface` is the input, on the points of `complex`. All arguments must outlive this.
  Readings(const Subject& subject, const TetComplex& complex, const Neighbours& neighbours,
           const InputSurface& surface, double ulp, double diagonal, double largest_given);

  // If the mesh conforms under no reading, that of "deviating".
  ConformityResult conformity();
  // The surface of the reading that counts.
  const InputSurface& surface() const { return united_ ? *united_ : surface_; }

 private:
  struct Reading;
  static const Reading kReadings[];

  bool always() const { return true; }
  bool near_planar() const { return bound_ > 0; }
  bool near_planar_alone() const { return bound_ > 0 && exact_ == nullptr; }
  bool near_planar_recorded() const { return bound_ > 0 && exact_ != nullptr; }
  bool near_planar_unstated() const { return widest_ > bound_ && !stated_; }
  bool is_exact();
  bool is_rounded();
  bool has_united_facets();
  bool has_moved_needles();
  bool has_recorded_facets();
  bool deviates();
  bool has_wider_slab();

  ConformityResult check(const InputSurface& on, ConformityOptions options) const;
  bool conforms_to(InputSurface flat, double width);
  Chains recorded_chains(const InputSurface& surface) const;
  std::vector<Index> recorded_facets() const;

  const Polyhedron& input_;
  const delmesher::ExactRecord* exact_;
  SharedData& shared_;
  const TetComplex& complex_;
  const Neighbours& neighbours_;
  const InputSurface& surface_;
  double rounding_;  // what rounding may move at most, in input units
  double diagonal_;  // this and the next four in input units
  double bound_;     // width of the slab that was promised for facets; 0: none
  double widest_;    // the same of what --planar allows a run to state
  bool stated_;
  double declared_;  // deviation, in input units
  ConformityOptions rounded_{.exact = false}, as_rounded_{.exact = false};
  ConformityResult result_;
  std::vector<Index> failed_edges_;  // of the surface as given, as written
  std::optional<InputSurface> united_;
};

}  // namespace tetproof::oracles
