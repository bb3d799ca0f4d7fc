#include "mesher/policies/default_size.h"

#include <algorithm>
#include <cmath>

#include "mesher/geometry/vector.h"
#include "mesher/policies/planar_runs.h"
#include "mesher/refine/prediction.h"

namespace delmesher::policies {

Part part_of(const TetMesh& mesh) {
  const auto at = [&](std::uint32_t v) { return mesh.vertices[v]; };
  double volume = 0, area = 0;
  for (const auto& [a, b, c, d] : mesh.tetrahedra) {
    volume += std::fabs(
        dot(subtract(at(b), at(a)), cross(subtract(at(c), at(a)), subtract(at(d), at(a)))));
  }
  for (const auto& [a, b, c] : mesh.boundary) {
    area += norm(cross(subtract(at(b), at(a)), subtract(at(c), at(a))));
  }
  return {volume / 6, area / 2};
}

bool may_choose_size(const Options& options) {
  return options.size == kSizeAuto && options.surface != SurfaceChoice::keep &&
         options.regions == Regions::solid && options.tolerance == 0 && options.max_edge == 0 &&
         options.size_field.empty() && options.budget == 0 && options.planar != 0 &&
         options.improve && !options.approximate && options.region == Region::interior;
}

DefaultSize default_size(const Result& without_size) {
  constexpr double kLargest = 0.1, kSmallest = 0.05;  // of the diagonal
  constexpr double kFew = 0.5, kThinnest = 0.1;
  const TetMesh& mesh = without_size.mesh;
  const Part part = part_of(mesh);
  const double diagonal = without_size.statistics.bbox_diagonal;
  if (diagonal == 0 || mesh.tetrahedra.empty()) return {};
  const double thickness = 2 * part.volume / part.area;  // of a plate
  const double size = std::clamp(thickness, kSmallest * diagonal, kLargest * diagonal);
  const double made = refine::tetrahedra_of_size(size, part.volume, part.area);
  const bool few = static_cast<double>(mesh.tetrahedra.size()) < kFew * made;
  if (!few || thickness < kThinnest * size) return {};
  constexpr double kMostTimes = 3;  // vertices per tetrahedron expected; usual is a quarter
  return {size, mesh.vertices.size() + static_cast<std::uint64_t>(kMostTimes * made)};
}

std::string why_not(const Result& sized, const Result& without_size) {
  constexpr double kMostBad = 0.1;
  if (PlanarRuns::is_worse(sized, without_size)) {
    return "tetrahedra are inverted or flat, lines are lost, or coordinates are not exact";
  }
  const MeshStatistics& s = sized.statistics.final;
  const bool is_bad = static_cast<double>(s.below_5) > kMostBad * static_cast<double>(s.tetrahedra);
  return is_bad ? "too many tetrahedra have dihedral angles below 5 degrees" : "";
}

}  // namespace delmesher::policies
