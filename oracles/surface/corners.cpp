#include "oracles/surface/corners.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "oracles/base/distances.h"

namespace tetproof::oracles {
namespace {

mpq_class squared_cosine(double degrees, Doubt doubt) {
  if (degrees == 90) return 0;
  if (degrees == 60) return mpq_class(1, 4);
  const double cosine = std::cos(degrees * (3.14159265358979323846 / 180));
  return mpq_class(cosine * cosine * (doubt == Doubt::acute ? 1 - 1e-9 : 1 + 1e-12));
}

// The sign of the turn where doubles tell, else 0. With U, V and N the sums of the sizes of the
// components of both directions and of the normal, the value is off by at most the error of each
// factor times the other two, and by 2^-50 UVN for roundings. All bounds are taken twice or more.
int surely_left(const ExactPoints& points, const IntervalVector& normal, Index v, Index p,
                Index q) {
  const Position &o = points.nearest(v), &a = points.nearest(p), &b = points.nearest(q);
  Position u{}, w{}, n{};
  double along_u = 0, along_w = 0, along_n = 0, width = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    u[i] = a[i] - o[i];
    w[i] = b[i] - o[i];
    n[i] = normal[i].middle();
    along_u += std::fabs(u[i]);
    along_w += std::fabs(w[i]);
    along_n += std::fabs(n[i]);
    width += normal[i].high - normal[i].low;
  }
  const double error_u = along_u * 0x1p-51 + 3 * points.difference_error();
  const double error_w = along_w * 0x1p-51 + 3 * points.difference_error();
  const double value = n[0] * (u[1] * w[2] - u[2] * w[1]) + n[1] * (u[2] * w[0] - u[0] * w[2]) +
                       n[2] * (u[0] * w[1] - u[1] * w[0]);
  const double error = 4 * (along_n + width) * ((along_u + error_u) * error_w + error_u * along_w) +
                       (4 * width + along_n * 0x1p-48) * along_u * along_w +
                       0x1p-900 * (1 + along_n);
  return value > error ? 1 : value < -error ? -1 : 0;
}

// For every vertex that is used.
std::size_t slots(const InputSurface& surface) {
  return surface.used_vertices().empty() ? 0 : std::size_t{surface.used_vertices().back()} + 1;
}

}  // namespace

// get_d() truncates the bound, by at most an ulp.
AngleBound::AngleBound(double degrees, Doubt doubt)
    : bound_(squared_cosine(degrees, doubt)),
      rough_bound_(Interval::around(bound_.get_d(), bound_.get_d())) {}

CornerThresholds thresholds_of(const delmesher::ExactRecord::Parameters& parameters) {
  const double acute = parameters.acute, corner = parameters.corner;
  return {acute, corner == 0 ? acute : std::min(acute, corner)};
}

int left_turn(const ExactPoints& points, const InputSurface::Facet& facet, Index v, Index p,
              Index q) {
  if (const int sign = surely_left(points, facet.rough_normal, v, p, q); sign != 0) return sign;
  const IntervalVector x = points.rough_difference(v, p), y = points.rough_difference(v, q);
  const IntervalVector c = exact::cross(x, y);
  if (const int sign = exact::dot(facet.rough_normal, c).sign(); sign != 2) return sign;
  return sgn(exact::dot(facet.normal(points), exact::cross(exact::difference(points, v, p),
                                                           exact::difference(points, v, q))));
}

AcuteCorners::AcuteCorners(const ExactPoints& points, const InputSurface& surface)
    : points_(points), surface_(surface), edges_at_(slots(surface)), triangles_at_(slots(surface)) {
  for (const InputSurface::Edge& edge : surface.edges()) {
    edges_at_.count(edge.from);
    edges_at_.count(edge.to);
  }
  for (const auto& triangle : surface.triangles()) {
    for (const Index v : triangle) triangles_at_.count(v);
  }
  edges_at_.allot();
  triangles_at_.allot();
  for (Index e = 0; e < surface.edges().size(); ++e) {
    edges_at_.put(surface.edges()[e].from, e);
    edges_at_.put(surface.edges()[e].to, e);
  }
  for (Index t = 0; t < surface.triangles().size(); ++t) {
    for (const Index v : surface.triangles()[t]) triangles_at_.put(v, t);
  }
}

const BoxTree& AcuteCorners::edge_tree() const {
  tree_once_([this] {
    std::vector<BoxTree::Box> boxes;
    boxes.reserve(surface_.edges().size());
    for (const InputSurface::Edge& edge : surface_.edges()) {
      boxes.push_back(box_around(points_, std::array{edge.from, edge.to}));
    }
    edge_tree_ = std::make_unique<BoxTree>(std::move(boxes));
  });
  return *edge_tree_;
}

bool AcuteCorners::edge_is_acute(Index e, const Present& present,
                                 const CornerThresholds& thresholds, Doubt doubt) const {
  const InputSurface::Edge& edge = surface_.edges()[e];
  if (!present(edge.left) || !present(edge.right)) return false;
  // The normals point away from each other where the facets enclose a sharp wedge, on either side.
  const IntervalVector &r = rough_normal(edge.left), &s = rough_normal(edge.right);
  const Interval rough_cosine = -exact::dot(r, s);
  if (rough_cosine.sign() == -1) return false;  // most are: making a bound takes longer
  const AngleBound bound(thresholds.with_facets, doubt);
  if (bound.surely_not_above(rough_cosine, exact::dot(r, r) * exact::dot(s, s))) return false;
  const ExactVector m = surface_.facets()[edge.left].normal(points_),
                    n = surface_.facets()[edge.right].normal(points_);
  const ExactNumber cosine = -exact::dot(m, n);
  if (cosine <= 0) return false;
  return bound.above(cosine, exact::squared(m) * exact::squared(n));
}

std::string AcuteCorners::why_acute(Index v, const Present& present,
                                    const CornerThresholds& thresholds, Doubt doubt) const {
  std::vector<Index> spokes;  // far ends of the edges present
  for (const Index e : edges_at_.of(v)) {
    const InputSurface::Edge& edge = surface_.edges()[e];
    if (!edge_present(edge, present)) continue;
    if (edge_is_acute(e, present, thresholds, doubt)) {
      return "facets at edge " + std::to_string(edge.from) + "-" + std::to_string(edge.to);
    }
    spokes.push_back(edge.from == v ? edge.to : edge.from);
  }
  const AngleBound of_edges(thresholds.of_edges, doubt), of_facets(thresholds.with_facets, doubt);
  for (std::size_t i = 0; i < spokes.size(); ++i) {
    const IntervalVector r = points_.rough_difference(v, spokes[i]);
    for (std::size_t j = 0; j < i; ++j) {
      const IntervalVector s = points_.rough_difference(v, spokes[j]);
      if (of_edges.surely_not_above(exact::dot(r, s), exact::dot(r, r) * exact::dot(s, s)))
        continue;
      if (exact::dot_sign(points_, v, spokes[i], spokes[j]) <= 0) continue;
      const ExactVector a = exact::difference(points_, v, spokes[i]);
      const ExactVector b = exact::difference(points_, v, spokes[j]);
      if (of_edges.above(exact::dot(a, b), exact::squared(a) * exact::squared(b))) {
        return "edges to " + std::to_string(spokes[i]) + " and " + std::to_string(spokes[j]);
      }
    }
  }
  for (const Index spoke : spokes) {
    if (edge_meets_facet(v, spoke, present, of_facets)) {
      return "the edge to " + std::to_string(spoke) + " and a facet";
    }
  }
  return {};
}

// The projection of the edge onto the facet has to begin inside a triangle of it, or on a flat edge
// of one.
bool AcuteCorners::edge_meets_facet(Index v, Index to, const Present& present,
                                    const AngleBound& bound) const {
  const IntervalVector rough = points_.rough_difference(v, to);
  for (const Index t : triangles_at_.of(v)) {
    const Index f = surface_.facet_of_triangle()[t];
    if (!present(f)) continue;
    const auto& corner = surface_.triangles()[t];
    const int i = static_cast<int>(std::find(corner.begin(), corner.end(), v) - corner.begin());
    const Index p = corner[(i + 1) % 3], q = corner[(i + 2) % 3];
    if (p == to || q == to) continue;
    const Interval rough_height = exact::dot(rough_normal(f), rough);
    const Interval rough_norms =
        exact::dot(rough_normal(f), rough_normal(f)) * exact::dot(rough, rough);
    if (bound.surely_not_beyond(rough_norms - rough_height * rough_height, rough_norms)) continue;
    const int after = left_turn(points_, surface_.facets()[f], v, p, to),
              before = left_turn(points_, surface_.facets()[f], v, to, q);
    if (after < 0 || (after == 0 && !is_flat(t, i))) continue;
    if (before < 0 || (before == 0 && !is_flat(t, (i + 2) % 3))) continue;
    if (after <= 0 && before <= 0) continue;
    const ExactVector d = exact::difference(points_, v, to);
    const ExactVector n = surface_.facets()[f].normal(points_);
    const ExactNumber height = exact::dot(n, d), norms = exact::squared(n) * exact::squared(d);
    if (bound.beyond(norms - height * height, norms)) return true;
  }
  return false;
}

std::vector<Index> AcuteCorners::edges_near(std::span<const Index> vertices,
                                            double distance) const {
  BoxTree::Box box = box_around(points_, vertices);
  for (int axis = 0; axis < 3; ++axis) {
    box.low[axis] -= distance;
    box.high[axis] += distance;
  }
  std::vector<Index> found;
  edge_tree().query(box, found);
  return found;
}

template <class Visit>
void AcuteCorners::boundary_near(Index v, double distance, const Present& present,
                                 Visit visit) const {
  std::vector<Index> facets;
  for (const Index e : edges_at_.of(v)) {
    for (const Index f : {surface_.edges()[e].left, surface_.edges()[e].right}) {
      if (present(f)) facets.push_back(f);
    }
  }
  const auto here = [&](Index f) {
    return std::find(facets.begin(), facets.end(), f) != facets.end();
  };
  for (const Index e : edges_near(std::array{v}, distance)) {
    const InputSurface::Edge& edge = surface_.edges()[e];
    if (edge.from == v || edge.to == v || (!here(edge.left) && !here(edge.right))) continue;
    visit(e, squared_distance_to_segment(points_, v, edge.from, edge.to));
  }
}

std::string AcuteCorners::nearer_than(double distance, Index v, const Present& present) const {
  std::string name;
  boundary_near(v, distance, present, [&](Index e, const mpq_class& squared) {
    if (!name.empty() || square_root(squared, points_.exponent()) >= distance) return;
    name = "edge " + std::to_string(surface_.edges()[e].from) + "-" +
           std::to_string(surface_.edges()[e].to);
  });
  return name;
}

double AcuteCorners::local_feature_size(Index v, const Present& present, double most) const {
  double smallest = most;
  boundary_near(v, most, present, [&](Index, const mpq_class& squared) {
    smallest = std::min(smallest, square_root(squared, points_.exponent()));
  });
  return smallest;
}

double AcuteCorners::distance_to_rest(Index e, Index facet, double most) const {
  const auto [from, to, left, right] = surface_.edges()[e];
  double smallest = most;
  for (const Index other : edges_near(std::array{from, to}, most)) {
    const InputSurface::Edge& edge = surface_.edges()[other];
    if (edge.left != facet && edge.right != facet) continue;
    for (const Index v : {edge.from, edge.to}) {
      if (v == from || v == to) continue;
      const mpq_class squared = squared_distance_to_segment(points_, v, from, to);
      smallest = std::min(smallest, square_root(squared, points_.exponent()));
    }
  }
  return smallest;
}

double AcuteCorners::distance_to_link(Index v, const Present& present) const {
  double smallest = std::numeric_limits<double>::infinity();
  for (const Index t : triangles_at_.of(v)) {
    if (!present(surface_.facet_of_triangle()[t])) continue;
    const auto& corner = surface_.triangles()[t];
    const int i = static_cast<int>(std::find(corner.begin(), corner.end(), v) - corner.begin());
    const mpq_class squared =
        squared_distance_to_segment(points_, v, corner[(i + 1) % 3], corner[(i + 2) % 3]);
    smallest = std::min(smallest, square_root(squared, points_.exponent()));
  }
  return smallest;
}

}  // namespace tetproof::oracles
