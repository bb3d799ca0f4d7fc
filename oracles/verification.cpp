#include "oracles/verification.h"

#include <algorithm>
#include <iterator>

namespace tetproof::oracles {

std::vector<Verification::Check> Verification::checks(const delmesher::ExactRecord* exact,
                                                      Stage stage) {
  std::vector<Check> list;
  // The file of a run that had a final stage is not the refined mesh.
  const bool other_file = stage == Stage::refined && exact != nullptr && !exact->final.empty();
  if (!other_file) list.push_back(&Verification::check_file);
  list.push_back(&Verification::check_input);
  if (exact == nullptr) return list;
  list.push_back(&Verification::check_sidecar);
  if (stage != Stage::refined) list.push_back(&Verification::check_exact_final);
  if (stage != Stage::final) {
    list.insert(list.end(),
                {&Verification::check_refined_complex, &Verification::check_refined_angles,
                 &Verification::check_refined_inside, &Verification::check_refined_promises});
  }
  return list;
}

void Verification::move_to(VerifyReport& report, double& ulp, double& diagonal) {
  report.deviation += report_.deviation;  // only the file has them
  report.slab += report_.slab;
  report.inverted += report_.inverted;
  report.flat += report_.flat;
  std::move(report_.oracles.begin(), report_.oracles.end(), std::back_inserter(report.oracles));
  if (ulp_ > 0) ulp = ulp_;
  if (diagonal_ > 0) diagonal = diagonal_;
}

double Verification::delta() const {
  if (exact_ == nullptr) return options_.promised.delta;
  return std::max(options_.promised.guaranteed_delta(), exact_->parameters.delta);
}

AngleScope Verification::scope() const {
  return options_.promised.region == delmesher::Region::hull ? AngleScope::all : AngleScope::solid;
}

}  // namespace tetproof::oracles
