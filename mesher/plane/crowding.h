// Where the refinement found no room: between doubles, or in a channel that the filter overlooked.
// The next attempt spares the input vertices and pieces there.
//
// Invariants:
//  - a note names a vertex or a piece of the input. any() says so if there is one, or if it is
//    hopeless; without a note it is of nothing that can be spared;
//  - splits are counted of pieces of the input alone, and it is hopeless only if one of them was
//    split as often as the options allow.
#pragma once

#include <cstdint>
#include <vector>

#include "mesher/plane/graph.h"

namespace delmesher::plane {

class Crowding {
 public:
  // `carrier`: per vertex id, the piece that it was put on, or kNone; may be too short for some.
  // `most_splits`: RefineOptions::most_splits.
  Crowding(const InputGraph& graph, const std::vector<PieceId>& carrier, std::uint64_t most_splits)
      : graph_(graph),
        carrier_(carrier),
        most_splits_(most_splits),
        splits_(graph.pieces.size(), 0) {}

  bool any() const { return any_; }
  // It would take too long: the refinement is to stop right now.
  bool hopeless() const { return hopeless_; }
  const std::vector<PieceId>& pieces() const { return pieces_; }
  const std::vector<VertexId>& vertices() const { return vertices_; }

  // No room at a vertex: of the input, or on a piece of it. (At others nothing can be spared.)
  void at(VertexId v);
  // A piece is split once more.
  void count_split(PieceId piece);

  // Throws InternalError at the first broken invariant.
  void validate() const;

 private:
  friend struct CrowdingBreaker;  // of the tests of validate()

  const InputGraph& graph_;
  const std::vector<PieceId>& carrier_;
  std::uint64_t most_splits_;
  std::vector<std::uint64_t> splits_;  // per piece
  std::vector<PieceId> pieces_;
  std::vector<VertexId> vertices_;
  bool any_ = false, hopeless_ = false;
};

}  // namespace delmesher::plane
