// Metamorphic relations: properties that must not change, or change in a known way, when the input
// is written differently or moved exactly. Seeded; TETPROOF_ITERATIONS adds random solids.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ostream>
#include <random>

#include "mesher/delmesher.h"
#include "oracles/verify.h"
#include "property_tests/samples.h"

namespace tetproof::metamorphic_test {
namespace {

using delmesher::Options;
using delmesher::Result;
using delmesher::Surface;
using oracles::VerifyOptions;
using oracles::VerifyReport;
using samples::NamedSurface;

constexpr std::uint64_t kSeed = 20261122;

Result mesh(const Surface& surface) {
  Options options = samples::split_surface();
  options.want_exact = true;
  Result result = delmesher::tetrahedralize(surface, options);
  EXPECT_TRUE(result.status.ok()) << result.status.message;
  return result;
}

VerifyReport verified(const Surface& surface, const Result& result, oracles::Stage stage,
                      const Options& options = {}) {
  VerifyReport report;
  EXPECT_EQ(
      oracles::verify(samples::to_polyhedron(surface), samples::to_mesh(result.mesh), &result.exact,
                      {.stage = stage, .promised = oracles::promise_of(options)}, report),
      "");
  return report;
}

// The verdicts: the final mesh conforms exactly, and the refined mesh keeps every promise.
Result expect_verdicts(const Surface& surface) {
  Result result = mesh(surface);
  const VerifyReport final_report = verified(surface, result, oracles::Stage::final);
  EXPECT_TRUE(samples::exact_or_rounded(final_report)) << to_text(final_report);
  EXPECT_NE(final_report.find("exact-constrained-delaunay"), nullptr);
  const VerifyReport refined = verified(surface, result, oracles::Stage::refined);
  EXPECT_TRUE(samples::exact_or_rounded(refined)) << to_text(refined);
  EXPECT_NE(refined.find("refined-encroachment"), nullptr);
  return result;
}

// Numbers that belong to the shape, however it is written.
struct Shape {
  std::uint64_t facets = 0, acute_vertices = 0, acute_edges = 0, dropped = 0;
  bool operator==(const Shape&) const = default;
};

std::ostream& operator<<(std::ostream& stream, const Shape& s) {
  return stream << s.facets << " facets, " << s.acute_vertices << " acute vertices, "
                << s.acute_edges << " acute edges, " << s.dropped << " dropped";
}

Shape shape_of(const Result& result) {
  return {result.exact.facets.size(), result.statistics.acute_vertices,
          result.statistics.acute_edges, result.statistics.dropped_triangles};
}

std::vector<NamedSurface> models() {
  std::vector<NamedSurface> list;
  for (const NamedSurface& model : samples::surfaces(kSeed)) {
    for (const char* name : {"skewed_l", "hollow_cube", "twisted", "pebble", "wedge"}) {
      if (model.name == name) list.push_back(model);
    }
  }
  for (int n = 0; n < samples::iterations(1); ++n) {
    list.push_back({"voxels_" + std::to_string(n), samples::random_voxels(kSeed + n)});
    list.push_back({"steps_" + std::to_string(n), samples::quantized_star(kSeed + n)});
  }
  return list;
}

class Metamorphic : public testing::TestWithParam<NamedSurface> {};

INSTANTIATE_TEST_SUITE_P(Made, Metamorphic, testing::ValuesIn(models()),
                         [](const auto& tested) { return tested.param.name; });

TEST_P(Metamorphic, VertexAndFacePermutationsKeepShapeAndVerdicts) {
  const Surface& original = GetParam().surface;
  std::mt19937_64 random(kSeed);
  std::vector<std::uint32_t> order(original.vertices.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random() % i]);
  Surface permuted;
  permuted.vertices.resize(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    permuted.vertices[order[i]] = original.vertices[i];
  }
  for (auto t : original.triangles) {
    for (auto& v : t) v = order[v];
    permuted.triangles.push_back(t);
  }
  std::reverse(permuted.triangles.begin(), permuted.triangles.end());
  const Shape before = shape_of(mesh(original));
  EXPECT_EQ(shape_of(expect_verdicts(permuted)), before);
}

// Rotations and reflections that only exchange and negate coordinates are exact.
TEST_P(Metamorphic, SignedAxisPermutationsKeepShapeAndVerdicts) {
  const Surface& original = GetParam().surface;
  const Shape before = shape_of(mesh(original));
  const int axes[2][3] = {{2, 0, 1}, {1, 0, 2}};
  for (const auto& axis : axes) {
    Surface moved = original;
    for (auto& p : moved.vertices) p = {-p[axis[0]], p[axis[1]], p[axis[2]]};
    // One negation, and one exchange in the second case: the first is a reflection.
    if (axis[0] == 2) {
      for (auto& t : moved.triangles) std::swap(t[1], t[2]);
    }
    const Result result = expect_verdicts(moved);
    EXPECT_TRUE(result.warnings.empty());
    EXPECT_EQ(shape_of(result), before);
  }
}

// Rounds coordinates to few bits, so that translations by 2^12 are exact.
Surface with_short_coordinates(Surface surface, int bits = 30) {
  for (auto& p : surface.vertices) {
    for (double& x : p) x = std::ldexp(std::nearbyint(std::ldexp(x, bits)), -bits);
  }
  return surface;
}

using Quaternion = std::array<int, 4>;

// By a rational rotation, times its common denominator: the numerators of the matrix of a
// quaternion, so that coordinates of few bits are not rounded.
Surface rotated_and_scaled(const Surface& surface, const Quaternion& q, bool back = false) {
  const double w = q[0], x = back ? -q[1] : q[1], y = back ? -q[2] : q[2], z = back ? -q[3] : q[3];
  const double m[3][3] = {
      {w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)},
      {2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)},
      {2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z}};
  Surface result = surface;
  for (auto& p : result.vertices) {
    const auto [a, b, c] = p;
    for (int i = 0; i < 3; ++i) p[i] = m[i][0] * a + m[i][1] * b + m[i][2] * c;
  }
  return result;
}

// The mesher does not care for axes: what roundings bend is tested in planar/. The tolerance of the
// filter is relative to the bounding box, which a rotation changes; so is the bound of planar
// facets, far above the 2^-25 that short coordinates bend them.
TEST_P(Metamorphic, ExactRotationsKeepShapeAndVerdicts) {
  const Surface original = with_short_coordinates(GetParam().surface, 24);
  Options options = samples::split_surface();
  options.tau = 0;
  options.want_exact = true;
  const Result straight = delmesher::tetrahedralize(original, options);
  ASSERT_TRUE(straight.status.ok()) << straight.status.message;
  // By 57, 98 and 154 degrees, none about a coordinate axis.
  for (const Quaternion& q :
       {Quaternion{11, 2, 3, 5}, Quaternion{4, 1, -3, 3}, Quaternion{3, 7, 8, -7}}) {
    const Surface moved = rotated_and_scaled(original, q);
    const double scale = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
    const Surface back = rotated_and_scaled(moved, q, true);
    for (std::size_t v = 0; v < back.vertices.size(); ++v) {
      for (int axis = 0; axis < 3; ++axis) {
        ASSERT_EQ(back.vertices[v][axis], scale * scale * original.vertices[v][axis]);
      }
    }
    const Result result = delmesher::tetrahedralize(moved, options);
    ASSERT_TRUE(result.status.ok()) << result.status.message;
    EXPECT_EQ(shape_of(result), shape_of(straight));
    EXPECT_EQ(result.statistics.planar_groups, straight.statistics.planar_groups);
    EXPECT_TRUE(samples::exact_or_rounded(verified(moved, result, oracles::Stage::final, options)));
    EXPECT_TRUE(
        samples::exact_or_rounded(verified(moved, result, oracles::Stage::refined, options)));
  }
}

TEST_P(Metamorphic, ExactTranslationKeepsShapeAndVerdicts) {
  const Surface original = with_short_coordinates(GetParam().surface);
  Surface moved = original;
  const Shape before = shape_of(mesh(original));
  for (auto& p : moved.vertices) {
    for (int axis = 0; axis < 3; ++axis) p[axis] += axis == 1 ? -0x1p12 : 0x1p10;
  }
  for (std::size_t v = 0; v < moved.vertices.size(); ++v) {
    ASSERT_EQ(moved.vertices[v][0] - 0x1p10, original.vertices[v][0]) << "not exact";
  }
  EXPECT_EQ(shape_of(expect_verdicts(moved)), before);
}

TEST_P(Metamorphic, ScalingByPowersOfTwoScalesTheMesh) {
  const Result plain = mesh(GetParam().surface);
  Surface scaled = GetParam().surface;
  for (auto& p : scaled.vertices) {
    for (double& x : p) x *= 0x1p-30;
  }
  Result result = expect_verdicts(scaled);
  EXPECT_EQ(shape_of(result), shape_of(plain));
  for (auto& p : result.mesh.vertices) {
    for (double& x : p) x *= 0x1p30;
  }
  EXPECT_EQ(result.mesh.vertices, plain.mesh.vertices);
  EXPECT_EQ(result.mesh.tetrahedra, plain.mesh.tetrahedra);
}

TEST_P(Metamorphic, OrientationFlipIsReportedAndGivesTheSameSolid) {
  Surface flipped = GetParam().surface;
  for (auto& t : flipped.triangles) std::swap(t[0], t[1]);
  const Result result = mesh(flipped);
  EXPECT_FALSE(result.warnings.empty());
  EXPECT_EQ(shape_of(result), shape_of(mesh(GetParam().surface)));
  EXPECT_TRUE(samples::exact_or_rounded(verified(flipped, result, oracles::Stage::final)));
}

// Exchanges the diagonal of the first flat convex quadrilateral of two triangles whose other
// diagonal is not an edge yet.
Surface retriangulated(const Surface& surface, std::size_t& changed) {
  oracles::ExactPoints points;
  points.assign(surface.vertices);
  Surface result = surface;
  for (std::size_t t = 0; t < result.triangles.size(); ++t) {
    for (std::size_t u = 0; u < t; ++u) {
      auto &first = result.triangles[t], &second = result.triangles[u];
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
          const auto a = first[i], b = first[(i + 1) % 3], c = first[(i + 2) % 3];
          const auto d = second[(j + 2) % 3];
          if (second[j] != b || second[(j + 1) % 3] != a || c == d) continue;
          if (oracles::exact::orient3d(points, a, b, c, d) != 0) continue;
          const auto n = oracles::exact::area2(points, a, b, c);
          const auto turn = [&](auto p, auto q, auto r) {
            return sgn(oracles::exact::dot(n, oracles::exact::area2(points, p, q, r)));
          };
          if (turn(c, a, d) <= 0 || turn(d, b, c) <= 0) continue;
          // The new diagonal must not be an edge already.
          const bool there =
              std::any_of(result.triangles.begin(), result.triangles.end(), [&](const auto& other) {
                return std::count(other.begin(), other.end(), c) +
                           std::count(other.begin(), other.end(), d) ==
                       2;
              });
          if (there) continue;
          first = {c, a, d};
          second = {d, b, c};
          ++changed;
          return result;
        }
      }
    }
  }
  return result;
}

std::vector<NamedSurface> models_with_flat_quadrilaterals() {
  std::vector<NamedSurface> list = models();
  std::erase_if(list, [](const NamedSurface& model) {
    std::size_t changed = 0;
    retriangulated(model.surface, changed);
    return changed == 0;
  });
  return list;
}

class Retriangulated : public testing::TestWithParam<NamedSurface> {};

INSTANTIATE_TEST_SUITE_P(Made, Retriangulated, testing::ValuesIn(models_with_flat_quadrilaterals()),
                         [](const auto& tested) { return tested.param.name; });

TEST_P(Retriangulated, FacetsKeepShapeAndVerdicts) {
  Surface surface = GetParam().surface;
  std::size_t changed = 0;
  for (int n = 0; n < 4; ++n) surface = retriangulated(surface, changed);
  EXPECT_EQ(changed, 4U);
  EXPECT_EQ(shape_of(expect_verdicts(surface)), shape_of(mesh(GetParam().surface)));
}

TEST_P(Metamorphic, UnionWithADisjointCopyDoublesEverything) {
  const Surface original = with_short_coordinates(GetParam().surface);
  Surface both = original;
  const auto offset = static_cast<std::uint32_t>(original.vertices.size());
  for (const auto& p : original.vertices) {
    ASSERT_LT(std::fabs(p[0]), 32) << "the copy would not be disjoint";
    ASSERT_EQ(p[0] + 64 - 64, p[0]) << "the copy would not be congruent";
    both.vertices.push_back({p[0] + 64, p[1], p[2]});
  }
  for (const auto& [a, b, c] : original.triangles) {
    both.triangles.push_back({a + offset, b + offset, c + offset});
  }
  // Filtering is relative to the diagonal, which the copy enlarges.
  Options options = samples::split_surface();
  options.want_exact = true;
  options.tau = 0;
  const Shape one = shape_of(delmesher::tetrahedralize(original, options));
  const Result two = delmesher::tetrahedralize(both, options);
  ASSERT_TRUE(two.status.ok()) << two.status.message;
  EXPECT_EQ(shape_of(two), (Shape{2 * one.facets, 2 * one.acute_vertices, 2 * one.acute_edges, 0}));
  EXPECT_TRUE(samples::exact_or_rounded(verified(both, two, oracles::Stage::final, options)));
  EXPECT_TRUE(samples::exact_or_rounded(verified(both, two, oracles::Stage::refined, options)));
}

// The exact volume, as the nearest double: a motion that rounds no coordinate keeps it, and a copy
// doubles it.
TEST(MetamorphicVolume, RigidMotionsKeepTheVolumeAndACopyDoublesIt) {
  const Surface surface = samples::random_voxels(kSeed);
  const auto volume = [](const Surface& s) {
    const Result result = mesh(s);
    const VerifyReport report = verified(s, result, oracles::Stage::final);
    return report.find("exact-volume")->figure("volume").value();
  };
  const double before = volume(surface);
  EXPECT_GT(before, 0);
  Surface moved = surface;
  for (auto& p : moved.vertices) p = {p[1] + 8, -p[0], p[2] - 16};
  EXPECT_EQ(volume(moved), before);
  Surface both = surface;
  for (const auto& p : surface.vertices) both.vertices.push_back({p[0], p[1] + 16, p[2]});
  for (const auto& [a, b, c] : surface.triangles) {
    const auto offset = static_cast<std::uint32_t>(surface.vertices.size());
    both.triangles.push_back({a + offset, b + offset, c + offset});
  }
  EXPECT_EQ(volume(both), 2 * before);
}

}  // namespace
}  // namespace tetproof::metamorphic_test
