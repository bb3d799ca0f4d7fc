// Boxes of segments and points in the cells of a uniform grid, so that the checks of a large input
// need not try all against all. The grid compares boxes only; the caller decides what is near.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace tetproof {

class PlaneGrid {
 public:
  using Corner = std::array<double, 2>;
  struct Box {
    Corner low, high;
  };

  PlaneGrid() = default;
  // Items are numbered in this order.
  explicit PlaneGrid(const std::vector<Box>& items);

  // Calls meet(item) once for every item whose box meets the given one, and for some others.
  template <class Meet>
  void visit(const Box& box, Meet&& meet) {
    if (cells_.empty()) return;
    ++epoch_;
    const Cell from = cell(box.low), to = cell(box.high);
    for (std::size_t y = from[1]; y <= to[1]; ++y) {
      for (std::size_t x = from[0]; x <= to[0]; ++x) {
        for (const std::uint32_t item : cells_[y * side_ + x]) {
          if (seen_[item] == epoch_) continue;
          seen_[item] = epoch_;
          meet(item);
        }
      }
    }
  }

 private:
  using Cell = std::array<std::size_t, 2>;
  // Monotone in both coordinates; a point outside the grid belongs to a cell of its border.
  Cell cell(const Corner& p) const;

  std::size_t side_ = 1;
  Box all_{};
  std::vector<std::vector<std::uint32_t>> cells_;
  std::vector<std::uint64_t> seen_;
  std::uint64_t epoch_ = 0;
};

}  // namespace tetproof
