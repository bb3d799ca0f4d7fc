#include "mesher/improve/improve.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "mesher/base/face_key.h"
#include "mesher/cdt/model_reference.h"
#include "mesher/cdt/test_models.h"
#include "mesher/improve/quality.h"
#include "mesher/surface/test_surfaces.h"

namespace delmesher::improve::improve_test {

namespace rational = cdt::rational;

namespace {

using namespace cdt::test_models;

// A conforming mesh of a surface with points on edges, in facets and in the volume, inside and out.
struct Case {
  Case(const Surface& surface, int density, std::uint32_t seed) : model(surface) {
    EXPECT_TRUE(model.valid);
    if (density > 0) cdt::test_models::enrich(model, density, seed);
    before = after = model.run().mesh;
  }

  void run(const ImproveOptions& options = {}, bool on_topology = true) {
    result = improve(before, on_topology ? &model.topology : nullptr, {}, options, model.points,
                     model.predicates, model.control);
    after = result.mesh;
  }

  std::string wrong() const { return rational::Checker(model.topology, model.points, after).run(); }

  Quality worst(const ConformingMesh& mesh, bool all = false) const {
    Quality q = kNotCounted;
    for (std::size_t n = 0; n < mesh.tetrahedra.size(); ++n) {
      if (!all && mesh.region[n] == kOutside) continue;
      const auto& t = mesh.tetrahedra[n];
      const auto at = [&](int i) { return model.points.nearest(t[i]); };
      q = worse(q, quality(at(0), at(1), at(2), at(3)));
    }
    return q;
  }

  Model model;
  ConformingMesh before, after;
  ImproveResult result;
};

float squared_sine(double degrees) {
  return static_cast<float>(1 - cosine_squared(degrees));
}

// On exactly the same surface, and no more than that takes.
TEST(Improve, SparesPointsOnEdgesWhileThereAreTooManyTetrahedra) {
  std::uint64_t spared = 0;
  std::uint32_t seed = 1;
  for (const Surface& s : one_of_each()) {
    Case as_ever(s, 3, seed), all(s, 3, seed), enough(s, 3, seed++);
    as_ever.run();
    const std::vector<std::uint8_t> edges(as_ever.model.topology.edge_count(), 1);
    ImproveOptions options;
    options.sparing = {edges, 0};
    all.run(options);
    EXPECT_EQ(all.wrong(), "");
    EXPECT_LE(all.after.tetrahedra.size(), as_ever.after.tetrahedra.size());
    spared += all.result.spared;
    options.sparing.tetrahedra = as_ever.before.tetrahedra.size();
    enough.run(options);
    EXPECT_EQ(enough.result.spared, 0U);
    EXPECT_EQ(enough.after.tetrahedra, as_ever.after.tetrahedra);
  }
  EXPECT_GT(spared, 100U);
}

// The surface and the hull are the same, by rational arithmetic, and no angle that misses its goal
// has become worse.
TEST(Improve, KeepsTheSurfaceAndTheWorstAngles) {
  std::uint32_t seed = 1;
  for (const Surface& s : one_of_each()) {
    for (const int density : {1, 3}) {
      Case c(s, density, seed++);
      c.run();
      EXPECT_EQ(c.wrong(), "");
      EXPECT_EQ(volume(c.model.points, c.after), volume(c.model.points, c.before));
      const Quality before = c.worst(c.before), after = c.worst(c.after);
      EXPECT_GE(after.dihedral, std::min(before.dihedral, squared_sine(kFlattestDihedral)));
      EXPECT_GE(after.face, std::min(before.face, squared_sine(14.47)));
      EXPECT_LT(c.after.tetrahedra.size(), c.before.tetrahedra.size());
      const std::size_t input = c.model.topology.vertex_half_edge.size();
      const std::set<VertexId> used = vertices(c.after);
      for (VertexId v = 0; v < input; ++v) EXPECT_TRUE(used.contains(v)) << v;
    }
  }
}

// Rounder tetrahedra have room for vertices to go: that is made use of before a mesh is given back.
TEST(Improve, LeavesLittleToAnotherRun) {
  std::size_t once = 0, twice = 0;
  for (std::uint32_t seed = 1; seed <= 4; ++seed) {
    Case c(box(0, 1), 12, seed);
    c.run();
    once += c.after.tetrahedra.size();
    c.before = c.after;
    c.run();
    EXPECT_EQ(c.wrong(), "");
    twice += c.after.tetrahedra.size();
  }
  EXPECT_GT(twice, once - once / 5);
}

// Random points in a box make slivers everywhere; none has to be there.
TEST(Improve, LeavesNoBadTetrahedronInABox) {
  for (std::uint32_t seed = 1; seed <= 4; ++seed) {
    Case c(box(0, 1), 4, seed);
    EXPECT_LT(c.worst(c.before).dihedral, squared_sine(5));
    c.run();
    EXPECT_GT(c.worst(c.after).dihedral, squared_sine(12));
    EXPECT_GT(c.worst(c.after).face, squared_sine(12));
  }
}

TEST(Improve, OutsideCountsForTheHull) {
  ImproveOptions options;
  options.region = Region::hull;
  std::uint32_t seed = 1;
  for (const Surface& s : one_of_each()) {
    Case c(s, 2, seed++);
    c.run(options);
    EXPECT_EQ(c.wrong(), "");
    const Quality before = c.worst(c.before, true), after = c.worst(c.after, true);
    EXPECT_GE(after.dihedral, std::min(before.dihedral, squared_sine(kFlattestDihedral)));
    EXPECT_GE(after.face, std::min(before.face, squared_sine(14.47)));
  }
}

// Without the surface's topology its faces and vertices stay as they are.
TEST(Improve, KeepsTheBoundaryOfAnyMesh) {
  std::uint32_t seed = 1;
  for (const Surface& s : one_of_each()) {
    Case c(s, 2, seed++);
    c.run({}, false);
    const auto faces = [](const ConformingMesh& mesh) {
      std::multiset<std::array<VertexId, 3>> keys;
      for (const SurfaceFace& face : mesh.boundary) {
        keys.insert(base::directed_face(face.vertices));
      }
      return keys;
    };
    EXPECT_EQ(faces(c.after), faces(c.before));
    EXPECT_EQ(volume(c.model.points, c.after), volume(c.model.points, c.before));
    EXPECT_LT(c.after.tetrahedra.size(), c.before.tetrahedra.size());
  }
}

// A grid of points, of which much can go; with a bound on the edges less.
TEST(Improve, MakesNoLongEdges) {
  const auto longest = [](const Case& c, const ConformingMesh& mesh) {
    double length = 0;
    for (std::size_t n = 0; n < mesh.tetrahedra.size(); ++n) {
      const auto& t = mesh.tetrahedra[n];
      for (const auto& [i, j] : kEdge) {
        if (mesh.region[n] == kOutside) continue;
        length = std::max(length, norm(c.model.points.difference(t[i], t[j])));
      }
    }
    return length;
  };
  const auto run = [&](double limit, double& before) {
    Case c(surface::test_surfaces::box({0, 0, 0}, {1, 1, 1}, 8), 0, 1);
    std::mt19937 random(1);
    for (int n = 0; n < 343; ++n) {
      const auto at = [&](int k) {
        return (1 + k % 7 + 1e-9 * static_cast<double>(random() % 1000)) / 8;
      };
      c.model.input.vertices.push_back(c.model.points.add_explicit(at(n), at(n / 7), at(n / 49)));
    }
    c.before = c.model.run().mesh;
    before = longest(c, c.before);
    ImproveOptions options;
    options.max_edge = limit < 1 ? before : 0;
    c.run(options);
    EXPECT_EQ(c.wrong(), "");
    return longest(c, c.after);
  };
  double before = 0;
  EXPECT_LE(run(0, before), before);
  EXPECT_GT(run(1, before), before);
}

// Scaling by a power of two scales the mesh; running again gives it again.
TEST(Improve, ScalesAndRepeats) {
  const Surface s = star(1, 0.1, 5);
  Case one(s, 3, 7);
  one.run();
  for (const double scale : {1.0, 0x1p40, 0x1p-40}) {
    Surface scaled = s;
    for (auto& x : scaled.vertices) x = {x[0] * scale, x[1] * scale, x[2] * scale};
    Case other(scaled, 3, 7);
    ASSERT_EQ(other.before.tetrahedra, one.before.tetrahedra);
    other.run();
    EXPECT_EQ(other.after.tetrahedra, one.after.tetrahedra);
    for (const VertexId v : vertices(one.after)) {
      const Vec3 x = one.model.points.nearest(v), y = other.model.points.nearest(v);
      for (int k = 0; k < 3; ++k) EXPECT_EQ(x[k] * scale, y[k]);
    }
  }
}

// Nothing that is given in another order makes another mesh.
TEST(Improve, OrderDoesNotMatter) {
  std::mt19937 random(1);
  for (const bool on_topology : {true, false}) {
    Case one(perforated_plate(5, 0.25, 2), 2, 1), other(perforated_plate(5, 0.25, 2), 2, 1);
    one.run({}, on_topology);
    ASSERT_TRUE(one.result.changed);
    std::vector<std::size_t> order(other.before.tetrahedra.size());
    for (std::size_t n = 0; n < order.size(); ++n) order[n] = n;
    std::shuffle(order.begin(), order.end(), random);
    for (std::size_t n = 0; n < order.size(); ++n) {
      auto t = one.before.tetrahedra[order[n]];
      std::swap(t[0], t[random() % 3 + 1]);
      std::swap(t[2], t[3]);
      other.before.tetrahedra[n] = t;
      other.before.region[n] = one.before.region[order[n]];
    }
    if (on_topology) {  // else faces are named by their order
      std::shuffle(other.before.boundary.begin(), other.before.boundary.end(), random);
    }
    other.run({}, on_topology);
    EXPECT_EQ(other.after.tetrahedra, one.after.tetrahedra);
    EXPECT_EQ(other.after.region, one.after.region);
    for (const VertexId v : vertices(one.after)) {
      EXPECT_EQ(other.model.points.nearest(v), one.model.points.nearest(v));
    }
  }
}

// A stretched octahedron around its long diagonal, where nothing is bad: around a short one it is
// rounder, and stays so.
TEST(Improve, RoundsOffWhereNothingIsBad) {
  PointStore points;
  const Vec3 corners[] = {{0, 0, 1.25}, {0, 0, -1.25}, {1, 0, 0},
                          {0, 1, 0},    {-1, 0, 0},    {0, -1, 0}};
  for (const Vec3& x : corners) points.add_explicit(x[0], x[1], x[2]);
  Predicates predicates(points);
  Control control{Limits{}};
  const auto around = [](VertexId a, VertexId b, const std::array<VertexId, 4>& ring) {
    ConformingMesh mesh;
    for (int k = 0; k < 4; ++k) {
      mesh.tetrahedra.push_back({ring[k], ring[(k + 1) % 4], b, a});
      mesh.region.push_back(1);
    }
    return mesh;
  };
  const auto mean = [&](const ConformingMesh& mesh) {
    double sum = 0;
    for (const auto& t : mesh.tetrahedra) {
      sum += std::sqrt(quality(corners[t[0]], corners[t[1]], corners[t[2]], corners[t[3]]).gamma);
    }
    return sum / static_cast<double>(mesh.tetrahedra.size());
  };
  const ConformingMesh tall = around(0, 1, {2, 3, 4, 5});
  const ImproveResult once = improve(tall, nullptr, {}, {}, points, predicates, control);
  EXPECT_TRUE(once.changed);
  EXPECT_EQ(once.mesh.tetrahedra.size(), 4U);
  EXPECT_GT(mean(once.mesh), mean(tall));
  for (const auto& t : once.mesh.tetrahedra) {
    EXPECT_GT(predicates.orient3d(t[0], t[1], t[2], t[3]), 0);
    EXPECT_FALSE(std::count(t.begin(), t.end(), 0U) == 1 &&
                 std::count(t.begin(), t.end(), 1U) == 1);
  }
  EXPECT_FALSE(improve(once.mesh, nullptr, {}, {}, points, predicates, control).changed);
}

// From the beginning to nearly the end, in steps that are not large.
TEST(Improve, TellsHowFarItIs) {
  Limits limits;
  std::vector<double> done;
  limits.progress = [&done](const Progress& progress) {
    done.push_back(progress.done);
    return true;
  };
  Case c(box(0, 1), 8, 1);
  Control control(limits);
  control.enter(Phase::improve);
  improve(c.before, &c.model.topology, {}, {}, c.model.points, c.model.predicates, control);
  ASSERT_GT(done.size(), 10U);
  double before = 0;
  for (const double now : done) {
    EXPECT_GE(now, before);
    EXPECT_LT(now, before + 0.25);
    before = now;
  }
  EXPECT_GT(before, 0.75);
  EXPECT_LE(before, 1);
}

TEST(Improve, EndsWhenItIsCancelled) {
  Limits limits;
  int calls = 0;
  limits.progress = [&calls](const Progress&) { return ++calls < 2; };
  Case c(box(0, 1), 8, 1);
  Control control(limits);
  control.enter(Phase::improve);
  ConformingMesh given = c.before;
  EXPECT_THROW(improve(std::move(given), &c.model.topology, {}, {}, c.model.points,
                       c.model.predicates, control),
               Stopped);
}

}  // namespace
}  // namespace delmesher::improve::improve_test
