// The oracles on the refined mesh of the record.
#include <algorithm>
#include <utility>

#include "oracles/mesh/delaunay.h"
#include "oracles/mesh/edge_lengths.h"
#include "oracles/mesh/hull.h"
#include "oracles/mesh/places.h"
#include "oracles/plan.h"
#include "oracles/record/chamfer.h"
#include "oracles/record/enrichment.h"
#include "oracles/record/filter.h"
#include "oracles/record/refinement.h"

namespace tetproof::oracles {
namespace {

// Empty unless there is a refined mesh to look at.
class RefinedStep : public Step {
 public:
  using Step::Step;
  std::string run() final {
    if (shared_.sidecar().usable && (makes_complex() || shared_.refined().shape.passed())) check();
    return {};
  }

 private:
  virtual void check() = 0;
  virtual bool makes_complex() const { return false; }
};

class RefinedComplex final : public RefinedStep {
  using RefinedStep::RefinedStep;
  bool makes_complex() const override { return true; }
  void check() override;
};

class RefinedAngles final : public RefinedStep {
  using RefinedStep::RefinedStep;
  void check() override {
    const auto& [complex, neighbours, shape, places] = shared_.refined();
    add(check_angles(complex, neighbours, *places, delta(), scope()), "refined-");
  }
};

class RefinedInside final : public RefinedStep {
  using RefinedStep::RefinedStep;
  void check() override {
    add(check_contained(shared_.refined().complex, *shared_.refined().places), "refined-");
  }
  static OracleReport check_contained(const TetComplex& complex, const Places& places);
};

class RefinedPromises final : public RefinedStep {
  using RefinedStep::RefinedStep;
  void check() override;
};

void RefinedComplex::check() {
  const auto& [complex, neighbours, shape, places] = shared_.refined();
  add(shape, "refined-");
  if (!shape.passed()) return;
  OracleReport orientation = check_orientation(complex);
  OracleReport delaunay = check_delaunay(complex, neighbours);
  if (orientation.passed() && delaunay.passed()) shared_.tell_refined_is_delaunay();
  add(std::move(orientation), "refined-");
  add(check_hull(complex, neighbours), "refined-");
  add(std::move(delaunay), "refined-");
}

void RefinedPromises::check() {
  const RefinedMesh mesh = shared_.refined_mesh();
  add(check_refined_facets(mesh), "refined-");
  add(check_segments(mesh), "refined-");
  if (!exact_->segments.empty() || !exact_->refined_facets.empty()) {  // else check_promise fails
    add(check_encroachment(mesh), "refined-");
    add(check_chamfer_angles(mesh), "refined-");
  }
  add(check_balls(mesh), "refined-");
  add(check_chamfer_need(mesh), "refined-");
  if (!exact_->refined_facets.empty()) add(check_chamfer_cuts(mesh), "refined-");
  if (!exact_->chamfer_points.empty()) add(check_chamfer_extent(mesh), "refined-");
  const bool dropped = std::any_of(exact_->facets.begin(), exact_->facets.end(),
                                   [](const auto& facet) { return facet.filtered != 0; });
  // Without a tolerance nothing may have been dropped.
  if (options_.promised.tau > 0 || exact_->parameters.tolerance > 0 || dropped) {
    add(check_filter(mesh), "refined-");
  }
  for (OracleReport& lengths : check_edge_lengths(*mesh.complex, options_.promised, {}, scope())) {
    add(std::move(lengths), "refined-");
  }
  if (!options_.promised.approximate) add(check_enrichment(mesh));
}

// A tetrahedron is called inside exactly if it is contained in the solid.
OracleReport RefinedInside::check_contained(const TetComplex& complex, const Places& places) {
  OracleReport contained("contained", "tetrahedra");
  std::uint64_t inside = 0;
  for (std::size_t t = 0; t < complex.tetrahedra.size(); ++t) {
    const bool within = places.of(t) == Place::inside;
    ++contained.checked;
    inside += complex.inside[t];
    if (within == (complex.inside[t] != 0)) continue;
    contained.fail(
        complex.tet_name(t) + (within ? " is contained in the solid but is not called inside"
                                      : " is called inside but is not contained in the solid"),
        complex.tet_site(t));
  }
  contained.figures.emplace_back("called inside", static_cast<double>(inside));
  return contained;
}

}  // namespace

std::unique_ptr<Step> check_refined_complex(const Subject& subject) {
  return std::make_unique<RefinedComplex>(subject);
}
std::unique_ptr<Step> check_refined_angles(const Subject& subject) {
  return std::make_unique<RefinedAngles>(subject);
}
std::unique_ptr<Step> check_refined_inside(const Subject& subject) {
  return std::make_unique<RefinedInside>(subject);
}
std::unique_ptr<Step> check_refined_promises(const Subject& subject) {
  return std::make_unique<RefinedPromises>(subject);
}

}  // namespace tetproof::oracles
