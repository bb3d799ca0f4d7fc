// A triangulation as written, against its input: on doubles, decided exactly.
#pragma once

#include "oracles/plane/file.h"
#include "oracles/plane/graph.h"
#include "oracles/verdict/promise.h"
#include "oracles/verdict/report.h"

namespace tetproof::oracles {

// Adds to the report:
// - complex: indices in range, corners distinct, no directed edge twice, every vertex used;
// - orientation: every triangle is counter-clockwise;
// - conformity: every piece of a segment is a chain of edges (of those listed, if the file lists
//   them), or the triangles do not meet it, and the inside does not end there. The chain's vertices
//   are at most 4 ulp of the input's largest coordinate and 9 ulp of their own coordinates off the
//   piece, or at most `declared` (input units) if that is given. The triangles are bounded by such
//   chains, or by the outer rectangle where the hull was promised. Triangles beside each other are
//   on the same side but across chains. Input vertices are vertices;
// - sides: triangles are inside or outside as rays say, or the faces of the input (plane_faces.h),
//   each piece where the inside ends is between an inside and an outside, any other one between two
//   triangles or none, and no hole is covered; triangles have the attributes of their regions, if
//   the format has any;
// - edge-list: the edges listed are those chains, each with the marker of its segment;
// - edges: none is above --max-edge; else undecided, with a record named in the first line;
// - angles: for information.
// Where corners were not to be restored (--approximate): only complex, orientation and angles; the
// rest is undecided unless there is a record (`recorded`). `deviation` gets the largest distance of
// a chain's vertex from its segment, in input units.
void check_plane_file(PlaneGraph& graph, const PlaneFile& file, const Promise& promise,
                      double declared, bool recorded, VerifyReport& report, double& deviation);

}  // namespace tetproof::oracles
