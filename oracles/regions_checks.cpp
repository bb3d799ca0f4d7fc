// The oracles on the mesh of a complex, with a region for each part of space that it bounds, as it
// was written.
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "oracles/base/vectors.h"
#include "oracles/file_step.h"
#include "oracles/mesh/angles.h"
#include "oracles/mesh/parts.h"
#include "oracles/surface/surface_validity.h"

namespace tetproof::oracles {
namespace {

class RegionsStep final : public FileStep {
 public:
  explicit RegionsStep(const Subject& subject)
      : FileStep(subject), split_(subject.split), merged_(subject.merged) {}
  std::string run() override;

 private:
  void measure_input();

  const MeshFile* split_;  // the file, where walls are split
  const MergedMesh* merged_;
};

void RegionsStep::measure_input() {
  double largest = 0;
  for (const auto& triangle : input_.triangles) {
    for (const Index v : triangle) {
      for (const double x : input_.vertices[v]) largest = std::max(largest, std::fabs(x));
    }
  }
  ulp_ = unit_in_last_place(largest);
  diagonal_ = diagonal_of(input_);
}

std::string RegionsStep::run() {
  if (exact_ != nullptr) return "a record is not of several regions";
#ifdef TETPROOF_SECOND_OPINIONS
  add(check_complex_validity(input_));
#endif
  if (!check_finite()) return {};
  ExactPoints points;
  std::vector<Position> positions = input_.vertices;
  positions.insert(positions.end(), mesh_.vertices.begin(), mesh_.vertices.end());
  if (std::string why = points.assign(positions); !why.empty()) return why;
  measure_input();
  check_contents();
  TetComplex complex;
  Neighbours neighbours;
  if (!check_tetrahedra(points, true, complex, neighbours)) return {};
  PartsResult parts = check_parts(input_, mesh_, complex, neighbours, options_.promised,
                                  options_.promised.strict ? 0 : kRoundedUlps * ulp_);
  if (parts.parts.passed()) {
    report_.deviation = parts.deviation;
    report_.deviation_ulps = parts.deviation / ulp_;
  }
  if (parts.split > 0) {
    report_.unproven.push_back("--regions (" + std::to_string(parts.split) +
                               " triangles are split)");
  }
  const bool by_name = !options_.promised.region_names.empty() ||
                       !options_.promised.region_sizes.empty() ||
                       !options_.promised.split_wall_names.empty();
  bool names_read = true;
  const bool tells_names = std::ranges::any_of(
      input_.region_points, [](const RegionPoint& p) { return !p.name.empty(); });
  if (by_name && !tells_names && (!input_.names_read || options_.promised.names)) {
    report_.unproven.emplace_back("names of regions: these are not read");
    parts.parts.undecided = parts.parts.violations > 0;
    names_read = false;
  }
  if (merged_ != nullptr) {
    OracleReport walls =
        check_split_walls(input_, *split_, *merged_, complex, neighbours, parts, options_.promised);
    walls.undecided = !names_read && walls.violations > 0;
    if (walls.checked > 0 || walls.violations > 0) add(std::move(walls));
  }
  add(std::move(parts.parts));
  add(std::move(parts.regions));
  check_points(complex, kRoundedUlps * ulp_);
  tell_turned(parts.list, "as in the input");
  if (mesh_.lists_boundary || parts.list.checked > 0) add(std::move(parts.list));
  complex.inside.assign(complex.tetrahedra.size(), 1);
  OracleReport angles("angles", "tetrahedra inside");
  angles.promised = false;
  angles.checked = complex.tetrahedra.size();
  measure_angles(complex, neighbours, complex.inside, angles);
  add(std::move(angles));
  if (parts.longest.empty()) {
    check_lengths(complex, input_.triangles);
  } else {
    check_lengths(complex, parts.longest, parts.triangles_fit);
  }
  return {};
}

}  // namespace

std::unique_ptr<Step> check_regions(const Subject& subject) {
  return std::make_unique<RegionsStep>(subject);
}

}  // namespace tetproof::oracles
