// What tests of generated surfaces have in common.
#pragma once

#include <vector>

#include "corpus/generators/shapes.h"

namespace tetproof::test_surfaces {

// A box of volume 24.
inline delmesher::Surface a_box() {
  return shapes::box({-1, -2, -0.5}, {3, 1, 1.5});
}

inline delmesher::Surface together(const std::vector<delmesher::Surface>& bodies) {
  delmesher::Surface surface;
  for (const delmesher::Surface& body : bodies) shapes::append(surface, body);
  surface.labels.clear();
  return surface;
}

inline delmesher::Surface inwards(delmesher::Surface body) {
  shapes::reverse(body);
  return body;
}

// Signed, in doubles: the sum over the triangles' tetrahedra with the origin.
inline double volume(const delmesher::Surface& s) {
  double sum = 0;
  for (const auto& [a, b, c] : s.triangles) {
    const shapes::Point &p = s.vertices[a], &q = s.vertices[b], &r = s.vertices[c];
    sum += p[0] * (q[1] * r[2] - q[2] * r[1]) + p[1] * (q[2] * r[0] - q[0] * r[2]) +
           p[2] * (q[0] * r[1] - q[1] * r[0]);
  }
  return sum / 6;
}

}  // namespace tetproof::test_surfaces
