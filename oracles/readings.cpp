#include "oracles/readings.h"

#include <algorithm>
#include <string>
#include <utility>

#include "oracles/record/refined_index.h"

namespace tetproof::oracles {

struct Readings::Reading {
  const char* name;
  const char* because;  // why a mesh that conforms so is one of the input
  bool (Readings::*asked)() const;
  bool (Readings::*conforms)();
};

const Readings::Reading Readings::kReadings[] = {
    {"exact", "every vertex of the boundary is exactly in its place", &Readings::always,
     &Readings::is_exact},
    {"rounded", "vertices are at most 4 ulp of the largest coordinate there from their places",
     &Readings::near_planar, &Readings::is_rounded},
    {"facets united", "facets within the promised slab count as one where no mesh edge parts them",
     &Readings::near_planar, &Readings::has_united_facets},
    {"needles moved",
     "a triangle no wider than the promised slab may belong to the facet on either side",
     &Readings::near_planar_alone, &Readings::has_moved_needles},
    {"facets of the record", "the record says which triangles, within the promised slab, are one",
     &Readings::near_planar_recorded, &Readings::has_recorded_facets},
    {"deviating", "the deviation is measured; the verdict and --declared-deviation judge it",
     &Readings::always, &Readings::deviates},
    {"wider slab",
     "nothing says how far facets are from planar; the slab is measured, and the verdict, "
     "--promised and --declared-deviation judge it",
     &Readings::near_planar_unstated, &Readings::has_wider_slab},
};

Readings::Readings(const Subject& subject, const TetComplex& complex, const Neighbours& neighbours,
                   const InputSurface& surface, double ulp, double diagonal, double largest_given)
    : input_(subject.input),
      exact_(subject.exact),
      shared_(subject.shared),
      complex_(complex),
      neighbours_(neighbours),
      surface_(surface),
      rounding_(kRoundedUlps * ulp),
      diagonal_(diagonal),
      bound_(subject.options.promised.planar_share() * diagonal),
      widest_(subject.options.promised.most_planar() * diagonal),
      stated_(subject.options.promised.stated_planar.has_value()),
      declared_(subject.options.declared_deviation * diagonal) {
  const double share = rounding_ / diagonal;
  // A solid may be so small that roundings are a larger share of its diagonal.
  rounded_.largest_tolerance = std::max(rounded_.largest_tolerance, share);
  as_rounded_.largest_tolerance = share;
  rounded_.largest_given = as_rounded_.largest_given = largest_given;
}

ConformityResult Readings::conformity() {
  for (const Reading& reading : kReadings) {
    if (!(this->*reading.asked)() || !(this->*reading.conforms)()) continue;
    result_.report.notes.push_back(std::string("read as \"") + reading.name +
                                   "\": " + reading.because);
    break;
  }
  return std::move(result_);
}

// What fails by positions alone is judged by the record's chains, if there is one.
ConformityResult Readings::check(const InputSurface& on, ConformityOptions options) const {
  const bool recorded = shared_.has_final();
  options.first_failure_ends = recorded;
  ConformityResult result = check_conformity(complex_, neighbours_, on, options);
  if (result.report.passed() || !recorded) return result;
  const Chains chains = recorded_chains(on);
  options.chains = &chains;
  options.first_failure_ends = false;
  return check_conformity(complex_, neighbours_, on, options);
}

bool Readings::is_exact() {
  result_ = check_conformity(complex_, neighbours_, surface_,
                             {.exact = true, .first_failure_ends = true});
  return result_.report.passed();
}

bool Readings::is_rounded() {
  result_ = check(surface_, as_rounded_);
  failed_edges_ = result_.failed_edges;
  return result_.report.passed() && result_.ulps <= kRoundedUlps;
}

// Chains that the record gives may be anywhere. Only facets were promised to be no more than planar
// within a bound, their edges are as given.
bool Readings::conforms_to(InputSurface flat, double width) {
  if (!(width <= bound_)) return false;
  as_rounded_.off_plane = rounding_;
  as_rounded_.planar = width > 0 ? bound_ : 0;
  ConformityResult of_flat = check(flat, as_rounded_);
  const bool near = of_flat.off_edges_ulps <= kRoundedUlps * (1 + 1e-9) ||
                    of_flat.off_edges <= declared_ * (1 + 1e-9);
  if (!of_flat.report.passed() || !near) return false;
  of_flat.slab = width;
  of_flat.deviation = std::max(of_flat.deviation, width);
  for (Index f = 0; f < flat.facets().size(); ++f) {
    const double ulp = flat.ulp_on(f, as_rounded_.largest_given);
    of_flat.ulps = std::max(of_flat.ulps, flat.facets()[f].slab / ulp);
  }
  of_flat.report.figures.emplace_back("slab over diagonal", width / diagonal_);
  of_flat.report.figures.emplace_back(
      "facets united",
      static_cast<double>(surface_.facets().size()) - static_cast<double>(flat.facets().size()));
  united_ = std::move(flat);
  result_ = std::move(of_flat);
  return true;
}

bool Readings::has_united_facets() {
  InputSurface flat = surface_;
  const double width = flat.unite_facets(failed_edges_, bound_, *complex_.points);
  return conforms_to(std::move(flat), width);
}

bool Readings::has_moved_needles() {
  InputSurface flat = surface_;
  flat.unite_facets(failed_edges_, bound_, *complex_.points);
  const double width = flat.move_needles(
      [&](const InputSurface& parted) { return check(parted, as_rounded_).failed_edges; }, bound_,
      *complex_.points);
  return conforms_to(std::move(flat), width);
}

// Whether they are facets is decided as before.
bool Readings::has_recorded_facets() {
  const std::vector<Index> named = recorded_facets();
  if (named.size() != surface_.triangles().size()) return false;
  InputSurface flat = surface_;
  const double width = flat.group_facets(named, bound_, *complex_.points);
  return conforms_to(std::move(flat), width);
}

bool Readings::deviates() {
  result_ = check(surface_, rounded_);
  return result_.report.passed();
}

bool Readings::has_wider_slab() {
  bound_ = widest_;
  return has_united_facets() || has_moved_needles();
}

// Per triangle of the input the facet that has it, by the record; empty if a triangle is in none.
std::vector<Index> Readings::recorded_facets() const {
  std::vector<Index> facet(input_.triangles.size(), kNone);
  for (const delmesher::ExactRecord::Facet& f : exact_->facets) {
    for (const std::uint32_t t : f.triangles) {
      if (t < facet.size()) facet[t] = f.id;
    }
  }
  if (std::find(facet.begin(), facet.end(), kNone) != facet.end()) facet.clear();
  return facet;
}

// The chain of mesh edges on which each edge of the surface lies by the record's exact coordinates,
// in vertices of the file.
Chains Readings::recorded_chains(const InputSurface& surface) const {
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

}  // namespace tetproof::oracles
