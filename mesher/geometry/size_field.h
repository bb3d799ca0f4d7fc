// How long edges may be, from place to place.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "mesher/delmesher/size_source.h"
#include "mesher/geometry/box_tree.h"

namespace delmesher::geometry {

// At x an edge may be as long as the smallest of size + growth |x - point| over all sources.
// Laws:
//  - The field is as flat as the growth says: of two places, one allows at most growth times their
//    distance more. So sizes that were asked for hold around their points, not only there.
//  - The answers do not depend on the order of the sources.
class SizeField {
 public:
  SizeField() = default;
  SizeField(std::span<const SizeSource> sources, double growth);

  bool empty() const { return sources_.empty(); }
  // What the field is at x; infinite if there is no source.
  double at(const Vec3& x) const;
  // Is the edge longer than the field is at one of its points? Decided in doubles.
  bool is_too_long(const Vec3& a, const Vec3& b) const;

 private:
  // A range of sources. Those of `first` to the middle are in the next node, the others in that
  // with the number `other`; 0: it has no parts.
  struct Node {
    Box box;
    double size = std::numeric_limits<double>::infinity();  // the smallest
    std::uint32_t first = 0, end = 0, other = 0;
  };

  std::uint32_t build(std::uint32_t first, std::uint32_t end);
  // Calls visit(source) where the box and the sizes of a node allow less than `bound` near the
  // `place`; a visit may lower the bound, and ends the search with true.
  template <class Visit>
  bool search(const Box& place, const double& bound, Visit visit) const;

  std::vector<SizeSource> sources_;
  std::vector<Node> nodes_;
  double growth_ = 0;
};

}  // namespace delmesher::geometry
