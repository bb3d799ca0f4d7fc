// The state that all operations of the improvement share: the mesh, the places and the mobility of
// its vertices, the quality of its tetrahedra, and the rule by which a change is accepted.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "mesher/improve/goals.h"
#include "mesher/improve/quality.h"
#include "mesher/predicates/predicates.h"
#include "mesher/surface/facet_locator.h"
#include "mesher/surface/topology.h"
#include "mesher/tetmesh/mesh_topology.h"
#include "mesher/tetmesh/mobility.h"

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

// Where a vertex is or could be: a point of the store, and as it will be written, before repairs of
// rounding.
struct Place {
  VertexId point;
  Vec3 position;
};

// Laws:
//  - Tetrahedra that count, made by a change, have no dihedral angle flatter than the floor and no
//    face angle below the promise, unless the replaced ones had one as bad. So neither the flattest
//    dihedral nor the smallest face angle of a mesh that misses them becomes worse.
//  - All tetrahedra that a change makes are positive, on exact coordinates and as doubles; of a
//    stand-in that is to go back also on exact coordinates with the vertices as given.
class State {
 public:
  // `point`: of each vertex, in the store. `topology`: of the surface; null if no vertex of it may
  // move. `given`: its vertices as given, where it is a stand-in; else empty. Arguments passed by
  // reference or pointer must outlive the state.
  State(MeshTopology tetrahedra, std::vector<VertexId> point, const SurfaceTopology* topology,
        std::span<const Vec3> given, PointStore& points, Predicates& predicates,
        const Goals& goals);

  MeshTopology mesh;

  const PointStore& points() const { return points_; }
  VertexId point(VertexId v) const { return point_[v]; }
  std::span<const VertexId> point_of_vertices() const { return point_; }
  const Vec3& position(VertexId v) const { return position_[v]; }
  Mobility mobility(VertexId v) const { return mobility_[v]; }

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
    return std::min({q.dihedral * per_target_.dihedral, q.face * per_target_.face,
                     q.gamma * per_target_.gamma});
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
    return at_least(std::max(least_score_, std::min(kNearlyGood, score(before))), before);
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
  // Exactly positive, and as doubles; of any four vertices, or of t with its i-th vertex elsewhere.
  bool is_positive(const Tet& t);
  bool is_positive_with(const Tet& t, int i, const Place& place);

  // Is an edge between these longer than wanted? Edges that exist may stay.
  bool too_long(const Vec3& x, const Vec3& y) const {
    return (goals_.max_edge > 0 &&
            squared_norm(subtract(y, x)) > goals_.max_edge * goals_.max_edge) ||
           (goals_.sizes != nullptr && goals_.sizes->is_too_long(x, y));
  }

  // --- changes
  // Makes the change if all that it creates is positive.
  bool accept(const Change& change);
  void replace(std::span<const TetId> removed, std::span<const CreatedTet> created,
               std::span<const SurfaceFace> faces);
  void contract(VertexId v, VertexId w, std::span<const TetId> star);
  // Where v goes if it moves by `offset`, within about `tolerance`; and any place in the volume.
  // The point is the last of the store, until it is forgotten, v is moved to it, or it becomes a
  // vertex whose star replaces tetrahedra.
  Place moved(VertexId v, const Vec3& offset, double tolerance);
  Place new_place(const Vec3& x, double tolerance);
  void forget(const Place& place);
  void move(VertexId v, const Place& place, std::span<const TetId> star);
  // `quality`: of the star, with v there.
  void move(VertexId v, const Place& place, std::span<const TetId> star,
            std::span<const Quality> quality);
  // `created` has kNone where the new vertex is.
  void insert(const Place& place, std::span<const TetId> removed, std::span<CreatedTet> created);

  // For points of facets that come to lie on an edge of the surface, which is straight: where they
  // go, near x; then v goes there, or it becomes a new vertex (kNone in `created` and `faces`).
  Place place_on_edge(const std::array<VertexId, 2>& end, const Vec3& x, double tolerance);
  void move_to_edge(VertexId v, const Place& place, std::span<const TetId> star);
  void insert_on_edge(const Place& place, std::span<const TetId> removed,
                      std::span<CreatedTet> created, std::span<SurfaceFace> faces);
  // Places for new vertices near x, in a facet and on an edge of the surface. Without a topology
  // there are none.
  bool has_places_on_surface() const { return topology_ != nullptr; }
  Place place_in_facet(FacetId facet, const Vec3& x, double tolerance);
  Place place_on_input_edge(std::uint32_t edge, const Vec3& x, double tolerance);
  // The edge of the surface that the edge a-b between two of its facets is a piece of; kNone where
  // its points are given by two parameters.
  std::uint32_t input_edge_of(VertexId a, VertexId b) const;
  // The new vertex is in this facet, or on an edge of it. `faces`: those at it, on the surface.
  void insert_on_surface(const Place& place, Mobility mobility, FacetId facet,
                         std::span<const TetId> removed, std::span<CreatedTet> created,
                         std::span<SurfaceFace> faces);
  // A place near v within the plane of a triangle of its facet.
  Place place_in_triangle(VertexId v, const std::array<VertexId, 3>& corners, double tolerance);

  // Counts changes.
  std::uint32_t clock() const { return clock_; }
  // When a tetrahedron at v last changed.
  std::uint32_t changed_at(VertexId v) const { return changed_at_[v]; }

  // How many vertices there are more than at the beginning.
  std::int64_t vertices_gained() const { return gained_; }

 private:
  // A change has to be worth it: many small steps cost time and bring little. Only bad tetrahedra
  // may become better by small steps.
  static constexpr float kNearlyGood = 0.6F;
  static constexpr float kGain = 1.1F, kLeastGain = 1.01F;

  Quality at_least(float score, const Quality& before) const {
    return {std::max(score * target_.dihedral, std::min(goals_.floor, before.dihedral)),
            std::max(score * target_.face, std::min(goals_.promised, before.face)),
            std::max(score * target_.gamma, std::min(least_gamma_, before.gamma))};
  }
  // The points with the vertices of the surface as given, by the same numbers.
  struct GivenPoints {
    PointStore points;
    Predicates predicates{points};
  };

  void find_mobility();
  void put_in(const Place& place, Mobility mobility, FacetId facet, std::span<const TetId> removed,
              std::span<CreatedTet> created, std::span<SurfaceFace> faces);
  Place place_of(const PointDefinition& d, std::span<const PlaneId> planes,
                 std::span<const std::uint32_t> lines);
  VertexId add_vertex(const Place& place, Mobility mobility, FacetId facet);
  void put_at(VertexId v, const Place& place);
  void measure(TetId t);
  void note(TetId t);
  void note_change(TetId t);

  PointStore& points_;
  Predicates& predicates_;
  const SurfaceTopology* topology_;
  std::span<const Vec3> given_;
  std::unique_ptr<GivenPoints> as_given_;  // null: nobody asks
  Goals goals_;
  Measure measure_ = Measure::shape;
  Quality target_, per_target_;              // of what is measured
  float least_score_ = 0, least_gamma_ = 0;  // of what a change makes
  std::size_t first_new_;                    // point of the store
  std::optional<FacetLocator> locator_;
  // Per vertex.
  std::vector<VertexId> point_;
  std::vector<Vec3> position_;
  std::vector<Mobility> mobility_;
  std::vector<FacetId> facet_;  // if in_plane
  std::vector<std::uint32_t> changed_at_;
  std::vector<Quality> quality_;  // per slot
  std::vector<VertexId> swallowed_;
  std::uint32_t clock_ = 0;
  std::int64_t gained_ = 0;
};

}  // namespace delmesher::improve
