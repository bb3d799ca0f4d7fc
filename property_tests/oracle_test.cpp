// The oracles accept good meshes and measure small damage; mutations/ does large damage.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "oracles/envelope.h"
#include "oracles/surface/input_surface.h"
#include "oracles/verify.h"
#include "property_tests/samples.h"

namespace tetproof::oracle_test {
namespace {

using namespace oracles;  // NOLINT
using samples::Sample;

VerifyReport run(const Sample& sample, const delmesher::ExactRecord* exact = nullptr,
                 const VerifyOptions& options = {}) {
  VerifyReport report;
  EXPECT_EQ(verify(sample.input, sample.mesh, exact, options, report), "");
  return report;
}

void expect_verdict(const Sample& sample, Verdict verdict) {
  const VerifyReport report = run(sample);
  EXPECT_EQ(report.verdict, verdict) << to_text(report);
  EXPECT_GE(report.oracles.size(), 5U);
  for (const OracleReport& oracle : report.oracles) EXPECT_GT(oracle.checked, 0U) << oracle.name;
}

TEST(Oracles, AcceptExactMeshes) {
  expect_verdict(samples::cube(), Verdict::exact);
  expect_verdict(samples::l_shape(), Verdict::exact);
  expect_verdict(samples::hollow_cube(), Verdict::exact);
  expect_verdict(samples::cube_in_hull(), Verdict::exact);
}

TEST(Oracles, CallRoundedMeshesRounded) {
  expect_verdict(samples::skewed(samples::cube()), Verdict::rounded);
  expect_verdict(samples::skewed(samples::l_shape()), Verdict::rounded);
}

TEST(Oracles, AcceptEverythingScaledByPowersOfTwo) {
  for (const double scale : {0x1p-40, 0x1p30}) {
    Sample sample = samples::skewed(samples::l_shape());
    for (auto* list : {&sample.input.vertices, &sample.mesh.vertices}) {
      for (Position& p : *list) {
        for (double& x : p) x *= scale;
      }
    }
    expect_verdict(sample, Verdict::rounded);
  }
}

TEST(Oracles, AnInsideOutSurfaceIsTheSameSolid) {
  Sample sample = samples::hollow_cube();
  for (auto& triangle : sample.input.triangles) std::swap(triangle[0], triangle[1]);
  expect_verdict(sample, Verdict::exact);
}

// Options for a mesh of the solid without any promise of quality.
VerifyOptions solid_only() {
  VerifyOptions options;
  options.promised.task = Task::cdt;
  return options;
}

TEST(Oracles, AcceptAnExactRecord) {
  const samples::ExactSample sample = samples::exact_sample();
  const VerifyReport report = run(sample.sample, &sample.exact, solid_only());
  EXPECT_EQ(report.verdict, Verdict::rounded) << to_text(report);
  EXPECT_NE(report.find("exact-conformity"), nullptr);
  EXPECT_NE(report.find("exact-volume"), nullptr);
}

TEST(Oracles, RefuseInputThatIsNoSolid) {
  Sample sample = samples::cube();
  sample.input.triangles.pop_back();
  VerifyReport report;
  EXPECT_NE(verify(sample.input, sample.mesh, nullptr, {}, report).find("open"), std::string::npos);
}

TEST(Oracles, AnEmptyMeshIsBroken) {
  Sample sample = samples::cube();
  sample.mesh = {};
  EXPECT_EQ(run(sample).verdict, Verdict::broken);
}

// ----------------------------------------------------------------------------------------- damage

Index vertex_at(const Sample& sample, const Position& p) {
  for (Index v = 0; v < sample.mesh.vertices.size(); ++v) {
    if (sample.mesh.vertices[v] == p) return v;
  }
  ADD_FAILURE() << "no such vertex";
  return 0;
}

double up(double x) {
  return std::nextafter(x, std::numeric_limits<double>::infinity());
}

// What an oracle says in words it says in numbers, too.
std::vector<std::vector<Index>> sites(const VerifyReport& report, const char* oracle,
                                      Site::Kind kind) {
  std::vector<std::vector<Index>> found;
  const OracleReport* said = report.find(oracle);
  if (said == nullptr) return found;
  for (const Site& site : said->sites) {
    const std::size_t numbers = kSiteKinds[static_cast<std::size_t>(kind)].numbers;
    if (site.kind == kind) {
      found.emplace_back(site.numbers.begin(),
                         site.numbers.begin() + static_cast<std::ptrdiff_t>(numbers));
    }
  }
  return found;
}

TEST(OracleDamage, HasAPlace) {
  Sample sample = samples::cube();
  std::swap(sample.mesh.tetrahedra[3][0], sample.mesh.tetrahedra[3][1]);
  sample.mesh.vertices.push_back({0.3, 0.3, 0.3});
  VerifyReport report = run(sample);
  using Numbers = std::vector<std::vector<Index>>;
  EXPECT_EQ(sites(report, "orientation", Site::Kind::tetrahedron), Numbers{{3}});
  EXPECT_EQ(sites(report, "complex", Site::Kind::vertex),
            (Numbers{{static_cast<Index>(sample.mesh.vertices.size() - 1)}}));
  EXPECT_FALSE(sites(report, "complex", Site::Kind::face).empty());

  sample = samples::cube();
  const Index moved = vertex_at(sample, {0.5, 0.5, 1});
  sample.mesh.vertices[moved][2] += 0x1p-4;
  report = run(sample);
  EXPECT_EQ(sites(report, "conformity", Site::Kind::vertex), Numbers{{moved}}) << to_text(report);
  const Numbers triangles = sites(report, "conformity", Site::Kind::input_triangle);
  ASSERT_EQ(triangles.size(), 2U);
  for (const std::vector<Index>& t : triangles) {
    for (const Index v : sample.input.triangles[t[0]]) EXPECT_EQ(sample.input.vertices[v][2], 1);
  }

  sample = samples::cube();
  std::swap(sample.mesh.boundary[4], sample.mesh.boundary.back());
  const std::array<Index, 3> lost = sample.mesh.boundary.back();
  sample.mesh.boundary.back() = sample.mesh.boundary[0];
  sample.mesh.labels.clear();
  report = run(sample);
  EXPECT_EQ(sites(report, "boundary-list", Site::Kind::listed_triangle),
            (Numbers{{static_cast<Index>(sample.mesh.boundary.size() - 1)}}));
  const Numbers faces = sites(report, "boundary-list", Site::Kind::face);
  ASSERT_EQ(faces.size(), 1U);
  EXPECT_TRUE(std::is_permutation(lost.begin(), lost.end(), faces[0].begin()));

  VerifyOptions near;
  sample = samples::cube();
  sample.mesh.vertices[moved][2] += 0x1p-4;
  ASSERT_EQ(verify_envelope(sample.input, sample.mesh, 1e-3, near, report), "");
  const std::vector<Position>& points = report.find("envelope")->points;
  ASSERT_FALSE(points.empty());
  EXPECT_NEAR(points[0][2], 1 + 0x1p-4, 0x1p-10);
}

TEST(OracleDamage, OneUlpOffAFacetIsNoLongerExact) {
  Sample sample = samples::cube();
  double& z = sample.mesh.vertices[vertex_at(sample, {0.5, 0.5, 1})][2];
  z = up(z);
  const VerifyReport report = run(sample);
  EXPECT_EQ(report.verdict, Verdict::rounded) << to_text(report);
  EXPECT_NEAR(report.deviation, 0x1p-52, 0x1p-60);
}

TEST(OracleDamage, ALargerMoveIsMeasured) {
  Sample sample = samples::cube();
  sample.mesh.vertices[vertex_at(sample, {0.5, 0.5, 1})][2] += 0x1p-20;
  const VerifyReport report = run(sample);
  EXPECT_EQ(report.verdict, Verdict::deviating) << to_text(report);
  EXPECT_NEAR(report.deviation, 0x1p-20, 0x1p-30);
  EXPECT_TRUE(failed(report, {}));
  EXPECT_FALSE(failed(report, {.declared_deviation = 1e-6}));
}

TEST(OracleDamage, AnInputCornerMovedByOneUlpIsMeasured) {
  Sample sample = samples::cube();
  double& x = sample.mesh.vertices[vertex_at(sample, {1, 1, 1})][0];
  x = up(x);
  EXPECT_EQ(run(sample).verdict, Verdict::rounded);
}

// Adds a sliver to a refined cube: on two boundary triangles of the face z = 1, spanning their four
// corners, one of which has been raised by `rise`.
Sample cube_with_sliver(double rise) {
  Sample sample = samples::cube();
  auto& mesh = sample.mesh;
  const Index raised = vertex_at(sample, {0.5, 0.5, 1});
  const auto flat = [&](const std::array<Index, 3>& t) {
    return std::all_of(t.begin(), t.end(), [&](Index v) { return mesh.vertices[v][2] == 1; });
  };
  std::array<Index, 3> first{};
  for (const auto& t : mesh.boundary) {
    if (flat(t) && std::find(t.begin(), t.end(), raised) != t.end()) first = t;
  }
  while (first[0] != raised) std::rotate(first.begin(), first.begin() + 1, first.end());
  for (const auto& t : mesh.boundary) {
    for (int i = 0; i < 3 && flat(t); ++i) {
      if (t[i] != first[2] || t[(i + 1) % 3] != first[1]) continue;
      mesh.tetrahedra.push_back({raised, t[(i + 2) % 3], first[1], first[2]});
      mesh.regions.push_back(mesh.regions.empty() ? 1 : mesh.regions[0]);
    }
  }
  mesh.regions.resize(mesh.tetrahedra.size(), 1);
  mesh.boundary.clear();
  mesh.labels.clear();
  mesh.vertices[raised][2] = 1 + rise;
  return sample;
}

TEST(Oracles, ARoundedSliverAlongTheSurfaceKeepsItsRegion) {
  Sample sample = cube_with_sliver(0x1p-52);
  VerifyReport report = run(sample);
  EXPECT_EQ(report.verdict, Verdict::rounded) << to_text(report);
  sample.mesh.regions.clear();  // tetrahedra inside only, without any number
  report = run(sample);
  EXPECT_EQ(report.verdict, Verdict::rounded) << to_text(report);
}

TEST(OracleDamage, AThickSliverOutsideIsCaught) {
  EXPECT_EQ(run(cube_with_sliver(0.125)).verdict, Verdict::broken);
}

// Still a conforming mesh, but not the one in the file.
TEST(OracleDamage, APointMovedAlongItsSegmentIsFarFromTheFile) {
  samples::ExactSample sample = samples::exact_sample();
  sample.exact.points[4].x = 0.5;
  EXPECT_FALSE(run(sample.sample, &sample.exact, solid_only()).find("rounding")->passed());
}

// ---------------------------------------------------------------------------------- refined stage

TEST(RefinedStage, AnglesAreCertifiedOnBothSidesOfTheBound) {
  const Sample sample = samples::cube();  // smallest face angle atan(1 / sqrt 2)
  const double smallest = std::atan(std::sqrt(0.5)) * 180 / 3.14159265358979323846;
  VerifyOptions options{.stage = Stage::refined};
  options.promised.planar = 0;
  options.promised.delta = smallest - 1e-6;
  EXPECT_TRUE(run(sample, nullptr, options).find("angles")->passed());
  options.promised.delta = smallest + 1e-6;
  const VerifyReport report = run(sample, nullptr, options);
  EXPECT_FALSE(report.find("angles")->passed());
  EXPECT_EQ(report.verdict, Verdict::broken);
}

// With planar facets, vertices may be written 2^-18 of the diagonal from where they were refined.
// That turns an edge of the cube by at most 2 * sqrt(3) * 2^-18 radians or 8e-4 degrees, and the
// two sides of an angle by twice that.
TEST(RefinedStage, AnglesOfAFileAloneAreUndecidedWherePlanarFacetsExplainThem) {
  const Sample sample = samples::cube();
  const double smallest = std::atan(std::sqrt(0.5)) * 180 / 3.14159265358979323846;
  VerifyOptions options{.stage = Stage::refined};
  options.promised.delta = smallest + 1e-6;
  const VerifyReport report = run(sample, nullptr, options);
  EXPECT_TRUE(report.find("angles")->undecided);
  EXPECT_EQ(report.verdict, Verdict::undecided);
  options.promised.delta = smallest + 1e-2;
  EXPECT_EQ(run(sample, nullptr, options).verdict, Verdict::broken);
}

TEST(RefinedStage, BadTetrahedraOutsideTheSolidAreLeftAlone) {
  Sample sample = samples::cube_in_hull();
  // Flatten a corner of the hull away from the solid, without inverting anything.
  sample.mesh.vertices[vertex_at(sample, {1, 1, 1})] = {0.76, 0.76, 0.76};
  VerifyOptions options{.stage = Stage::refined};
  options.promised.delta = 30;
  EXPECT_TRUE(run(sample, nullptr, options).find("angles")->passed());
  options.promised.region = delmesher::Region::hull;
  EXPECT_FALSE(run(sample, nullptr, options).find("angles")->passed());
}

delmesher::ExactRecord refined_record(const Sample& sample) {
  delmesher::ExactRecord record;
  record.points = explicit_points(sample.input.vertices);
  for (const Position& p : sample.mesh.vertices) {
    const auto same = std::find(sample.input.vertices.begin(), sample.input.vertices.end(), p);
    record.mesh_vertices.push_back(static_cast<Index>(same != sample.input.vertices.end()
                                                          ? same - sample.input.vertices.begin()
                                                          : record.points.size()));
    if (same == sample.input.vertices.end()) {
      record.points.push_back(explicit_points(std::span(&p, 1))[0]);
    }
  }
  for (std::size_t t = 0; t < sample.mesh.tetrahedra.size(); ++t) {
    Tet tet = sample.mesh.tetrahedra[t];
    for (Index& v : tet) v = record.mesh_vertices[v];
    record.refined.push_back({tet, sample.mesh.regions[t] == 1});
  }
  for (Face f : sample.mesh.boundary) {
    for (Index& v : f) v = record.mesh_vertices[v];
    record.refined_facets.push_back({f[0], f[1], f[2], kNone});
  }
  // Names the facets as the oracle itself finds them.
  ExactPoints points;
  points.assign(record.points);
  InputSurface surface;
  surface.assign(sample.input, points);
  for (auto& [a, b, c, id] : record.refined_facets) {
    for (const InputSurface::Facet& facet : surface.facets()) {
      const auto on = [&](Index v) { return facet.side(points, v) == 0; };
      if (on(a) && on(b) && on(c)) id = facet.id;
    }
  }
  return record;
}

TEST(RefinedStage, AcceptsAndChecksARecord) {
  Sample sample = samples::cube_in_hull();  // Kuhn's subdivision is Delaunay, with ties
  VerifyOptions options{.stage = Stage::refined};
  options.promised.delta = 14;
  options.promised.region = delmesher::Region::hull;
  options.promised.approximate = true;
  delmesher::ExactRecord record = refined_record(sample);
  for (const auto& face : record.refined_facets) sample.mesh.facets.push_back(face[3]);
  const VerifyReport good = run(sample, &record, options);
  // Made by hand, it has no segments, and no chamfering that could be promised.
  for (const char* name :
       {"refined-complex", "refined-orientation", "refined-hull", "refined-angles",
        "refined-contained", "refined-delaunay", "same-mesh", "rounding"}) {
    EXPECT_TRUE(good.find(name)->passed()) << to_text(good);
  }
  EXPECT_GT(good.find("refined-delaunay")->checked, 100U);
  EXPECT_GT(good.find("refined-facets")->checked, 10U);

  delmesher::ExactRecord damaged = record;
  damaged.refined_facets[0][3] = 10000;
  EXPECT_FALSE(run(sample, &damaged, options).find("refined-facets")->passed());
  damaged = record;
  for (auto& tet : damaged.refined) tet.inside = true;
  EXPECT_FALSE(run(sample, &damaged, options).find("refined-contained")->passed());
  // Nor may all be called outside, even where a facet is said to be dropped.
  for (auto& tet : damaged.refined) tet.inside = false;
  damaged.facets = {{0, 0, 1, {0}}};
  const VerifyReport none = run(sample, &damaged, options);
  EXPECT_FALSE(none.find("refined-contained")->passed());
  EXPECT_GT(none.find("refined-contained")->violations, 0U);
  damaged = record;
  // Move an inner vertex by one ulp: its cells' corners are no longer cospherical.
  const Index v = record.mesh_vertices[vertex_at(sample, {0.5, 0.5, 0.5})];
  damaged.points[v].x = up(damaged.points[v].x);
  EXPECT_FALSE(run(sample, &damaged, options).find("refined-delaunay")->passed());
}

}  // namespace
}  // namespace tetproof::oracle_test
