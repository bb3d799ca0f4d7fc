#include "oracles/mesh/split_walls.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>

#include "oracles/base/union_find.h"

namespace tetproof::oracles {
namespace {

// A triangle of the input by its corners, of which the first one given counts.
struct Given {
  Face corners;
  std::vector<std::int32_t> labels;  // ascending
};
using GivenTriangles = std::map<Face, Given>;

// The first vertex of the input at each place.
std::map<Position, Index> places_of(const Polyhedron& input) {
  std::map<Position, Index> first;
  for (Index v = 0; v < input.vertices.size(); ++v) first.try_emplace(input.vertices[v], v);
  return first;
}

GivenTriangles triangles_of(const Polyhedron& input, const std::map<Position, Index>& first) {
  GivenTriangles triangles;
  for (std::size_t t = 0; t < input.triangles.size(); ++t) {
    Face corners;
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] = first.at(input.vertices[input.triangles[t][k]]);
    }
    Face key = corners;
    sort_face(key);
    Given& given = triangles.try_emplace(key, Given{corners, {}}).first->second;
    given.labels.push_back(input.labels.empty() ? 0 : input.labels[t]);
    std::ranges::sort(given.labels);
  }
  return triangles;
}

class SplitWalls {
 public:
  SplitWalls(const Polyhedron& input, const MeshFile& mesh, const MergedMesh& merged,
             const TetComplex& complex, const Neighbours& neighbours, const PartsResult& parts,
             const Promise& promise)
      : input_(input),
        mesh_(mesh),
        merged_(merged),
        complex_(complex),
        neighbours_(neighbours),
        parts_(parts),
        promise_(promise),
        sets_(4 * complex.tetrahedra.size()) {}

  OracleReport run() {
    find_triangles();
    connect();
    report_.checked = walls_.size();
    check_vertices();
    if (!mesh_.boundary.empty()) check_list();
    for (const std::string& name : promise_.split_wall_names) {
      if (!found_.contains(name)) report_.fail("no wall is called \"" + name + "\"");
    }
    return std::move(report_);
  }

 private:
  struct Wall {
    Index one, other;  // faces, as of Neighbours
    const Given* given;
    const PartsResult::Piece* piece;  // null: the whole triangle
  };

  void find_triangles() {
    first_ = places_of(input_);
    triangles_ = triangles_of(input_, first_);
    for (const Position& p : merged_.mesh.vertices) {
      const auto found = first_.find(p);
      given_.push_back(found == first_.end() ? kNone : found->second);
    }
  }
  const PartsResult::Piece* piece(const Face& face) const {
    const auto found = parts_.pieces.find(sorted(face));
    return found == parts_.pieces.end() ? nullptr : &found->second;
  }
  const Given* triangle(const PartsResult::Piece& piece) const {
    Face key = input_.triangles[piece.given];
    for (Index& v : key) v = first_.at(input_.vertices[v]);
    return &triangles_.at(sorted(key));
  }
  const Given* triangle(const Face& face) const {
    Face key;
    for (std::size_t k = 0; k < 3; ++k) key[k] = given_[face[k] - complex_.first_vertex];
    if (std::ranges::count(key, kNone) > 0) return nullptr;
    sort_face(key);
    const auto found = triangles_.find(key);
    return found == triangles_.end() ? nullptr : &found->second;
  }

  std::string label_name(std::int32_t label) const {
    const auto known = input_.names.find({2, label});
    return known != input_.names.end() ? known->second : "label " + std::to_string(label);
  }
  std::string region_name(Index tet) const {
    const std::string& known = parts_.called.at(parts_.part[tet]);
    if (!known.empty() || mesh_.regions.empty()) return known;
    return "region " + std::to_string(mesh_.regions[tet]);
  }
  bool is_sheet(const Wall& wall) const {
    return parts_.part[wall.one / 4] == parts_.part[wall.other / 4];
  }
  bool is_chosen(const Wall& wall) {
    if (promise_.split_walls == Promise::Split::all) return true;
    std::vector<std::string> names;
    for (const std::int32_t label : wall.given->labels) names.push_back(label_name(label));
    if (!is_sheet(wall)) {
      const std::string a = region_name(wall.one / 4), b = region_name(wall.other / 4);
      names.push_back(a + "|" + b);
      names.push_back(b + "|" + a);
    }
    bool chosen = false;
    for (const std::string& name : names) {
      if (std::ranges::count(promise_.split_wall_names, name) == 0) continue;
      found_.insert(name);
      chosen = true;
    }
    return chosen;
  }

  void connect() {
    for (Index face = 0; face < neighbours_.across.size(); ++face) {
      const Index other = neighbours_.across[face];
      if (other == kNone || other < face) continue;
      const Tet &t = complex_.tetrahedra[face / 4], &u = complex_.tetrahedra[other / 4];
      const Face corners = face_of(t, static_cast<int>(face % 4));
      const PartsResult::Piece* piece = this->piece(corners);
      const Wall wall = {face, other, piece != nullptr ? triangle(*piece) : triangle(corners),
                         piece};
      if (wall.given != nullptr && is_chosen(wall)) {
        walls_.push_back(wall);
        continue;
      }
      for (Index k = 0; k < 4; ++k) {
        for (Index l = 0; l < 4; ++l) {
          if (t[k] == u[l]) sets_.unite(4 * (face / 4) + k, 4 * (other / 4) + l);
        }
      }
    }
  }

  // The vertex of the file at a corner.
  Index vertex(Index tet, Index corner) const {
    for (const Index v : mesh_.tetrahedra[tet]) {
      if (merged_.place[v] + complex_.first_vertex == corner) return v;
    }
    return kNone;
  }
  Index vertex_at(Index place) const {
    return vertex(place / 4, complex_.tetrahedra[place / 4][place % 4]);
  }
  // A face as the file has it, counter-clockwise seen from outside its tetrahedron.
  Face side(Index face) const {
    const Tet& tet = complex_.tetrahedra[face / 4];
    Face corners = face_of(tet, static_cast<int>(face % 4));
    for (Index& v : corners) v = vertex(face / 4, v);
    return corners;
  }
  static Face sorted(Face face) {
    sort_face(face);
    return face;
  }

  void check_vertices() {
    const auto name = [](Index v) { return "vertex " + std::to_string(v); };
    std::vector<std::uint8_t> used(mesh_.vertices.size(), 0);
    std::map<Index, Index> of_set;
    std::map<Index, std::set<Index>> at_place, sets_at;
    for (Index place = 0; place < sets_.size(); ++place) {
      const Index v = vertex_at(place);
      used[v] = 1;
      at_place[merged_.place[v]].insert(v);
      const Index first = of_set.try_emplace(sets_.find(place), v).first->second;
      if (first != v) {
        report_.fail(name(first) + " and " + name(v) +
                     " are at the same place, and no chosen wall is between them");
      }
    }
    for (Index v = 0; v < used.size(); ++v) {
      if (used[v] == 0) report_.fail(name(v) + " is of no tetrahedron");
    }
    for (const Wall& wall : walls_) {
      for (const Index face : {wall.one, wall.other}) {
        for (Index k = 0; k < 4; ++k) {
          if (k == face % 4) continue;
          const Index place = face - face % 4 + k;
          sets_at[merged_.place[vertex_at(place)]].insert(sets_.find(place));
        }
      }
    }
    for (const auto& [place, vertices] : at_place) {
      const auto found = sets_at.find(place);
      if (found == sets_at.end()) {
        if (vertices.size() > 1) {
          report_.fail(name(*vertices.rbegin()) + " is where another one is, on no chosen wall");
        }
        continue;
      }
      std::set<Index> apart;
      for (const Index set : found->second) apart.insert(of_set.at(set));
      if (apart.size() != found->second.size() || apart != vertices) {
        report_.fail("at the place of " + name(*vertices.begin()) + " are " +
                     std::to_string(vertices.size()) + " vertices, and walls part " +
                     std::to_string(found->second.size()) + " sides");
      }
    }
  }

  // What the set of a side is called; front: that seen counter-clockwise as given.
  std::string side_name(const Wall& wall, Index here, Index there) const {
    if (!is_sheet(wall)) return region_name(here / 4) + "|" + region_name(there / 4);
    Face outward = face_of(complex_.tetrahedra[here / 4], static_cast<int>(here % 4));
    Face given = wall.given->corners;
    if (wall.piece != nullptr) {
      given = wall.piece->corners;
    } else {
      for (Index& v : outward) v = given_[v - complex_.first_vertex];
    }
    const bool behind = sort_face(outward) == sort_face(given);
    return label_name(wall.given->labels.front()) + (behind ? "|back" : "|front");
  }

  void check_list() {
    const auto name = [](std::size_t n) { return "listed triangle " + std::to_string(n); };
    std::set<Face> faces;
    for (Index face = 0; face < neighbours_.across.size(); ++face) faces.insert(sorted(side(face)));
    std::map<Face, std::vector<std::size_t>> listed;
    for (std::size_t n = 0; n < mesh_.boundary.size(); ++n) {
      const Face key = sorted(mesh_.boundary[n]);
      listed[key].push_back(n);
      if (!faces.contains(key)) report_.fail(name(n) + " is a face of no tetrahedron");
    }
    const bool named = mesh_.has_names && input_.names_read && !promise_.names;
    for (const Wall& wall : walls_) {
      const bool parts = sorted(side(wall.one)) != sorted(side(wall.other));
      for (const auto& [here, there] :
           {std::pair(wall.one, wall.other), std::pair(wall.other, wall.one)}) {
        Face outward = side(here);
        const bool even = sort_face(outward);
        const auto found = listed.find(outward);
        if (found == listed.end() || found->second.size() != 1) {
          report_.fail("a side of a wall of " + complex_.tet_name(here / 4) +
                       " is not listed once");
          continue;
        }
        if (!parts) continue;
        const std::size_t n = found->second.front();
        Face face = mesh_.boundary[n];
        if (sort_face(face) != even) report_.fail(name(n) + " is seen from within its side");
        if (!named || n >= mesh_.labels.size()) continue;
        const auto known = mesh_.names.find({2, mesh_.labels[n]});
        const std::string wanted = side_name(wall, here, there);
        if (known == mesh_.names.end() || !is_called(known->second, wanted)) {
          report_.fail(name(n) + " is not of the set \"" + wanted + "\"");
        }
      }
    }
  }

  const Polyhedron& input_;
  const MeshFile& mesh_;
  const MergedMesh& merged_;
  const TetComplex& complex_;
  const Neighbours& neighbours_;
  const PartsResult& parts_;
  const Promise& promise_;
  std::map<Position, Index> first_;
  GivenTriangles triangles_;
  std::vector<Index> given_;  // per vertex of the merged mesh that of the input, or kNone
  UnionFind sets_;            // of corners k of tetrahedra t, as 4 t + k
  std::vector<Wall> walls_;
  std::set<std::string> found_;  // of the names promised
  OracleReport report_{"split-walls", "triangles of walls"};
};

}  // namespace

MergedMesh merge_places(const Polyhedron& input, const MeshFile& mesh) {
  MergedMesh merged{mesh, {}};
  std::map<Position, Index> number;
  merged.mesh.vertices.clear();
  for (const Position& p : mesh.vertices) {
    const auto next = static_cast<Index>(merged.mesh.vertices.size());
    const auto [at, fresh] = number.try_emplace(p, next);
    if (fresh) merged.mesh.vertices.push_back(p);
    merged.place.push_back(at->second);
  }
  const auto place = [&](Index v) { return v < merged.place.size() ? merged.place[v] : v; };
  for (Tet& tet : merged.mesh.tetrahedra) {
    for (Index& v : tet) v = place(v);
  }
  for (MeshFile::EdgeNode& node : merged.mesh.edge_nodes) {
    for (Index& v : node.ends) v = place(v);
  }
  const std::map<Position, Index> first = places_of(input);
  const GivenTriangles triangles = triangles_of(input, first);
  MeshFile& list = merged.mesh;
  std::map<Face, std::pair<Face, std::size_t>> known;  // by place: as listed first, and where
  list.boundary.clear();
  list.labels.clear();
  list.facets.clear();
  for (std::size_t n = 0; n < mesh.boundary.size(); ++n) {
    Face as_listed = mesh.boundary[n], face = as_listed;
    for (Index& v : face) v = place(v);
    Face key = face;
    sort_face(key);
    sort_face(as_listed);
    const auto [at, fresh] = known.try_emplace(key, as_listed, list.boundary.size());
    if (!fresh && at->second.first != as_listed) {
      const std::size_t before = at->second.second;
      if (before >= list.labels.size()) continue;
      Face corners = key;
      for (Index& v : corners) {
        const auto found = v < list.vertices.size() ? first.find(list.vertices[v]) : first.end();
        v = found == first.end() ? kNone : found->second;
      }
      sort_face(corners);
      const auto found = triangles.find(corners);
      if (found != triangles.end()) list.labels[before] = found->second.labels.front();
      continue;
    }
    list.boundary.push_back(face);
    if (n < mesh.labels.size()) list.labels.push_back(mesh.labels[n]);
    if (n < mesh.facets.size()) list.facets.push_back(mesh.facets[n]);
  }
  return merged;
}

OracleReport check_split_walls(const Polyhedron& input, const MeshFile& mesh,
                               const MergedMesh& merged, const TetComplex& complex,
                               const Neighbours& neighbours, const PartsResult& parts,
                               const Promise& promise) {
  return SplitWalls(input, mesh, merged, complex, neighbours, parts, promise).run();
}

}  // namespace tetproof::oracles
