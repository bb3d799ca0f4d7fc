#include "mesher/results/record_stages.h"

#include <algorithm>

namespace delmesher::results {
namespace {

// visit(v) for each point that the record names by its number, the definitions of points aside.
template <class Visit>
void for_each_point(ExactRecord& record, Visit&& visit) {
  for (auto& chain : record.segments) {
    for (auto& v : chain.vertices) visit(v);
  }
  for (auto& corner : record.corners) visit(corner.vertex);
  for (auto& [point, vertex] : record.chamfer_points) {
    visit(point);
    visit(vertex);
  }
  for (auto& ball : record.balls) {
    visit(ball.vertex);
    for (auto& v : ball.tetrahedron) visit(v);
  }
  for (auto* tets : {&record.refined, &record.final, &record.unrepaired}) {
    for (auto& t : *tets) {
      for (auto& v : t.vertices) visit(v);
    }
  }
  for (auto* faces : {&record.refined_facets, &record.final_facets, &record.unrepaired_facets}) {
    for (auto& f : *faces) {
      for (int k = 0; k < 3; ++k) visit(f[k]);
    }
  }
  for (auto& v : record.mesh_vertices) visit(v);
}

}  // namespace

void record_parameters(const Options& options, const InForce& force, double diagonal, double planar,
                       ExactRecord& record) {
  record.parameters = {.delta = std::min(options.delta, refine::kGuaranteedDelta),
                       .acute = force.acute,
                       .corner = force.corner,
                       .tolerance = force.tau * diagonal,
                       .region = options.region,
                       .gabriel = force.gabriel,
                       .planar = planar};
}

void record_facets(const SurfaceTopology& topology, const chamfer::FilterResult* filter,
                   ExactRecord& record) {
  for (FacetId f = 0; f < topology.facet_triangles.size(); ++f) {
    const auto& triangles = topology.facet_triangles[f];
    std::uint8_t filtered = 0;
    if (filter != nullptr && filter->facet_kept[f] == 0) {
      filtered = filter->kept_at_first[f] == 0 ? 1 : 2;
    }
    record.facets.push_back({triangles[0], topology.labels[triangles[0]], filtered, triangles});
  }
}

void record_chamfer(const chamfer::ChamferResult& chamfered, ExactRecord& record) {
  for (VertexId v = 0; v < chamfered.vertex_is_acute.size(); ++v) {
    if (chamfered.vertex_is_acute[v] == 0) continue;
    record.corners.push_back({v, chamfered.vertex_distance[v]});
  }
  for (std::uint32_t n = 0; n < chamfered.new_point_vertex.size(); ++n) {
    record.chamfer_points.push_back({chamfered.first_new_point + n, chamfered.new_point_vertex[n]});
  }
}

void record_refined(const chamfer::ChamferResult& chamfered, const refine::RefineResult& refined,
                    const SurfaceTopology& topology, ExactRecord& record) {
  const Plc& plc = chamfered.plc;
  const auto facet_id = [&](std::uint32_t f) {
    const FacetId facet = plc.facets[f].input_facet;
    return facet == kNone ? kNone : topology.facet_triangles[facet][0];
  };
  std::vector<std::uint32_t> facet_of_segment(plc.segments.size(), kNone);
  for (std::uint32_t f = 0; f < plc.facets.size(); ++f) {
    for (const auto& side : plc.facets[f].boundary) facet_of_segment[side.segment] = f;
  }
  for (std::size_t n = 0; n < plc.segments.size(); ++n) {
    const std::uint32_t f = facet_of_segment[n];
    const bool box = f != kNone && plc.facets[f].input_facet == kNone;
    if (box) continue;
    const bool artificial = plc.segments[n].input_edge == kNone;
    record.segments.push_back(
        {artificial, artificial && f != kNone ? facet_id(f) : kNone, refined.chain[n]});
  }
  for (std::size_t n = 0; n < refined.tetrahedra.size(); ++n) {
    record.refined.push_back({refined.tetrahedra[n], refined.side[n] == Side::inside});
  }
  for (std::size_t n = 0; n < refined.in_volume.size(); ++n) {
    record.balls.push_back({refined.in_volume[n], refined.ball[n]});
  }
  for (const refine::RefinedFace& face : refined.faces) {
    const std::uint32_t id = facet_id(face.facet);
    if (id == kNone) continue;
    record.refined_facets.push_back({face.vertices[0], face.vertices[1], face.vertices[2], id});
  }
}

void record_final(const ConformingMesh& mesh, const SurfaceTopology& topology,
                  ExactRecord& record) {
  record.final.clear();
  record.final_facets.clear();
  for (std::size_t n = 0; n < mesh.tetrahedra.size(); ++n) {
    record.final.push_back({mesh.tetrahedra[n], mesh.region[n] != kOutside});
  }
  for (const SurfaceFace& face : mesh.boundary) {
    record.final_facets.push_back({face.vertices[0], face.vertices[1], face.vertices[2],
                                   topology.facet_triangles[face.facet][0]});
  }
}

void record_changed(const ConformingMesh& changed, const SurfaceTopology& topology,
                    ExactRecord& record) {
  if (record.unrepaired.empty()) {
    record.unrepaired = std::move(record.final);
    record.unrepaired_facets = std::move(record.final_facets);
  }
  record_final(changed, topology, record);
}

void record_repaired(const output::RoundingResult& rounded, Region region, ExactRecord& record) {
  if (record.final.empty()) return;  // the refined mesh itself was written
  if (record.unrepaired.empty()) record.unrepaired = record.final;
  std::erase_if(record.final,
                [&](const ExactRecord::Tet& t) { return region == Region::hull || t.inside; });
  for (std::size_t n = 0; n < rounded.mesh.tetrahedra.size(); ++n) {
    ExactRecord::Tet tet{{}, rounded.mesh.inside[n] != 0};
    for (int i = 0; i < 4; ++i) tet.vertices[i] = rounded.vertices[rounded.mesh.tetrahedra[n][i]];
    record.final.push_back(tet);
  }
}

void record_points(const PointStore& points, const PointStore* as_refined,
                   std::size_t input_vertices, const output::RoundingResult& rounded,
                   ExactRecord& record) {
  record.mesh_vertices = rounded.vertices;
  std::vector<std::uint32_t> number(points.size(), 0);
  const auto use = [&](std::uint32_t v) { number[v] = 1; };
  for_each_point(record, use);
  for (VertexId v = 0; v < points.size(); ++v) {
    const PointDefinition d = points.definition(v);
    if (number[v] == 0 || points.is_corner(v)) continue;
    for (const VertexId c : d.corner) {
      if (c != kNone) use(c);
    }
  }
  // Input vertices keep their numbers, used or not.
  std::uint32_t next = 0;
  for (VertexId v = 0; v < points.size(); ++v) {
    if (number[v] == 0 && v >= input_vertices) {
      number[v] = kNone;
      continue;
    }
    number[v] = next++;
    const bool moved = as_refined != nullptr && v < input_vertices;
    const PointDefinition d = moved ? as_refined->definition(v) : points.definition(v);
    const auto at = [&](int k) { return number[d.corner[k]]; };
    ExactPoint p;
    switch (d.kind) {
      case PointKind::explicit_point: {
        const Vec3 x = points.nearest(v);
        p = {ExactPoint::Kind::explicit_point, 0, 0, 0, x[0], x[1], x[2]};
        break;
      }
      case PointKind::on_segment:
        p = {ExactPoint::Kind::on_segment, at(0), at(1), 0, d.u, 0, 0};
        break;
      case PointKind::on_triangle:
        p = {ExactPoint::Kind::on_triangle, at(0), at(1), at(2), d.u, d.v, 0};
        break;
      case PointKind::on_planes:
        p = {ExactPoint::Kind::on_planes, d.corner[0], d.corner[1], d.corner[2], 0, 0, 0};
        break;
    }
    record.points.push_back(p);
  }
  const PointStore& moved = as_refined != nullptr ? *as_refined : points;
  for (std::uint32_t n = 0; n < moved.plane_count(); ++n) {
    const PlaneEquation& plane = moved.plane(n);
    record.planes.push_back({plane.spanned, plane.normal, plane.through});
  }
  for_each_point(record, [&](std::uint32_t& v) { v = number[v]; });
}

}  // namespace delmesher::results
