// Which faces of the tetrahedra are subfacets: the mark of a face is the number of a subfacet. This
// class only stores marks. A mark stays when its subfacet dies.
//
// Invariants between insertions:
//  - the two tetrahedra on both sides of a face (on the hull one is a ghost) have the same mark for
//    it, or both have none;
//  - every mark is the number of a subfacet.
#pragma once

#include <array>
#include <span>

#include "mesher/base/growing_array.h"
#include "mesher/refine/notes.h"

namespace delmesher::refine {

class SubfacetMarks {
 public:
  explicit SubfacetMarks(Tetrahedrization& dt) : dt_(dt) {}

  // The mark of face i of a tetrahedron, or kNone.
  std::uint32_t of(TetId t, int i) const {
    return (note(dt_, t, Note::faces) >> i & 1) != 0 ? number_[t][i] : kNone;
  }
  // False only if no face of t has a mark.
  bool any_on(TetId t) const { return note(dt_, t, Note::faces) != 0; }

  // On one side of the face alone.
  void set(FaceHandle side, std::uint32_t mark) {
    number_[side.tet()][side.face()] = mark;
    note(dt_, side.tet(), Note::faces) |= static_cast<std::uint8_t>(1U << side.face());
  }
  // `created` is `inner` with the new vertex in the place of the one opposite `face`.
  void inherit(TetId created, TetId inner, int face) {
    const auto bit = static_cast<std::uint8_t>(1U << face);
    std::uint8_t& faces = note(dt_, created, Note::faces);
    faces = note(dt_, inner, Note::faces) & bit;
    if (faces != 0) number_[created][face] = number_[inner][face];
  }
  // Call before marking new tetrahedra.
  void make_room() {
    if (dt_.capacity() > number_.size()) number_.resize(dt_.capacity());
  }

  // Every mark m becomes number[m]; where that is kNone, it goes.
  void renumber(std::span<const std::uint32_t> number);
  // Gives memory back; nothing may be asked afterwards.
  void release() { number_.release(); }

  // Throws InternalError at the first broken invariant, if there are `subfacets` of them.
  void validate(std::size_t subfacets) const;

 private:
  Tetrahedrization& dt_;
  GrowingArray<std::array<std::uint32_t, 4>> number_;  // per tetrahedron, where its note says so
};

}  // namespace delmesher::refine
