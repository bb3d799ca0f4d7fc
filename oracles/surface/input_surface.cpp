#include "oracles/surface/input_surface.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "oracles/base/distances.h"
#include "oracles/base/union_find.h"
#include "oracles/base/vectors.h"

namespace tetproof::oracles {
namespace {

struct DirectedEdge {
  Index low, high;  // sorted ends
  Index triangle;
  int corner;  // the edge leaves this corner
  bool forward;
  bool operator<(const DirectedEdge& other) const {
    return std::pair(low, high) < std::pair(other.low, other.high);
  }
};

std::string edge_name(Index a, Index b) {
  return "edge " + std::to_string(a) + "-" + std::to_string(b);
}

// Is the angle between the normals of two triangles acute?
bool same_way(const ExactPoints& points, const std::array<Index, 3>& s,
              const std::array<Index, 3>& t) {
  const int rough = exact::dot(exact::rough_area2(points, s[0], s[1], s[2]),
                               exact::rough_area2(points, t[0], t[1], t[2]))
                        .sign();
  if (rough != 2) return rough > 0;
  return exact::dot(exact::area2(points, s[0], s[1], s[2]),
                    exact::area2(points, t[0], t[1], t[2])) > 0;
}

// By intervals where these are narrow, as they are unless the largest triangle is a needle.
IntervalVector rough_normal_of(const InputSurface::Facet& facet, const ExactPoints& points) {
  if (!facet.sum) {
    IntervalVector area = exact::rough_area2(points, facet.span[0], facet.span[1], facet.span[2]);
    double size = 0, width = 0;
    for (const Interval& x : area) {
      size = std::max(size, std::fabs(x.middle()));
      width = std::max(width, x.high - x.low);
    }
    if (width <= 0x1p-48 * size) return area;
  }
  const ExactVector normal = facet.area2(points);
  IntervalVector result;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double x = to_double(normal[axis], 2 * points.exponent());
    result[axis] = Interval::around(x, x);
  }
  return result;
}

}  // namespace

std::pair<Index, int> InputSurface::Facet::plane_of(const ExactPoints& points) const {
  const Index plane = sum ? kNone : points.common_plane(span);
  if (plane == kNone) return {kNone, 0};
  const ExactVector normal = points.normal_of(plane);
  IntervalVector rough;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double x = to_double(normal[axis], 0);
    rough[axis] = Interval::around(x, x);
  }
  const int turned = exact::dot(rough, rough_normal).sign();
  return {plane, turned == 2 ? 0 : turned};
}

ExactVector InputSurface::Facet::normal(const ExactPoints& points) const {
  const auto [plane, turned] = plane_of(points);
  if (turned == 0) return area2(points);
  const ExactVector normal = points.normal_of(plane);
  return turned > 0 ? normal : ExactVector{-normal[0], -normal[1], -normal[2]};
}

ExactVector InputSurface::Facet::area2(const ExactPoints& points) const {
  return sum ? *sum : exact::area2(points, span[0], span[1], span[2]);
}

int InputSurface::Facet::side(const ExactPoints& points, Index v) const {
  if (v == span[0]) return 0;
  const int rough = exact::dot(rough_normal, points.rough_difference(span[0], v)).sign();
  if (rough != 2) return rough;
  if (sum) return sgn(exact::dot(*sum, exact::difference(points, span[0], v)));
  if (v == span[1] || v == span[2] || points.is_combination(v, span)) return 0;
  if (const auto [plane, turned] = plane_of(points); turned != 0) {
    return points.is_defined_on(v, plane) ? 0 : turned * points.side_of(plane, v);
  }
  return exact::orient3d(points, span[0], span[1], span[2], v);
}

int InputSurface::Facet::facing(const ExactPoints& points,
                                const std::array<Index, 3>& triangle) const {
  const auto& [a, b, c] = triangle;
  const int rough = exact::dot(rough_normal, exact::rough_area2(points, a, b, c)).sign();
  if (rough != 2) return rough;
  return sgn(exact::dot(normal(points), exact::area2(points, a, b, c)));
}

std::string InputSurface::assign(const Polyhedron& polyhedron, const ExactPoints& points) {
  triangles_ = polyhedron.triangles;
  if (triangles_.empty()) return "the surface has no triangles";
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    for (const Index v : triangles_[t]) {
      if (v >= polyhedron.vertices.size()) {
        return "triangle " + std::to_string(t) + " refers to vertex " + std::to_string(v);
      }
    }
  }
  if (std::string why = find_neighbours(); !why.empty()) return why;
  measure(points);
  orient_components(points);
  build_facets(polyhedron, points);
  build_edges();
  volume6_ = sum_from_origin6(points, triangles_);
  if (volume6_.sign() <= 0) return "the surface encloses no volume";
  return {};
}

std::string InputSurface::find_neighbours() {
  std::vector<DirectedEdge> edges;
  edges.reserve(3 * triangles_.size());
  for (Index t = 0; t < triangles_.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const Index a = triangles_[t][i], b = triangles_[t][(i + 1) % 3];
      if (a == b) return "triangle " + std::to_string(t) + " repeats vertex " + std::to_string(a);
      edges.push_back({std::min(a, b), std::max(a, b), t, i, a < b});
    }
  }
  std::sort(edges.begin(), edges.end());
  neighbours_.assign(triangles_.size(), {kNone, kNone, kNone});
  for (std::size_t i = 0; i < edges.size(); i += 2) {
    const DirectedEdge& e = edges[i];
    if (i + 1 >= edges.size() || e < edges[i + 1]) return edge_name(e.low, e.high) + " is open";
    const DirectedEdge& f = edges[i + 1];
    if (i + 2 < edges.size() && !(e < edges[i + 2])) {
      return edge_name(e.low, e.high) + " has more than two triangles";
    }
    if (e.forward == f.forward) {
      return edge_name(e.low, e.high) + " is not consistently oriented";
    }
    neighbours_[e.triangle][e.corner] = f.triangle;
    neighbours_[f.triangle][f.corner] = e.triangle;
  }
  return {};
}

void InputSurface::measure(const ExactPoints& points) {
  used_vertices_.clear();
  for (const auto& triangle : triangles_) {
    used_vertices_.insert(used_vertices_.end(), triangle.begin(), triangle.end());
  }
  std::sort(used_vertices_.begin(), used_vertices_.end());
  used_vertices_.erase(std::unique(used_vertices_.begin(), used_vertices_.end()),
                       used_vertices_.end());
  used_vertices_.shrink_to_fit();
  std::vector<BoxTree::Box> boxes(triangles_.size());
  Box all;
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    boxes[t] = box_around(points, triangles_[t]);
    for (const Index v : triangles_[t]) all.add(points.nearest(v));
  }
  largest_coordinate_ = all.largest();
  diagonal_ = all.diagonal();
  tree_ = std::make_shared<const BoxTree>(std::move(boxes));
  parts_ = std::make_shared<const RayParts>(points, triangles_);
}

std::vector<std::vector<Index>> InputSurface::components() const {
  std::vector<std::vector<Index>> result;
  std::vector<bool> seen(triangles_.size(), false);
  for (Index seed = 0; seed < triangles_.size(); ++seed) {
    if (seen[seed]) continue;
    std::vector<Index>& component = result.emplace_back(1, seed);
    seen[seed] = true;
    for (std::size_t i = 0; i < component.size(); ++i) {
      for (const Index n : neighbours_[component[i]]) {
        if (!seen[n]) component.push_back(n);
        seen[n] = true;
      }
    }
  }
  return result;
}

// A component is turned if the parity of the crossings above one of its triangles says that the
// solid lies on its front side. Parity itself does not depend on orientations.
void InputSurface::orient_components(const ExactPoints& points) {
  for (const std::vector<Index>& component : components()) {
    for (const Index t : component) {
      const auto& [a, b, c] = triangles_[t];
      const int up = sgn(exact::area2(points, a, b, c)[2]);
      if (up == 0) continue;
      const RayCrossings above =
          crossings_above(points, triangles_, *tree_, *parts_, triangles_[t], t);
      if (above.on_triangle) continue;
      if ((above.count % 2 == 0) != (up > 0)) {
        for (const Index f : component) std::swap(triangles_[f][1], triangles_[f][2]);
        for (const Index f : component) std::swap(neighbours_[f][0], neighbours_[f][2]);
      }
      break;
    }
  }
}

void InputSurface::build_facets(const Polyhedron& polyhedron, const ExactPoints& points) {
  const auto label = [&](Index t) { return polyhedron.labels.empty() ? 0 : polyhedron.labels[t]; };
  UnionFind groups(triangles_.size());
  unite_polygons(polyhedron, points, [&](Index a, Index b) { groups.unite(a, b); });
  for (Index t = 0; t < triangles_.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const Index n = neighbours_[t][i];
      if (n < t || label(n) != label(t)) continue;
      const auto& corners = triangles_[n];
      const Index a = triangles_[t][0], b = triangles_[t][1], c = triangles_[t][2];
      const bool flat = std::all_of(corners.begin(), corners.end(), [&](Index v) {
        return v == a || v == b || v == c || exact::orient3d(points, a, b, c, v) == 0;
      });
      if (flat && same_way(points, triangles_[t], corners)) groups.unite(t, n);
    }
  }
  number_facets([&](Index t) { return groups.find(t); }, label, true, points);
}

void InputSurface::number_facets(const std::function<Index(Index)>& representative,
                                 const std::function<std::int32_t(Index)>& label, bool planar,
                                 const ExactPoints& points) {
  facets_.clear();
  facet_of_triangle_.assign(triangles_.size(), kNone);
  for (Index t = 0; t < triangles_.size(); ++t) {
    const Index root = representative(t);
    if (root == t) {
      facet_of_triangle_[t] = static_cast<Index>(facets_.size());
      facets_.push_back({.id = t, .label = label(t)});
    }
    facet_of_triangle_[t] = facet_of_triangle_[root];
  }
  facets_.shrink_to_fit();
  find_normals(planar, points);
  count_euler();
}

// A planar facet has the normal of any of its triangles that is not flat; the largest one's is
// known best. Of another one it is the sum of the area vectors, or, as the denominator of a sum of
// many would outgrow all memory, that of its largest triangle.
void InputSurface::find_normals(bool planar, const ExactPoints& points) {
  const Members all = members();
  for (Index f = 0; f < facets_.size(); ++f) {
    Facet& facet = facets_[f];
    double largest = -1;
    facet.largest = 0;
    for (const Index t : all.of(f)) {
      const auto& [a, b, c] = triangles_[t];
      for (const Index v : triangles_[t]) {
        facet.largest = std::max(facet.largest, largest_component(points.nearest(v)));
      }
      const IntervalVector area = exact::rough_area2(points, a, b, c);
      double size = 0;
      for (const Interval& x : area) size = std::max(size, std::fabs(x.middle()));
      if (!(size > largest)) continue;
      largest = size;
      facet.span = triangles_[t];
    }
    if (largest <= 0) {  // flat as far as doubles tell
      for (const Index t : all.of(f)) {
        facet.span = triangles_[t];
        if (!exact::is_zero(area2(points, t))) break;
      }
    }
    if (!planar && all.of(f).size() > 1 && points.all_integers()) {
      ExactVector sum;
      for (const Index t : all.of(f)) {
        const ExactVector area = area2(points, t);
        for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] += area[axis];
      }
      facet.sum = std::make_shared<const ExactVector>(std::move(sum));
    }
    facet.rough_normal = rough_normal_of(facet, points);
  }
}

InputSurface::Members InputSurface::members() const {
  Members result;
  result.first.assign(facets_.size() + 1, 0);
  for (const Index f : facet_of_triangle_) ++result.first[f + 1];
  std::partial_sum(result.first.begin(), result.first.end(), result.first.begin());
  result.triangles.resize(triangles_.size());
  std::vector<Index> next(result.first.begin(), result.first.end() - 1);
  for (Index t = 0; t < triangles_.size(); ++t) {
    result.triangles[next[facet_of_triangle_[t]]++] = t;
  }
  return result;
}

std::array<ExactSum, 3> InputSurface::excess2(const ExactPoints& points, TriangleSpan faces,
                                              std::span<const Index> triangles) const {
  std::vector<std::array<Index, 3>> corners;
  corners.reserve(triangles.size());
  for (const Index t : triangles) corners.push_back(triangles_[t]);
  return sum_of_areas2(points, faces, corners);
}

ExactVector InputSurface::area2(const ExactPoints& points, Index t) const {
  const auto& [a, b, c] = triangles_[t];
  return exact::area2(points, a, b, c);
}

// The triangles of a planar polygon belong together whatever their shape (a fan may hold degenerate
// ones).
void InputSurface::unite_polygons(const Polyhedron& polyhedron, const ExactPoints& points,
                                  const std::function<void(Index, Index)>& unite) const {
  const std::vector<Index>& polygon = polyhedron.polygons;
  for (std::size_t first = 0; first < polygon.size();) {
    std::size_t last = first + 1;
    while (last < polygon.size() && polygon[last] == polygon[first]) ++last;
    if (last == first + 1) {  // a triangle
      first = last;
      continue;
    }
    ExactVector normal;
    for (std::size_t t = first; t < last; ++t) {
      const ExactVector area = area2(points, static_cast<Index>(t));
      // As in number_facets.
      if (!points.all_integers() && !exact::is_zero(normal)) break;
      for (int axis = 0; axis < 3; ++axis) normal[axis] += area[axis];
    }
    bool flat = true;
    for (std::size_t t = first; t < last && flat; ++t) {
      for (const Index v : triangles_[t]) {
        flat = flat && exact::dot(normal, exact::difference(points, triangles_[first][0], v)) == 0;
      }
    }
    if (flat) {
      for (std::size_t t = first + 1; t < last; ++t) {
        unite(static_cast<Index>(first), static_cast<Index>(t));
      }
    }
    first = last;
  }
}

void InputSurface::count_euler() {
  std::vector<std::pair<Index, Index>> corners;  // facet, vertex
  for (Index t = 0; t < triangles_.size(); ++t) {
    const Index facet = facet_of_triangle_[t];
    facets_[facet].euler += 1;
    for (int i = 0; i < 3; ++i) {
      corners.emplace_back(facet, triangles_[t][i]);
      const Index n = neighbours_[t][i];
      if (facet_of_triangle_[n] != facet || t < n) facets_[facet].euler -= 1;
    }
  }
  std::sort(corners.begin(), corners.end());
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  for (const auto& corner : corners) facets_[corner.first].euler += 1;
}

double InputSurface::unite_facets(const std::vector<Index>& across, double thin,
                                  const ExactPoints& points) {
  UnionFind groups(triangles_.size());
  std::vector<std::int32_t> labels;
  for (Index t = 0; t < triangles_.size(); ++t) {
    const Facet& facet = facets_[facet_of_triangle_[t]];
    labels.push_back(facet.label);
    groups.unite(facet.id, t);
  }
  std::vector<Index> united;
  const Members all = members();
  const auto in_slab_of = [&](Index f, Index other) {
    const auto [low, high] = heights(facets_[f], all.of(f), points);
    const auto [below, above] = heights(facets_[f], all.of(other), points);
    return std::max(high, above) - std::min(low, below) <= thin;
  };
  for (const Index e : across) {
    const Facet &left = facets_[edges_[e].left], &right = facets_[edges_[e].right];
    if (left.label != right.label) continue;
    if (!in_slab_of(edges_[e].left, edges_[e].right) &&
        !in_slab_of(edges_[e].right, edges_[e].left)) {
      continue;
    }
    groups.unite(left.id, right.id);
    united.push_back(left.id);
  }
  number_facets([&](Index t) { return groups.find(t); }, [&](Index t) { return labels[t]; }, false,
                points);
  build_edges();
  std::vector<std::uint8_t> asked(facets_.size(), 0);
  for (const Index t : united) asked[facet_of_triangle_[t]] = 1;
  return widest_slab(asked, thin, points);
}

double InputSurface::group_facets(const std::vector<Index>& group, double thin,
                                  const ExactPoints& points) {
  std::vector<std::int32_t> labels;
  for (Index t = 0; t < triangles_.size(); ++t) {
    labels.push_back(facets_[facet_of_triangle_[t]].label);
  }
  UnionFind groups(triangles_.size());
  for (Index t = 0; t < triangles_.size(); ++t) {
    for (const Index n : neighbours_[t]) {
      if (group[t] == group[n] && labels[t] == labels[n]) groups.unite(t, n);
    }
  }
  number_facets([&](Index t) { return groups.find(t); }, [&](Index t) { return labels[t]; }, false,
                points);
  build_edges();
  return widest_slab(std::vector<std::uint8_t>(facets_.size(), 1), thin, points);
}

double InputSurface::move_needles(const MissingEdges& missing, double thin,
                                  const ExactPoints& points) {
  const std::vector<Index> own = facet_of_triangle_;
  const auto facets = static_cast<Index>(facets_.size());
  // Facets first, then triangles.
  std::vector<Index> group = own;
  for (Index t = 0; t < triangles_.size(); ++t) {
    if (is_thin(t, thin, points)) group[t] = facets + t;
  }
  group_facets(group, thin, points);
  // Groups that needles join; two facets are never joined.
  UnionFind clusters(facets + triangles_.size());
  std::vector<std::pair<Index, Index>> beside;  // a needle, and a facet
  for (const Index e : missing(*this)) {
    const auto [left, right] =
        std::minmax(group[facets_[edges_[e].left].id], group[facets_[edges_[e].right].id]);
    if (left >= facets) {
      clusters.unite(left, right);
    } else if (right >= facets) {
      beside.emplace_back(right, left);
    }
  }
  constexpr Index kSeveral = kNone - 1;
  std::vector<Index> to(facets + triangles_.size(), kNone);  // by cluster, the group that it joins
  for (const auto& [needle, facet] : beside) {
    Index& joined = to[clusters.find(needle)];
    joined = joined == kNone || joined == facet ? facet : kSeveral;
  }
  std::vector<Index> home(to.size(), kNone);  // by cluster, the facet that it is in as given
  for (Index t = 0; t < triangles_.size(); ++t) {
    if (group[t] < facets) continue;
    Index& in = home[clusters.find(group[t])];
    in = in == kNone || in == own[t] ? own[t] : kSeveral;
  }
  for (Index t = 0; t < triangles_.size(); ++t) {
    if (group[t] < facets) continue;
    const Index cluster = clusters.find(group[t]);
    if (to[cluster] == kSeveral) continue;
    if (to[cluster] != kNone) {
      group[t] = to[cluster];
    } else {
      group[t] = home[cluster] == kSeveral ? cluster : home[cluster];
    }
  }
  return group_facets(group, thin, points);
}

bool InputSurface::is_thin(Index t, double thin, const ExactPoints& points) const {
  double longest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    longest =
        std::max(longest, exact::distance(points, triangles_[t][i], triangles_[t][(i + 1) % 3]));
  }
  return length(area2(points, t), 2 * points.exponent()) <= thin * longest;
}

std::pair<double, double> InputSurface::heights(const Facet& facet,
                                                std::span<const Index> triangles,
                                                const ExactPoints& points) const {
  const ExactVector normal = facet.area2(points);
  if (exact::is_zero(normal)) return {-HUGE_VAL, HUGE_VAL};
  double low = 0, high = 0;
  for (const Index t : triangles) {
    for (const Index v : triangles_[t]) {
      if (facet.side(points, v) == 0) continue;
      const double height =
          component(exact::dot(normal, exact::difference(points, facet.span[0], v)), normal,
                    points.exponent());
      low = std::min(low, height);
      high = std::max(high, height);
    }
  }
  return {low, high};
}

double InputSurface::widest_slab(const std::vector<std::uint8_t>& asked, double thin,
                                 const ExactPoints& points) {
  double widest = 0;
  const Members all = members();
  for (Index f = 0; f < facets_.size(); ++f) {
    if (asked[f] == 0) continue;
    Facet& facet = facets_[f];
    if (exact::is_zero(facet.area2(points))) return HUGE_VAL;
    if (all.of(f).size() == 1) continue;  // in one plane
    for (const Index t : all.of(f)) {
      if (facet.facing(points, triangles_[t]) < 0 && !is_thin(t, thin, points)) return HUGE_VAL;
    }
    const auto [low, high] = heights(facet, all.of(f), points);
    // The few roundings of measuring stay below this factor.
    facet.slab = (high - low) * (1 + 1e-12);
    widest = std::max(widest, facet.slab);
  }
  return widest;
}

bool InputSurface::is_flat_with_another(Index facet, double width,
                                        const ExactPoints& points) const {
  const Members all = members();
  const auto in_slab_of = [&](Index f, Index other) {
    const auto [low, high] = heights(facets_[f], all.of(f), points);
    const auto [below, above] = heights(facets_[f], all.of(other), points);
    return std::max(high, above) - std::min(low, below) <= width;
  };
  return std::any_of(edges_.begin(), edges_.end(), [&](const Edge& edge) {
    if (edge.left != facet && edge.right != facet) return false;
    const Facet &left = facets_[edge.left], &right = facets_[edge.right];
    return left.label == right.label && exact::dot(left.normal(points), right.normal(points)) > 0 &&
           (in_slab_of(edge.left, edge.right) || in_slab_of(edge.right, edge.left));
  });
}

void InputSurface::build_edges() {
  edges_.clear();
  for (Index t = 0; t < triangles_.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const Index n = neighbours_[t][i];
      const Index left = facet_of_triangle_[t], right = facet_of_triangle_[n];
      if (t < n && left != right) {
        edges_.push_back({triangles_[t][i], triangles_[t][(i + 1) % 3], left, right});
      }
    }
  }
  edges_.shrink_to_fit();
}

BoxTree::Box enlarged(BoxTree::Box box, double by) {
  for (int axis = 0; axis < 3; ++axis) {
    box.low[axis] -= by;
    box.high[axis] += by;
  }
  return box;
}

}  // namespace tetproof::oracles
