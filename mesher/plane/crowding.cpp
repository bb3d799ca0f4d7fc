#include "mesher/plane/crowding.h"

#include <algorithm>

#include "mesher/base/check.h"

namespace delmesher::plane {

void Crowding::at(VertexId v) {
  any_ = true;
  if (v < graph_.vertices) {
    vertices_.push_back(v);
  } else if (v < carrier_.size() && carrier_[v] != kNone) {
    pieces_.push_back(carrier_[v]);
  }
}

void Crowding::count_split(PieceId piece) {
  if (piece < kBoxPieces || ++splits_[piece] != most_splits_) return;
  any_ = hopeless_ = true;
  pieces_.push_back(piece);
}

void Crowding::validate() const {
  DELMESHER_CHECK(any_ || (pieces_.empty() && vertices_.empty() && !hopeless_),
                  "something is crowded, and any() denies it");
  for (const VertexId v : vertices_) {
    DELMESHER_CHECK(v < graph_.vertices, "a crowded vertex that is not of the input");
  }
  for (const PieceId p : pieces_) {
    DELMESHER_CHECK(p < graph_.pieces.size(), "a crowded piece that does not exist");
  }
  for (PieceId p = 0; p < kBoxPieces; ++p) {
    DELMESHER_CHECK(splits_[p] == 0, "splits of a side of the box are counted");
  }
  const bool often = most_splits_ > 0 && std::ranges::any_of(splits_, [&](std::uint64_t n) {
                       return n >= most_splits_;
                     });
  DELMESHER_CHECK(!hopeless_ || often, "hopeless, and no piece was split that often");
}

}  // namespace delmesher::plane
