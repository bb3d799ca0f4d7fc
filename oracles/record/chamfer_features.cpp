#include "oracles/record/chamfer_features.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "oracles/base/distances.h"
#include "oracles/mesh/angles.h"
#include "oracles/record/filter.h"

namespace tetproof::oracles {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

// In radians. From exact vectors, so that small angles are right as well, and those of normals
// whose products are not doubles.
double angle_between(const ExactVector& a, const ExactVector& b) {
  return exact_angle(exact::squared(exact::cross(a, b)), exact::dot(a, b)) * std::numbers::pi / 180;
}

}  // namespace

// The height of a bridge point over its edge, as a share of the chamfer distance, by the formula
// for three equal edges (Figure 4). Sectors above 120 degrees are cut into two, above 240 into
// four; those of triangles are not.
double ChamferFeatures::step_of(double sector) const {
  constexpr double kThird = 2 * std::numbers::pi / 3 + 1e-9;
  const double parts = shape_.per_triangle || sector <= kThird ? 1 : sector <= 2 * kThird ? 2 : 4;
  const double half = sector / parts / 2;
  return std::sin(half) / (std::cos(half) + 0.5);
}

double ChamferFeatures::distance(Index v, const AcuteCorners::Present& present) const {
  double most = kInfinite;
  for (const Index e : corners_.edges_at(v)) {
    const InputSurface::Edge& edge = surface_.edges()[e];
    if (AcuteCorners::edge_present(edge, present)) {
      most = std::min(most, exact::distance(points_, edge.from, edge.to));
    }
  }
  const double third = (shape_.to_link ? corners_.distance_to_link(v, present)
                                       : corners_.local_feature_size(v, present, most)) /
                       3;
  return shape_.limit > 0 ? std::min(third, shape_.limit) : third;
}

// A sector begins at a side of a facet that leaves the vertex, and consists of the triangles up to
// the next side; or every triangle is one.
std::vector<ChamferFeatures::Sector> ChamferFeatures::sectors(
    Index v, const AcuteCorners::Present& present) const {
  const auto& triangles = surface_.triangles();
  const auto& facet_of = surface_.facet_of_triangle();
  const auto corner = [&](Index t) {
    return static_cast<int>(std::find(triangles[t].begin(), triangles[t].end(), v) -
                            triangles[t].begin());
  };
  std::vector<Sector> list;
  for (Index t : corners_.triangles_at(v)) {
    const Index f = facet_of[t];
    if (!present(f)) continue;
    if (!shape_.per_triangle && facet_of[surface_.neighbour(t, corner(t))] == f) continue;
    double angle = 0;
    for (;;) {
      const int i = corner(t);
      angle += angle_between(exact::difference(points_, v, triangles[t][(i + 1) % 3]),
                             exact::difference(points_, v, triangles[t][(i + 2) % 3]));
      const Index next = surface_.neighbour(t, (i + 2) % 3);
      if (shape_.per_triangle || facet_of[next] != f) break;
      t = next;
    }
    list.push_back({f, angle});
  }
  return list;
}

double ChamferFeatures::step(Index v, Index facet, const AcuteCorners::Present& present) const {
  double smallest = kInfinite;
  for (const Sector& sector : sectors(v, present)) {
    if (sector.facet == facet) smallest = std::min(smallest, step_of(sector.angle));
  }
  return smallest;
}

Index ChamferFeatures::triangle_beside(Index e, Index facet) const {
  const InputSurface::Edge& edge = surface_.edges()[e];
  for (const Index t : corners_.triangles_at(edge.from)) {
    const auto& corner = surface_.triangles()[t];
    if (surface_.facet_of_triangle()[t] == facet &&
        std::find(corner.begin(), corner.end(), edge.to) != corner.end()) {
      return t;
    }
  }
  return kNone;
}

// All bridge points in a triangle with an acute edge are as high as the lowest.
double ChamferFeatures::strip_in_triangle(Index t, const AcuteCorners::Present& present) const {
  const auto& corner = surface_.triangles()[t];
  double height = kInfinite;
  for (int i = 0; i < 3; ++i) {
    const Index v = corner[i];
    if (corners_.why_acute(v, present, thresholds_, Doubt::acute).empty()) continue;
    const double angle = angle_between(exact::difference(points_, v, corner[(i + 1) % 3]),
                                       exact::difference(points_, v, corner[(i + 2) % 3]));
    height = std::min(height, step_of(angle) * distance(v, present));
  }
  return height;
}

double ChamferFeatures::strip(Index e, Index facet, const AcuteCorners::Present& present) const {
  const InputSurface::Edge& edge = surface_.edges()[e];
  const Index beside = shape_.to_link ? triangle_beside(e, facet) : kNone;
  if (shape_.per_triangle) {
    const double height = strip_in_triangle(beside, present);
    return shape_.limit > 0 ? std::min(height, shape_.limit) : height;
  }
  double height = kInfinite;
  for (const Index v : {edge.from, edge.to}) {
    height = std::min(height, step(v, facet, present) * distance(v, present));
    // At most a third of the distance to the rest of the facet's boundary.
    for (const Index other : {edge.from, edge.to}) {
      const AcuteCorners::Present only = [facet](Index f) { return f == facet; };
      height = std::min(height, corners_.local_feature_size(other, only, 3 * height) / 3);
    }
  }
  height = std::min(height, corners_.distance_to_rest(e, facet, 3 * height) / 3);
  if (shape_.to_link) {
    for (const Index v : surface_.triangles()[beside]) {
      if (v == edge.from || v == edge.to) continue;
      const mpq_class squared = squared_distance_to_segment(points_, v, edge.from, edge.to);
      height = std::min(height, square_root(squared, points_.exponent()) / 3);
    }
  }
  return shape_.limit > 0 ? std::min(height, shape_.limit) : height;
}

// The borders run from one end's cut points to the other's.
void ChamferFeatures::add_strips(Index e, const AcuteCorners::Present& present,
                                 std::vector<Feature>& list) const {
  const InputSurface::Edge& edge = surface_.edges()[e];
  const double length = exact::distance(points_, edge.from, edge.to) -
                        distance(edge.from, present) - distance(edge.to, present);
  const double wedge =
      std::numbers::pi - angle_between(surface_.facets()[edge.left].normal(points_),
                                       surface_.facets()[edge.right].normal(points_));
  for (const Index f : {edge.left, edge.right}) {
    const double height = strip(e, f, present);
    const double gap = std::min(height, 2 * height * std::sin(wedge / 2));
    list.push_back({gap, length / gap, {edge.left, edge.right, kNone, kNone}});
  }
}

// The edges at a vertex from their cut points on: how near they are to each other, and to facets.
void ChamferFeatures::add_edges(Index v, const AcuteCorners::Present& present,
                                std::vector<Feature>& list) const {
  const double d = distance(v, present);
  std::vector<Index> spokes, edges;
  for (const Index e : corners_.edges_at(v)) {
    const InputSurface::Edge& edge = surface_.edges()[e];
    if (!AcuteCorners::edge_present(edge, present)) continue;
    spokes.push_back(edge.from == v ? edge.to : edge.from);
    edges.push_back(e);
  }
  for (std::size_t i = 0; i < spokes.size(); ++i) {
    const InputSurface::Edge& edge = surface_.edges()[edges[i]];
    const ExactVector a = exact::difference(points_, v, spokes[i]);
    const double length = exact::distance(points_, v, spokes[i]);
    for (std::size_t j = 0; j < i; ++j) {
      const double angle = angle_between(a, exact::difference(points_, v, spokes[j]));
      const double both = std::min(length, exact::distance(points_, v, spokes[j]));
      const double widening = std::sin(std::min(angle, std::numbers::pi / 2));
      const InputSurface::Edge& other = surface_.edges()[edges[j]];
      list.push_back({2 * d * std::sin(angle / 2),
                      std::log(both / d) / widening,
                      {edge.left, edge.right, other.left, other.right}});
    }
    // The distance from a facet that the edge does not bound, if it projects into a triangle of it.
    for (const Index t : corners_.triangles_at(v)) {
      const Index f = surface_.facet_of_triangle()[t];
      const auto& corner = surface_.triangles()[t];
      if (!present(f) || std::find(corner.begin(), corner.end(), spokes[i]) != corner.end())
        continue;
      const int k = static_cast<int>(std::find(corner.begin(), corner.end(), v) - corner.begin());
      const ExactVector n = surface_.facets()[f].normal(points_);
      const auto left = [&](const ExactVector& x, const ExactVector& y) {
        return sgn(exact::dot(n, exact::cross(x, y)));
      };
      if (left(exact::difference(points_, v, corner[(k + 1) % 3]), a) < 0 ||
          left(a, exact::difference(points_, v, corner[(k + 2) % 3])) < 0) {
        continue;
      }
      const double angle = std::fabs(std::numbers::pi / 2 - angle_between(a, n));
      list.push_back({d * std::sin(angle),
                      std::log(length / d) / std::sin(angle),
                      {edge.left, edge.right, f, kNone}});
    }
  }
}

std::vector<ChamferFeatures::Feature> ChamferFeatures::at(
    Index v, const AcuteCorners::Present& present) const {
  if (corners_.why_acute(v, present, thresholds_, Doubt::acute).empty()) return {};
  const double d = distance(v, present);
  std::vector<Feature> list = {{.size = d, .times = 0}};
  for (const Sector& sector : sectors(v, present)) {
    list.push_back({d * step_of(sector.angle), 0, {sector.facet, kNone, kNone, kNone}});
  }
  for (const Index e : corners_.edges_at(v)) {
    if (AcuteCorners::edge_present(surface_.edges()[e], present) &&
        corners_.edge_is_acute(e, present, thresholds_, Doubt::acute)) {
      add_strips(e, present, list);
    }
  }
  add_edges(v, present, list);
  return list;
}

}  // namespace tetproof::oracles
