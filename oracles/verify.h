// All oracles on one mesh, and the verdict.
#pragma once

#include <string>

#include "mesher/delmesher.h"
#include "oracles/files/mesh_file.h"
#include "oracles/files/polyhedron.h"
#include "oracles/verdict/verdict.h"

namespace tetproof::oracles {

// Empty on success, else why the input bounds no solid; the report is empty then.
std::string verify(const Polyhedron& input, const MeshFile& mesh,
                   const delmesher::ExactRecord* exact, const VerifyOptions& options,
                   VerifyReport& report);

// The same for a mesh and a record that the caller does not need any more: each part of them is
// given up as soon as no oracle needs it, for less memory. `exact` may be null.
std::string verify_and_discard(const Polyhedron& input, MeshFile& mesh,
                               delmesher::ExactRecord* exact, const VerifyOptions& options,
                               VerifyReport& report);

}  // namespace tetproof::oracles
