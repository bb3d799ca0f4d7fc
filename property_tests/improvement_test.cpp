// Laws of the improvement of final meshes, asked of oracles that share nothing with it, and lies
// about it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "mesher/delmesher.h"
#include "oracles/improvement/local_operations.h"
#include "oracles/verify.h"
#include "property_tests/samples.h"

namespace tetproof::improvement_test {
namespace {

using namespace oracles;  // NOLINT
using delmesher::ExactRecord;
using delmesher::Options;
using delmesher::Result;
using samples::NamedSurface;

constexpr std::uint64_t kSeed = 1;

struct Told {
  samples::Sample sample;
  ExactRecord record;
  Promise promise;
  delmesher::Statistics statistics;

  VerifyReport verify() const {
    VerifyReport report;
    EXPECT_EQ(oracles::verify(sample.input, sample.mesh, &record,
                              {.stage = Stage::both, .promised = promise}, report),
              "");
    return report;
  }
};

Told run_of(const delmesher::Surface& surface, Options options = {}) {
  options.want_exact = true;
  const Result result = delmesher::tetrahedralize(surface, options);
  EXPECT_TRUE(result.status.ok()) << result.status.message;
  return {{samples::to_polyhedron(surface), samples::to_mesh(result.mesh)},
          result.exact,
          promise_of(options),
          result.statistics};
}

const Told& honest() {
  static const Told told = [] {
    Options options = samples::split_surface();
    options.tau = 0x1p-9;  // takes the slab apart
    return run_of(samples::wedge_and_slab(), options);
  }();
  return told;
}

class ImprovedModels : public testing::TestWithParam<NamedSurface> {};

// Both runs are the same up to the improvement: slivers are not treated in either.
TEST_P(ImprovedModels, AreNeverWorseThanWithoutIt) {
  for (const auto region : {delmesher::Region::interior, delmesher::Region::hull}) {
    Options options = samples::split_surface();
    options.region = region;
    const Told improved = run_of(GetParam().surface, options);
    const VerifyReport report = improved.verify();
    EXPECT_TRUE(samples::as_promised(report)) << to_text(report);
    options.improve = false;
    const Told plain = run_of(GetParam().surface, options);
    const auto &before = plain.statistics.final, &after = improved.statistics.final;
    EXPECT_GE(after.min_face_angle, std::min(before.min_face_angle, 14.47) - 1e-6);
    EXPECT_GE(after.min_dihedral,
              std::min({before.min_dihedral, 180 - before.max_dihedral, kImprovedDihedral}) - 1e-6);
    EXPECT_EQ(improved.record.refined.size(), plain.record.refined.size());
    const bool changed = !improved.record.unrepaired.empty();
    EXPECT_EQ((changed ? improved.record.unrepaired : improved.record.final).size(),
              plain.record.final.size());
  }
}

INSTANTIATE_TEST_SUITE_P(Improvement, ImprovedModels, testing::ValuesIn(samples::surfaces(kSeed)),
                         [](const auto& tested) { return tested.param.name; });

// A polyhedron inscribed in the unit sphere: no sharp corner or edge.
delmesher::Surface ball(int rounds) {
  delmesher::Surface s;
  s.vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  s.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                 {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int round = 0; round < rounds; ++round) {
    std::map<std::array<std::uint32_t, 2>, std::uint32_t> middle;
    const auto between = [&](std::uint32_t a, std::uint32_t b) {
      const std::array<std::uint32_t, 2> key = {std::min(a, b), std::max(a, b)};
      const auto [at, fresh] = middle.emplace(key, static_cast<std::uint32_t>(s.vertices.size()));
      if (fresh) {
        std::array<double, 3> x;
        for (int k = 0; k < 3; ++k) x[k] = s.vertices[a][k] + s.vertices[b][k];
        const double length = std::sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
        s.vertices.push_back({x[0] / length, x[1] / length, x[2] / length});
      }
      return at->second;
    };
    std::vector<std::array<std::uint32_t, 3>> finer;
    for (const auto& [a, b, c] : s.triangles) {
      const std::uint32_t x = between(a, b), y = between(b, c), z = between(c, a);
      finer.insert(finer.end(), {{a, x, z}, {b, y, x}, {c, z, y}, {x, y, z}});
    }
    s.triangles = finer;
  }
  return s;
}

TEST(Improvement, OfABallTakesLessAndIsRounder) {
  Options options = samples::split_surface();
  const auto improved = run_of(ball(3), options).statistics.final;
  options.improve = false;
  options.slivers = true;
  const auto treated = run_of(ball(3), options).statistics.final;
  EXPECT_LE(improved.tetrahedra, treated.tetrahedra);
  EXPECT_GT(improved.min_dihedral, treated.min_dihedral);
  EXPECT_GT(improved.min_dihedral, 12);
}

// A long edge takes the place of one that was as long, there and once.
TEST(Improvement, LongEdgesStayInTheirPlace) {
  const auto tetrahedron = [](std::vector<Position>& points, Position at, double size) {
    const auto first = static_cast<Index>(points.size());
    points.push_back(at);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      points.push_back(at);
      points.back()[axis] += size;
    }
    return ExactRecord::Tet{{first, first + 1, first + 2, first + 3}, true};
  };
  std::vector<Position> positions;
  const ExactRecord::Tet large = tetrahedron(positions, {0, 0, 0}, 10),
                         moved = tetrahedron(positions, {0.1, 0.1, 0.1}, 9.9),
                         again = tetrahedron(positions, {0.2, 0.2, 0.2}, 9.8),
                         elsewhere = tetrahedron(positions, {100, 0, 0}, 9),
                         small = tetrahedron(positions, {100, 0, 0}, 1),
                         other = tetrahedron(positions, {3, 3, 3}, 1);
  ExactPoints points;
  ASSERT_EQ(points.assign(positions), "");
  const auto judged = [&](const std::vector<ExactRecord::Tet>& after) {
    ExactRecord record;
    record.unrepaired = {large, small, other};
    record.final = after;
    Promise promise;
    promise.max_edge = 2;
    return check_improvement(record, points, promise).passed();
  };
  EXPECT_TRUE(judged({large, small, other}));
  EXPECT_TRUE(judged({moved, small, other}));
  EXPECT_TRUE(judged({small, other}));
  EXPECT_FALSE(judged({elsewhere, other}));
  EXPECT_FALSE(judged({moved, again, small}));
}

struct Lie {
  const char* what;
  const char* oracle;
  void (*tell)(Told&);
};

// The inner tetrahedra of the record, as numbers in `final`.
std::vector<std::size_t> inner(const ExactRecord& record) {
  std::vector<std::size_t> result;
  for (std::size_t n = 0; n < record.final.size(); ++n) {
    if (record.final[n].inside) result.push_back(n);
  }
  return result;
}

// A point close to a face of an inner tetrahedron splits it in file and record: all stay positive.
void flatten(Told& run, std::size_t n) {
  ExactPoints points;
  points.assign(run.record.points);
  const ExactRecord::Tet tet = run.record.final[n];
  Position x{};
  const double weight[4] = {0.334, 0.333, 0.3329, 0.0001};
  for (int i = 0; i < 4; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      x[axis] += weight[i] * points.nearest(tet.vertices[i])[axis];
    }
  }
  const auto in_record = static_cast<Index>(run.record.points.size());
  run.record.points.push_back(
      {delmesher::ExactPoint::Kind::explicit_point, 0, 0, 0, x[0], x[1], x[2]});
  const auto in_file = static_cast<Index>(run.sample.mesh.vertices.size());
  run.sample.mesh.vertices.push_back(x);
  run.record.mesh_vertices.push_back(in_record);
  const auto written = [&](Index v) {
    const auto& list = run.record.mesh_vertices;
    return static_cast<Index>(std::find(list.begin(), list.end(), v) - list.begin());
  };
  Tet same = tet.vertices;
  for (Index& v : same) v = written(v);
  std::sort(same.begin(), same.end());
  auto& tets = run.sample.mesh.tetrahedra;
  const auto found = std::find_if(tets.begin(), tets.end(), [&](Tet t) {
    std::sort(t.begin(), t.end());
    return t == same;
  });
  ASSERT_NE(found, tets.end());
  const Tet whole = *found;
  const std::int64_t region =
      run.sample.mesh.regions[static_cast<std::size_t>(found - tets.begin())];
  for (int i = 0; i < 4; ++i) {
    ExactRecord::Tet part = tet;
    part.vertices[i] = in_record;
    Tet file_part = whole;
    std::replace(file_part.begin(), file_part.end(), written(tet.vertices[i]), in_file);
    if (i == 0) {
      run.record.final[n] = part;
      *found = file_part;
    } else {
      run.record.final.push_back(part);
      run.sample.mesh.tetrahedra.push_back(file_part);
      run.sample.mesh.regions.push_back(region);
    }
  }
}

void add_flat_split(Told& run) {
  flatten(run, inner(run.record).front());
}

const Lie kLies[] = {
    {"a flat tetrahedron after the improvement", "improvement", add_flat_split},
    {"improved where that was not wanted", "repairs", [](Told& r) { r.promise.improve = false; }},
    {"an improved mesh told to be constrained Delaunay", "exact-constrained-delaunay",
     [](Told& r) {
       r.record.unrepaired.clear();
       r.record.unrepaired_facets.clear();
     }},
    {"the improved mesh told to be the one before", "unrepaired-constrained-delaunay",
     [](Told& r) {
       r.record.unrepaired = r.record.final;
       r.record.unrepaired_facets = r.record.final_facets;
     }},
    {"a mesh before that lacks a tetrahedron", "unrepaired-hull",
     [](Told& r) { r.record.unrepaired.erase(r.record.unrepaired.begin()); }},
    {"a mesh before on other facets", "unrepaired-facets",
     [](Told& r) { r.record.unrepaired_facets[0][3] = r.record.facets.back().id + 1; }},
    {"the mesh before, told to be the improved one", "same-mesh",
     [](Told& r) {
       r.record.final = r.record.unrepaired;
       r.record.final_facets = r.record.unrepaired_facets;
     }},
    {"a vertex of the surface moved off it", "exact-conformity",
     [](Told& r) {
       std::vector<std::uint8_t> final(r.record.points.size(), 0);
       for (const auto& face : r.record.final_facets) {
         for (int k = 0; k < 3; ++k) final[face[k]] = 1;
       }
       for (const auto& tet : r.record.unrepaired) {
         for (const Index v : tet.vertices) final[v] = 0;
       }
       const auto v = std::find(final.begin(), final.end(), 1) - final.begin();
       ASSERT_LT(static_cast<std::size_t>(v), final.size());
       ExactPoints points;
       points.assign(r.record.points);
       const Position x = points.nearest(static_cast<Index>(v));
       r.record.points[static_cast<std::size_t>(v)] = {delmesher::ExactPoint::Kind::explicit_point,
                                                       0,
                                                       0,
                                                       0,
                                                       x[0] + 0x1p-20,
                                                       x[1] + 0x1p-21,
                                                       x[2] + 0x1p-22};
     }},
};

TEST(Improvement, LiesAboutItAreCaught) {
  const VerifyReport good = honest().verify();
  ASSERT_TRUE(samples::as_promised(good)) << to_text(good);
  ASSERT_NE(good.find("improvement"), nullptr);
  EXPECT_TRUE(good.find("improvement")->promised);
  ASSERT_FALSE(honest().record.unrepaired_facets.empty());
  for (const Lie& lie : kLies) {
    Told told = honest();
    lie.tell(told);
    const VerifyReport report = told.verify();
    const OracleReport* oracle = report.find(lie.oracle);
    ASSERT_NE(oracle, nullptr) << lie.what << '\n' << to_text(report);
    EXPECT_FALSE(oracle->passed()) << lie.what << '\n' << to_text(report);
  }
}

// A bar of many cubes in a row.
delmesher::Surface bar(int length) {
  delmesher::Surface s;
  for (int x = 0; x <= length; ++x) {
    for (const auto& [y, z] :
         {std::pair(0, 0), std::pair(1, 0), std::pair(1, 1), std::pair(0, 1)}) {
      s.vertices.push_back(
          {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)});
    }
  }
  const auto quad = [&s](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    s.triangles.insert(s.triangles.end(), {{a, b, c}, {a, c, d}});
  };
  quad(0, 3, 2, 1);
  for (int x = 0; x < length; ++x) {
    const auto here = static_cast<std::uint32_t>(4 * x);
    for (std::uint32_t i = 0; i < 4; ++i) {
      const std::uint32_t j = (i + 1) % 4;
      quad(here + i, here + j, here + 4 + j, here + 4 + i);
    }
  }
  const auto last = static_cast<std::uint32_t>(4 * length);
  quad(last, last + 1, last + 2, last + 3);
  return s;
}

double along_bar(const ExactRecord& record, const ExactRecord::Tet& tet) {
  double x = 0;
  for (const Index v : tet.vertices) {
    if (v < record.points.size()) x += record.points[v].x / 4;
  }
  return x;
}

// The first one inside whose centre is near x; as many as there are if there is none.
std::size_t inside_near(const ExactRecord& record, const std::vector<ExactRecord::Tet>& tets,
                        double x) {
  const auto found = std::find_if(tets.begin(), tets.end(), [&](const auto& tet) {
    return tet.inside && std::fabs(along_bar(record, tet) - x) < 1;
  });
  return static_cast<std::size_t>(found - tets.begin());
}

// A tetrahedron that was inverted before the improvement excuses a flat one near it afterwards, and
// none far from it.
TEST(Improvement, IsNotExcusedByRoundingElsewhere) {
  Options options = samples::split_surface();
  options.improve = false;  // the mesh before and after is the same
  const Told plain = run_of(bar(40), options);
  ASSERT_TRUE(plain.record.unrepaired.empty());
  const auto judged = [&plain](double defect_at, double flat_at) {
    Told told = plain;
    told.promise.improve = true;
    ExactRecord& r = told.record;
    r.unrepaired = r.final;
    r.unrepaired_facets = r.final_facets;
    const std::size_t defect = inside_near(r, r.unrepaired, defect_at);
    EXPECT_LT(defect, r.unrepaired.size());
    std::swap(r.unrepaired[defect].vertices[0], r.unrepaired[defect].vertices[1]);
    const std::size_t flat = inside_near(r, r.final, flat_at);
    EXPECT_LT(flat, r.final.size());
    flatten(told, flat);
    ExactPoints points;
    points.assign(r.points);
    return check_improvement(r, points, told.promise);
  };
  const OracleReport near = judged(2, 3), far = judged(2, 36);
  EXPECT_TRUE(near.promised && near.passed()) << near.findings.at(0);
  EXPECT_FALSE(far.passed());
}

// Two slivers over the same square, the later one half as high: roundings do not tell, more does.
TEST(Improvement, WhichIsFlatterByRoundingsIsNotTold) {
  const auto passes = [](double before, double after) {
    ExactRecord record;
    const std::array<double, 3> places[] = {
        {0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, before}, {1, 1, after}};
    for (const auto& [x, y, z] : places) {
      record.points.push_back({delmesher::ExactPoint::Kind::explicit_point, 0, 0, 0, x, y, z});
    }
    record.unrepaired = {{{0, 2, 1, 3}, true}};
    record.final = {{{0, 2, 1, 4}, true}};
    ExactPoints points;
    points.assign(record.points);
    return check_improvement(record, points, {}).passed();
  };
  EXPECT_TRUE(passes(1e-9, 1e-9));
  EXPECT_FALSE(passes(1e-9, 5e-10));
  EXPECT_FALSE(passes(1e-9, -1e-9));
  EXPECT_TRUE(passes(1e-15, 5e-16));
}

// A worst tetrahedron that was there before allows no other one as bad at another place.
TEST(Improvement, IsNotExcusedByWhatIsAsBadElsewhere) {
  Options options = samples::split_surface();
  options.improve = false;
  Told told = run_of(bar(40), options);
  told.promise.improve = true;
  ExactRecord& r = told.record;
  ExactPoints points;
  flatten(told, inside_near(r, r.final, 2));
  r.unrepaired = r.final;
  r.unrepaired_facets = r.final_facets;
  points.assign(r.points);
  EXPECT_TRUE(check_improvement(r, points, told.promise).passed());
  flatten(told, inside_near(r, r.final, 36));
  points.assign(r.points);
  EXPECT_FALSE(check_improvement(r, points, told.promise).passed());
}

// If all vertices have moved, none of them is in the mesh before. Then its tetrahedra at the same
// place tell what was near, and the report how often.
TEST(Improvement, IsExcusedByWhatWasThereWhereAllVerticesMoved) {
  Options options = samples::split_surface();
  options.improve = false;
  const Told plain = run_of(bar(40), options);
  const auto judged = [&plain](double before, double after) {
    Told told = plain;
    told.promise.improve = true;
    ExactRecord& r = told.record;
    flatten(told, inside_near(r, r.final, before));
    r.unrepaired = r.final;
    r.final = plain.record.final;
    told.sample.mesh = plain.sample.mesh;
    r.mesh_vertices = plain.record.mesh_vertices;
    flatten(told, inside_near(r, r.final, after));
    const auto count = static_cast<Index>(r.points.size());
    const std::vector<delmesher::ExactPoint> same = r.points;
    r.points.insert(r.points.end(), same.begin(), same.end());
    for (ExactRecord::Tet& tet : r.final) {
      for (Index& v : tet.vertices) v += count;
    }
    ExactPoints points;
    points.assign(r.points);
    return check_improvement(r, points, told.promise);
  };
  const auto by_place = [](const OracleReport& report) {
    const std::map<std::string, double> figures(report.figures.begin(), report.figures.end());
    return figures.at(kByPlace);
  };
  const OracleReport there = judged(2, 2), elsewhere = judged(2, 36);
  EXPECT_TRUE(there.passed()) << there.findings.at(0);
  EXPECT_GT(by_place(there), 0);
  EXPECT_FALSE(elsewhere.passed());
}

// The refined mesh keeps the promise, the improvement has made longer edges.
TEST(Improvement, MakesNoEdgeLongerThanPromised) {
  Told told = run_of(ball(3));
  ASSERT_FALSE(told.record.unrepaired.empty());
  ExactPoints points;
  points.assign(told.record.points);
  const auto longest = [&points](const std::vector<ExactRecord::Tet>& tets) {
    double result = 0;
    for (const ExactRecord::Tet& tet : tets) {
      if (!tet.inside) continue;
      for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < i; ++j) {
          result = std::max(result, exact::distance(points, tet.vertices[i], tet.vertices[j]));
        }
      }
    }
    return result;
  };
  const double before = longest(told.record.unrepaired), after = longest(told.record.final);
  ASSERT_GT(after, 1.001 * before);
  told.promise.max_edge = 1.001 * before;
  EXPECT_FALSE(check_improvement(told.record, points, told.promise).passed());
  told.promise.max_edge = 1.001 * after;
  EXPECT_TRUE(check_improvement(told.record, points, told.promise).passed());
  // A size field that grows so slowly is nearly the same everywhere.
  told.promise.max_edge = 0;
  told.promise.size_growth = 1e-12;
  told.promise.size_field = {{{0, 0, 0}, 1.001 * before}};
  EXPECT_FALSE(check_improvement(told.record, points, told.promise).passed());
  told.promise.size_field = {{{0, 0, 0}, 1.001 * after}};
  EXPECT_TRUE(check_improvement(told.record, points, told.promise).passed());
}

}  // namespace
}  // namespace tetproof::improvement_test
