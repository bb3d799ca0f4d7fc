// The tetrahedra that one apex makes with several faces, as a vertex does with its link. Where a
// vertex could go is asked for many places, so several tetrahedra are measured at a time, and what
// belongs to the faces alone is measured once.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mesher/improve/quality.h"

namespace delmesher::improve {

class Cone {
 public:
  void clear() {
    size_ = 0;
    order_.clear();
  }
  // The face is counter-clockwise as seen from the side where the apex is not.
  void add(const Vec3& a, const Vec3& b, const Vec3& c, bool counts);
  // After the last face.
  void finish();
  std::size_t size() const { return size_; }

  // The average of the apexes that make tetrahedra nearly regular (best_apex()), over those that
  // count; and of the squared edges of all faces.
  Vec3 average_apex() const;
  double average_squared_edge() const;

  // With the apex at x: are all tetrahedra positive, and do those that count reach `least`? If so,
  // quality(n) is known for all.
  bool reaches(const Vec3& x, const Quality& least);
  bool counts(std::size_t n) const { return blocks_[n / kLanes].counts[n % kLanes]; }
  // Of the tetrahedron at the n-th face; kNotCounted if it does not count.
  Quality quality(std::size_t n) const {
    const Block& block = blocks_[n / kLanes];
    const std::size_t l = n % kLanes;
    return block.counts[l] ? Quality{block.dihedral[l], block.face[l], block.gamma[l]}
                           : kNotCounted;
  }

 private:
  static constexpr std::size_t kLanes = 4;
  using Lanes = std::array<double, kLanes>;

  struct alignas(32) Block {
    std::array<Lanes, 3> a, b, c;
    std::array<Lanes, 3> normal;  // as long as twice the area
    Lanes inverse_n, length;      // of the normal: one over its square, and its length
    Lanes ab, bc, ca;             // squared edges
    Lanes angle;                  // the squared sine of the smallest angle
    std::array<float, kLanes> dihedral, face, gamma;
    std::array<bool, kLanes> counts;
  };

  static void find_normals(Block& block);
  static bool measure(Block& block, const Vec3& x, const Quality& least);

  std::size_t size_ = 0;
  std::vector<Block> blocks_;
  std::vector<std::uint32_t> order_;  // of the blocks: what failed last is asked first
};

}  // namespace delmesher::improve
