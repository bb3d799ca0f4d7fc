// What a mesh must satisfy, and the verdict from the reports of all oracles.
#pragma once

#include <functional>
#include <string>

#include "oracles/verdict/promise.h"
#include "oracles/verdict/report.h"

namespace tetproof::oracles {

// The stage that is checked. A mesh file alone holds one of the two stages; a sidecar has both.
enum class Stage : std::uint8_t { refined, final, both };

struct VerifyOptions {
  Stage stage = Stage::final;
  // The options that the mesher was asked for. The record is held to them. The refined stage of a
  // file alone takes delta and region from them.
  Promise promised = {};
  // The version of the sidecar that the record was read from.
  unsigned record_version = kRecordVersion;
  // The path of that sidecar, for the kernel that reads its text once more; empty: there is only
  // the record.
  std::string sidecar = {};
  // The largest deviation that is not a failure, as a fraction of the diagonal; beyond 4 ulp the
  // verdict says "deviating" in any case.
  double declared_deviation = 0;
  // Threads that share the oracles; the report is the same for every number. 0: one per core.
  unsigned threads = 1;
  // Called with the report of every oracle as soon as there is one; by any of the threads, but
  // never by two at a time.
  std::function<void(const OracleReport&)> progress = nullptr;
};

// Every promise is checked, whether the record has its sections or not. A file alone is taken for a
// final mesh unless the promise says otherwise.
Stage stage_of(const Promise& promised, bool recorded);

// A deviation of so many ulp is that of rounding.
inline constexpr double kRoundedUlps = 4;

// Sets the verdict, and the deviation as a share of the diagonal; 0 stands for unknown.
void conclude(double diagonal, VerifyReport& report);

// A verification fails if the mesh is broken or deviates more than declared.
bool failed(const VerifyReport& report, const VerifyOptions& options);

}  // namespace tetproof::oracles
