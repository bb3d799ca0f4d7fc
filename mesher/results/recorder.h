// Results of a run besides the mesh: statistics and, if asked for, the exact record and
// the chamfered surface. The driver calls it after each stage.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "mesher/cdt/cdt.h"
#include "mesher/chamfer/filter.h"
#include "mesher/delmesher.h"
#include "mesher/output/rounding.h"
#include "mesher/planar/planarized_surface.h"
#include "mesher/refine/refine.h"
#include "mesher/results/in_force.h"
#include "mesher/run/session.h"
#include "mesher/surface/validity.h"
#include "mesher/tetmesh/conforming_mesh.h"

namespace delmesher::results {

class Recorder {
 public:
  Recorder(const Session& session, Result& result) : session_(session), result_(result) {}

  RungCounts& ladder() { return result_.statistics.ladder; }
  std::vector<std::string>& warnings() { return result_.warnings; }
  void checked(const SurfaceReport& report);
  // Facets were made planar. The triangles recorded are oriented as in the input.
  void planar(const PlanarizedSurface& planarized, const ValidityResult& validity);
  void predicted(double tetrahedra) { result_.statistics.predicted_tetrahedra = tetrahedra; }
  void chamfered(const chamfer::ChamferResult& chamfered, const chamfer::FilterResult& filter,
                 const InForce& force);
  void refined(const chamfer::ChamferResult& chamfered, const refine::RefineResult& refined);
  // The mesh is that of the input alone, without the vertices of the refined one.
  void plain_taken() { result_.statistics.enriched = false; }
  void tetrahedrized(const cdt::CdtResult& cdt);
  // The same mesh after local operations.
  void improved(const ConformingMesh& mesh);
  // The same with the surface kept, but for `left` vertices on it.
  void kept(const ConformingMesh& mesh, std::uint64_t left);
  // Triangles that no region has.
  void left_out(std::uint64_t faces);
  // `vertices` in all were taken out again before rounding.
  void thinned(const ConformingMesh& mesh, std::uint64_t vertices);
  // Edges of the surface as given came back by local operations, except for `missing`.
  void put_back(std::uint64_t diagonals, std::uint64_t missing);
  // Points on edges that came back were taken out for fewer tetrahedra.
  void spared(std::uint64_t points) { result_.statistics.diagonals_spared = points; }
  void no_way_back() { result_.statistics.planar_given_up = true; }
  // The mesh itself, as written.
  void written(output::RoundingResult rounded);
  // Times and counters, however the run ended; without a mesh if it failed.
  void finish();

 private:
  // Warns of vertices of no triangle that are none of the mesh.
  void note_loose_points(const TetMesh& mesh);
  bool exact() const { return session_.options.want_exact; }

  const Session& session_;
  Result& result_;
};

}  // namespace delmesher::results
