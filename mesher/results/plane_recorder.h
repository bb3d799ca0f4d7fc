// Results of a run in the plane besides the mesh: statistics, warnings and, if asked
// for, the exact record and the chamfered graph. The driver calls it after each stage.
#pragma once

#include <vector>

#include "mesher/delmesher_plane.h"
#include "mesher/plane/chamfer.h"
#include "mesher/plane/graph.h"
#include "mesher/plane/refine.h"
#include "mesher/plane/rounding.h"
#include "mesher/run/plane_session.h"

namespace delmesher::plane {

class Recorder {
 public:
  Recorder(const Session& session, PlaneResult& result) : session_(session), result_(result) {}

  void checked(const InputGraph& graph);
  // Once per attempt, however it ends.
  void chamfered(const Chamfered& chamfered);
  void refined(const InputGraph& graph, const Chamfered& chamfered, const Spared& spared,
               const RefinedMesh& refined);
  void enriched(const InputGraph& graph, const RefinedMesh& mesh);
  // The mesh itself, as written.
  void written(const InputGraph& graph, RoundedPlane rounded);
  // Times and counters, however the run ended; without a mesh if it failed.
  void finish();

 private:
  bool exact() const { return session_.options.want_exact; }
  void record_refined(const InputGraph& graph, const Chamfered& chamfered,
                      std::vector<std::uint32_t> dropped, const RefinedMesh& refined);

  const Session& session_;
  PlaneResult& result_;
};

}  // namespace delmesher::plane
