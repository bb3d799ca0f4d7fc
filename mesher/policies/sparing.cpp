#include "mesher/policies/sparing.h"

#include <algorithm>

namespace delmesher::plane {

void Sparing::drop(std::uint8_t& flag) {
  spared_.count += flag == 0;
  flag = 1;
}

void Sparing::complete(const InputGraph& graph, std::size_t before) {
  constexpr int kMostFailures = 8;
  for (PieceId p = kBoxPieces; p < graph.pieces.size(); ++p) {
    const Piece& piece = graph.pieces[p];
    if (spared_.vertex[piece.a] != 0 || spared_.vertex[piece.b] != 0) drop(spared_.piece[p]);
  }
  if (++failures_ < kMostFailures && spared_.count > before) return;
  all_ = true;
  std::fill(spared_.piece.begin(), spared_.piece.end(), 1);
  std::fill(spared_.piece.begin(), spared_.piece.begin() + kBoxPieces, 0);
  std::fill(spared_.vertex.begin(), spared_.vertex.end(), 1);
}

void Sparing::spare(const InputGraph& graph, const RefinedMesh& refined) {
  const std::size_t before = spared_.count;
  for (const PieceId p : refined.crowded_pieces) {
    if (p >= kBoxPieces) drop(spared_.piece[p]);
  }
  for (const VertexId v : refined.crowded_vertices) drop(spared_.vertex[v]);
  complete(graph, before);
}

bool Sparing::spare_disturbed(const InputGraph& graph, const Chamfered& chamfered,
                              const RefinedMesh& refined, const std::vector<VertexId>& disturbed) {
  if (all_) return false;
  const std::size_t before = spared_.count;
  const auto is_disturbed = [&](VertexId v) {
    return std::binary_search(disturbed.begin(), disturbed.end(), v);
  };
  for (const VertexId v : disturbed) {
    if (v >= refined.carrier.size()) continue;
    const PieceId p = refined.carrier[v];
    if (p != kNone && p >= kBoxPieces) drop(spared_.piece[p]);
  }
  for (const Gap& gap : chamfered.gaps) {
    if (gap.piece >= kBoxPieces && is_disturbed(gap.b)) drop(spared_.piece[gap.piece]);
  }
  complete(graph, before);
  return true;
}

}  // namespace delmesher::plane
