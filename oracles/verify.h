// All oracles on one mesh, and the verdict.
#pragma once

#include <string>

#include "mesher/delmesher.h"
#include "oracles/conformity.h"
#include "oracles/input_surface.h"
#include "oracles/measures.h"
#include "oracles/mesh_file.h"
#include "oracles/report.h"

namespace tetproof::oracles {

enum class Stage : std::uint8_t { refined, final };

struct VerifyOptions {
  Stage stage = Stage::final;
  double delta = 14.47;  // refined stage
  AngleScope scope = AngleScope::solid;
  // Largest deviation that is no failure, as a fraction of the diagonal; beyond 4 ulp the verdict
  // says "deviating" in any case.
  double declared_deviation = 0;
};

// Why the input bounds no solid, or null; the report is empty then.
std::string verify(const Polyhedron& input, const MeshFile& mesh,
                   const delmesher::ExactRecord* exact, const VerifyOptions& options,
                   VerifyReport& report);

// A verification fails if the mesh is broken or deviates more than declared.
bool failed(const VerifyReport& report, const VerifyOptions& options);

}  // namespace tetproof::oracles
