#include "mesher/results/mesh_to_write.h"

#include <algorithm>

#include "mesher/base/face_key.h"
#include "mesher/surface/given_place.h"

namespace delmesher::results {
namespace {

std::vector<Vec3> places(const PointStore& points, std::span<const Vec3> given) {
  std::vector<Vec3> place;
  if (given.empty()) return place;
  place.reserve(points.size());
  PointStore scratch;
  for (VertexId v = 0; v < points.size(); ++v) {
    place.push_back(given_place(points, v, given, scratch));
  }
  return place;
}

output::RoundingInput rounding_input(const Session& session) {
  const PointStore& points = session.points;
  output::RoundingInput input;
  input.points = &points;
  input.frame = session.frame;
  input.place = places(points, session.given);
  input.fixed.resize(points.size());
  input.on_surface.resize(points.size());
  for (VertexId v = 0; v < points.size(); ++v) {
    // Only points on the surface or on the box have planes.
    input.on_surface[v] = points.planes(v).empty() ? 0 : 1;
    input.fixed[v] =
        v < session.input_vertices() || (points.is_explicit(v) && input.on_surface[v] != 0);
  }
  return input;
}

}  // namespace

MeshToWrite conforming_mesh(const cdt::CdtResult& cdt, const Session& session) {
  const Region region = session.options.region;
  MeshToWrite mesh{rounding_input(session), {}, {}};
  output::RoundingInput& input = mesh.rounding;
  const auto inside = static_cast<std::size_t>(std::count(cdt.inside.begin(), cdt.inside.end(), 1));
  input.tetrahedra.reserve(region == Region::interior ? inside : cdt.tetrahedra.size());
  input.inside.reserve(input.tetrahedra.capacity());
  mesh.repeated_faces.reserve(input.tetrahedra.capacity());
  for (std::size_t n = 0; n < cdt.tetrahedra.size(); ++n) {
    if (region == Region::interior && cdt.inside[n] == 0) continue;
    input.tetrahedra.push_back(cdt.tetrahedra[n]);
    input.inside.push_back(cdt.inside[n]);
    if (!cdt.repeated_faces.empty()) {
      mesh.repeated_faces.push_back(repeated_within(region, cdt.repeated_faces[n]));
    }
  }
  for (const SurfaceFace& face : cdt.boundary) {
    input.boundary.push_back(face.vertices);
    mesh.facet_of_boundary.push_back(face.facet);
  }
  return mesh;
}

MeshToWrite approximate_mesh(const chamfer::ChamferResult& chamfered,
                             const refine::RefineResult& refined, const Session& session) {
  const Region region = session.options.region;
  MeshToWrite mesh{rounding_input(session), {}, {}};
  output::RoundingInput& input = mesh.rounding;
  std::vector<std::array<VertexId, 3>> written;
  for (std::size_t n = 0; n < refined.tetrahedra.size(); ++n) {
    const bool inside = refined.side[n] == Side::inside;
    if (region == Region::interior && !inside) continue;
    const auto& t = refined.tetrahedra[n];
    input.tetrahedra.push_back(t);
    input.inside.push_back(inside ? 1 : 0);
    for (const auto& f : kFace) written.push_back(undirected_face(t[f[0]], t[f[1]], t[f[2]]));
  }
  std::sort(written.begin(), written.end());
  for (const refine::RefinedFace& face : refined.faces) {
    const FacetId facet = chamfered.plc.facets[face.facet].input_facet;
    const auto& v = face.vertices;
    if (facet == kNone ||
        !std::binary_search(written.begin(), written.end(), undirected_face(v[0], v[1], v[2]))) {
      continue;
    }
    input.boundary.push_back(v);
    mesh.facet_of_boundary.push_back(facet);
  }
  return mesh;
}

}  // namespace delmesher::results
