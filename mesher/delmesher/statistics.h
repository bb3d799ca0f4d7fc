// Sizes, angles, times and counters of a run.
#pragma once

#include <array>
#include <cstdint>

#include "ladder.h"
#include "run.h"

namespace delmesher {

// Size, angles in degrees and shapes of a mesh; angles and shapes over the tetrahedra that
// Options::region covers.
struct MeshStatistics {
  std::uint64_t vertices = 0, tetrahedra = 0, interior_tetrahedra = 0;
  double min_face_angle = 0, max_face_angle = 0, min_dihedral = 0, max_dihedral = 0;
  double mean_min_face_angle = 0, mean_max_face_angle = 0;  // per face
  double mean_min_dihedral = 0, mean_max_dihedral = 0;      // per tetrahedron
  std::array<std::uint64_t, 12> face_angle_histogram{};     // 15-degree bins
  std::array<std::uint64_t, 12> dihedral_histogram{};
  // Of the smallest dihedral angle of each tetrahedron: how many are below 5 and 10 degrees, and
  // the 1 % quantile.
  std::uint64_t below_5 = 0, below_10 = 0;
  double dihedral_1_percent = 0;
  // Gamma is 3 times the inscribed sphere's radius over the circumsphere's. SICN is Gmsh's signed
  // inverse condition number, negative for inverted tetrahedra. Both are 1 for regular ones.
  double min_gamma = 0, mean_gamma = 0, gamma_1_percent = 0, min_sicn = 0, mean_sicn = 0;
  // Where the smallest angles are, as vertices of the mesh: the edge of the dihedral angle with the
  // two other vertices of the tetrahedron, and the corner of the face angle with the two others.
  std::array<std::uint32_t, 4> sharpest_dihedral{};
  std::array<std::uint32_t, 3> sharpest_face_angle{};
};

struct Statistics {
  std::array<double, kPhaseCount> phase_seconds{};
  double bbox_diagonal = 0;
  // Options::size, if it was chosen, and the tetrahedra without; else 0.
  double chosen_size = 0;
  std::uint64_t tetrahedra_without_size = 0;
  // With Options::tolerance: the length, and the triangles of the surface that was meshed.
  double tolerance = 0;
  std::uint64_t remeshed_triangles = 0;
  MeshStatistics refined, final;
  std::uint64_t facets = 0;  // of the surface that was meshed
  // Facets that were made planar, of more than one triangle each; and facets of the surface as
  // given, if there are such.
  std::uint64_t planar_groups = 0, given_facets = 0;
  // Where facets were made planar, in input units: the largest distance of a vertex as given from
  // the plane of a facet, and the bound on it.
  double planar_deviation = 0, planar_bound = 0;
  // With a tolerance: lines, as Options::feature has them, that are within planar facets.
  std::uint64_t lines_lost = 0;
  // With Options::planar 0 the facets are planar only while they are refined: edges of the surface
  // as given within them, which come back afterwards; how many found no place; and whether for
  // that, or because the mesh did not fit the surface as given, it was meshed anew without planar
  // facets.
  std::uint64_t diagonals = 0, diagonals_missing = 0;
  std::uint64_t diagonals_spared = 0;  // points on them that went for fewer tetrahedra
  bool planar_given_up = false;
  // Where planar facets left the mesh with inverted or flat tetrahedra: the limit that ended a run
  // that kept the surface as given, which might have had none. Vertices, most of the time: there it
  // needs more of them.
  Limit planar_limit = Limit::none;
  // With SurfaceChoice::keep: vertices on the surface that are not of the input.
  std::uint64_t left_on_surface = 0;
  double predicted_tetrahedra = 0;  // of the final mesh, in the region, before refinement
  double tau = 0;                   // in force
  std::uint64_t dropped_triangles = 0, filter_rounds = 0;
  std::uint64_t acute_vertices = 0, acute_edges = 0;
  double guaranteed_acute = 0;   // threshold in force
  double guaranteed_corner = 0;  // the same for the angle of two edges
  bool gabriel = false;          // the constraints of the refined mesh have empty balls
  RungCounts ladder;             // in all runs
  // Limits that the mesher set itself: whether the treatment of slivers, or of angles above the
  // guaranteed bound, was ended by its cap on insertions; and how often the constrained
  // tetrahedrization began anew.
  bool refinement_capped = false;
  std::uint64_t cdt_restarts = 0;
  std::uint64_t steiner_on_segments = 0, steiner_on_facets = 0, steiner_in_volume = 0;
  // Does the final mesh have points of the refined one? No if the mesh of the input alone is
  // better.
  bool enriched = true;
  std::uint64_t rounding_inverted = 0, rounding_flat = 0, rounding_repaired = 0;
  // Local operations that took a tetrahedron for positive which is positive as written, but not on
  // exact coordinates: nothing else was left to repair the written mesh.
  std::uint64_t rounding_inexact = 0;
  // Points of the last step taken out again where doubles are too coarse for them.
  std::uint64_t rounding_thinned = 0;
  // Signs of tetrahedra in doubles that rounding and its repairs decided: their work.
  std::uint64_t rounding_signs = 0;
  double max_surface_deviation = 0;  // input units
  // Signs of predicates by what decided them: doubles, double-doubles, integers of a few words,
  // integers of any size, a plane or line that all points share; and ties that were broken.
  std::uint64_t predicate_filter = 0, predicate_extended = 0, predicate_fixed = 0;
  std::uint64_t predicate_exact = 0, predicate_by_support = 0, predicate_symbolic = 0;
};

}  // namespace delmesher
