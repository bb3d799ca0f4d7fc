// Laws of the Delaunay tetrahedrization: valid structure, locally Delaunay, unique, and independent
// of insertion order.
#include "mesher/delaunay/tetrahedrization.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <string>

#include "mesher/base/test_complaints.h"

namespace delmesher::delaunay {

// Breaks a tetrahedrization, or brings it to the end of its numbers.
struct TetrahedrizationBreaker {
  Tetrahedrization& dt;

  TetId finite() const {
    TetId t = 0;
    while (!dt.alive(t) || dt.is_ghost(t)) ++t;
    return t;
  }
  void turn_over() const { std::swap(dt.cell_[finite()].vertex[0], dt.cell_[finite()].vertex[1]); }
  void glue_wrongly() const { dt.glue(finite(), 0, finite(), 1); }
  void forget_incident() const { dt.incident_[dt.vertex(finite(), 0)] = kNone; }
  void lose_slot() const { dt.free_.push_back(finite()); }
  void kill() const { dt.state_[finite()].mark = Tetrahedrization::kDead; }
  void use_up_epochs() const { dt.star_epoch_ = 0xffffffffU; }
};

namespace {

using TetSet = std::set<std::array<VertexId, 4>>;

struct Fixture {
  PointStore points;
  Predicates predicates{points};
  Limits options;
  Control control{options};

  std::vector<VertexId> all() const {
    std::vector<VertexId> ids(points.size());
    for (VertexId v = 0; v < ids.size(); ++v) ids[v] = v;
    return ids;
  }
};

TetSet tets(const Tetrahedrization& dt) {
  TetSet set;
  for (TetId t = 0; t < dt.capacity(); ++t) {
    if (!dt.alive(t) || dt.is_ghost(t)) continue;
    std::array<VertexId, 4> v = {dt.vertex(t, 0), dt.vertex(t, 1), dt.vertex(t, 2),
                                 dt.vertex(t, 3)};
    std::sort(v.begin(), v.end());
    set.insert(v);
  }
  return set;
}

void add_random(PointStore& points, int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(0, 1);
  for (int n = 0; n < count; ++n) {
    const double x = u(random);
    const double y = u(random);
    points.add_explicit(x, y, u(random));
  }
}

// All 8 k^3 ties: every cell of an integer grid is cospherical, every plane coplanar.
void add_grid(PointStore& points, int k) {
  for (int x = 0; x < k; ++x) {
    for (int y = 0; y < k; ++y) {
      for (int z = 0; z < k; ++z) points.add_explicit(x, y, z);
    }
  }
}

TEST(Tetrahedrization, RandomPointsAreDelaunay) {
  Fixture f;
  add_random(f.points, 2000, 1);
  Tetrahedrization dt(f.predicates);
  dt.build(f.all(), f.control);
  dt.validate(true);
  // Between the number of tetrahedra of a stacked polytope and Euler's usual 6.7 per random point.
  EXPECT_GT(dt.tetrahedra(), 2000U * 5);
  EXPECT_LT(dt.tetrahedra(), 2000U * 7);
}

TEST(Tetrahedrization, GridFillsItsCube) {
  Fixture f;
  add_grid(f.points, 9);
  Tetrahedrization dt(f.predicates);
  dt.build(f.all(), f.control);
  dt.validate(true);
  double volume6 = 0;
  for (const auto& t : tets(dt)) {
    Vec3 p[4];
    for (int i = 0; i < 4; ++i) p[i] = f.points.nearest(t[i]);
    double d[3][3];
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) d[i][k] = p[i + 1][k] - p[0][k];
    }
    const double det = d[0][0] * (d[1][1] * d[2][2] - d[1][2] * d[2][1]) -
                       d[0][1] * (d[1][0] * d[2][2] - d[1][2] * d[2][0]) +
                       d[0][2] * (d[1][0] * d[2][1] - d[1][1] * d[2][0]);
    EXPECT_NE(det, 0);
    volume6 += std::abs(det);
  }
  EXPECT_EQ(volume6, 6.0 * 8 * 8 * 8);  // small integers: exact in doubles
}

// Few vertices go and come, alone and in clusters: the result is that of build(). On a grid every
// choice is a tie.
TEST(Tetrahedrization, ChangedToOtherVerticesIsThatOfThese) {
  int changed = 0;
  for (const bool grid : {false, true}) {
    Fixture f;
    f.points.add_explicit(-1, -1, -1);  // a hull that stays
    f.points.add_explicit(30, -1, -1);
    f.points.add_explicit(-1, 30, -1);
    f.points.add_explicit(-1, -1, 30);
    if (grid) {
      add_grid(f.points, 7);
    } else {
      add_random(f.points, 400, 5);
    }
    std::mt19937 random(6);
    for (int round = 0; round < 12; ++round) {
      const auto size = static_cast<VertexId>(f.points.size());
      std::vector<VertexId> before, after;
      // Neighbours in the order of a grid, so that holes have several vertices; the last round
      // changes so much that the tetrahedrization is built again.
      const VertexId run = round == 11 ? size / 3 : 1 + round % 4;
      const VertexId goes = 4 + static_cast<VertexId>(random() % (size - run - 4)),
                     comes = 4 + static_cast<VertexId>(random() % (size - run - 4));
      for (VertexId v = 0; v < size; ++v) {
        if (v < comes || v >= comes + run) before.push_back(v);
        if (v < goes || v >= goes + run) after.push_back(v);
      }
      Tetrahedrization dt(f.predicates), expected(f.predicates);
      dt.build(before, f.control);
      dt.change_to(after, f.control);
      dt.validate(true);
      expected.build(after, f.control);
      EXPECT_EQ(tets(dt), tets(expected)) << round;
      for (const VertexId v : before) {
        const bool stays = std::binary_search(after.begin(), after.end(), v);
        EXPECT_EQ(dt.incident(v) != kNone, stays) << v;
      }
      changed += before != after;
    }
  }
  EXPECT_GT(changed, 20);
}

TEST(Tetrahedrization, VerticesOfTheHullAreNotRemoved) {
  Fixture f;
  add_random(f.points, 50, 7);
  f.points.add_explicit(9, 9, 9);
  Tetrahedrization dt(f.predicates);
  dt.build(f.all(), f.control);
  EXPECT_THROW(dt.remove(std::array<VertexId, 1>{50}, f.control), InternalError);
}

TEST(Tetrahedrization, IndependentOfInsertionOrder) {
  for (const bool grid : {false, true}) {
    Fixture f;
    if (grid) {
      add_grid(f.points, 5);
    } else {
      add_random(f.points, 300, 2);
    }
    std::vector<VertexId> ids = f.all();
    Tetrahedrization reference(f.predicates);
    reference.build(ids, f.control);
    const TetSet expected = tets(reference);
    std::mt19937 random(3);
    for (int round = 0; round < 5; ++round) {
      std::shuffle(ids.begin(), ids.end(), random);
      Tetrahedrization dt(f.predicates);
      dt.build(ids, f.control);
      dt.validate(true);
      EXPECT_EQ(tets(dt), expected) << (grid ? "grid" : "random") << " round " << round;
    }
  }
}

TEST(Tetrahedrization, FindsVerticesEdgesAndFaces) {
  Fixture f;
  add_grid(f.points, 4);
  Tetrahedrization dt(f.predicates);
  dt.build(f.all(), f.control);
  std::size_t faces = 0;
  for (const auto& t : tets(dt)) {
    for (const auto& face : kFace) {
      const FaceHandle found = dt.find_face(t[face[0]], t[face[1]], t[face[2]]);
      ASSERT_TRUE(found.exists());
      for (const FaceHandle side : {found, dt.across(found)}) {
        std::array<VertexId, 3> corners{}, expected = {t[face[0]], t[face[1]], t[face[2]]};
        for (int k = 0; k < 3; ++k) corners[k] = dt.vertex(side.tet(), kFace[side.face()][k]);
        std::ranges::sort(corners);
        std::ranges::sort(expected);
        EXPECT_EQ(corners, expected);
        EXPECT_EQ(dt.opposite(side), dt.vertex(side.tet(), side.face()));
        EXPECT_EQ(FaceHandle::at(side.index()), side);
        EXPECT_NE(FaceHandle(side.tet(), (side.face() + 1) % 4), side);
      }
      EXPECT_NE(dt.across(found), found);
      EXPECT_EQ(dt.across(dt.across(found)), found);
      ++faces;
    }
    for (const auto& edge : kEdge) {
      const TetId having = dt.find_edge(t[edge[0]], t[edge[1]]);
      ASSERT_NE(having, kNone);
      std::vector<TetId> ring;
      dt.edge_ring(having, t[edge[0]], t[edge[1]], ring);
      EXPECT_GE(ring.size(), 3U);
      for (const TetId r : ring) {
        EXPECT_GE(dt.index_of(r, t[edge[0]]), 0);
        EXPECT_GE(dt.index_of(r, t[edge[1]]), 0);
      }
    }
  }
  EXPECT_GT(faces, 100U);
  EXPECT_EQ(dt.find_edge(0, 63), kNone);  // opposite corners of the cube
  EXPECT_FALSE(dt.find_face(0, 1, 63).exists());
}

TEST(Tetrahedrization, RefusesDuplicatesAndFlatInput) {
  Fixture f;
  add_grid(f.points, 3);
  Tetrahedrization dt(f.predicates);
  dt.build(f.all(), f.control);
  const VertexId twin = f.points.add_explicit(1, 1, 1);
  const TetSet before = tets(dt);
  EXPECT_FALSE(dt.insert(twin, 0));
  EXPECT_EQ(tets(dt), before);

  Fixture flat;
  for (int n = 0; n < 20; ++n) flat.points.add_explicit(n % 5, n / 5, 0);
  Tetrahedrization none(flat.predicates);
  EXPECT_THROW(none.build(flat.all(), flat.control), InternalError);
}

// Where there was a vertex before, locate() says whether there is one now.
TEST(Tetrahedrization, LocateTellsOfDuplicates) {
  Fixture f;
  add_grid(f.points, 3);
  Tetrahedrization dt(f.predicates);
  dt.build(f.all(), f.control);
  VertexId duplicate = 0;
  const VertexId fresh = f.points.add_explicit(0.5, 0.25, 0.125);
  const TetId t = dt.locate(fresh, dt.incident(26), &duplicate);
  EXPECT_EQ(duplicate, kNone);
  EXPECT_FALSE(dt.is_ghost(t));
  dt.locate(f.points.add_explicit(1, 1, 1), dt.incident(26), &duplicate);
  EXPECT_EQ(duplicate, 13U);
  dt.locate(fresh, dt.incident(26), &duplicate);
  EXPECT_EQ(duplicate, kNone);
}

TEST(Tetrahedrization, MixedPointsOnAnEdgeAndATriangle) {
  Fixture f;
  add_random(f.points, 50, 5);
  for (int n = 1; n < 40; ++n) f.points.add_on_segment(0, 1, n / 40.0);
  for (int n = 1; n < 20; ++n) {
    for (int m = 1; n + m < 20; ++m) f.points.add_on_triangle(2, 3, 4, n / 20.0, m / 20.0);
  }
  Tetrahedrization dt(f.predicates);
  dt.build(f.all(), f.control);
  dt.validate(true);
}

TEST(Tetrahedrization, ValidateReportsEveryDamage) {
  using Breaker = TetrahedrizationBreaker;
  const std::pair<void (Breaker::*)() const, const char*> cases[] = {
      {&Breaker::turn_over, "not positively oriented"},
      {&Breaker::glue_wrongly, "neighbours"},
      {&Breaker::forget_incident, "dead or not at its vertex"},
      {&Breaker::lose_slot, "free slot"},
      {&Breaker::kill, "dead"},
  };
  expect_complaints(cases, [](auto damage) {
    Fixture f;
    add_random(f.points, 50, 7);
    Tetrahedrization dt(f.predicates);
    dt.build(f.all(), f.control);
    const auto said = [&] { return complaint([&] { dt.validate(true); }); };
    EXPECT_EQ(said(), "nothing");
    (Breaker{dt}.*damage)();
    return said();
  });
}

TEST(Tetrahedrization, TooManyTetrahedraAreALimit) {
  Fixture f;
  add_random(f.points, 200, 11);
  Tetrahedrization dt(f.predicates, 300);
  try {
    dt.build(f.all(), f.control);
    FAIL() << "no limit";
  } catch (const Stopped& stopped) {
    EXPECT_EQ(stopped.status.code, StatusCode::limit_reached);
    EXPECT_EQ(stopped.status.limit, Limit::size);
    EXPECT_NE(stopped.status.message.find("300 tetrahedra"), std::string::npos);
  }
  // No face has the number kNone.
  EXPECT_LT(std::uint64_t{4} * (Tetrahedrization::kMostTetrahedra - 1) + 3, kNone);
}

TEST(Tetrahedrization, StarsAreFoundAfterTheLastEpoch) {
  Fixture f;
  add_random(f.points, 100, 12);
  Tetrahedrization dt(f.predicates);
  dt.build(f.all(), f.control);
  const auto star = dt.star(7);
  const std::vector<TetId> before(star.begin(), star.end());
  TetrahedrizationBreaker{dt}.use_up_epochs();
  for (int round = 0; round < 3; ++round) {
    const auto again = dt.star(7);
    EXPECT_EQ(std::vector<TetId>(again.begin(), again.end()), before) << round;
  }
}

}  // namespace
}  // namespace delmesher::delaunay
