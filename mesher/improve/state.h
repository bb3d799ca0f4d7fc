// The state that all operations of the improvement share: the mesh, the quality of its tetrahedra,
// and the quality that a change has to reach.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "mesher/improve/goals.h"
#include "mesher/improve/quality.h"
#include "mesher/tetmesh/exact_mesh.h"

namespace delmesher::improve {

// False if it is zero.
inline bool to_unit_length(Vec3& x) {
  const double length = norm(x);
  for (double& k : x) k /= length;
  return length > 0;
}

// The part of an offset that keeps a vertex where it belongs. `axis`: the unit normal of its facet,
// or the direction of its edge.
inline Vec3 allowed_offset(Mobility mobility, const Vec3& axis, const Vec3& offset) {
  if (mobility == Mobility::free) return offset;
  const double along = dot(offset, axis);
  if (mobility == Mobility::in_plane) return add_scaled(offset, -along, axis);
  return {along * axis[0], along * axis[1], along * axis[2]};
}

// What the score of a tetrahedron tells: how near the worst of these is to its target.
enum class Measure : std::uint8_t {
  shape,     // dihedral angles, face angles and gamma
  dihedrals  // dihedral angles alone
};

// Laws:
//  - Tetrahedra that count, made by a change, have no dihedral angle flatter than the floor and no
//    face angle below the promise, unless the replaced ones had one as bad. So neither the flattest
//    dihedral nor the smallest face angle of a mesh that misses them becomes worse.
//  - All tetrahedra that a change makes are positive (PlacedMesh).
class State final : public ExactMesh {
 public:
  // Arguments as of ExactMesh.
  State(NumberedMesh numbered, const SurfaceTopology* surface, std::span<const Vec3> given,
        PointStore& points, Predicates& predicates, const Goals& goals);

  bool counts_in(RegionId region) const { return region != kOutside || goals_.everywhere; }
  bool counts(TetId t) const { return counts_in(mesh.region(t)); }
  // The quality of a tetrahedron of the mesh; kNotCounted if it does not count.
  const Quality& quality(TetId t) const { return quality_[t]; }
  // Of any four vertices, or of t with its i-th vertex at x; incomplete if below `least`.
  Quality quality_of(const Tet& t, const Quality& least = {}) const {
    return improve::quality(position_[t[0]], position_[t[1]], position_[t[2]], position_[t[3]],
                            least);
  }
  Quality quality_with(const Tet& t, int i, const Vec3& x, const Quality& least = {}) const {
    const auto at = [&](int k) -> const Vec3& { return k == i ? x : position_[t[k]]; };
    return improve::quality(at(0), at(1), at(2), at(3), least);
  }
  Quality worst_of(std::span<const TetId> tets) const;
  // Of face i of t, as long as twice its area.
  Vec3 face_normal(TetId t, int i) const {
    const auto at = [&](int k) -> const Vec3& { return position(mesh.tet(t)[kFace[i][k]]); };
    return cross(subtract(at(1), at(0)), subtract(at(2), at(0)));
  }

  // By the worst of what is measured: 1 and more is good enough.
  float score(const Quality& q) const {
    return std::min(std::min(q.dihedral * per_target_.dihedral, q.face * per_target_.face),
                    q.gamma * per_target_.gamma);
  }
  // What is not measured by its shape is mended with this score: a dihedral angle of 12.2 degrees.
  static constexpr float kMended = 0.32F;
  // From now on scores tell of this. If it is not the shape, all that a change makes is mended: a
  // mesh is not to get many tetrahedra that are bad instead of one that is worse.
  void measure_by(Measure measure);
  Measure measures() const { return measure_; }
  // Fineness of the grid of new points, in the shortest edge where they go.
  static constexpr double kGrid = 1.0 / 1024;
  // Below this score it is worth trying hard.
  static constexpr float kBad = 0.4F;
  bool good(const Quality& q) const { return score(q) >= 1; }
  float score(TetId t) const { return score(quality_[t]); }
  // By its dihedral angles alone, whatever is measured.
  float dihedral_score(TetId t) const { return quality_[t].dihedral / goals_.target.dihedral; }
  // By its face angles alone, if they are measured.
  float face_score(TetId t) const { return quality_[t].face * per_target_.face; }

  // The quality that a change has to reach if it replaces tetrahedra as bad as `before`: better
  // than they are; or, where something else is gained, nearly good or as good as they are.
  Quality to_be_better(const Quality& before) const {
    const float now = score(before);
    return at_least(std::max(least_score_, (now < kBad ? kLeastGain : kGain) * now), before);
  }
  Quality to_be_acceptable(const Quality& before) const {
    return at_least(std::max(least_score_, std::min(goals_.nearly_good, score(before))), before);
  }
  // The least quality with this score.
  Quality to_reach(float score) const {
    return {score * target_.dihedral, score * target_.face, score * target_.gamma};
  }
  static bool reaches(const Quality& q, const Quality& least) {
    return q.dihedral >= least.dihedral && q.face >= least.face && q.gamma >= least.gamma;
  }

  // Below face i of t, seen from outside: where a vertex makes a nearly regular tetrahedron of it.
  Vec3 best_apex_below(TetId t, int i) const {
    const Tet& v = mesh.tet(t);
    return best_apex(position_[v[kFace[i][0]]], position_[v[kFace[i][1]]],
                     position_[v[kFace[i][2]]]);
  }
  // Is an edge between these longer than wanted, in tetrahedra of the region? Edges that exist may
  // stay, and those that the input has come back however long they are.
  void bound_edges(bool bound) { edges_are_bounded_ = bound && goals_.bounds_edges(); }
  bool edges_are_bounded() const { return edges_are_bounded_; }
  bool too_long(const Vec3& x, const Vec3& y, RegionId region) const {
    if (!edges_are_bounded_) return false;
    const double longest = goals_.max_edge_in(region);
    return (longest > 0 && squared_norm(subtract(y, x)) > longest * longest) ||
           (goals_.sizes != nullptr && goals_.sizes->is_too_long(x, y));
  }

  using ExactMesh::move;
  // `quality`: of the star, with v there.
  void move(VertexId v, const Place& place, std::span<const TetId> star,
            std::span<const Quality> quality);

 private:
  // A change has to be worth it: many small steps cost time and bring little. Only bad tetrahedra
  // may become better by small steps.
  static constexpr float kGain = 1.1F, kLeastGain = 1.01F;

  Quality at_least(float score, const Quality& before) const {
    return {std::max(score * target_.dihedral, std::min(goals_.floor, before.dihedral)),
            std::max(score * target_.face, std::min(goals_.promised, before.face)),
            std::max(score * target_.gamma, std::min(least_gamma_, before.gamma))};
  }
  void note(TetId t) override;

  Goals goals_;
  bool edges_are_bounded_ = false;
  Measure measure_ = Measure::shape;
  Quality target_, per_target_;              // of what is measured
  float least_score_ = 0, least_gamma_ = 0;  // of what a change makes
  std::vector<Quality> quality_;             // per slot
};

}  // namespace delmesher::improve
