#include "mesher/cdt/validate.h"

#include <vector>

#include "mesher/base/check.h"

namespace delmesher::cdt {
namespace {

void validate_edges(Tetrahedrization& mesh, const Chains& chains) {
  for (std::uint32_t n = 0; n < chains.size(); ++n) {
    if (!chains.is_subsegment(n)) continue;
    DELMESHER_CHECK(find_edge(mesh, chains, chains.node(n).vertex, chains.next(n).vertex) != kNone,
                    "a subsegment is not an edge");
  }
}

}  // namespace

void validate_segments(Tetrahedrization& mesh, const Chains& chains) {
  mesh.validate(true);
  chains.validate(mesh.predicates());
  validate_edges(mesh, chains);
}

void validate_facets(Tetrahedrization& mesh, const Chains& chains,
                     std::span<const SurfaceFace> surface, std::span<const RegionId> region,
                     Partition partition) {
  mesh.validate(false);
  validate_edges(mesh, chains);
  std::vector<std::uint8_t> walls(mesh.capacity(), 0);  // bit i: face i is on the surface
  for (const SurfaceFace& triangle : surface) {
    const FaceHandle face = find_face(mesh, chains, triangle.vertices);
    DELMESHER_CHECK(face.exists(), "a triangle of a facet is not a face");
    DELMESHER_CHECK((walls[face.tet()] >> face.face() & 1) == 0,
                    "a triangle of a facet is there twice");
    for (const FaceHandle side : {face, mesh.across(face)}) {
      walls[side.tet()] |= static_cast<std::uint8_t>(1U << side.face());
    }
  }
  Predicates& predicates = mesh.predicates();
  const PredicateCounters counters = predicates.counters;
  for (TetId t = 0; t < mesh.capacity(); ++t) {
    if (!mesh.alive(t)) continue;
    const bool ghost = mesh.is_ghost(t);
    DELMESHER_CHECK(region[t] == kOutside ||
                        (!ghost && (region[t] == kInside || partition == Partition::regions)),
                    "a tetrahedron outside the hull is inside, or one of two sides is a third one");
    const VertexId* w = mesh.vertices(t);
    for (int i = 0; i < 4; ++i) {
      const TetId u = mesh.neighbor(t, i);
      const bool wall = (walls[t] >> i & 1) != 0;
      const bool changes = region[t] != region[u];
      DELMESHER_CHECK(changes == wall || (wall && partition == Partition::regions),
                      "regions change elsewhere than at a facet");
      if (wall || ghost || mesh.is_ghost(u)) continue;
      DELMESHER_CHECK(predicates.insphere_perturbed(w[0], w[1], w[2], w[3],
                                                    mesh.vertex(u, mesh.mirror(t, i))) < 0,
                      "a face that no facet hides is not locally Delaunay");
    }
  }
  predicates.counters = counters;
}

}  // namespace delmesher::cdt
