// A certain side is the exact side; far points are certain.
#include "mesher/surface/approximate_plane.h"

#include <gtest/gtest.h>

#include <random>

#include "mesher/predicates/predicates.h"

namespace delmesher::surface {
namespace {

// orient3d of the corners and the point, and the plane's answer.
struct Answers {
  int exact, approximate;
};

Answers ask(Predicates& predicates, VertexId a, VertexId b, VertexId c, VertexId p) {
  const PointStore& points = predicates.points();
  const ApproximatePlane plane(points.approximation(a), points.approximation(b),
                               points.approximation(c));
  return {predicates.orient3d(a, b, c, p), plane.side(points.approximation(p))};
}

class PlaneSides : public testing::Test {
 protected:
  VertexId random_point(double scale) {
    const auto x = [&] { return (static_cast<double>(random_() >> 11) * 0x1p-52 - 1) * scale; };
    const double a = x(), b = x(), c = x();
    return points_.add_explicit(a, b, c);
  }
  double fraction() { return static_cast<double>(random_() >> 44) * 0x1p-20; }

  std::mt19937_64 random_{7};
  PointStore points_;
  Predicates predicates_{points_};
};

TEST_F(PlaneSides, CertainSidesAreExactAndMostRandomPointsAreCertain) {
  int certain = 0;
  for (const double scale : {0x1p-300, 1.0, 0x1p300}) {
    for (int n = 0; n < 1000; ++n) {
      const VertexId a = random_point(scale), b = random_point(scale), c = random_point(scale);
      const Answers answers = ask(predicates_, a, b, c, random_point(scale));
      if (answers.approximate == 0) continue;
      ++certain;
      EXPECT_EQ(answers.approximate, answers.exact);
    }
  }
  EXPECT_GT(certain, 1990);  // products of the smallest coordinates look like underflow
}

TEST_F(PlaneSides, PointsOnOrNextToThePlaneAreNeverWrong) {
  int doubtful = 0, certain = 0;
  for (int n = 0; n < 3000; ++n) {
    const VertexId a = random_point(1), b = random_point(1), c = random_point(1);
    const VertexId on = points_.add_on_triangle(a, b, c, fraction() / 2, fraction() / 2);
    EXPECT_EQ(ask(predicates_, a, b, c, on).approximate, 0);
    const Vec3 p = points_.nearest(on);
    const double step = std::ldexp(1.0, -static_cast<int>(30 + random_() % 25));
    const VertexId near = points_.add_explicit(p[0] + step, p[1] - step, p[2]);
    const Answers answers = ask(predicates_, a, b, c, near);
    if (answers.approximate == 0) ++doubtful;
    if (answers.approximate == 0) continue;
    ++certain;
    EXPECT_EQ(answers.approximate, answers.exact);
  }
  EXPECT_GT(doubtful, 100);
  EXPECT_GT(certain, 1000);
}

// A plane through points that are themselves rounded.
TEST_F(PlaneSides, CornersMayBeImplicit) {
  int certain = 0;
  for (int n = 0; n < 1000; ++n) {
    const VertexId p = random_point(1), q = random_point(1), r = random_point(1);
    const VertexId a = points_.add_on_segment(p, q, fraction() / 3);
    const VertexId b = points_.add_on_triangle(p, q, r, fraction() / 2, fraction() / 2);
    // Next to the plane of a, b and r.
    const Vec3 x = points_.nearest(p);
    const double step = std::ldexp(1.0, -static_cast<int>(random_() % 60));
    const VertexId near = points_.add_explicit(x[0], x[1] + step, x[2]);
    const Answers answers = ask(predicates_, a, b, r, near);
    if (answers.approximate == 0) continue;
    ++certain;
    EXPECT_EQ(answers.approximate, answers.exact);
  }
  EXPECT_GT(certain, 500);
}

}  // namespace
}  // namespace delmesher::surface
