// Google Benchmark of the kernels: predicates by point mix and stage, and plain Delaunay of random
// points beside CGAL's.
#include <benchmark/benchmark.h>

#include <random>

#include "mesher/predicates/predicates.h"
#include "reports/benchmark/floor.h"

namespace tetproof::benchmark {
namespace {

using delmesher::base::VertexId;
using delmesher::predicates::PointStore;
using delmesher::predicates::Predicates;

constexpr std::size_t kPoints = 4096;

// `implicit`: every other point is on a segment or a triangle between explicit ones.
PointStore random_points(bool implicit) {
  std::mt19937_64 random(20261121);
  std::uniform_real_distribution<double> coordinate(0, 1);
  PointStore points;
  for (std::size_t n = 0; n < kPoints; ++n) {
    if (!implicit || n < 8 || n % 2 == 0) {
      const double x = coordinate(random), y = coordinate(random);
      points.add_explicit(x, y, coordinate(random));
    } else if (n % 4 == 1) {
      points.add_on_segment(0, static_cast<VertexId>(n - 1), 0.375);
    } else {
      points.add_on_triangle(0, 2, static_cast<VertexId>(n - 1), 0.25, 0.4375);
    }
  }
  return points;
}

template <class Call>
void run_predicate(::benchmark::State& state, Call&& call) {
  const PointStore points = random_points(state.range(0) != 0);
  Predicates predicates(points);
  std::mt19937_64 random(7);
  std::vector<VertexId> ids(5 * kPoints);
  for (VertexId& id : ids) id = static_cast<VertexId>(random() % kPoints);
  std::size_t n = 0;
  for (auto _ : state) {
    ::benchmark::DoNotOptimize(call(predicates, &ids[n]));
    n = n + 5 < ids.size() ? n + 5 : 0;
  }
  const auto& c = predicates.counters;
  const double all = static_cast<double>(c.decided());
  state.counters["filter_decides"] = static_cast<double>(c.filter) / all;
}

void orient3d(::benchmark::State& state) {
  run_predicate(
      state, [](Predicates& p, const VertexId* v) { return p.orient3d(v[0], v[1], v[2], v[3]); });
}
BENCHMARK(orient3d)->Arg(0)->Arg(1)->ArgName("implicit");

void insphere(::benchmark::State& state) {
  run_predicate(state, [](Predicates& p, const VertexId* v) {
    return p.insphere(v[0], v[1], v[2], v[3], v[4]);
  });
}
BENCHMARK(insphere)->Arg(0)->Arg(1)->ArgName("implicit");

void in_diametral_ball(::benchmark::State& state) {
  run_predicate(state, [](Predicates& p, const VertexId* v) {
    return v[0] == v[1] || v[1] == v[2] || v[0] == v[2]
               ? 0
               : p.in_diametral_ball(v[0], v[1], v[2], v[3]);
  });
}
BENCHMARK(in_diametral_ball)->Arg(0)->Arg(1)->ArgName("implicit");

std::vector<std::array<double, 3>> doubles(std::size_t count) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> coordinate(0, 1);
  std::vector<std::array<double, 3>> points(count);
  for (auto& p : points) p = {coordinate(random), coordinate(random), coordinate(random)};
  return points;
}

template <Timing (*kDelaunay)(const std::vector<std::array<double, 3>>&)>
void delaunay(::benchmark::State& state) {
  const auto points = doubles(static_cast<std::size_t>(state.range(0)));
  double seconds = 0, tetrahedra = 0;
  for (auto _ : state) {
    const Timing timing = kDelaunay(points);
    state.SetIterationTime(timing.seconds);
    seconds += timing.seconds;
    tetrahedra += static_cast<double>(timing.tetrahedra);
  }
  state.counters["us_per_tet"] = 1e6 * seconds / tetrahedra;
}
BENCHMARK(delaunay<cgal_delaunay>)->RangeMultiplier(10)->Range(1000, 1000000)->UseManualTime();
BENCHMARK(delaunay<own_delaunay>)->RangeMultiplier(10)->Range(1000, 1000000)->UseManualTime();

}  // namespace
}  // namespace tetproof::benchmark

BENCHMARK_MAIN();
