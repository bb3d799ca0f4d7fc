#include "mesher/tetmesh/conforming_mesh.h"

#include <algorithm>
#include <cstddef>

namespace delmesher::tetmesh {

void keep_inside(ConformingMesh& mesh) {
  std::size_t kept = 0;
  for (std::size_t n = 0; n < mesh.tetrahedra.size(); ++n) {
    if (mesh.region[n] == kOutside) continue;
    mesh.tetrahedra[kept] = mesh.tetrahedra[n];
    mesh.region[kept++] = mesh.region[n];
  }
  mesh.tetrahedra.resize(kept);
  mesh.region.resize(kept);
  mesh.repeated_faces.clear();
}

ConformingMesh part_within(Region region, const ConformingMesh& mesh) {
  const auto is_written = [&](RegionId id) { return region == Region::hull || id != kOutside; };
  const auto count = static_cast<std::size_t>(std::ranges::count_if(mesh.region, is_written));
  ConformingMesh part;
  part.boundary = mesh.boundary;
  part.tetrahedra.reserve(count);
  part.region.reserve(count);
  part.repeated_faces.reserve(mesh.repeated_faces.empty() ? 0 : count);
  for (std::size_t n = 0; n < mesh.tetrahedra.size(); ++n) {
    if (!is_written(mesh.region[n])) continue;
    part.tetrahedra.push_back(mesh.tetrahedra[n]);
    part.region.push_back(mesh.region[n]);
    if (mesh.repeated_faces.empty()) continue;
    part.repeated_faces.push_back(repeated_within(region, mesh.repeated_faces[n]));
  }
  return part;
}

}  // namespace delmesher::tetmesh
