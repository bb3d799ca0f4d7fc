#include "mesher/surface/half_edges.h"

#include <algorithm>
#include <numeric>

#include "mesher/base/ids.h"

namespace delmesher::surface {
namespace {

// Half-edges sorted by the smaller end, then the larger one, then their index: a counting sort on
// the smaller end followed by short sorts.
struct SortedHalfEdges {
  std::vector<std::uint32_t> order;
  std::vector<std::uint32_t> far_end;   // in the same order
  std::vector<std::size_t> near_begin;  // per vertex: its range as the smaller end

  SortedHalfEdges(const Triangles& triangles, std::size_t vertex_count) {
    std::vector<std::size_t> begin(vertex_count + 1, 0);
    const auto n = static_cast<std::uint32_t>(3 * triangles.size());
    const auto ends = [&](std::uint32_t h) {
      const std::uint32_t a = triangles[h / 3][h % 3], b = triangles[h / 3][(h % 3 + 1) % 3];
      return std::pair{std::min(a, b), std::max(a, b)};
    };
    for (std::uint32_t h = 0; h < n; ++h) {
      const auto [a, b] = ends(h);
      if (a != b) ++begin[a + 1];
    }
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    std::vector<std::pair<std::uint32_t, std::uint32_t>> entries(begin.back());
    std::vector<std::size_t> cursor(begin.begin(), begin.end() - 1);
    for (std::uint32_t h = 0; h < n; ++h) {
      const auto [a, b] = ends(h);
      if (a != b) entries[cursor[a]++] = {b, h};
    }
    near_begin = std::move(begin);
    order.reserve(entries.size());
    far_end.reserve(entries.size());
    for (std::size_t v = 0; v < vertex_count; ++v) {
      std::sort(entries.begin() + static_cast<std::ptrdiff_t>(near_begin[v]),
                entries.begin() + static_cast<std::ptrdiff_t>(near_begin[v + 1]));
    }
    for (const auto& [b, h] : entries) {
      far_end.push_back(b);
      order.push_back(h);
    }
  }
};

}  // namespace

HalfEdgeGroups::HalfEdgeGroups(const Triangles& triangles, std::size_t vertex_count) {
  const SortedHalfEdges sorted(triangles, vertex_count);
  // Where the group starting with half-edge h is found in the sorted list, so that groups can be
  // renumbered by their smallest half-edge without another sort.
  std::vector<std::uint32_t> group_at(3 * triangles.size(), kNone);
  std::vector<std::uint32_t> group_end(3 * triangles.size(), 0);
  std::size_t groups = 0;
  for (std::size_t v = 0; v + 1 < sorted.near_begin.size(); ++v) {
    for (std::size_t i = sorted.near_begin[v]; i < sorted.near_begin[v + 1];) {
      std::size_t j = i + 1;
      while (j < sorted.near_begin[v + 1] && sorted.far_end[j] == sorted.far_end[i]) ++j;
      group_at[sorted.order[i]] = static_cast<std::uint32_t>(i);
      group_end[sorted.order[i]] = static_cast<std::uint32_t>(j);
      ++groups;
      i = j;
    }
  }
  half_edges_.reserve(sorted.order.size());
  begin_.reserve(groups + 1);
  begin_.push_back(0);
  for (std::size_t h = 0; h < group_at.size(); ++h) {
    if (group_at[h] == kNone) continue;
    for (std::uint32_t i = group_at[h]; i < group_end[h]; ++i) {
      half_edges_.push_back(sorted.order[i]);
    }
    begin_.push_back(half_edges_.size());
  }
}

}  // namespace delmesher::surface
