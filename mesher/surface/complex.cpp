#include "mesher/surface/complex.h"

#include <algorithm>
#include <map>

#include "mesher/base/face_key.h"
#include "mesher/base/sort_unique.h"

namespace delmesher::surface {

MergedSurface merge_repeated(const Surface& given) {
  MergedSurface merged;
  merged.surface.vertices = given.vertices;
  const bool labelled = given.labels.size() == given.triangles.size();
  if (!labelled) merged.surface.labels = given.labels;  // refused later
  std::map<std::array<std::uint32_t, 3>, std::uint32_t> first;
  for (std::uint32_t t = 0; t < given.triangles.size(); ++t) {
    const auto& [a, b, c] = given.triangles[t];
    const auto [entry, is_new] = first.try_emplace(
        undirected_face(a, b, c), static_cast<std::uint32_t>(merged.surface.triangles.size()));
    if (is_new || a == b || b == c || c == a) {
      merged.surface.triangles.push_back(given.triangles[t]);
      if (labelled) merged.surface.labels.push_back(given.labels[t]);
      merged.given.push_back(t);
    } else if (labelled && given.labels[t] != merged.surface.labels[entry->second]) {
      merged.further_labels.emplace_back(entry->second, given.labels[t]);
    }
  }
  sort_unique(merged.further_labels);
  return merged;
}

std::vector<std::int32_t> MergedSurface::labels_of(std::uint32_t triangle) const {
  std::vector<std::int32_t> labels = {surface.labels.empty() ? 0 : surface.labels[triangle]};
  const auto begin = std::ranges::lower_bound(further_labels, triangle, {},
                                              [](const auto& item) { return item.first; });
  for (auto item = begin; item != further_labels.end() && item->first == triangle; ++item) {
    labels.push_back(item->second);
  }
  sort_unique(labels);
  return labels;
}

}  // namespace delmesher::surface
