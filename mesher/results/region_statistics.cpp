#include "mesher/results/region_statistics.h"

#include <algorithm>

#include "mesher/output/statistics.h"
#include "mesher/tetmesh/conforming_mesh.h"

namespace delmesher::results {
namespace {

// Statistics of the tetrahedra of the region; `is_inside` separates them by their number.
template <class IsInside>
MeshStatistics region_statistics(const std::vector<std::array<VertexId, 4>>& all,
                                 const IsInside& is_inside,
                                 const std::vector<std::uint8_t>& repeated_faces,
                                 const PointStore& points, Region region, Control& control) {
  std::vector<std::array<double, 3>> coordinates(points.size());
  for (VertexId v = 0; v < points.size(); ++v) coordinates[v] = points.nearest(v);
  std::vector<std::array<std::uint32_t, 4>> tetrahedra;
  std::vector<std::uint8_t> repeated;
  std::vector<std::uint8_t> used(points.size(), 0);
  std::uint64_t interior = 0;
  for (std::size_t n = 0; n < all.size(); ++n) {
    const bool inside = is_inside(n);
    interior += inside ? 1 : 0;
    if (region == Region::interior && !inside) continue;
    tetrahedra.push_back(all[n]);
    repeated.push_back(repeated_within(region, repeated_faces[n]));
    for (const VertexId v : all[n]) used[v] = 1;
  }
  const auto vertices = static_cast<std::uint64_t>(std::count(used.begin(), used.end(), 1));
  return output::mesh_statistics(coordinates, tetrahedra, repeated, vertices, interior, control);
}

}  // namespace

MeshStatistics refined_statistics(const refine::RefineResult& refined, const PointStore& points,
                                  Region region, Control& control) {
  const auto is_inside = [&](std::size_t n) { return refined.side[n] == Side::inside; };
  return region_statistics(refined.tetrahedra, is_inside, refined.repeated_faces, points, region,
                           control);
}

MeshStatistics interior_statistics(const cdt::CdtResult& cdt, const PointStore& points,
                                   Control& control) {
  const auto is_inside = [&](std::size_t n) { return cdt.mesh.region[n] != kOutside; };
  return region_statistics(cdt.mesh.tetrahedra, is_inside, cdt.mesh.repeated_faces, points,
                           Region::interior, control);
}

}  // namespace delmesher::results
