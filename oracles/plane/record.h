// The record of a run in the plane: what it claims to keep, its points, and that the file holds its
// last mesh. Nothing here looks at the meshes themselves.
#pragma once

#include "oracles/plane/complex.h"
#include "oracles/plane/file.h"

namespace tetproof::oracles {

// promise: the record is of the present version, has the sections that the promise needs, and its
// bounds are those promised, as the plane has no guard that would make them stricter.
OracleReport check_plane_promise(const delmesher::PlaneRecord& record, const Promise& promise,
                                 unsigned version);

// sidecar: the vertices of the input come first, unchanged; other points lie strictly between two
// of them; triangles, edges and written vertices refer to points; every other point is used.
// Returns whether all points could be read and all references are to points. All other checks of
// the record take that for granted.
bool read_plane_points(const PlaneGraph& input, const delmesher::PlaneRecord& record,
                       PlanePoints& exact, VerifyReport& report);

// same-mesh: triangles, sides and listed edges of the file are, one to one, those of the last mesh.
OracleReport check_plane_same_mesh(const RecordedPlane& recorded, const PlaneFile& file);

// rounding: every written vertex is within 4 ulp of the input's largest coordinate, or of its own
// if that is larger, from its exact place, or within `declared` (input units); vertices of the
// input are unmoved; no point is written twice. `deviation` gets the largest distance of a written
// vertex from its place, of those not beyond the input, in input units.
OracleReport check_plane_rounding(const RecordedPlane& recorded, const PlaneFile& file,
                                  double declared, double& deviation);

}  // namespace tetproof::oracles
