#include "mesher/results/split_walls.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "mesher/base/disjoint_sets.h"
#include "mesher/base/face_key.h"
#include "mesher/base/sort_unique.h"
#include "mesher/delmesher/region_name.h"

namespace delmesher::results {
namespace {

// What walls are called.
class Names {
 public:
  Names(const Options& options, const surface::MergedSurface& merged,
        const std::vector<MeshRegion>& regions)
      : options_(options), merged_(merged), regions_(regions) {}

  std::string region(std::size_t number) const {
    std::string name = name_of_region(regions_[number - 1], options_.label_names);
    return name.empty() ? "region " + std::to_string(number) : name;
  }
  std::string label(std::int32_t label) const {
    const auto known = options_.label_names.find(label);
    return known != options_.label_names.end() ? known->second : "label " + std::to_string(label);
  }
  // All names of a triangle between two regions: by these, either of which comes first, and by
  // labels.
  std::vector<std::string> of(std::size_t one, std::size_t other, std::uint32_t triangle) const {
    std::vector<std::string> names;
    if (one != other) {
      names = {region(one) + "|" + region(other), region(other) + "|" + region(one)};
    }
    for (const std::int32_t l : merged_.labels_of(triangle)) names.push_back(label(l));
    return names;
  }
  // The side of a triangle that is that of region `here`; in front, if both are the same.
  std::string side(std::size_t here, std::size_t there, std::uint32_t triangle, bool front) const {
    if (here != there) return region(here) + "|" + region(there);
    const std::string name = label(merged_.labels_of(triangle).front());
    return name + (front ? "|front" : "|back");
  }
  bool is_chosen(std::size_t one, std::size_t other, std::uint32_t triangle) const {
    if (options_.split_walls == SplitWalls::all) return true;
    const std::vector<std::string> names = of(one, other, triangle);
    return std::ranges::any_of(names, [&](const std::string& name) {
      return std::ranges::count(options_.split_wall_names, name) > 0;
    });
  }

 private:
  const Options& options_;
  const surface::MergedSurface& merged_;
  const std::vector<MeshRegion>& regions_;
};

// Corner k of tetrahedron t is place 4 t + k.
class Splitter {
 public:
  Splitter(const Names& names, TetMesh& mesh)
      : names_(names), region_(mesh.regions), mesh_(mesh), sets_(4 * mesh.tetrahedra.size()) {}

  // The labels of the sides, by their names, from `label` on.
  // Triangles of the second sides are of facets `facets` above those of the first ones.
  std::map<std::string, std::int32_t> run(std::int32_t label, std::uint32_t facets) {
    choose();
    join();
    give_vertices();
    list(label, facets);
    return std::move(labels_);
  }

 private:
  using Key = std::array<std::uint32_t, 3>;
  // Of the faces of a positive tetrahedron, the corners, counter-clockwise seen from outside.
  static constexpr std::array<std::array<std::uint32_t, 3>, 4> kFaces = {
      {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
  struct Side {
    Key key;
    std::array<std::uint32_t, 3> place;  // counter-clockwise seen from outside
  };

  static Key key_of(const Key& face) { return undirected_face(face[0], face[1], face[2]); }
  std::uint32_t vertex(std::uint32_t place) const { return mesh_.tetrahedra[place / 4][place % 4]; }
  Key vertices(const Side& side) const {
    return {vertex(side.place[0]), vertex(side.place[1]), vertex(side.place[2])};
  }

  // Pairs the sides of faces at vertices of the boundary, of which those of a chosen wall are two.
  void choose() {
    std::vector<std::uint8_t> on_boundary(mesh_.vertices.size(), 0);
    for (const Key& face : mesh_.boundary) {
      for (const std::uint32_t v : face) on_boundary[v] = 1;
    }
    for (std::uint32_t t = 0; t < mesh_.tetrahedra.size(); ++t) {
      const auto& tet = mesh_.tetrahedra[t];
      for (const auto& [i, j, k] : kFaces) {
        const Key face = {tet[i], tet[j], tet[k]};
        if (std::ranges::none_of(face, [&](std::uint32_t v) { return on_boundary[v] != 0; })) {
          continue;
        }
        sides_.push_back({key_of(face), {4 * t + i, 4 * t + j, 4 * t + k}});
      }
    }
    std::ranges::stable_sort(sides_, {}, &Side::key);
    chosen_.assign(sides_.size(), 0);
    for (std::size_t n = 0; n < mesh_.boundary.size(); ++n) {
      const Key& face = mesh_.boundary[n];
      const auto at = std::ranges::lower_bound(sides_, key_of(face), {}, &Side::key);
      const auto first = static_cast<std::size_t>(at - sides_.begin());
      listed_.push_back({first, directed_face(face) != directed_face(vertices(*at))});
      if (is_double(first) &&
          names_.is_chosen(region(first), region(first + 1), mesh_.boundary_facets[n])) {
        chosen_[first] = 1;
      }
    }
  }
  std::size_t region(std::size_t side) const {
    return static_cast<std::size_t>(region_[sides_[side].place[0] / 4]);
  }
  // Is this the first of two sides of a face?
  bool is_double(std::size_t n) const {
    return n + 1 < sides_.size() && sides_[n].key == sides_[n + 1].key;
  }

  // What hangs together at each vertex, across faces that are not chosen.
  void join() {
    for (std::size_t n = 0; n < sides_.size(); ++n) {
      if (!is_double(n) || chosen_[n] != 0) continue;
      for (const std::uint32_t p : sides_[n].place) {
        for (const std::uint32_t q : sides_[n + 1].place) {
          if (vertex(p) == vertex(q)) sets_.join(p, q);
        }
      }
    }
  }

  // The first set with a chosen face at a vertex keeps it, and so do those without one.
  void give_vertices() {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> sets;  // vertex and set
    for (std::size_t n = 0; n < sides_.size(); ++n) {
      if (chosen_[n] == 0) continue;
      for (const std::size_t side : {n, n + 1}) {
        for (const std::uint32_t p : sides_[side].place) {
          sets.emplace_back(vertex(p), sets_.smallest(p));
        }
      }
    }
    sort_unique(sets);
    std::map<std::uint32_t, std::uint32_t> copy;  // by set
    for (std::size_t n = 1; n < sets.size(); ++n) {
      if (sets[n].first != sets[n - 1].first) continue;
      copy[sets[n].second] = static_cast<std::uint32_t>(mesh_.vertices.size());
      mesh_.vertices.push_back(mesh_.vertices[sets[n].first]);
    }
    for (const Side& side : sides_) {
      for (const std::uint32_t p : side.place) {
        const auto given = copy.find(sets_.smallest(p));
        if (given != copy.end()) mesh_.tetrahedra[p / 4][p % 4] = given->second;
      }
    }
  }

  // Sides with the same vertices cannot part.
  void list(std::int32_t label, std::uint32_t facets) {
    const std::size_t count = mesh_.boundary.size();
    for (std::size_t n = 0; n < count; ++n) {
      const auto [first, turned] = listed_[n];
      // The one behind the triangle sees it as it is given.
      const std::size_t behind = turned ? first + 1 : first, front = turned ? first : first + 1;
      if (chosen_[first] == 0 ||
          key_of(vertices(sides_[behind])) == key_of(vertices(sides_[front]))) {
        Key face = vertices(sides_[first]);
        if (turned) std::swap(face[1], face[2]);
        if (key_of(face) != key_of(mesh_.boundary[n])) mesh_.boundary[n] = face;
        continue;
      }
      const std::uint32_t facet = mesh_.boundary_facets[n];
      const auto label_of = [&](std::size_t here, std::size_t there) {
        const auto next = label + static_cast<std::int32_t>(labels_.size());
        const std::string name = names_.side(region(here), region(there), facet, here == front);
        return labels_.try_emplace(name, next).first->second;
      };
      mesh_.boundary[n] = vertices(sides_[behind]);
      mesh_.boundary_labels[n] = label_of(behind, front);
      mesh_.boundary.push_back(vertices(sides_[front]));
      mesh_.boundary_labels.push_back(label_of(front, behind));
      mesh_.boundary_facets.push_back(facet + facets);
    }
  }

  const Names& names_;
  const std::vector<std::int32_t>& region_;
  TetMesh& mesh_;
  DisjointSets sets_;
  std::vector<Side> sides_;
  std::vector<std::uint8_t> chosen_;  // per side that is the first of two
  // Of each triangle the first side, and whether that sees it turned over.
  struct Listed {
    std::size_t first;
    bool turned;
  };
  std::vector<Listed> listed_;
  std::map<std::string, std::int32_t> labels_;
};

}  // namespace

Status check_wall_names(const Options& options, const surface::MergedSurface& merged,
                        const std::vector<MeshRegion>& regions, const ConformingMesh& mesh) {
  if (options.split_walls != SplitWalls::named) return {};
  const Names names(options, merged, regions);
  const std::vector<std::array<RegionId, 2>> beside = regions_beside(mesh);
  std::set<std::string> known, listed;
  for (std::size_t n = 0; n < beside.size(); ++n) {
    const auto& [one, other] = beside[n];
    if (one == kOutside) continue;
    const std::vector<std::string> all = names.of(one, other, mesh.boundary[n].facet);
    known.insert(all.begin(), all.end());
    listed.insert(all.front());
  }
  for (const std::string& name : options.split_wall_names) {
    if (known.contains(name)) continue;
    std::string list;
    for (const std::string& other : listed) list += (list.empty() ? "" : ", ") + other;
    return {StatusCode::invalid_options,
            "no wall is called \"" + name + "\": there are " + (list.empty() ? "none" : list)};
  }
  return {};
}

void split_walls(const Options& options, const surface::MergedSurface& merged, Result& result) {
  if (options.split_walls == SplitWalls::none) return;
  std::int32_t label = 0;
  for (const auto& [known, name] : options.label_names) label = std::max(label, known);
  for (const std::int32_t known : merged.surface.labels) label = std::max(label, known);
  for (const auto& [triangle, known] : merged.further_labels) label = std::max(label, known);
  const auto facets = static_cast<std::uint32_t>(merged.surface.triangles.size());
  const Names names(options, merged, result.regions);
  for (auto& [name, number] : Splitter(names, result.mesh).run(label + 1, facets)) {
    result.wall_names.emplace(number, name);
  }
}

}  // namespace delmesher::results
