#include "mesher/refine/cavity_constraints.h"

#include <gtest/gtest.h>

#include <set>

#include "mesher/refine/test_parts.h"

namespace delmesher::refine {
namespace {

// In the volume and on the bottom of the box, near edges, near faces, and far from both.
constexpr Vec3 kPlaces[] = {{1.5, 0.0625, 0.0625}, {1.25, 0.75, 0.03125}, {2.5, 1.5, 0.5},
                            {1.25, 0.5, 0},        {3.5, 1, 0.5},         {-1.25, -0.875, -0.625}};

struct Found {
  std::set<std::uint32_t> subsegments, subfacets;
};

// Brute force over the tetrahedra of the cavity.
Found in_cavity(const Parts& parts) {
  Found found;
  for (const TetId t : parts.dt.cavity()) {
    for (const auto& e : kEdge) {
      found.subsegments.insert(
          parts.subsegments.find(parts.dt.vertex(t, e[0]), parts.dt.vertex(t, e[1])));
    }
    for (int i = 0; i < 4; ++i) found.subfacets.insert(parts.subfacets.on_face(t, i));
  }
  found.subsegments.erase(kNone);
  found.subfacets.erase(kNone);
  return found;
}

TEST(CavityConstraints, EachIsListedOnce) {
  for (const Vec3& place : kPlaces) {
    Parts parts;
    parts.insert_some();
    const VertexId v = parts.points.add_explicit(place[0], place[1], place[2]);
    for (int again = 0; again < 2; ++again) {
      parts.find_cavity(v);
      const Found expected = in_cavity(parts);
      EXPECT_EQ(parts.constraints.count().subsegments, expected.subsegments.size());
      EXPECT_EQ(parts.constraints.count().subfacets, expected.subfacets.size());
    }
    parts.constraints.begin();
    EXPECT_EQ(parts.constraints.count().subsegments, 0U);
    EXPECT_EQ(parts.constraints.count().subfacets, 0U);
  }
}

TEST(CavityConstraints, TheEncroachedAreQueued) {
  std::size_t most_subsegments = 0, most_subfacets = 0;
  for (const Vec3& place : kPlaces) {
    Parts parts;
    const VertexId v = parts.points.add_explicit(place[0], place[1], place[2]);
    parts.find_cavity(v);
    std::vector<std::uint32_t> subsegments, subfacets;
    const Found all = in_cavity(parts);
    for (const std::uint32_t s : all.subsegments) {
      const Vec3 to_a = subtract(parts.points.nearest(parts.subsegments[s].a), place);
      const Vec3 to_b = subtract(parts.points.nearest(parts.subsegments[s].b), place);
      if (dot(to_a, to_b) < 0) subsegments.push_back(s);
    }
    for (const std::uint32_t s : all.subfacets) {
      const auto& c = parts.subfacets[s].v;
      if (parts.predicates.in_diametral_ball(c[0], c[1], c[2], v) > 0) subfacets.push_back(s);
    }
    CavityConstraints& constraints = parts.constraints;
    EXPECT_EQ(constraints.queue_encroached_subsegments(v, {}), !subsegments.empty());
    EXPECT_EQ(taken_from(parts.subsegments), subsegments);
    EXPECT_EQ(constraints.queue_encroached_subfacets(v, {}), !subfacets.empty());
    EXPECT_EQ(taken_from(parts.subfacets), subfacets);
    // Nothing was found since.
    EXPECT_FALSE(constraints.queue_encroached_subsegments(v, constraints.count()));
    EXPECT_FALSE(constraints.queue_encroached_subfacets(v, constraints.count()));
    if (!subsegments.empty()) {
      const std::uint32_t except = subsegments.front();
      subsegments.erase(subsegments.begin());
      EXPECT_EQ(constraints.queue_encroached_subsegments(v, {}, except), !subsegments.empty());
      EXPECT_EQ(taken_from(parts.subsegments), subsegments);
    }
    most_subsegments = std::max(most_subsegments, subsegments.size());
    most_subfacets = std::max(most_subfacets, subfacets.size());
  }
  EXPECT_GT(most_subsegments, 0U);
  EXPECT_GT(most_subfacets, 1U);
}

// Those with both tetrahedra in the cavity, reported before it is filled and found afterwards.
TEST(CavityConstraints, WhatTheCavityRemovesIsQueued) {
  bool subsegment_lost = false, subfacet_lost = false;
  for (const Vec3& place : kPlaces) {
    Parts parts;
    const VertexId v = parts.points.add_explicit(place[0], place[1], place[2]);
    parts.find_cavity(v);
    for (const TetId t : parts.dt.cavity()) {
      std::size_t lost = 0;
      for (int i = 0; i < 4; ++i) {
        lost +=
            parts.subfacets.on_face(t, i) != kNone && parts.dt.in_cavity(parts.dt.neighbor(t, i))
                ? 1
                : 0;
      }
      EXPECT_EQ(parts.constraints.queue_lost_subfacets(t), lost > 0);
    }
    const std::vector<std::uint32_t> told = taken_from(parts.subfacets);
    parts.fill_cavity(v);
    parts.constraints.requeue_lost();
    std::vector<std::uint32_t> subsegments, subfacets;
    for (std::uint32_t s = 0; s < parts.subsegments.size(); ++s) {
      const auto& sub = parts.subsegments[s];
      if (parts.dt.find_edge(sub.a, sub.b) == kNone) subsegments.push_back(s);
    }
    for (std::uint32_t s = 0; s < parts.subfacets.size(); ++s) {
      const auto& c = parts.subfacets[s].v;
      if (!parts.dt.find_face(c[0], c[1], c[2]).exists()) subfacets.push_back(s);
    }
    EXPECT_EQ(taken_from(parts.subsegments), subsegments);
    EXPECT_EQ(taken_from(parts.subfacets), subfacets);
    EXPECT_EQ(told, subfacets);
    subsegment_lost |= !subsegments.empty();
    subfacet_lost |= !subfacets.empty();
  }
  EXPECT_TRUE(subsegment_lost);
  EXPECT_TRUE(subfacet_lost);
}

// A point beyond the outer box: the sides that it sees would be lost with the ghosts there.
TEST(CavityConstraints, SidesOfTheBoxAreLostWithTheirGhosts) {
  Parts parts;
  const Vec3 place = {9, 1, 0.5};
  const VertexId v = parts.points.add_explicit(place[0], place[1], place[2]);
  parts.find_cavity(v);
  std::vector<std::uint32_t> seen;
  for (std::uint32_t s = 0; s < parts.subfacets.size(); ++s) {
    const auto& c = parts.subfacets[s].v;
    const bool of_box = parts.plc().facets[parts.subfacets[s].facet].input_facet == kNone;
    if (of_box && parts.predicates.orient3d(c[0], c[1], c[2], v) > 0) seen.push_back(s);
  }
  EXPECT_EQ(seen.size(), 2U);
  bool any = false;
  for (const TetId t : parts.dt.cavity()) {
    if (parts.dt.is_ghost(t)) any |= parts.constraints.queue_lost_subfacets(t);
  }
  EXPECT_TRUE(any);
  EXPECT_EQ(taken_from(parts.subfacets), seen);
}

}  // namespace
}  // namespace delmesher::refine
