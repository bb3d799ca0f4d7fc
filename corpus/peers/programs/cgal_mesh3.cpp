// tetproof-cgal-mesh3 SWITCHES INPUT OUT.mesh STATS.json: CGAL's Mesh_3 on the surface with its
// sharp edges protected, as in the example mesh_polyhedral_domain_with_features of its manual. The
// manual leaves sizes to the user; here they are fractions of the diagonal of the bounding box.
// SWITCHES: "-" for its defaults, "raw" for no step of optimization.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_polyhedron_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/Polyhedral_mesh_domain_with_features_3.h>
#include <CGAL/make_mesh_3.h>
#include <CGAL/version.h>

#include <array>
#include <cmath>
#include <stdexcept>
#include <unordered_map>
#include <vector>

#include "corpus/peers/programs/adapter.h"
#include "corpus/peers/programs/cgal_polyhedron.h"

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Polyhedron = CGAL::Mesh_polyhedron_3<Kernel>::type;
using Domain = CGAL::Polyhedral_mesh_domain_with_features_3<Kernel>;
using Triangulation = CGAL::Mesh_triangulation_3<Domain, CGAL::Default, CGAL::Sequential_tag>::type;
using Complex = CGAL::Mesh_complex_3_in_triangulation_3<Triangulation, Domain::Corner_index,
                                                        Domain::Curve_index>;
using Criteria = CGAL::Mesh_criteria_3<Triangulation>;

// Fractions of the diagonal. Facets are, at their centres, a tenth of the peer's envelope
// (corpus/peers/peers.cpp) from the surface; the other sizes are in proportion as in the manual's
// example.
constexpr double kFacetDistance = 0.5e-3;
constexpr double kEdgeSize = 0.025;
constexpr double kFacetSize = 0.05;
constexpr double kCellSize = 0.05;

double diagonal_of(const Polyhedron& polyhedron) {
  CGAL::Bbox_3 box;
  for (auto p = polyhedron.points_begin(); p != polyhedron.points_end(); ++p) box += p->bbox();
  return std::hypot(box.xmax() - box.xmin(), box.ymax() - box.ymin(), box.zmax() - box.zmin());
}

Complex complex_in(const Polyhedron& polyhedron, bool optimize) {
  Domain domain(polyhedron);
  domain.detect_features();  // edges of at least 60 degrees, its default
  const double size = diagonal_of(polyhedron);
  namespace parameters = CGAL::parameters;
  const Criteria criteria(parameters::edge_size = kEdgeSize * size, parameters::facet_angle = 25,
                          parameters::facet_size = kFacetSize * size,
                          parameters::facet_distance = kFacetDistance * size,
                          parameters::cell_radius_edge_ratio = 3,
                          parameters::cell_size = kCellSize * size);
  // The surface bounds a solid, and so has the mesh to: without this its boundary may touch itself.
  const auto topology = parameters::manifold();
  if (optimize) return CGAL::make_mesh_3<Complex>(domain, criteria, topology);
  return CGAL::make_mesh_3<Complex>(domain, criteria, topology, parameters::no_perturb(),
                                    parameters::no_exude());
}

delmesher::TetMesh take(const Complex& complex) {
  delmesher::TetMesh taken;
  std::unordered_map<const void*, std::uint32_t> index;
  for (auto cell = complex.cells_in_complex_begin(); cell != complex.cells_in_complex_end();
       ++cell) {
    std::array<std::uint32_t, 4> corners;
    for (int i = 0; i < 4; ++i) {
      const auto vertex = cell->vertex(i);
      const auto [at, is_new] =
          index.try_emplace(&*vertex, static_cast<std::uint32_t>(taken.vertices.size()));
      if (is_new) {
        const auto& p = vertex->point();
        taken.vertices.push_back(
            {CGAL::to_double(p.x()), CGAL::to_double(p.y()), CGAL::to_double(p.z())});
      }
      corners[static_cast<std::size_t>(i)] = at->second;
    }
    taken.tetrahedra.push_back(corners);
  }
  taken.inside.assign(taken.tetrahedra.size(), 1);
  tetproof::adapter::orient(taken);
  return taken;
}

delmesher::TetMesh mesh(const delmesher::Surface& surface, bool raw) {
  delmesher::TetMesh taken = take(
      complex_in(tetproof::adapter::polyhedron_of<Polyhedron, Kernel::Point_3>(surface), !raw));
  if (taken.tetrahedra.empty()) throw std::runtime_error("no tetrahedron inside");
  return taken;
}

}  // namespace

int main(int argc, char** argv) {
  return tetproof::adapter::run({"tetproof-cgal-mesh3", "CGAL", CGAL_VERSION_STR, mesh}, argc,
                                argv);
}
