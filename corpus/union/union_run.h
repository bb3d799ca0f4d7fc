// What the union and the walls of a surface have in common: how a run begins, what it tells, how it
// ends.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>

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
  // The surface as a soup.
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
    return true;
  }
  // What comes of the steps, or that they were stopped.
  template <class Steps>
  UnionResult result_of(Steps&& steps) {
    try {
      poll_();
      steps();
    } catch (const Stopped&) {
      fail(UnionCode::stopped, "interrupted");
    }
    return std::move(result_);
  }

  Poll poll_;
  Soup soup_;
  UnionResult result_;
};

}  // namespace tetproof::unite
