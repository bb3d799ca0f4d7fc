#include "oracles/memory.h"

#include <type_traits>

#include "oracles/base/heap.h"

namespace tetproof::oracles {

void Memory::need(unsigned bulks) {
  for (std::size_t bit = 0; bit < needs_.size(); ++bit) needs_[bit] += bulks >> bit & 1U;
}

void Memory::done_with(unsigned bulks) {
  bool fewer = false;
  for (std::size_t bit = 0; bit < needs_.size(); ++bit) {
    if ((bulks >> bit & 1U) == 0 || --needs_[bit] > 0) continue;
    give_up(static_cast<Bulk>(1U << bit));
    fewer = true;
  }
  if (fewer) return_free_pages();
}

// Of a vector, assigning nothing would keep the memory.
void Memory::give_up(Bulk bulk) {
  MeshFile* mesh = expendable_.mesh;
  delmesher::ExactRecord* record = expendable_.record;
  const auto empty = [](auto&... lists) { ((lists = std::decay_t<decltype(lists)>()), ...); };
  if (bulk == kFile && mesh != nullptr) empty(*mesh);
  if (bulk == kFileTetrahedra && mesh != nullptr) empty(mesh->tetrahedra);
  if (bulk == kRefinedComplex) forget_refined_();
  if (record == nullptr) return;
  if (bulk == kRefinedTetrahedra) empty(record->refined);
  if (bulk == kRefinedElements) {
    empty(record->segments, record->chamfer_points, record->refined_facets, record->balls);
  }
  if (bulk == kFinalTetrahedra) empty(record->final);
  if (bulk == kUnrepairedTetrahedra) empty(record->unrepaired);
  if (bulk == kFinalMeshes) {
    empty(record->final, record->final_facets, record->unrepaired, record->unrepaired_facets);
  }
}

}  // namespace tetproof::oracles
