#include "mesher/cdt/separation.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "mesher/cdt/cdt_reference.h"
#include "mesher/cdt/gift_wrapping.h"
#include "mesher/cdt/polyhedron.h"
#include "mesher/surface/tetrahedron_contact.h"

namespace delmesher::cdt {
namespace {

using rational::Vector;

// The triangle cut by the tetrahedron's four half-spaces, in plain rational arithmetic.
std::vector<Vector> clip(const std::array<Vector, 4>& tet, const std::array<Vector, 3>& triangle) {
  std::vector<Vector> polygon(triangle.begin(), triangle.end());
  for (int i = 0; i < 4; ++i) {
    const auto height = [&](const Vector& x) {  // positive inside
      return mpq_class(-rational::volume(tet[kFace[i][0]], tet[kFace[i][1]], tet[kFace[i][2]], x));
    };
    std::vector<Vector> next;
    for (std::size_t n = 0; n < polygon.size(); ++n) {
      const Vector &a = polygon[n], &b = polygon[(n + 1) % polygon.size()];
      const mpq_class x = height(a), y = height(b);
      if (sgn(x) >= 0) next.push_back(a);
      if (sgn(x) * sgn(y) >= 0) continue;
      Vector p;
      for (int k = 0; k < 3; ++k) p[k] = a[k] + (b[k] - a[k]) * x / (x - y);
      next.push_back(p);
    }
    polygon = next;
  }
  return polygon;
}

// Tiny integer coordinates, so that every kind of coincidence is frequent.
class SeparationTest : public testing::Test {
 protected:
  void draw(int range) {
    points_ = std::make_unique<PointStore>();
    predicates_ = std::make_unique<Predicates>(*points_);
    std::set<std::array<int, 3>> taken;
    while (taken.size() < 7) {
      std::array<int, 3> c;
      for (int& x : c) x = static_cast<int>(random_() % static_cast<unsigned>(range));
      if (taken.insert(c).second) points_->add_explicit(c[0], c[1], c[2]);
    }
  }
  bool usable(std::array<VertexId, 4>& tet, const std::array<VertexId, 3>& triangle) {
    const int side = predicates_->orient3d(tet[0], tet[1], tet[2], tet[3]);
    if (side < 0) std::swap(tet[0], tet[1]);
    const Vector n = rational::area(at(triangle[0]), at(triangle[1]), at(triangle[2]));
    return side != 0 && !rational::is_zero(n);
  }
  Vector at(VertexId v) const { return rational::exact(*points_, v); }

  std::unique_ptr<PointStore> points_;
  std::unique_ptr<Predicates> predicates_;
  std::mt19937 random_{4};
};

TEST_F(SeparationTest, AgreesWithRationalClipping) {
  int meeting = 0, touching = 0, apart = 0, proper = 0, overcautious = 0;
  for (int round = 0; round < 12000; ++round) {
    draw(3 + round % 3);
    const auto shared = static_cast<VertexId>(round % 3);  // 0, 1 or 2 common vertices
    std::array<VertexId, 4> tet = {0, 1, 2, 3};
    const std::array<VertexId, 3> triangle = {4 - shared, 5 - shared, 6 - shared};
    if (!usable(tet, triangle)) continue;
    const std::array<Vector, 4> t = {at(tet[0]), at(tet[1]), at(tet[2]), at(tet[3])};
    const std::vector<Vector> common = clip(t, {at(triangle[0]), at(triangle[1]), at(triangle[2])});
    // The interior is met iff the middle of the common part is off all four faces.
    bool inside = !common.empty();
    if (inside) {
      Vector middle = {0, 0, 0};
      for (const Vector& p : common) {
        for (int k = 0; k < 3; ++k) middle[k] += p[k] / static_cast<int>(common.size());
      }
      for (int i = 0; i < 4; ++i) {
        inside = inside &&
                 sgn(rational::volume(t[kFace[i][0]], t[kFace[i][1]], t[kFace[i][2]], middle)) != 0;
      }
    }
    ASSERT_EQ(meets_interior(*predicates_, tet, triangle), inside) << round;
    // Improper: the common part has a point that is not spanned by the common vertices. With at
    // most two common vertices this means: it has a corner that is none of them.
    bool improper = false;
    for (const Vector& p : common) {
      bool known = false;
      for (VertexId v = 4 - shared; v < 4; ++v) known = known || p == at(v);
      improper = improper || !known;
    }
    const bool flagged = may_meet_improperly(*predicates_, tet, triangle);
    if (improper) {
      ASSERT_TRUE(flagged) << round;
    }
    if (boxes_disjoint(*points_, tet, triangle)) {
      ASSERT_TRUE(common.empty());
    }
    (inside ? meeting : improper ? touching : common.empty() ? apart : proper) += 1;
    overcautious += flagged && !improper ? 1 : 0;
  }
  EXPECT_GT(meeting, 1000);
  EXPECT_GT(touching, 1000);
  EXPECT_GT(apart, 500);
  EXPECT_GT(proper, 500);
  EXPECT_LT(overcautious, (apart + proper) / 4);
}

// Where no four vertices are coplanar there is no false alarm either.
TEST_F(SeparationTest, IsExactInGeneralPosition) {
  std::array<int, 2> counts{};
  for (int round = 0; round < 1000; ++round) {
    draw(1000);
    const auto shared = static_cast<VertexId>(round % 3);
    std::array<VertexId, 4> tet = {0, 1, 2, 3};
    const std::array<VertexId, 3> triangle = {4 - shared, 5 - shared, 6 - shared};
    bool general = true;
    for (VertexId a = 0; a < 7 - shared; ++a) {
      for (VertexId b = 0; b < a; ++b) {
        for (VertexId c = 0; c < b; ++c) {
          for (VertexId d = 0; d < c; ++d) {
            general = general && sgn(rational::volume(at(a), at(b), at(c), at(d))) != 0;
          }
        }
      }
    }
    if (!general || !usable(tet, triangle)) continue;
    bool improper = false;
    for (const Vector& p : clip({at(tet[0]), at(tet[1]), at(tet[2]), at(tet[3])},
                                {at(triangle[0]), at(triangle[1]), at(triangle[2])})) {
      bool known = false;
      for (VertexId v = 4 - shared; v < 4; ++v) known = known || p == at(v);
      improper = improper || !known;
    }
    ASSERT_EQ(may_meet_improperly(*predicates_, tet, triangle), improper) << round;
    ++counts[improper ? 1 : 0];
  }
  EXPECT_GT(counts[0], 100);
  EXPECT_GT(counts[1], 100);
}

// With three common vertices the two meet in the triangle that these span.
TEST_F(SeparationTest, AFaceMeetsItsTetrahedronProperly) {
  int faces = 0;
  for (int round = 0; round < 200; ++round) {
    draw(3 + round % 3);
    std::array<VertexId, 4> tet = {0, 1, 2, 3};
    if (!usable(tet, {0, 1, 2})) continue;
    for (const auto& [a, b, c] : {std::array<VertexId, 3>{0, 1, 2}, {3, 1, 0}, {2, 3, 1}}) {
      EXPECT_FALSE(meets_interior(*predicates_, tet, {a, b, c}));
      EXPECT_FALSE(may_meet_improperly(*predicates_, tet, {a, b, c}));
      ++faces;
    }
  }
  EXPECT_GT(faces, 100);
}

TEST(Boxes, AreDisjointWhereOneCoordinateTells) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double offset : {-3.0, -1.0, 1.0, 3.0}) {  // 1: they touch
      PointStore points;
      const auto add = [&](double x, double y, double z) {
        std::array<double, 3> p = {x, y, z};
        std::rotate(p.begin(), p.begin() + axis, p.end());
        return points.add_explicit(p[0], p[1], p[2]);
      };
      const std::array<VertexId, 4> tet = {add(0, 0, 0), add(1, 0, 0), add(0, 1, 0), add(0, 0, 1)};
      const std::array<VertexId, 3> triangle = {add(offset, 0, 0), add(offset, 1, 0),
                                                add(offset, 0, 1)};
      // The tetrahedron reaches from 0 to 1.
      EXPECT_EQ(boxes_disjoint(points, tet, triangle), offset < 0 || offset > 1);
    }
  }
}

// A vertex of the tetrahedron is known only roughly, and the triangle has one at the nearest
// doubles of it: in no coordinate may the two be called apart, whichever of them is on which side.
TEST(Boxes, OfRoughlyKnownPointsAreLargeEnough) {
  int rough = 0;
  for (const double u : {0.1, 0.2, 0.3, 1.0 / 3, 0.7}) {
    for (const double side : {-1.0, 1.0}) {
      for (int place = 0; place < 4; ++place) {
        for (const bool swapped : {false, true}) {
          PointStore points;
          const VertexId a = points.add_explicit(0.1, 0.2, 0.3),
                         b = points.add_explicit(0.7, 1.1, 0.9);
          const VertexId p = points.add_on_segment(a, b, u);
          rough += points.approximation(p).error > 0 ? 1 : 0;
          const Vec3 n = points.nearest(p);
          const auto away = [&](double step, int k) {
            return points.add_explicit(n[0] + step * (1 + k), n[1] + step * (1 + k % 2),
                                       n[2] + step * (2 - k % 3));
          };
          const VertexId q = points.add_explicit(n[0], n[1], n[2]);
          std::array<VertexId, 4> tet;
          for (int k = 0; k < 4; ++k) tet[k] = k == place ? (swapped ? q : p) : away(side, k);
          std::array<VertexId, 3> triangle;
          for (int k = 0; k < 3; ++k) {
            triangle[k] = k == place % 3 ? (swapped ? p : q) : away(-side, k);
          }
          EXPECT_FALSE(boxes_disjoint(points, tet, triangle)) << u << " " << side << " " << place;
        }
      }
    }
  }
  EXPECT_GT(rough, 0);
}

// ------------------------------------------------------------------------- filling of polyhedra

std::set<Tetrahedron> as_set(std::vector<Tetrahedron> tetrahedra) {
  for (Tetrahedron& t : tetrahedra) std::sort(t.begin(), t.end());
  return {tetrahedra.begin(), tetrahedra.end()};
}

// In a convex polyhedron with Delaunay faces every way must find the Delaunay tetrahedrization.
TEST(Polyhedron, ConvexIsDelaunay) {
  std::mt19937 random(17);
  std::size_t all_isolated = 0;
  Limits options;
  Control control(options);
  for (const unsigned range : {4U, 16U, 1000U}) {
    for (const std::size_t n : {5U, 9U, 30U}) {
      PointStore points;
      Predicates predicates(points);
      std::set<std::array<unsigned, 3>> taken;
      std::vector<VertexId> vertices;
      while (vertices.size() < n) {
        std::array<unsigned, 3> c;
        for (unsigned& x : c) x = static_cast<unsigned>(random() % range);
        if (!taken.insert(c).second) continue;
        vertices.push_back(points.add_explicit(c[0], c[1], c[2]));
      }
      Tetrahedrization mesh(predicates);
      mesh.build(vertices, control);
      std::vector<Triangle> faces;
      std::vector<Tetrahedron> expected;
      for (TetId t = 0; t < mesh.capacity(); ++t) {
        if (!mesh.alive(t) || mesh.is_ghost(t)) continue;
        const VertexId* v = mesh.vertices(t);
        expected.push_back({v[0], v[1], v[2], v[3]});
        for (int i = 0; i < 4; ++i) {
          if (!mesh.is_ghost(mesh.neighbor(t, i))) continue;
          faces.push_back({v[kFace[i][0]], v[kFace[i][1]], v[kFace[i][2]]});
        }
      }
      // Inner vertices are on no face: isolated ones...
      std::set<VertexId> seen;
      for (const Triangle& f : faces) seen.insert(f.begin(), f.end());
      std::vector<VertexId> isolated;
      for (const VertexId v : vertices) {
        if (seen.count(v) == 0) isolated.push_back(v);
      }
      all_isolated += isolated.size();
      const auto check = [&](const std::vector<VertexId>& on_no_face) {
        FillCounters counters;
        std::vector<Tetrahedron> filled, wrapped;
        PolyhedronFiller filler(predicates, control);
        ASSERT_TRUE(filler.fill(faces, on_no_face, filled));
        EXPECT_EQ(as_set(filled), as_set(expected));
        ASSERT_TRUE(gift_wrap(predicates, control, faces, vertices, wrapped, counters));
        EXPECT_EQ(as_set(wrapped), as_set(expected));
      };
      check(isolated);
      // ... or dangling walls bring them in.
      for (const Tetrahedron& t : expected) {
        for (int i = 0; i < 4; ++i) {
          const Triangle f = {t[kFace[i][0]], t[kFace[i][1]], t[kFace[i][2]]};
          const bool fresh =
              std::any_of(f.begin(), f.end(), [&](VertexId v) { return seen.count(v) == 0; });
          if (!fresh) continue;
          seen.insert(f.begin(), f.end());
          faces.push_back(f);
          faces.push_back({f[0], f[2], f[1]});
        }
      }
      check({});
    }
  }
  EXPECT_GT(all_isolated, 20U);
}

TEST(Polyhedron, OpenSurfaceIsRefused) {
  PointStore points;
  Predicates predicates(points);
  Limits options;
  Control control(options);
  points.add_explicit(0, 0, 0);
  points.add_explicit(1, 0, 0);
  points.add_explicit(0, 1, 0);
  points.add_explicit(0, 0, 1);
  std::vector<Triangle> faces = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
  std::vector<Tetrahedron> tetrahedra;
  PolyhedronFiller filler(predicates, control);
  EXPECT_TRUE(filler.fill(faces, {}, tetrahedra));
  EXPECT_EQ(tetrahedra.size(), 1U);
  faces.pop_back();
  tetrahedra.clear();
  EXPECT_FALSE(filler.fill(faces, {}, tetrahedra));
  EXPECT_TRUE(tetrahedra.empty());
}

}  // namespace
}  // namespace delmesher::cdt
