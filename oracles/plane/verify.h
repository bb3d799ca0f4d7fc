// Exact checks of a mesh of the plane, of its record, and of the promises. Shares no code with the
// mesher: rationals decide, a plain floating-point bound only skips the obvious cases.
//
// plane_conformity.h describes the checks of the file. No claim of a PlaneRecord is believed; the
// rooms of its checks say their laws:
// - plane_record.h: the bounds and sections that were promised, the exact points, and that the file
//   holds the last mesh of the record (promise, sidecar, same-mesh, rounding);
// - plane_complex.h: both meshes are triangulations (complex, orientation, delaunay; exact-,
//   refined-);
// - plane_final.h: the final mesh is one of the input (exact-conformity, exact-sides, exact-area,
//   enrichment);
// - plane_refined.h: the refined mesh keeps its promises (segments, angles, encroachment, edges,
//   sides), and plane_chamfer.h: it lacks of the input what it may.
#pragma once

#include <string>
#include <vector>

#include "mesher/delmesher_plane.h"
#include "oracles/plane/file.h"
#include "oracles/verdict/promise.h"
#include "oracles/verdict/report.h"

namespace tetproof {

struct PlaneVerifyOptions {
  oracles::Promise promised = {};
  unsigned record_version = 1;
  // The largest deviation that is not a failure, as a fraction of the diagonal; 4 ulp in any case.
  double declared_deviation = 0;
};

// Empty on success, else why the input is not a planar graph; the report is empty then.
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
PlaneVerdict verify_plane(const delmesher::PlanarGraph& graph,
                          const delmesher::PlaneOptions& options,
                          const delmesher::PlaneResult& result);

}  // namespace tetproof
