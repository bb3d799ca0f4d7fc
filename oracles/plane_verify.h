// Exact checks of a mesh of the plane, its record and what was promised. Shares no code with the
// mesher: rationals decide, a plain floating-point bound only skips what is obvious.
//
// Of the file: plane_conformity.h. Of a PlaneRecord, which is believed in nothing:
//  - promise: the present version, the sections that the promise needs, bounds as promised;
//  - sidecar: the input vertices come first, unchanged; points on segments lie between their ends;
//  - same-mesh: triangles, sides and listed edges of the file are, one to one, those of the last
//    mesh of the record; rounding: every written vertex is within 4 ulp of the largest coordinate
//    from its exact place, or within what was declared, and no point is written twice;
//  - both meshes (exact-, refined-): complex (counter-clockwise triangles whose border is a
//    rectangle around the input and that have its area), delaunay (edges without segment);
//  - exact: segments are tiled completely; the sides agree with a flood; all vertices of the input
//    and of the refined mesh are there; the area of the inside of a single ring;
//  - refined: edges on segments are parts of them; no edge of a triangle in the region is
//    encroached from there (open discs); the angle bound, and --max-edge; triangles lie where they
//    claim, and are mixed exactly if a segment crosses them; chamfers and drops as in
//    plane_chamfer.h.
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
  // Largest deviation that is no failure, as a fraction of the diagonal; 4 ulp in any case.
  double declared_deviation = 0;
};

// Why the input is no planar graph, or null; the report is empty then.
std::string verify_plane(const delmesher::PlanarGraph& graph, const oracles::PlaneFile& file,
                         const delmesher::PlaneRecord* record, const PlaneVerifyOptions& options,
                         oracles::VerifyReport& report);

struct PlaneVerdict {
  oracles::VerifyReport report;
  std::vector<std::string> failures;  // "oracle: finding", a few of each
  std::uint64_t checks = 0;           // what the oracles looked at
  bool ok() const { return failures.empty(); }
  std::string text() const;
};

// For a result with status ok and an exact record.
PlaneVerdict verify_plane(const delmesher::PlanarGraph& graph, const delmesher::Options& options,
                          const delmesher::PlaneResult& result);

}  // namespace tetproof
