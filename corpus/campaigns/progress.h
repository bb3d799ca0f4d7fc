// The progress of a campaign on the screen: one live line on a terminal, a line per run in a pipe,
// and a table by mesher at the end.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "reports/results.h"

namespace tetproof {

// The runs of one mesher, including those that were in the database already.
struct MesherCount {
  std::string mesher;
  std::array<std::size_t, kDispositionCount> counts{};  // by disposition
  double mesh_seconds = 0, verify_seconds = 0;          // wall time, summed over these runs

  std::size_t runs() const;
  void add(const RunRow& row);
};

// A header and a line per mesher: counts by disposition, seconds of meshing and of verifying.
// Always there: ok, unverified, wrong-result; the others where there are any.
std::string count_table(const std::vector<MesherCount>& meshers);

// "7.2 s", "3:05 min", "2:10 h".
std::string duration_text(double seconds);

// Estimates how long a campaign will go on. The remaining runs of a mesher take as long as its runs
// so far did on average, or as all runs did if it has none yet.
class RemainingTime {
 public:
  void expect(const std::string& mesher, std::size_t runs) { of_[mesher].left += runs; }
  void already_done(const std::string& mesher) { --of_[mesher].left; }
  void done(const std::string& mesher, double seconds);
  // Nothing before the first run has ended. \param jobs runs at a time
  std::optional<double> seconds(unsigned jobs) const;

 private:
  struct Runs {
    std::size_t left = 0, made = 0;
    double seconds = 0;
  };
  std::map<std::string, Runs> of_;
};

class Progress {
 public:
  // Every mesher gets `models` runs, of which `jobs` at a time.
  Progress(const std::vector<std::string>& meshers, std::size_t models, unsigned jobs,
           bool terminal);

  void already_done(const RunRow& row);
  // \param seconds of everything: meshing, measuring, verifying
  void done(const RunRow& row, double seconds);
  void running(const std::string& what);
  void finish();

 private:
  std::size_t total_, finished_ = 0, ok_ = 0, unverified_ = 0;
  unsigned jobs_;
  bool terminal_;
  RemainingTime remaining_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace tetproof
