#include "oracles/verdict/verdict.h"

#include <algorithm>

namespace tetproof::oracles {

Stage stage_of(const Promise& promised, bool recorded) {
  if (promised.approximate) return Stage::refined;
  return !recorded || promised.task == Task::cdt ? Stage::final : Stage::both;
}

void conclude(double diagonal, VerifyReport& report) {
  report.deviation_share = diagonal > 0 ? report.deviation / diagonal : 0;
  if (report.any_failed()) {
    report.verdict = Verdict::broken;
  } else if (!report.all_passed()) {
    report.verdict = Verdict::undecided;
  } else if (report.deviation == 0) {
    report.verdict = Verdict::exact;
  } else {
    report.verdict = report.deviation_ulps <= kRoundedUlps ? Verdict::rounded : Verdict::deviating;
  }
}

bool failed(const VerifyReport& report, const VerifyOptions& options) {
  // A surface of its own has been judged by its distance.
  if (options.promised.tolerance != 0) return report.verdict == Verdict::broken;
  // United facets may be planar within the promised bound. Without them only the declared deviation
  // is allowed.
  const double declared = report.slab > 0
                              ? std::max(options.declared_deviation, report.planar_share)
                              : options.declared_deviation;
  return report.verdict == Verdict::broken ||
         (report.verdict == Verdict::deviating && report.deviation_share > declared);
}

}  // namespace tetproof::oracles
