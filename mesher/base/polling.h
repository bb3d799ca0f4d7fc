// Whether a reader goes on: the limits and signals of its caller, asked now and then.
#pragma once

#include <cstdint>
#include <functional>
#include <utility>

#include "mesher/base/namespaces.h"

namespace delmesher::base {

// Thrown out of a reader that is to stop; caught where files are opened.
struct ReadingStopped {};

class Polling {
 public:
  // `go_on` may be empty: then nothing stops.
  explicit Polling(std::function<bool()> go_on = {}) : go_on_(std::move(go_on)) {}

  // To be called in every long loop; `steps` is the work since the last call, a few nanoseconds
  // each. Throws ReadingStopped when the caller does not want more.
  void poll(std::uint64_t steps = 1) {
    steps_ += steps;
    if (steps_ < kStepsPerQuestion) return;
    steps_ = 0;
    if (go_on_ && !go_on_()) throw ReadingStopped();
  }

 private:
  static constexpr std::uint64_t kStepsPerQuestion = std::uint64_t{1} << 14;
  std::function<bool()> go_on_;
  std::uint64_t steps_ = 0;
};

}  // namespace delmesher::base
