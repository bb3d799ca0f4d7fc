// Laws of meshes of complexes with parts as thin as roundings.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <random>

#include "property_tests/complexes.h"

namespace tetproof::slivers_test {
namespace {

using namespace complexes;  // NOLINT(google-build-using-namespace)
using delmesher::Result;
using delmesher::StatusCode;

// About a random axis (quaternions).
class Turn {
 public:
  explicit Turn(std::mt19937_64& random) {
    for (double& x : q_) x = std::uniform_real_distribution<double>(-1, 1)(random);
  }
  std::array<double, 3> operator()(const std::array<double, 3>& p) const {
    const auto& [w, x, y, z] = q_;
    const double norm = w * w + x * x + y * y + z * z;
    std::array<double, 3> turned = {(w * w + x * x - y * y - z * z) * p[0] +
                                        2 * (x * y - w * z) * p[1] + 2 * (x * z + w * y) * p[2],
                                    2 * (x * y + w * z) * p[0] +
                                        (w * w - x * x + y * y - z * z) * p[1] +
                                        2 * (y * z - w * x) * p[2],
                                    2 * (x * z - w * y) * p[0] + 2 * (y * z + w * x) * p[1] +
                                        (w * w - x * x - y * y + z * z) * p[2]};
    for (double& c : turned) c /= norm;
    return turned;
  }

 private:
  std::array<double, 4> q_;
};

// Four flat tetrahedra as thick as roundings, far from the origin or not: volumes in doubles have
// no digit right, and vertices of one side of a tetrahedron are on the others, too.
TEST(AllRegions, OfSlivers) {
  int meshed = 0, split = 0;
  for (int i = 0; i < samples::iterations(60); ++i) {
    SCOPED_TRACE(i);
    std::mt19937_64 random(kSeed + static_cast<std::uint64_t>(i));
    const auto between = [&](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(random);
    };
    Builder builder;
    for (int n = 0; n < 4; ++n) {
      const std::array<std::array<double, 3>, 4> flat = {
          {{0, 0, 0},
           {between(0.3, 1), 0, 0},
           {0, between(0.3, 1), 0},
           {between(0.1, 0.4), between(0.1, 0.4), between(1e-16, 4e-16)}}};
      const Turn turn(random);
      const auto moved = [&](const std::array<double, 3>& p) {
        std::array<double, 3> r = turn(p);
        r[0] += 3 * n + (i % 2 == 0 ? 1e3 : 0);
        r[1] += i % 2 == 0 ? 7 : 0;
        r[2] += i % 2 == 0 ? 1 : 0;
        return r;
      };
      for (const auto& [a, b, c] :
           {std::array{0, 2, 1}, std::array{0, 1, 3}, std::array{1, 2, 3}, std::array{2, 0, 3}}) {
        builder.triangle(moved(flat[static_cast<std::size_t>(a)]),
                         moved(flat[static_cast<std::size_t>(b)]),
                         moved(flat[static_cast<std::size_t>(c)]));
      }
    }
    const Result result = delmesher::tetrahedralize(builder.surface(), all_regions());
    // It is flat, or turned inside out.
    if (result.status.code == StatusCode::invalid_surface) continue;
    ASSERT_TRUE(result.status.ok()) << result.status.message;
    ++meshed;
    split += result.statistics.left_on_surface > 0 ? 1 : 0;
    const VerifyReport report =
        verified(samples::to_polyhedron(builder.surface()), samples::to_mesh(result.mesh));
    EXPECT_TRUE(report.verdict == oracles::Verdict::exact ||
                report.verdict == oracles::Verdict::rounded)
        << to_text(report);
  }
  EXPECT_GT(meshed, samples::iterations(60) / 3);
  EXPECT_GT(split, 0);
}

// Plates as thin: their narrow sides are nothing but vertices of both ends of each edge.
TEST(AllRegions, OfThinPlates) {
  int decided = 0, split = 0;
  for (int i = 0; i < samples::iterations(40); ++i) {
    SCOPED_TRACE(i);
    std::mt19937_64 random(kSeed + static_cast<std::uint64_t>(i));
    Builder builder;
    builder.box({0, 0, 0}, {1, 0.7, 0x1p-53 * (1 + i % 8)});
    Surface surface = builder.surface();
    const Turn turn(random);
    for (auto& p : surface.vertices) p = turn(p);
    const Result result = delmesher::tetrahedralize(surface, all_regions());
    if (result.status.code == StatusCode::invalid_surface) continue;
    ASSERT_TRUE(result.status.ok()) << result.status.message;
    split += result.statistics.left_on_surface > 0 ? 1 : 0;
    const VerifyReport report =
        verified(samples::to_polyhedron(surface), samples::to_mesh(result.mesh));
    EXPECT_NE(report.verdict, oracles::Verdict::broken) << to_text(report);
    decided += report.verdict != oracles::Verdict::undecided ? 1 : 0;
  }
  EXPECT_GT(decided, samples::iterations(40) / 2);
  EXPECT_GT(split, 0);
}

// Sides of it are planar and so thin that the middle of one triangle is in the other, in doubles.
TEST(AllRegions, OfAPlateFarAway) {
  Surface surface;
  surface.vertices = {{1000000.0, -299995.0, 20000.0},
                      {999999.4677569496, -299994.34920279088, 20000.247741097926},
                      {999999.95611772337, -299994.70487534057, 19999.130453754697},
                      {999999.42387467297, -299994.05407813145, 19999.378194852619},
                      {999999.99999999988, -299995.00000000006, 19999.999999999978},
                      {999999.46775694948, -299994.34920279094, 20000.247741097905},
                      {999999.95611772325, -299994.70487534063, 19999.130453754675},
                      {999999.42387467285, -299994.05407813151, 19999.378194852598}};
  surface.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                       {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  const Result result = delmesher::tetrahedralize(surface, all_regions());
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  const VerifyReport report =
      verified(samples::to_polyhedron(surface), samples::to_mesh(result.mesh));
  EXPECT_EQ(report.verdict, oracles::Verdict::exact) << to_text(report);
}

// Two boxes that overlap, cut where rounding left needles: edges that cross are parallel in
// doubles.
TEST(AllRegions, OfNeedles) {
  Surface surface;
  surface.vertices = {{0, 0, 0},
                      {-0.92781448768171726, 0.61287202508417737, -0.99662403656982901},
                      {-0.6066743234235018, -1.3396167560840724, -0.25900680506317175},
                      {-1.5344888111052191, -0.72674473099989489, -1.2556308416330006},
                      {-1.0004088437724632, 0.24397979555613805, 1.0813728855551337},
                      {-1.9282233314541806, 0.8568518206403154, 0.084748848985304631},
                      {-1.6070831671959649, -1.0956369605279341, 0.82236608049196191},
                      {-2.5348976548776823, -0.48276493544375687, -0.17425795607786709},
                      {-1.0491493523664175, 0.34494867386736289, -1.0484253975824633},
                      {-1.9769638400481349, 0.95782069895154021, -2.0450494341522925},
                      {-2.4623032987869364, -0.1138727059157176, -2.2522548782028298},
                      {-2.0495581961388809, 0.58892846942350086, 0.032947487972670282},
                      {-2.9773726838205983, 1.2018004945076783, -0.96367654859715868},
                      {-3.4627121425593992, 0.13010708964042045, -1.1708819926476961},
                      {-1.0491493523664177, 0.34494867386736294, -1.0484253975824633},
                      {-1.2492311211209102, 0.39374463297859053, -0.83215082047143663},
                      {-2.0495581961388809, 0.58892846942350086, 0.032947487972670261},
                      {-2.0495581961388809, 0.58892846942350086, 0.032947487972670234},
                      {-1.5905210685365743, 0.16106851000129085, -0.6575081622092438},
                      {-1.9021034135543546, 0.2122757089259211, -0.33594851508275958}};
  surface.triangles = {
      {0, 2, 3},   {14, 1, 8},  {8, 1, 0},    {3, 14, 8},   {3, 8, 0},   {4, 5, 7},    {4, 7, 6},
      {0, 1, 5},   {0, 5, 4},   {2, 6, 7},    {2, 7, 3},    {0, 4, 6},   {0, 6, 2},    {14, 15, 1},
      {18, 15, 3}, {7, 18, 3},  {3, 15, 14},  {5, 17, 16},  {17, 5, 15}, {5, 16, 7},   {16, 17, 7},
      {15, 5, 1},  {17, 19, 7}, {17, 18, 19}, {17, 15, 18}, {19, 18, 7}, {3, 10, 9},   {3, 9, 8},
      {12, 13, 7}, {7, 11, 16}, {12, 7, 16},  {17, 12, 16}, {9, 12, 17}, {15, 11, 8},  {9, 14, 8},
      {14, 15, 8}, {9, 15, 14}, {16, 11, 15}, {17, 16, 15}, {9, 17, 15}, {7, 13, 10},  {7, 10, 3},
      {19, 7, 3},  {11, 7, 19}, {18, 3, 8},   {19, 3, 18},  {11, 18, 8}, {11, 19, 18}, {10, 13, 12},
      {10, 12, 9}};
  const Result result = delmesher::tetrahedralize(surface, all_regions());
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  const VerifyReport report =
      verified(samples::to_polyhedron(surface), samples::to_mesh(result.mesh));
  EXPECT_NE(report.verdict, oracles::Verdict::broken) << to_text(report);
}

}  // namespace
}  // namespace tetproof::slivers_test
