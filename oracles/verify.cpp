#include "oracles/verify.h"

#include <atomic>

#include "oracles/parallel.h"
#include "oracles/verdict.h"
#include "oracles/verification.h"

namespace tetproof::oracles {

std::string verify(const Polyhedron& input, const MeshFile& mesh,
                   const delmesher::ExactRecord* exact, const VerifyOptions& options,
                   VerifyReport& report) {
  report = {};
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
