#include "mesher/io/named_sets.h"

#include <algorithm>
#include <numeric>
#include <set>

#include "mesher/io/text.h"

namespace delmesher::io {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

// The faces of a positive tetrahedron, by the corner that each of them lacks; counter-clockwise
// seen from outside.
constexpr std::array<std::array<std::size_t, 3>, 4> kFaces = {
    {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

Triangle sorted(Triangle t) {
  std::sort(t.begin(), t.end());
  return t;
}

bool is_even(const Triangle& t) {
  return (t[0] < t[1]) == ((t[1] < t[2]) == (t[0] < t[2]));
}

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

// The ends of the edges, in the order of CellNodes.
constexpr std::array<std::array<std::size_t, 2>, 6> kEdges = {
    {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}}};

// In one line.
std::string name_of(const LabelNames& names, std::int32_t number, const char* unnamed) {
  const auto found = names.find(number);
  if (found == names.end()) return unnamed + std::to_string(number);
  std::string name = found->second;
  for (char& c : name) {
    if (static_cast<unsigned char>(c) < ' ' || c == '\x7f') c = ' ';
  }
  return name;
}

template <class Cell>
CellNodes nodes_of(const Cell& cell, std::size_t edges, const EdgeNodes* edge_nodes) {
  CellNodes nodes;
  for (const std::uint32_t v : cell) nodes.add(v);
  for (std::size_t e = 0; edge_nodes != nullptr && e < edges; ++e) {
    nodes.add(edge_nodes->number(cell[kEdges[e][0]], cell[kEdges[e][1]]));
  }
  return nodes;
}

}  // namespace

CellNodes NamedMesh::tetrahedron(std::size_t i) const {
  return nodes_of(mesh.tetrahedra[i], 6, edge_nodes);
}

CellNodes NamedMesh::triangle(std::size_t i) const {
  return nodes_of(mesh.boundary[i], 3, edge_nodes);
}

std::int32_t region(const TetMesh& mesh, std::size_t tet) {
  if (!mesh.regions.empty()) return mesh.regions[tet];
  return mesh.inside[tet] != 0 ? kRegionInside : kRegionOutside;
}

Members tetrahedra_of_regions(const TetMesh& mesh) {
  Members tetrahedra;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    tetrahedra[region(mesh, t)].push_back(t);
  }
  return tetrahedra;
}

Members triangles_of_labels(const TetMesh& mesh) {
  Members triangles;
  for (std::size_t t = 0; t < mesh.boundary.size(); ++t) {
    triangles[mesh.boundary_labels[t]].push_back(t);
  }
  return triangles;
}

std::string region_name(const NamedMesh& named, std::int32_t region) {
  if (!named.mesh.regions.empty()) return name_of(named.region_names, region, "region ");
  return region == kRegionInside ? "inside" : "outside";
}

std::string label_name(const LabelNames& names, std::int32_t label) {
  return name_of(names, label, "label ");
}

std::vector<GivenName> given_names(const NamedMesh& named) {
  std::vector<GivenName> given;
  for (const auto& [label, triangles] : triangles_of_labels(named.mesh)) {
    if (named.names.contains(label)) given.push_back({label, 2, label_name(named.names, label)});
  }
  for (const auto& [number, tetrahedra] : tetrahedra_of_regions(named.mesh)) {
    if (!named.mesh.regions.empty() && named.region_names.contains(number)) {
      given.push_back({number, 3, region_name(named, number)});
    }
  }
  return given;
}

LabelNames distinct_names(LabelNames names) {
  std::set<std::string> given, used;
  for (auto& [number, name] : names) given.insert(name = as_utf8(name));
  std::map<std::string, int> next;  // number of a name
  for (auto& [number, name] : names) {
    const std::string first = name;
    int& last = next.try_emplace(first, 1).first->second;
    while (!used.insert(name).second) {
      do {
        name = first + " " + std::to_string(++last);
      } while (given.contains(name));
    }
  }
  return names;
}

std::string Identifiers::make(const std::string& name) {
  constexpr std::size_t kLongest = 60;  // Abaqus allows 80 characters, and a number may follow
  std::string id;
  for (const char c : name.substr(0, kLongest)) {
    const char small = lower(c);
    id += (small >= 'a' && small <= 'z') || (c >= '0' && c <= '9') ? c : '_';
  }
  if (id.empty() || lower(id[0]) < 'a' || lower(id[0]) > 'z') id = "set_" + id;
  const auto key = [](std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), lower);
    return text;
  };
  std::string free = id;
  for (int& next = used_.try_emplace(key(id), 0).first->second; next > 0; ++next) {
    free = id + "_" + std::to_string(next + 1);
    if (used_.try_emplace(key(free), 1).second) break;
  }
  used_[key(free)] = std::max(used_[key(free)], 1);
  return free;
}

std::vector<TriangleSides> sides_of_boundary(const TetMesh& mesh) {
  std::vector<std::size_t> order(mesh.boundary.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::vector<Triangle> keys(order.size());
  std::vector<bool> on_boundary(mesh.vertices.size());
  for (std::size_t i = 0; i < keys.size(); ++i) {
    keys[i] = sorted(mesh.boundary[i]);
    for (const std::uint32_t v : keys[i]) on_boundary[v] = true;
  }
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return keys[a] < keys[b]; });
  std::vector<TriangleSides> sides(order.size());
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const auto& corners = mesh.tetrahedra[t];
    for (std::size_t apex = 0; apex < 4; ++apex) {
      Triangle face;
      for (std::size_t k = 0; k < 3; ++k) face[k] = corners[kFaces[apex][k]];
      if (!on_boundary[face[0]] || !on_boundary[face[1]] || !on_boundary[face[2]]) continue;
      const Triangle key = sorted(face);
      auto found = std::lower_bound(order.begin(), order.end(), key,
                                    [&](std::size_t i, const Triangle& k) { return keys[i] < k; });
      for (; found != order.end() && keys[*found] == key; ++found) {
        const bool behind = is_even(face) == is_even(mesh.boundary[*found]);
        auto& both = sides[*found].sides;
        TriangleSides::Side& wanted = both[behind ? 0 : 1];
        // Tetrahedra that rounding has inverted may both seem to be on one side.
        TriangleSides::Side& side =
            wanted.apex == TriangleSides::kNone ? wanted : both[behind ? 1 : 0];
        side = {t, static_cast<int>(apex)};
      }
    }
  }
  return sides;
}

}  // namespace delmesher::io
