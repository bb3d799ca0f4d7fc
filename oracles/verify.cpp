#include "oracles/verify.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <set>

#include "oracles/chamfer.h"
#include "oracles/delaunay.h"
#include "oracles/enrichment.h"
#include "oracles/filter.h"
#include "oracles/hull.h"
#include "oracles/local_operations.h"
#include "oracles/parallel.h"
#include "oracles/places.h"
#include "oracles/refinement.h"
#include "oracles/regions.h"
#include "oracles/same_mesh.h"
#include "oracles/stand_in.h"
#include "oracles/surface_validity.h"
#ifdef TETPROOF_SECOND_OPINIONS
#include "oracles/cgal/second_kernel.h"
#endif

namespace tetproof::oracles {
namespace {

using delmesher::ExactRecord;

constexpr double kRoundedUlps = 4;

double figure(const OracleReport& report, const std::string& name) {
  for (const auto& [key, value] : report.figures) {
    if (key == name) return value;
  }
  return 0;
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

// Names a number of the record, apart from its points, that is not finite, so that nothing can be
// decided; empty if all are.
std::string endless(const ExactRecord& record) {
  const ExactRecord::Parameters& p = record.parameters;
  if (!std::isfinite(p.delta)) return "delta";
  if (!std::isfinite(p.acute) || !std::isfinite(p.corner)) return "a threshold";
  if (!std::isfinite(p.tolerance)) return "the tolerance";
  if (!std::isfinite(p.planar)) return "the bound of planar facets";
  for (const ExactRecord::Corner& corner : record.corners) {
    if (std::isfinite(corner.threshold) && std::isfinite(corner.radius)) continue;
    return "the threshold or radius of corner " + std::to_string(corner.vertex);
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

// The diagonal of the bounding box of the vertices that have triangles.
double diagonal_of(const Polyhedron& input) {
  Position low{HUGE_VAL, HUGE_VAL, HUGE_VAL}, high{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
  for (const auto& t : input.triangles) {
    for (const Index v : t) {
      for (std::size_t i = 0; v < input.vertices.size() && i < 3; ++i) {
        low[i] = std::min(low[i], input.vertices[v][i]);
        high[i] = std::max(high[i], input.vertices[v][i]);
      }
    }
  }
  return std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
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

// Data that several parts of a verification need, made by the first that asks.
class Shared {
 public:
  struct Sidecar {
    ExactPoints points;
    // The same points on the vertices as given, if some were moved: these are written.
    ExactPoints given;
    InputSurface surface;  // that was meshed
    // Is the final mesh one of the surface as given, although another was refined?
    bool as_given = false;
    InputSurface surface_as_given;
    double diagonal = 0;  // of the input
    OracleReport report{"sidecar", "input vertices"};
    std::string why;      // the input bounds no solid
    bool usable = false;  // points and surface have been made

    const ExactPoints& written() const { return given.size() > 0 ? given : points; }
    // Of the final mesh.
    const ExactPoints& final_points() const { return as_given ? given : points; }
    const InputSurface& final_surface() const { return as_given ? surface_as_given : surface; }
  };
  struct Final {
    TetComplex complex;
    Neighbours neighbours;
    OracleReport shape{"complex"};
    ConformityResult conformity;  // with chains; empty unless the shape passed
  };
  struct Refined {
    TetComplex complex;
    Neighbours neighbours;
    OracleReport shape{"complex"};
    std::unique_ptr<const Places> places;
  };

  Shared(const Polyhedron& input, const ExactRecord* exact, const Promise& promise)
      : input_(input), exact_(exact), promise_(promise) {}

  const Sidecar& sidecar() {
    sidecar_once_([this] { read_sidecar(); });
    return sidecar_;
  }
  // The final mesh of the record. Only for a usable sidecar.
  std::shared_ptr<const Final> final();
  // Its memory, once its own oracles are done.
  void forget_final() {
    const std::lock_guard<std::mutex> lock(final_mutex_);
    final_.reset();
  }
  // The arguments of the oracles of the refined mesh, once there is one.
  RefinedMesh refined_mesh() const {
    return {exact_,
            &sidecar_.points,
            &sidecar_.surface,
            &refined_.complex,
            &refined_.neighbours,
            &promise_,
            static_cast<Index>(input_.vertices.size())};
  }
  // Only for a usable sidecar.
  const Refined& refined() {
    refined_once_([this] {
      refined_.complex = complex_of(exact_->refined, sidecar().points);
      refined_.shape = check_complex(refined_.complex, refined_.neighbours);
      refined_.places = std::make_unique<const Places>(refined_mesh());
    });
    return refined_;
  }
  std::mutex progress;

 private:
  void read_sidecar();

  const Polyhedron& input_;
  const ExactRecord* exact_;
  const Promise& promise_;
  Once sidecar_once_, refined_once_;
  std::mutex final_mutex_;
  std::shared_ptr<const Final> final_;
  Sidecar sidecar_;
  Refined refined_;
};

std::shared_ptr<const Shared::Final> Shared::final() {
  const Sidecar& s = sidecar();
  const std::lock_guard<std::mutex> lock(final_mutex_);
  if (final_) return final_;
  const auto made = std::make_shared<Final>();
  made->complex = complex_of(exact_->final, s.final_points());
  made->shape = check_complex(made->complex, made->neighbours);
  if (made->shape.passed()) {
    made->conformity = check_conformity(made->complex, made->neighbours, s.final_surface(),
                                        {.exact = true, .want_chains = true});
  }
  final_ = made;
  return final_;
}

void Shared::read_sidecar() {
  Sidecar& s = sidecar_;
  if (const std::string why = s.points.assign(exact_->points, exact_->planes); !why.empty()) {
    s.report.checked_what = "points";
    s.report.checked = exact_->points.size();
    s.report.fail("the sidecar's " + why);
    return;
  }
  bool moved = false;
  for (Index v = 0; v < input_.vertices.size(); ++v) {
    ++s.report.checked;
    using Kind = delmesher::ExactPoint::Kind;
    const bool there = v < s.points.size();
    moved = moved || (there && exact_->points[v].kind == Kind::on_planes);
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
  if (!s.report.passed()) return;
  if (moved) {
    std::vector<delmesher::ExactPoint> definitions = exact_->points;
    const auto given = explicit_points(input_.vertices);
    std::copy(given.begin(), given.end(), definitions.begin());
    if (const std::string why = s.given.assign(definitions); !why.empty()) {
      s.report.fail("with the vertices as given: " + why);
      return;
    }
  }
  s.diagonal = diagonal_of(input_);
  Polyhedron meshed = input_;
  if (!exact_->triangles.empty()) meshed.triangles = exact_->triangles;
  s.why = s.surface.assign(meshed, s.points);
  s.usable = s.why.empty();
  if (!s.usable && (moved || !exact_->triangles.empty())) {
    s.report.fail("the surface that was meshed: " + s.why);
    s.why.clear();
  }
  // What was promised as given is judged as given; so is a mesh that claims to be more than was
  // promised.
  s.as_given = s.usable && moved && (promise_.planar == 0 || names_other_facets(*exact_));
  if (!s.as_given) return;
  s.why = s.surface_as_given.assign(input_, s.given);
  s.usable = s.why.empty();
}

// One part of a verification, with a report of its own. Each check returns why the input bounds no
// solid, or an empty text.
class Verification {
 public:
  using Check = std::string (Verification::*)();
  using FaceOnFacet = std::array<std::uint32_t, 4>;  // of the record

  Verification(const Polyhedron& input, const MeshFile& mesh, const ExactRecord* exact,
               const VerifyOptions& options, Shared& shared)
      : input_(input), mesh_(mesh), exact_(exact), options_(options), shared_(shared) {}

  // The checks of a verification, in the order of their reports.
  static std::vector<Check> checks(const ExactRecord* exact, Stage stage);
  // Appends this part's report; the last part that knows them tells the measures of the input.
  void move_to(VerifyReport& report, double& ulp, double& diagonal);

 private:
  // The mesh as written, on its doubles.
  bool check_finite();
  std::string check_file();
  std::string check_input();
  std::vector<std::vector<Index>> recorded_chains(const InputSurface& surface);
  std::vector<Index> recorded_facets() const;
  ConformityResult conformity_of_file(const TetComplex& complex, const Neighbours& neighbours,
                                      const InputSurface& surface,
                                      std::optional<InputSurface>& united);
  void check_file_surface(const TetComplex& complex, const Neighbours& neighbours,
                          const InputSurface& input);
  void check_file_hull(const TetComplex& complex, const Neighbours& neighbours);
  void check_file_quality(const TetComplex& complex, const Neighbours& neighbours,
                          const InputSurface& surface, const ConformityResult& conformity);
  void turn_all(TetComplex& complex) const;
  std::string check_sidecar();
  OracleReport check_facet_list(const InputSurface& surface) const;
  std::string check_exact_final();
  void check_exact_hull(const TetComplex& complex, const Neighbours& neighbours);
  void check_final_complex(const ExactPoints& points, const InputSurface& surface);
  std::string check_refined_complex();
  std::string check_refined_angles();
  std::string check_refined_inside();
  std::string check_refined_promises();
  OracleReport check_facet_ids(const TetComplex& complex, const ConformityResult& conformity,
                               const InputSurface& surface,
                               const std::vector<FaceOnFacet>& listed) const;
  std::vector<Index> returned_vertices() const;
  void check_constrained(const TetComplex& complex, const Neighbours& neighbours,
                         const InputSurface& surface);
  void check_unrepaired();
  void check_promises(const RefinedMesh& mesh);
  OracleReport check_contained(const TetComplex& complex, const Places& places) const;
  OracleReport check_edges(const TetComplex& complex) const;
  double delta() const;
  AngleScope scope() const;
  void add(OracleReport oracle, const std::string& prefix = {}) {
    oracle.name = prefix + oracle.name;
    if (options_.progress) {
      const std::lock_guard<std::mutex> lock(shared_.progress);
      options_.progress(oracle);
    }
    report_.oracles.push_back(std::move(oracle));
  }

  const Polyhedron& input_;
  const MeshFile& mesh_;
  const ExactRecord* exact_;
  const VerifyOptions& options_;
  Shared& shared_;
  VerifyReport report_;
  double ulp_ = 0, diagonal_ = 0;
  double slack_ = 0;  // how far the surface of the file may be from where it belongs
};

std::vector<Verification::Check> Verification::checks(const ExactRecord* exact, Stage stage) {
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
    const Position& p = mesh_.vertices[v];
    if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2])) {
      report.fail("vertex " + std::to_string(v) + " is not finite");
    }
  }
  if (report.violations == 0) return true;
  add(std::move(report));
  return false;
}

std::string Verification::check_file() {
  if (!check_finite()) return {};
  std::vector<Position> positions = input_.vertices;
  positions.insert(positions.end(), mesh_.vertices.begin(), mesh_.vertices.end());
  ExactPoints points;
  InputSurface surface;
  if (std::string why = points.assign(positions); !why.empty()) return why;
  if (std::string why = surface.assign(input_, points); !why.empty()) return why;
  ulp_ = std::ldexp(1.0, std::ilogb(surface.largest_coordinate()) - 52);
  diagonal_ = surface.diagonal();

  const auto offset = static_cast<Index>(input_.vertices.size());
  TetComplex complex{&points, mesh_.tetrahedra, {}, offset, static_cast<Index>(points.size())};
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
  report_.inverted = static_cast<std::uint64_t>(figure(orientation, "inverted"));
  report_.flat = static_cast<std::uint64_t>(figure(orientation, "flat"));
  add(std::move(orientation));
  complex.inside = inside_by_parity(complex, surface);
  if (options_.stage == Stage::refined) {
    add(check_angles(complex, neighbours, Places(complex, neighbours, surface), delta(), scope()));
    return {};
  }
  std::vector<std::int64_t> given = mesh_.regions;
  const bool solid_only =
      fills(complex, surface,
            std::max(kRoundedUlps * ulp_, options_.promised.planar_share() * diagonal_));
  if (given.empty() && solid_only) given.assign(complex.tetrahedra.size(), 0);
  if (given.empty()) {  // the hull: parity alone decides
    check_file_surface(complex, neighbours, surface);
    check_file_hull(complex, neighbours);
    return {};
  }
  const Regions regions(complex, given);
  check_file_surface(complex, neighbours, surface);
  // The centroid of a tetrahedron is a quarter of its altitude away from its faces.
  add(regions.check_strays(8 * slack_));
  if (!solid_only) check_file_hull(complex, neighbours);
  return {};
}

// Tries the surface as it is first. If facets that are planar within a bound may be one, those are
// united that no chain of mesh edges separates, provided that the mesh conforms to the united
// surface, which is then returned as well.
ConformityResult Verification::conformity_of_file(const TetComplex& complex,
                                                  const Neighbours& neighbours,
                                                  const InputSurface& surface,
                                                  std::optional<InputSurface>& united) {
  ConformityResult result =
      check_conformity(complex, neighbours, surface, {.exact = true, .first_failure_ends = true});
  if (result.report.passed()) return result;
  const auto check = [&](const InputSurface& on, ConformityOptions options) {
    ConformityResult r = check_conformity(complex, neighbours, on, options);
    if (r.report.passed() || exact_ == nullptr || exact_->final.empty()) return r;
    const auto chains = recorded_chains(on);
    options.chains = &chains;
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
  const auto conforms_to = [&](InputSurface& flat, double width) {
    if (!(width <= bound)) return false;
    as_rounded.off_plane = width + kRoundedUlps * ulp_;
    ConformityResult of_flat = check(flat, as_rounded);
    if (!of_flat.report.passed()) return false;
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
  const double width = flat.unite_facets(failed_edges, bound, *complex.points);
  if (conforms_to(flat, width)) return result;
  // Triangles no wider than roundings may belong to one facet or to another. The record says to
  // which, and whether that is a facet is decided as before.
  if (exact_ == nullptr) return at_most_deviating();
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
  add(check_volume(complex, neighbours, input,
                   2 * slack_ * surface_area(complex, conformity.faces)));
  check_file_quality(complex, neighbours, surface, conformity);
  // If the faces' facets are unknown, so are the labels they should have.
  if (mesh_.boundary.empty() || conformity.report.undecided) return;
  std::vector<Face> listed = mesh_.boundary;
  for (Face& face : listed) {
    for (Index& v : face) v += complex.first_vertex;
  }
  const bool labelled = !input_.labels.empty() && mesh_.labels.size() == listed.size();
  add(check_boundary_list(complex, neighbours, surface, conformity, listed,
                          labelled ? mesh_.labels : std::vector<std::int32_t>{}));
}

// The chain of mesh edges on which each edge of the surface lies by the record's exact coordinates,
// in vertices of the file.
std::vector<std::vector<Index>> Verification::recorded_chains(const InputSurface& surface) {
  std::vector<std::vector<Index>> chains(surface.edges().size());
  const Shared::Sidecar& sidecar = shared_.sidecar();
  if (!sidecar.usable) return chains;
  const std::shared_ptr<const Shared::Final> final = shared_.final();
  if (!final->shape.passed()) return chains;
  const ConformityResult& exact = final->conformity;
  std::vector<Index> written(sidecar.points.size(), kNone);
  for (std::size_t i = 0; i < exact_->mesh_vertices.size(); ++i) {
    const Index v = exact_->mesh_vertices[i];
    if (v >= written.size()) continue;  // check_rounding reports it
    written[v] = static_cast<Index>(input_.vertices.size() + i);
  }
  // The surface that was meshed may have fewer edges than the input, or in another direction.
  std::map<std::pair<Index, Index>, Index> number;
  for (Index e = 0; e < surface.edges().size(); ++e) {
    number[{surface.edges()[e].from, surface.edges()[e].to}] = e;
  }
  for (Index e = 0; e < exact.chains.size(); ++e) {
    std::vector<Index> chain = exact.chains[e];
    for (Index& v : chain) v = written[v];
    const auto& [from, to, left, right] = sidecar.final_surface().edges()[e];
    auto found = number.find({from, to});
    if (found == number.end()) {
      found = number.find({to, from});
      std::reverse(chain.begin(), chain.end());
    }
    if (found != number.end()) chains[found->second] = std::move(chain);
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

std::string Verification::check_sidecar() {
  const Shared::Sidecar& sidecar = shared_.sidecar();
  add(sidecar.report);
  if (!sidecar.usable) return sidecar.why;
  ulp_ = std::ldexp(1.0, std::ilogb(sidecar.surface.largest_coordinate()) - 52);
  diagonal_ = sidecar.diagonal;
  add(check_promise(options_.promised, *exact_, options_.record_version, diagonal_));
  if (!exact_->planes.empty() || !exact_->triangles.empty()) {
    add(check_stand_in(input_, *exact_, sidecar.surface));
  }
  add(check_facet_list(sidecar.surface));
  add(check_same_mesh(mesh_, *exact_, options_.promised, !input_.labels.empty()));
  add(check_rounding(mesh_, *exact_, sidecar.written(),
                     {.ulp = ulp_,
                      .allowed = options_.declared_deviation * diagonal_,
                      .input_vertices = static_cast<Index>(input_.vertices.size())}));
  return {};
}

// The facets of the record are those of the input, once each, with their triangles.
OracleReport Verification::check_facet_list(const InputSurface& surface) const {
  OracleReport report("facet-list", "facets");
  report.checked = surface.facets().size();
  if (const FacetIndex facets(surface, *exact_); !facets.defect().empty()) {
    report.fail(facets.defect());
  }
  return report;
}

std::string Verification::check_exact_final() {
  const Shared::Sidecar& sidecar = shared_.sidecar();
  if (!sidecar.usable) return {};
  const ExactPoints& points = sidecar.final_points();
  const InputSurface& surface = sidecar.final_surface();
  ulp_ = std::ldexp(1.0, std::ilogb(surface.largest_coordinate()) - 52);
  check_final_complex(points, surface);
  const bool usable = shared_.final()->shape.passed();
  shared_.forget_final();
  if (usable && !exact_->unrepaired.empty()) check_unrepaired();
#ifdef TETPROOF_SECOND_OPINIONS
  add(check_second_kernel(input_, surface, *exact_, points, options_.sidecar, sidecar.as_given),
      "exact-");
#endif
  return {};
}

void Verification::check_final_complex(const ExactPoints& points, const InputSurface& surface) {
  const std::shared_ptr<const Shared::Final> final = shared_.final();
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
  if (options_.promised.task == Task::cdt) {
    add(check_origins(*exact_, points, surface, static_cast<Index>(input_.vertices.size())));
  }
}

// The faces that the record puts on facets are those that tile them.
OracleReport Verification::check_facet_ids(const TetComplex& complex,
                                           const ConformityResult& conformity,
                                           const InputSurface& surface,
                                           const std::vector<FaceOnFacet>& listed) const {
  OracleReport report("facets", "faces");
  std::vector<std::pair<Face, Index>> facet_of;
  facet_of.reserve(conformity.faces.size());
  for (Index f = 0; f < conformity.faces.size(); ++f) {
    facet_of.emplace_back(conformity.faces[f], conformity.facets[f]);
    std::sort(facet_of.back().first.begin(), facet_of.back().first.end());
  }
  std::sort(facet_of.begin(), facet_of.end());
  std::vector<std::uint8_t> seen(facet_of.size());
  for (const auto& [a, b, c, id] : listed) {
    Face face = {a, b, c};
    std::sort(face.begin(), face.end());
    ++report.checked;
    const auto found =
        std::lower_bound(facet_of.begin(), facet_of.end(), std::pair(face, Index{0}));
    if (found == facet_of.end() || found->first != face) {
      report.fail(complex.face_name(face) + " is no boundary face of the solid");
    } else if (seen[found - facet_of.begin()]++ != 0) {
      report.fail(complex.face_name(face) + " is listed twice");
    } else if (found->second != kNone && surface.facets()[found->second].id != id) {
      report.fail(complex.face_name(face) + " is said to tile facet " + std::to_string(id) +
                  " but tiles " + std::to_string(surface.facets()[found->second].id));
    }
  }
  if (report.checked != facet_of.size()) report.fail("not every boundary face is listed once");
  return report;
}

// What was put back onto the surface as given has no tetrahedra outside if none were asked for.
void Verification::check_exact_hull(const TetComplex& complex, const Neighbours& neighbours) {
  const bool inside_alone = shared_.sidecar().as_given &&
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

// On edges of the surface as given that the surface which was refined does not have.
std::vector<Index> Verification::returned_vertices() const {
  const Shared::Sidecar& sidecar = shared_.sidecar();
  std::vector<Index> vertices;
  if (!sidecar.as_given) return vertices;
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
void Verification::check_constrained(const TetComplex& complex, const Neighbours& neighbours,
                                     const InputSurface& surface) {
  std::vector<Face> constraints;
  for (const auto& [a, b, c, id] : exact_->final_facets) constraints.push_back({a, b, c});
  const bool repaired = !exact_->unrepaired.empty();
  OracleReport delaunay =
      check_constrained_delaunay(complex, neighbours, surface, constraints, {.gate = !repaired});
  // Where nothing is demanded, a mesh all of whose faces are on the surface has nothing to count.
  if (!repaired || delaunay.checked > 0) add(std::move(delaunay), "exact-");
}

// A mesh of the surface that was refined.
void Verification::check_unrepaired() {
  const Shared::Sidecar& sidecar = shared_.sidecar();
  add(options_.promised.improve
          ? check_improvement(*exact_, sidecar.written(), options_.promised, returned_vertices())
          : check_repairs(*exact_, sidecar.written(), options_.promised));
  const TetComplex before = complex_of(exact_->unrepaired, sidecar.points);
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
  add(check_constrained_delaunay(before, neighbours, sidecar.surface, constraints), "unrepaired-");
}

std::string Verification::check_refined_complex() {
  if (!shared_.sidecar().usable) return {};
  const auto& [complex, neighbours, shape, places] = shared_.refined();
  add(shape, "refined-");
  if (!shape.passed()) return {};
  add(check_orientation(complex), "refined-");
  add(check_hull(complex, neighbours), "refined-");
  add(check_delaunay(complex, neighbours), "refined-");
  return {};
}

std::string Verification::check_refined_angles() {
  if (!shared_.sidecar().usable || !shared_.refined().shape.passed()) return {};
  const auto& [complex, neighbours, shape, places] = shared_.refined();
  add(check_angles(complex, neighbours, *places, delta(), scope()), "refined-");
  return {};
}

std::string Verification::check_refined_inside() {
  if (!shared_.sidecar().usable || !shared_.refined().shape.passed()) return {};
  add(check_contained(shared_.refined().complex, *shared_.refined().places), "refined-");
  return {};
}

std::string Verification::check_refined_promises() {
  if (!shared_.sidecar().usable || !shared_.refined().shape.passed()) return {};
  check_promises(shared_.refined_mesh());
  return {};
}

void Verification::check_promises(const RefinedMesh& mesh) {
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
  if (options_.promised.max_edge > 0) add(check_edges(*mesh.complex), "refined-");
  if (!options_.promised.approximate) add(check_enrichment(mesh));
}

// No edge of a tetrahedron of the region is longer than --max-edge.
OracleReport Verification::check_edges(const TetComplex& complex) const {
  OracleReport report("edges", "tetrahedra");
  const double most = options_.promised.max_edge * (1 + 1e-9);
  double longest = 0;
  for (std::size_t t = 0; t < complex.tetrahedra.size(); ++t) {
    if (complex.inside[t] == 0 && scope() == AngleScope::solid) continue;
    ++report.checked;
    const Tet& tet = complex.tetrahedra[t];
    double here = 0;
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < i; ++j) {
        here = std::max(here, exact::distance(*complex.points, tet[i], tet[j]));
      }
    }
    longest = std::max(longest, here);
    if (here > most) report.fail(complex.tet_name(t) + " has an edge above --max-edge");
  }
  report.figures.emplace_back("longest edge", longest);
  return report;
}

// A tetrahedron is called inside exactly if it is contained in the solid.
OracleReport Verification::check_contained(const TetComplex& complex, const Places& places) const {
  OracleReport contained("contained", "tetrahedra");
  std::uint64_t inside = 0;
  for (std::size_t t = 0; t < complex.tetrahedra.size(); ++t) {
    const bool within = places.of(t) == Place::inside;
    ++contained.checked;
    inside += complex.inside[t];
    if (within == (complex.inside[t] != 0)) continue;
    contained.fail(complex.tet_name(t) +
                   (within ? " is contained in the solid but is not called inside"
                           : " is called inside but is not contained in the solid"));
  }
  contained.figures.emplace_back("called inside", static_cast<double>(inside));
  return contained;
}

double Verification::delta() const {
  if (exact_ == nullptr) return options_.promised.delta;
  return std::max(options_.promised.guaranteed_delta(), exact_->parameters.delta);
}

AngleScope Verification::scope() const {
  return options_.promised.region == delmesher::Region::hull ? AngleScope::all : AngleScope::solid;
}

void conclude(double ulp, double diagonal, VerifyReport& report) {
  report.deviation_ulps = ulp > 0 ? report.deviation / ulp : 0;
  report.deviation_share = diagonal > 0 ? report.deviation / diagonal : 0;
  if (report.any_failed()) {
    report.verdict = Verdict::broken;
  } else if (!report.all_passed()) {
    report.verdict = Verdict::undecided;
  } else if (report.deviation == 0) {
    report.verdict = Verdict::exact;
  } else {
    report.verdict = report.deviation_ulps <= kRoundedUlps ? Verdict::rounded : Verdict::deviating;
  }
}

}  // namespace

std::string verify(const Polyhedron& input, const MeshFile& mesh, const ExactRecord* exact,
                   const VerifyOptions& options, VerifyReport& report) {
  report = {};
  Shared shared(input, exact, options.promised);
  const std::vector<Verification::Check> checks = Verification::checks(exact, options.stage);
  std::vector<Verification> parts(checks.size(), {input, mesh, exact, options, shared});
  std::vector<std::string> why(checks.size());
  std::atomic<bool> no_solid = false;
  run_tasks(options.threads, checks.size(), [&](std::size_t n) {
    if (no_solid) return;
    why[n] = (parts[n].*checks[n])();
    if (!why[n].empty()) no_solid = true;
  });
  for (const std::string& reason : why) {
    if (!reason.empty()) return reason;
  }
  double ulp = 0, diagonal = 0;
  for (Verification& part : parts) part.move_to(report, ulp, diagonal);
  conclude(ulp, diagonal, report);
  return {};
}

bool failed(const VerifyReport& report, const VerifyOptions& options) {
  // United facets may be planar within the promised bound. Without them only the declared deviation
  // is allowed.
  const double declared =
      report.slab > 0 ? std::max(options.declared_deviation, options.promised.planar_share())
                      : options.declared_deviation;
  return report.verdict == Verdict::broken ||
         (report.verdict == Verdict::deviating && report.deviation_share > declared);
}

}  // namespace tetproof::oracles
