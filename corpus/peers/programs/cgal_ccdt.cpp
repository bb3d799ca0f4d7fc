// tetproof-cgal-ccdt SWITCHES INPUT OUT.mesh STATS.json: the conforming constrained Delaunay
// triangulation of CGAL 6.1 and later, as in the first example of its manual. It fills the convex
// hull; a path from outside tells by the constrained facets it crosses what is inside.
// SWITCHES: "-"; it has no step of optimization.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/make_conforming_constrained_Delaunay_triangulation_3.h>
#include <CGAL/version.h>

#include <array>
#include <stdexcept>
#include <unordered_map>
#include <vector>

#include "corpus/peers/programs/adapter.h"
#include "corpus/peers/programs/cgal_polyhedron.h"

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Polyhedron = CGAL::Surface_mesh<Kernel::Point_3>;

// How many constrained facets lie between a cell and what is outside: even without, odd within.
template <class Constrained, class Triangulation>
std::unordered_map<const void*, bool> sides_of(const Constrained& constrained,
                                               const Triangulation& cells) {
  std::unordered_map<const void*, bool> inside;
  std::vector<typename Triangulation::Cell_handle> open = {cells.infinite_cell()};
  inside[&*open.back()] = false;
  while (!open.empty()) {
    const auto cell = open.back();
    open.pop_back();
    const bool here = inside.at(&*cell);
    for (int i = 0; i < 4; ++i) {
      const auto next = cell->neighbor(i);
      const bool there = constrained.is_facet_constrained(cell, i) ? !here : here;
      if (inside.try_emplace(&*next, there).second) open.push_back(next);
    }
  }
  return inside;
}

delmesher::TetMesh mesh(const delmesher::Surface& surface, bool raw) {
  if (raw) throw std::runtime_error("there is nothing that could be left out");
  const Polyhedron polyhedron =
      tetproof::adapter::polyhedron_of<Polyhedron, Kernel::Point_3>(surface);
  const auto constrained = CGAL::make_conforming_constrained_Delaunay_triangulation_3(polyhedron);
  const auto& cells = constrained.triangulation();
  const auto inside = sides_of(constrained, cells);
  delmesher::TetMesh taken;
  std::unordered_map<const void*, std::uint32_t> index;
  for (const auto vertex : cells.finite_vertex_handles()) {
    const auto& p = vertex->point();
    index[&*vertex] = static_cast<std::uint32_t>(taken.vertices.size());
    taken.vertices.push_back({p.x(), p.y(), p.z()});
  }
  for (const auto cell : cells.finite_cell_handles()) {
    std::array<std::uint32_t, 4> corners;
    for (int i = 0; i < 4; ++i) corners[static_cast<std::size_t>(i)] = index.at(&*cell->vertex(i));
    taken.tetrahedra.push_back(corners);
    taken.inside.push_back(inside.at(&*cell) ? 1 : 0);
  }
  if (taken.tetrahedra.empty()) throw std::runtime_error("no tetrahedra");
  tetproof::adapter::orient(taken);
  return taken;
}

}  // namespace

int main(int argc, char** argv) {
  return tetproof::adapter::run({"tetproof-cgal-ccdt", "CGAL", CGAL_VERSION_STR, mesh}, argc, argv);
}
