// Triangles of a polygon in the plane without holes.
#pragma once

#include <queue>
#include <tuple>

#include "mesher/base/polling.h"
#include "mesher/geometry/projected_face.h"

namespace delmesher::geometry {

using Triangle = std::array<std::uint32_t, 3>;

// Clips the ears of one counter-clockwise, (weakly) simple polygon, shortest diagonal first.
//
// Every clipped triangle is strictly positive. So if the polygon is simple they cannot overlap:
// their indicator functions add up to the polygon's winding number, which is 0 or 1.
//
// Invariants between two clippings:
//  - the corners that are alive form one ring by `previous_` and `next_`, left_ of them;
//  - convex_ of a corner that is alive says whether it turns left, strictly;
//  - a corner that is alive has an entry of its present version in ears_ if and only if it was an
//    ear when it was last examined: at the start, or when a neighbour was clipped. Entries of other
//    versions, and of corners that are gone, are passed over;
//  - only corners of blunt_ that are alive and not convex can block an ear of a simple polygon.
class EarClipper {
 public:
  EarClipper(const std::vector<Point2>& points, const Loop& loop, Polling& polling)
      : points_(points), loop_(loop), polling_(polling) {}

  // False if it got stuck, with the rest of the polygon clipped regardless.
  bool run(std::vector<Triangle>& triangles);

 private:
  struct Ear {
    double diagonal;  // squared length
    std::size_t corner;
    std::uint32_t version;
    bool operator<(const Ear& other) const {  // the shortest diagonal on top of the queue
      return std::tie(other.diagonal, other.corner) < std::tie(diagonal, corner);
    }
  };

  const Point2& at(std::size_t corner) const { return points_[loop_[corner]]; }
  int turn(std::size_t corner) const;
  void sort_blunt();
  bool is_ear(std::size_t corner) const;
  void examine(std::size_t corner);
  void clip(std::size_t corner, std::vector<Triangle>& triangles);

  const std::vector<Point2>& points_;
  const Loop& loop_;
  Polling& polling_;
  std::vector<std::size_t> previous_, next_;
  std::vector<std::uint32_t> version_;
  std::vector<std::uint8_t> alive_, convex_;
  // Corners that turn right or not: only they can block an ear. In the order of their coordinate
  // along `axis_`, the longer side of the polygon's box.
  std::vector<std::size_t> blunt_;
  std::size_t axis_ = 0;
  std::priority_queue<Ear> ears_;
  std::size_t left_ = 0;
};

}  // namespace delmesher::geometry
