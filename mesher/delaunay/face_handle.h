// A face of a tetrahedron, or none, in 32 bits: the handle by which tetrahedra name each other and
// others name their faces.
#pragma once

#include <cstdint>

#include "mesher/base/ids.h"

namespace delmesher::delaunay {

class FaceHandle {
 public:
  // A handle can name the faces of this many tetrahedra, and none.
  static constexpr std::uint32_t kMostTetrahedra = (1U << 30) - 1;

  constexpr FaceHandle() = default;  // none
  // Face i is opposite vertex i.
  constexpr FaceHandle(TetId tet, int face) : index_(4 * tet + static_cast<std::uint32_t>(face)) {}
  // The inverse of index().
  static constexpr FaceHandle at(std::uint32_t index) {
    return {index >> 2, static_cast<int>(index & 3U)};
  }

  constexpr bool exists() const { return index_ != kNone; }
  constexpr TetId tet() const { return index_ >> 2; }
  constexpr int face() const { return static_cast<int>(index_ & 3U); }
  // For arrays by face: below 4 * capacity of the tetrahedrization; kNone for none.
  constexpr std::uint32_t index() const { return index_; }
  friend constexpr bool operator==(FaceHandle, FaceHandle) = default;

 private:
  std::uint32_t index_ = kNone;
};

}  // namespace delmesher::delaunay
