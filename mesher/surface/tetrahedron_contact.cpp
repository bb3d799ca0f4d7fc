#include "mesher/surface/tetrahedron_contact.h"

#include <utility>

namespace delmesher::surface {
namespace {

// Corners 0..3 are the tetrahedron's, 4..6 the triangle's.
class SeparatingPlanes {
 public:
  SeparatingPlanes(Predicates& predicates, const std::array<VertexId, 4>& tetrahedron,
                   const Corners& triangle)
      : predicates_(predicates) {
    for (unsigned i = 0; i < 4; ++i) id_[i] = tetrahedron[i];
    for (unsigned i = 4; i < 7; ++i) {
      id_[i] = triangle[i - 4];
      same_as_[i] = i;
      for (unsigned k = 0; k < 4; ++k) {
        if (tetrahedron[k] == id_[i]) same_as_[i] = k;
      }
    }
    sign_.fill(kUnset);
    sign_[0b1111] = 1;
  }

  // Most pairs are separated by a face of the tetrahedron or by the triangle's plane.
  bool exist() {
    if (separates(4, 5, 6)) return true;
    if (separates(1, 2, 3) || separates(0, 2, 3) || separates(0, 1, 3) || separates(0, 1, 2)) {
      return true;
    }
    for (unsigned i = 0; i < 4; ++i) {
      for (unsigned j = i + 1; j < 4; ++j) {
        for (unsigned k = 4; k < 7; ++k) {
          if (separates(i, j, k)) return true;
        }
      }
    }
    for (unsigned i = 0; i < 4; ++i) {
      if (separates(i, 4, 5) || separates(i, 4, 6) || separates(i, 5, 6)) return true;
    }
    return false;
  }

 private:
  static constexpr std::int8_t kUnset = 2;

  // Sign of orient3d of four corners given in any order.
  int orient(std::array<unsigned, 4> c) {
    for (unsigned& i : c) i = same_as_[i];
    int parity = 1;
    for (unsigned i = 1; i < 4; ++i) {
      for (unsigned j = i; j > 0 && c[j - 1] >= c[j]; --j) {
        if (c[j - 1] == c[j]) return 0;
        std::swap(c[j - 1], c[j]);
        parity = -parity;
      }
    }
    std::int8_t& sign = sign_[1U << c[0] | 1U << c[1] | 1U << c[2] | 1U << c[3]];
    if (sign == kUnset) {
      sign = static_cast<std::int8_t>(
          predicates_.orient3d(id_[c[0]], id_[c[1]], id_[c[2]], id_[c[3]]));
    }
    return parity * sign;
  }

  // If the three are not affinely independent, every sign is 0; if they are, some corner of the
  // tetrahedron is off their plane and shows on which side the tetrahedron is.
  bool separates(unsigned i, unsigned j, unsigned k) {
    int side = 0;
    for (unsigned l = 0; l < 7; ++l) {
      if (l == i || l == j || l == k) continue;
      const int o = orient({i, j, k, l});
      if (l < 4) {
        if (o * side < 0) return false;
        if (o != 0) side = o;
      } else if (side == 0 || o * side > 0) {
        return false;
      }
    }
    return side != 0;
  }

  Predicates& predicates_;
  std::array<VertexId, 7> id_;
  std::array<unsigned, 7> same_as_{0, 1, 2, 3, 4, 5, 6};
  std::array<std::int8_t, 128> sign_;
};

}  // namespace

bool meets_interior(Predicates& predicates, const std::array<VertexId, 4>& tetrahedron,
                    const Corners& triangle) {
  return !SeparatingPlanes(predicates, tetrahedron, triangle).exist();
}

}  // namespace delmesher::surface
