// Long loops ask now and then whether to go on.
#pragma once

#include <functional>
#include <utility>

namespace tetproof::unite {

struct Stopped {};

class Poll {
 public:
  explicit Poll(std::function<bool()> go_on) : go_on_(std::move(go_on)) {}
  // Throws Stopped where the answer is no.
  void operator()() {
    constexpr unsigned kEvery = 256;
    if (calls_++ % kEvery == 0 && go_on_ && !go_on_()) throw Stopped();
  }

 private:
  std::function<bool()> go_on_;
  unsigned calls_ = 0;
};

}  // namespace tetproof::unite
