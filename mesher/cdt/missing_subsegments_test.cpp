#include "mesher/cdt/missing_subsegments.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "mesher/base/test_complaints.h"
#include "mesher/cdt/model_reference.h"
#include "mesher/cdt/subsegment_splitter.h"
#include "mesher/cdt/test_models.h"

namespace delmesher::cdt {

// Breaks one invariant at a time.
struct MissingSubsegmentsBreaker {
  MissingSubsegments& missing;
  const Chains& chains;

  void forget_one() const { missing.queue_.pop_front(); }
  void forget_all() const { missing.by_ends_ = {}; }
  void queue_a_last_node() const {
    std::uint32_t n = 0;
    while (chains.is_subsegment(n)) ++n;
    missing.queue_.push_back(n);
  }
  void queue_no_node() const {
    missing.queue_.push_back(static_cast<std::uint32_t>(chains.size()));
  }
  void find_another() const {
    const std::uint32_t n = missing.queue_.front();
    missing.by_ends_.set(pair_key(chains.node(n).vertex, chains.next(n).vertex), n + 1);
  }
  void not_find_one() const {
    const std::uint32_t n = missing.queue_.front();
    missing.by_ends_.erase(pair_key(chains.node(n).vertex, chains.next(n).vertex));
  }
};

namespace {

using namespace test_models;

// Long thin needles side by side: many of their edges are missing.
struct Recovery : Model {
  Tetrahedrization mesh{predicates};
  Chains chains;
  MissingSubsegments missing{mesh, chains};

  explicit Recovery(const Surface& given = needles(12, 1e-3, 5))
      : Model(given), chains(input, points) {
    mesh.build(input.vertices, control);
    missing.find_all(control);
  }
  // Those that are not edges, by brute force over all tetrahedra.
  std::vector<std::uint32_t> expected() const {
    std::set<std::uint64_t> edges;
    for (TetId t = 0; t < mesh.capacity(); ++t) {
      if (!mesh.alive(t)) continue;
      for (const auto& e : kEdge) {
        edges.insert(pair_key(mesh.vertex(t, e[0]), mesh.vertex(t, e[1])));
      }
    }
    std::vector<std::uint32_t> nodes;
    for (std::uint32_t n = 0; n < chains.size(); ++n) {
      if (!chains.is_subsegment(n)) continue;
      if (!edges.contains(pair_key(chains.node(n).vertex, chains.next(n).vertex))) {
        nodes.push_back(n);
      }
    }
    return nodes;
  }
  void split(std::uint32_t n) {
    SubsegmentSplitter splitter(chains, points, predicates);
    const VertexId a = chains.node(n).vertex;
    const std::uint32_t m = splitter.split(n, target_in_the_middle(chains.node(n), chains.next(n)));
    ASSERT_TRUE(mesh.insert(chains.node(m).vertex, mesh.incident(a)));
    missing.follow_split(n, m);
  }
  std::string said() const { return complaint_of(missing); }
};

TEST(MissingSubsegments, AllAreFoundInTheirOrder) {
  Recovery recovery;
  const std::vector<std::uint32_t> expected = recovery.expected();
  ASSERT_GT(expected.size(), 2U);
  EXPECT_EQ(recovery.said(), "nothing");
  for (const std::uint32_t n : expected) {
    ASSERT_FALSE(recovery.missing.empty());
    EXPECT_EQ(recovery.missing.take(), n);
  }
  EXPECT_TRUE(recovery.missing.empty());
}

TEST(MissingSubsegments, NoneIsMissingInABox) {
  const Recovery recovery(box(0, 1));
  EXPECT_TRUE(recovery.missing.empty());
  EXPECT_EQ(recovery.said(), "nothing");
}

// A split in the middle may destroy other subsegments, which wait then.
TEST(MissingSubsegments, WhatIsMissingWaitsAfterEverySplit) {
  Recovery recovery;
  std::size_t splits = 0;
  for (; !recovery.missing.empty() && splits < 400; ++splits) {
    const std::uint32_t n = recovery.missing.take();
    const VertexId a = recovery.chains.node(n).vertex, b = recovery.chains.next(n).vertex;
    if (find_edge(recovery.mesh, recovery.chains, a, b) == kNone) recovery.split(n);
    ASSERT_EQ(recovery.said(), "nothing");
  }
  EXPECT_GT(splits, 10U);
}

TEST(MissingSubsegments, ValidateReportsEveryBrokenInvariant) {
  using Breaker = MissingSubsegmentsBreaker;
  const std::pair<void (Breaker::*)() const, const char*> cases[] = {
      {&Breaker::forget_one, "a missing subsegment does not wait"},
      {&Breaker::forget_all, "none is found by its ends"},
      {&Breaker::queue_a_last_node, "names no subsegment"},
      {&Breaker::queue_no_node, "names no subsegment"},
      {&Breaker::find_another, "is not found by its ends"},
      {&Breaker::not_find_one, "is not found by its ends"},
  };
  expect_complaints(cases, [&](auto damage) {
    Recovery recovery;
    EXPECT_EQ(recovery.said(), "nothing");
    (Breaker{recovery.missing, recovery.chains}.*damage)();
    return recovery.said();
  });
}

}  // namespace
}  // namespace delmesher::cdt
