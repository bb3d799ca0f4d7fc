// Makes a failing input small: the smallest valid surface found on which a mesher still fails in
// the same way. Every trial runs in a supervised child, so crashes, hangs and memory are no
// obstacle.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "corpus/meshers.h"
#include "mesher/delmesher.h"

namespace tetproof {

// How a mesher failed on a surface, which must stay the same. Empty if it did not fail.
// "crash: SIGABRT: Assertion `x' failed", "timeout", "wrong-result: conformity", ...
// Numbers, which change with the input, are left out.
using Failure = std::string;

// Does a surface that is certified valid still fail in the wanted way?
using StillFails = std::function<bool(const delmesher::Surface&)>;

struct ShrinkLimits {
  std::uint64_t runs = 5000;  // of the mesher
  double seconds = 600;
};

struct ShrinkProgress {
  std::uint64_t runs = 0;
  std::function<void(const std::string& step, const delmesher::Surface&)> tell;
};

// The search alone. The result is valid and fails; it is `surface` itself if nothing smaller was
// found. Deterministic if `fails` is and time does not run out.
delmesher::Surface shrink(const delmesher::Surface& surface, const StillFails& fails,
                          const ShrinkLimits& limits, ShrinkProgress& progress);

struct Prober {
  Mesher mesher;
  std::filesystem::path supervisor, self;  // tetproof-supervise, tetproof
  std::filesystem::path folder;            // for the files of the runs
  Limits limits;
  bool verify = true;  // ask the oracles about meshes that are delivered

  Failure failure(const delmesher::Surface& surface) const;
};

}  // namespace tetproof
