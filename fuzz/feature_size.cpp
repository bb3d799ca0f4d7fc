#include "fuzz/feature_size.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fuzz/stages.h"
#include "oracles/base/distances.h"

namespace tetproof::fuzz {

using oracles::Index;

namespace {

// The largest relative error of box distances in doubles.
constexpr double kRoundings = 0x1p-50;

// A lower bound for the distance of contents of the boxes: the largest gap along an axis.
double gap(const oracles::BoxTree::Box& a, const oracles::BoxTree::Box& b) {
  double widest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    widest = std::max({widest, a.low[i] - b.high[i], b.low[i] - a.high[i]});
  }
  return widest * (1 - kRoundings);
}

}  // namespace

// The closest pair so far.
struct FeatureSizes::Nearest {
  const FeatureSizes& sizes;
  mpq_class squared = -1;  // in integer units; negative: none
  double length = std::numeric_limits<double>::infinity();

  bool may_be(const Box& a, const Box& b) const { return gap(a, b) <= length * (1 + kRoundings); }
  void take(const mpq_class& found) {
    if (found < 0 || (squared >= 0 && found >= squared)) return;
    squared = found;
    length = sizes.length_of(found);
  }
};

std::string FeatureSizes::assign(const delmesher::Surface& surface) {
  const oracles::Polyhedron polyhedron = {surface.vertices, surface.triangles, surface.labels, {}};
  if (std::string refusal = points_.assign(surface.vertices); !refusal.empty()) return refusal;
  if (std::string refusal = surface_.assign(polyhedron, points_); !refusal.empty()) return refusal;
  facet_vertices_.assign(surface_.facets().size(), {});
  for (Index t = 0; t < surface_.triangles().size(); ++t) {
    auto& list = facet_vertices_[surface_.facet_of_triangle()[t]];
    list.insert(list.end(), surface_.triangles()[t].begin(), surface_.triangles()[t].end());
  }
  for (auto& list : facet_vertices_) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  return {};
}

double FeatureSizes::length_of(const mpq_class& squared) const {
  mpf_class root(squared, 256);
  root = sqrt(root);
  long exponent = 0;
  const double digits = mpf_get_d_2exp(&exponent, root.get_mpf_t());
  return std::ldexp(digits, static_cast<int>(exponent + points_.exponent()));
}

FeatureSizes::Box FeatureSizes::box(std::initializer_list<Index> corners) const {
  Box result = {points_.nearest(*corners.begin()), points_.nearest(*corners.begin())};
  for (const Index v : corners) {
    for (std::size_t i = 0; i < 3; ++i) {
      result.low[i] = std::min(result.low[i], points_.nearest(v)[i]);
      result.high[i] = std::max(result.high[i], points_.nearest(v)[i]);
    }
  }
  return result;
}

bool FeatureSizes::touches(Index vertex, Index facet) const {
  return std::binary_search(facet_vertices_[facet].begin(), facet_vertices_[facet].end(), vertex);
}

bool FeatureSizes::facets_touch(Index triangle, Index other) const {
  const Index f = surface_.facet_of_triangle()[triangle], g = surface_.facet_of_triangle()[other];
  return std::any_of(facet_vertices_[f].begin(), facet_vertices_[f].end(),
                     [&](Index v) { return touches(v, g); });
}

// Examines the pairs of a vertex with a vertex, an edge or a facet.
void FeatureSizes::examine_vertices(Nearest& nearest) const {
  const std::vector<Index>& used = surface_.used_vertices();
  for (const Index v : used) {
    const Box at = box({v});
    for (const Index w : used) {
      if (w <= v || !nearest.may_be(at, box({w}))) continue;
      nearest.take(oracles::exact::squared(oracles::exact::difference(points_, v, w)).rational());
    }
    for (const auto& edge : surface_.edges()) {
      if (v == edge.from || v == edge.to || !nearest.may_be(at, box({edge.from, edge.to}))) {
        continue;
      }
      nearest.take(oracles::squared_distance_to_segment(points_, v, edge.from, edge.to));
    }
    for (Index t = 0; t < surface_.triangles().size(); ++t) {
      const auto& [a, b, c] = surface_.triangles()[t];
      if (touches(v, surface_.facet_of_triangle()[t]) || !nearest.may_be(at, box({a, b, c}))) {
        continue;
      }
      nearest.take(oracles::squared_distance_to_face(points_, v, surface_.triangles()[t]));
    }
  }
}

void FeatureSizes::examine_edges(Nearest& nearest) const {
  const auto& edges = surface_.edges();
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const auto [a, b] = std::pair(edges[i].from, edges[i].to);
    const Box around = box({a, b});
    for (std::size_t j = 0; j < i; ++j) {
      const auto [c, d] = std::pair(edges[j].from, edges[j].to);
      if (a == c || a == d || b == c || b == d) continue;
      if (!nearest.may_be(around, box({c, d}))) continue;
      nearest.take(oracles::squared_distance_inside(points_, a, b, c, d));
    }
  }
}

double FeatureSizes::smallest() const {
  Nearest nearest{*this};
  examine_vertices(nearest);
  examine_edges(nearest);
  return nearest.length;
}

bool FeatureSizes::closer(Index triangle, Index other, double distance) const {
  const auto &s = surface_.triangles()[triangle], &t = surface_.triangles()[other];
  if (gap(box({s[0], s[1], s[2]}), box({t[0], t[1], t[2]})) >= distance) return false;
  Nearest nearest{*this};
  for (std::size_t i = 0; i < 3; ++i) {
    nearest.take(oracles::squared_distance_to_face(points_, s[i], t));
    nearest.take(oracles::squared_distance_to_face(points_, t[i], s));
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = s[i], b = s[(i + 1) % 3], c = t[k], d = t[(k + 1) % 3];
      nearest.take(oracles::squared_distance_to_segment(points_, a, c, d));
      nearest.take(oracles::squared_distance_to_segment(points_, c, a, b));
      nearest.take(oracles::squared_distance_inside(points_, a, b, c, d));
    }
  }
  return nearest.length < distance;
}

bool roomy(const delmesher::Surface& surface, double share) {
  FeatureSizes sizes;
  return sizes.assign(surface).empty() && sizes.smallest() > sizes.largest_coordinate() * share;
}

}  // namespace tetproof::fuzz
