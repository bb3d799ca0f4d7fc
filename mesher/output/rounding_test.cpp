#include "mesher/output/rounding.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>

#include "mesher/base/face_key.h"
#include "mesher/delaunay/tetrahedrization.h"
#include "mesher/output/rounded_mesh.h"
#include "mesher/output/vertex_moves.h"

namespace delmesher::output::rounding_test {
namespace {

using Face = std::array<std::uint32_t, 3>;
using ExactVec = std::array<mpq_class, 3>;

// ------------------------------------------------------------------- independent, in rationals

ExactVec rational(const Vec3& p) {
  return {mpq_class(p[0]), mpq_class(p[1]), mpq_class(p[2])};
}

ExactVec exact_position(const PointStore& points, VertexId v) {
  const PointDefinition& d = points.definition(v);
  if (d.kind == PointKind::explicit_point) return rational(points.nearest(v));
  const bool segment = d.kind == PointKind::on_segment;
  const mpq_class weight[3] = {
      d.u, segment ? mpq_class(1 - mpq_class(d.u)) : mpq_class(d.v),
      segment ? mpq_class(0) : mpq_class(1 - mpq_class(d.u) - mpq_class(d.v))};
  ExactVec sum;
  for (int k = 0; k < (segment ? 2 : 3); ++k) {
    const ExactVec corner = rational(points.nearest(d.corner[k]));
    for (int i = 0; i < 3; ++i) sum[i] += weight[k] * corner[i];
  }
  return sum;
}

int orientation(const ExactVec& a, const ExactVec& b, const ExactVec& c, const ExactVec& d) {
  mpq_class m[3][3];
  const ExactVec* rows[3] = {&b, &c, &d};
  for (int r = 0; r < 3; ++r) {
    for (int i = 0; i < 3; ++i) m[r][i] = (*rows[r])[i] - a[i];
  }
  return sgn(mpq_class(m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                       m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                       m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0])));
}

int sign_of(const std::vector<Vec3>& x, const Tet& t) {
  return orientation(rational(x[t[0]]), rational(x[t[1]]), rational(x[t[2]]), rational(x[t[3]]));
}

Face rotated(Face f) {
  std::rotate(f.begin(), std::min_element(f.begin(), f.end()), f.end());
  return f;
}

// Outward faces, counting each, with the region of the tetrahedron.
std::map<Face, int> oriented_faces(const std::vector<Tet>& tets,
                                   const std::vector<RegionId>& region) {
  std::map<Face, int> faces;
  for (std::size_t t = 0; t < tets.size(); ++t) {
    for (const auto& f : kFace) {
      const bool fresh =
          faces.emplace(rotated({tets[t][f[0]], tets[t][f[1]], tets[t][f[2]]}), region[t]).second;
      EXPECT_TRUE(fresh) << "a face is twice on the same side";
    }
  }
  return faces;
}

// Faces on one tetrahedron, or between tetrahedra of different regions.
std::set<Face> outline(const std::vector<Tet>& tets, const std::vector<RegionId>& region) {
  const auto faces = oriented_faces(tets, region);
  std::set<Face> result;
  for (const auto& [f, flag] : faces) {
    const auto twin = faces.find(rotated({f[0], f[2], f[1]}));
    if (twin == faces.end() || twin->second != flag) result.insert(f);
  }
  return result;
}

// ------------------------------------------------------------------------------------ test meshes

struct Scene {
  PointStore points;
  RoundingInput input;

  void finish() {
    input.points = &points;
    input.mobility.resize(points.size(), Mobility::free);
    input.mesh.region.resize(input.mesh.tetrahedra.size(), 1);
    const std::set<Face> faces = outline(input.mesh.tetrahedra, input.mesh.region);
    for (const Face& f : faces) input.mesh.boundary.push_back({f, 0});
  }
  std::size_t bad_when_rounded() const { return bad().size(); }
  std::set<VertexId> disturbed() const {
    std::set<VertexId> result;
    for (const Tet& t : bad()) result.insert(t.begin(), t.end());
    return result;
  }

 private:
  std::vector<Tet> bad() const {
    std::vector<Vec3> x;
    for (VertexId v = 0; v < points.size(); ++v) x.push_back(points.nearest(v));
    std::vector<Tet> result;
    for (const Tet& t : input.mesh.tetrahedra) {
      if (sign_of(x, t) <= 0) result.push_back(t);
    }
    return result;
  }
};

RoundingResult run(const Scene& scene, const RepairLimits& limits = {}) {
  const Limits options;
  Control control(options);
  return round_mesh(scene.input, control, limits);
}

// Everything that round_mesh promises, whatever it could or could not repair.
void check(const Scene& scene, const RoundingResult& r) {
  ASSERT_TRUE(std::is_sorted(r.vertices.begin(), r.vertices.end()));
  ASSERT_EQ(r.vertices.size(), r.mesh.vertices.size());
  ASSERT_EQ(r.mesh.tetrahedra.size(), r.mesh.inside.size());
  std::uint64_t inverted = 0, flat = 0;
  std::vector<Tet> in_store;
  std::set<std::uint32_t> used;
  for (const Tet& t : r.mesh.tetrahedra) {
    const int sign = sign_of(r.mesh.vertices, t);
    inverted += sign < 0;
    flat += sign == 0;
    in_store.push_back({r.vertices[t[0]], r.vertices[t[1]], r.vertices[t[2]], r.vertices[t[3]]});
    used.insert(t.begin(), t.end());
  }
  EXPECT_EQ(inverted, r.inverted);
  EXPECT_EQ(flat, r.flat);
  EXPECT_EQ(scene.bad_when_rounded(), r.repaired + inverted + flat);
  EXPECT_EQ(std::set<VertexId>(r.disturbed.begin(), r.disturbed.end()), scene.disturbed());
  EXPECT_EQ(used.size(), r.vertices.size());
  EXPECT_EQ(outline(in_store, {r.mesh.inside.begin(), r.mesh.inside.end()}),
            outline(scene.input.mesh.tetrahedra, scene.input.mesh.region));
  ASSERT_EQ(r.mesh.boundary.size(), scene.input.mesh.boundary.size());
  for (std::size_t i = 0; i < r.mesh.boundary.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(r.vertices[r.mesh.boundary[i][k]], scene.input.mesh.boundary[i].vertices[k]);
    }
  }
  double largest = 0;
  for (const auto& face : scene.input.mesh.boundary) {
    for (const VertexId v : face.vertices) {
      for (const double c : scene.points.nearest(v)) largest = std::max(largest, std::fabs(c));
    }
  }
  const double ulp = std::nextafter(largest, INFINITY) - largest;
  for (std::size_t i = 0; i < r.vertices.size(); ++i) {
    const VertexId v = r.vertices[i];
    if (scene.input.mobility[v] == Mobility::fixed) {
      EXPECT_EQ(r.mesh.vertices[i], scene.points.nearest(v));
    }
    if (scene.input.mobility[v] == Mobility::free) continue;
    const ExactVec exact = exact_position(scene.points, v), written = rational(r.mesh.vertices[i]);
    mpq_class squared = 0;
    for (int k = 0; k < 3; ++k) squared += (written[k] - exact[k]) * (written[k] - exact[k]);
    const mpq_class limit = 4 * mpq_class(ulp), claimed(r.max_surface_deviation);
    EXPECT_TRUE(squared <= limit * limit) << v;
    EXPECT_TRUE(squared <= claimed * claimed) << v;
    // The claim adds twice the error of nearest doubles in three coordinates: sqrt(3) ulp.
    EXPECT_TRUE(claimed <= limit + 2 * mpq_class(ulp));
  }
  const std::set<Vec3> distinct(r.mesh.vertices.begin(), r.mesh.vertices.end());
  EXPECT_EQ(distinct.size() + r.coincident, r.mesh.vertices.size());
}

void expect_same(const RoundingResult& a, const RoundingResult& b, double factor) {
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.mesh.tetrahedra, b.mesh.tetrahedra);
  EXPECT_EQ(a.max_surface_deviation * factor, b.max_surface_deviation);
  ASSERT_EQ(a.mesh.vertices.size(), b.mesh.vertices.size());
  for (std::size_t i = 0; i < a.mesh.vertices.size(); ++i) {
    for (int k = 0; k < 3; ++k) ASSERT_EQ(a.mesh.vertices[i][k] * factor, b.mesh.vertices[i][k]);
  }
}

// Points of a grid on a triangle with no exactly representable plane, a tip for all, and, just
// above each grid triangle, a point whose tetrahedron is positive but often vanishes when rounded.
Scene make_grazing(std::uint64_t seed, double scale, bool tiny_tips_on_surface) {
  std::mt19937_64 random(seed);
  const int n = 8;
  Scene s;
  std::uniform_real_distribution<double> noise(-0.3, 0.3);
  const auto corner = [&](double x, double y, double z) {
    // In braces: arguments of a call are evaluated in any order.
    const Vec3 at{x + noise(random), y + noise(random), z + noise(random)};
    const VertexId v = s.points.add_explicit(scale * at[0], scale * at[1], scale * at[2]);
    s.input.mobility.resize(v + 1, Mobility::fixed);
    return v;
  };
  const VertexId p = corner(1, 0, 0), q = corner(0, 1, 0), r = corner(0, 0, 1),
                 tip = corner(2, 2, 2);
  std::map<std::pair<int, int>, VertexId> grid;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; i + j <= n; ++j) {
      // Jittered, so that the sums do not happen to be exact.
      const auto jitter = [&] { return std::ldexp(std::round(noise(random) * 0x1p20), -25); };
      const std::array<double, 2> u{double(i) / n + jitter(), double(j) / n + jitter()};
      const VertexId v = s.points.add_on_triangle(p, q, r, u[0], u[1]);
      grid[{i, j}] = v;
      s.input.mobility.resize(v + 1, Mobility::in_plane);
    }
  }
  Predicates exact(s.points);
  const auto add = [&](VertexId a, VertexId b, VertexId c) {
    const Vec3 x = s.points.nearest(a), y = s.points.nearest(b), z = s.points.nearest(c);
    Vec3 m;
    for (int k = 0; k < 3; ++k) m[k] = 0.4 * x[k] + 0.3 * y[k] + 0.3 * z[k];
    VertexId v = s.points.add_explicit(m[0], m[1], m[2]);
    for (int i = 0; i < 12 && exact.orient3d(a, b, c, v) <= 0; ++i) {
      s.points.pop_back();
      m[i % 3] = std::nextafter(m[i % 3], INFINITY);
      v = s.points.add_explicit(m[0], m[1], m[2]);
    }
    ASSERT_GT(exact.orient3d(a, b, c, v), 0);
    s.input.mobility.resize(v + 1, tiny_tips_on_surface ? Mobility::in_plane : Mobility::free);
    for (const Tet& t :
         {Tet{a, b, c, v}, Tet{a, b, v, tip}, Tet{b, c, v, tip}, Tet{c, a, v, tip}}) {
      ASSERT_GT(exact.orient3d(t[0], t[1], t[2], t[3]), 0);
      s.input.mesh.tetrahedra.push_back(t);
    }
  };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; i + j < n; ++j) {
      add(grid[{i, j}], grid[{i + 1, j}], grid[{i, j + 1}]);
      if (i + j + 2 <= n) add(grid[{i + 1, j}], grid[{i + 1, j + 1}], grid[{i, j + 1}]);
    }
  }
  s.finish();
  return s;
}

// Two large triangles at a dihedral angle of 180 degrees minus next to nothing, with the points of
// a square grid on both, and a Delaunay tetrahedrization: the squares that straddle the ridge
// become tetrahedra with next to no volume, their corners not quite coplanar. The corners of a box
// around are fixed.
Scene make_ridge(std::uint64_t seed, double scale, double angle, double shift = 0) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> noise(-1, 1);
  Scene s;
  const auto corner = [&](double x, double y, double z) {
    const VertexId v =
        s.points.add_explicit(scale * (x + shift), scale * (y - 2 * shift), scale * (z + shift));
    s.input.mobility.resize(v + 1, Mobility::fixed);
    return v;
  };
  for (int i = 0; i < 8; ++i) {
    corner((i & 1) != 0 ? 3 : -3, (i & 2) != 0 ? 3 : -3, (i & 4) != 0 ? 3 : -3);
  }
  const double tilt = 0.3 * noise(random), offset = 0.1 * noise(random), turn = noise(random);
  const double cosine = 1 / std::sqrt(1 + tilt * tilt), sine = tilt * cosine;
  const double reach = 2 / std::sqrt(1 + turn * turn);
  // Along the ridge, across it, and up.
  const auto on_plane = [&](double along, double across, double lift) {
    const double x = reach * (along - turn * across), y = reach * (turn * along + across);
    return corner(x, cosine * y, sine * y + offset + lift);
  };
  const VertexId a = on_plane(-1, 0, 0), b = on_plane(1, 0, 0);
  const VertexId c = on_plane(0, 1, 0), d = on_plane(0, -1, angle);
  std::vector<VertexId> all{0, 1, 2, 3, 4, 5, 6, 7, a, b, c, d};
  for (int i = -4; i <= 4; ++i) {
    for (int j = -4; j <= 4; ++j) {
      const double x = 0.25 * i / reach, y = 0.25 * j / reach;
      const double along = (x + turn * y) / (1 + turn * turn);
      const double across = (y - turn * x) / (1 + turn * turn);
      // along = v_b - v_a, |across| = v_apex, the weights summing to 1
      const double weight = std::fabs(across), of_b = 0.5 * (1 - weight + along);
      if (of_b < 0 || of_b + weight > 1) continue;
      const VertexId v = s.points.add_on_triangle(b, across > 0 ? c : d, a, of_b, weight);
      s.input.mobility.resize(v + 1, Mobility::in_plane);
      all.push_back(v);
    }
  }
  Predicates predicates(s.points);
  Tetrahedrization delaunay(predicates);
  const Limits options;
  Control control(options);
  delaunay.build(all, control);
  for (TetId t = 0; t < delaunay.capacity(); ++t) {
    if (!delaunay.alive(t) || delaunay.is_ghost(t)) continue;
    const VertexId* v = delaunay.vertices(t);
    s.input.mesh.tetrahedra.push_back({v[0], v[1], v[2], v[3]});
  }
  s.finish();
  return s;
}

// ------------------------------------------------------------------------------------------ tests

void expect_good_grazing(bool on_surface) {
  std::size_t before = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Scene s = make_grazing(seed, 1, on_surface);
    before += s.bad_when_rounded();
    const RoundingResult r = run(s);
    check(s, r);
    EXPECT_EQ(r.inverted + r.flat, 0U) << seed;
  }
  EXPECT_GT(before, 50U);  // else the test shows nothing
}

TEST(Rounding, GrazingVolumeVertices) {
  expect_good_grazing(false);
}

TEST(Rounding, GrazingSurfaceVertices) {
  expect_good_grazing(true);
}

TEST(Rounding, Ridges) {
  std::size_t before = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    for (const double angle : {1e-15, 3e-16, 0.0}) {
      const Scene s = make_ridge(seed, 1, angle);
      before += s.bad_when_rounded();
      const RoundingResult r = run(s);
      check(s, r);
      EXPECT_EQ(r.inverted + r.flat, 0U) << seed << " " << angle;
    }
  }
  EXPECT_GT(before, 20U);
}

TEST(Rounding, FarFromTheOrigin) {
  std::size_t before = 0;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    for (const double shift : {1e3, 1e9, 1e13}) {
      const Scene s = make_ridge(seed, 1, 2e-16 * shift, shift);
      before += s.bad_when_rounded();
      const RoundingResult r = run(s);
      check(s, r);
      EXPECT_EQ(r.inverted + r.flat, 0U) << seed << " " << shift;
    }
  }
  EXPECT_GT(before, 20U);
}

// How many tetrahedra are bad when rounded, and that untangling leaves none.
std::size_t untangled(const Scene& scene) {
  const Limits options;
  Control control(options);
  const NearestMesh nearest(scene.input, control);
  RoundedMesh mesh(nearest);
  const std::size_t before = mesh.bad().size();
  EXPECT_TRUE(VertexMoves(mesh).untangle(control));
  EXPECT_TRUE(mesh.bad().empty());
  for (std::uint32_t v = 0; v < mesh.mesh.vertices(); ++v) {
    EXPECT_TRUE(!mesh.fixed(v) || mesh.position(v) == mesh.home(v)) << v;
  }
  return before;
}

TEST(Rounding, UntanglingAloneIsEnough) {
  std::size_t before = 0;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    SCOPED_TRACE(seed);
    before += untangled(make_grazing(seed, 1, false)) + untangled(make_grazing(seed, 1, true)) +
              untangled(make_ridge(seed, 1, 3e-16)) + untangled(make_ridge(seed, 1, 2e-7, 1e9));
  }
  EXPECT_GT(before, 100U);  // else the test shows nothing
}

TEST(Rounding, NothingToDo) {
  const Scene s = make_ridge(1, 1, 0.1);
  ASSERT_EQ(s.bad_when_rounded(), 0U);
  const RoundingResult r = run(s);
  check(s, r);
  EXPECT_EQ(r.mesh.tetrahedra.size(), s.input.mesh.tetrahedra.size());
  EXPECT_EQ(r.repaired, 0U);
  for (std::size_t i = 0; i < r.vertices.size(); ++i) {
    EXPECT_EQ(r.mesh.vertices[i], s.points.nearest(r.vertices[i]));
  }
}

TEST(Rounding, SameTwiceAndScaled) {
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    const Scene s = make_ridge(seed, 1, 3e-16);
    const Scene g = make_grazing(seed, 1, false);
    expect_same(run(s), run(s), 1);
    for (const double factor : {0x1p-10, 0x1p20, 0x1p-200, 0x1p300}) {
      expect_same(run(s), run(make_ridge(seed, factor, 3e-16)), factor);
      expect_same(run(g), run(make_grazing(seed, factor, false)), factor);
    }
  }
}

TEST(Rounding, WhatCannotMoveIsCounted) {
  Scene s = make_ridge(0, 1, 3e-16);
  std::ranges::fill(s.input.mobility, Mobility::fixed);
  const std::size_t before = s.bad_when_rounded();
  ASSERT_GT(before, 0U);
  // With every face to be kept, there are no flips either.
  s.input.mesh.boundary.clear();
  std::set<Face> faces;
  for (const Tet& t : s.input.mesh.tetrahedra) {
    for (const auto& f : kFace) faces.insert(undirected_face(t[f[0]], t[f[1]], t[f[2]]));
  }
  for (const Face& f : faces) s.input.mesh.boundary.push_back({f, 0});
  const RoundingResult r = run(s);
  EXPECT_EQ(r.repaired, 0U);
  EXPECT_EQ(r.inverted + r.flat, before);
  EXPECT_EQ(r.mesh.tetrahedra, s.input.mesh.tetrahedra);
  EXPECT_EQ(r.operations, 0U);
  EXPECT_EQ(r.inexact_operations, 0U);
}

TEST(Rounding, WhereThereIsTooMuchToRepairNothingIs) {
  const Scene s = make_ridge(0, 1, 3e-16);
  const std::size_t before = s.bad_when_rounded();
  ASSERT_GT(before, 0U);
  const RoundingResult left = run(s, {.most = before - 1});
  check(s, left);
  EXPECT_FALSE(left.tried);
  EXPECT_EQ(left.inverted + left.flat, before);
  EXPECT_EQ(left.mesh.tetrahedra, s.input.mesh.tetrahedra);
  for (std::size_t i = 0; i < left.vertices.size(); ++i) {
    EXPECT_EQ(left.mesh.vertices[i], s.points.nearest(left.vertices[i]));
  }
  const RoundingResult repaired = run(s, {.most = before});
  EXPECT_TRUE(repaired.tried);
  EXPECT_GT(repaired.repaired, 0U);
}

TEST(Rounding, FlipsWhereNothingMoves) {
  std::size_t before = 0, after = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Scene s = make_ridge(seed, 1, 3e-16);
    std::ranges::fill(s.input.mobility, Mobility::fixed);
    before += s.bad_when_rounded();
    const RoundingResult r = run(s);
    check(s, r);
    EXPECT_EQ(r.vertices.size(), s.points.size());
    // Each operation mends something, and nothing else does.
    EXPECT_LE(r.operations, r.repaired);
    EXPECT_EQ(r.operations > 0, r.repaired > 0);
    after += r.inverted + r.flat;
  }
  EXPECT_GT(before, 10U);
  EXPECT_EQ(after, 0U);
}

TEST(Rounding, CoincidentVerticesAreSeparated) {
  // Two tetrahedra that touch only where two different points of a segment round to one.
  Scene s;
  PointStore& p = s.points;
  const VertexId a = p.add_explicit(1, 1, 1), b = p.add_explicit(3, 4, 5);
  const VertexId v = p.add_on_segment(a, b, 0.25), w = p.add_on_segment(a, b, 0.25 + 0x1p-54);
  ASSERT_EQ(p.nearest(v), p.nearest(w));
  const VertexId first = p.add_explicit(7, 0, 0);
  p.add_explicit(8, 0, 1), p.add_explicit(7, 1, 0), p.add_explicit(-7, 0, 0);
  p.add_explicit(-8, 0, 1), p.add_explicit(-7, 1, 0);
  Predicates exact(p);
  for (int i = 0; i < 2; ++i) {
    const VertexId f = first + 3 * i, x = i == 0 ? v : w;
    const bool positive = exact.orient3d(f, f + 1, f + 2, x) > 0;
    s.input.mesh.tetrahedra.push_back({f, positive ? f + 1 : f + 2, positive ? f + 2 : f + 1, x});
  }
  s.input.mobility.assign(p.size(), Mobility::fixed);
  s.input.mobility[v] = s.input.mobility[w] = Mobility::in_plane;
  s.finish();
  const RoundingResult r = run(s);
  check(s, r);
  EXPECT_EQ(r.coincident, 0U);
  s.input.mobility[v] = s.input.mobility[w] =
      Mobility::fixed;  // the others being explicit, nothing can be done
  EXPECT_EQ(run(s).coincident, 1U);
}

TEST(Rounding, Cancels) {
  Limits options;
  options.progress = [](const Progress&) { return false; };
  Control control(options);
  const Scene s = make_ridge(0, 1, 3e-16);
  EXPECT_THROW(round_mesh(s.input, control), Stopped);
}

TEST(Rounding, EmptyMesh) {
  Scene s;
  s.points.add_explicit(0, 0, 0);
  s.finish();
  const RoundingResult r = run(s);
  EXPECT_TRUE(r.vertices.empty());
  EXPECT_TRUE(r.mesh.tetrahedra.empty());
}

}  // namespace
}  // namespace delmesher::output::rounding_test
