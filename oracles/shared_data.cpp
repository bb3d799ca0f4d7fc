#include "oracles/shared_data.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "oracles/base/box.h"
#include "oracles/base/vectors.h"
#include "oracles/mesh/delaunay.h"

namespace tetproof::oracles {
namespace {

using delmesher::ExactRecord;

// Names a number of the record, apart from its points, that is not finite, so that nothing can be
// decided; empty if all are.
std::string endless(const ExactRecord& record) {
  const ExactRecord::Parameters& p = record.parameters;
  if (!std::isfinite(p.delta)) return "delta";
  if (!std::isfinite(p.acute) || !std::isfinite(p.corner)) return "a threshold";
  if (!std::isfinite(p.tolerance)) return "the tolerance";
  if (!std::isfinite(p.planar)) return "the bound of planar facets";
  for (const ExactRecord::Corner& corner : record.corners) {
    if (!std::isfinite(corner.distance)) {
      return "the distance of corner " + std::to_string(corner.vertex);
    }
  }
  return {};
}

// Names a section with a number of no point, or of no triangle of the input, so that nothing can be
// decided; empty if there is none. Written vertices are for other oracles.
std::string out_of_range(const ExactRecord& record, std::size_t triangles) {
  const std::size_t points = record.points.size();
  const auto all_below = [](const auto& list, std::size_t count) {
    return std::all_of(list.begin(), list.end(), [count](Index i) { return i < count; });
  };
  for (const ExactRecord::Facet& facet : record.facets) {
    if (!all_below(facet.triangles, triangles)) return "facets";
  }
  for (const ExactRecord::Chain& chain : record.segments) {
    if (!all_below(chain.vertices, points)) return "segments";
  }
  for (const ExactRecord::Corner& corner : record.corners) {
    if (corner.vertex >= points) return "corners";
  }
  for (const auto& made : record.chamfer_points) {
    if (!all_below(made, points)) return "chamfer_points";
  }
  for (const ExactRecord::Ball& ball : record.balls) {
    if (ball.vertex >= points || !all_below(ball.tetrahedron, points)) return "balls";
  }
  for (const auto* tets : {&record.refined, &record.final, &record.unrepaired}) {
    for (const ExactRecord::Tet& tet : *tets) {
      if (!all_below(tet.vertices, points)) return "tetrahedra";
    }
  }
  for (const auto* faces :
       {&record.refined_facets, &record.final_facets, &record.unrepaired_facets}) {
    for (const auto& [a, b, c, id] : *faces) {
      if (std::max({a, b, c}) >= points) return "faces on facets";
    }
  }
  return {};
}

// Does a face of the final mesh tile a facet that the record, whose facets are those of the surface
// that was refined, does not list?
bool names_other_facets(const ExactRecord& record) {
  std::vector<std::uint32_t> listed;
  for (const ExactRecord::Facet& facet : record.facets) listed.push_back(facet.id);
  std::sort(listed.begin(), listed.end());
  return std::any_of(record.final_facets.begin(), record.final_facets.end(), [&](const auto& face) {
    return !std::binary_search(listed.begin(), listed.end(), face[3]);
  });
}

}  // namespace

double diagonal_of(const Polyhedron& input) {
  Box box;
  for (const auto& t : input.triangles) {
    for (const Index v : t) {
      if (v < input.vertices.size()) box.add(input.vertices[v]);
    }
  }
  return box.diagonal();
}

TetComplex complex_of(const std::vector<ExactRecord::Tet>& tets, const ExactPoints& points) {
  TetComplex complex{&points, {}, {}, 0, 0};
  complex.tetrahedra.reserve(tets.size());
  complex.inside.reserve(tets.size());
  for (const ExactRecord::Tet& tet : tets) {
    complex.tetrahedra.push_back(tet.vertices);
    complex.inside.push_back(tet.inside);
  }
  return complex;
}

void SharedData::tell_refined_is_delaunay() {
  const auto& first = exact_->unrepaired.empty() ? exact_->final : exact_->unrepaired;
  const bool other_points = exact_->unrepaired.empty() && sidecar().as_given;
  if (first.empty() || other_points) return;
  std::vector<std::uint8_t> found = in_both(first, refined().complex);
  const std::lock_guard<std::mutex> lock(final_mutex_);
  in_refined_ = std::move(found);
}

void SharedData::make_final() {
  if (final_) return;
  const Sidecar& s = sidecar();
  const auto made = std::make_shared<Final>();
  made->complex = complex_of(exact_->final, s.final_points());
  made->shape = check_complex(made->complex, made->neighbours);
  if (made->shape.passed()) {
    made->conformity = check_conformity(made->complex, made->neighbours, s.final_surface(),
                                        {.exact = true, .want_chains = true});
  }
  if (!final_chains_known_) final_chains_ = std::move(made->conformity.chains);
  made->conformity.chains = {};
  final_chains_known_ = true;
  final_ = made;
}

std::string SharedData::place_as_given(ExactPoints& points) const {
  std::vector<delmesher::ExactPoint> definitions = exact_->points;
  const auto given = explicit_points(input_.vertices);
  std::copy(given.begin(), given.end(), definitions.begin());
  return points.assign(definitions);
}

std::shared_ptr<const ExactPoints> SharedData::written() {
  const Sidecar& s = sidecar();
  if (!s.moved || s.as_given) {
    return {std::shared_ptr<const void>(), s.moved ? &s.given : &s.points};  // they stay
  }
  {
    const std::lock_guard<std::mutex> lock(written_mutex_);
    if (written_ != nullptr) return std::exchange(written_, nullptr);
  }
  const auto points = std::make_shared<ExactPoints>();
  place_as_given(*points);  // without defect, as it was done before
  return points;
}

void SharedData::read_sidecar() {
  Sidecar& s = sidecar_;
  if (const std::string why = s.points.assign(exact_->points, exact_->planes); !why.empty()) {
    s.report.checked_what = "points";
    s.report.checked = exact_->points.size();
    s.report.fail("the sidecar's " + why);
    return;
  }
  for (Index v = 0; v < input_.vertices.size(); ++v) {
    ++s.report.checked;
    using Kind = delmesher::ExactPoint::Kind;
    const bool there = v < s.points.size();
    s.moved = s.moved || (there && exact_->points[v].kind == Kind::on_planes);
    if (there && exact_->points[v].kind == Kind::on_planes) continue;  // for the stand-in oracle
    if (!there || exact_->points[v].kind != Kind::explicit_point ||
        s.points.nearest(v) != input_.vertices[v]) {
      s.report.fail("input vertex " + std::to_string(v) + " is not point " + std::to_string(v));
    }
  }
  for (std::size_t v = input_.vertices.size(); v < exact_->points.size(); ++v) {
    if (exact_->points[v].kind != delmesher::ExactPoint::Kind::on_planes) continue;
    s.report.fail("point " + std::to_string(v) + " is on planes, but no vertex of the input");
  }
  if (!exact_->triangles.empty() && exact_->triangles.size() != input_.triangles.size()) {
    s.report.fail("the record has " + std::to_string(exact_->triangles.size()) +
                  " triangles, the input " + std::to_string(input_.triangles.size()));
  }
  if (const std::string name = endless(*exact_); !name.empty()) {
    s.report.fail(name + " is not finite");
  }
  if (const std::string name = out_of_range(*exact_, input_.triangles.size()); !name.empty()) {
    s.report.fail(name + " name what does not exist");
  }
  s.diagonal = diagonal_of(input_);
  // The stand-in oracle says how far a vertex may be moved. Beyond the whole input nothing is left
  // to ask, and intervals around such places decide nothing, which takes very long.
  for (Index v = 0; s.moved && v < input_.vertices.size() && s.report.passed(); ++v) {
    if (!(distance(s.points.nearest(v), input_.vertices[v]) <= s.diagonal)) {
      s.report.fail("input vertex " + std::to_string(v) +
                    " was moved by more than the input's size");
    }
  }
  if (!s.report.passed()) return;
  if (s.moved) {
    if (const std::string why = place_as_given(s.given); !why.empty()) {
      s.report.fail("with the vertices as given: " + why);
      return;
    }
  }
  Polyhedron meshed = input_;
  if (!exact_->triangles.empty()) meshed.triangles = exact_->triangles;
  s.why = s.surface.assign(meshed, s.points);
  s.usable = s.why.empty();
  if (!s.usable && (s.moved || !exact_->triangles.empty())) {
    s.report.fail("the surface that was meshed: " + s.why);
    s.why.clear();
  }
  // What was promised as given is judged as given; so is a mesh that claims to be more than was
  // promised.
  s.as_given = s.usable && s.moved && (promise_.planar == 0 || names_other_facets(*exact_));
  if (s.moved && !s.as_given) {
    written_ = std::make_shared<const ExactPoints>(std::exchange(s.given, {}));
  }
  if (!s.as_given) return;
  s.why = s.surface_as_given.assign(input_, s.given);
  s.usable = s.why.empty();
}

}  // namespace tetproof::oracles
