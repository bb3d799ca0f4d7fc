#include "mesher/tetmesh/mesh_topology.h"

#include <algorithm>
#include <tuple>

#include "mesher/base/check.h"
#include "mesher/base/face_key.h"

namespace delmesher::tetmesh {

MeshTopology::MeshTopology(std::vector<Tet> tetrahedra, std::span<const RegionId> region,
                           std::span<const SurfaceFace> boundary, std::size_t vertices)
    : tet_(std::move(tetrahedra)),
      neighbor_(tet_.size(), {kNone, kNone, kNone, kNone}),
      facet_(tet_.size(), {kNone, kNone, kNone, kNone}),
      region_(region.begin(), region.end()),
      incident_(vertices, kNone),
      mark_(tet_.size(), 0) {
  for (TetId t = 0; t < tet_.size(); ++t) {
    for (const VertexId v : tet_[t]) incident_[v] = t;
  }
  link(boundary);
}

// Faces are matched vertex by vertex: each is listed with its smallest one.
void MeshTopology::link(std::span<const SurfaceFace> boundary) {
  const std::size_t vertices = incident_.size();
  struct Entry {
    VertexId middle, largest;
    std::uint32_t side;  // kNone: a face of the surface, of this facet
    FacetId facet;
  };
  std::vector<std::uint32_t> begin(vertices + 1, 0);
  const auto face_of = [&](TetId t, int i) {
    const Tet& v = tet_[t];
    return undirected_face(v[kFace[i][0]], v[kFace[i][1]], v[kFace[i][2]]);
  };
  const auto key_of = [](const SurfaceFace& face) {
    return undirected_face(face.vertices[0], face.vertices[1], face.vertices[2]);
  };
  for (TetId t = 0; t < tet_.size(); ++t) {
    const Tet& v = tet_[t];
    for (const auto& [i, j, k] : kFace) ++begin[std::min({v[i], v[j], v[k]}) + 1];
  }
  for (const SurfaceFace& face : boundary) ++begin[key_of(face)[0] + 1];
  for (std::size_t v = 0; v < vertices; ++v) begin[v + 1] += begin[v];
  std::vector<Entry> entries(begin[vertices]);
  std::vector<std::uint32_t> fill(begin.begin(), begin.end() - 1);
  for (TetId t = 0; t < tet_.size(); ++t) {
    for (int i = 0; i < 4; ++i) {
      const auto [a, b, c] = face_of(t, i);
      entries[fill[a]++] = {b, c, 4 * t + static_cast<std::uint32_t>(i), kNone};
    }
  }
  for (const SurfaceFace& face : boundary) {
    const auto [a, b, c] = key_of(face);
    entries[fill[a]++] = {b, c, kNone, face.facet};
  }
  for (std::size_t v = 0; v < vertices; ++v) {
    const auto first = entries.begin() + begin[v], last = entries.begin() + begin[v + 1];
    std::sort(first, last, [](const Entry& a, const Entry& b) {
      return std::tie(a.middle, a.largest, a.side) < std::tie(b.middle, b.largest, b.side);
    });
    for (auto e = first; e != last;) {
      auto next = e + 1;
      while (next != last && next->middle == e->middle && next->largest == e->largest) ++next;
      const FacetId facet = (next - 1)->side == kNone ? (next - 1)->facet : kNone;
      const auto sides = (next - e) - (facet == kNone ? 0 : 1);
      DELMESHER_CHECK(sides == 1 || sides == 2,
                      "a face belongs to no tetrahedron, or to more than two");
      for (auto side = e; side != e + sides; ++side) {
        facet_[side->side / 4][side->side % 4] = facet;
        if (sides == 2) neighbor_[side->side / 4][side->side % 4] = (e + (side == e ? 1 : 0))->side;
      }
      e = next;
    }
  }
}

void MeshTopology::star(VertexId v, std::vector<TetId>& star) const {
  star.clear();
  next_epoch(epoch_, mark_);
  star.push_back(incident_[v]);
  mark_[star[0]] = epoch_;
  for (std::size_t n = 0; n < star.size(); ++n) {
    const TetId t = star[n];
    for (int i = 0; i < 4; ++i) {
      if (tet_[t][i] == v || neighbor_[t][i] == kNone) continue;
      const TetId u = neighbor_[t][i] >> 2U;
      if (mark_[u] == epoch_) continue;
      mark_[u] = epoch_;
      star.push_back(u);
    }
  }
}

std::vector<VertexId> MeshTopology::pinched() const {
  std::vector<std::uint32_t> degree(incident_.size(), 0);
  for (TetId t = 0; t < tet_.size(); ++t) {
    if (!alive(t)) continue;
    for (const VertexId v : tet_[t]) ++degree[v];
  }
  std::vector<VertexId> pinched;
  std::vector<TetId> around;
  for (VertexId v = 0; v < degree.size(); ++v) {
    if (degree[v] == 0) continue;
    star(v, around);
    if (around.size() < degree[v]) pinched.push_back(v);
  }
  return pinched;
}

void MeshTopology::contract(VertexId v, VertexId w, std::span<const TetId> star) {
  for (const TetId t : star) {
    const int i = index_of(t, v), j = index_of(t, w);
    if (j < 0) {
      tet_[t][i] = w;
      incident_[w] = t;
      continue;
    }
    // The faces opposite v and w become one.
    const std::uint32_t across_v = neighbor_[t][i], across_w = neighbor_[t][j];
    const FacetId facet = facet_[t][i] != kNone ? facet_[t][i] : facet_[t][j];
    for (const auto& [from, to] : {std::pair(across_v, across_w), std::pair(across_w, across_v)}) {
      if (from == kNone) continue;
      neighbor_[from / 4][from % 4] = to;
      facet_[from / 4][from % 4] = facet;
    }
    // The vertices of the face opposite v may have had this tetrahedron as theirs.
    for (int k = 0; k < 4; ++k) {
      if (k == i || incident_[tet_[t][k]] != t) continue;
      const std::uint32_t side = across_v != kNone ? across_v : across_w;
      DELMESHER_CHECK(side != kNone, "a tetrahedron that is alone at an edge was contracted");
      incident_[tet_[t][k]] = side / 4;
    }
    tet_[t][0] = kNone;
    free_.push_back(t);
  }
  incident_[v] = kNone;
}

TetId MeshTopology::take_slot() {
  if (!free_.empty()) {
    const TetId t = free_.back();
    free_.pop_back();
    return t;
  }
  const auto t = static_cast<TetId>(tet_.size());
  tet_.push_back({});
  neighbor_.push_back({});
  facet_.push_back({});
  region_.push_back(kOutside);
  mark_.push_back(0);
  return t;
}

void MeshTopology::join(const FaceEntry& a, const FaceEntry& b) {
  for (const auto& [from, to] : {std::pair(a.side, b.side), std::pair(b.side, a.side)}) {
    if (from != kNone) neighbor_[from / 4][from % 4] = to;
  }
}

void MeshTopology::replace(std::span<const TetId> removed, std::span<const CreatedTet> created,
                           std::span<const SurfaceFace> faces) {
  next_epoch(epoch_, mark_);
  for (const TetId t : removed) mark_[t] = epoch_;
  faces_.clear();
  for (const TetId t : removed) {
    for (int i = 0; i < 4; ++i) {
      const std::uint32_t across = neighbor_[t][i];
      if (across != kNone && mark_[across / 4] == epoch_) continue;
      const Tet& v = tet_[t];
      faces_.push_back({undirected_face(v[kFace[i][0]], v[kFace[i][1]], v[kFace[i][2]]), across,
                        facet_[t][i], false});
    }
  }
  const std::size_t outer = faces_.size();
  vertices_.clear();
  for (const TetId t : removed) {
    vertices_.insert(vertices_.end(), tet_[t].begin(), tet_[t].end());
    tet_[t][0] = kNone;
    free_.push_back(t);
  }
  created_.clear();
  for (const CreatedTet& tet : created) {
    const TetId t = take_slot();
    created_.push_back(t);
    tet_[t] = tet.vertices;
    neighbor_[t] = {kNone, kNone, kNone, kNone};
    facet_[t] = {kNone, kNone, kNone, kNone};
    region_[t] = tet.region;
    for (const VertexId v : tet.vertices) incident_[v] = t;
    for (int i = 0; i < 4; ++i) {
      const Tet& v = tet.vertices;
      faces_.push_back({undirected_face(v[kFace[i][0]], v[kFace[i][1]], v[kFace[i][2]]),
                        4 * t + static_cast<std::uint32_t>(i), kNone, true});
    }
  }
  // Vertices inside the cavity have no tetrahedra any more.
  for (const VertexId v : vertices_) {
    const TetId t = incident_[v];
    if (t != kNone && (!alive(t) || index_of(t, v) < 0)) incident_[v] = kNone;
  }
  std::sort(faces_.begin(), faces_.end(), [](const FaceEntry& a, const FaceEntry& b) {
    return std::tie(a.key, a.created) < std::tie(b.key, b.created);
  });
  DELMESHER_CHECK(outer <= faces_.size(), "fewer faces after a change than around it");
  for (std::size_t n = 0; n < faces_.size();) {
    const bool paired = n + 1 < faces_.size() && faces_[n + 1].key == faces_[n].key;
    const FaceEntry& first = faces_[n];
    FacetId facet = first.facet;
    for (const SurfaceFace& face : faces) {
      const auto& [a, b, c] = face.vertices;
      if (undirected_face(a, b, c) == first.key) facet = face.facet;
    }
    if (paired) join(first, faces_[n + 1]);
    for (std::size_t k = n; k < n + (paired ? 2 : 1); ++k) {
      if (faces_[k].side != kNone) facet_[faces_[k].side / 4][faces_[k].side % 4] = facet;
    }
    n += paired ? 2 : 1;
  }
}

void MeshTopology::validate() const {
  for (TetId t = 0; t < tet_.size(); ++t) {
    if (!alive(t)) continue;
    for (int i = 0; i < 4; ++i) {
      const std::uint32_t across = neighbor_[t][i];
      if (across == kNone) continue;
      const TetId u = across / 4;
      const int j = static_cast<int>(across % 4);
      DELMESHER_CHECK(alive(u), "a neighbour is dead");
      DELMESHER_CHECK(neighbor_[u][j] == 4 * t + static_cast<std::uint32_t>(i),
                      "neighbours do not name each other");
      const Tet &v = tet_[t], &w = tet_[u];
      DELMESHER_CHECK(undirected_face(v[kFace[i][0]], v[kFace[i][1]], v[kFace[i][2]]) ==
                          undirected_face(w[kFace[j][0]], w[kFace[j][1]], w[kFace[j][2]]),
                      "neighbours share another face");
      DELMESHER_CHECK(facet_[t][i] == facet_[u][j], "the two sides of a face name two facets");
      DELMESHER_CHECK(facet_[t][i] != kNone || region_[t] == region_[u],
                      "the region changes beside the surface");
    }
  }
  for (VertexId v = 0; v < incident_.size(); ++v) {
    const TetId t = incident_[v];
    DELMESHER_CHECK(t == kNone || (alive(t) && index_of(t, v) >= 0),
                    "incident() names a tetrahedron that is dead or not at its vertex");
  }
}

}  // namespace delmesher::tetmesh
