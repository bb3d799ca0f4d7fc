#include "mesher/surface/tetrahedron_contact.h"

#include <algorithm>
#include <bit>

namespace delmesher::surface {
namespace {

// Corners 0 to 3 are the tetrahedron's, 4 to 6 the triangle's. Sets of corners are bits.
using CornerSet = unsigned;
constexpr CornerSet kTetrahedron = 0b1111;

// Three corners, and for which others, appended, an odd permutation sorts the four.
struct Triple {
  CornerSet corners;
  unsigned odd;
};

// Most pairs are separated by a face of the tetrahedron. (The triangle's plane comes before these.)
constexpr std::array<Triple, 34> kTriples = [] {
  std::array<Triple, 34> triples{};
  std::size_t count = 0;
  for (const unsigned of_triangle : {0U, 1U, 2U}) {
    for (unsigned i = 0; i < 7; ++i) {
      for (unsigned j = i + 1; j < 7; ++j) {
        for (unsigned k = j + 1; k < 7; ++k) {
          if ((i > 3 ? 1U : 0U) + (j > 3 ? 1U : 0U) + (k > 3 ? 1U : 0U) != of_triangle) continue;
          Triple t{1U << i | 1U << j | 1U << k, 0};
          for (unsigned l = 0; l < 7; ++l) {
            if (((l < i ? 1U : 0U) + (l < j ? 1U : 0U) + (l < k ? 1U : 0U)) % 2 == 1) {
              t.odd |= 1U << l;
            }
          }
          triples[count++] = t;
        }
      }
    }
  }
  return triples;
}();

class SeparatingPlanes {
 public:
  SeparatingPlanes(Predicates& predicates, const std::array<VertexId, 4>& tetrahedron,
                   const Corners& triangle)
      : predicates_(predicates) {
    for (unsigned i = 0; i < 4; ++i) id_[i] = tetrahedron[i];
    for (unsigned i = 0; i < 3; ++i) {
      id_[4 + i] = triangle[i];
      corner_[i] = 4 + i;
      for (unsigned k = 0; k < 4; ++k) {
        if (tetrahedron[k] == triangle[i]) corner_[i] = k;
      }
      triangle_ |= 1U << corner_[i];
    }
    sign_.fill(kUnset);
    sign_[kTetrahedron] = 1;
  }

  bool exist() {
    std::array<int, 4> side;  // of the triangle's plane
    bool above = false, below = false;
    for (unsigned i = 0; i < 4; ++i) {
      side[i] = orient(corner_[0], corner_[1], corner_[2], i);
      above |= side[i] > 0;
      below |= side[i] < 0;
    }
    if (above != below) return true;
    for (unsigned i = 0; i < 4; ++i) {
      for (unsigned j = i + 1; j < 4; ++j) {
        if (side[i] * side[j] < 0 && meets_triangle(i, j)) return false;
      }
    }
    const CornerSet all = kTetrahedron | triangle_;
    return std::any_of(kTriples.begin(), kTriples.end(), [&](const Triple& triple) {
      return (triple.corners & ~all) == 0 && separates(triple, all);
    });
  }

 private:
  static constexpr std::int8_t kUnset = 2;

  // Of four different corners.
  int sign_of(CornerSet four) {
    std::int8_t& sign = sign_[four];
    if (sign == kUnset) {
      std::array<VertexId, 4> v;
      CornerSet rest = four;
      for (VertexId& id : v) {
        id = id_[static_cast<unsigned>(std::countr_zero(rest))];
        rest &= rest - 1;
      }
      sign = static_cast<std::int8_t>(predicates_.orient3d(v[0], v[1], v[2], v[3]));
    }
    return sign;
  }

  // Sign of orient3d of four corners in any order.
  int orient(unsigned i, unsigned j, unsigned k, unsigned l) {
    const CornerSet three = 1U << i | 1U << j | 1U << k;
    if (i == j || j == k || k == i || (three >> l & 1U) != 0) return 0;
    const bool odd = (i > j) ^ (i > k) ^ (j > k) ^ (i > l) ^ (j > l) ^ (k > l);
    const int sign = sign_of(three | 1U << l);
    return odd ? -sign : sign;
  }

  // Does the edge between two corners of the tetrahedron, on both sides of the triangle's plane,
  // meet the interior of the triangle? Then the triangle meets the interior of the tetrahedron.
  bool meets_triangle(unsigned i, unsigned j) {
    const int sign = orient(i, j, corner_[0], corner_[1]);
    return sign != 0 && orient(i, j, corner_[1], corner_[2]) == sign &&
           orient(i, j, corner_[2], corner_[0]) == sign;
  }

  // If the three are not affinely independent, every sign is 0; if they are, some corner of the
  // tetrahedron is off their plane and shows on which side the tetrahedron is.
  bool separates(const Triple& triple, CornerSet all) {
    // By sides of the plane, below and above: are corners of the tetrahedron, or of the triangle,
    // there?
    std::array<bool, 2> of_tetrahedron{}, of_triangle{};
    for (CornerSet rest = all & ~triple.corners; rest != 0; rest &= rest - 1) {
      const auto l = static_cast<unsigned>(std::countr_zero(rest));
      const int sign = sign_of(triple.corners | 1U << l);
      if (sign == 0) continue;
      const std::size_t above = (sign > 0) ^ ((triple.odd >> l & 1U) != 0) ? 1 : 0;
      if ((kTetrahedron >> l & 1U) != 0) {
        of_tetrahedron[above] = true;
        if (of_tetrahedron[1 - above] || of_triangle[above]) return false;
      }
      if ((triangle_ >> l & 1U) != 0) {
        of_triangle[above] = true;
        if (of_triangle[1 - above] || of_tetrahedron[above]) return false;
      }
    }
    return of_tetrahedron[0] || of_tetrahedron[1];
  }

  Predicates& predicates_;
  std::array<VertexId, 7> id_;
  std::array<unsigned, 3> corner_{};  // of the triangle; the tetrahedron's if it has the same
  CornerSet triangle_ = 0;
  std::array<std::int8_t, 128> sign_;
};

}  // namespace

bool meets_interior(Predicates& predicates, const std::array<VertexId, 4>& tetrahedron,
                    const Corners& triangle) {
  return !SeparatingPlanes(predicates, tetrahedron, triangle).exist();
}

}  // namespace delmesher::surface
