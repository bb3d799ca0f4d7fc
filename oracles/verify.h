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

// Of a mesh file there is only what it holds; a sidecar has both.
enum class Stage : std::uint8_t { refined, final, both };

struct VerifyOptions {
  Stage stage = Stage::final;
  // What the mesher was asked for. The record is held to it; of a file alone, the refined stage
  // takes delta and region from it.
  Promise promised = {};
  // Of the sidecar that the record was read from.
  unsigned record_version = kRecordVersion;
  // That sidecar, for the kernel that reads its text once more; empty: there is only the record.
  std::string sidecar = {};
  // Largest deviation that is no failure, as a fraction of the diagonal; beyond 4 ulp the verdict
  // says "deviating" in any case.
  double declared_deviation = 0;
  // Threads that share the oracles; the report is the same for every number. 0: one per core.
  unsigned threads = 1;
  // Called with the report of every oracle as soon as it has one; with more threads by any of them,
  // but never by two at a time.
  std::function<void(const OracleReport&)> progress = nullptr;
};

// Why the input bounds no solid, or null; the report is empty then.
std::string verify(const Polyhedron& input, const MeshFile& mesh,
                   const delmesher::ExactRecord* exact, const VerifyOptions& options,
                   VerifyReport& report);

// A verification fails if the mesh is broken or deviates more than declared.
bool failed(const VerifyReport& report, const VerifyOptions& options);

}  // namespace tetproof::oracles
