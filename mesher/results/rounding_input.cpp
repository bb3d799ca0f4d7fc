#include "mesher/results/rounding_input.h"

#include <algorithm>
#include <utility>
#include <vector>

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

}  // namespace

output::RoundingInput rounding_input(ConformingMesh mesh, const Session& session) {
  const PointStore& points = session.points;
  output::RoundingInput input;
  input.mesh = std::move(mesh);
  input.points = &points;
  input.frame = session.frame;
  input.mobility.reserve(points.size());
  input.place = places(points, session.surface.given_vertices());
  for (VertexId v = 0; v < points.size(); ++v) {
    // Only points on the surface or on the box have planes.
    const bool on_surface = !points.planes(v).empty();
    const bool given = v < session.input_vertices() || (points.is_explicit(v) && on_surface);
    input.mobility.push_back(given        ? Mobility::fixed
                             : on_surface ? Mobility::in_plane
                                          : Mobility::free);
  }
  return input;
}

ConformingMesh refined_part(const chamfer::ChamferResult& chamfered,
                            const refine::RefineResult& refined, Region region) {
  ConformingMesh part;
  std::vector<std::array<VertexId, 3>> written;
  for (std::size_t n = 0; n < refined.tetrahedra.size(); ++n) {
    const bool inside = refined.side[n] == Side::inside;
    if (region == Region::interior && !inside) continue;
    const Tet& t = refined.tetrahedra[n];
    part.tetrahedra.push_back(t);
    part.region.push_back(inside ? kInside : kOutside);
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
    part.boundary.push_back({v, facet});
  }
  return part;
}

}  // namespace delmesher::results
