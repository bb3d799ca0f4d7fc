#include "mesher/cdt/cdt.h"

#include <gtest/gtest.h>

#include "mesher/base/test_complaints.h"
#include "mesher/cdt/gift_wrapping.h"
#include "mesher/cdt/model_reference.h"
#include "mesher/cdt/test_models.h"
#include "mesher/cdt/validate.h"

namespace delmesher::cdt {
namespace {

using namespace test_models;

CdtResult expect_good(const Surface& surface) {
  Model model(surface);
  EXPECT_TRUE(model.valid);
  if (!model.valid) return {};
  CdtResult result = model.run();
  EXPECT_EQ(model.wrong(result), "");
  const CdtCounters& n = result.counters;
  EXPECT_EQ(n.facet_restarts, 0U);
  // A patch has at least one missing triangle, and the largest cavity is one of the cavities
  // counted.
  EXPECT_GE(n.missing_triangles, n.patches);
  EXPECT_GE(n.cavity_tetrahedra, n.largest_cavity);
  EXPECT_LE(n.cavity_tetrahedra, n.patches * n.largest_cavity);
  return result;
}

TEST(Cdt, Cube) {
  const CdtResult result = expect_good(box(-1, 2));
  EXPECT_TRUE(result.steiner.empty());
  EXPECT_EQ(result.mesh.boundary.size(), 12U);
  for (const RegionId region : result.mesh.region) EXPECT_EQ(region, kInside);
}

// A facet's plane is described from a vertex off it. Here the neighbours of the facet's first
// triangle lie in the facet, and of the tetrahedron of other candidates (the surface's first
// triangle 0 4 3 and the first vertex off its plane, 5) only vertex 3 does not.
TEST(Cdt, AFacetsPlaneIsDescribedFromAnyVertexOffIt) {
  Surface s;
  s.vertices = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};
  s.triangles = {{0, 4, 3}, {5, 4, 6}, {4, 0, 6}, {5, 1, 4}, {6, 2, 5},
                 {4, 1, 3}, {1, 5, 3}, {5, 2, 3}, {2, 6, 3}, {6, 0, 3}};
  expect_good(s);
}

// The checker itself must notice the defects that it is there for.
TEST(Cdt, CheckerNoticesDefects) {
  Model model(twisted_prism(3, 0.5, 1, true));
  ASSERT_TRUE(model.valid);
  const CdtResult good = model.run();
  ASSERT_EQ(model.wrong(good), "");
  CdtResult bad = good;
  bad.mesh.region[0] ^= 1;
  EXPECT_EQ(model.wrong(bad), "volume inside differs from the solid's");
  bad = good;
  bad.mesh.boundary.pop_back();
  EXPECT_EQ(model.wrong(bad), "facet not covered exactly");
  bad = good;
  std::swap(bad.mesh.boundary[0].vertices[0], bad.mesh.boundary[0].vertices[1]);
  EXPECT_EQ(model.wrong(bad), "face turned over");
  bad = good;
  std::swap(bad.mesh.tetrahedra[0][0], bad.mesh.tetrahedra[0][1]);
  EXPECT_EQ(model.wrong(bad), "tetrahedron not positive");
  bad = good;
  for (auto& chain : bad.chain) {
    if (!chain.empty()) chain.pop_back();
  }
  EXPECT_EQ(model.wrong(bad), "chain without its ends");
}

// Without the place in the code.
template <class Check>
std::string reason_of(const Check& check) {
  const std::string text = complaint(check);
  return text == "nothing" ? "" : text.substr(text.rfind(": ") + 2);
}

TEST(Cdt, ValidateReportsBrokenPromises) {
  Model model(box(0, 8));
  const std::vector<SurfaceFace> surface = model.run().mesh.boundary;
  Tetrahedrization mesh(model.predicates);
  mesh.build(model.input.vertices, model.control);
  const Chains chains(model.input, model.points);
  EXPECT_EQ(reason_of([&] { validate_segments(mesh, chains); }), "");
  std::vector<RegionId> inside(mesh.capacity(), kOutside);
  TetId finite = 0;
  for (TetId t = 0; t < mesh.capacity(); ++t) {
    if (!mesh.alive(t) || mesh.is_ghost(t)) continue;
    inside[t] = 1;
    finite = t;
  }
  const auto said = [&](const std::vector<SurfaceFace>& faces, const auto& sides) {
    return reason_of([&] { validate_facets(mesh, chains, faces, sides, Partition::sides); });
  };
  EXPECT_EQ(said(surface, inside), "");
  std::vector<RegionId> other = inside;
  other[finite] = 0;
  EXPECT_EQ(said(surface, other), "regions change elsewhere than at a facet");
  std::vector<SurfaceFace> faces(surface.begin(), surface.end() - 1);
  EXPECT_EQ(said(faces, inside), "regions change elsewhere than at a facet");
  faces.push_back(faces[0]);
  EXPECT_EQ(said(faces, inside), "a triangle of a facet is there twice");
  faces = surface;
  faces[0].vertices[0] = static_cast<VertexId>(model.points.add_explicit(99, 0, 0));
  EXPECT_EQ(said(faces, inside), "a triangle of a facet is not a face");

  Model twisted(twisted_prism(3, 0.5, 1, true));
  Tetrahedrization delaunay(twisted.predicates);
  delaunay.build(twisted.input.vertices, twisted.control);
  const Chains edges(twisted.input, twisted.points);
  EXPECT_EQ(reason_of([&] { validate_segments(delaunay, edges); }), "a subsegment is not an edge");
}

// Three boxes in each other: of two sides the middle one is out; as regions each is its own.
TEST(Cdt, RegionsAreNumberedAndSidesAlternate) {
  Surface nested = box(0, 8);
  append(nested, inside_out(box(1, 7)));
  append(nested, box(2, 6));
  Model model(nested);
  const auto volume_of = [&](const CdtResult& result, RegionId region) -> mpq_class {
    ConformingMesh part;
    for (std::size_t t = 0; t < result.mesh.tetrahedra.size(); ++t) {
      if (result.mesh.region[t] == region) part.tetrahedra.push_back(result.mesh.tetrahedra[t]);
    }
    return volume(model.points, part) / 6;
  };
  const CdtResult sides = model.run();
  EXPECT_EQ(volume_of(sides, kOutside), 6 * 6 * 6 - 4 * 4 * 4);
  EXPECT_EQ(volume_of(sides, kInside), 8 * 8 * 8 - 6 * 6 * 6 + 4 * 4 * 4);
  model.input.partition = Partition::regions;
  const CdtResult regions = model.run();
  EXPECT_EQ(volume_of(regions, kOutside), 0);
  std::set<mpq_class> volumes;
  for (RegionId region = kInside; region < kInside + 3; ++region) {
    volumes.insert(volume_of(regions, region));
  }
  EXPECT_EQ(volumes,
            (std::set<mpq_class>{8 * 8 * 8 - 6 * 6 * 6, 6 * 6 * 6 - 4 * 4 * 4, 4 * 4 * 4}));
}

TEST(Cdt, StepsAreToldInTheirOrder) {
  Model model(box(0, 8));
  std::vector<CdtStep> steps;
  model.input.on_step = [&](CdtStep step) { steps.push_back(step); };
  model.run();
  EXPECT_EQ(steps, (std::vector<CdtStep>{CdtStep::delaunay, CdtStep::segments, CdtStep::facets,
                                         CdtStep::classify}));
}

// The claims of the first tetrahedron are checked like those of the others, and checking does not
// count as work.
TEST(Cdt, ValidateLooksAtAllAndCountsNothing) {
  Model model(box(0, 8));
  const std::vector<SurfaceFace> surface = model.run().mesh.boundary;
  Tetrahedrization mesh(model.predicates);
  mesh.build(model.input.vertices, model.control);
  const Chains chains(model.input, model.points);
  std::vector<RegionId> inside(mesh.capacity(), kOutside);
  for (TetId t = 0; t < mesh.capacity(); ++t)
    inside[t] = mesh.alive(t) && !mesh.is_ghost(t) ? kInside : kOutside;
  const PredicateCounters before = model.predicates.counters;
  EXPECT_EQ(reason_of([&] { validate_facets(mesh, chains, surface, inside, Partition::sides); }),
            "");
  const PredicateCounters& after = model.predicates.counters;
  EXPECT_EQ(before.filter, after.filter);
  EXPECT_EQ(before.support, after.support);
  EXPECT_EQ(before.extended, after.extended);
  EXPECT_EQ(before.exact, after.exact);
  EXPECT_EQ(before.symbolic, after.symbolic);
  ASSERT_TRUE(mesh.alive(0));
  inside[0] = 2;
  EXPECT_EQ(reason_of([&] { validate_facets(mesh, chains, surface, inside, Partition::sides); }),
            "a tetrahedron outside the hull is inside, or one of two sides is a third one");
}

// Three edges of a box end at each corner; a point inside an edge has a part of it on both sides.
TEST(Cdt, ValencesCountSubsegments) {
  Model model(box(0, 8));
  Chains chains(model.input, model.points);
  for (VertexId v = 0; v < 8; ++v) EXPECT_EQ(chains.valence(v), 3U);
  EXPECT_EQ(chains.valence(8), 0U);
  for (std::uint32_t e = 0; e < model.topology.edge_count(); ++e) {
    if (chains.first(e) == kNone) continue;
    const auto end = model.topology.edge_vertices(e);
    const VertexId v = model.points.add_on_segment(end[0], end[1], 0.75);
    const std::uint32_t n = chains.insert_after(chains.first(e), v, {0.25, 0.75});
    EXPECT_EQ(chains.valence(v), 2U);
    EXPECT_EQ(chains.node_of(v), n);
    EXPECT_EQ(chains.length(e), 8);
    EXPECT_EQ(chains.vertices(e), (std::vector<VertexId>{end[0], v, end[1]}));
  }
  for (VertexId v = 0; v < 8; ++v) EXPECT_EQ(chains.valence(v), 3U);
}

// Where a vertex in an edge has no parameter of its own, its distances from the ends say where.
TEST(Cdt, ExplicitPointsOnEdgesHaveTheirFractions) {
  Model model(box(0, 8));
  model.input.on_edge.resize(model.topology.edge_count());
  std::uint32_t edge = 0;
  while (model.topology.edge_is_flat[edge] != 0) ++edge;
  const auto end = model.topology.edge_vertices(edge);
  const Vec3 p = model.points.nearest(end[0]), q = model.points.nearest(end[1]);
  const VertexId v = model.points.add_explicit(0.75 * p[0] + 0.25 * q[0], 0.75 * p[1] + 0.25 * q[1],
                                               0.75 * p[2] + 0.25 * q[2]);
  model.input.on_edge[edge].push_back(v);
  const Chains chains(model.input, model.points);
  EXPECT_EQ(chains.vertices(edge), (std::vector<VertexId>{end[0], v, end[1]}));
  EXPECT_EQ(chains.next(chains.first(edge)).from, (std::array<double, 2>{0.25, 0.75}));
}

// A solid with the edge 0 1 from the origin to (1, 0, 0) on its border, and beside the edge at the
// given x the tips of three small tetrahedra, so that every ball through its ends has one of them
// inside. The first is the nearest to the edge: the reference for its first split.
Surface beside_an_edge(const Surface& solid, double x, const std::array<double, 3>& directions) {
  Surface s = solid;
  for (std::size_t i = 0; i < 3; ++i) {
    const double angle = directions[i] * M_PI / 180, c = std::cos(angle), d = std::sin(angle);
    const double off = i == 0 ? 0.01 : 0.0125, size = 0.02;
    const auto at = [&](double along, double radial, double across) -> Point {
      return {x + along * size, (off + radial * size) * c - across * size * d,
              (off + radial * size) * d + across * size * c};
    };
    Surface tip;
    tip.vertices = {at(0, 0, 0), at(0.3, 1, 0), at(-0.2, 1, 0.3), at(-0.1, 1, -0.35)};
    tip.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};
    append(s, tip);
  }
  return s;
}

// Where the edge 0 1 has been split, as fractions from 0; ascending.
std::vector<double> splits_of_first_edge(const Surface& s) {
  Model model(s);
  EXPECT_TRUE(model.valid);
  const CdtResult result = model.run();
  EXPECT_EQ(model.wrong(result), "");
  std::vector<double> splits;
  for (VertexId v = 0; v < model.points.size(); ++v) {
    const PointDefinition d = model.points.definition(v);
    if (d.kind != PointKind::on_segment || d.corner[0] + d.corner[1] != 1) continue;
    splits.push_back(model.points.nearest(v)[0]);
  }
  std::sort(splits.begin(), splits.end());
  return splits;
}

bool has(const std::vector<double>& splits, double place, double tolerance) {
  return std::any_of(splits.begin(), splits.end(),
                     [&](double x) { return std::fabs(x - place) <= tolerance; });
}

// The rule of Si and Gaertner: with no acute end, at the reference's distance from the nearer one.
TEST(Cdt, WithNoAcuteEndTheNearerOneDecidesWhereAnEdgeIsSplit) {
  Surface cube = box(0, 1);
  const auto number = [&](const Point& p) {
    return static_cast<std::uint32_t>(std::find(cube.vertices.begin(), cube.vertices.end(), p) -
                                      cube.vertices.begin());
  };
  // The edge from the origin first.
  std::array<std::uint32_t, 2> ends = {number({0, 0, 0}), number({1, 0, 0})};
  for (std::uint32_t k = 0; k < 2; ++k) {
    std::swap(cube.vertices[k], cube.vertices[ends[k]]);
    for (auto& t : cube.triangles) {
      for (std::uint32_t& v : t) v = v == k ? ends[k] : v == ends[k] ? k : v;
    }
    if (ends[1] == k) ends[1] = ends[0];
  }
  ASSERT_EQ(cube.vertices[0], (Point{0, 0, 0}));
  ASSERT_EQ(cube.vertices[1], (Point{1, 0, 0}));
  const double radius = std::hypot(0.3, 0.01);
  for (const bool near_end : {true, false}) {
    const std::vector<double> splits =
        splits_of_first_edge(beside_an_edge(cube, near_end ? 0.3 : 0.7, {210, 120, 320}));
    EXPECT_TRUE(has(splits, near_end ? radius : 1 - radius, 1e-5)) << near_end;
    EXPECT_FALSE(has(splits, 0.5, 0.01)) << near_end;
  }
}

// With one acute end, on the sphere around it through the reference, unless that is outside the
// central 60 %: then in the middle.
TEST(Cdt, AnEdgeIsSplitOnTheSphereAroundItsAcuteEnd) {
  Surface solid;
  solid.vertices = {{0, 0, 0}, {1, 0, 0}, {1.3, 1, 0}, {1.3, -0.1, 1}};
  solid.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  const std::array<double, 3> directions = {230, 130, 330};
  const std::vector<double> near = splits_of_first_edge(beside_an_edge(solid, 0.3, directions));
  EXPECT_TRUE(has(near, std::hypot(0.3, 0.01), 1e-12));
  EXPECT_FALSE(has(near, 0.5, 0.01));
  EXPECT_TRUE(has(splits_of_first_edge(beside_an_edge(solid, 0.9, directions)), 0.5, 0));
  EXPECT_TRUE(has(splits_of_first_edge(beside_an_edge(solid, 0.1, directions)), 0.5, 0));
}

// Cannot be tetrahedrized without further vertices.
TEST(Cdt, Schoenhardt) {
  for (const double twist : {0.5, 0.2, 0.01, 1e-6, 1e-12}) {
    const CdtResult result = expect_good(twisted_prism(3, twist, 1, true));
    EXPECT_FALSE(result.steiner.empty()) << twist;
    EXPECT_LT(result.steiner.size(), 200U) << twist;
  }
}

TEST(Cdt, TwistedPrisms) {
  for (const int n : {4, 5, 8, 13}) {
    for (const double height : {0.05, 1.0, 7.0}) {
      expect_good(twisted_prism(n, 0.3 / n, height, true));
      expect_good(twisted_prism(n, 0.3 / n, height, false));
    }
  }
}

TEST(Cdt, CosphericalPrisms) {
  for (const int n : {4, 6, 12, 48}) expect_good(twisted_prism(n, 0, 1, n % 4 == 0));
}

TEST(Cdt, Chazelle) {
  for (const int n : {1, 2, 4}) {
    for (const double gap : {1.0, 0x1p-6, 0x1p-20}) expect_good(chazelle(n, gap));
  }
}

TEST(Cdt, PerforatedPlates) {
  for (std::uint32_t seed = 0; seed < 6; ++seed) {
    for (const double thickness : {4.0, 0.25, 0x1p-6}) {
      const int n = 3 + 2 * static_cast<int>(seed);
      expect_good(perforated_plate(n, thickness, seed));
    }
  }
}

TEST(Cdt, RegularVoxels) {
  std::vector<double> planes;
  for (int i = 0; i <= 9; ++i) planes.push_back(i);
  const CdtResult result = expect_good(voxels({planes, planes, planes}, [](int i, int j, int k) {
    return (i % 2 == 0) + (j % 2 == 0) + (k % 2 == 0) >= 2;
  }));
  EXPECT_TRUE(result.steiner.empty());
}

TEST(Cdt, Stars) {
  for (std::uint32_t seed = 0; seed < 5; ++seed) expect_good(star(2, 0.05, seed));
}

TEST(Cdt, LargeMissingRegions) {
  for (const double gap : {0x1p-6, 0x1p-10}) {
    const CdtResult result = expect_good(plate_between_crumbs(8, gap, 1));
    // Otherwise the test says nothing about facet recovery.
    EXPECT_GT(result.counters.largest_cavity, 200U);
    EXPECT_GT(result.counters.wrapped_tetrahedra, 0U);
  }
}

TEST(Cdt, NestedCubes) {
  Surface s = box(0, 8);
  append(s, inside_out(box(1, 7)));
  append(s, box(2, 6));
  append(s, inside_out(box(3, 5)));
  append(s, box(20, 21));
  const CdtResult result = expect_good(s);
  EXPECT_FALSE(result.mesh.tetrahedra.empty());
}

// Edges between others that run along them: the points on all of them have to lie on the same
// spheres up to the square of their distance, or the splitting multiplies with every bit of it.
TEST(Cdt, NestedShellsDownTo1e14) {
  const double radius[6] = {0.625, 0.6537, 0.638, 0.93, 0.79, 0.907};
  const Surface octahedron = {
      {},
      {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}},
      {}};
  for (const double gap : {0x1p-28, 0x1p-46}) {
    Surface s;
    double scale = 1;
    for (int shell = 0; shell < 4; ++shell, scale *= 1 - gap) {
      Surface part = octahedron;
      for (std::size_t i = 0; i < 6; ++i) {
        Point p = {0, 0, 0};
        p[i / 2] = (i % 2 == 0 ? 1 : -1) * scale * radius[i];
        part.vertices.push_back(p);
      }
      append(s, part);
    }
    Model model(s);
    ASSERT_TRUE(model.valid);
    const CdtResult result = model.run();
    EXPECT_GT(result.steiner.size(), 100U);
    EXPECT_LT(result.steiner.size(), 8000U) << gap;
  }
}

TEST(Cdt, NeedlesDownTo1e12) {
  for (const double angle : {1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12}) {
    const CdtResult result = expect_good(needles(6, angle, 7));
    EXPECT_LT(result.steiner.size(), 5000U) << angle;
  }
}

// Two parameters give at most twice the precision of a double.
TEST(Cdt, NeedlesDownTo1e32) {
  for (const double angle : {1e-3, 1e-15, 1e-17, 1e-20, 1e-25, 1e-30, 1e-32}) {
    const CdtResult result = expect_good(needle_among_obstacles(angle, 3));
    EXPECT_LT(result.steiner.size(), 500U) << angle;
  }
  Model model(needle_among_obstacles(1e-40, 3));
  ASSERT_TRUE(model.valid);
  EXPECT_THROW(model.run(), Stopped);  // at once, not after filling all memory
}

TEST(Cdt, ScalesWithTheInput) {
  for (const Surface& s : {star(2, 0.1, 3), perforated_plate(7, 0.25, 1)}) {
    const CdtResult original = expect_good(s);
    for (const double factor : {0x1p-10, 0x1p20, 0x1p-120}) {
      Surface scaled = s;
      for (auto& p : scaled.vertices) {
        for (double& x : p) x *= factor;
      }
      Model model(scaled);
      ASSERT_TRUE(model.valid);
      const CdtResult result = model.run();
      EXPECT_EQ(result.mesh.tetrahedra, original.mesh.tetrahedra);
      EXPECT_EQ(result.mesh.region, original.mesh.region);
    }
  }
}

// Labels split a plane into facets; facets without any vertex off the plane around them.
TEST(Cdt, LabelledPatches) {
  std::vector<double> planes;
  for (int i = 0; i <= 7; ++i) planes.push_back(i);
  Surface s = voxels({planes, planes, {0, 0.5}}, [](int, int, int) { return true; });
  for (std::size_t t = 0; t < s.triangles.size(); ++t) {
    double x = 0, y = 0;
    for (const std::uint32_t v : s.triangles[t]) {
      x += s.vertices[v][0] / 3;
      y += s.vertices[v][1] / 3;
    }
    s.labels.push_back((x > 3 && x < 4) || (y > 2 && y < 5 && x < 6) ? 1 : 0);
  }
  const CdtResult result = expect_good(s);
  std::set<FacetId> facets;
  for (const SurfaceFace& f : result.mesh.boundary) facets.insert(f.facet);
  EXPECT_GT(facets.size(), 6U);
}

// Slabs squashed so that large facets, with walls already near them, are missing.
TEST(Cdt, SquashedSlabs) {
  std::uint64_t blocked = 0;
  for (const std::uint32_t seed : {7U, 14U, 30U}) {
    Surface s = slabs(3, 0.01, seed);
    for (auto& p : s.vertices) p[2] *= 0.01;
    const CdtResult result = expect_good(s);
    blocked += result.counters.blocked_tetrahedra;
  }
  EXPECT_GT(blocked, 10U);       // otherwise the test says nothing about walls in the cavities
  EXPECT_LT(blocked, 1000000U);  // far more than the tetrahedra that there ever were
}

// The solid itself is a polyhedron with constrained Delaunay faces: filled from its faces alone, in
// any way, it must give the same tetrahedra, because these are unique.
TEST(Cdt, SolidIsFilledInOneWayOnly) {
  std::uint64_t hidden = 0, blocked = 0;
  Surface nested = box(0, 8);
  append(nested, inside_out(box(1, 7)));
  for (const Surface& s : {twisted_prism(3, 0.5, 1, true), star(1, 0.05, 3), star(2, 0.3, 4),
                           perforated_plate(5, 0.25, 1), chazelle(2, 1), nested}) {
    Model model(s);
    ASSERT_TRUE(model.valid);
    const CdtResult result = model.run();
    std::set<Tetrahedron> expected;
    for (std::size_t n = 0; n < result.mesh.tetrahedra.size(); ++n) {
      Tetrahedron t = result.mesh.tetrahedra[n];
      std::sort(t.begin(), t.end());
      if (result.mesh.region[n] != kOutside) expected.insert(t);
    }
    std::vector<Triangle> faces;
    std::set<VertexId> used;
    for (const SurfaceFace& f : result.mesh.boundary) {
      faces.push_back(f.vertices);
      used.insert(f.vertices.begin(), f.vertices.end());
    }
    const auto as_set = [](std::vector<Tetrahedron> list) {
      for (Tetrahedron& t : list) std::sort(t.begin(), t.end());
      return std::set<Tetrahedron>(list.begin(), list.end());
    };
    std::vector<Tetrahedron> filled, wrapped;
    PolyhedronFiller filler(model.predicates, model.control);
    EXPECT_TRUE(filler.fill(faces, {}, filled));
    EXPECT_EQ(as_set(filled), expected);
    blocked += filler.counters().blocked;
    FillCounters counters;
    EXPECT_TRUE(gift_wrap(model.predicates, model.control, faces, {used.begin(), used.end()},
                          wrapped, counters));
    EXPECT_EQ(as_set(wrapped), expected);
    hidden += counters.hidden;
  }
  EXPECT_GT(hidden, 20U);  // otherwise the test says nothing about visibility
  EXPECT_GT(blocked, 20U);
}

// ------------------------------------------------------------------------------------- enriched

std::size_t used_vertices(const CdtResult& result) {
  std::set<VertexId> used;
  for (const auto& t : result.mesh.tetrahedra) used.insert(t.begin(), t.end());
  return used.size();
}

TEST(Cdt, Enriched) {
  std::uint32_t seed = 1;
  for (const Surface& s : {box(0, 1), perforated_plate(5, 0.25, 2), star(1, 0.1, 5),
                           chazelle(2, 0.5), twisted_prism(3, 0.5, 1, true), needles(6, 1e-3, 1)}) {
    for (const int density : {1, 3}) {
      Model model(s);
      ASSERT_TRUE(model.valid);
      enrich(model, density, seed++);
      const CdtResult result = model.run();
      EXPECT_EQ(model.wrong(result), "");
      EXPECT_EQ(result.counters.facet_restarts, 0U);
      EXPECT_EQ(used_vertices(result), model.input.vertices.size() + result.steiner.size());
    }
  }
}

// All tetrahedra of the vertex just above the middle of the upper facet reach through that to the
// ring below: cut by it, they leave the vertex on no face of the polyhedra to be filled.
TEST(Cdt, VertexOnNoFaceOfACavityStays) {
  Model model(box(0, 64));
  ASSERT_TRUE(model.valid);
  const auto add = [&](double x, double y, double z) {
    model.input.vertices.push_back(model.points.add_explicit(x, y, z));
  };
  add(32, 32, 65);
  add(33, 32, 76);
  add(32, 33, 54);
  for (const double x : {22, 42}) {
    for (const double y : {23, 41}) add(x, y, 62);
  }
  const CdtResult result = model.run();
  EXPECT_GT(result.counters.isolated_vertices, 0U);
  EXPECT_EQ(model.wrong(result), "");
  EXPECT_EQ(result.counters.facet_restarts, 0U);
  EXPECT_EQ(used_vertices(result), model.input.vertices.size() + result.steiner.size());
}

// Progress and the limit of vertices count no more vertices than there are.
TEST(Cdt, ALimitOfAllVerticesIsEnough) {
  // Only every 64th poll looks at the limit: with 64 different beginnings, each poll does once.
  std::size_t asked = 0;
  for (int begun = 0; begun < 64; ++begun) {
    Model model(plate_between_crumbs(4, 0x1p-6, 1));
    ASSERT_TRUE(model.valid);
    for (int i = 0; i < begun; ++i) model.control.poll();
    model.options.progress = [&](const Progress& progress) {
      EXPECT_LE(progress.vertices, model.points.size());
      ++asked;
      return true;
    };
    const CdtResult result = model.run();
    EXPECT_GT(result.counters.largest_cavity, 0U);  // facets were missing
  }
  EXPECT_GT(asked, 100U);
}

// An edge begins at all of its first end and ends at all of its last.
TEST(Cdt, ChainsBeginAndEndWithWholeFractions) {
  const Model model(box(0, 8));
  const Chains chains(model.input, model.points);
  int edges = 0;
  for (std::uint32_t e = 0; e < model.topology.edge_count(); ++e) {
    const std::uint32_t n = chains.first(e);
    if (n == kNone) continue;
    ++edges;
    const std::array<double, 2> first = chains.node(n).from, last = chains.next(n).from;
    EXPECT_EQ(first, (std::array<double, 2>{0, 1}));
    EXPECT_EQ(last, (std::array<double, 2>{1, 0}));
  }
  EXPECT_EQ(edges, 12);
}

TEST(Cdt, StopsWhenTold) {
  Model model(star(3, 0.05, 1));
  ASSERT_TRUE(model.valid);
  model.options.max_vertices = 300;
  EXPECT_THROW(model.run(), Stopped);
}

}  // namespace
}  // namespace delmesher::cdt
