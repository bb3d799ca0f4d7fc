// All oracles on one mesh, and the verdict.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "mesher/delmesher.h"
#include "oracles/angles.h"
#include "oracles/conformity.h"
#include "oracles/input_surface.h"
#include "oracles/measures.h"
#include "oracles/mesh_file.h"
#include "oracles/promise.h"
#include "oracles/report.h"

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
  // The largest deviation that is no failure, as a fraction of the diagonal; beyond 4 ulp the
  // verdict says "deviating" in any case.
  double declared_deviation = 0;
  // Threads that share the oracles; the report is the same for every number. 0: one per core.
  unsigned threads = 1;
  // Called with the report of every oracle as soon as there is one; by any of the threads, but
  // never by two at a time.
  std::function<void(const OracleReport&)> progress = nullptr;
};

// Empty on success, else why the input bounds no solid; the report is empty then.
std::string verify(const Polyhedron& input, const MeshFile& mesh,
                   const delmesher::ExactRecord* exact, const VerifyOptions& options,
                   VerifyReport& report);

// The same for a mesh and a record that the caller does not need any more: each part of them is
// given up as soon as no oracle needs it, for less memory. `exact` may be null.
std::string verify_and_discard(const Polyhedron& input, MeshFile& mesh,
                               delmesher::ExactRecord* exact, const VerifyOptions& options,
                               VerifyReport& report);

// A verification fails if the mesh is broken or deviates more than declared.
bool failed(const VerifyReport& report, const VerifyOptions& options);

}  // namespace tetproof::oracles
