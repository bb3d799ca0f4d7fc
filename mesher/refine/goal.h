// Decides whether a tetrahedron is bad (sections 5.4 and 5.7), and how bad.
#pragma once

#include <cstdint>

#include "mesher/geometry/size_field.h"
#include "mesher/predicates/points.h"

namespace delmesher::refine {

class Goal {
 public:
  // Face angles of at least `delta` degrees; no slivers, if asked; no edge longer than `max_edge`
  // unless that is 0, nor than `sizes` allow unless that is null or empty.
  Goal(double delta, bool slivers, double max_edge, const SizeField* sizes = nullptr);

  // Levels of badness grow with the squared radius-edge ratio, by a few per doubling.
  static constexpr std::uint8_t kWorst = 254;

  // 1 to kWorst, or 0 if the tetrahedron is not bad. Judged in doubles; in doubt about a face
  // angle a tetrahedron is bad, which costs at most a split.
  std::uint8_t badness(const PointStore& points, const VertexId* v) const;

  // Squared height, per squared base, of an isosceles triangle whose angle opposite its base is
  // delta.
  double offcentre2() const { return offcentre2_; }

 private:
  bool has_edge_above_sizes(const PointStore& points, const VertexId* v) const;

  double max_cosine_squared_;  // a face angle is too small if its squared cosine exceeds this
  bool slivers_;
  double max_edge_;
  const SizeField* sizes_;  // null: any
  double offcentre2_;
};

}  // namespace delmesher::refine
