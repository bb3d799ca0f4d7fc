#include "mesher/improve/state.h"

namespace delmesher::improve {

State::State(NumberedMesh numbered, const SurfaceTopology* surface, std::span<const Vec3> given,
             PointStore& points, Predicates& predicates, const Goals& goals)
    : ExactMesh(std::move(numbered), surface, given, goals.as_given, points, predicates),
      goals_(goals) {
  bound_edges(true);
  measure_by(Measure::shape);
  for (TetId t = 0; t < mesh.slots(); ++t) note(t);
}

void State::measure_by(Measure measure) {
  // Better than every value that counts, so that what is not measured is never the worst.
  constexpr float kIgnored = 1e30F;
  // However flat, tetrahedra are not to lose all of their volume.
  constexpr float kLeastGamma = 0.01F;
  measure_ = measure;
  target_ = goals_.target;
  per_target_ = {1 / target_.dihedral, 1 / target_.face, 1 / target_.gamma};
  least_score_ = least_gamma_ = 0;
  if (measure == Measure::shape) return;
  least_score_ = kMended;
  least_gamma_ = kLeastGamma;
  target_.gamma = 0;
  per_target_.gamma = kIgnored;
  target_.face = 0;
  per_target_.face = kIgnored;
}

void State::note(TetId t) {
  if (t >= quality_.size()) quality_.resize(mesh.slots());
  quality_[t] = counts(t) ? quality_of(mesh.tet(t)) : kNotCounted;
}

Quality State::worst_of(std::span<const TetId> tets) const {
  Quality worst = kNotCounted;
  for (const TetId t : tets) worst = worse(worst, quality_[t]);
  return worst;
}

void State::move(VertexId v, const Place& place, std::span<const TetId> star,
                 std::span<const Quality> quality) {
  put_at(v, place);
  for (std::size_t n = 0; n < star.size(); ++n) {
    quality_[star[n]] = quality[n];
    note_change(star[n]);
  }
}

}  // namespace delmesher::improve
