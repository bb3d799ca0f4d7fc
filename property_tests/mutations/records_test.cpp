// Damage to a small exact record, on a tetrahedron.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "property_tests/mutations/damages.h"
#include "property_tests/score_table.h"

namespace tetproof {
namespace {

using namespace mutations;  // NOLINT
using namespace oracles;    // NOLINT
using delmesher::ExactPoint;

double up(double x) {
  return std::nextafter(x, std::numeric_limits<double>::infinity());
}

// On a tetrahedron with a point on an edge and one on a face.
const RecordDamage kSmallDamages[] = {
    {"inside flag swapped", "exact-interior", [](auto& r) { r.final[1].inside = false; }},
    {"inside flag swapped, seen by the volume", "exact-volume",
     [](auto& r) { r.final[1].inside = false; }},
    {"point on a facet rounded to doubles", "exact-conformity",
     [](auto& r) {
       ExactPoints points;
       points.assign(r.points);
       const Position p = points.nearest(5);
       r.points[5] = {ExactPoint::Kind::explicit_point, 0, 0, 0, p[0], p[1], p[2]};
     }},
    {"input vertex moved by an ulp", "sidecar", [](auto& r) { r.points[2].x = up(r.points[2].x); }},
    {"reference to an implicit point", "sidecar", [](auto& r) { r.points[5].k = 4; }},
    {"tetrahedron lost", "exact-conformity", [](auto& r) { r.final.pop_back(); }},
    {"facet id wrong", "exact-facets", [](auto& r) { r.final_facets[3][3] = 2; }},
    {"vertex of the file unknown", "rounding", [](auto& r) { r.mesh_vertices.pop_back(); }},
};

class SmallDamages : public testing::TestWithParam<RecordDamage> {};

TEST_P(SmallDamages, AreCaughtByTheOracleMeantForThem) {
  samples::ExactSample sample = samples::exact_sample();
  VerifyOptions options;
  options.promised.task = Task::cdt;
  ASSERT_TRUE(samples::exact_or_rounded(run(sample.sample, &sample.exact, options)));
  GetParam().apply(sample.exact);
  judge("tetrahedron", GetParam().name, GetParam().oracle,
        run(sample.sample, &sample.exact, options));
}

INSTANTIATE_TEST_SUITE_P(All, SmallDamages, testing::ValuesIn(kSmallDamages),
                         test_name<RecordDamage>);

}  // namespace
}  // namespace tetproof
