#include "mesher/results/region_list.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#include "mesher/base/face_key.h"
#include "mesher/delaunay/tetrahedrization.h"
#include "mesher/geometry/vector.h"

namespace delmesher::results {
namespace {

using Pair = std::pair<std::int32_t, std::int32_t>;  // of regions, the smaller one first
// What is between two regions: the labels that some triangle there has, of each such list one.
using Walls = std::map<Pair, std::set<std::vector<std::int32_t>>>;

constexpr std::int32_t kUnbounded = 0;

double volume_of(const TetMesh& mesh, const std::array<std::uint32_t, 4>& t) {
  const Vec3& a = mesh.vertices[t[0]];
  return dot(cross(subtract(mesh.vertices[t[1]], a), subtract(mesh.vertices[t[2]], a)),
             subtract(mesh.vertices[t[3]], a)) /
         6;
}

// From 1 on, as the tetrahedra come. (A mesh of one region has no list of its own.)
void sort_by_volume(TetMesh& mesh, std::vector<MeshRegion>& regions) {
  if (mesh.regions.empty()) mesh.regions.assign(mesh.tetrahedra.size(), 1);
  const std::int32_t count = mesh.regions.empty() ? 0 : *std::ranges::max_element(mesh.regions);
  std::vector<MeshRegion> unsorted(static_cast<std::size_t>(count));
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    MeshRegion& region = unsorted[static_cast<std::size_t>(mesh.regions[t] - 1)];
    ++region.tetrahedra;
    region.volume += volume_of(mesh, mesh.tetrahedra[t]);
  }
  std::vector<std::size_t> order(unsorted.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(
      order, [&](std::size_t i, std::size_t j) { return unsorted[i].volume > unsorted[j].volume; });
  std::vector<std::int32_t> number(order.size());
  for (const std::size_t i : order) {
    regions.push_back(unsorted[i]);
    number[i] = static_cast<std::int32_t>(regions.size());
  }
  for (std::int32_t& region : mesh.regions) region = number[static_cast<std::size_t>(region - 1)];
}

// The regions on both sides of each boundary triangle, the same twice for a sheet.
std::vector<Pair> sides_of_boundary(const TetMesh& mesh) {
  std::map<std::array<std::uint32_t, 3>, std::size_t> triangle;
  for (std::size_t n = 0; n < mesh.boundary.size(); ++n) {
    const auto& [a, b, c] = mesh.boundary[n];
    triangle[undirected_face(a, b, c)] = n;
  }
  std::vector<std::vector<std::int32_t>> beside(mesh.boundary.size());
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const auto& v = mesh.tetrahedra[t];
    for (const auto& f : kFace) {
      const auto found = triangle.find(undirected_face(v[f[0]], v[f[1]], v[f[2]]));
      if (found != triangle.end()) beside[found->second].push_back(mesh.regions[t]);
    }
  }
  std::vector<Pair> sides;
  for (std::vector<std::int32_t>& regions : beside) {
    regions.resize(2, kUnbounded);
    sides.push_back(std::minmax(regions[0], regions[1]));
  }
  return sides;
}

// Which regions a label's triangles surround: those that only an odd number of them separates from
// the unbounded one. None if they are not closed.
class Surrounded {
 public:
  explicit Surrounded(std::size_t regions) : side_(regions + 1) {}

  std::vector<std::int32_t> run(const Walls& walls, std::int32_t label) {
    std::ranges::fill(side_, kUnknown);
    neighbors_.assign(side_.size(), {});
    for (const auto& [pair, lists] : walls) {
      for (const std::vector<std::int32_t>& labels : lists) {
        join(pair, std::ranges::binary_search(labels, label));
      }
    }
    return spread() ? odd() : std::vector<std::int32_t>();
  }

 private:
  enum Side : std::uint8_t { kEven, kOdd, kUnknown };

  void join(const Pair& pair, bool crosses) {
    neighbors_[static_cast<std::size_t>(pair.first)].emplace_back(pair.second, crosses);
    neighbors_[static_cast<std::size_t>(pair.second)].emplace_back(pair.first, crosses);
  }
  bool spread() {
    std::vector<std::size_t> queue = {kUnbounded};
    side_[kUnbounded] = kEven;
    for (std::size_t n = 0; n < queue.size(); ++n) {
      for (const auto& [region, crosses] : neighbors_[queue[n]]) {
        const auto u = static_cast<std::size_t>(region);
        const Side side = (side_[queue[n]] == kOdd) != crosses ? kOdd : kEven;
        if (side_[u] == kUnknown) {
          side_[u] = side;
          queue.push_back(u);
        }
        if (side_[u] != side) return false;
      }
    }
    return true;
  }
  std::vector<std::int32_t> odd() const {
    std::vector<std::int32_t> result;
    for (std::size_t region = 1; region < side_.size(); ++region) {
      if (side_[region] == kOdd) result.push_back(static_cast<std::int32_t>(region));
    }
    return result;
  }

  std::vector<Side> side_;
  std::vector<std::vector<std::pair<std::int32_t, bool>>> neighbors_;
};

// A region is of the smallest closed solid that it lies in.
void find_labels(const surface::MergedSurface& merged, const TetMesh& mesh,
                 std::vector<MeshRegion>& regions) {
  // So many labels are not solids.
  constexpr std::size_t kMostWork = 100'000'000;
  const std::vector<Pair> sides = sides_of_boundary(mesh);
  Walls walls;
  std::set<std::int32_t> all;
  for (std::size_t n = 0; n < mesh.boundary.size(); ++n) {
    std::vector<std::int32_t> labels = merged.labels_of(mesh.boundary_facets[n]);
    all.insert(labels.begin(), labels.end());
    walls[sides[n]].insert(std::move(labels));
  }
  if (all.size() * (walls.size() + regions.size()) > kMostWork) return;
  std::vector<double> smallest(regions.size(), HUGE_VAL);
  Surrounded surrounded(regions.size());
  for (const std::int32_t label : all) {
    const std::vector<std::int32_t> inside = surrounded.run(walls, label);
    double volume = 0;
    for (const std::int32_t r : inside) volume += regions[static_cast<std::size_t>(r - 1)].volume;
    for (const std::int32_t r : inside) {
      const auto n = static_cast<std::size_t>(r - 1);
      if (volume >= smallest[n]) continue;
      smallest[n] = volume;
      regions[n].label = label;
    }
  }
}

}  // namespace

void list_regions(const surface::MergedSurface& merged, Result& result) {
  sort_by_volume(result.mesh, result.regions);
  find_labels(merged, result.mesh, result.regions);
  for (std::uint32_t& facet : result.mesh.boundary_facets) facet = merged.given[facet];
}

}  // namespace delmesher::results
