#include "oracles/verify.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

#include "oracles/base/parallel.h"
#include "oracles/record/ordinary_units.h"
#include "oracles/record/record_origin.h"
#include "oracles/surface/input_digits.h"
#include "oracles/verdict/verdict.h"
#include "oracles/verification.h"

namespace tetproof::oracles {
namespace {

// What alone is asked about although more was promised.
std::string scope_of(const VerifyOptions& options, bool recorded) {
  if (!recorded || options.promised.task != Task::mesh) return {};
  if (options.stage == Stage::final) return "the final mesh";
  const bool more = options.stage == Stage::refined && !options.promised.approximate;
  return more ? "the refined mesh" : "";
}

// Runs all parts in the order of their turns. `largest`: coordinate of the input as given, where it
// has been moved; else 0.
std::string run_parts(const Polyhedron& input, const MeshFile& mesh,
                      const delmesher::ExactRecord* exact, const VerifyOptions& options,
                      double largest, const Expendable& expendable, VerifyReport& report) {
  SharedData shared(input, exact, options.promised, expendable);
  shared.largest_given = largest;
  const std::vector<Verification::Part> list = Verification::parts(exact, options.stage);
  std::vector<Verification> parts(list.size(), {input, mesh, exact, options, shared});
  std::vector<std::size_t> order(list.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&list](std::size_t n) { return list[n].turn; });
  for (const Verification::Part& part : list) {
    for (const Bulk bulk : part.needs) shared.need(bulk);
    for (const Bulk bulk : part.tells) shared.need(bulk);
  }
  std::vector<std::string> why(list.size());
  std::atomic<bool> no_solid = false;
  run_tasks(options.threads, order.size(), [&](std::size_t turn) {
    if (no_solid) return;
    const std::size_t n = order[turn];
    why[n] = (parts[n].*list[n].check)();
    if (!why[n].empty()) no_solid = true;
    for (const Bulk bulk : list[n].needs) shared.done_with(bulk);
  });
  for (const std::string& reason : why) {
    if (!reason.empty()) return reason;
  }
  double ulp = 0, diagonal = 0;
  for (Verification& part : parts) part.move_to(report, ulp, diagonal);
  report.scope = scope_of(options, exact != nullptr);
  conclude(ulp, diagonal, report);
  return {};
}

// Of which every deviation is in input units again; other figures of lengths are not.
std::string verify_scaled(InOrdinaryUnits& task, VerifyOptions options, double largest,
                          VerifyReport& report) {
  options.promised = task.promise;
  const bool text_skipped = task.record.has_value() && !options.sidecar.empty();
  options.sidecar.clear();  // its text is in the other units
  delmesher::ExactRecord* record = task.record ? &*task.record : nullptr;
  std::string refusal =
      run_parts(task.input, task.mesh, record, options, std::ldexp(largest, -task.exponent),
                {&task.mesh, record}, report);
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

std::string verify_in_units(const Polyhedron& input, const MeshFile& mesh,
                            const delmesher::ExactRecord* exact, const VerifyOptions& options,
                            double largest, const Expendable& expendable, VerifyReport& report) {
  if (auto scaled = in_ordinary_units(input, mesh, exact, options.promised)) {
    return verify_scaled(*scaled, options, largest, report);
  }
  return run_parts(input, mesh, exact, options, largest, expendable, report);
}

std::string verify_beside_origin(BesideOrigin task, VerifyOptions options, VerifyReport& report) {
  OracleReport origin = move_to_origin(task);
  if (options.progress) options.progress(origin);
  const bool exact = origin.passed();
  report.oracles.push_back(std::move(origin));
  if (!exact) {
    conclude(0, 0, report);
    return {};
  }
  options.promised = task.promise;
  return verify_in_units(task.input, task.mesh, &task.record, options, task.largest,
                         {&task.mesh, &task.record}, report);
}

std::string verify_as_given(const Polyhedron& input, const MeshFile& mesh,
                            const delmesher::ExactRecord* exact, const VerifyOptions& options,
                            const Expendable& expendable, VerifyReport& report) {
  VerifyOptions known = options;
  known.promised.automatic_planar = automatic_planar_share(input);
  report = {};
  report.planar_share = known.promised.planar_share();
  if (exact != nullptr && names_origin(*exact)) {
    return verify_beside_origin({input, mesh, *exact, known.promised}, known, report);
  }
  return verify_in_units(input, mesh, exact, known, 0, expendable, report);
}

}  // namespace

std::string verify(const Polyhedron& input, const MeshFile& mesh,
                   const delmesher::ExactRecord* exact, const VerifyOptions& options,
                   VerifyReport& report) {
  return verify_as_given(input, mesh, exact, options, {}, report);
}

std::string verify_and_discard(const Polyhedron& input, MeshFile& mesh,
                               delmesher::ExactRecord* exact, const VerifyOptions& options,
                               VerifyReport& report) {
  return verify_as_given(input, mesh, exact, options, {&mesh, exact}, report);
}

}  // namespace tetproof::oracles
