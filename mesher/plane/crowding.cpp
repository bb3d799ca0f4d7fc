#include "mesher/plane/crowding.h"

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

void Crowding::forget() {
  any_ = hopeless_ = false;
  pieces_.clear();
  vertices_.clear();
}

}  // namespace delmesher::plane
