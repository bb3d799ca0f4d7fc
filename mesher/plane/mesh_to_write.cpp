#include "mesher/plane/mesh_to_write.h"

namespace delmesher::plane {

MeshToWrite select(const Triangulation& mesh, const std::vector<Side>& side,
                   const std::vector<double>& attributes, Region region) {
  MeshToWrite result;
  const auto wanted = [&](TriangleId t) {
    return region == Region::hull || side[t] == Side::inside;
  };
  for (TriangleId t = 0; t < mesh.size(); ++t) {
    if (!wanted(t)) continue;
    result.triangles.push_back(mesh[t].vertex);
    result.inside.push_back(side[t] == Side::inside);
    if (!attributes.empty()) result.attributes.push_back(attributes[t]);
    for (int i = 0; i < 3; ++i) {
      const EdgeId e = edge_of(t, i), f = mesh.twin(e);
      if (mesh.piece(e) == kNone || mesh.piece(e) < kBoxPieces) continue;
      if (f != kNone && f < e && wanted(triangle_of(f))) continue;
      result.edges.push_back({mesh.origin(e), mesh.target(e)});
      result.edge_pieces.push_back(mesh.piece(e));
    }
  }
  return result;
}

}  // namespace delmesher::plane
