// Numbers of elements that wait to be split, each once, in the order in which they came.
//
// Invariant: a number is in the queue, once, if and only if waits() says so.
#pragma once

#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "mesher/base/check.h"
#include "mesher/base/ids.h"
#include "mesher/base/namespaces.h"

namespace delmesher::refine {

class WorkQueue {
 public:
  bool empty() const { return queue_.empty(); }
  bool waits(std::uint32_t n) const { return n < waits_.size() && waits_[n] != 0; }

  // Puts n at the end, unless it waits already.
  void add(std::uint32_t n) {
    if (waits(n)) return;
    if (n >= waits_.size()) waits_.resize(std::size_t{n} + 1, 0);
    waits_[n] = 1;
    queue_.push_back(n);
  }
  // Takes the first one; kNone if none waits.
  std::uint32_t take() {
    if (queue_.empty()) return kNone;
    const std::uint32_t n = queue_.front();
    queue_.pop_front();
    waits_[n] = 0;
    return n;
  }

  // Every n becomes number[n], in the same order; where that is kNone, it waits no more.
  void renumber(std::span<const std::uint32_t> number) {
    std::deque<std::uint32_t> before;
    before.swap(queue_);
    waits_.clear();
    for (const std::uint32_t n : before) {
      if (number[n] != kNone) add(number[n]);
    }
  }

  // Throws InternalError if the invariant is broken, or if `size` or a larger number waits.
  void validate(std::size_t size) const {
    std::size_t waiting = 0;
    for (const std::uint8_t waits : waits_) waiting += waits;
    DELMESHER_CHECK(waiting == queue_.size(), "an element waits in no queue, or twice");
    for (const std::uint32_t n : queue_) {
      DELMESHER_CHECK(n < size && waits(n),
                      "an element in the queue does not exist, or is not marked as waiting");
    }
  }

 private:
  friend struct WorkQueueBreaker;  // of the tests of validate()

  std::deque<std::uint32_t> queue_;
  std::vector<std::uint8_t> waits_;  // by number, as far as any has waited
};

}  // namespace delmesher::refine
