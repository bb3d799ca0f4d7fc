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

constexpr std::size_t kEdges[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};

// From the first to the second end of each edge, its squared length, and one over its length.
struct Edges {
  std::array<Vectors, 6> vector;
  std::array<Lanes, 6> squared, inverse;
};

// Of the face opposite each vertex: twice its area as a vector, outwards; the square of that, and
// one over its length.
struct Faces {
  std::array<Vectors, 4> normal;
  std::array<Lanes, 4> squared, inverse;
};

Edges edges_of(std::span<const std::array<double, 3>> coordinates,
               std::span<const std::array<std::uint32_t, 4>> tetrahedra) {
  std::array<Vectors, 4> corner{};
  for (std::size_t l = 0; l < tetrahedra.size(); ++l) {
    for (std::size_t i = 0; i < 4; ++i) {
      const auto& p = coordinates[tetrahedra[l][i]];
      for (std::size_t k = 0; k < 3; ++k) corner[i][k][l] = p[k];
    }
  }
  Edges edges;
  for (std::size_t e = 0; e < 6; ++e) {
    subtract(corner[kEdges[e][0]], corner[kEdges[e][1]], edges.vector[e]);
    dot(edges.vector[e], edges.vector[e], edges.squared[e]);
    inverse_root(edges.squared[e], edges.inverse[e]);
  }
  return edges;
}

Faces faces_of(const Edges& edges) {
  Faces faces;
  cross(edges.vector[3], edges.vector[4], faces.normal[0]);
  cross(edges.vector[2], edges.vector[1], faces.normal[1]);
  cross(edges.vector[0], edges.vector[2], faces.normal[2]);
  cross(edges.vector[1], edges.vector[0], faces.normal[3]);
  for (std::size_t f = 0; f < 4; ++f) {
    dot(faces.normal[f], faces.normal[f], faces.squared[f]);
    inverse_root(faces.squared[f], faces.inverse[f]);
  }
  return faces;
}

// The largest of each lane.
template <std::size_t N>
Lanes largest_of(const std::array<Lanes, N>& values) {
  Lanes largest = values[0];
  for (std::size_t n = 1; n < N; ++n) {
    in_lanes([&](auto l) { largest[l] = values[n][l] > largest[l] ? values[n][l] : largest[l]; });
  }
  return largest;
}

// Raises `largest` to the size of the cosines.
void take_note(const Lanes& cosine, Lanes& largest) {
  in_lanes([&](auto l) {
    const double size = std::fabs(cosine[l]);
    largest[l] = size > largest[l] ? size : largest[l];
  });
}

void measure_faces(const Edges& edges, CosineBatch& batch, Lanes& largest) {
  // Of edges i and j at their common end; negative if one of them starts there and one ends.
  const auto between = [&](std::size_t i, std::size_t j, double sign, Lanes& result) {
    dot(edges.vector[i], edges.vector[j], result);
    in_lanes([&](auto l) { result[l] *= sign * (edges.inverse[i][l] * edges.inverse[j][l]); });
    take_note(result, largest);
  };
  // The edges of each face, in the order 12, 13, 23 of its vertices.
  constexpr std::size_t kFaceEdges[4][3] = {{3, 4, 5}, {1, 2, 5}, {0, 2, 4}, {0, 1, 3}};
  for (std::size_t f = 0; f < 4; ++f) {
    const auto& [i, j, k] = kFaceEdges[f];
    between(i, j, 1, batch.face[f][0]);
    between(i, k, -1, batch.face[f][1]);
    between(j, k, 1, batch.face[f][2]);
  }
}

void measure_dihedrals(const Faces& faces, CosineBatch& batch, Lanes& largest) {
  for (std::size_t e = 0; e < 6; ++e) {
    // The faces at an edge are opposite the two other vertices.
    const std::size_t f = kEdges[5 - e][0], g = kEdges[5 - e][1];
    Lanes& result = batch.dihedral[e];
    dot(faces.normal[f], faces.normal[g], result);
    in_lanes([&](auto l) { result[l] *= -(faces.inverse[f][l] * faces.inverse[g][l]); });
    take_note(result, largest);
  }
}

void measure_shapes(const Edges& edges, const Faces& faces, CosineBatch& batch) {
  Lanes areas{}, squared_areas{}, squared_edges{};
  for (std::size_t f = 0; f < 4; ++f) {
    in_lanes([&](auto l) {
      squared_areas[l] += faces.squared[f][l];
      areas[l] += faces.squared[f][l] * faces.inverse[f][l];
    });
  }
  for (const Lanes& squared : edges.squared) {
    in_lanes([&](auto l) { squared_edges[l] += squared[l]; });
  }
  // From vertex 0 to the centre of the circumsphere, times twice the determinant, which is six
  // times the volume.
  Vectors centre;
  for (std::size_t k = 0; k < 3; ++k) {
    in_lanes([&](auto l) {
      centre[k][l] = edges.squared[0][l] * faces.normal[1][k][l] +
                     edges.squared[1][l] * faces.normal[2][k][l] +
                     edges.squared[2][l] * faces.normal[3][k][l];
    });
  }
  Lanes determinant, squared_centre;
  dot(edges.vector[0], faces.normal[1], determinant);
  dot(centre, centre, squared_centre);
  in_lanes([&](auto l) {
    const double six = -6 * determinant[l];
    batch.gamma[l] = std::fabs(six * determinant[l]) / (areas[l] * std::sqrt(squared_centre[l]));
    batch.sicn[l] = six / std::sqrt(squared_edges[l] * squared_areas[l]);
  });
}

}  // namespace

void CosineBatch::measure(std::span<const std::array<double, 3>> coordinates,
                          std::span<const std::array<std::uint32_t, 4>> tetrahedra) {
  // In a triangle whose angles have cosines up to the last, no side is 24 times as long as another;
  // so no edge is much shorter than the longest one, which alone is bounded.
  constexpr double kMaxSquared = 1e60, kMaxCosine = 0.999;
  constexpr double kMaxInverseArea = 1e150;  // infinite where a face has no area
  const std::size_t count = std::min(kLanes, tetrahedra.size());
  const Edges edges = edges_of(coordinates, tetrahedra.first(count));
  const Faces faces = faces_of(edges);
  Lanes cosine{};  // the largest, whatever its sign
  measure_faces(edges, *this, cosine);
  measure_dihedrals(faces, *this, cosine);
  measure_shapes(edges, faces, *this);
  const Lanes longest = largest_of(edges.squared), thinnest = largest_of(faces.inverse);
  for (std::size_t l = 0; l < kLanes; ++l) {
    ordinary[l] = l < count && longest[l] < kMaxSquared && longest[l] > 1 / kMaxSquared &&
                  cosine[l] < kMaxCosine && thinnest[l] < kMaxInverseArea;
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
