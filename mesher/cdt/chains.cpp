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

double distance_between(const PointStore& points, VertexId a, VertexId b) {
  return safe_distance(points.difference(a, b), {});
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
  DELMESHER_CHECK(v < valence_.size(), "a chain has a vertex that its tables are too short for");
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
  const double a = distance_between(points_, end[0], v), b = distance_between(points_, end[1], v);
  return {a / (a + b), b / (a + b)};
}

double Chains::length(std::uint32_t edge) const {
  const std::array<VertexId, 2> end = topology_->edge_vertices(edge);
  return distance_between(points_, end[0], end[1]);
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

void Chains::validate(Predicates& predicates) const {
  const PredicateCounters counters = predicates.counters;
  std::size_t in_chains = 0;
  for (std::uint32_t e = 0; e < topology_->edge_count(); ++e) in_chains += validate_chain(e);
  DELMESHER_CHECK(in_chains == nodes_.size(), "a node in no chain");
  for (const ChainNode& n : nodes_) {
    if (n.next == kNone) continue;
    validate_fractions(n);
    if (nodes_[n.next].next != kNone) validate_order(n, predicates);
  }
  validate_lookup();
  predicates.counters = counters;
}

// From end to end; gives the number of nodes.
std::size_t Chains::validate_chain(std::uint32_t edge) const {
  DELMESHER_CHECK((first_[edge] == kNone) == (topology_->edge_is_flat[edge] != 0),
                  "a flat edge with a chain, or one without that is not flat");
  if (first_[edge] == kNone) return 0;
  const std::array<VertexId, 2> end = topology_->edge_vertices(edge);
  std::size_t count = 0;
  std::uint32_t last = kNone;
  for (std::uint32_t n = first_[edge]; n != kNone; n = nodes_[n].next) {
    DELMESHER_CHECK(n < nodes_.size() && ++count <= nodes_.size(), "a chain leads nowhere");
    DELMESHER_CHECK(nodes_[n].edge == edge, "a chain leads to another edge");
    last = n;
  }
  DELMESHER_CHECK(
      count >= 2 && nodes_[first_[edge]].vertex == end[0] && nodes_[last].vertex == end[1],
      "a chain that does not join the ends of its edge");
  DELMESHER_CHECK(nodes_[first_[edge]].from == (std::array<double, 2>{0, 1}) &&
                      nodes_[last].from == (std::array<double, 2>{1, 0}),
                  "an end of an edge elsewhere than at its end");
  return count;
}

// The node behind n must lie on the edge, strictly between its neighbours.
void Chains::validate_order(const ChainNode& n, Predicates& predicates) const {
  const ChainNode& v = nodes_[n.next];
  const std::array<VertexId, 2> end = topology_->edge_vertices(n.edge);
  for (int axis = 0; axis < 3; ++axis) {
    DELMESHER_CHECK(predicates.orient2d(axis, end[0], end[1], v.vertex) == 0,
                    "a vertex of a chain off its edge");
  }
  DELMESHER_CHECK(predicates.dot_sign(n.vertex, v.vertex, nodes_[v.next].vertex) < 0,
                  "a vertex of a chain out of order");
}

// The fractions of a point have its parameter's 53 bits, the point itself may have more.
void Chains::validate_fractions(const ChainNode& n) const {
  constexpr double kRounding = 0x1p-52;
  const ChainNode& next = nodes_[n.next];
  DELMESHER_CHECK(std::abs(n.from[0] + n.from[1] - 1) <= kRounding,
                  "fractions that do not add up to 1");
  DELMESHER_CHECK(next.from[0] >= n.from[0] - kRounding && next.from[1] <= n.from[1] + kRounding,
                  "fractions that are not monotone");
}

void Chains::validate_lookup() const {
  std::vector<std::uint32_t> valence(valence_.size(), 0), inside(node_of_.size(), kNone);
  for (std::uint32_t n = 0; n < nodes_.size(); ++n) {
    const ChainNode& node = nodes_[n];
    if (node.next != kNone) {
      ++valence[node.vertex];
      ++valence[nodes_[node.next].vertex];
    }
    if (node.next != kNone && n != first_[node.edge]) inside[node.vertex] = n;
  }
  DELMESHER_CHECK(inside == node_of_, "a vertex is found at another node than its own");
  DELMESHER_CHECK(valence == valence_, "a valence that is not the number of subsegments");
}

TetId find_edge(Tetrahedrization& mesh, const Chains& chains, VertexId a, VertexId b) {
  if (chains.valence(b) < chains.valence(a)) std::swap(a, b);
  return mesh.find_edge(a, b);
}

FaceHandle find_face(Tetrahedrization& mesh, const Chains& chains, std::array<VertexId, 3> face) {
  std::sort(face.begin(), face.end(), [&](VertexId a, VertexId b) {
    const std::uint32_t x = chains.valence(a), y = chains.valence(b);
    return x != y ? x < y : a < b;
  });
  return mesh.find_face(face[0], face[1], face[2]);
}

}  // namespace delmesher::cdt
