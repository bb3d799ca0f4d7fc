#include "oracles/verify.h"

#include <atomic>
#include <cmath>

#include "oracles/ordinary_units.h"
#include "oracles/parallel.h"
#include "oracles/verdict.h"
#include "oracles/verification.h"

namespace tetproof::oracles {
namespace {

// Of which every deviation is in input units again; other figures of lengths are not.
std::string verify_scaled(const InOrdinaryUnits& task, VerifyOptions options,
                          VerifyReport& report) {
  options.promised = task.promise;
  const bool text_skipped = task.record.has_value() && !options.sidecar.empty();
  options.sidecar.clear();  // its text is in the other units
  std::string refusal =
      verify(task.input, task.mesh, task.record ? &*task.record : nullptr, options, report);
  report.deviation = std::ldexp(report.deviation, task.exponent);
  report.slab = std::ldexp(report.slab, task.exponent);
  for (OracleReport& oracle : report.oracles) {
    oracle.notes.push_back("lengths are in units of 2^" + std::to_string(task.exponent));
    if (text_skipped && oracle.name.ends_with("second-kernel")) {
      oracle.notes.push_back("the text of the points was not read a second time");
    }
  }
  return refusal;
}

}  // namespace

std::string verify(const Polyhedron& input, const MeshFile& mesh,
                   const delmesher::ExactRecord* exact, const VerifyOptions& options,
                   VerifyReport& report) {
  report = {};
  if (const auto scaled = in_ordinary_units(input, mesh, exact, options.promised)) {
    return verify_scaled(*scaled, options, report);
  }
  SharedData shared(input, exact, options.promised);
  const std::vector<Verification::Check> checks = Verification::checks(exact, options.stage);
  std::vector<Verification> parts(checks.size(), {input, mesh, exact, options, shared});
  std::vector<std::string> why(checks.size());
  std::atomic<bool> no_solid = false;
  run_tasks(options.threads, checks.size(), [&](std::size_t n) {
    if (no_solid) return;
    why[n] = (parts[n].*checks[n])();
    if (!why[n].empty()) no_solid = true;
  });
  for (const std::string& reason : why) {
    if (!reason.empty()) return reason;
  }
  double ulp = 0, diagonal = 0;
  for (Verification& part : parts) part.move_to(report, ulp, diagonal);
  conclude(ulp, diagonal, report);
  return {};
}

}  // namespace tetproof::oracles
