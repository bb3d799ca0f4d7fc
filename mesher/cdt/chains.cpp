#include "mesher/cdt/chains.h"

#include <algorithm>
#include <cmath>

#include "mesher/base/check.h"

namespace delmesher::cdt {

double safe_distance(const Vec3& a, const Vec3& b) {
  const Vec3 d = {std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])};
  const double m = std::max({d[0], d[1], d[2]});
  if (m == 0) return 0;
  const double x = d[0] / m, y = d[1] / m, z = d[2] / m;
  return m * std::sqrt(x * x + y * y + z * z);
}

Chains::Chains(const CdtInput& input, const PointStore& points)
    : topology_(input.topology),
      points_(points),
      first_(input.topology->edge_count(), kNone),
      node_of_(points.size(), kNone),
      valence_(points.size(), 0) {
  for (std::uint32_t e = 0; e < topology_->edge_count(); ++e) {
    if (topology_->edge_is_flat[e] != 0) continue;
    const std::array<VertexId, 2> end = topology_->edge_vertices(e);
    first_[e] = static_cast<std::uint32_t>(nodes_.size());
    append(e, end[0], {0, 1});
    if (e < input.on_edge.size()) {
      for (const VertexId v : input.on_edge[e]) append(e, v, fractions(e, v));
    }
    append(e, end[1], {1, 0});
    nodes_.back().next = kNone;
  }
}

void Chains::append(std::uint32_t edge, VertexId v, const std::array<double, 2>& from) {
  const auto n = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back({v, edge, n + 1, from});
  count(v, n, from[0] != 0 && from[1] != 0);
}

void Chains::count(VertexId v, std::uint32_t node, bool inside) {
  DELMESHER_CHECK(v < valence_.size(), "chain vertex out of range");
  valence_[v] += inside ? 2 : 1;
  if (inside) node_of_[v] = node;
}

// Exact from the end at which the point's definition is anchored.
std::array<double, 2> Chains::fractions(std::uint32_t edge, VertexId v) const {
  const std::array<VertexId, 2> end = topology_->edge_vertices(edge);
  const PointDefinition& d = points_.definition(v);
  if (d.kind == PointKind::on_segment) {
    if (d.corner[0] == end[1] && d.corner[1] == end[0]) return {d.u, 1 - d.u};
    if (d.corner[0] == end[0] && d.corner[1] == end[1]) return {1 - d.u, d.u};
  }
  const Vec3 p = points_.nearest(v);
  const double a = safe_distance(p, points_.nearest(end[0])),
               b = safe_distance(p, points_.nearest(end[1]));
  return {a / (a + b), b / (a + b)};
}

double Chains::length(std::uint32_t edge) const {
  const std::array<VertexId, 2> end = topology_->edge_vertices(edge);
  return safe_distance(points_.nearest(end[0]), points_.nearest(end[1]));
}

std::vector<VertexId> Chains::vertices(std::uint32_t edge) const {
  std::vector<VertexId> result;
  for (std::uint32_t n = first_[edge]; n != kNone; n = nodes_[n].next) {
    result.push_back(nodes_[n].vertex);
  }
  return result;
}

std::uint32_t Chains::insert_after(std::uint32_t n, VertexId v, const std::array<double, 2>& from) {
  const auto m = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back({v, nodes_[n].edge, nodes_[n].next, from});
  nodes_[n].next = m;
  if (v >= valence_.size()) {
    valence_.resize(std::size_t{v} + 1, 0);
    node_of_.resize(std::size_t{v} + 1, kNone);
  }
  count(v, m, true);
  return m;
}

TetId find_edge(Tetrahedrization& mesh, const Chains& chains, VertexId a, VertexId b) {
  if (chains.valence(b) < chains.valence(a)) std::swap(a, b);
  return mesh.find_edge(a, b);
}

std::uint32_t find_face(Tetrahedrization& mesh, const Chains& chains,
                        std::array<VertexId, 3> face) {
  std::sort(face.begin(), face.end(), [&](VertexId a, VertexId b) {
    const std::uint32_t x = chains.valence(a), y = chains.valence(b);
    return x != y ? x < y : a < b;
  });
  return mesh.find_face(face[0], face[1], face[2]);
}

}  // namespace delmesher::cdt
