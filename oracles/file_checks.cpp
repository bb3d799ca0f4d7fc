// The oracles on the mesh of a solid as it was written.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <utility>

#include "oracles/base/vectors.h"
#include "oracles/file_step.h"
#include "oracles/mesh/delaunay.h"
#include "oracles/mesh/hull.h"
#include "oracles/mesh/kept.h"
#include "oracles/mesh/measures.h"
#include "oracles/mesh/places.h"
#include "oracles/mesh/regions.h"
#include "oracles/readings.h"
#include "oracles/surface/surface_validity.h"
#include "oracles/verdict/verdict.h"

namespace tetproof::oracles {
namespace {

// The mesh as written, on its doubles.
class SolidStep final : public FileStep {
 public:
  explicit SolidStep(const Subject& subject) : FileStep(subject), subject_(subject) {}
  std::string run() override;

 private:
  bool check_empty();
  BeforeWriting before_writing();
  void check_surface(const TetComplex& complex, const Neighbours& neighbours,
                     const InputSurface& input);
  void check_hull_of_file(const TetComplex& complex, const Neighbours& neighbours,
                          const InputSurface& surface);
  void check_surface_kept(const ConformityResult& conformity, Index first);
  void check_quality(const TetComplex& complex, const Neighbours& neighbours,
                     const InputSurface& surface, const ConformityResult& conformity);
  bool labels_differ() const;
  void tell_lost_labels();
  void check_no_list();
  void check_names();

  const Subject& subject_;
  double slack_ = 0;  // how far the surface of the file may be from where it belongs
};

class InputStep final : public Step {
  using Step::Step;
  std::string run() override;
};

// The filter may leave nothing to refine. Then same-mesh decides whether the record has nothing to
// write, either; without a record an empty file says nothing.
bool SolidStep::check_empty() {
  if (exact_ == nullptr || !options_.promised.approximate || !mesh_.tetrahedra.empty())
    return false;
  OracleReport report("complex", "vertices");
  report.checked = 1;
  report.notes.emplace_back("the file has no tetrahedra");
  if (!mesh_.vertices.empty()) report.fail("the file has vertices, but no tetrahedra");
  if (!mesh_.boundary.empty()) report.fail("the file has triangles, but no tetrahedra");
  add(std::move(report));
  return true;
}

std::string SolidStep::run() {
  if (!check_finite() || check_empty()) return {};
  ExactPoints points;
  InputSurface surface;
  {
    std::vector<Position> positions = input_.vertices;
    positions.insert(positions.end(), mesh_.vertices.begin(), mesh_.vertices.end());
    if (std::string why = points.assign(positions); !why.empty()) return why;
  }
  if (std::string why = surface.assign(input_, points); !why.empty()) return why;
  ulp_ = ulp_of(surface);
  diagonal_ = surface.diagonal();
  check_contents();
  TetComplex complex;
  Neighbours neighbours;
  if (!check_tetrahedra(points, options_.stage == Stage::refined, complex, neighbours)) return {};
  complex.inside = inside_by_parity(complex, surface);
  if (options_.stage == Stage::refined) {
    add(check_angles(complex, neighbours, Places(complex, neighbours, surface), delta(), scope(),
                     before_writing()));
    if (exact_ == nullptr) add(surface_not_decided("conformity"));
    return {};
  }
  check_points(complex,
               std::max(kRoundedUlps * ulp_, options_.promised.planar_share() * diagonal_));
  const bool solid_only =
      fills(complex, surface,
            std::max(kRoundedUlps * ulp_, options_.promised.planar_share() * diagonal_));
  std::vector<std::int64_t> one_region;
  if (mesh_.regions.empty() && solid_only) one_region.assign(complex.tetrahedra.size(), 0);
  const std::vector<std::int64_t>& given = mesh_.regions.empty() ? one_region : mesh_.regions;
  if (given.empty()) {  // the hull: parity alone decides
    check_surface(complex, neighbours, surface);
    check_hull_of_file(complex, neighbours, surface);
    return {};
  }
  const Regions regions(complex, given);
  check_surface(complex, neighbours, surface);
  // The centroid of a tetrahedron is a quarter of its altitude away from its faces.
  const bool sides_known = exact_ != nullptr || !mesh_.all_called_inside;
  add(regions.check_strays(8 * slack_, sides_known ? mesh_.inside : std::vector<std::uint8_t>{}));
  // What is outside is there to fill the hull.
  const bool beside = std::ranges::find(complex.inside, 0) != complex.inside.end();
  if (!solid_only || beside || scope() == AngleScope::all)
    check_hull_of_file(complex, neighbours, surface);
  return {};
}

BeforeWriting SolidStep::before_writing() {
  BeforeWriting before;
  if (exact_ == nullptr) {
    before.farthest = kRoundedUlps * ulp_ + options_.promised.planar_share() * diagonal_;
  } else if (shared_.sidecar().usable) {
    before.points = &shared_.sidecar().points;
    before.point.assign(exact_->mesh_vertices.begin(), exact_->mesh_vertices.end());
  }
  return before;
}

void SolidStep::check_surface(const TetComplex& complex, const Neighbours& neighbours,
                              const InputSurface& input) {
  Readings readings(subject_, complex, neighbours, input, ulp_, diagonal_, largest_given_);
  ConformityResult conformity = readings.conformity();
  const InputSurface& surface = readings.surface();
  if (conformity.report.passed()) {  // else the deviation means nothing
    report_.deviation = conformity.deviation;
    report_.deviation_ulps = conformity.ulps;
    report_.slab = conformity.slab;
    slack_ = conformity.deviation;
  } else if (exact_ == nullptr &&
             undecidable(complex, surface, conformity, kRoundedUlps, largest_given_)) {
    conformity.report.undecided = true;
    conformity.report.notes.push_back(
        "where it fails, edges of the input are closer than doubles can tell: the file alone "
        "does not say which mesh edge is whose, a record (--exact) does");
    slack_ = kRoundedUlps * ulp_;
  }
  add(conformity.report);
  if (options_.promised.keep) check_surface_kept(conformity, complex.first_vertex);
  // What may differ at all may differ by the smallest double.
  const double area =
      surface_area(complex, conformity.faces, area_unit(input.largest_coordinate()));
  const double allowed = slack_ > 0 ? std::max(2 * slack_ * area, 0x1p-1074) : 0;
  add(check_volume(complex, neighbours, input, allowed));
  check_quality(complex, neighbours, surface, conformity);
  // If the faces' facets are unknown, so are the labels they should have.
  if (conformity.report.undecided) return;
  if (mesh_.boundary.empty()) return check_no_list();
  std::vector<Face> listed = mesh_.boundary;
  for (Face& face : listed) {
    for (Index& v : face) v += complex.first_vertex;
  }
  const bool labelled = !input_.labels.empty() && mesh_.labels.size() == listed.size();
  OracleReport list =
      check_boundary_list(complex, neighbours, surface, conformity, listed,
                          labelled ? mesh_.labels : std::vector<std::int32_t>{}, exact_ != nullptr);
  tell_turned(list, "seen from outside");
  if (!labelled) tell_lost_labels();
  add(std::move(list));
  check_names();
}

// Unless it was to be strict, a run may leave vertices on the surface; what it left is said first.
void SolidStep::check_surface_kept(const ConformityResult& conformity, Index first) {
  OracleReport kept = check_kept(input_, mesh_, conformity.faces, first, options_.promised);
  if (kept.violations > 0 && !options_.promised.strict) {
    say_first("--surface keep (" + std::to_string(kept.violations) + " triangles are split)", kept);
  }
  add(std::move(kept));
}

bool SolidStep::labels_differ() const {
  return std::ranges::adjacent_find(input_.labels, std::ranges::not_equal_to()) !=
         input_.labels.end();
}

// Not every format has labels.
void SolidStep::tell_lost_labels() {
  if (labels_differ()) report_.unproven.emplace_back("labels of the input (the file has none)");
}

// Labels that differ are lost in a file that lists no triangles, though its format has them.
void SolidStep::check_no_list() {
  if (!mesh_.lists_boundary) return tell_lost_labels();
  if (!labels_differ()) return;
  OracleReport list("boundary-list", "labels");
  list.checked = 1;
  list.fail("the input has labels, and the file lists no triangles");
  add(std::move(list));
}

// Others than delmesher promise no names.
void SolidStep::check_names() {
  if (!mesh_.has_names || options_.promised.names) return;
  const std::vector<std::int64_t> labels(mesh_.labels.begin(), mesh_.labels.end());
  OracleReport names("names", "labels"), sides("names", "regions");
  compare_names(input_.names, mesh_.names, 2, labels, names);
  // The regions of a mesh that was made are its sides, and are called so or not at all.
  if (exact_ != nullptr) compare_names({}, mesh_.names, 3, mesh_.regions, sides);
  names.promised = exact_ != nullptr && input_.names_read;
  if (!names.promised && names.violations > 0) {
    names.notes.push_back(input_.names_read
                              ? names.findings[0] + ", which is not a fault without a record"
                              : "the names were not compared: those of the input are not read");
    names.violations = 0;
    names.findings.clear();
    names.spots.clear();
  }
  if (sides.violations > 0) return add(std::move(sides));
  if (names.checked > 0 && !(input_.names.empty() && names.passed() && names.notes.empty())) {
    add(std::move(names));
  }
}

// Nothing is promised of the doubles as written, so these oracles only count and measure.
void SolidStep::check_quality(const TetComplex& complex, const Neighbours& neighbours,
                              const InputSurface& surface, const ConformityResult& conformity) {
  OracleReport delaunay =
      check_constrained_delaunay(complex, neighbours, surface, conformity.faces, {.gate = false});
  // A mesh all of whose faces are on the surface, as a single tetrahedron, has nothing to count.
  if (delaunay.checked > 0) add(std::move(delaunay));
  OracleReport angles("angles", "tetrahedra inside");
  angles.promised = false;
  for (const std::uint8_t inside : complex.inside) angles.checked += inside;
  measure_angles(complex, neighbours, complex.inside, angles);
  add(std::move(angles));
  check_lengths(complex, conformity.faces);
}

// Steiner points on the outer boundary are rounded like all others.
void SolidStep::check_hull_of_file(const TetComplex& complex, const Neighbours& neighbours,
                                   const InputSurface& surface) {
  // Of `mesh` the hull is that of a box, whose size is up to the mesher.
  const bool of_input = options_.promised.task == Task::cdt;
  if (!of_input && exact_ == nullptr && scope() == AngleScope::all) {
    report_.unproven.emplace_back("how far --region hull reaches");
  }
  if (report_.inverted + report_.flat > 0) return;  // the oracle needs positive tetrahedra
  add(check_hull(
      complex, neighbours,
      {.allowed = std::max({kRoundedUlps * ulp_, slack_, options_.declared_deviation * diagonal_}),
       .of = of_input ? std::span(surface.used_vertices()) : std::span<const Index>{}}));
}

std::string InputStep::run() {
#ifdef TETPROOF_SECOND_OPINIONS
  add(check_surface_validity(input_));  // it only asks other libraries
#endif
  return {};
}

}  // namespace

std::unique_ptr<Step> check_file(const Subject& subject) {
  return std::make_unique<SolidStep>(subject);
}
std::unique_ptr<Step> check_input(const Subject& subject) {
  return std::make_unique<InputStep>(subject);
}

}  // namespace tetproof::oracles
