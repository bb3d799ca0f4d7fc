#include "mesher/results/recorder.h"

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "mesher/output/statistics.h"
#include "mesher/results/record_stages.h"
#include "mesher/results/region_statistics.h"

namespace delmesher::results {
namespace {

// With rounded coordinates, for display, in the triangulation that the refinement gave it.
Surface chamfered_surface(const chamfer::ChamferResult& chamfered,
                          const refine::RefineResult& refined, const SurfaceTopology& topology,
                          const PointStore& points) {
  Surface surface;
  std::vector<std::uint32_t> number(points.size(), kNone);
  for (const refine::RefinedFace& face : refined.faces) {
    const FacetId facet = chamfered.plc.facets[face.facet].input_facet;
    if (facet == kNone) continue;
    std::array<std::uint32_t, 3> triangle;
    for (int k = 0; k < 3; ++k) {
      std::uint32_t& n = number[face.vertices[k]];
      if (n == kNone) {
        n = static_cast<std::uint32_t>(surface.vertices.size());
        surface.vertices.push_back(points.nearest(face.vertices[k]));
      }
      triangle[k] = n;
    }
    surface.triangles.push_back(triangle);
    surface.labels.push_back(topology.labels[topology.facet_triangles[facet][0]]);
  }
  return surface;
}

}  // namespace

void Recorder::checked(const SurfaceReport& report) {
  result_.warnings = report.warnings;
  result_.statistics.bbox_diagonal = report.bbox_diagonal;
}

void Recorder::planar(const PlanarizedSurface& planarized, const ValidityResult& validity) {
  Statistics& s = result_.statistics;
  s.facets = session_.surface.topology().facet_triangles.size();
  if (planarized.planes.empty()) return;
  s.planar_groups = planarized.groups;
  if (exact()) {
    auto& triangles = result_.exact.triangles = planarized.triangles;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      if (validity.reverse_triangle[t] != 0) std::swap(triangles[t][1], triangles[t][2]);
    }
  }
  s.given_facets = planarized.given_facets;
  s.planar_deviation = planarized.deviation;
  s.planar_bound = planarized.bound;
  s.lines_lost = planarized.lines_lost;
}

void Recorder::chamfered(const chamfer::ChamferResult& chamfered,
                         const chamfer::FilterResult& filter, const InForce& force) {
  Statistics& s = result_.statistics;
  s.tau = force.tau;
  s.dropped_triangles = filter.dropped_triangles;
  s.filter_rounds = filter.rounds;
  s.acute_vertices = chamfered.acute_vertices;
  s.acute_edges = chamfered.acute_edges;
  s.guaranteed_acute = force.acute;
  s.guaranteed_corner = force.corner;
  s.gabriel = force.gabriel;
  if (!exact()) return;
  ExactRecord& record = result_.exact;
  record_parameters(session_.options, force, session_.diagonal, result_.statistics.planar_bound,
                    record);
  record_facets(session_.surface.topology(), &filter, record);
  record_chamfer(chamfered, record);
}

void Recorder::refined(const chamfer::ChamferResult& chamfered,
                       const refine::RefineResult& refined) {
  Statistics& s = result_.statistics;
  s.steiner_on_segments = refined.on_segments;
  s.steiner_on_facets = refined.on_facets;
  s.refinement_capped = refined.capped;
  s.steiner_in_volume = refined.in_volume.size();
  s.refined =
      refined_statistics(refined, session_.points, session_.options.region, session_.control);
  if (exact()) record_refined(chamfered, refined, session_.surface.topology(), result_.exact);
  if (session_.options.want_chamfered) {
    result_.chamfered =
        chamfered_surface(chamfered, refined, session_.surface.topology(), session_.points);
  }
}

void Recorder::tetrahedrized(const cdt::CdtResult& cdt) {
  result_.statistics.steiner_on_segments += cdt.steiner.size();
  result_.statistics.cdt_restarts = cdt.counters.facet_restarts;
  if (!exact()) return;
  if (result_.exact.facets.empty())
    record_facets(session_.surface.topology(), nullptr, result_.exact);
  record_final(cdt.mesh, session_.surface.topology(), result_.exact);
}

void Recorder::improved(const ConformingMesh& mesh) {
  if (exact()) record_changed(mesh, session_.surface.topology(), result_.exact);
}

void Recorder::kept(const ConformingMesh& mesh, std::uint64_t left) {
  result_.statistics.left_on_surface = left;
  improved(mesh);
}

void Recorder::left_out(std::uint64_t faces) {
  if (faces == 0) return;
  result_.warnings.push_back(
      std::to_string(faces) +
      " triangles are left out: both of their sides are open to the outside");
}

void Recorder::thinned(const ConformingMesh& mesh, std::uint64_t vertices) {
  result_.statistics.rounding_thinned = vertices;
  if (exact()) record_changed(mesh, session_.surface.topology(), result_.exact);
}

void Recorder::put_back(std::uint64_t diagonals, std::uint64_t missing) {
  result_.statistics.diagonals = diagonals;
  result_.statistics.diagonals_missing = missing;
}

void Recorder::note_loose_points(const TetMesh& mesh) {
  std::map<Vec3, std::vector<VertexId>> loose;
  for (VertexId v = 0; v < session_.input_vertices(); ++v) {
    if (session_.surface.topology().vertex_half_edge[v] == kNone) {
      loose[session_.points.nearest(v)].push_back(v);
    }
  }
  if (loose.empty()) return;
  for (const Vec3& p : mesh.vertices) loose.erase(p);
  std::size_t count = 0;
  VertexId first = kNone;
  for (const auto& [place, vertices] : loose) {
    count += vertices.size();
    first = std::min(first, vertices.front());
  }
  if (count == 0) return;
  result_.warnings.push_back(
      std::to_string(count) + (count == 1 ? " point" : " points") +
      " left out: outside of the mesh, or on a triangle (the first is number " +
      std::to_string(first) + ", counted from 0)");
}

void Recorder::written(output::RoundingResult rounded) {
  Statistics& s = result_.statistics;
  s.rounding_inverted = rounded.inverted;
  s.rounding_flat = rounded.flat;
  s.rounding_repaired = rounded.repaired;
  s.rounding_inexact = rounded.inexact_operations;
  s.rounding_signs = rounded.signs;
  s.max_surface_deviation = rounded.max_surface_deviation;
  if (s.rounding_inexact > 0) {
    result_.warnings.push_back(
        "repairs of rounding that hold as written, but not on exact coordinates: " +
        std::to_string(s.rounding_inexact) + "; features there are a few roundings apart");
  }
  TetMesh& mesh = rounded.mesh;
  std::uint64_t interior = 0;
  for (const std::uint8_t inside : mesh.inside) interior += inside;
  s.final = output::mesh_statistics(mesh.vertices, mesh.tetrahedra, rounded.repeated_faces,
                                    mesh.vertices.size(), interior, session_.control);
  if (exact()) {
    if (rounded.operations > 0) {
      record_repaired(rounded, session_.options.region, result_.exact);
    }
    record_points(session_.points, session_.surface.planarized_vertices(),
                  session_.input_vertices(), rounded, result_.exact);
  }
  // A triangle may be as far on the other side of the plane of its facet as a vertex on this one.
  if (session_.surface.is_planarized()) mesh.planar_within = 2 * s.planar_bound / session_.diagonal;
  const SurfaceTopology& topology = session_.surface.topology();
  for (std::uint32_t& facet : mesh.boundary_facets) {
    facet = topology.facet_triangles[facet][0];
    mesh.boundary_labels.push_back(topology.labels[facet]);
  }
  note_loose_points(mesh);
  result_.mesh = std::move(mesh);
}

void Recorder::finish() {
  const PredicateCounters& c = session_.predicates.counters;
  Statistics& s = result_.statistics;
  s.phase_seconds = session_.control.phase_seconds();
  s.predicate_filter = c.filter;
  s.predicate_extended = c.extended;
  s.predicate_fixed = c.fixed;
  s.predicate_exact = c.exact;
  s.predicate_symbolic = c.symbolic;
  s.predicate_by_support = c.support;
  if (!result_.status.ok()) result_.mesh = {};
}

}  // namespace delmesher::results
