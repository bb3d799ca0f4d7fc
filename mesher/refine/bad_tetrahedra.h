// The bad tetrahedra of a refinement, worst first, and the tetrahedra that are still to be judged.
//
// A tetrahedron's note (Note::waiting) is its level of badness, kFresh while it is to be judged, or
// 0 if it does not wait. Entries stay when their tetrahedron dies. An entry counts only if its
// tetrahedron is alive and waits at the level of the entry; an entry of the heap counts only if its
// tetrahedron is alive, waits, and has the ratio of the entry.
//
// Invariants:
//  - a live tetrahedron that waits at a level has an entry: there, or in the heap if the largest
//    ratio comes first; the other one is empty;
//  - no level above the worst one has entries;
//  - heap_ is a heap, the largest ratio in front;
//  - a tetrahedron, dead or alive, is noted as fresh if and only if it is in the list of fresh
//    ones, where it is once.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "mesher/refine/goal.h"
#include "mesher/refine/notes.h"

namespace delmesher::refine {

class BadTetrahedra {
 public:
  // `largest_ratio_first`: next() goes by the radius-edge ratio itself (section 5.4), not by
  // levels.
  BadTetrahedra(Tetrahedrization& dt, const PointStore& points, bool largest_ratio_first = false)
      : dt_(dt), points_(points), largest_ratio_first_(largest_ratio_first) {}

  // Forgets everything. The tetrahedra of a level are brought into a spatial order when next()
  // comes down to that level for the first time.
  void start();
  // `level`: 1 to Goal::kWorst.
  void add(TetId t, std::uint8_t level);
  // The last added of the worst ones, or kNone. With the largest ratio first, the one with the
  // largest ratio, and of equal ones that with the largest id. It waits on until it dies or is
  // dismissed.
  TetId next();
  // Does it wait at this level, or to be judged?
  bool waits(TetId t, std::uint8_t level) const {
    const std::uint8_t waiting = note(dt_, t, Note::waiting);
    return waiting == level || waiting == kFresh;
  }
  // It will not be split after all.
  void dismiss(TetId t) { note(dt_, t, Note::waiting) = 0; }

  // To be judged later: most of the tetrahedra that appear while subsegments and subfacets are
  // split do not live to be judged.
  void add_fresh(std::span<const TetId> created);
  // Judges the fresh ones that live: judge(t) is a level of badness, 0 for a good one.
  template <class Judge>
  void judge_fresh(Judge&& judge) {
    for (const TetId t : fresh_) {
      dismiss(t);
      if (!dt_.alive(t)) continue;
      const std::uint8_t level = judge(t);
      if (level != 0) add(t, level);
    }
    fresh_.clear();
  }

  // Gives the memory back; nothing may be asked afterwards.
  void release();

  // Throws InternalError at the first broken invariant.
  void validate() const;

 private:
  friend struct BadTetrahedraBreaker;  // of the tests of validate()

  static constexpr std::uint8_t kFresh = Goal::kWorst + 1;

  // A bad tetrahedron by its squared radius-edge ratio; infinite if that cannot be computed.
  struct Ranked {
    double ratio2;
    TetId t;
    auto operator<=>(const Ranked&) const = default;
  };

  void sort_level(std::size_t level);
  double ratio2_of(TetId t) const;
  TetId next_by_ratio();

  Tetrahedrization& dt_;
  const PointStore& points_;
  std::array<std::vector<TetId>, Goal::kWorst + 1> level_;  // level 0 stays empty
  std::size_t worst_ = 0;                                   // no level above has entries
  std::size_t sorted_ = 0;  // the lowest level that has been brought into spatial order
  std::vector<TetId> fresh_;
  bool largest_ratio_first_;
  std::vector<Ranked> heap_;  // the largest ratio in front
};

}  // namespace delmesher::refine
