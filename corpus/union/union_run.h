// What the union and the walls of a surface have in common: how a run begins, in which units, what
// it tells, how it ends.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "corpus/union/poll.h"
#include "corpus/union/soup.h"
#include "corpus/union/unite.h"
#include "corpus/union/words.h"

namespace tetproof::unite {

class UnionRun {
 protected:
  explicit UnionRun(const std::function<bool()>& go_on) : poll_(go_on) {}

  // False, so that a step can return it.
  bool fail(UnionCode code, std::string message) {
    result_.code = code;
    result_.message = std::move(message);
    return false;
  }
  void tell(std::uint64_t count, const char* one, const char* many) {
    if (count > 0) result_.done.push_back(counted(count, one, many));
  }
  // As they are given; all others are in units.
  std::string length(double x) const { return number(std::ldexp(x, unit_)); }
  std::string volume_as_given(double x) const { return number(std::ldexp(x, 3 * unit_)); }
  std::string place(Position p) const {
    scale(p, unit_);
    return unite::place(p);
  }

  // The surface as a soup, in units.
  bool take_soup(const delmesher::Surface& surface) {
    if (const std::string defect = defect_of_lists(surface); !defect.empty()) {
      return fail(UnionCode::unsound, defect);
    }
    soup_ = soup_of(surface);
    UnionCounts& counts = result_.counts;
    counts.welded = soup_.welded;
    counts.degenerate = soup_.degenerate;
    tell(counts.welded, "vertex welded to another at the same place",
         "vertices welded to others at the same place");
    tell(counts.degenerate, "triangle without area removed", "triangles without area removed");
    return enter_units();
  }
  // What comes of the steps, or that they were stopped.
  template <class Steps>
  UnionResult result_of(Steps&& steps) {
    try {
      poll_();
      steps();
      return_to_given_units();
    } catch (const Stopped&) {
      fail(UnionCode::stopped, "interrupted");
    }
    return std::move(result_);
  }

  Poll poll_;
  Soup soup_;
  UnionResult result_;
  int unit_ = 0;  // 2^unit_ as given

 private:
  static void scale(Position& p, int exponent) {
    for (double& x : p) x = std::ldexp(x, exponent);
  }
  // False if that is not exact.
  static bool scale(std::vector<Position>& vertices, int exponent) {
    bool exact = true;
    for (Position& p : vertices) {
      const Position before = p;
      scale(p, exponent);
      Position back = p;
      scale(back, -exponent);
      exact = exact && back == before;
    }
    return exact;
  }
  // Of coordinates of ordinary size, no power that is formed comes near the ends of doubles.
  bool enter_units() {
    constexpr int kOrdinary = 64;
    const int exponent = soup_.vertices.empty() ? 0 : std::ilogb(largest_coordinate(soup_));
    if (std::abs(exponent) <= kOrdinary) return true;
    unit_ = exponent;
    return scale(soup_.vertices, -unit_) || fail_out_of_range();
  }
  void return_to_given_units() {
    if (unit_ == 0) return;
    UnionCounts& counts = result_.counts;
    for (double* length : {&counts.largest_move, &counts.largest_separation}) {
      *length = std::ldexp(*length, unit_);
    }
    for (double* volume : {&counts.volume_before, &counts.volume_after}) {
      *volume = std::ldexp(*volume, 3 * unit_);
    }
    if (!scale(result_.surface.vertices, unit_)) fail_out_of_range();
  }
  bool fail_out_of_range() {
    return fail(UnionCode::out_of_range,
                "some coordinates are too small for doubles beside the others: scale the surface, "
                "or move it");
  }
};

}  // namespace tetproof::unite
