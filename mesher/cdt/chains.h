// The chains of vertices that subdivide the input's constrained edges.
//
// Invariants at any time:
//  - every edge that is not flat has one chain, from its smaller end vertex to its larger one, and
//    no other edge has any; every node is in the chain of its edge;
//  - the vertices of a chain lie exactly on its edge, each strictly between its neighbours;
//  - the two fractions of a node at an end are exactly 0 and 1. From node to node towards end 1,
//    the fraction from end 0 does not fall and that from end 1 does not grow; both may be wrong by
//    the rounding of 1;
//  - a vertex strictly inside an edge is found by node_of(), and no other vertex is;
//  - the valence of a vertex is the number of the subsegments that end there.
// Whether subsegments are edges of the tetrahedrization is checked by validate_segments().
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mesher/cdt/cdt.h"

namespace delmesher::cdt {

// A vertex of a chain. The position along the edge is kept as a fraction of its length from either
// end, because near an end only the fraction from that end is accurate.
struct ChainNode {
  VertexId vertex;
  std::uint32_t edge;
  std::uint32_t next;          // towards the edge's larger end vertex; kNone at the end
  std::array<double, 2> from;  // fraction from end 0 (smaller vertex) and from end 1
};

// Per constrained edge a linked list of nodes; the subsegment from a node to its next is named by
// the node.
class Chains {
 public:
  explicit Chains(const CdtInput& input, const PointStore& points);

  const SurfaceTopology& topology() const { return *topology_; }
  std::size_t size() const { return nodes_.size(); }
  const ChainNode& node(std::uint32_t n) const { return nodes_[n]; }
  bool is_subsegment(std::uint32_t n) const { return nodes_[n].next != kNone; }
  const ChainNode& next(std::uint32_t n) const { return nodes_[nodes_[n].next]; }
  // First node of an edge's chain, kNone for flat edges.
  std::uint32_t first(std::uint32_t edge) const { return first_[edge]; }
  // The node of a vertex strictly inside an edge, kNone for other vertices.
  std::uint32_t node_of(VertexId v) const { return v < node_of_.size() ? node_of_[v] : kNone; }
  // Number of subsegments at a vertex.
  std::uint32_t valence(VertexId v) const { return v < valence_.size() ? valence_[v] : 0; }
  double length(std::uint32_t edge) const;
  // Vertices of an edge's chain from end to end.
  std::vector<VertexId> vertices(std::uint32_t edge) const;

  // Inserts v, at the given fractions, after node n; returns its node.
  std::uint32_t insert_after(std::uint32_t n, VertexId v, const std::array<double, 2>& from);

  // Throws InternalError at the first broken invariant. A few predicates per node, which are not
  // counted.
  void validate(Predicates& predicates) const;

 private:
  friend struct ChainsBreaker;  // of the tests of validate()

  void append(std::uint32_t edge, VertexId v, const std::array<double, 2>& from);
  void count(VertexId v, std::uint32_t node, bool inside);
  std::array<double, 2> fractions(std::uint32_t edge, VertexId v) const;
  std::size_t validate_chain(std::uint32_t edge) const;
  void validate_order(const ChainNode& n, Predicates& predicates) const;
  void validate_fractions(const ChainNode& n) const;
  void validate_lookup() const;

  const SurfaceTopology* topology_;
  const PointStore& points_;
  std::vector<ChainNode> nodes_;
  std::vector<std::uint32_t> first_, node_of_, valence_;
};

// As Tetrahedrization::find_edge and find_face. The search is around the vertex with the fewest
// subsegments, so that hubs with thousands of tetrahedra are not visited once per facet.
TetId find_edge(Tetrahedrization& mesh, const Chains& chains, VertexId a, VertexId b);
FaceHandle find_face(Tetrahedrization& mesh, const Chains& chains, std::array<VertexId, 3> face);

// Distance of two points given by their coordinates, without overflow or underflow of squares.
double safe_distance(const Vec3& a, const Vec3& b);
// Distance of two points, also if their nearest doubles are the same.
double distance_between(const PointStore& points, VertexId a, VertexId b);

}  // namespace delmesher::cdt
