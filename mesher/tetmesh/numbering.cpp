#include "mesher/tetmesh/numbering.h"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

#include "mesher/base/spatial_sort.h"

namespace delmesher::tetmesh {
namespace {

// The vertices in ascending order, but for the last two where that would turn it inside out.
Tet in_order(Tet t) {
  bool turned = false;
  for (int last = 3; last > 0; --last) {
    for (int i = 0; i < last; ++i) {
      if (t[i] < t[i + 1]) continue;
      std::swap(t[i], t[i + 1]);
      turned = !turned;
    }
  }
  if (turned) std::swap(t[2], t[3]);
  return t;
}

std::vector<VertexId> vertices_in_order(const ConformingMesh& mesh, const PointStore& points) {
  std::vector<std::uint8_t> used(points.size(), 0);
  for (const Tet& t : mesh.tetrahedra) {
    for (const VertexId v : t) used[v] = 1;
  }
  std::vector<VertexId> order;
  std::vector<Vec3> coordinates;
  coordinates.reserve(points.size());
  for (VertexId v = 0; v < points.size(); ++v) {
    if (used[v] != 0) order.push_back(v);
    coordinates.push_back(points.nearest(v));
  }
  hilbert_sort(order, coordinates);
  return order;
}

}  // namespace

NumberedMesh numbered(ConformingMesh mesh, const PointStore& points) {
  std::vector<VertexId> point = vertices_in_order(mesh, points);
  std::vector<VertexId> number(points.size(), kNone);
  for (VertexId v = 0; v < point.size(); ++v) number[point[v]] = v;
  {  // gone before the topology finds its neighbours, which takes the most memory
    std::vector<std::pair<Tet, RegionId>> sorted;
    sorted.reserve(mesh.tetrahedra.size());
    for (std::size_t n = 0; n < mesh.tetrahedra.size(); ++n) {
      Tet t = mesh.tetrahedra[n];
      for (VertexId& v : t) v = number[v];
      sorted.emplace_back(in_order(t), mesh.region[n]);
    }
    std::sort(sorted.begin(), sorted.end());
    for (std::size_t n = 0; n < sorted.size(); ++n) {
      std::tie(mesh.tetrahedra[n], mesh.region[n]) = sorted[n];
    }
  }
  for (SurfaceFace& face : mesh.boundary) {
    for (VertexId& v : face.vertices) v = number[v];
  }
  MeshTopology topology(std::move(mesh.tetrahedra), mesh.region, mesh.boundary, point.size());
  return {std::move(point), std::move(topology)};
}

NumberedMesh numbered_by_points(ConformingMesh mesh, std::size_t points) {
  std::vector<VertexId> point(points);
  std::iota(point.begin(), point.end(), 0U);
  return {std::move(point),
          MeshTopology(std::move(mesh.tetrahedra), mesh.region, mesh.boundary, points)};
}

ConformingMesh mesh_of(const MeshTopology& topology, std::span<const VertexId> point) {
  ConformingMesh mesh;
  for (TetId t = 0; t < topology.slots(); ++t) {
    if (!topology.alive(t)) continue;
    Tet v;
    for (int i = 0; i < 4; ++i) v[i] = point[topology.tet(t)[i]];
    mesh.tetrahedra.push_back(v);
    mesh.region.push_back(topology.region(t));
    mesh.repeated_faces.push_back(topology.repeated_faces(t));
    for (int i = 0; i < 4; ++i) {
      if (topology.facet(t, i) == kNone || !topology.is_told_from(t, i)) continue;
      mesh.boundary.push_back(
          {{v[kFace[i][0]], v[kFace[i][1]], v[kFace[i][2]]}, topology.facet(t, i)});
    }
  }
  return mesh;
}

}  // namespace delmesher::tetmesh
