#include "mesher/plane/record.h"

#include "mesher/plane/rounding.h"

namespace delmesher::plane {

void record_points(const InputGraph& graph, const PointStore& points, PlaneRecord& record) {
  record.points.reserve(points.size());
  for (VertexId n = 0; n < points.size(); ++n) {
    const VertexId v = n < graph.vertices ? graph.id[n] : n;
    const PointDefinition d = points.definition(v);
    ExactPoint p;
    if (d.kind == PointKind::explicit_point) {
      const std::array<double, 2> x = in_input_units(graph, points, v);
      p.x = x[0];
      p.y = x[1];
    } else {
      p.kind = ExactPoint::Kind::on_segment;
      p.i = graph.number_of(d.corner[0]);
      p.j = graph.number_of(d.corner[1]);
      p.x = d.u;
    }
    record.points.push_back(p);
  }
}

void record_triangles(const InputGraph& graph, const Triangulation& mesh,
                      const std::vector<Side>& side, std::vector<PlaneRecord::Triangle>& triangles,
                      std::vector<PlaneRecord::Edge>& edges) {
  triangles.clear();
  edges.clear();
  for (TriangleId t = 0; t < mesh.size(); ++t) {
    const auto& [a, b, c] = mesh[t].vertex;
    triangles.push_back({{graph.number_of(a), graph.number_of(b), graph.number_of(c)}, side[t]});
    for (int i = 0; i < 3; ++i) {
      const EdgeId e = edge_of(t, i), f = mesh.twin(e);
      if (mesh.piece(e) == kNone || (f != kNone && f < e)) continue;
      const std::uint32_t segment = graph.pieces[mesh.piece(e)].segment;
      edges.push_back(
          {{graph.number_of(mesh.origin(e)), graph.number_of(mesh.target(e))}, segment});
    }
  }
}

PlanarGraph chamfered_graph(const InputGraph& graph, const Chamfered& chamfered,
                            const PointStore& points) {
  PlanarGraph result;
  result.insideness = graph.input->insideness;
  result.holes = graph.input->holes;
  std::vector<std::uint32_t> number(points.size(), kNone);
  const auto vertex = [&](VertexId v) {
    if (number[v] == kNone) {
      number[v] = static_cast<std::uint32_t>(result.vertices.size());
      result.vertices.push_back(in_input_units(graph, points, v));
    }
    return number[v];
  };
  for (PieceId id = kBoxPieces; id < graph.pieces.size(); ++id) {
    const auto [a, b] = chamfered.ends[id];
    if (a == kNone) continue;
    const std::uint32_t segment = graph.pieces[id].segment;
    result.segments.push_back({vertex(a), vertex(b)});
    const auto& markers = graph.input->markers;
    result.markers.push_back(markers.empty() ? 0 : markers[segment]);
    const auto& partitions = graph.input->partitions;
    if (!partitions.empty()) result.partitions.push_back(partitions[segment]);
  }
  return result;
}

}  // namespace delmesher::plane
