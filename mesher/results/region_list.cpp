#include "mesher/results/region_list.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <utility>

#include "mesher/arithmetic/dyadic.h"
#include "mesher/base/sort_unique.h"
#include "mesher/delmesher/region_name.h"
#include "mesher/geometry/vector.h"
#include "mesher/predicates/exact_point.h"
#include "mesher/results/split_walls.h"
#include "mesher/tetmesh/boundary_sides.h"

namespace delmesher::results {
namespace {

using Pair = std::array<RegionId, 2>;  // the smaller one first
// What is between two regions: the labels that some triangle there has, of each such list one.
using Walls = std::map<Pair, std::set<std::vector<std::int32_t>>>;

// Per region six times its volume, by the faces around it.
std::vector<Dyadic> volumes6(const PointStore& points, const ConformingMesh& mesh) {
  std::vector<Dyadic> volumes(*std::ranges::max_element(mesh.region) + std::size_t{1});
  for_each_side(mesh, [&](std::size_t, std::size_t t, int i) {
    const Tet& v = mesh.tetrahedra[t];
    const auto at = [&](int k) { return dyadic_point(points, v[kFace[i][k]]); };
    const DyadicPoint a = at(0), b = at(1), c = at(2);
    const auto minor = [&](std::size_t j, std::size_t k) { return b[j] * c[k] - b[k] * c[j]; };
    Dyadic& volume = volumes[mesh.region[t]];
    volume = volume + a[0] * minor(1, 2) + a[1] * minor(2, 0) + a[2] * minor(0, 1);
  });
  return volumes;
}

// Of a positive number, to be compared: the nearest one of 24 bits, of two the larger.
std::pair<std::int64_t, std::uint64_t> rounded(const Dyadic& x) {
  constexpr std::size_t kBits = 24;
  const std::size_t length = x.mantissa.bit_length();
  const auto exponent = static_cast<std::int64_t>(x.exponent) + static_cast<std::int64_t>(length);
  const std::uint64_t bits = length > kBits
                                 ? ((x.mantissa >> (length - kBits - 1)).data()[0] + 1) / 2
                                 : x.mantissa.data()[0] << (kBits - length);
  if (bits >> kBits != 0) return {exponent + 1, bits / 2};
  return {exponent, bits};
}

// The volumes become those of the new numbers.
void sort_by_volume(std::vector<Dyadic>& volumes, ConformingMesh& mesh,
                    std::vector<MeshRegion>& regions) {
  std::vector<FacetId> first(volumes.size(), kNone);
  const std::vector<Pair> beside = regions_beside(mesh);
  for (std::size_t n = 0; n < beside.size(); ++n) {
    for (const RegionId region : beside[n]) {
      first[region] = std::min(first[region], mesh.boundary[n].facet);
    }
  }
  std::vector<RegionId> order(volumes.size()), number(volumes.size());
  std::iota(order.begin(), order.end(), kOutside);
  std::ranges::stable_sort(order.begin() + 1, order.end(), [&](RegionId i, RegionId j) {
    const auto u = rounded(volumes[i]), v = rounded(volumes[j]);
    return u != v ? u > v : first[i] < first[j];
  });
  std::vector<Dyadic> sorted;
  for (const RegionId region : order) {
    number[region] = static_cast<RegionId>(sorted.size());
    sorted.push_back(std::move(volumes[region]));
    if (region != kOutside) {
      regions.emplace_back().volume = round_to_double(sorted.back()).value / 6;
    }
  }
  volumes = std::move(sorted);
  for (RegionId& region : mesh.region) region = number[region];
}

// Which regions a label's triangles surround: those that only an odd number of them separates from
// the outside. The triangles are closed.
class Surrounded {
 public:
  explicit Surrounded(std::size_t regions) : side_(regions + 1) {}

  std::vector<RegionId> run(const Walls& walls, std::int32_t label) {
    std::ranges::fill(side_, kUnknown);
    neighbors_.assign(side_.size(), {});
    for (const auto& [pair, lists] : walls) {
      for (const std::vector<std::int32_t>& labels : lists) {
        join(pair, std::ranges::binary_search(labels, label));
      }
    }
    spread();
    return odd();
  }

 private:
  enum Side : std::uint8_t { kEven, kOdd, kUnknown };

  void join(const Pair& pair, bool crosses) {
    neighbors_[pair[0]].emplace_back(pair[1], crosses);
    neighbors_[pair[1]].emplace_back(pair[0], crosses);
  }
  void spread() {
    std::vector<RegionId> queue = {kOutside};
    side_[kOutside] = kEven;
    for (std::size_t n = 0; n < queue.size(); ++n) {
      for (const auto& [region, crosses] : neighbors_[queue[n]]) {
        if (side_[region] != kUnknown) continue;
        side_[region] = (side_[queue[n]] == kOdd) != crosses ? kOdd : kEven;
        queue.push_back(region);
      }
    }
  }
  std::vector<RegionId> odd() const {
    std::vector<RegionId> result;
    for (std::size_t region = 1; region < side_.size(); ++region) {
      if (side_[region] == kOdd) result.push_back(static_cast<RegionId>(region));
    }
    return result;
  }

  std::vector<Side> side_;
  std::vector<std::vector<std::pair<RegionId, bool>>> neighbors_;
};

// Labels whose triangles are not closed, with an edge that an odd number of these has; if there is
// one, with an edge of one triangle alone.
std::map<std::int32_t, std::array<std::uint32_t, 2>> open_labels(
    const surface::MergedSurface& merged) {
  using Edge = std::array<std::uint32_t, 2>;
  struct Side {
    std::int32_t label;
    Edge edge;
    auto operator<=>(const Side&) const = default;
  };
  std::vector<Side> sides;
  std::vector<Edge> edges;
  const auto& triangles = merged.surface.triangles;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    const std::vector<std::int32_t> labels = merged.labels_of(t);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax(triangles[t][k], triangles[t][(k + 1) % 3]);
      edges.push_back({a, b});
      for (const std::int32_t label : labels) sides.push_back({label, edges.back()});
    }
  }
  std::ranges::sort(sides);
  std::ranges::sort(edges);
  const auto is_free = [&](const Edge& edge) {
    const auto [begin, end] = std::equal_range(edges.begin(), edges.end(), edge);
    return end - begin == 1;
  };
  std::map<std::int32_t, Edge> open;
  for (std::size_t n = 0; n < sides.size();) {
    std::size_t end = n;
    while (end < sides.size() && sides[end] == sides[n]) ++end;
    if ((end - n) % 2 != 0) {
      const auto [entry, is_new] = open.try_emplace(sides[n].label, sides[n].edge);
      if (!is_new && is_free(sides[n].edge) && !is_free(entry->second)) {
        entry->second = sides[n].edge;
      }
    }
    n = end;
  }
  return open;
}

class Lister {
 public:
  Lister(const surface::MergedSurface& merged, const PointStore& points, ConformingMesh& mesh)
      : merged_(merged),
        points_(points),
        mesh_(mesh),
        open_(open_labels(merged)),
        volumes6_(volumes6(points, mesh)) {}

  RegionList run() {
    sort_by_volume(volumes6_, mesh_, list_.report.regions);
    beside_ = regions_beside(mesh_);
    list_.bare = static_cast<std::size_t>(std::ranges::count(beside_, Pair{kOutside, kOutside}));
    find_labels();
    measure_walls();
    find_open();
    return std::move(list_);
  }

 private:
  // A region is of the smallest closed solid that it lies in.
  void find_labels() {
    // So many labels are not solids.
    constexpr std::size_t kMostWork = 100'000'000;
    std::vector<MeshRegion>& regions = list_.report.regions;
    Walls walls;
    std::set<std::int32_t> closed;
    for (std::size_t n = 0; n < mesh_.boundary.size(); ++n) {
      std::vector<std::int32_t> labels = merged_.labels_of(mesh_.boundary[n].facet);
      for (const std::int32_t label : labels) {
        if (!open_.contains(label)) closed.insert(label);
      }
      walls[beside_[n]].insert(std::move(labels));
    }
    if (closed.size() * (walls.size() + regions.size()) > kMostWork) return;
    std::vector<Dyadic> smallest(regions.size());
    Surrounded surrounded(regions.size());
    for (const std::int32_t label : closed) {
      const std::vector<RegionId> inside = surrounded.run(walls, label);
      Dyadic volume;
      for (const RegionId r : inside) volume = volume + volumes6_[r];
      for (const RegionId r : inside) {
        if (regions[r - 1].label && (volume - smallest[r - 1]).sign() >= 0) continue;
        smallest[r - 1] = volume;
        regions[r - 1].label = label;
      }
    }
  }

  void measure_walls() {
    std::map<Pair, std::pair<std::set<FacetId>, double>> walls;
    for (std::size_t n = 0; n < mesh_.boundary.size(); ++n) {
      auto& [triangles, area] = walls[beside_[n]];
      triangles.insert(mesh_.boundary[n].facet);
      const auto& [a, b, c] = mesh_.boundary[n].vertices;
      const Vec3 from = points_.nearest(a);
      area +=
          norm(cross(subtract(points_.nearest(b), from), subtract(points_.nearest(c), from))) / 2;
    }
    for (const auto& [pair, wall] : walls) {
      const auto first = static_cast<std::int32_t>(pair[0]),
                 second = static_cast<std::int32_t>(pair[1]);
      list_.report.walls.push_back({{first, second}, wall.first.size(), wall.second});
    }
  }

  void find_open() {
    std::map<std::int32_t, std::int32_t> region;  // of those with one on both sides
    for (std::size_t n = 0; n < mesh_.boundary.size(); ++n) {
      if (beside_[n][0] != beside_[n][1]) continue;
      for (const std::int32_t label : merged_.labels_of(mesh_.boundary[n].facet)) {
        if (open_.contains(label)) region.try_emplace(label, beside_[n][0]);
      }
    }
    for (const auto& [label, number] : region) {
      const auto& [a, b] = open_.at(label);
      list_.report.open.push_back(
          {label, number, {merged_.surface.vertices[a], merged_.surface.vertices[b]}});
    }
  }

  const surface::MergedSurface& merged_;
  const PointStore& points_;
  ConformingMesh& mesh_;
  const std::map<std::int32_t, std::array<std::uint32_t, 2>> open_;  // an edge of each label
  std::vector<Dyadic> volumes6_;  // of the regions, and of the outside
  std::vector<Pair> beside_;      // per face of the boundary
  RegionList list_;
};

Status unknown_region(const std::string& name, const Options& options,
                      const std::vector<MeshRegion>& regions) {
  std::vector<std::string> names;
  for (const MeshRegion& region : regions) {
    if (std::string known = name_of_region(region, options.label_names); !known.empty()) {
      names.push_back(std::move(known));
    }
  }
  sort_unique(names);
  std::string list;
  for (const std::string& known : names) list += (list.empty() ? "" : ", ") + known;
  return {StatusCode::invalid_options,
          "no region is called \"" + name + "\": " +
              (list.empty() ? "none lies in a closed solid that has a name" : "there are " + list)};
}

// Calls visit(number) for each region of the name. Are there any?
template <class Visit>
bool for_each_called(const std::string& name, const Options& options,
                     const std::vector<MeshRegion>& regions, const Visit& visit) {
  bool any = false;
  for (std::size_t n = 0; n < regions.size(); ++n) {
    if (name.empty() || name_of_region(regions[n], options.label_names) != name) continue;
    visit(static_cast<RegionId>(n + 1));
    any = true;
  }
  return any;
}

}  // namespace

RegionList list_regions(const surface::MergedSurface& merged, const PointStore& points,
                        ConformingMesh& mesh) {
  return Lister(merged, points, mesh).run();
}

Status choose_regions(const Options& options, const std::vector<MeshRegion>& regions,
                      ConformingMesh& mesh) {
  std::set<RegionId> chosen;
  if (options.regions == Regions::largest) chosen.insert(kInside);
  for (const std::string& name : options.region_names) {
    const auto take = [&](RegionId region) { chosen.insert(region); };
    if (!for_each_called(name, options, regions, take)) {
      return unknown_region(name, options, regions);
    }
  }
  for (RegionId n = 1; n <= regions.size(); ++n) {
    if (options.regions == Regions::all) chosen.insert(n);
    if (regions[n - 1].is_hole) chosen.erase(n);
  }
  for (RegionId& region : mesh.region) {
    if (!chosen.contains(region)) region = kOutside;
  }
  return {};
}

Status find_region_sizes(const Options& options, const std::vector<MeshRegion>& regions,
                         std::vector<double>& sizes) {
  sizes.clear();
  const auto is_bounded = [](const MeshRegion& region) { return region.max_edge > 0; };
  if (std::ranges::any_of(regions, is_bounded)) {
    sizes.push_back(0);
    for (const MeshRegion& region : regions) sizes.push_back(region.max_edge);
  }
  for (const auto& [name, max_edge] : options.region_sizes) {
    sizes.resize(regions.size() + 1, 0);
    const double size = max_edge;
    const auto bound = [&](RegionId region) {
      sizes[region] = sizes[region] > 0 ? std::min(sizes[region], size) : size;
    };
    if (!for_each_called(name, options, regions, bound)) {
      return unknown_region(name, options, regions);
    }
  }
  return {};
}

namespace {

// Local operations do not know which way a triangle between tetrahedra was given.
void turn_as_given(const surface::MergedSurface& merged, TetMesh& mesh) {
  const auto normal = [](const auto& vertices, const auto& t) {
    return cross(subtract(vertices[t[1]], vertices[t[0]]),
                 subtract(vertices[t[2]], vertices[t[0]]));
  };
  for (std::size_t n = 0; n < mesh.boundary.size(); ++n) {
    auto& face = mesh.boundary[n];
    const auto& given = merged.surface.triangles[mesh.boundary_facets[n]];
    if (dot(normal(mesh.vertices, face), normal(merged.surface.vertices, given)) < 0) {
      std::swap(face[1], face[2]);
    }
  }
}

}  // namespace

void finish_regions(const Options& options, const surface::MergedSurface& merged,
                    std::size_t triangles, Result& result) {
  TetMesh& mesh = result.mesh;
  // A mesh of region 1 alone has no list of its own.
  if (mesh.regions.empty()) mesh.regions.assign(mesh.tetrahedra.size(), 1);
  for (const std::int32_t region : mesh.regions) {
    ++result.regions[static_cast<std::size_t>(region - 1)].tetrahedra;
  }
  turn_as_given(merged, mesh);
  split_walls(options, merged, result);
  const auto count = static_cast<std::uint32_t>(merged.given.size());
  for (std::uint32_t& facet : mesh.boundary_facets) {
    facet = facet < count ? merged.given[facet]
                          : static_cast<std::uint32_t>(triangles) + merged.given[facet - count];
  }
}

}  // namespace delmesher::results
