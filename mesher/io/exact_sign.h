// Exact signs of small determinants of doubles, for triangulating polygons. The stages have faster
// predicates of their own, which the reader must not depend on.
#pragma once

#include <array>

namespace delmesher::io {

// Sign of det(a - c, b - c): positive if a, b, c turn counter-clockwise. Any finite coordinates.
int orient2d_sign(const std::array<double, 2>& a, const std::array<double, 2>& b,
                  const std::array<double, 2>& c);

// Whether four points lie exactly in one plane. Any finite coordinates.
bool coplanar(const std::array<double, 3>& a, const std::array<double, 3>& b,
              const std::array<double, 3>& c, const std::array<double, 3>& d);

}  // namespace delmesher::io
