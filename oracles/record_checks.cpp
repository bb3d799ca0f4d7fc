// The oracles on the record and on its final mesh.
#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "oracles/improvement/local_operations.h"
#include "oracles/mesh/delaunay.h"
#include "oracles/mesh/hull.h"
#include "oracles/mesh/measures.h"
#include "oracles/plan.h"
#include "oracles/record/same_mesh.h"
#include "oracles/surface/stand_in.h"
#ifdef TETPROOF_SECOND_OPINIONS
#include "oracles/cgal/second_kernel.h"
#endif

namespace tetproof::oracles {

namespace {

// No oracle would look at a point that nothing uses, or at a plane. Points on segments and
// triangles are given by vertices of the input.
void check_all_is_used(const delmesher::ExactRecord& record, std::size_t inputs,
                       OracleReport& report) {
  std::vector<std::uint8_t> used(record.points.size());
  const auto use = [&](std::uint32_t v) {
    if (v < used.size()) used[v] = 1;
  };
  const auto use_each = [&](const auto& list) { std::for_each(list.begin(), list.end(), use); };
  for (const auto& chain : record.segments) use_each(chain.vertices);
  for (const auto& corner : record.corners) use(corner.vertex);
  for (const auto* tets : {&record.refined, &record.final, &record.unrepaired}) {
    for (const auto& tet : *tets) use_each(tet.vertices);
  }
  for (const auto* faces :
       {&record.refined_facets, &record.final_facets, &record.unrepaired_facets}) {
    for (const auto& [a, b, c, facet] : *faces) use_each(std::array{a, b, c});
  }
  use_each(record.mesh_vertices);
  for (const auto& made : record.chamfer_points) use_each(made);
  for (const auto& ball : record.balls) {
    use(ball.vertex);
    use_each(ball.tetrahedron);
  }
  for (std::size_t v = inputs; v < used.size(); ++v) {
    if (used[v] == 0) report.fail("point " + std::to_string(v) + " is used by nothing");
  }
  std::vector<std::uint8_t> meets(record.planes.size());
  for (const delmesher::ExactPoint& p : record.points) {
    if (p.kind != delmesher::ExactPoint::Kind::on_planes) continue;
    for (const std::uint32_t plane : {p.i, p.j, p.k})
      meets[plane] = 1;  // in range: points are usable
  }
  for (std::size_t n = 0; n < meets.size(); ++n) {
    if (meets[n] == 0) report.fail("no vertex is on plane " + std::to_string(n));
  }
}

// The record as such, and the file beside it.
class Sidecar final : public Step {
 public:
  using Step::Step;
  std::string run() override;

 private:
  OracleReport check_written();
  OracleReport check_facet_list(const InputSurface& surface) const;
};

// The final mesh of the record, and the one before local operations.
class Final final : public Step {
 public:
  using Step::Step;
  std::string run() override;

 private:
  using FaceOnFacet = std::array<std::uint32_t, 4>;

  void check_exact_hull(const TetComplex& complex, const Neighbours& neighbours);
  void check_complex_of_final(const ExactPoints& points, const InputSurface& surface);
  Index facet_of(const InputSurface& surface, Index triangle) const;
  OracleReport check_facet_ids(const TetComplex& complex, const ConformityResult& conformity,
                               const InputSurface& surface,
                               const std::vector<FaceOnFacet>& listed) const;
  std::vector<Index> returned_vertices() const;
  void check_constrained(const TetComplex& complex, const Neighbours& neighbours,
                         const InputSurface& surface);
  void check_unrepaired();
};

std::string Sidecar::run() {
  const SharedData::Sidecar& sidecar = shared_.sidecar();
  OracleReport report = sidecar.report;
  if (sidecar.usable) check_all_is_used(*exact_, input_.vertices.size(), report);
  add(std::move(report));
  if (!sidecar.usable) return sidecar.why;
  ulp_ = ulp_of(sidecar.surface);
  diagonal_ = sidecar.diagonal;
  // First, as the points that are written take much memory; told last.
  OracleReport rounding = check_written();
  add(check_promise(options_.promised, *exact_, options_.record_version, diagonal_));
  if (!exact_->planes.empty() || !exact_->triangles.empty()) {
    add(check_stand_in(input_, *exact_, sidecar.surface));
  }
  add(check_facet_list(sidecar.surface));
  add(check_same_mesh(mesh_, *exact_, options_.promised, input_.labels));
  add(std::move(rounding));
  return {};
}

OracleReport Sidecar::check_written() {
  const std::shared_ptr<const ExactPoints> written = shared_.written();
  // Otherwise the oracles of the file measure it, on its surface.
  if (options_.stage == Stage::refined) {
    report_.deviation = largest_rounding(mesh_, *exact_, *written);
    report_.deviation_ulps = report_.deviation / ulp_;
  }
  return check_rounding(mesh_, *exact_, *written,
                        {.ulp = ulp_,
                         .allowed = options_.declared_deviation * diagonal_,
                         .input_vertices = static_cast<Index>(input_.vertices.size())});
}

// The facets of the record are those of the input, once each, with their triangles.
OracleReport Sidecar::check_facet_list(const InputSurface& surface) const {
  OracleReport report("facet-list", "facets");
  report.checked = surface.facets().size();
  if (const FacetIndex facets(surface, *exact_); !facets.defect().empty()) {
    report.fail(facets.defect());
  }
  return report;
}

std::string Final::run() {
  const SharedData::Sidecar& sidecar = shared_.sidecar();
  if (!sidecar.usable) return {};
  const ExactPoints& points = sidecar.final_points();
  const InputSurface& surface = sidecar.final_surface();
  ulp_ = ulp_of(surface);
  check_complex_of_final(points, surface);
  const bool usable = shared_.final()->shape.passed();
  shared_.forget_final();
#ifdef TETPROOF_SECOND_OPINIONS
  // Before the mesh that has not been improved takes the memory of this one; told after it.
  OracleReport second = check_second_kernel(input_, surface, *exact_, points, options_.sidecar,
                                            sidecar.as_given, options_.promised.keep);
#endif
  if (usable && !exact_->unrepaired.empty()) check_unrepaired();
#ifdef TETPROOF_SECOND_OPINIONS
  add(std::move(second), "exact-");
#endif
  return {};
}

void Final::check_complex_of_final(const ExactPoints& points, const InputSurface& surface) {
  const std::shared_ptr<const SharedData::Final> final = shared_.final();
  const auto& [complex, neighbours, shape, conformity] = *final;
  add(shape, "exact-");
  if (!shape.passed()) return;
  add(check_orientation(complex), "exact-");
  add(check_interior(complex, neighbours, surface, walls_of(complex, exact_->final_facets)),
      "exact-");
  add(conformity.report, "exact-");
  add(check_volume(complex, neighbours, surface, 0), "exact-");
  check_exact_hull(complex, neighbours);
  check_constrained(complex, neighbours, surface);
  add(check_facet_ids(complex, conformity, surface, exact_->final_facets), "exact-");
  if (options_.promised.task == Task::cdt && !options_.promised.keep) {
    add(check_origins(*exact_, points, surface, static_cast<Index>(input_.vertices.size())));
  }
}

// A facet is named by its first triangle, or, where each triangle is a face, by any.
Index Final::facet_of(const InputSurface& surface, Index triangle) const {
  if (triangle >= surface.triangles().size()) return kNone;
  const Index facet = surface.facet_of_triangle()[triangle];
  return options_.promised.keep || surface.facets()[facet].id == triangle ? facet : kNone;
}

// The faces that the record puts on facets are those that tile them, seen from outside.
OracleReport Final::check_facet_ids(const TetComplex& complex, const ConformityResult& conformity,
                                    const InputSurface& surface,
                                    const std::vector<FaceOnFacet>& listed) const {
  OracleReport report("facets", "faces");
  struct Tile {
    Face face;
    Index facet;
    bool even;  // the permutation of the ascending corners that is seen from outside
    auto operator<=>(const Tile&) const = default;
  };
  std::vector<Tile> tiles;
  tiles.reserve(conformity.faces.size());
  for (Index f = 0; f < conformity.faces.size(); ++f) {
    Face face = conformity.faces[f];
    const bool even = sort_face(face);
    tiles.push_back({face, conformity.facets[f], even});
  }
  std::sort(tiles.begin(), tiles.end());
  std::vector<std::uint8_t> seen(tiles.size());
  for (const auto& [a, b, c, id] : listed) {
    Face face = {a, b, c};
    const bool even = sort_face(face);
    ++report.checked;
    const auto found = std::lower_bound(tiles.begin(), tiles.end(), Tile{face, Index{0}, false});
    if (found == tiles.end() || found->face != face) {
      report.fail(complex.face_name(face) + " is not a boundary face of the solid");
    } else if (seen[found - tiles.begin()]++ != 0) {
      report.fail(complex.face_name(face) + " is listed twice");
    } else if (found->even != even) {
      report.fail(complex.face_name(face) + " is turned over");
    } else if (found->facet != kNone && facet_of(surface, id) != found->facet) {
      report.fail(complex.face_name(face) + " is said to tile facet " + std::to_string(id) +
                  " but tiles " + std::to_string(surface.facets()[found->facet].id));
    }
  }
  if (report.checked != tiles.size()) report.fail("not every boundary face is listed once");
  return report;
}

// What was improved, or put back onto the surface as given, has no tetrahedra outside if none were
// asked for; the mesh before that has. That nothing overlaps follows then from the surface:
// positive tetrahedra lie at a point as often as it winds around it.
void Final::check_exact_hull(const TetComplex& complex, const Neighbours& neighbours) {
  const bool improved = options_.promised.improve && !exact_->unrepaired.empty();
  const bool inside_alone = (improved || shared_.sidecar().as_given) &&
                            options_.promised.region == delmesher::Region::interior &&
                            std::all_of(exact_->final.begin(), exact_->final.end(),
                                        [](const auto& t) { return t.inside; });
  if (!inside_alone) {
    add(check_hull(complex, neighbours), "exact-");
    return;
  }
  OracleReport report("hull", "tetrahedra");
  report.checked = exact_->final.size();
  report.promised = false;
  report.notes.emplace_back("the record's final mesh is the solid alone: nothing fills the hull");
  add(std::move(report), "exact-");
}

// On edges of the surface as given that the surface which was refined does not have. They excuse
// what was promised on the surface as given, not a mesh that claims to be of that.
std::vector<Index> Final::returned_vertices() const {
  const SharedData::Sidecar& sidecar = shared_.sidecar();
  std::vector<Index> vertices;
  if (!sidecar.as_given || options_.promised.planar != 0) return vertices;
  std::set<std::pair<Index, Index>> returned;
  for (const auto& edge : sidecar.surface_as_given.edges()) {
    returned.insert(std::minmax(edge.from, edge.to));
  }
  for (const auto& edge : sidecar.surface.edges()) {
    returned.erase(std::minmax(edge.from, edge.to));
  }
  for (const auto& [from, to] : returned) vertices.insert(vertices.end(), {from, to});
  for (Index v = 0; v < exact_->points.size(); ++v) {
    const delmesher::ExactPoint& p = exact_->points[v];
    const bool on_edge = p.kind == delmesher::ExactPoint::Kind::on_segment;
    if (on_edge && returned.contains(std::minmax(p.i, p.j))) vertices.push_back(v);
  }
  return vertices;
}

// The property is demanded before improvement and repairs of rounding, and counted after them.
void Final::check_constrained(const TetComplex& complex, const Neighbours& neighbours,
                              const InputSurface& surface) {
  std::vector<Face> constraints;
  for (const auto& [a, b, c, id] : exact_->final_facets) constraints.push_back({a, b, c});
  const bool repaired = !exact_->unrepaired.empty();
  OracleReport delaunay =
      repaired
          ? check_constrained_delaunay(complex, neighbours, surface, constraints, {.gate = false})
          : check_constrained_delaunay(complex, neighbours, surface, constraints,
                                       {.known = shared_.known_to_be_delaunay()});
  // Where nothing is demanded, a mesh all of whose faces are on the surface has nothing to count.
  if (!repaired || delaunay.checked > 0) add(std::move(delaunay), "exact-");
}

// A mesh of the surface that was refined.
void Final::check_unrepaired() {
  const SharedData::Sidecar& sidecar = shared_.sidecar();
  // Of a kept surface only the surface is promised, which the final mesh shows by itself.
  if (!options_.promised.keep) {
    const std::shared_ptr<const ExactPoints> written = shared_.written();
    add(options_.promised.improve
            ? check_improvement(*exact_, *written, options_.promised, returned_vertices())
            : check_repairs(*exact_, *written, options_.promised));
  }
  memory_.done_with(kFinalTetrahedra);
  const TetComplex before = complex_of(exact_->unrepaired, sidecar.points);
  memory_.done_with(kUnrepairedTetrahedra);
  Neighbours neighbours;
  OracleReport shape = check_complex(before, neighbours);
  const bool usable = shape.passed();
  add(std::move(shape), "unrepaired-");
  if (!usable) return;
  add(check_orientation(before), "unrepaired-");
  // Otherwise the unrepaired mesh could lack the wrong part of the final one.
  add(check_hull(before, neighbours), "unrepaired-");
  // The record lists none if repairs did not change them.
  const auto& listed =
      exact_->unrepaired_facets.empty() ? exact_->final_facets : exact_->unrepaired_facets;
  {
    const ConformityResult conformity =
        check_conformity(before, neighbours, sidecar.surface, {.exact = true});
    add(conformity.report, "unrepaired-");
    add(check_facet_ids(before, conformity, sidecar.surface, listed), "unrepaired-");
  }
  std::vector<Face> constraints;
  for (const auto& [a, b, c, id] : listed) constraints.push_back({a, b, c});
  add(check_constrained_delaunay(before, neighbours, sidecar.surface, constraints,
                                 {.known = shared_.known_to_be_delaunay()}),
      "unrepaired-");
}

}  // namespace

std::unique_ptr<Step> check_sidecar(const Subject& subject) {
  return std::make_unique<Sidecar>(subject);
}
std::unique_ptr<Step> check_final(const Subject& subject) {
  return std::make_unique<Final>(subject);
}

}  // namespace tetproof::oracles
