// Names of the enumerators of the public headers.
#include "mesher/delmesher/run.h"
#include "mesher/delmesher/surface_report.h"

namespace delmesher {

const char* phase_name(Phase phase) {
  static constexpr const char* kNames[kPhaseCount] = {
      "read",   "check",  "remesh", "filter",   "chamfer", "delaunay", "segments",
      "facets", "refine", "enrich", "classify", "improve", "round",    "write"};
  return kNames[static_cast<std::size_t>(phase)];
}

const char* defect_name(Defect::Kind kind) {
  static constexpr const char* kNames[] = {"non-finite coordinate",
                                           "vertex index out of range",
                                           "no triangles",
                                           "degenerate triangle",
                                           "open edge",
                                           "non-manifold edge",
                                           "non-manifold vertex",
                                           "inconsistent orientation",
                                           "duplicate triangle",
                                           "self-intersection"};
  return kNames[static_cast<std::size_t>(kind)];
}

}  // namespace delmesher
