#include "mesher/policies/sparing.h"

#include <algorithm>

namespace delmesher::plane {

void Sparing::drop(std::uint8_t& flag) {
  spared_.count += flag == 0;
  flag = 1;
}

void Sparing::spare(const InputGraph& graph, const RefinedMesh& refined) {
  constexpr int kMostFailures = 8;
  const std::size_t before = spared_.count;
  for (const PieceId p : refined.crowded_pieces) {
    if (p >= kBoxPieces) drop(spared_.piece[p]);
  }
  for (const VertexId v : refined.crowded_vertices) drop(spared_.vertex[v]);
  for (PieceId p = kBoxPieces; p < graph.pieces.size(); ++p) {
    const Piece& piece = graph.pieces[p];
    if (spared_.vertex[piece.a] != 0 || spared_.vertex[piece.b] != 0) drop(spared_.piece[p]);
  }
  if (++failures_ < kMostFailures && spared_.count > before) return;
  std::fill(spared_.piece.begin(), spared_.piece.end(), 1);
  std::fill(spared_.piece.begin(), spared_.piece.begin() + kBoxPieces, 0);
  std::fill(spared_.vertex.begin(), spared_.vertex.end(), 1);
}

}  // namespace delmesher::plane
