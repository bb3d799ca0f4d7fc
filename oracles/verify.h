// All oracles on one mesh, and the verdict.
#pragma once

#include <string>

#include "mesher/delmesher.h"
#include "oracles/files/polyhedron.h"
#include "oracles/memory.h"
#include "oracles/verdict/verdict.h"

namespace tetproof::oracles {

// `exact` may be null. What is expendable is given up part by part, as soon as no oracle needs it,
// for less memory; it has to be this mesh and this record.
//
// With a promised tolerance the mesh is judged as envelope.h says, without a record.
//
// Empty on success, else why the input bounds no solid; the report is empty then.
std::string verify(const Polyhedron& input, const MeshFile& mesh,
                   const delmesher::ExactRecord* exact, const VerifyOptions& options,
                   VerifyReport& report, const Expendable& expendable = {});

// Where the elements that findings name are, by what was given.
void locate(const Polyhedron& input, const MeshFile& mesh, VerifyReport& report);

}  // namespace tetproof::oracles
