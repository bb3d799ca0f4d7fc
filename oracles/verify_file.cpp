// The oracles on the mesh as it was written.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "oracles/base/vectors.h"
#include "oracles/files/edge_nodes.h"
#include "oracles/mesh/delaunay.h"
#include "oracles/mesh/hull.h"
#include "oracles/mesh/places.h"
#include "oracles/mesh/regions.h"
#include "oracles/record/refined_index.h"
#include "oracles/surface/surface_validity.h"
#include "oracles/verdict/verdict.h"
#include "oracles/verification.h"

namespace tetproof::oracles {

// Some formats have no convention: there the sign of the majority is the right one. A file with a
// record was written by delmesher, which has one.
void Verification::turn_all(TetComplex& complex) const {
  if (!mesh_.either_orientation || exact_ != nullptr) return;
  std::int64_t balance = 0;
  for (const auto& [a, b, c, d] : complex.tetrahedra) {
    balance += exact::orient3d(*complex.points, a, b, c, d);
  }
  if (balance >= 0) return;
  for (Tet& tet : complex.tetrahedra) std::swap(tet[2], tet[3]);
}

// Numbers that are not finite are reported by an oracle, as no file may make the verification fail
// otherwise.
bool Verification::check_finite() {
  OracleReport report("complex", "vertices");
  for (std::size_t v = 0; v < mesh_.vertices.size(); ++v) {
    ++report.checked;
    if (!is_finite(mesh_.vertices[v])) {
      report.fail("vertex " + std::to_string(v) + " is not finite");
    }
  }
  if (report.violations == 0) return true;
  add(std::move(report));
  return false;
}

// The filter may leave nothing to refine. Then same-mesh decides whether the record has nothing to
// write, either; without a record an empty file says nothing.
bool Verification::check_empty() {
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

std::string Verification::check_file() {
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
  if (!mesh_.edge_nodes.empty() || (options_.promised.second_order && mesh_.has_second_order)) {
    OracleReport nodes = check_edge_nodes(
        mesh_, std::max(kRoundedUlps * ulp_, options_.declared_deviation * diagonal_));
    // Of a file alone nobody may know with which options it was made.
    if (exact_ != nullptr && !options_.promised.second_order) {
      nodes.fail("the elements are of second order, promised were linear ones");
    }
    add(std::move(nodes));
  }
  if (exact_ == nullptr && options_.promised.max_vertices > 0) {
    add(check_written_vertices(options_.promised, mesh_.vertices.size()));
  }

  const auto offset = static_cast<Index>(input_.vertices.size());
  TetComplex complex{&points, mesh_.tetrahedra, {}, offset, static_cast<Index>(points.size())};
  shared_.done_with(Bulk::file_tetrahedra);
  for (Tet& tet : complex.tetrahedra) {
    for (Index& v : tet) v = v < mesh_.vertices.size() ? v + offset : kNone;
  }
  const bool in_range = std::none_of(
      complex.tetrahedra.begin(), complex.tetrahedra.end(),
      [](const Tet& tet) { return *std::max_element(tet.begin(), tet.end()) == kNone; });
  // Neighbours are numbers of faces within tetrahedra, so no tetrahedron may be turned afterwards.
  if (in_range) turn_all(complex);
  Neighbours neighbours;
  add(check_complex(complex, neighbours, options_.stage == Stage::refined));
  if (!in_range) return {};  // the complex oracle has reported it
  OracleReport orientation = check_orientation(complex);
  report_.inverted = static_cast<std::uint64_t>(orientation.figure("inverted").value_or(0));
  report_.flat = static_cast<std::uint64_t>(orientation.figure("flat").value_or(0));
  add(std::move(orientation));
  complex.inside = inside_by_parity(complex, surface);
  if (options_.stage == Stage::refined) {
    add(check_angles(complex, neighbours, Places(complex, neighbours, surface), delta(), scope(),
                     before_writing()));
    if (exact_ == nullptr) add(surface_not_decided("conformity"));
    return {};
  }
  const bool solid_only =
      fills(complex, surface,
            std::max(kRoundedUlps * ulp_, options_.promised.planar_share() * diagonal_));
  std::vector<std::int64_t> one_region;
  if (mesh_.regions.empty() && solid_only) one_region.assign(complex.tetrahedra.size(), 0);
  const std::vector<std::int64_t>& given = mesh_.regions.empty() ? one_region : mesh_.regions;
  if (given.empty()) {  // the hull: parity alone decides
    check_file_surface(complex, neighbours, surface);
    check_file_hull(complex, neighbours);
    return {};
  }
  const Regions regions(complex, given);
  check_file_surface(complex, neighbours, surface);
  // The centroid of a tetrahedron is a quarter of its altitude away from its faces.
  const bool sides_known = exact_ != nullptr || !mesh_.all_called_inside;
  add(regions.check_strays(8 * slack_, sides_known ? mesh_.inside : std::vector<std::uint8_t>{}));
  // What is outside is there to fill the hull.
  const bool beside = std::ranges::find(complex.inside, 0) != complex.inside.end();
  if (!solid_only || beside || scope() == AngleScope::all) check_file_hull(complex, neighbours);
  return {};
}

BeforeWriting Verification::before_writing() {
  BeforeWriting before;
  if (exact_ == nullptr) {
    before.farthest = kRoundedUlps * ulp_ + options_.promised.planar_share() * diagonal_;
  } else if (shared_.sidecar().usable) {
    before.points = &shared_.sidecar().points;
    before.point.assign(exact_->mesh_vertices.begin(), exact_->mesh_vertices.end());
  }
  return before;
}

// Tries the surface as it is first. If facets that are planar within a bound may be one, those are
// united that no chain of mesh edges separates, provided that the mesh conforms to the united
// surface, which is then returned as well. Needles no wider than the bound may belong to the facet
// on either side of them.
ConformityResult Verification::conformity_of_file(const TetComplex& complex,
                                                  const Neighbours& neighbours,
                                                  const InputSurface& surface,
                                                  std::optional<InputSurface>& united) {
  ConformityResult result =
      check_conformity(complex, neighbours, surface, {.exact = true, .first_failure_ends = true});
  if (result.report.passed()) return result;
  // What fails by positions alone is judged by the record's chains, if there is one.
  const bool recorded = shared_.has_final();
  const auto check = [&](const InputSurface& on, ConformityOptions options) {
    options.first_failure_ends = recorded;
    ConformityResult r = check_conformity(complex, neighbours, on, options);
    if (r.report.passed() || !recorded) return r;
    const Chains chains = recorded_chains(on);
    options.chains = &chains;
    options.first_failure_ends = false;
    return check_conformity(complex, neighbours, on, options);
  };
  const double rounding = kRoundedUlps * ulp_ / diagonal_;
  const double planar = options_.promised.planar_share();
  ConformityOptions rounded{.exact = false};
  // A solid may be so small that roundings are a larger share of its diagonal.
  rounded.largest_tolerance = std::max(rounded.largest_tolerance, rounding);
  const auto at_most_deviating = [&] { return check(surface, rounded); };
  if (planar == 0) return at_most_deviating();
  ConformityOptions as_rounded = rounded;
  as_rounded.largest_tolerance = rounding;
  result = check(surface, as_rounded);
  if (result.report.passed() && result.deviation <= kRoundedUlps * ulp_) return result;
  const std::vector<Index> failed_edges = std::move(result.failed_edges);
  const double bound = planar * diagonal_;
  const double at_edges =
      std::max(kRoundedUlps * ulp_, options_.declared_deviation * diagonal_) * (1 + 1e-9);
  const auto conforms_to = [&](InputSurface& flat, double width) {
    if (!(width <= bound)) return false;
    as_rounded.off_plane = kRoundedUlps * ulp_;
    as_rounded.planar = width > 0 ? bound : 0;
    ConformityResult of_flat = check(flat, as_rounded);
    // Chains that the record gives may be anywhere. Only facets were promised to be no more than
    // planar within a bound, their edges are as given.
    if (!of_flat.report.passed() || of_flat.off_edges > at_edges) return false;
    of_flat.slab = width;
    of_flat.deviation = std::max(of_flat.deviation, width);
    of_flat.report.figures.emplace_back(
        "facets united",
        static_cast<double>(surface.facets().size()) - static_cast<double>(flat.facets().size()));
    united = std::move(flat);
    result = std::move(of_flat);
    return true;
  };
  InputSurface flat = surface;
  if (conforms_to(flat, flat.unite_facets(failed_edges, bound, *complex.points))) return result;
  if (exact_ == nullptr) {
    const double width = flat.move_needles(
        [&](const InputSurface& parted) { return check(parted, as_rounded).failed_edges; }, bound,
        *complex.points);
    if (conforms_to(flat, width)) return result;
    return at_most_deviating();
  }
  // To which of two facets a needle belongs is in the record, and whether that is a facet is
  // decided as before.
  const std::vector<Index> named = recorded_facets();
  if (named.size() != surface.triangles().size()) return at_most_deviating();
  flat = surface;
  const double named_width = flat.group_facets(named, bound, *complex.points);
  return conforms_to(flat, named_width) ? result : at_most_deviating();
}

// Per triangle of the input the facet that has it, by the record; empty if a triangle is in none.
std::vector<Index> Verification::recorded_facets() const {
  std::vector<Index> facet(input_.triangles.size(), kNone);
  for (const delmesher::ExactRecord::Facet& f : exact_->facets) {
    for (const std::uint32_t t : f.triangles) {
      if (t < facet.size()) facet[t] = f.id;
    }
  }
  if (std::find(facet.begin(), facet.end(), kNone) != facet.end()) facet.clear();
  return facet;
}

void Verification::check_file_surface(const TetComplex& complex, const Neighbours& neighbours,
                                      const InputSurface& input) {
  std::optional<InputSurface> united;
  ConformityResult conformity = conformity_of_file(complex, neighbours, input, united);
  const InputSurface& surface = united ? *united : input;
  if (conformity.report.passed()) {  // else the deviation means nothing
    report_.deviation = conformity.deviation;
    report_.slab = conformity.slab;
    slack_ = conformity.deviation;
  } else if (exact_ == nullptr && undecidable(complex, surface, conformity, kRoundedUlps * ulp_)) {
    conformity.report.undecided = true;
    conformity.report.notes.push_back(
        "where it fails, edges of the input are closer than doubles can tell: the file alone "
        "does not say which mesh edge is whose, a record (--exact) does");
    slack_ = kRoundedUlps * ulp_;
  }
  add(conformity.report);
  // What may differ at all may differ by the smallest double.
  const double area =
      surface_area(complex, conformity.faces, area_unit(input.largest_coordinate()));
  const double allowed = slack_ > 0 ? std::max(2 * slack_ * area, 0x1p-1074) : 0;
  add(check_volume(complex, neighbours, input, allowed));
  check_file_quality(complex, neighbours, surface, conformity);
  // If the faces' facets are unknown, so are the labels they should have.
  if (mesh_.boundary.empty() || conformity.report.undecided) return;
  std::vector<Face> listed = mesh_.boundary;
  for (Face& face : listed) {
    for (Index& v : face) v += complex.first_vertex;
  }
  const bool labelled = !input_.labels.empty() && mesh_.labels.size() == listed.size();
  OracleReport list = check_boundary_list(complex, neighbours, surface, conformity, listed,
                                          labelled ? mesh_.labels : std::vector<std::int32_t>{});
  if (!labelled && !input_.labels.empty()) {
    list.notes.emplace_back("the input has labels and the file has none");
  }
  add(std::move(list));
  check_names();
}

// Others than delmesher promise no names.
void Verification::check_names() {
  if (!mesh_.has_names || options_.promised.names) return;
  const std::vector<std::int64_t> labels(mesh_.labels.begin(), mesh_.labels.end());
  OracleReport names("names", "labels"), sides("names", "regions");
  compare_names(input_.names, mesh_.names, 2, labels, names);
  // The regions of a mesh that was made are its sides, and are called so or not at all.
  if (exact_ != nullptr) compare_names({}, mesh_.names, 3, mesh_.regions, sides);
  names.promised = exact_ != nullptr && input_.names_read;
  if (!names.promised && names.violations > 0) {
    names.notes.push_back(input_.names_read
                              ? names.findings[0] + ", which is no fault without a record"
                              : "the names were not compared: those of the input are not read");
    names.violations = 0;
    names.findings.clear();
  }
  if (sides.violations > 0) return add(std::move(sides));
  if (names.checked > 0 && !(input_.names.empty() && names.passed() && names.notes.empty())) {
    add(std::move(names));
  }
}

// The chain of mesh edges on which each edge of the surface lies by the record's exact coordinates,
// in vertices of the file.
Chains Verification::recorded_chains(const InputSurface& surface) {
  const SharedData::Sidecar& sidecar = shared_.sidecar();
  if (!sidecar.usable) return {};
  const Chains& exact = shared_.final_chains();
  std::vector<Index> written(sidecar.points.size(), kNone);
  for (std::size_t i = 0; i < exact_->mesh_vertices.size(); ++i) {
    const Index v = exact_->mesh_vertices[i];
    if (v >= written.size()) continue;  // check_rounding reports it
    written[v] = static_cast<Index>(input_.vertices.size() + i);
  }
  // The surface that was meshed may have fewer edges than the input, or in another direction.
  const std::vector<InputSurface::Edge>& meshed = sidecar.final_surface().edges();
  const InputEdges number(surface);
  std::vector<Index> recorded(surface.edges().size(), kNone);
  for (Index e = 0; e < meshed.size(); ++e) {
    const Index on = number.find(meshed[e].from, meshed[e].to);
    if (on != kNone) recorded[on] = e;
  }
  Chains chains;
  std::vector<Index> chain;
  for (std::size_t e = 0; e < recorded.size(); ++e) {
    chain.clear();
    if (recorded[e] != kNone) {
      for (const Index v : exact.of(recorded[e])) chain.push_back(written[v]);
      if (meshed[recorded[e]].from != surface.edges()[e].from) {
        std::reverse(chain.begin(), chain.end());
      }
    }
    chains.add(chain);
  }
  return chains;
}

// Nothing is promised of the doubles as written, so these oracles only count and measure.
void Verification::check_file_quality(const TetComplex& complex, const Neighbours& neighbours,
                                      const InputSurface& surface,
                                      const ConformityResult& conformity) {
  OracleReport delaunay =
      check_constrained_delaunay(complex, neighbours, surface, conformity.faces, {.gate = false});
  // A mesh all of whose faces are on the surface, as a single tetrahedron, has nothing to count.
  if (delaunay.checked > 0) add(std::move(delaunay));
  OracleReport angles("angles", "tetrahedra inside");
  angles.promised = false;
  for (const std::uint8_t inside : complex.inside) angles.checked += inside;
  measure_angles(complex, neighbours, complex.inside, angles);
  const Promise& promised = options_.promised;
  for (const auto& [is_promised, option] :
       {std::pair(promised.max_edge > 0, "--max-edge"),
        std::pair(!promised.size_field.empty(), "--size-field"),
        std::pair(promised.delta != Promise{}.delta, "--delta")}) {
    if (exact_ != nullptr || !is_promised) continue;
    angles.notes.push_back(std::string(option) +
                           " is promised of the refined mesh, which is in the record");
  }
  add(std::move(angles));
}

// Steiner points on the outer boundary are rounded like all others.
void Verification::check_file_hull(const TetComplex& complex, const Neighbours& neighbours) {
  if (report_.inverted + report_.flat > 0) return;  // the oracle needs positive tetrahedra
  add(check_hull(complex, neighbours,
                 {.allowed = std::max(
                      {kRoundedUlps * ulp_, slack_, options_.declared_deviation * diagonal_})}));
}

std::string Verification::check_input() {
#ifdef TETPROOF_SECOND_OPINIONS
  add(check_surface_validity(input_));  // it only asks other libraries
#endif
  return {};
}

}  // namespace tetproof::oracles
