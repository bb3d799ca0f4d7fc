#include "oracles/plane/verify.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <set>

#include "oracles/plane/complex.h"
#include "oracles/plane/conformity.h"
#include "oracles/plane/final.h"
#include "oracles/plane/record.h"
#include "oracles/plane/refined.h"
#include "oracles/verdict/promise.h"

namespace tetproof {
namespace {

using delmesher::PlanarGraph;
using delmesher::PlaneRecord;
using oracles::OracleReport;
using oracles::PlaneFile;
using oracles::Promise;
using oracles::Verdict;
using oracles::VerifyReport;

std::string reason_against(const PlanarGraph& graph) {
  if (graph.segments.empty()) return "no segments";
  std::set<std::array<double, 2>> places;
  for (const auto& p : graph.vertices) {
    if (!std::isfinite(p[0]) || !std::isfinite(p[1])) return "a vertex is not finite";
    if (!places.insert({p[0] + 0.0, p[1] + 0.0}).second) return "two vertices coincide";
  }
  for (const auto& [a, b] : graph.segments) {
    if (std::max(a, b) >= graph.vertices.size()) return "a segment refers to no vertex";
    if (a == b) return "a segment begins and ends at one vertex";
  }
  return {};
}

// The record's own claims, each mesh of it, and the file against it. Returns the largest distance
// of a written vertex from its exact place, in input units.
double verify_record(PlaneGraph& input, const PlaneFile& file, const PlaneRecord& record,
                     const PlaneVerifyOptions& options, VerifyReport& report) {
  const Promise& promise = options.promised;
  const auto tell = [&](OracleReport oracle) { report.oracles.push_back(std::move(oracle)); };
  tell(oracles::check_plane_promise(record, promise, options.record_version));
  PlanePoints exact;
  if (!oracles::read_plane_points(input, record, exact, report)) return 0;
  oracles::RecordedPlane recorded{input,
                                  record,
                                  promise,
                                  exact,
                                  {record.refined, record.refined_edges, exact},
                                  {record.final, record.final_edges, exact}};
  const bool refined = oracles::check_plane_complex(recorded.refined, input, "refined-", report);
  const bool final =
      promise.approximate || oracles::check_plane_complex(recorded.final, input, "exact-", report);
  if (final && !promise.approximate) oracles::check_plane_final(recorded, report);
  if (final && refined) oracles::check_plane_refined(recorded, report);
  tell(oracles::check_plane_same_mesh(recorded, file));
  double deviation = 0;
  tell(oracles::check_plane_rounding(recorded, file, options.declared_deviation * input.diagonal(),
                                     deviation));
  return deviation;
}

}  // namespace

std::string verify_plane(const PlanarGraph& graph, const PlaneFile& file, const PlaneRecord* record,
                         const PlaneVerifyOptions& options, VerifyReport& report) {
  constexpr double kUlps = 4;
  report = {};
  report.cells = "triangles";
  if (std::string why = reason_against(graph); !why.empty()) return why;
  PlaneGraph input(graph);
  const double ulp = input.ulp();
  oracles::check_plane_file(input, file, options.promised,
                            options.declared_deviation * input.diagonal(), record != nullptr,
                            report, report.deviation);
  if (record != nullptr && options.promised.approximate && file.triangles.empty()) {
    // Corners may have taken all triangles; same-mesh decides whether the record has none either.
    for (OracleReport& oracle : report.oracles) {
      oracle.checked = std::max<std::uint64_t>(oracle.checked, 1);
      oracle.notes.emplace_back("the file has no triangle");
    }
  }
  if (record == nullptr && !options.promised.of_record.empty()) {
    std::ranges::copy(options.promised.of_record, std::back_inserter(report.unproven));
    report.scope = "the mesh as written";
  }
  if (record != nullptr) {
    if (record->delta < options.promised.delta) {
      char text[100];
      std::snprintf(text, sizeof text, "--delta above %.6g degrees", record->delta);
      report.unproven.emplace_back(text);
    }
    report.deviation =
        std::max(report.deviation, verify_record(input, file, *record, options, report));
  } else if (options.promised.max_vertices > 0) {
    report.oracles.push_back(oracles::check_written(options.promised, file.vertices.size(), 0));
  }
  report.deviation_ulps = ulp > 0 ? report.deviation / ulp : 0;
  report.deviation_share = input.diagonal() > 0 ? report.deviation / input.diagonal() : 0;
  report.verdict = report.any_failed()               ? Verdict::broken
                   : !report.all_passed()            ? Verdict::undecided
                   : report.deviation == 0           ? Verdict::exact
                   : report.deviation <= kUlps * ulp ? Verdict::rounded
                                                     : Verdict::deviating;
  return {};
}

std::string PlaneVerdict::text() const {
  std::string text;
  for (const std::string& failure : failures) text += failure + "\n";
  return text;
}

PlaneVerdict verify_plane(const PlanarGraph& graph, const delmesher::PlaneOptions& options,
                          const delmesher::PlaneResult& result) {
  PlaneVerdict verdict;
  PlaneVerifyOptions how;
  how.promised = oracles::promise_of(options);
  const std::string why =
      verify_plane(graph, oracles::plane_file_of(result.mesh), &result.exact, how, verdict.report);
  if (!why.empty()) verdict.failures.push_back("input: " + why);
  for (const OracleReport& oracle : verdict.report.oracles) {
    verdict.checks += oracle.checked;
    if (!oracle.passed() && oracle.findings.empty()) {
      verdict.failures.push_back(oracle.name + ": nothing to check");
    }
    for (const std::string& finding : oracle.findings) {
      verdict.failures.push_back(oracle.name + ": " + finding);
    }
  }
  return verdict;
}

}  // namespace tetproof
