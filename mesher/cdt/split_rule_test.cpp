#include "mesher/cdt/split_rule.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mesher/cdt/model_reference.h"
#include "mesher/cdt/test_models.h"
#include "mesher/geometry/vector.h"

namespace delmesher::cdt {
namespace {

using namespace test_models;

// A thin spike: its edges 0-1, 0-2 and 0-3 leave the apex 0 within a few degrees.
Surface spike() {
  Surface s;
  s.vertices = {{0, 0, 0}, {16, 0, 0}, {16, 1, 0}, {15, 0, 1}};
  s.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  return s;
}

class Splitting : public testing::Test {
 protected:
  std::uint32_t edge(VertexId a, VertexId b) const {
    for (std::uint32_t e = 0; e < model_.topology.edge_count(); ++e) {
      if (model_.topology.edge_vertices(e) == std::array<VertexId, 2>{a, b}) return e;
    }
    return kNone;
  }
  VertexId split(std::uint32_t node, const SplitTarget& target) {
    SubsegmentSplitter splitter(chains_, model_.points, model_.predicates);
    return chains_.node(splitter.split(node, target)).vertex;
  }
  double from_apex(VertexId v) const { return norm(model_.points.nearest(v)); }

  Model model_{spike()};
  Chains chains_{model_.input, model_.points};
};

TEST_F(Splitting, PointsLieOnTheEdgeAndKnowItsFacets) {
  const std::uint32_t e = edge(0, 2), n = chains_.first(e);
  const SplitTarget third = target_behind(chains_.node(n), chains_.next(n), 1.0 / 3);
  const VertexId v = split(n, third);
  EXPECT_EQ(model_.predicates.dot_sign(0, v, 2), -1);
  EXPECT_NEAR(from_apex(v), std::sqrt(257.0) / 3, 1e-4);
  EXPECT_EQ(model_.points.lines(v).size(), 1U);
  EXPECT_EQ(model_.points.planes(v).size(), 2U);
  EXPECT_EQ(chains_.vertices(e), (std::vector<VertexId>{0, v, 2}));
  // The node's fractions are those of the point itself.
  const ChainNode& node = chains_.node(chains_.node_of(v));
  EXPECT_EQ(node.from[0] + node.from[1], 1.0);
  EXPECT_NEAR(node.from[0] * 16, model_.points.nearest(v)[0], 1e-14);
}

TEST_F(Splitting, ATargetOutsideThePartMeansItsMiddle) {
  const std::uint32_t n = chains_.first(edge(0, 1));
  const VertexId half = split(n, target_in_the_middle(chains_.node(n), chains_.next(n)));
  SplitTarget beyond = target_in_the_middle(chains_.node(n), chains_.next(n));
  beyond.from = {0.75, 0.25};
  beyond.anchor = 1;
  const VertexId quarter = split(n, beyond);
  EXPECT_EQ(model_.points.nearest(half)[0], 8);
  EXPECT_EQ(model_.points.nearest(quarter)[0], 4);
}

TEST_F(Splitting, PartsAroundAnAcuteVertexEndOnOneSphere) {
  const std::uint32_t n = chains_.first(edge(0, 1));
  const VertexId reference = split(n, target_behind(chains_.node(n), chains_.next(n), 0.4));
  const std::uint32_t m = chains_.first(edge(0, 2));
  SplitRule rule(chains_, model_.points);
  const VertexId v = split(m, rule.target(m, Centre::end0, reference));
  EXPECT_NEAR(from_apex(v), from_apex(reference), 1e-14);
}

// Two edges at an angle of 2^-107.
Surface needle() {
  Surface s;
  s.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 0x1p-107, 0}, {1, 0, 1}};
  s.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  return s;
}

TEST(SplitRule, StopsAfterManyReferencesThatNoPointMatches) {
  Model model(needle());
  ASSERT_TRUE(model.valid);
  Chains chains(model.input, model.points);
  std::array<std::uint32_t, 2> node{};  // of the edges 0-1 and 0-2
  for (std::uint32_t e = 0; e < model.topology.edge_count(); ++e) {
    const auto [a, b] = model.topology.edge_vertices(e);
    if (a == 0 && b < 3) node[b - 1] = chains.first(e);
  }
  SubsegmentSplitter splitter(chains, model.points, model.predicates);
  const SplitTarget near = target_behind(chains.node(node[0]), chains.next(node[0]), 0.4);
  const VertexId reference = chains.node(splitter.split(node[0], near)).vertex;
  SplitRule rule(chains, model.points);
  for (int i = 0; i < 1023; ++i) rule.target(node[1], Centre::end0, reference);
  try {
    rule.target(node[1], Centre::end0, reference);
    ADD_FAILURE() << "goes on";
  } catch (const Stopped& stopped) {
    EXPECT_EQ(stopped.status.limit, Limit::precision);
    EXPECT_NE(stopped.status.message.find("edge 0-2"), std::string::npos);
  }
}

TEST_F(Splitting, WithoutAReferenceOrAroundBothEndsInTheMiddle) {
  const std::uint32_t n = chains_.first(edge(0, 1)), m = chains_.first(edge(0, 2));
  const VertexId reference = split(n, target_behind(chains_.node(n), chains_.next(n), 0.4));
  SplitRule rule(chains_, model_.points);
  for (const SplitTarget& t :
       {rule.target(m, Centre::both, reference), rule.target(m, Centre::end0, kNone),
        rule.target(m, Centre::none, kNone)}) {
    EXPECT_EQ(t.from, (std::array<double, 2>{0.5, 0.5}));
  }
}

}  // namespace
}  // namespace delmesher::cdt
