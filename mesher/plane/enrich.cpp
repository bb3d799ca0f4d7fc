#include "mesher/plane/enrich.h"

#include <vector>

#include "mesher/base/check.h"
#include "mesher/plane/spatial_order.h"

namespace delmesher::plane {

void enrich(const InputGraph& graph, const Chamfered& chamfered, Triangulation& mesh,
            const PointStore& points, Control& control) {
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
