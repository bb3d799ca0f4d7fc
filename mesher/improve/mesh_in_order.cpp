#include "mesher/improve/mesh_in_order.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "mesher/base/spatial_sort.h"

namespace delmesher::improve {
namespace {

// Tetrahedra as good as this are left alone. (Lower targets were tried: they take a quarter less
// time, but nearly as many tetrahedra; then the worst of them are worse.)
constexpr double kDihedral = 22, kFaceAngle = 20;  // degrees
constexpr float kGamma = 0.4F;

float squared_sine(double degrees) {
  return static_cast<float>(1 - cosine_squared(degrees));
}

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

}  // namespace

Goals goals_of(const ImproveOptions& options) {
  return {.target = {squared_sine(kDihedral), squared_sine(kFaceAngle), kGamma * kGamma},
          .promised = squared_sine(options.delta),
          .floor = squared_sine(kFlattestDihedral),
          .max_edge = options.max_edge,
          .sizes = options.sizes != nullptr && !options.sizes->empty() ? options.sizes : nullptr,
          .as_given = options.as_given,
          .everywhere = options.region == Region::hull};
}

std::vector<VertexId> vertices_in_order(const ImproveMesh& mesh, const PointStore& points) {
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

WorkMesh work_mesh(ImproveMesh mesh, std::span<const VertexId> point, std::size_t points) {
  std::vector<VertexId> number(points, kNone);
  for (VertexId v = 0; v < point.size(); ++v) number[point[v]] = v;
  {  // gone before the work mesh finds its neighbours, which takes the most memory
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
  return {std::move(mesh.tetrahedra), mesh.region, mesh.boundary, point.size()};
}

ImproveMesh result_of(const State& state) {
  const WorkMesh& mesh = state.mesh;
  // A face of the surface has one side that is inside, or else any one side tells of it.
  const auto is_told_from = [&](TetId t, TetId u) {
    return u == kNone || std::pair(mesh.region(u), u) < std::pair(mesh.region(t), t);
  };
  ImproveMesh result;
  for (TetId t = 0; t < mesh.slots(); ++t) {
    if (!mesh.alive(t)) continue;
    Tet v;
    for (int i = 0; i < 4; ++i) v[i] = state.point(mesh.tet(t)[i]);
    result.tetrahedra.push_back(v);
    result.region.push_back(mesh.region(t));
    for (int i = 0; i < 4; ++i) {
      if (mesh.facet(t, i) == kNone || !is_told_from(t, mesh.neighbor(t, i))) continue;
      result.boundary.push_back(
          {{v[kFace[i][0]], v[kFace[i][1]], v[kFace[i][2]]}, mesh.facet(t, i)});
    }
  }
  return result;
}

}  // namespace delmesher::improve
