#include "mesher/plane/plane_predicates.h"

#include <algorithm>
#include <array>

#include "mesher/predicates/stages.h"

namespace delmesher::plane {

int PlanePredicates::orient_exact(VertexId a, VertexId b, VertexId c) {
  if (a == b || b == c || a == c) return 0;
  ++counters.exact;
  const VertexId ids[] = {a, b, c};
  return stages::exact(points_, predicates::polynomials::Orient2d{2}, ids);
}

int PlanePredicates::in_circle_exact(VertexId a, VertexId b, VertexId c, VertexId d) {
  if (a == b || a == c || a == d || b == c || b == d || c == d) return 0;
  ++counters.exact;
  const VertexId ids[] = {a, b, c, d};
  return stages::exact(points_, polynomials::InCircle{}, ids);
}

int PlanePredicates::dot_exact(VertexId p, VertexId q, VertexId r) {
  if (p == q || q == r) return 0;
  ++counters.exact;
  const VertexId ids[] = {p, q, r};
  return stages::exact(points_, polynomials::Dot{}, ids);
}

// With heights h, the determinant is h_a orient(bcd) - h_b orient(acd) + h_c orient(abd) -
// h_d orient(abc): the sign of a vanishing one is that of the coefficient of the smallest id whose
// coefficient is not zero.
int PlanePredicates::perturbed_sign(VertexId a, VertexId b, VertexId c, VertexId d) {
  const std::array<VertexId, 4> v = {a, b, c, d};
  std::array<std::uint8_t, 4> order = {0, 1, 2, 3};
  std::sort(order.begin(), order.end(), [&](int i, int j) { return v[i] < v[j]; });
  for (std::size_t i = 1; i < 4; ++i) {
    if (v[order[i]] == v[order[i - 1]]) return 0;
  }
  ++counters.symbolic;
  for (const int i : order) {
    const int s = i == 0   ? orient(b, c, d)
                  : i == 1 ? -orient(a, c, d)
                  : i == 2 ? orient(a, b, d)
                           : -orient(a, b, c);
    if (s != 0) return s;
  }
  return 0;
}

}  // namespace delmesher::plane
