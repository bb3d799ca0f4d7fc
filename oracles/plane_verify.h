// Exact checks of a mesh of the plane, of its record, and of the promises. Shares no code with the
// mesher: rationals decide, a plain floating-point bound only skips the obvious cases.
//
// plane_conformity.h describes the checks of the file. No claim of a PlaneRecord is believed:
// - promise: the present version, the sections that the promise needs, bounds as promised;
// - sidecar: the input vertices come first, unchanged; points on segments lie between their ends;
// - same-mesh: triangles, sides and listed edges of the file are, one to one, those of the last
//   mesh of the record;
// - rounding: every written vertex is within 4 ulp of the largest coordinate from its exact place,
//   or within the declared deviation, input vertices are unmoved, and no point is written twice;
// - both meshes (exact-, refined-): complex (the border of the triangles is a rectangle around the
//   input, and they have its area), orientation (counter-clockwise triangles), delaunay (all edges
//   on no segment);
// - exact: segments are tiled completely; the sides agree with a flood; the vertices are those of
//   the input and of the refined mesh; the inside of a single ring has its area;
// - refined: edges on segments are parts of them; no edge of a triangle in the region is encroached
//   from there (open discs); the angle bound, and --max-edge; triangles are on the side that they
//   claim, and are mixed exactly if a segment crosses them; chamfers and drops as in
//   plane_chamfer.h.
#pragma once

#include <string>
#include <vector>

#include "mesher/delmesher_plane.h"
#include "oracles/plane_file.h"
#include "oracles/promise.h"
#include "oracles/report.h"

namespace tetproof {

struct PlaneVerifyOptions {
  oracles::Promise promised = {};
  unsigned record_version = 1;
  // The largest deviation that is no failure, as a fraction of the diagonal; 4 ulp in any case.
  double declared_deviation = 0;
};

// Empty on success, else why the input is no planar graph; the report is empty then.
std::string verify_plane(const delmesher::PlanarGraph& graph, const oracles::PlaneFile& file,
                         const delmesher::PlaneRecord* record, const PlaneVerifyOptions& options,
                         oracles::VerifyReport& report);

struct PlaneVerdict {
  oracles::VerifyReport report;
  std::vector<std::string> failures;  // "oracle: finding", a few of each
  std::uint64_t checks = 0;           // elements that the oracles looked at
  bool ok() const { return failures.empty(); }
  std::string text() const;
};

// For a result of the library, with status ok and an exact record.
PlaneVerdict verify_plane(const delmesher::PlanarGraph& graph, const delmesher::Options& options,
                          const delmesher::PlaneResult& result);

}  // namespace tetproof
