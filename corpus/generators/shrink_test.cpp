#include "corpus/generators/shrink.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>

#include "corpus/generators/certify.h"
#include "corpus/generators/shapes.h"

namespace tetproof {
namespace {

namespace fs = std::filesystem;
using delmesher::Surface;

// 2048 triangles, not quite a sphere.
Surface large() {
  int n = 0;
  return shapes::sphere(4, [&] { return 1 + 0.001 * ((n += 37) % 11); });
}

// Fails where the vertex with the largest x is, exactly, and only there.
class AtOneVertex {
 public:
  explicit AtOneVertex(const Surface& surface) : place_(surface.vertices[0]) {
    for (const auto& p : surface.vertices) place_ = std::max(place_, p);
  }
  bool operator()(const Surface& surface) const {
    for (const auto& p : surface.vertices) {
      if (p == place_) return true;
    }
    return false;
  }

 private:
  std::array<double, 3> place_;
};

// Where a run takes five seconds, five minutes on two cores are 120 runs, and 60 judgements.
TEST(Shrink, FewRunsAreEnough) {
  const Surface surface = large();
  ASSERT_GE(surface.triangles.size(), 2000U);
  const AtOneVertex fails(surface);
  ShrinkProgress progress;
  const Surface small = shrink(
      surface,
      [&](const std::vector<Surface>& some) -> std::optional<std::size_t> {
        EXPECT_LE(some.size(), 2U);
        for (std::size_t i = 0; i < some.size(); ++i) {
          EXPECT_TRUE(certified_valid(some[i]));
          if (fails(some[i])) return i;
        }
        return std::nullopt;
      },
      {.runs = 120, .seconds = 1000, .at_once = 2}, progress);
  EXPECT_TRUE(fails(small));
  EXPECT_TRUE(certified_valid(small));
  EXPECT_LE(small.triangles.size(), 60U);
  EXPECT_LE(progress.runs, 121U);
}

// Fails where the apex is the first vertex, which the first triangle does not have.
TEST(Shrink, KeepsTheOrderOfVertices) {
  const Surface surface =
      shapes::tetrahedron({0.1, 0.1, 123.456}, {0.3, 0, 0}, {2.7, 0, 0}, {0, 3.3, 0});
  ShrinkProgress progress;
  const Surface small = shrink(
      surface,
      [&](const std::vector<Surface>& some) -> std::optional<std::size_t> {
        for (std::size_t i = 0; i < some.size(); ++i) {
          if (some[i].vertices[0][2] > 100) return i;
        }
        return std::nullopt;
      },
      {.runs = 300, .seconds = 60}, progress);
  EXPECT_GT(small.vertices[0][2], 100);
  EXPECT_EQ(small.vertices[0][2], std::floor(small.vertices[0][2]));  // simpler than it was
}

// What was not judged is not a result, be it only without the vertices that no triangle has.
TEST(Shrink, TheGivenSurfaceStaysIfNothingElseFails) {
  Surface surface = shapes::tetrahedron({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
  surface.vertices.push_back({5, 5, 5});
  ShrinkProgress progress;
  const auto nothing = [](const std::vector<Surface>&) { return std::nullopt; };
  EXPECT_EQ(shrink(surface, nothing, {.runs = 50, .seconds = 60}, progress).vertices,
            surface.vertices);
  const auto anything = [](const std::vector<Surface>&) { return std::optional<std::size_t>(0); };
  EXPECT_EQ(shrink(surface, anything, {.runs = 50, .seconds = 60}, progress).vertices.size(), 4U);
}

class SideBySideRuns : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) / ("shrink_test_" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  // A mesher that runs this as a script, with the number of triangles in $n.
  Prober prober(const std::string& script) const {
    Prober p;
    p.mesher.command = [script](const RunFiles& files) {
      return std::vector<std::string>{"/bin/sh", "-c",
                                      "n=$(sed -n 2p \"$0\" | cut -d' ' -f2); " + script,
                                      files.input.string()};
    };
    p.supervisor = TETPROOF_SUPERVISE_PATH;
    p.folder = folder_;
    p.limits = {.wall_seconds = 60, .cpu_seconds = 60, .memory_bytes = 1ULL << 30};
    p.verify = false;
    return p;
  }
  fs::path folder_;
};

// A box has 12 triangles, a tetrahedron 4.
const Surface& box() {
  static const Surface surface = shapes::box({0, 0, 0}, {1, 1, 1});
  return surface;
}
const Surface& tetrahedron() {
  static const Surface surface = shapes::tetrahedron({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
  return surface;
}

TEST_F(SideBySideRuns, TheOneThatIsKnownFirstCountsAndTheOthersAreGivenUp) {
  // Boxes hang without using the processor, until the wall clock ends them.
  const Prober p = prober("[ $n = 12 ] && sleep 50; echo gone >&2; exit 3");
  SideBySide judges(p, p.probe(tetrahedron()));
  EXPECT_EQ(judges({box(), tetrahedron()}), 1U);
  EXPECT_EQ(judges({}), std::nullopt);
}

TEST_F(SideBySideRuns, AnotherFailureIsNone) {
  const Prober p =
      prober("echo kind $((n % 5)) >&2; echo x$(printf %${n}s | tr ' ' x) >&2; exit 3");
  SideBySide judges(p, p.probe(box()));
  EXPECT_EQ(judges({tetrahedron(), box()}), 1U);
  EXPECT_EQ(judges({tetrahedron()}), std::nullopt);
}

// Coordinates are written with sign, point and exponent or without.
TEST_F(SideBySideRuns, NumbersAreNoPartOfAFailure) {
  const Prober p =
      prober("echo at \"($([ $n = 12 ] && echo -4,0.5 || echo 4,-2.1e-07))\" >&2; exit 3");
  const Probe first = p.probe(box());
  EXPECT_NE(first.failure.find("at (#,#)"), std::string::npos) << first.failure;
  SideBySide judges(p, first);
  EXPECT_EQ(judges({tetrahedron()}), 0U);
}

TEST_F(SideBySideRuns, TheLimitFollowsTheCase) {
  const Prober p = prober("echo gone >&2; exit 3");
  const Probe quick = p.probe(box());
  Probe slow = quick;
  slow.cpu_seconds = 10;
  SideBySide judges(p, slow);
  EXPECT_EQ(judges.cpu_limit(), 30);
  EXPECT_EQ(judges({box()}), 0U);
  EXPECT_EQ(judges.cpu_limit(), 1);  // never less
  slow.cpu_seconds = 40;
  EXPECT_EQ(SideBySide(p, slow).cpu_limit(), 60);  // never more than was asked for
  slow.failure = "timeout";
  slow.cpu_seconds = 1;
  EXPECT_EQ(SideBySide(p, slow).cpu_limit(), 60);
}

}  // namespace
}  // namespace tetproof
