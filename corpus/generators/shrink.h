// Makes a failing input small: the smallest valid surface found on which a mesher still fails in
// the same way. Every trial runs in a supervised child, so crashes, hangs and memory are no
// obstacle.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "corpus/peers/meshers.h"
#include "mesher/delmesher.h"

namespace tetproof {

// How a mesher failed on a surface, which must stay the same. Empty if it did not fail.
// "crash: SIGABRT: Assertion `x' failed", "timeout", "wrong-result: conformity", ...
// Numbers, which change with the input, are left out.
using Failure = std::string;

// Which of some surfaces, all certified valid, still fails in the wanted way; nothing if none does.
// They may be run side by side: then the answer is the one that is known first, and the others are
// given up.
using OneThatFails =
    std::function<std::optional<std::size_t>(const std::vector<delmesher::Surface>&)>;

struct ShrinkLimits {
  std::uint64_t runs = 5000;  // of the mesher
  double seconds = 600;
  std::size_t at_once = 1;  // surfaces to be judged together
  // Asked between trials: true ends the search with what it has found.
  std::function<bool()> stop = [] { return false; };
};

struct ShrinkProgress {
  std::uint64_t runs = 0;
  std::function<void(const std::string& step, const delmesher::Surface&)> tell;
};

// The search alone. The result is valid and fails; it is `surface` itself if nothing smaller was
// found. Deterministic if `fails` is and time does not run out. What takes most away is tried
// first, and a step that misses several times in a row gives way to the next.
delmesher::Surface shrink(const delmesher::Surface& surface, const OneThatFails& fails,
                          const ShrinkLimits& limits, ShrinkProgress& progress);

struct Probe {
  Failure failure;
  double cpu_seconds = 0;  // of the mesher
};

struct Prober {
  Mesher mesher;
  std::filesystem::path supervisor, self;  // tetproof-supervise, tetproof
  std::filesystem::path folder;            // for the files of the runs
  Limits limits;
  bool verify = true;  // ask the oracles about meshes that are delivered
  // Asked during a run: true gives it up.
  std::function<bool()> stop = [] { return false; };

  // Ends early, with any failure, once `given_up` is set.
  Probe probe(const delmesher::Surface& surface, const std::atomic<bool>& given_up) const;
  Probe probe(const delmesher::Surface& surface) const;
};

// Judges surfaces side by side, each in a process and a folder of its own. The limit of processor
// time follows the current case: what takes much longer than the last surface that failed in the
// wanted way is ended, and counts as one that does not fail so. A failure that is a limit keeps it.
class SideBySide {
 public:
  // `first` is the probe of the surface that the search begins with.
  SideBySide(const Prober& prober, const Probe& first);

  std::optional<std::size_t> operator()(const std::vector<delmesher::Surface>& surfaces);
  double cpu_limit() const { return limits_.cpu_seconds; }

 private:
  void follow(double cpu_seconds);

  Prober prober_;
  Failure wanted_;
  Limits limits_;
};

}  // namespace tetproof
