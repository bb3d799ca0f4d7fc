// Which tetrahedra are inside the solid (section 5.5), asked for one at a time during refinement.
//
// Away from the removed part of the surface (chamfered or filtered) the surface is a union of
// subfacets, so no open tetrahedron meets it there and a side is passed on from tetrahedron to
// tetrahedron: kept across an ordinary face, changed across a subfacet of the input. Only
// tetrahedra near the removed part need the exact test against the whole surface.
//
// A tetrahedron's note (Note::side) holds its side, if that is known. Invariant, whenever every
// subfacet is a face: of two neighbours with known sides, none of them straddling or near the
// removed part, one is inside and one outside if and only if a subfacet of the input is between
// them; beyond the hull is outside.
#pragma once

#include <span>

#include "mesher/geometry/box_tree.h"
#include "mesher/refine/notes.h"
#include "mesher/refine/subfacets.h"
#include "mesher/surface/solid.h"

namespace delmesher::refine {

class Sides {
 public:
  // `removed`: boxes that cover the part of the surface that the complex lacks.
  Sides(const Plc& plc, const SurfaceTopology& topology, const PointStore& points,
        Tetrahedrization& dt, const Subfacets& subfacets, std::span<const Box> removed);

  // Requires every subfacet to be a face of the tetrahedrization.
  Side of(TetId t);
  // Is it the side that of() found before, or that the tetrahedron inherited?
  bool known_outside(TetId t) const { return state(t) == State::outside; }
  bool known_inside(TetId t) const { return state(t) == State::inside; }

  // A tetrahedron is `asked` during find_out() only.
  enum class State : std::uint8_t { unknown, outside, inside, straddling, asked };
  // The common side of the tetrahedra of a cavity, which their replacements inherit.
  State common_of_cavity() const;
  void inherit(TetId created, State common) { set(created, common); }

  // With several threads: finds the sides of all tetrahedra near the removed part, as of() would.
  // With one thread it does nothing, and of() finds them.
  void classify_near_removed(Control& control);

  // Requires every subfacet to be a face. Throws InternalError if the invariant is broken.
  void validate() const;

 private:
  friend struct SidesBreaker;  // of the tests of validate()

  State state(TetId t) const { return static_cast<State>(note(dt_, t, Note::side)); }
  void set(TetId t, State s) { note(dt_, t, Note::side) = static_cast<std::uint8_t>(s); }
  // May the tetrahedron touch the removed part? Conservative. `last_near`: the box of it to be
  // asked first; afterwards one that the tetrahedron is near, if there is one.
  bool near_removed(TetId t, std::uint32_t& last_near) const;
  // Is face i of t part of the input surface?
  bool on_surface(TetId t, int i) const;
  State classify(TetId t);
  State through(TetId t, int i) const;
  State find_out(TetId start);
  void tell(TetId source);

  const Plc& plc_;
  const PointStore& points_;
  Tetrahedrization& dt_;
  const Subfacets& subfacets_;
  std::span<const Box> removed_;
  BoxTree removed_boxes_;
  std::uint32_t last_near_ = 0;
  Solid solid_;
};

}  // namespace delmesher::refine
