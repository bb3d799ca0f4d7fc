#include "mesher/cdt/chains.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "mesher/base/test_complaints.h"
#include "mesher/cdt/model_reference.h"
#include "mesher/cdt/test_models.h"

namespace delmesher::cdt {

// Breaks one invariant at a time, at an edge whose chain has the nodes end, a, b, end.
struct ChainsBreaker {
  Chains& chains;
  PointStore& points;
  std::uint32_t edge;

  std::uint32_t first() const { return chains.first_[edge]; }
  ChainNode& node(int place) const {
    std::uint32_t n = first();
    for (; place > 0; --place) n = chains.nodes_[n].next;
    return chains.nodes_[n];
  }
  std::uint32_t flat_edge() const {
    std::uint32_t e = 0;
    while (chains.topology_->edge_is_flat[e] == 0) ++e;
    return e;
  }

  void lose_the_chain() const { chains.first_[edge] = kNone; }
  void give_a_flat_edge_one() const { chains.first_[flat_edge()] = first(); }
  void lead_to_another_edge() const {
    node(1).edge = (edge + 1) % static_cast<std::uint32_t>(chains.topology_->edge_count());
  }
  void go_round() const { node(2).next = first(); }
  void lead_nowhere() const { node(2).next = static_cast<std::uint32_t>(chains.size()); }
  void skip_a_node() const { node(0).next = node(1).next; }
  void begin_inside() const { node(0).vertex = node(1).vertex; }
  void end_before_the_end() const { node(3).from = {0.99, 0.01}; }
  void exchange_vertices() const {
    std::swap(node(1).vertex, node(2).vertex);
    std::swap(chains.node_of_[node(1).vertex], chains.node_of_[node(2).vertex]);
  }
  void leave_the_edge() const {
    const Vec3 p = points.nearest(node(1).vertex);
    node(1).vertex = points.add_explicit(p[0], p[1] + 0x1p-40, p[2] + 0x1p-40);
  }
  void repeat_a_vertex() const { node(2).vertex = node(1).vertex; }
  void exchange_fractions() const { std::swap(node(1).from, node(2).from); }
  void let_a_fraction_fall() const { node(1).from = {0.75, 0.25}; }
  void claim_too_much() const { node(1).from[0] += 0x1p-20; }
  void forget_the_node() const { chains.node_of_[node(1).vertex] = kNone; }
  void find_an_end() const { chains.node_of_[node(0).vertex] = first(); }
  void count_too_many() const { ++chains.valence_[node(0).vertex]; }
};

namespace {

using namespace test_models;

class ChainsOfABox : public testing::Test {
 protected:
  // Two points on edge 0, at thirds of its length.
  ChainsOfABox() {
    while (model_.topology.edge_is_flat[edge_] != 0) ++edge_;
    const auto end = model_.topology.edge_vertices(edge_);
    model_.input.on_edge.resize(model_.topology.edge_count());
    model_.input.on_edge[edge_] = {model_.points.add_on_segment(end[1], end[0], 0.375),
                                   model_.points.add_on_segment(end[0], end[1], 0.375)};
  }

  std::string said_of(const Chains& chains) { return complaint_of(chains, model_.predicates); }

  Model model_{box(0, 1)};
  std::uint32_t edge_ = 0;
};

TEST_F(ChainsOfABox, GoFromEndToEnd) {
  const Chains chains(model_.input, model_.points);
  EXPECT_EQ(said_of(chains), "nothing");
  EXPECT_EQ(chains.size(), 2 * 12U + 2U);
  const auto end = model_.topology.edge_vertices(edge_);
  const std::vector<VertexId> vertices = chains.vertices(edge_);
  ASSERT_EQ(vertices.size(), 4U);
  EXPECT_EQ(vertices.front(), end[0]);
  EXPECT_EQ(vertices.back(), end[1]);
  EXPECT_EQ(chains.valence(end[0]), 3U);
  EXPECT_EQ(chains.valence(vertices[1]), 2U);
  EXPECT_EQ(chains.node_of(end[0]), kNone);
  const ChainNode& inside = chains.node(chains.node_of(vertices[1]));
  EXPECT_EQ(inside.vertex, vertices[1]);
  EXPECT_EQ(inside.from, (std::array<double, 2>{0.375, 0.625}));
}

TEST_F(ChainsOfABox, InsertionKeepsTheInvariants) {
  Chains chains(model_.input, model_.points);
  const auto end = model_.topology.edge_vertices(edge_);
  const std::uint32_t n = chains.first(edge_);
  const VertexId v = model_.points.add_on_segment(end[1], end[0], 0.25);
  const std::uint32_t m = chains.insert_after(n, v, {0.25, 0.75});
  EXPECT_EQ(chains.node(n).next, m);
  EXPECT_EQ(chains.vertices(edge_).size(), 5U);
  EXPECT_EQ(said_of(chains), "nothing");
}

TEST_F(ChainsOfABox, ValidateReportsEveryBrokenInvariant) {
  using Breaker = ChainsBreaker;
  const std::pair<void (Breaker::*)() const, const char*> cases[] = {
      {&Breaker::lose_the_chain, "or one without that is not flat"},
      {&Breaker::give_a_flat_edge_one, "a flat edge with a chain"},
      {&Breaker::lead_to_another_edge, "leads to another edge"},
      {&Breaker::go_round, "leads nowhere"},
      {&Breaker::lead_nowhere, "leads nowhere"},
      {&Breaker::skip_a_node, "in no chain"},
      {&Breaker::begin_inside, "does not join the ends"},
      {&Breaker::end_before_the_end, "elsewhere than at its end"},
      {&Breaker::exchange_vertices, "out of order"},
      {&Breaker::leave_the_edge, "off its edge"},
      {&Breaker::repeat_a_vertex, "out of order"},
      {&Breaker::exchange_fractions, "not monotone"},
      {&Breaker::let_a_fraction_fall, "not monotone"},
      {&Breaker::claim_too_much, "add up to 1"},
      {&Breaker::forget_the_node, "another node than its own"},
      {&Breaker::find_an_end, "another node than its own"},
      {&Breaker::count_too_many, "not the number of subsegments"},
  };
  expect_complaints(cases, [&](auto damage) {
    Chains chains(model_.input, model_.points);
    EXPECT_EQ(said_of(chains), "nothing");
    (Breaker{chains, model_.points, edge_}.*damage)();
    return said_of(chains);
  });
}

// Validation does not count.
TEST_F(ChainsOfABox, ValidateCountsNoPredicates) {
  const Chains chains(model_.input, model_.points);
  const std::uint64_t before = model_.predicates.counters.decided();
  chains.validate(model_.predicates);
  EXPECT_EQ(model_.predicates.counters.decided(), before);
}

}  // namespace
}  // namespace delmesher::cdt
