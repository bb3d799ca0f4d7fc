#include "mesher/refine/bad_tetrahedra.h"

#include <algorithm>
#include <cmath>

#include "mesher/base/check.h"
#include "mesher/base/spatial_sort.h"
#include "mesher/refine/tetrahedron_shape.h"

namespace delmesher::refine {

void BadTetrahedra::start() {
  release();
  sorted_ = level_.size();
  for (TetId t = 0; t < dt_.capacity(); ++t) dismiss(t);
}

void BadTetrahedra::release() {
  for (std::vector<TetId>& level : level_) level = {};
  fresh_ = {};
  heap_ = {};
  worst_ = 0;
}

void BadTetrahedra::add(TetId t, std::uint8_t level) {
  note(dt_, t, Note::waiting) = level;
  if (largest_ratio_first_) {
    heap_.push_back({ratio2_of(t), t});
    std::push_heap(heap_.begin(), heap_.end());
    return;
  }
  level_[level].push_back(t);
  worst_ = std::max(worst_, std::size_t{level});
}

double BadTetrahedra::ratio2_of(TetId t) const {
  TetrahedronShape s = shape_of(points_, dt_.vertices(t));
  add_circumsphere(s);
  const double ratio2 = s.radius2 / s.shortest2();
  return std::isnan(ratio2) ? HUGE_VAL : ratio2;
}

// An entry with another ratio than its tetrahedron has is of a dead one with the same id.
TetId BadTetrahedra::next_by_ratio() {
  while (!heap_.empty()) {
    const auto [ratio2, t] = heap_.front();
    if (dt_.alive(t) && note(dt_, t, Note::waiting) != 0 && ratio2_of(t) == ratio2) return t;
    std::pop_heap(heap_.begin(), heap_.end());
    heap_.pop_back();
  }
  return kNone;
}

TetId BadTetrahedra::next() {
  if (largest_ratio_first_) return next_by_ratio();
  constexpr std::size_t kAhead = 8;  // entries, of which nine in ten are dead
  for (; worst_ > 0; --worst_) {
    if (worst_ < sorted_) {
      sorted_ = worst_;
      sort_level(sorted_);
    }
    std::vector<TetId>& level = level_[worst_];
    while (!level.empty()) {
      const TetId t = level.back();
      if (level.size() > kAhead) dt_.prefetch(level[level.size() - 1 - kAhead]);
      if (dt_.alive(t) && note(dt_, t, Note::waiting) == worst_) return t;
      level.pop_back();
    }
  }
  return kNone;
}

// In a spatial order, without the dead.
void BadTetrahedra::sort_level(std::size_t n) {
  std::vector<TetId>& level = level_[n];
  std::vector<TetId> waiting;
  std::vector<Vec3> place;
  for (const TetId t : level) {
    if (!dt_.alive(t) || note(dt_, t, Note::waiting) != n) continue;
    waiting.push_back(t);
    place.push_back(points_.nearest(dt_.vertex(t, 0)));
  }
  std::vector<std::uint32_t> order(waiting.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  spatial_sort(order, place);
  level.clear();
  for (const std::uint32_t i : order) level.push_back(waiting[i]);
}

void BadTetrahedra::add_fresh(std::span<const TetId> created) {
  for (const TetId t : created) {
    std::uint8_t& waiting = note(dt_, t, Note::waiting);
    if (waiting == kFresh) continue;
    waiting = kFresh;
    fresh_.push_back(t);
  }
}

void BadTetrahedra::validate() const {
  std::vector<std::uint8_t> fresh(dt_.capacity(), 0);
  for (const TetId t : fresh_) {
    DELMESHER_CHECK(t < fresh.size() && fresh[t] == 0, "a tetrahedron is to be judged twice");
    fresh[t] = 1;
  }
  std::vector<std::uint8_t> found(dt_.capacity(), 0);
  for (std::size_t n = 0; n < level_.size(); ++n) {
    DELMESHER_CHECK(level_[n].empty() || (n > 0 && n <= worst_),
                    "a bad tetrahedron waits above the worst level");
    for (const TetId t : level_[n]) {
      DELMESHER_CHECK(t < found.size(), "a tetrahedron waits that does not exist");
      if (note(dt_, t, Note::waiting) == n) found[t] = 1;
    }
  }
  DELMESHER_CHECK(!largest_ratio_first_ || worst_ == 0, "a level has entries beside the heap");
  DELMESHER_CHECK(std::is_heap(heap_.begin(), heap_.end()), "the largest ratio is not in front");
  for (const Ranked& ranked : heap_) {
    DELMESHER_CHECK(ranked.t < found.size(), "a tetrahedron waits that does not exist");
    if (dt_.alive(ranked.t) && ratio2_of(ranked.t) == ranked.ratio2) found[ranked.t] = 1;
  }
  for (TetId t = 0; t < dt_.capacity(); ++t) {
    const std::uint8_t waiting = note(dt_, t, Note::waiting);
    DELMESHER_CHECK((waiting == kFresh) == (fresh[t] != 0),
                    "a fresh tetrahedron is not to be judged, or another one is");
    if (!dt_.alive(t) || waiting == 0 || waiting == kFresh) continue;
    DELMESHER_CHECK(found[t] != 0, "a bad tetrahedron waits at no level");
  }
}

}  // namespace delmesher::refine
