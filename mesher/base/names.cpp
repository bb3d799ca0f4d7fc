// Names of the enumerators of the public header, and defaults.
#include "mesher/delmesher.h"

namespace delmesher {

const char* phase_name(Phase phase) {
  static constexpr const char* kNames[kPhaseCount] = {"read",     "check",    "filter", "chamfer",
                                                      "delaunay", "segments", "facets", "refine",
                                                      "enrich",   "classify", "round",  "write"};
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

// (Here, so that the command line does not need the mesher to know its defaults.)
Options plane_options() {
  Options options;
  options.delta = 20.7;
  return options;
}

const char* version() {
  return "0.1.0";
}

}  // namespace delmesher
