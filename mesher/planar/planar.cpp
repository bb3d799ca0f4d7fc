#include "mesher/planar/planar.h"

#include <algorithm>
#include <utility>

#include "mesher/base/sort_unique.h"
#include "mesher/planar/flatness.h"
#include "mesher/surface/given_place.h"
#include "mesher/surface/half_edges.h"

namespace delmesher::planar {
namespace {

Surface in_given_coordinates(const Surface& surface, const Session& s) {
  Surface result = surface;
  for (Vec3& p : result.vertices) p = s.frame.given(p);
  return result;
}

// The largest distance that a vertex may have from the plane of its facet, in input units. It is
// half of the deviation allowed, because a triangle may be as far on the other side of the plane.
double bound_of(const Surface& surface, double planar, const Session& s) {
  if (planar != kPlanarAuto) return planar / 2 * s.diagonal;
  // How finely coordinates are written is seen in those that were given. Twice: planes may be moved
  // by as much again for vertices that lie on more than three.
  return 2 * (s.frame.moved() ? flatness(in_given_coordinates(surface, s), s.control)
                              : flatness(surface, s.control));
}

// Gives supports to the points that the mesh has on the surface, and to those on the outer box,
// whose planes are numbered after the planes of the surface.
void set_supports(const ConformingMesh& mesh, const Session& session, SurfaceAsGiven& as_given) {
  const SurfaceTopology& s = as_given.topology;
  std::vector<std::vector<PlaneId>> planes(as_given.points.size());
  for (const SurfaceFace& face : mesh.boundary) {
    for (const VertexId v : face.vertices) planes[v].push_back(s.facet_plane[face.facet]);
  }
  const auto before = static_cast<PlaneId>(session.surface.topology().plane_count),
             now = static_cast<PlaneId>(s.plane_count);
  const auto corners = static_cast<VertexId>(session.input_vertices());
  for (VertexId v = corners; v < planes.size(); ++v) {
    for (const PlaneId plane : session.points.planes(v)) {
      if (plane >= before) planes[v].push_back(plane - before + now);
    }
    sort_unique(planes[v]);
    std::vector<std::uint32_t> lines;
    const PointDefinition d = as_given.points.definition(v);
    if (d.kind == PointKind::on_segment && d.corner[0] < corners) {
      const std::uint32_t edge = edge_between(s, d.corner[0], d.corner[1]);
      if (edge != kNone && s.edge_is_flat[edge] == 0) lines = {edge, s.edge_line[edge]};
      sort_unique(lines);
    }
    if (!planes[v].empty()) as_given.points.set_supports(v, planes[v], lines);
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

// Edges of the surface as given that bend by so many degrees, and are not edges between facets of
// the planarized one.
std::uint64_t lines_lost(const Surface& given, const SurfaceTopology& planarized, double degrees) {
  PointStore points;
  for (const Vec3& p : given.vertices) points.add_explicit(p[0], p[1], p[2]);
  Predicates predicates(points);
  const double cosine = predicates::cosine_squared(degrees);
  const HalfEdgeGroups edges(given.triangles, given.vertices.size());
  std::uint64_t lost = 0;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto corner = [&](std::uint32_t h, std::uint32_t k) {
      return given.triangles[h / 3][(h + k) % 3];
    };
    const std::uint32_t h = edges[e][0], g = edges[e][1];
    const VertexId a = corner(h, 0), b = corner(h, 1);
    const std::uint32_t edge = edge_between(planarized, a, b);
    if (edge != kNone && planarized.edge_is_flat[edge] == 0) continue;
    if (!predicates.bends_below(corner(h, 2), corner(g, 2), a, b, cosine)) ++lost;
  }
  return lost;
}

}  // namespace

bool goes_back(const Options& options) {
  return options.planar == 0 && options.improve && !options.approximate;
}

PlanarizedSurface enter_surface(const Surface& surface, const ValidityResult& validity,
                                Planes planes, Session& session) {
  const Surface outwards = oriented_outwards(surface, validity);
  const bool returns = planes == Planes::while_refined;
  const double bound =
      planes == Planes::none
          ? 0
          : bound_of(outwards, returns ? kPlanarAuto : session.options.planar, session);
  PlanarizedSurface planarized =
      planarize(outwards, bound, session.control, returns ? Retriangulate::no : Retriangulate::yes);
  SurfaceTopology topology =
      planarized_topology(outwards, planarized, session.points, session.predicates);
  if (session.options.tolerance != 0 && !planarized.planes.empty() && !returns) {
    planarized.lines_lost = lines_lost(outwards, topology, session.options.feature);
  }
  if (planarized.planes.empty()) {
    session.surface.enter_given(std::move(topology));
  } else {
    session.surface.enter_planarized(std::move(topology), outwards.vertices);
  }
  return planarized;
}

SurfaceAsGiven as_given(const Session& session) {
  const std::span<const Vec3> given = session.surface.given_vertices();
  const SurfaceTopology& planarized = session.surface.topology();
  SurfaceAsGiven result;
  Predicates predicates(result.points);
  result.topology =
      build_topology({{given.begin(), given.end()}, planarized.triangles, planarized.labels},
                     result.points, predicates);
  return result;
}

void return_to(SurfaceAsGiven as_given, Session& session) {
  session.surface.return_to_given(std::move(as_given.topology),
                                  vertices_of(session.points, session.input_vertices()));
  session.points = std::move(as_given.points);
}

bool go_back(const ConformingMesh& mesh, SurfaceAsGiven& as_given, Session& session) {
  const std::span<const Vec3> given = session.surface.given_vertices();
  PointStore without_supports;
  append_as_given(session.points, given, without_supports);
  if (!conforms(mesh, as_given.topology, without_supports, session.control)) return false;
  append_as_given(session.points, given, as_given.points);
  set_supports(mesh, session, as_given);
  return_to(std::move(as_given), session);
  return true;
}

}  // namespace delmesher::planar
