#include "mesher/output/cosines.h"

#include <algorithm>
#include <cmath>

namespace delmesher::output {
namespace {

constexpr std::size_t kLanes = CosineBatch::kLanes;
using Lanes = CosineBatch::Lanes;
using Vectors = std::array<Lanes, 3>;

// A loop over all lanes, with nothing in it that depends on another one.
template <class Work>
void in_lanes(Work&& work) {
  for (std::size_t l = 0; l < kLanes; ++l) work(l);
}

void subtract(const Vectors& from, const Vectors& to, Vectors& result) {
  for (std::size_t k = 0; k < 3; ++k)
    in_lanes([&](auto l) { result[k][l] = to[k][l] - from[k][l]; });
}

void dot(const Vectors& u, const Vectors& v, Lanes& result) {
  in_lanes([&](auto l) { result[l] = u[0][l] * v[0][l] + u[1][l] * v[1][l] + u[2][l] * v[2][l]; });
}

void cross(const Vectors& u, const Vectors& v, Vectors& result) {
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
    in_lanes([&](auto l) { result[k][l] = u[i][l] * v[j][l] - u[j][l] * v[i][l]; });
  }
}

void inverse_root(const Lanes& squared, Lanes& result) {
  in_lanes([&](auto l) { result[l] = 1 / std::sqrt(squared[l]); });
}

}  // namespace

void CosineBatch::measure(std::span<const std::array<double, 3>> coordinates,
                          std::span<const std::array<std::uint32_t, 4>> tetrahedra) {
  // In a triangle whose angles have cosines up to the last, no side is 24 times as long as another;
  // so no edge is much shorter than the longest one, which alone is bounded.
  constexpr double kMaxSquared = 1e60, kMaxCosine = 0.999;
  constexpr double kMaxInverseArea = 1e150;  // infinite where a face has no area
  constexpr std::size_t kEdges[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
  const std::size_t count = std::min(kLanes, tetrahedra.size());
  std::array<Vectors, 4> corner{};
  for (std::size_t l = 0; l < count; ++l) {
    for (std::size_t i = 0; i < 4; ++i) {
      const auto& p = coordinates[tetrahedra[l][i]];
      for (std::size_t k = 0; k < 3; ++k) corner[i][k][l] = p[k];
    }
  }
  std::array<Vectors, 6> edge;
  std::array<Lanes, 6> squared, inverse;
  Lanes longest, largest{}, thinnest{};
  for (std::size_t e = 0; e < 6; ++e) {
    subtract(corner[kEdges[e][0]], corner[kEdges[e][1]], edge[e]);
    dot(edge[e], edge[e], squared[e]);
    inverse_root(squared[e], inverse[e]);
  }
  longest = squared[0];
  for (std::size_t e = 1; e < 6; ++e) {
    in_lanes([&](auto l) { longest[l] = squared[e][l] > longest[l] ? squared[e][l] : longest[l]; });
  }
  const auto note = [&](const Lanes& cosine) {
    in_lanes([&](auto l) {
      const double size = std::fabs(cosine[l]);
      largest[l] = size > largest[l] ? size : largest[l];
    });
  };
  // Of edges i and j at their common end; negative if one of them starts there and one ends.
  const auto between = [&](std::size_t i, std::size_t j, double sign, Lanes& result) {
    dot(edge[i], edge[j], result);
    in_lanes([&](auto l) { result[l] *= sign * (inverse[i][l] * inverse[j][l]); });
    note(result);
  };
  // The edges of each face, in the order 12, 13, 23 of its vertices.
  constexpr std::size_t kFaceEdges[4][3] = {{3, 4, 5}, {1, 2, 5}, {0, 2, 4}, {0, 1, 3}};
  for (std::size_t f = 0; f < 4; ++f) {
    const auto& [i, j, k] = kFaceEdges[f];
    between(i, j, 1, face[f][0]);
    between(i, k, -1, face[f][1]);
    between(j, k, 1, face[f][2]);
  }
  std::array<Vectors, 4> normal;
  cross(edge[3], edge[4], normal[0]);
  cross(edge[2], edge[1], normal[1]);
  cross(edge[0], edge[2], normal[2]);
  cross(edge[1], edge[0], normal[3]);
  std::array<Lanes, 4> squared_area, area;  // the latter is one over it
  Lanes areas{}, squared_areas{}, squared_edges{};
  for (std::size_t f = 0; f < 4; ++f) {
    dot(normal[f], normal[f], squared_area[f]);
    inverse_root(squared_area[f], area[f]);
    in_lanes([&](auto l) {
      thinnest[l] = area[f][l] > thinnest[l] ? area[f][l] : thinnest[l];
      squared_areas[l] += squared_area[f][l];
      areas[l] += squared_area[f][l] * area[f][l];
    });
  }
  for (std::size_t e = 0; e < 6; ++e) {
    // The faces at an edge are opposite the two other vertices.
    const std::size_t f = kEdges[5 - e][0], g = kEdges[5 - e][1];
    dot(normal[f], normal[g], dihedral[e]);
    in_lanes([&](auto l) { dihedral[e][l] *= -(area[f][l] * area[g][l]); });
    note(dihedral[e]);
    in_lanes([&](auto l) { squared_edges[l] += squared[e][l]; });
  }
  // From vertex 0 to the centre of the circumsphere, times twice the determinant, which is six
  // times the volume.
  Vectors centre;
  for (std::size_t k = 0; k < 3; ++k) {
    in_lanes([&](auto l) {
      centre[k][l] = squared[0][l] * normal[1][k][l] + squared[1][l] * normal[2][k][l] +
                     squared[2][l] * normal[3][k][l];
    });
  }
  Lanes determinant, squared_centre;
  dot(edge[0], normal[1], determinant);
  dot(centre, centre, squared_centre);
  in_lanes([&](auto l) {
    const double six = -6 * determinant[l];
    gamma[l] = std::fabs(six * determinant[l]) / (areas[l] * std::sqrt(squared_centre[l]));
    sicn[l] = six / std::sqrt(squared_edges[l] * squared_areas[l]);
  });
  for (std::size_t l = 0; l < kLanes; ++l) {
    ordinary[l] = l < count && longest[l] < kMaxSquared && longest[l] > 1 / kMaxSquared &&
                  largest[l] < kMaxCosine && thinnest[l] < kMaxInverseArea;
  }
}

// acos c = pi / 2 - asin c where |c| <= 1/2, else 2 asin sqrt((1 - |c|) / 2), for |c|; and asin by
// a polynomial: the best one of degree 12 for asin(sqrt z) / sqrt z in z <= 1/4 is off by 2e-17.
void degrees_of_cosines(std::span<double> values) {
  constexpr double kDegrees = 57.29577951308232;  // per radian
  constexpr double kCoefficients[] = {0.03187962140081284,
                                      -0.016187392271599134,
                                      0.019513468251252167,
                                      0.0065293020047365695,
                                      0.012170138592391726,
                                      0.01388484282640208,
                                      0.01735977964134998,
                                      0.022371749733164054,
                                      0.03038195969768514,
                                      0.044642856805998936,
                                      0.07500000000385201,
                                      0.16666666666664942,
                                      1.0};
  for (double& value : values) {
    const double size = std::fabs(value);
    const bool small = size <= 0.5;
    const double z = small ? size * size : 0.5 * (1 - size);
    const double root = std::sqrt(z);
    double polynomial = 0;
    for (const double c : kCoefficients) polynomial = polynomial * z + c;
    const double arcsine = (small ? size : root) * polynomial * kDegrees;
    const double angle = small ? 90 - arcsine : 2 * arcsine;
    value = value < 0 ? 180 - angle : angle;
  }
}

}  // namespace delmesher::output
