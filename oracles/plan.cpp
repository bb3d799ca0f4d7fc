#include "oracles/plan.h"

#include <algorithm>
#include <iterator>

#include "oracles/base/vectors.h"

namespace tetproof::oracles {
namespace {

using delmesher::ExactRecord;

// The mesh of a complex, with a region for each part of space, is judged by its file alone.
bool of_regions(const ExactRecord*, const VerifyOptions& options) {
  return options.promised.all_regions;
}
bool of_solid(const ExactRecord*, const VerifyOptions& options) {
  return !options.promised.all_regions;
}
// The file of a run that had a final stage is not the refined mesh.
bool of_file(const ExactRecord* exact, const VerifyOptions& options) {
  return of_solid(exact, options) &&
         (options.stage != Stage::refined || exact == nullptr || exact->final.empty());
}
bool of_record(const ExactRecord* exact, const VerifyOptions& options) {
  return of_solid(exact, options) && exact != nullptr;
}
bool of_final(const ExactRecord* exact, const VerifyOptions& options) {
  return of_record(exact, options) && options.stage != Stage::refined;
}
bool of_refined(const ExactRecord* exact, const VerifyOptions& options) {
  return of_record(exact, options) && options.stage != Stage::final;
}

constexpr unsigned kRefined = kRefinedElements + kRefinedComplex;
constexpr unsigned kFinal = kFinalTetrahedra + kUnrepairedTetrahedra + kFinalMeshes;

// What the first steps need is given up before others need much: the record is all but gone when
// the file's turn comes. The first step that asks for the refined complex makes it, out of the
// refined tetrahedra.
constexpr PlannedStep kSteps[] = {
    {check_sidecar, of_record, 2,
     kFile + kFileTetrahedra + kRefinedTetrahedra + kRefinedElements + kFinal, 0},
    {check_refined_complex, of_refined, 4, kRefined + kFinal, kRefinedTetrahedra},
    {check_refined_angles, of_refined, 5, kRefined, 0},
    {check_refined_inside, of_refined, 6, kRefined, 0},
    {check_refined_promises, of_refined, 7, kRefined + kFinal, 0},
    {check_final, of_final, 3, kFinalMeshes, kFinalTetrahedra + kUnrepairedTetrahedra},
    {check_file, of_file, 0, kFile, kFileTetrahedra},
    {check_input, of_solid, 1, 0, 0},
    {check_regions, of_regions, 0, kFile + kFileTetrahedra, 0},
};

}  // namespace

std::vector<PlannedStep> plan(const ExactRecord* exact, const VerifyOptions& options) {
  std::vector<PlannedStep> steps;
  std::ranges::copy_if(kSteps, std::back_inserter(steps),
                       [&](const PlannedStep& step) { return step.wanted(exact, options); });
  return steps;
}

double Step::ulp_of(const InputSurface& surface) const {
  return unit_in_last_place(std::max(surface.largest_coordinate(), largest_given_));
}

void Step::move_to(VerifyReport& report, double& diagonal) {
  report.deviation += report_.deviation;  // only one step has them
  report.deviation_ulps += report_.deviation_ulps;
  report.slab += report_.slab;
  report.inverted += report_.inverted;
  report.flat += report_.flat;
  std::ranges::move(report_.unproven, std::back_inserter(report.unproven));
  std::move(report_.oracles.begin(), report_.oracles.end(), std::back_inserter(report.oracles));
  if (diagonal_ > 0) diagonal = diagonal_;
}

double Step::delta() const {
  if (exact_ == nullptr) return options_.promised.delta;
  return std::max(options_.promised.guaranteed_delta(), exact_->parameters.delta);
}

AngleScope Step::scope() const {
  return options_.promised.region == delmesher::Region::hull ? AngleScope::all : AngleScope::solid;
}

void Step::add(OracleReport oracle, const std::string& prefix) {
  oracle.name = prefix + oracle.name;
  // Numbers of the record's own mesh are no places in the file.
  if (!prefix.empty()) oracle.forget_sites(Site::Kind::vertex, Site::Kind::listed_triangle);
  if (options_.progress) {
    const std::lock_guard<std::mutex> lock(shared_.progress);
    options_.progress(oracle);
  }
  report_.oracles.push_back(std::move(oracle));
}

}  // namespace tetproof::oracles
