#include "mesher/plane/enrich.h"

#include <algorithm>
#include <vector>

#include "mesher/base/check.h"
#include "mesher/plane/spatial_order.h"

namespace delmesher::plane {

namespace {

bool is_in_a_face(VertexId v, const InputGraph& graph, const std::vector<PieceId>& carrier) {
  return v >= graph.vertices + 4 && carrier[v] == kNone;
}

// The vertices of a Delaunay triangulation in a disc are connected, and one end of the part is at
// the border of its disc; nothing else of the graph is within it.
void drop_encroaching(const Gap& gap, const InputGraph& graph, const std::vector<PieceId>& carrier,
                      Triangulation& mesh, PlanePredicates& predicates) {
  std::vector<VertexId> next = {gap.b}, dropped;
  std::vector<EdgeId> spokes;
  while (!next.empty()) {
    const VertexId v = next.back();
    next.pop_back();
    mesh.star(v, spokes);
    for (const EdgeId e : spokes) {
      const VertexId u = mesh.origin(e);
      if (!is_in_a_face(u, graph, carrier) || predicates.dot(gap.a, u, gap.b) >= 0) continue;
      if (std::find(dropped.begin(), dropped.end(), u) != dropped.end()) continue;
      dropped.push_back(u);
      next.push_back(u);
    }
  }
  for (const VertexId v : dropped) mesh.remove(v);
}

}  // namespace

void enrich(const InputGraph& graph, const Chamfered& chamfered,
            const std::vector<PieceId>& carrier, bool keep_points, Triangulation& mesh,
            const PointStore& points, PlanePredicates& predicates, Control& control) {
  for (const Gap& gap : chamfered.gaps) {
    if (keep_points || gap.b < graph.vertices) continue;
    control.poll(points.size());
    drop_encroaching(gap, graph, carrier, mesh, predicates);
  }
  std::vector<VertexId> missing, near(graph.vertices, kNone);
  for (VertexId v = 0; v < graph.vertices; ++v) {
    if (!mesh.has_vertex(v)) missing.push_back(v);
  }
  for (const Gap& gap : chamfered.gaps) {
    if (gap.b >= graph.vertices) near[gap.a] = gap.b;  // a cut point
  }
  arrange_in_rounds(missing);
  TriangleId hint = mesh.around(graph.vertices);
  for (const VertexId v : missing) {
    control.poll(points.size());
    const VertexId there = mesh.insert(v, near[v] != kNone ? mesh.around(near[v]) : hint);
    if (there != v) {
      DELMESHER_CHECK(there >= graph.vertices + 4, "two vertices of a valid graph coincide");
      mesh.rename(there, v);  // a Steiner point happens to be there
    }
    hint = mesh.around(v);
  }
  std::vector<VertexId> chain;
  for (const Gap& gap : chamfered.gaps) {
    control.poll(points.size());
    const auto obstacle = mesh.insert_segment(gap.a, gap.b, gap.piece, chain);
    DELMESHER_CHECK(obstacle.kind == Triangulation::Obstacle::Kind::none,
                    "a segment of a valid graph meets another one");
  }
}

}  // namespace delmesher::plane
