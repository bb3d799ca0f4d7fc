#include "oracles/verification.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace tetproof::oracles {

// The file comes last, since the record is all but gone then.
std::vector<Verification::Part> Verification::parts(const delmesher::ExactRecord* exact,
                                                    Stage stage) {
  std::vector<Part> list;
  // The file of a run that had a final stage is not the refined mesh.
  const bool other_file = stage == Stage::refined && exact != nullptr && !exact->final.empty();
  if (!other_file) {
    list.push_back({&Verification::check_file, 3, {Bulk::file}, {Bulk::file_tetrahedra}});
  }
  list.push_back({&Verification::check_input, 4, {}, {}});
  if (exact == nullptr) return list;
  list.push_back(
      {&Verification::check_sidecar,
       0,
       {Bulk::file, Bulk::file_tetrahedra, Bulk::refined_tetrahedra, Bulk::refined_elements,
        Bulk::final_tetrahedra, Bulk::unrepaired_tetrahedra, Bulk::final_meshes},
       {}});
  if (stage != Stage::refined) {
    list.push_back({&Verification::check_exact_final,
                    2,
                    {Bulk::final_meshes},
                    {Bulk::final_tetrahedra, Bulk::unrepaired_tetrahedra}});
  }
  if (stage == Stage::final) return list;
  const std::vector<Bulk> needs = {Bulk::refined_elements, Bulk::refined_complex};
  // The first that asks makes the complex, out of the tetrahedra.
  list.push_back({&Verification::check_refined_complex,
                  1,
                  {Bulk::refined_elements, Bulk::refined_complex, Bulk::final_tetrahedra,
                   Bulk::unrepaired_tetrahedra, Bulk::final_meshes},
                  {Bulk::refined_tetrahedra}});
  list.push_back({&Verification::check_refined_angles, 1, needs, {}});
  list.push_back({&Verification::check_refined_inside, 1, needs, {}});
  list.push_back({&Verification::check_refined_promises,
                  1,
                  {Bulk::refined_elements, Bulk::refined_complex, Bulk::final_tetrahedra,
                   Bulk::unrepaired_tetrahedra, Bulk::final_meshes},
                  {}});
  return list;
}

double Verification::ulp_of(const InputSurface& surface) const {
  const double largest = std::max(surface.largest_coordinate(), shared_.largest_given);
  return std::ldexp(1.0, std::ilogb(largest) - 52);
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
