// The planes of planar groups: which groups share one, and which planes meet at a vertex
// (planarized_surface.h says what for).
#pragma once

#include <cstdint>
#include <vector>

#include "mesher/base/control.h"
#include "mesher/planar/planar_growth.h"
#include "mesher/predicates/points.h"

namespace delmesher::planar {

// Is the point on the plane exactly?
bool exactly_on(const PlaneEquation& plane, const Vec3& p);
// The plane in doubles.
Fit rough(const PlaneEquation& plane);

// Call fit(), share(), spread_moves() and relieve_vertices() in this order. If the last one says
// that groups have lost triangles, all must be done again; the same after let_go() and after
// PlanarGrowth::detach().
class GroupPlanes {
 public:
  GroupPlanes(MeasuredSurface& surface, PlanarGrowth& growth, Control& control)
      : surface_(surface), growth_(growth), control_(control) {}

  // The plane that fits the triangles of each group, which loses those that are too far from it.
  // False if no vertex has to move for any of them.
  bool fit();
  // Groups that meet at a vertex in planes that are the same within the noise share one of them,
  // the larger group's.
  void share();
  // A planar group one of whose vertices moves has to move with it. True if there was one.
  bool spread_moves();
  // A vertex can be the meeting point of three planes. One of more stays where it is, and the
  // planes are moved so that they contain it, which each can for up to three vertices; where not
  // all can, groups give up their triangles at the vertex until it has three planes. True if some
  // have.
  bool relieve_vertices();
  // A vertex that finds no place on its planes. The triangles at it that are in groups of the plane
  // with the least area there have to leave them, with let_go(). False if there is no group.
  bool release(VertexId v);
  // The same until no plane is left at v. True if there was one.
  bool release_all(VertexId v);
  // For all such vertices together: a group at some of them that was grown across a bend, say, is
  // taken apart if there are far fewer pieces than triangles that it spares. Where no group is, the
  // triangles leave.
  void let_go();

  // A group by the number of the group whose plane it shares.
  std::uint32_t plane_of(std::uint32_t group) const { return plane_of_[group]; }
  const std::vector<std::uint32_t>& planes_at(VertexId v) const { return planes_at_[v]; }
  const PlaneEquation& plane(std::uint32_t group) const { return planes_[group].plane; }
  // Do vertices move to the plane that the group shares?
  bool moving(std::uint32_t group) const {
    return planes_[plane_of_[group]].lent_state == State::moving;
  }
  // Is the vertex off the plane of one of its groups that move?
  bool must_move(VertexId v) const;

 private:
  // on_plane: all vertices are on the plane exactly. planar: they are in one plane exactly, whose
  // equation doubles cannot hold; the group becomes moving if one of its vertices moves for
  // another. In the order of how much moves.
  enum class State : std::uint8_t { on_plane, planar, moving };
  struct Plane {
    PlaneEquation fitted{};      // of the group's triangles alone
    PlaneEquation plane{};       // and moved so that it contains the pins of its vertices
    std::vector<VertexId> pins;  // if the group lends its plane: vertices that stay and are on it
    double area = 0;             // twice that of the triangles
    std::size_t fitted_to = 0;   // so many triangles: groups only lose them
    State state = State::on_plane;       // of the group in its own plane
    State lent_state = State::on_plane;  // if the group lends its plane: of all that share it
  };

  void fit(std::uint32_t group);
  PlaneEquation meant_plane(const Fit& fit, std::uint32_t group,
                            const std::vector<VertexId>& list) const;
  bool all_on(const PlaneEquation& plane, const std::vector<VertexId>& list) const;
  bool in_one_plane(std::uint32_t group, const std::vector<VertexId>& list) const;
  std::uint32_t largest_triangle(std::uint32_t group) const;
  void find_lent_states();
  bool one_plane(std::uint32_t g, std::uint32_t h) const;
  bool pin_all(VertexId v, const std::vector<std::vector<std::uint32_t>>& sharing);
  void make_room(const std::vector<VertexId>& stuck);
  bool pin(VertexId v, std::uint32_t g, const std::vector<std::uint32_t>& sharing);
  PlaneEquation pinned_plane(const Plane& plane) const;
  bool release(VertexId v, std::uint32_t plane);
  bool detach_at(VertexId v, std::uint32_t plane);
  std::vector<std::uint32_t> triangles_at(VertexId v, std::uint32_t plane);

  MeasuredSurface& surface_;
  PlanarGrowth& growth_;
  Control& control_;
  std::vector<Plane> planes_;                          // per group
  std::vector<std::uint32_t> plane_of_;                // group -> the one whose plane it shares
  std::vector<std::vector<std::uint32_t>> planes_at_;  // vertex -> planes, as such groups

  // What let_go() is about.
  struct Departure {
    std::vector<std::uint32_t> triangles;  // at a vertex
    std::vector<std::uint32_t> groups;     // at it, theirs and others
  };
  std::vector<Departure> departures_;
};

}  // namespace delmesher::planar
