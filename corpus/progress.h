// What the user sees of a campaign: one live line on a terminal, a line per run in a pipe.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

#include "reports/results.h"

namespace tetproof {

class Progress {
 public:
  Progress(std::size_t total, bool terminal) : total_(total), terminal_(terminal) {}

  void already_done(const RunRow& row) {
    ++finished_, ++present_;
    ok_ += row.disposition == Disposition::ok;
  }
  void done(const RunRow& row);
  void running(const std::string& what);
  void finish();

 private:
  std::string eta() const;

  std::size_t total_, finished_ = 0, present_ = 0, ok_ = 0;
  bool terminal_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace tetproof
