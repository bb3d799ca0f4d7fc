#include "mesher/surface/tetrahedron_contact.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "mesher/surface/solid.h"
#include "mesher/surface/test_surfaces.h"
#include "mesher/surface/topology.h"

namespace delmesher::surface {
namespace {

using namespace test_surfaces;
using Rational = std::array<mpq_class, 3>;

Rational rational(const Vec3& p) {
  return {mpq_class(p[0]), mpq_class(p[1]), mpq_class(p[2])};
}

// Straight from the definition of the point kinds.
Rational rational(const PointStore& points, VertexId v) {
  if (points.is_explicit(v)) return rational(points.nearest(v));
  const PointDefinition d = points.definition(v);
  const bool segment = d.kind == PointKind::on_segment;
  const Rational p = rational(points.nearest(d.corner[0]));
  const Rational q = rational(points.nearest(d.corner[1]));
  const Rational r = segment ? q : rational(points.nearest(d.corner[2]));
  const mpq_class u(d.u), w(segment ? 1 - mpq_class(d.u) : mpq_class(d.v));
  Rational result;
  for (std::size_t i = 0; i < 3; ++i) result[i] = u * p[i] + w * q[i] + (1 - u - w) * r[i];
  return result;
}

// orient3d with rationals: > 0 if d is on the side of abc to which its normal points.
mpq_class volume(const Rational& a, const Rational& b, const Rational& c, const Rational& d) {
  std::array<Rational, 3> m;
  for (std::size_t i = 0; i < 3; ++i) {
    m[0][i] = b[i] - a[i];
    m[1][i] = c[i] - a[i];
    m[2][i] = d[i] - a[i];
  }
  mpq_class det = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    det += m[0][i] * (m[1][j] * m[2][k] - m[1][k] * m[2][j]);
  }
  return det;
}

// Clips the triangle with the closed tetrahedron. The mean of the corners of the rest is inside the
// tetrahedron iff the triangle meets its interior.
bool meets_interior_by_clipping(const std::array<Rational, 4>& k,
                                const std::array<Rational, 3>& t) {
  constexpr std::size_t kFaces[4][3] = {{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}};
  std::vector<Rational> polygon(t.begin(), t.end());
  for (const auto& face : kFaces) {
    const auto height = [&](const Rational& p) {
      return volume(k[face[0]], k[face[1]], k[face[2]], p);
    };
    std::vector<Rational> clipped;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Rational &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
      const mpq_class hp = height(p), hq = height(q);
      if (hp >= 0) clipped.push_back(p);
      if (sgn(hp) * sgn(hq) < 0) {
        const mpq_class s = hp / (hp - hq);
        Rational x;
        for (std::size_t j = 0; j < 3; ++j) x[j] = p[j] + s * (q[j] - p[j]);
        clipped.push_back(x);
      }
    }
    polygon = clipped;
  }
  if (polygon.empty()) return false;
  Rational mean{0, 0, 0};
  for (const Rational& p : polygon) {
    for (std::size_t j = 0; j < 3; ++j) mean[j] += p[j] / mpq_class(polygon.size());
  }
  for (const auto& face : kFaces) {
    if (volume(k[face[0]], k[face[1]], k[face[2]], mean) <= 0) return false;
  }
  return true;
}

// Seven points of a coarse grid, so that every kind of contact occurs often; the tetrahedron may
// share corners with the triangle or have corners on it.
class RandomPairs {
 public:
  RandomPairs(std::uint64_t seed, int grid) : random_(seed), grid_(grid) {}

  PointStore points;
  Predicates predicates{points};

  Corners triangle() {
    for (;;) {
      const Corners t{grid_point(), grid_point(), grid_point()};
      if (find_projection(predicates, t).sign != 0) return t;
    }
  }

  std::array<VertexId, 4> tetrahedron(const Corners& t) {
    for (;;) {
      std::array<VertexId, 4> k;
      for (VertexId& v : k) v = corner(t);
      const int o = predicates.orient3d(k[0], k[1], k[2], k[3]);
      if (o == 0) continue;
      if (o < 0) std::swap(k[0], k[1]);
      return k;
    }
  }

  std::array<Rational, 4> exact(const std::array<VertexId, 4>& k) const {
    return {rational(points, k[0]), rational(points, k[1]), rational(points, k[2]),
            rational(points, k[3])};
  }
  std::array<Rational, 3> exact(const Corners& t) const {
    return {rational(points, t[0]), rational(points, t[1]), rational(points, t[2])};
  }

 private:
  std::uint64_t below(std::uint64_t n) { return random_() % n; }

  VertexId grid_point() {
    const auto x = [&] {
      return 0.1 * static_cast<double>(below(static_cast<std::uint64_t>(grid_)));
    };
    return points.add_explicit(x(), x(), x());
  }

  VertexId corner(const Corners& t) {
    const auto parameter = [&] { return static_cast<double>(below(9)) / 8 + 0x1p-45; };
    switch (below(8)) {
      case 0:
        return t[below(3)];
      case 1: {
        const auto i = below(3);
        return points.add_on_segment(t[i], t[(i + 1) % 3], parameter());
      }
      case 2:
        return points.add_on_triangle(t[0], t[1], t[2], parameter() / 2, parameter() / 2);
      default:
        return grid_point();
    }
  }

  std::mt19937_64 random_;
  int grid_;
};

TEST(TetrahedronContact, AgreesWithRationalClipping) {
  std::array<int, 2> seen{};
  for (const int grid : {2, 3, 4, 7}) {
    for (std::uint64_t seed = 0; seed < 1500; ++seed) {
      RandomPairs pairs(seed, grid);
      const Corners t = pairs.triangle();
      const auto k = pairs.tetrahedron(t);
      const bool expected = meets_interior_by_clipping(pairs.exact(k), pairs.exact(t));
      ++seen[expected];
      ASSERT_EQ(meets_interior(pairs.predicates, k, t), expected)
          << "grid " << grid << " seed " << seed;
    }
  }
  EXPECT_GT(seen[0], 1000);
  EXPECT_GT(seen[1], 500);
}

// Two tetrahedra edges crossing at a distance, so that neither faces nor the triangle's plane
// separate, only a plane through corners of both.
TEST(TetrahedronContact, SeparatedByAnEdgeOnly) {
  PointStore points;
  Predicates predicates(points);
  const std::array<VertexId, 4> k{points.add_explicit(-4, 0, 0), points.add_explicit(4, 0, 0),
                                  points.add_explicit(0, 3, -2), points.add_explicit(0, -3, -2)};
  const auto positive = predicates.orient3d(k[0], k[1], k[2], k[3]) > 0
                            ? k
                            : std::array<VertexId, 4>{k[1], k[0], k[2], k[3]};
  const auto triangle = [&](double z) {
    return Corners{points.add_explicit(0, -4, z), points.add_explicit(0, 4, z),
                   points.add_explicit(1, 0, 5)};
  };
  EXPECT_FALSE(meets_interior(predicates, positive, triangle(0.25)));
  EXPECT_FALSE(meets_interior(predicates, positive, triangle(0)));  // the edges cross
  EXPECT_TRUE(meets_interior(predicates, positive, triangle(-0x1p-1060)));
}

struct Model {
  Surface surface;
  PointStore points;
  Predicates predicates{points};
  SurfaceTopology topology;
  Solid solid;
  explicit Model(Surface s)
      : surface(std::move(s)),
        topology(build_topology(surface, points, predicates)),
        solid(topology, predicates) {}
};

Side side_by_definition(const Model& model, const std::array<VertexId, 4>& k,
                        const std::vector<std::pair<Point, Point>>& nested_boxes) {
  const auto at = [&](VertexId v) { return rational(model.points, v); };
  const std::array<Rational, 4> corners{at(k[0]), at(k[1]), at(k[2]), at(k[3])};
  for (const auto& t : model.topology.triangles) {
    if (meets_interior_by_clipping(corners, {at(t[0]), at(t[1]), at(t[2])}))
      return Side::straddling;
  }
  std::size_t around = 0;
  for (const auto& [lo, hi] : nested_boxes) {
    bool inside = true;
    for (std::size_t i = 0; i < 3; ++i) {
      const mpq_class x = (corners[0][i] + corners[1][i] + corners[2][i] + corners[3][i]) / 4;
      inside = inside && x > mpq_class(lo[i]) && x < mpq_class(hi[i]);
    }
    around += inside;
  }
  return around % 2 == 1 ? Side::inside : Side::outside;
}

TEST(Solid, AgreesWithTheDefinition) {
  const std::vector<std::pair<Point, Point>> boxes{{{0.1, 0.1, 0.1}, {0.7, 0.7, 0.7}},
                                                   {{0.3, 0.2, 0.3}, {0.5, 0.6, 0.5}}};
  Model model(joined(box(boxes[0].first, boxes[0].second, 2),
                     reversed(box(boxes[1].first, boxes[1].second))));
  std::mt19937_64 random(7);
  std::array<int, 3> seen{};
  std::array<std::size_t, 3> cell{};
  // Grid coordinates that coincide with the boxes' planes, exactly and by an ulp.
  const auto corner = [&] {
    const auto& ts = model.topology.triangles;
    const auto& t = ts[random() % ts.size()];
    if (random() % 16 == 0) return t[random() % 3];
    if (random() % 16 == 0) {
      return model.points.add_on_triangle(t[0], t[1], t[2], static_cast<double>(random() % 9) / 8,
                                          static_cast<double>(random() % 9) / 8);
    }
    Vec3 p;
    for (std::size_t i = 0; i < 3; ++i) {
      double& x = p[i];
      constexpr double kGrid[] = {0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8};
      x = kGrid[cell[i] + random() % 3];
      if (random() % 8 == 0) x = std::nextafter(x, random() % 2 == 0 ? 1 : -1);
    }
    return model.points.add_explicit(p[0], p[1], p[2]);
  };
  for (int round = 0; round < 800; ++round) {
    for (std::size_t& c : cell) c = random() % 7;
    std::array<VertexId, 4> k{corner(), corner(), corner(), corner()};
    const int o = model.predicates.orient3d(k[0], k[1], k[2], k[3]);
    if (o == 0) continue;
    if (o < 0) std::swap(k[0], k[1]);
    const Side side = model.solid.classify(k);
    ++seen[static_cast<std::size_t>(side)];
    ASSERT_EQ(side, side_by_definition(model, k, boxes)) << round;
  }
  for (const int n : seen) EXPECT_GT(n, 50);
}

// Tetrahedra without any double strictly inside: their centroid must be located exactly.
TEST(Solid, ThinTetrahedra) {
  // The rays from the centroids hit the middle of faces, where four triangles meet.
  Model model(box({1, 1, 1}, {2, 2, 2}, 2));
  const double above = std::nextafter(1.0, 2.0), below = std::nextafter(1.0, 0.0);
  const auto at = [&](double x, double y, double z) { return model.points.add_explicit(x, y, z); };
  const auto flat = [&](double low, double high) {
    std::array<VertexId, 4> k{at(1.25, 1.25, low), at(1.75, 1.25, low), at(1.5, 2, low),
                              at(1.5, 1.5, high)};
    return model.solid.classify(k);
  };
  EXPECT_EQ(flat(1, above), Side::inside);
  EXPECT_EQ(flat(below, 1), Side::outside);
  EXPECT_EQ(flat(below, above), Side::straddling);
  EXPECT_EQ(flat(0.5, below), Side::outside);
  EXPECT_EQ(flat(1, 1.5), Side::inside);
}

}  // namespace
}  // namespace delmesher::surface
