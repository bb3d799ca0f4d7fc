#include "mesher/policies/as_given.h"

#include <algorithm>
#include <utility>

#include "mesher/base/sort_unique.h"
#include "mesher/enrich/enrichment.h"
#include "mesher/surface/given_place.h"

namespace delmesher::policies {
namespace {

// Gives supports to the vertices of the surface `as_given`, to the points that the mesh has on it,
// and to the points on the outer box, whose planes are numbered after the planes of the surface.
void set_supports(const ConformingMesh& mesh, const Session& session,
                  const SurfaceTopology& as_given, const PointStore& vertices, PointStore& points) {
  std::vector<std::vector<PlaneId>> planes(points.size());
  for (const SurfaceFace& face : mesh.boundary) {
    for (const VertexId v : face.vertices) planes[v].push_back(as_given.facet_plane[face.facet]);
  }
  const auto before = static_cast<PlaneId>(session.surface.topology().plane_count),
             now = static_cast<PlaneId>(as_given.plane_count);
  for (VertexId v = 0; v < points.size(); ++v) {
    if (v < session.surface.given_vertices().size()) {
      points.set_supports(v, vertices.planes(v), vertices.lines(v));
      continue;
    }
    for (const PlaneId plane : session.points.planes(v)) {
      if (plane >= before) planes[v].push_back(plane - before + now);
    }
    sort_unique(planes[v]);
    std::vector<std::uint32_t> lines;
    const PointDefinition d = points.definition(v);
    if (d.kind == PointKind::on_segment && d.corner[0] < session.surface.given_vertices().size()) {
      const std::uint32_t edge = edge_between(as_given, d.corner[0], d.corner[1]);
      if (edge != kNone && as_given.edge_is_flat[edge] == 0) {
        lines = {edge, as_given.edge_line[edge]};
      }
      sort_unique(lines);
    }
    if (!planes[v].empty()) points.set_supports(v, planes[v], lines);
  }
}

// By exact signs, without supports.
bool conforms(const ConformingMesh& mesh, const SurfaceTopology& as_given, const PointStore& points,
              Control& control) {
  Predicates predicates(points);
  for (const auto& [a, b, c, d] : mesh.tetrahedra) {
    control.poll();
    if (predicates.orient3d(a, b, c, d) <= 0) return false;
  }
  return std::ranges::all_of(mesh.boundary, [&](const SurfaceFace& face) {
    const auto& [a, b, c] = as_given.triangles[as_given.facet_triangles[face.facet].front()];
    return std::ranges::all_of(face.vertices, [&, a = a, b = b, c = c](VertexId v) {
      return predicates.orient3d(a, b, c, v) == 0;
    });
  });
}

PointStore vertices_of(const PointStore& points, std::size_t count) {
  PointStore vertices;
  for (std::uint32_t n = 0; n < points.plane_count(); ++n) vertices.add_plane(points.plane(n));
  vertices.copy_corners(points, count);
  return vertices;
}

SurfaceTopology build(const Session& session, PointStore& points) {
  Predicates predicates(points);
  const std::span<const Vec3> given = session.surface.given_vertices();
  const SurfaceTopology& planarized = session.surface.topology();
  return build_topology({{given.begin(), given.end()}, planarized.triangles, planarized.labels},
                        points, predicates);
}

void enter(SurfaceTopology as_given, PointStore points, Session& session) {
  session.surface.return_to_given(std::move(as_given),
                                  vertices_of(session.points, session.input_vertices()));
  session.points = std::move(points);
}

}  // namespace

bool goes_back(const Options& options) {
  return options.planar == 0 && options.improve && !options.approximate;
}

SurfaceTopology topology_as_given(const Session& session) {
  PointStore points;
  return build(session, points);
}

bool go_back(const ConformingMesh& mesh, SurfaceTopology as_given, Session& session) {
  PointStore points;
  append_as_given(session.points, session.surface.given_vertices(), points);
  if (!conforms(mesh, as_given, points, session.control)) return false;
  PointStore vertices;
  build(session, vertices);  // for the supports of the vertices
  set_supports(mesh, session, as_given, vertices, points);
  enter(std::move(as_given), std::move(points), session);
  return true;
}

cdt::CdtResult tetrahedrize_as_given(const ConformingMesh& mesh, Session& session) {
  PointStore points;
  SurfaceTopology as_given = build(session, points);
  append_as_given(session.points, session.surface.given_vertices(), points);
  double farthest = 0;
  for (VertexId v = 0; v < session.input_vertices(); ++v) {
    farthest = std::max(farthest, distance(points.nearest(v), session.points.nearest(v)));
  }
  Predicates predicates(points);
  // Twice, and more than doubles err.
  const double reach = 2 * farthest + 0x1p-40 * session.diagonal;
  cdt::CdtInput input =
      enrich::input_as_given(mesh, as_given, reach, points, predicates, session.control);
  enter(std::move(as_given), std::move(points), session);
  input.topology = &session.surface.topology();
  return cdt::constrained_delaunay_tetrahedrization(input, session.points, session.predicates,
                                                    session.control);
}

}  // namespace delmesher::policies
