// The pieces of a planar graph by heights, and there from left to right, so that a ray need not
// look at all that it crosses: ranges of heights as a binary tree, each piece in the few that it
// fills.
#pragma once

#include <span>
#include <vector>

#include "oracles/plane/points.h"

namespace tetproof {

class PlaneSlabs {
 public:
  using Index = PlanePoints::Index;
  using Point = PlanePoints::Point;
  struct Piece {
    Index a, b;  // ends, whose coordinates are doubles
  };

  // The points must outlive this. Pieces may cross, but then a ray looks at more of them.
  PlaneSlabs(PlanePoints& points, std::vector<Piece> pieces);

  // Calls meet(pieces) with those that the ray to the right of p crosses, each in one of the calls
  // and from left to right in it. The ray is above the point by less than anything.
  template <class Meet>
  void right_of(const Point& p, Meet&& meet) {
    for (std::size_t at = leaf_of(p); at > 0; at /= 2) {
      const std::span<const Index> all = slabs_[at].pieces;
      if (slabs_[at].in_order) {
        const std::size_t first = first_right_of(all, p);
        if (first < all.size()) meet(all.subspan(first));
        continue;
      }
      for (std::size_t k = 0; k < all.size(); ++k) {
        if (is_right_of(all[k], p)) meet(all.subspan(k, 1));
      }
    }
  }

 private:
  struct Slab {
    std::vector<Index> pieces;
    bool in_order = true;  // else some cross in it
  };

  const Point& point(Index v) const { return points_.all()[v]; }
  void add(Index piece);
  void sort(std::size_t at);
  std::pair<double, double> near(const Piece& piece, double height) const;
  int compare(const Piece& s, const Piece& t, double height) const;
  std::size_t leaf_of(const Point& p) const;
  std::size_t first_right_of(std::span<const Index> pieces, const Point& p);
  bool is_right_of(Index piece, const Point& p);

  PlanePoints& points_;
  std::vector<Piece> pieces_;    // b is higher than a, or level with it
  std::vector<double> heights_;  // of all ends, rising
  std::vector<Slab> slabs_;      // the tree's: 2 n and 2 n + 1 are the halves of n, from 1 on
};

}  // namespace tetproof
