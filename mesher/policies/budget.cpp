#include "mesher/policies/budget.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "mesher/geometry/vector.h"
#include "mesher/refine/prediction.h"

namespace delmesher::policies {
namespace {

refine::PredictionOptions prediction_options(const Session& session) {
  return {.region = session.options.region,
          .max_edge = session.options.max_edge,
          .sizes = &session.sizes};
}

// How many triangles a triangle becomes if its edges are halved until they are as short as asked
// for: one for each such length along its longest edge and across it.
double pieces_of(const Vec3& a, const Vec3& b, const Vec3& c, const Session& session) {
  double most = session.options.max_edge > 0 ? session.options.max_edge : HUGE_VAL;
  if (!session.sizes.empty()) {
    most = std::min(most, session.sizes.at({(a[0] + b[0] + c[0]) / 3, (a[1] + b[1] + c[1]) / 3,
                                            (a[2] + b[2] + c[2]) / 3}));
  }
  const double along = std::max({distance(a, b), distance(b, c), distance(c, a)});
  const double across = norm(cross(subtract(b, a), subtract(c, a))) / along;
  return std::max(std::ceil(along / most), 1.0) * std::max(std::ceil(across / most), 1.0);
}

// With the surface kept, but for edges that are too long: on the 459 valid models of the collection
// 1.7 per triangle at the median; and as many as edges are to be short.
double kept_tetrahedra(const Session& session) {
  constexpr double kPerTriangle = 1.7;
  const SurfaceTopology& topology = session.surface.topology();
  double tetrahedra = 0;
  for (const auto& [a, b, c] : topology.triangles) {
    const auto at = [&](VertexId v) { return session.points.nearest(v); };
    tetrahedra += kPerTriangle * pieces_of(at(a), at(b), at(c), session);
  }
  if (session.bounds_edges()) {
    const std::vector<std::uint8_t> none(topology.facet_triangles.size(), 0);
    tetrahedra += refine::predict_tetrahedra({}, topology, none, session.points,
                                             prediction_options(session), session.control);
  }
  return tetrahedra;
}

// Every triangle that the filter drops comes back in the final step, with at least one tetrahedron.
double of_dropped(std::uint64_t triangles) {
  return static_cast<double>(triangles);
}

double predicted_tetrahedra(const chamfer::ChamferedSurface& surface, double enough,
                            const Session& session) {
  refine::PredictionOptions options = prediction_options(session);
  if (enough > 0) options.enough = enough;
  return of_dropped(surface.filter.dropped_triangles) +
         refine::predict_tetrahedra(surface.chamfer.plc, session.surface.topology(),
                                    surface.filter.facet_kept, session.points, options,
                                    session.control);
}

Stopped beyond(const std::string& why) {
  return {{StatusCode::limit_reached, why, Limit::budget}};
}

std::string about(double tetrahedra) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g", tetrahedra);
  return text;
}

std::string budget_text(std::uint64_t budget) {
  return "the budget of " + std::to_string(budget) + " tetrahedra";
}

}  // namespace

Budget::Budget(const Options& options)
    : is_automatic_(options.surface == SurfaceChoice::automatic),
      budget_(options.budget),
      tau_asked_(options.tau),
      tau_(is_automatic_ ? kFinestTau : tau_asked_) {
  if (budget_ > 0) want_at_most(static_cast<double>(budget_));
}

void Budget::want_at_most(double tetrahedra) {
  // Predictions are within a factor of 3 for nine models in ten, and of 8 for nearly all: what is
  // written is counted. Refined meshes have three vertices for four tetrahedra of the final one.
  constexpr double kFarBeyond = 3, kVertices = 0.75, kSurelyMore = 8;
  constexpr double kSoonMade = 1000;  // the input's own mesh may have fewer than the refined one
  const bool bounded = budget_ > 0;
  most_predicted_ = bounded ? kSurelyMore * tetrahedra + kSoonMade : tetrahedra;
  most_vertices_ = kFarBeyond * kVertices * tetrahedra + (bounded ? kSoonMade : 0);
}

// Of a surface that is not chamfered yet: nine tenths of what the kept facets take, and of seven
// tetrahedra for every corner beyond three at a vertex to be chamfered. On the 459 valid models of
// the collection the prediction with chamfers is at least 1.2 times this. With few such corners it
// would cost more than the chamfers, and is left out.
double Budget::least(chamfer::FilteredSurface& surface, const Session& session) const {
  constexpr double kShare = 0.9, kPerCorner = 7, kFew = 0.2;  // a triangle
  const SurfaceTopology& topology = session.surface.topology();
  const double corners = surface.crowded_corners();
  if (corners < kFew * static_cast<double>(topology.triangles.size())) return 0;
  const double others =
      of_dropped(surface.filter().dropped_triangles) + kShare * kPerCorner * corners;
  refine::PredictionOptions options = prediction_options(session);
  options.enough = (most_predicted_ - others) / kShare;
  return others + kShare * refine::predict_tetrahedra({}, topology, surface.filter().facet_kept,
                                                      session.points, options, session.control);
}

bool Budget::is_exceeded_at_least(chamfer::FilteredSurface& surface, const Session& session,
                                  Recorder& recorder) {
  if (is_automatic_ && most_predicted_ == 0) {
    constexpr double kTimes = 4, kSmall = 201;
    want_at_most(kTimes * kept_tetrahedra(session) + kSmall);
  }
  if (most_predicted_ == 0) return false;
  const bool is_whole = surface.filter().dropped_triangles == 0;
  const double taken = is_whole && least_of_whole_ ? *least_of_whole_ : least(surface, session);
  if (is_whole) least_of_whole_ = taken;
  if (taken <= most_predicted_) return false;
  predicted_ = taken;
  recorder.predicted(predicted_);
  return true;
}

void Budget::predict(chamfer::FilteredSurface& surface, const Session& session,
                     Recorder& recorder) {
  const chamfer::ChamferedSurface& chamfered = surface.finish();
  if (times_chamfered_ == surface.times_chamfered()) return;
  times_chamfered_ = surface.times_chamfered();
  predicted_ = predicted_tetrahedra(chamfered, most_predicted_, session);
  recorder.predicted(predicted_);
}

std::string Budget::excess() const {
  return budget_ > 0 ? "more than " + budget_text(budget_) : "too many tetrahedra";
}

void Budget::settle(Session& session) const {
  if (!is_kept()) throw beyond(excess() + " are predicted: about " + about(predicted_));
  session.control.predict(predicted_);
  bound(session);
}

void Budget::bound(Session& session) const {
  if (most_vertices_ == 0) return;
  session.control.allow(session.points.size() + static_cast<std::uint64_t>(most_vertices_),
                        beyond("the mesh takes " + excess()).status);
}

Status Budget::check(const Options& options, const Result& result) {
  const std::uint64_t made = result.mesh.tetrahedra.size();
  if (options.budget == 0 || made <= options.budget) return {};
  const bool may_be_coarser = options.tolerance == 0 && options.max_edge == 0 &&
                              options.size_field.empty() && !options.want_exact;
  return beyond("the mesh has " + std::to_string(made) + " tetrahedra, more than " +
                budget_text(options.budget) +
                (may_be_coarser ? "; with --tolerance there are fewer" : ""))
      .status;
}

}  // namespace delmesher::policies
