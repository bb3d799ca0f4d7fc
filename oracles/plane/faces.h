// The faces into which the pieces of a planar graph cut the plane, and which of them are inside: of
// the input alone, whatever a mesh says. For graphs of which parity does not decide.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "oracles/base/union_find.h"
#include "oracles/plane/graph.h"

namespace tetproof::oracles {

class PlaneFaces {
 public:
  using Index = PlaneGraph::Index;
  using Point = PlaneGraph::Point;

  // The graph must outlive this. Its pieces meet at their ends alone, or are equal.
  explicit PlaneFaces(PlaneGraph& graph);

  // Is p, which is on no piece, inside?
  bool inside(const Point& p);
  // Is one side of the piece inside, and the other one outside?
  bool separates(Index piece) const {
    return inside_[face_[side_of_[piece]]] != inside_[face_[side_of_[piece] ^ 1U]];
  }

 private:
  struct Crossing;

  const PlaneGraph::Piece& piece_of(Index side) const { return graph_.pieces()[side / 2]; }
  Index start(Index side) const { return side % 2 == 0 ? piece_of(side).a : piece_of(side).b; }
  Index end(Index side) const { return start(side ^ 1U); }
  void sort_sides();
  void trace_borders();
  void join_components();
  void find_inside();
  std::vector<Index> outermost() const;
  Crossing crossing(Index piece, const Point& p) const;
  Index border_right_of(const Point& p);

  PlaneGraph& graph_;
  PlaneSlabs slabs_;
  // Each piece has two sides, 2 n on its left and 2 n + 1 on its right, which run from its first
  // end and from its last end. Of equal pieces only the first counts.
  std::vector<Index> side_of_;                  // per piece: the left side of the one that counts
  std::vector<std::vector<Index>> sides_from_;  // per vertex, counter-clockwise
  std::vector<Index> face_;                     // per side
  UnionFind joined_{0};                         // borders that belong to one face
  Index unbounded_ = 0;
  std::vector<std::uint8_t> inside_;  // per face
};

// What is inside the input: by parity where that decides, else by faces.
class PlaneInside {
 public:
  // The graph must outlive this.
  explicit PlaneInside(PlaneGraph& graph) : graph_(graph) {
    if (!graph.closed_rings()) faces_.emplace(graph);
  }

  // Is p, which is on no piece, inside?
  bool contains(const PlaneGraph::Point& p) {
    return faces_ ? faces_->inside(p) : graph_.inside_by_ray(p);
  }
  // Is one side of the piece inside, and the other one outside?
  bool ends_at(PlaneGraph::Index piece) const {
    return faces_ ? faces_->separates(piece) : graph_.separates(graph_.pieces()[piece].segment);
  }

 private:
  PlaneGraph& graph_;
  std::optional<PlaneFaces> faces_;
};

}  // namespace tetproof::oracles
