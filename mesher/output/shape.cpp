#include "mesher/output/shape.h"

#include <algorithm>
#include <cmath>

namespace delmesher::output {
namespace {

constexpr double kDegrees = 57.29577951308232;  // per radian
// Beyond this ratio of longest to shortest edge, products of four lengths could underflow.
constexpr int kComparableExponents = 200;

Vec3 minus(const Vec3& u) {
  return {-u[0], -u[1], -u[2]};
}

// b - a, halved: the difference of two finite doubles may overflow, half of it does not. Halving
// loses at most the last bit of denormals.
Vec3 half_difference(const Vec3& a, const Vec3& b) {
  return {0.5 * b[0] - 0.5 * a[0], 0.5 * b[1] - 0.5 * a[1], 0.5 * b[2] - 0.5 * a[2]};
}

// The vector times a power of two that brings its largest component into [1/2, 1); 0 stays 0.
Vec3 normalized(const Vec3& u) {
  int exponent = 0;
  std::frexp(largest_component(u), &exponent);
  return times_power_of_two(u, -exponent);
}

// In [0, 180]; 0 if both arguments are 0.
double angle(double sine, double cosine) {
  return std::min(180.0, std::atan2(sine, cosine) * kDegrees);
}

// Index in kEdges of the edge between two vertices of a tetrahedron.
int edge_index(int i, int j) {
  static constexpr int kIndex[4][4] = {{-1, 0, 1, 2}, {0, -1, 3, 4}, {1, 3, -1, 5}, {2, 4, 5, -1}};
  return kIndex[i][j];
}

// The vector from vertex i to vertex j.
Vec3 edge_vector(const Shape& shape, int i, int j) {
  const Vec3& e = shape.edge[edge_index(i, j)];
  return i < j ? e : minus(e);
}

// Twice the area vector of face f, from the two shorter edges: the cross product of two long,
// nearly parallel edges of a needle would lose digits (Shewchuk 2013).
Vec3 face_normal(const Shape& shape, int f) {
  const auto [a, b, c] = kFaces[f];
  const double ab = shape.squared_length[edge_index(a, b)];
  const double bc = shape.squared_length[edge_index(b, c)];
  const double ca = shape.squared_length[edge_index(c, a)];
  if (ab >= bc && ab >= ca) return cross(edge_vector(shape, b, c), edge_vector(shape, c, a));
  if (bc >= ca) return cross(edge_vector(shape, c, a), edge_vector(shape, a, b));
  return cross(edge_vector(shape, a, b), edge_vector(shape, b, c));
}

// The vertex with the shortest edges: from there, for the same reason.
int base_vertex(const Shape& shape) {
  int base = 0;
  double best = INFINITY;
  for (int i = 0; i < 4; ++i) {
    double sum = 0;
    for (int j = 0; j < 4; ++j) {
      if (j != i) sum += shape.squared_length[edge_index(i, j)];
    }
    if (sum < best) {
      best = sum;
      base = i;
    }
  }
  return base;
}

// With a common scale, all six share the volume and the normals:
// |n_f| |n_g| sin = 6 V |edge|, |n_f| |n_g| cos = -n_f . n_g for outward normals.
std::array<double, 6> comparable_dihedrals(const Shape& shape, double volume) {
  std::array<Vec3, 4> normal;
  for (int f = 0; f < 4; ++f) normal[f] = face_normal(shape, f);
  std::array<double, 6> result;
  for (int e = 0; e < 6; ++e) {
    // The faces at edge ij are opposite the two other vertices, which are the ends of edge 5 - e.
    const double cosine = -dot(normal[kEdges[5 - e][0]], normal[kEdges[5 - e][1]]);
    result[e] = angle(volume * std::sqrt(shape.squared_length[e]), cosine);
  }
  return result;
}

// The dihedral angle at an edge does not change if each edge from one of its ends is scaled alone.
std::array<double, 6> incomparable_dihedrals(const Shape& shape) {
  std::array<double, 6> result;
  for (int e = 0; e < 6; ++e) {
    const auto [d, c] = kEdges[e];
    const auto [a, b] = kEdges[5 - e];
    const Vec3 along = edge_vector(shape, d, c);
    const Vec3 na = cross(edge_vector(shape, d, a), along);
    const Vec3 nb = cross(edge_vector(shape, d, b), along);
    const double volume = std::fabs(dot(edge_vector(shape, d, a), nb));
    result[e] = angle(volume * norm(along), dot(na, nb));
  }
  return result;
}

}  // namespace

Shape make_shape(std::span<const Vec3> coordinates,
                 const std::array<std::uint32_t, 4>& tetrahedron) {
  Shape shape;
  double longest = 0, shortest = INFINITY;
  for (int e = 0; e < 6; ++e) {
    shape.edge[e] = half_difference(coordinates[tetrahedron[kEdges[e][0]]],
                                    coordinates[tetrahedron[kEdges[e][1]]]);
    const double size = largest_component(shape.edge[e]);
    longest = std::max(longest, size);
    if (size > 0) shortest = std::min(shortest, size);
  }
  int high = 0, low = 0;
  std::frexp(longest, &high);
  if (longest > 0) std::frexp(shortest, &low);
  shape.comparable = longest == 0 || high - low < kComparableExponents;
  const bool in_range = longest == 0 || (high > -100 && high < 100);
  for (int e = 0; e < 6; ++e) {
    if (!shape.comparable) {
      shape.edge[e] = normalized(shape.edge[e]);
    } else if (!in_range) {
      shape.edge[e] = times_power_of_two(shape.edge[e], -high);
    }
    shape.squared_length[e] = dot(shape.edge[e], shape.edge[e]);
  }
  return shape;
}

double volume_term(const Shape& shape) {
  const int base = base_vertex(shape);
  const auto [a, b, c] = kFaces[base];
  return dot(cross(edge_vector(shape, base, a), edge_vector(shape, base, b)),
             edge_vector(shape, base, c));
}

// The radius of the inscribed sphere is the volume term over the sum of the doubled areas.
Quality quality(const Shape& shape) {
  Quality result;
  const double volume = volume_term(shape);
  if (!shape.comparable || volume == 0) return result;
  const int base = base_vertex(shape);
  double areas = 0, squared_areas = 0, squared_edges = 0, longest = 0;
  Vec3 centre{};  // from the base to that of the circumsphere, times twice the volume term
  for (int f = 0; f < 4; ++f) {
    const Vec3 normal = face_normal(shape, f);
    squared_areas += dot(normal, normal);
    areas += norm(normal);
    if (f == base) continue;
    // The face opposite to the end of this edge.
    const double square = shape.squared_length[edge_index(base, f)];
    for (int k = 0; k < 3; ++k) centre[k] += square * normal[k];
  }
  for (const double square : shape.squared_length) {
    squared_edges += square;
    longest = std::max(longest, square);
  }
  const double size = std::fabs(volume);
  // The radius is at least half the longest edge, whatever rounding makes of the centre.
  const double diameter = std::max(norm(centre), size * std::sqrt(longest));
  result.gamma = std::min(1.0, 6 * (size / areas) * (size / diameter));
  result.sicn = 6 * volume / std::sqrt(squared_edges * squared_areas);
  return result;
}

std::array<double, 3> face_angles(const Shape& shape, int f) {
  std::array<double, 3> result;
  const double area = shape.comparable ? norm(face_normal(shape, f)) : 0;
  for (int i = 0; i < 3; ++i) {
    const int p = kFaces[f][i];
    const Vec3 u = edge_vector(shape, p, kFaces[f][(i + 1) % 3]);
    const Vec3 v = edge_vector(shape, p, kFaces[f][(i + 2) % 3]);
    // Edges at different scales do not share one area, but their directions are right.
    result[i] = angle(shape.comparable ? area : norm(cross(u, v)), dot(u, v));
  }
  return result;
}

std::array<double, 6> dihedral_angles(const Shape& shape) {
  return shape.comparable ? comparable_dihedrals(shape, std::fabs(volume_term(shape)))
                          : incomparable_dihedrals(shape);
}

}  // namespace delmesher::output
