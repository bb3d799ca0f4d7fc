// What `delmesher improve` promises of a mesh from anywhere, decided on the mesh that was given and
// the one that was made of it.
#pragma once

#include <string>

#include "oracles/files/mesh_file.h"
#include "oracles/verdict/verdict.h"

namespace tetproof::oracles {

// The oracles, all of the mesh that was made:
//  - complex: as of any mesh; where the one given is not a manifold, it need not be one either;
//  - orientation: no tetrahedron is inverted, and no more are flat than were;
//  - kept-faces: the hull and the faces between regions are those given, to the last bit, with the
//    same region on either side, and so are listed triangles;
//  - boundary-list: the triangles listed are those given, turned as they were, with their
//    labels and facets;
//  - edge-nodes: as of any mesh;
//  - improvement: as check_improvement, in all regions. Delta is not bounded by what refinement
//    guarantees: no face angle below it may become worse.
// With the same walls between and around the same regions, tetrahedra that are positive fill what
// those given fill. Whether these overlap is not asked.
//
// Empty on success, else why the given mesh cannot be improved; the report is empty then.
// Only these options count: delta, the largest edge, the order of the elements, and the declared
// deviation (of nodes on edges).
std::string verify_improved(const MeshFile& given, const MeshFile& mesh,
                            const VerifyOptions& options, VerifyReport& report);

}  // namespace tetproof::oracles
