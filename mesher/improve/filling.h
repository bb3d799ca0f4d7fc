// Puts points into the volume and leaves every face and edge of the surface alone: constrained
// Delaunay refinement (Shewchuk 1998) without its splits of segments and facets.
//
// Every vertex has a size, the edge length wanted there: on the surface the mean length of its
// edges on the surface, for a new point the least that the vertices of its cavity allow, which
// grows with the distance from them; and never more than kOfLongest of the longest edge asked for.
// A tetrahedron is too large if its circumradius exceeds the mean size of its vertices. The largest
// by that ratio gets a point first, at its circumcentre.
//
// Laws:
//  - Faces on the surface and all vertices stay.
//  - A new point has kClearance sizes to the vertices of its cavity, and kFacetClearance to the
//    faces of the surface on its skin. Where that leaves no place there is no point.
//  - All tetrahedra stay positive (state.h).
//
// It ends: by the first clearance points could be packed only so densely if all cavities were those
// of a constrained Delaunay tetrahedrization. They are not quite, since improvement has been there
// before, so that the number of points is bounded as well: kMostPoints for each tetrahedron and for
// each cube of the size in its volume.
#pragma once

#include <cstddef>
#include <cstdint>
#include <queue>
#include <span>
#include <tuple>
#include <vector>

#include "mesher/base/control.h"
#include "mesher/improve/state.h"
#include "mesher/tetmesh/insert_point.h"

namespace delmesher::improve {

class Filling {
 public:
  // `goals`: edges inside are to be no longer than these allow.
  Filling(State& state, const Goals& goals, Control& control);

  // Until no tetrahedron that counts is too large, or only such as have no place for a point.
  void run();

 private:
  struct Candidate {
    double ratio;  // squared: of the circumradius to the size
    TetId tet;
    std::uint32_t version;
    bool operator<(const Candidate& o) const {
      return std::tie(ratio, o.tet) < std::tie(o.ratio, tet);
    }
  };
  struct Circumcentre {
    Vec3 from_first;            // vertex
    double squared_radius = 0;  // 0 where the tetrahedron is flat
  };

  // The whole skin is looked at for all that counts.
  struct Judge {
    using Value = bool;
    static bool in_plane() { return true; }
    static bool value_of(TetId, int) { return true; }
  };

  void find_sizes();
  void bound_points();
  // What max_edge, and what the size field besides, allow in a region.
  double allowed_in(RegionId region) const;
  double allowed_at(const Vec3& x, RegionId region) const;
  double mean_size(TetId t) const;
  Circumcentre circumcentre(TetId t) const;
  void note(TetId t);
  TetId locate(TetId t, const Vec3& x) const;
  bool is_in_ball(TetId t, const Vec3& x) const;
  bool insert(TetId start, const Vec3& x);
  template <class Belongs>
  void collect(TetId start, const Belongs& belongs);
  void grow(TetId start, const Vec3& x);
  bool cut_back(TetId start, const Vec3& x);
  bool sees(TetId t, int i, const Vec3& x) const;
  double size_at(std::span<const TetId> cavity, const Vec3& x) const;
  bool has_room(std::span<const TetId> cavity, const Vec3& x, double size) const;

  State& state_;
  const Goals& goals_;
  Control& control_;
  double most_points_ = 0;
  std::vector<double> size_;            // per vertex
  std::vector<std::uint32_t> version_;  // per slot: counts the tetrahedra that were there
  std::vector<Circumcentre> ball_;      // per slot: of the tetrahedron there, since note()
  std::priority_queue<Candidate> queue_;
  InsertPoint<Judge> operation_;
  std::vector<TetId> cavity_, work_;
  std::vector<std::uint32_t> asked_;  // per slot: asked_epoch_ if collect() has
  std::uint32_t asked_epoch_ = 0;
  std::vector<std::uint32_t> mark_;  // per slot: epoch_ if cut_back() has left it
  std::uint32_t epoch_ = 0;
};

}  // namespace delmesher::improve
