// Edge-connected sets of triangles that are planar within a noise bound: how they grow, and how
// they are taken apart (planarized_surface.h says what for).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mesher/base/control.h"
#include "mesher/delmesher/surface.h"
#include "mesher/geometry/vector.h"
#include "mesher/predicates/points.h"

namespace delmesher::planar {

int largest_axis(const Vec3& v);

// A plane in doubles, the largest component of its normal being 1 or -1.
struct Fit {
  Vec3 normal{0, 0, 0};
  Vec3 through{0, 0, 0};

  double height(const Vec3& p) const { return dot(normal, subtract(p, through)) / norm(normal); }
};

// The plane of a growing set of triangles. Its normal is the sum of area vectors, whose error does
// not grow with the length of a narrow group: the noise of a long edge adds an error that is
// perpendicular to that edge. Sums are compensated: of thousands of triangles, rounding would move
// the plane by more than the noise.
class PlaneFit {
 public:
  explicit PlaneFit(const std::vector<Vec3>& vertices) : vertices_(&vertices) {}

  void add(const std::array<std::uint32_t, 3>& triangle);
  void add(const PlaneFit& other);  // its triangles
  Fit fit() const;

 private:
  struct Sum {
    double high = 0, low = 0;

    void add(double x);
  };

  const std::vector<Vec3>* vertices_;
  std::array<Sum, 3> area_, moment_;
  Vec3 origin_{0, 0, 0};
  double weight_ = 0;
  std::uint64_t count_ = 0;
};

// The triangles of a closed manifold surface, their neighbours and sizes. A half-edge 3 t + k goes
// from corner k of triangle t to the next.
class MeasuredSurface {
 public:
  explicit MeasuredSurface(const Surface& surface);

  const std::vector<Vec3>& vertices() const { return surface_.vertices; }
  const std::vector<std::array<std::uint32_t, 3>>& triangles() const { return surface_.triangles; }
  std::int32_t label(std::uint32_t t) const {
    return t < surface_.labels.size() ? surface_.labels[t] : 0;
  }
  // Per half-edge, the one in the other direction.
  const std::vector<std::uint32_t>& opposite() const { return opposite_; }
  const Vec3& area(std::uint32_t t) const { return area_[t]; }  // twice the area vector
  double size(std::uint32_t t) const { return size_[t]; }       // its length
  // The corner of the half-edge's triangle that it does not touch.
  VertexId across(std::uint32_t h) const { return surface_.triangles[h / 3][(h % 3 + 2) % 3]; }
  std::uint32_t longest_edge(std::uint32_t t) const;  // a half-edge
  double edge_length(std::uint32_t h) const;
  // Is the corner across the half-edge's edge no farther than `most` from the plane of the larger
  // of its two triangles, which are not folded upon one another?
  bool bends_by_less(std::uint32_t h, double most) const;
  std::span<const std::uint32_t> triangles_at(VertexId v);

 private:
  const Surface& surface_;
  std::vector<std::uint32_t> opposite_;
  std::vector<Vec3> area_;
  std::vector<double> size_;
  std::vector<std::size_t> begin_;  // vertex -> range of around_; empty until somebody asks
  std::vector<std::uint32_t> around_;
};

// Laws: a triangle is in one group at most, and a group's triangles have one label and ascend; when
// it has grown, all its vertices are within its noise of the plane that fits it. Groups keep their
// numbers; one that was taken apart is empty.
class PlanarGrowth {
 public:
  struct Group {
    std::vector<std::uint32_t> triangles;
    double noise = 0;                 // bound on the distances of its vertices from the plane
    std::vector<std::uint32_t> left;  // triangles that were in it, and are in none
  };

  // No bound is smaller than `finest`.
  PlanarGrowth(const MeasuredSurface& surface, double noise, double finest, Control& control);

  // Is there an edge between triangles that are coplanar within the noise, but not exactly? Most
  // surfaces have none, and nothing to be done.
  bool any_nearly_flat() const;
  void grow_all();
  // A group stops where the plane of its first triangles ends, which is off by the noise, and so
  // one flat face may be that of two groups. Neighbours that lie in one plane become one group.
  void merge_neighbours();
  // Into groups of a smaller bound, together with the triangles that have left it, if these are
  // fewer than `fewer_than`. False, and nothing changes, if they are not, or if its bound is the
  // smallest already.
  bool take_apart(std::uint32_t group, std::size_t fewer_than);
  // Takes a triangle out of its group: it is a facet of its own from now on.
  void detach(std::uint32_t triangle);

  const std::vector<Group>& groups() const { return groups_; }
  std::uint32_t group_of(std::uint32_t triangle) const { return group_of_[triangle]; }
  // Has the group more than one triangle?
  bool is_group(std::uint32_t g) const { return g != kNone && groups_[g].triangles.size() > 1; }
  std::vector<VertexId> vertices_of(std::uint32_t group) const;  // ascending
  bool within(std::uint32_t triangle, const Fit& fit, double noise) const;

 private:
  class Growing;
  class Merging;

  void grow_from(std::vector<std::uint32_t> seeds, double noise);
  void grow(std::uint32_t seed, double noise);
  void hand_over_needles();
  void remove(std::uint32_t triangle);
  bool fits(std::uint32_t triangle, const Fit& fit, double noise) const;

  const MeasuredSurface& surface_;
  const double noise_, finest_;
  Control& control_;
  std::vector<std::uint8_t> open_;  // triangles that a growing group may take
  std::vector<std::uint32_t> group_of_;
  std::vector<Group> groups_;
};

}  // namespace delmesher::planar
