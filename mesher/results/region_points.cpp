#include "mesher/results/region_points.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>

#include "mesher/geometry/box_tree.h"
#include "mesher/predicates/predicates.h"

namespace delmesher::results {
namespace {

using geometry::Box;

// Of the tetrahedra that contain a point; none of them has been found.
using Where = std::optional<RegionId>;

class Finder {
 public:
  Finder(std::span<const RegionPoint> given, const ConformingMesh& mesh, PointStore& points)
      : given_(given), mesh_(mesh), points_(points) {}

  // kOutside also for points on a wall between regions.
  std::vector<RegionId> run() {
    std::vector<Box> boxes;
    for (const RegionPoint& p : given_) boxes.push_back({p.point, p.point});
    const geometry::BoxTree tree(boxes);
    const std::size_t before = points_.size();
    for (const RegionPoint& p : given_) {
      points_.add_explicit(p.point[0], p.point[1], p.point[2]);
    }
    first_ = static_cast<VertexId>(before);
    std::vector<Where> found(given_.size());
    std::vector<std::uint8_t> between(given_.size(), 0);  // on a wall
    for (std::size_t t = 0; t < mesh_.tetrahedra.size(); ++t) {
      tree.query(geometry::enclosing_box(points_, mesh_.tetrahedra[t]), [&](std::uint32_t n) {
        if (!contains(mesh_.tetrahedra[t], n)) return true;
        if (found[n] && *found[n] != mesh_.region[t]) between[n] = 1;
        found[n] = mesh_.region[t];
        return true;
      });
    }
    points_.truncate(before);
    std::vector<RegionId> result;
    for (std::size_t n = 0; n < given_.size(); ++n) {
      result.push_back(between[n] != 0 ? kOutside : found[n].value_or(kOutside));
    }
    return result;
  }

 private:
  bool contains(const Tet& t, std::uint32_t n) {
    const VertexId p = first_ + n;
    return predicates_.orient3d(p, t[1], t[2], t[3]) >= 0 &&
           predicates_.orient3d(t[0], p, t[2], t[3]) >= 0 &&
           predicates_.orient3d(t[0], t[1], p, t[3]) >= 0 &&
           predicates_.orient3d(t[0], t[1], t[2], p) >= 0;
  }

  const std::span<const RegionPoint> given_;
  const ConformingMesh& mesh_;
  PointStore& points_;
  predicates::Predicates predicates_{points_};
  VertexId first_ = 0;
};

std::string number_of(std::size_t n) {
  return "region point " + std::to_string(n + 1);
}

}  // namespace

Status enter_region_points(std::span<const RegionPoint> given, const ConformingMesh& mesh,
                           PointStore& points, std::vector<MeshRegion>& regions,
                           std::vector<std::string>& warnings) {
  if (given.empty()) return {};
  const std::vector<RegionId> where = Finder(given, mesh, points).run();
  for (std::size_t n = 0; n < given.size(); ++n) {
    const RegionPoint& p = given[n];
    if (where[n] == kOutside) {
      if (!p.is_hole) {
        warnings.push_back(number_of(n) + " lies in no region, or on a wall between two: ignored");
      }
      continue;
    }
    MeshRegion& region = regions[where[n] - 1];
    region.is_hole = region.is_hole || p.is_hole;
    if (!p.name.empty() && !region.name.empty() && region.name != p.name) {
      return {StatusCode::invalid_options, number_of(n) + " calls the region \"" + p.name +
                                               "\" that another one calls \"" + region.name +
                                               "\": is a wall missing between them?"};
    }
    if (!p.name.empty()) region.name = p.name;
    if (p.max_edge > 0 && (region.max_edge == 0 || p.max_edge < region.max_edge)) {
      region.max_edge = p.max_edge;
    }
  }
  return {};
}

}  // namespace delmesher::results
