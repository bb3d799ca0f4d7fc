#include "mesher/refine/prediction.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <optional>

#include "mesher/base/flat_map.h"
#include "mesher/delmesher/options.h"
#include "mesher/geometry/box_tree.h"
#include "mesher/geometry/vector.h"

namespace delmesher::refine {
namespace {

// A cell of the octree is split while its side exceeds this multiple of the local feature size at
// its centre.
constexpr double kCellSize = 1.5;
// A larger local feature size than the side of a cell counts as that; a few times more for large
// cells, of which simple models have no others.
constexpr double kFarReach = 4;
// Tetrahedra per integral of 1 / lfs^3, measured.
constexpr double kPerUnit[2] = {0.84, 1};  // inside; down to the outer box
// A bound on edges takes as many as so small a local feature size.
constexpr double kOfBound = 0.32;
// In a cube of edges of the size, and per square of it on a thin plate, of which both faces count.
constexpr double kInCube = 9.8, kPerSquare = 3.5;
constexpr int kMinDepth = 3, kMaxDepth = 60;
// From this depth on, four children of eight stand for all: every other one, as on a chessboard.
// One level more without that costs twice the time and brings estimates 4 % nearer (root mean
// square of the logarithms over 459 models).
constexpr int kSampledDepth = 3;
// Beyond so many cells (half a minute; the largest models take a tenth) one child stands for all.
constexpr std::uint64_t kMostCells = 1U << 23U;
// In smaller cells than so many ulps of the coordinates there, doubles do not tell distances.
constexpr double kSmallestCell = 16;

// A segment of the complex, a triangle of a kept facet, or a vertex by itself.
struct Element {
  std::array<VertexId, 3> corner;  // the third is kNone for a segment, the second too for a vertex
  std::uint32_t owner;             // the segment; after these the facets, then the vertices
};

// A box of the tree, or an element, waiting to be looked at.
struct Waiting {
  double distance2;
  std::uint32_t index;
  bool is_element;
  bool operator<(const Waiting& o) const {  // for a heap with the nearest on top
    if (distance2 != o.distance2) return distance2 > o.distance2;
    return is_element != o.is_element ? o.is_element : index > o.index;
  }
};

// The surroundings of a point.
struct Surroundings {
  double size;     // the local feature size, if below the bound
  double nearest;  // distance of the nearest element, if below the bound
  std::array<std::uint32_t, 2> witness = {kNone, kNone};  // two that do not touch, within `size`
};

struct Cell {
  Vec3 center;
  double side;
  int depth;
  double weight;        // how many it stands for
  Surroundings parent;  // of the centre of the cell above
};

// Squared distances from the origin.
double origin_segment2(const Vec3& a, const Vec3& b) {
  const Vec3 u = subtract(b, a);
  const double all = dot(u, u);
  const double t = all > 0 ? std::clamp(-dot(a, u) / all, 0.0, 1.0) : 0;
  const Vec3 foot = {a[0] + t * u[0], a[1] + t * u[1], a[2] + t * u[2]};
  return dot(foot, foot);
}

double origin_triangle2(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 n = cross(subtract(b, a), subtract(c, a));
  const double ab = dot(n, cross(a, b)), bc = dot(n, cross(b, c)), ca = dot(n, cross(c, a));
  const double square = dot(n, n);
  if (square > 0 && ab >= 0 && bc >= 0 && ca >= 0) {
    const double height = dot(n, a);
    return height * height / square;
  }
  double best = HUGE_VAL;
  if (!(ab > 0)) best = std::min(best, origin_segment2(a, b));
  if (!(bc > 0)) best = std::min(best, origin_segment2(b, c));
  if (!(ca > 0)) best = std::min(best, origin_segment2(c, a));
  return best;
}

class Predictor {
 public:
  Predictor(const Plc& plc, const SurfaceTopology& topology,
            const std::vector<std::uint8_t>& facet_kept, const PointStore& points,
            const PredictionOptions& options, Control& control)
      : plc_(plc),
        topology_(topology),
        facet_kept_(facet_kept),
        points_(points),
        options_(options),
        control_(control),
        surface_(triangle_boxes(topology, points)) {
    Owned vertices(plc.segments.size() + topology.facet_triangles.size());
    collect_elements(vertices);
    collect_vertices(vertices);
    std::vector<Box> boxes;
    for (const Element& e : elements_) {
      Box box;
      for (const VertexId v : e.corner) {
        if (v != kNone) box.extend({points.nearest(v), points.nearest(v)});
      }
      boxes.push_back(box);
    }
    element_tree_.emplace(boxes);
    for (auto& own : vertices) {
      std::sort(own.begin(), own.end());
      first_vertex_.push_back(static_cast<std::uint32_t>(vertices_.size()));
      std::unique_copy(own.begin(), own.end(), std::back_inserter(vertices_));
    }
    first_vertex_.push_back(static_cast<std::uint32_t>(vertices_.size()));
  }

  double run() {
    if (surface_.empty()) return 0;
    const Box all = surface_.node(0).box;
    Cell root{{}, 0, 0, 1, {HUGE_VAL, HUGE_VAL}};
    for (std::size_t k = 0; k < 3; ++k) {
      root.center[k] = 0.5 * all.lo[k] + 0.5 * all.hi[k];
      root.side = std::max(root.side, all.hi[k] - all.lo[k]);
    }
    if (options_.region == Region::hull) root.side *= 2;  // the outer box (section 5.1)
    visit(root, Where::unknown);
    return predicted() + of_bound();
  }

 private:
  using Owned = std::vector<std::vector<VertexId>>;  // vertices per owner

  void collect_elements(Owned& vertices) {
    for (std::uint32_t s = 0; s < plc_.segments.size(); ++s) {
      const auto& ends = plc_.segments[s].vertex;
      elements_.push_back({{ends[0], ends[1], kNone}, s});
      vertices[s].assign(ends.begin(), ends.end());
    }
    for (std::uint32_t t = 0; t < topology_.triangles.size(); ++t) {
      const FacetId f = topology_.facet_of[t];
      if (!facet_kept_.empty() && facet_kept_[f] == 0) continue;
      const auto owner = static_cast<std::uint32_t>(plc_.segments.size() + f);
      elements_.push_back({topology_.triangles[t], owner});
      auto& own = vertices[owner];
      own.insert(own.end(), topology_.triangles[t].begin(), topology_.triangles[t].end());
    }
  }

  // Vertices that facets got by chamfering, and vertices that are elements by themselves.
  void collect_vertices(Owned& vertices) {
    for (const PlcFacet& facet : plc_.facets) {
      if (facet.input_facet == kNone) continue;
      auto& own = vertices[plc_.segments.size() + facet.input_facet];
      for (const PlcFacet::Side& side : facet.boundary) {
        const auto& ends = plc_.segments[side.segment].vertex;
        own.insert(own.end(), ends.begin(), ends.end());
      }
      own.insert(own.end(), facet.isolated.begin(), facet.isolated.end());
      for (const VertexId v : facet.isolated) add_vertex(v, vertices);
    }
  }

  void add_vertex(VertexId v, Owned& vertices) {
    elements_.push_back({{v, kNone, kNone}, static_cast<std::uint32_t>(vertices.size())});
    vertices.push_back({v});
  }

  // Of the bound on edges, inside: cells are too coarse for the volume of thin parts.
  double of_bound() const {
    if (options_.max_edge == 0 || options_.region != Region::interior) return 0;
    const Vec3 origin = surface_.node(0).box.lo;
    double sixfold = 0, area = 0;
    for (const auto& t : topology_.triangles) {
      const auto at = [&](std::size_t k) { return subtract(points_.nearest(t[k]), origin); };
      const Vec3 normal = cross(subtract(at(1), at(0)), subtract(at(2), at(0)));
      sixfold += dot(at(0), normal);
      area += norm(normal) / 2;
    }
    return tetrahedra_of_size(options_.max_edge / kMostOfSize, std::fabs(sixfold) / 6, area);
  }

  enum class Where : std::uint8_t { unknown, inside, outside };

  // Squared distance, as good as an estimate needs it.
  double distance2(const Vec3& p, const Element& e) const {
    const Vec3 a = subtract(points_.nearest(e.corner[0]), p);
    if (e.corner[1] == kNone) return dot(a, a);
    const Vec3 b = subtract(points_.nearest(e.corner[1]), p);
    if (e.corner[2] == kNone) return origin_segment2(a, b);
    return origin_triangle2(a, b, subtract(points_.nearest(e.corner[2]), p));
  }

  // Do the two elements of the complex share a point (or did they, before chamfering)?
  bool touch(std::uint32_t a, std::uint32_t b) {
    if (a == b) return true;
    constexpr std::uint32_t kFew = 12;
    const std::uint32_t n = first_vertex_[a + 1] - first_vertex_[a];
    if (n + first_vertex_[b + 1] - first_vertex_[b] <= kFew) return share_vertex(a, b);
    const std::uint64_t key = pair_key(a, b);
    const std::uint32_t known = touching_.get(key, 2);
    if (known != 2) return known != 0;
    const bool result = share_vertex(a, b);
    touching_.set(key, result ? 1 : 0);
    return result;
  }

  bool share_vertex(std::uint32_t a, std::uint32_t b) const {
    std::uint32_t i = first_vertex_[a], j = first_vertex_[b];
    while (i < first_vertex_[a + 1] && j < first_vertex_[b + 1]) {
      if (vertices_[i] == vertices_[j]) return true;
      (vertices_[i] < vertices_[j] ? i : j)++;
    }
    return false;
  }

  // Elements are looked at from the nearest on, until two do not touch. A pair that did not nearby,
  // in the cell above, bounds the search from the start.
  Surroundings surroundings(const Vec3& p, double bound, const Surroundings& nearby) {
    Surroundings found{bound, bound, nearby.witness};
    met_.clear();
    waiting_.clear();
    if (element_tree_->empty()) return found;  // all was filtered away
    if (nearby.witness[0] != kNone) {
      found.size = std::min(bound, witness_distance(p, nearby));
      found.nearest = found.size;
      gather(p, found.size * found.size);
      for (const Waiting& w : waiting_) {
        if (!meet(w, found)) break;
      }
      return found;
    }
    waiting_.push_back({0, 0, false});
    while (!waiting_.empty()) {
      std::pop_heap(waiting_.begin(), waiting_.end());
      const Waiting w = waiting_.back();
      waiting_.pop_back();
      if (w.is_element) {
        if (!meet(w, found)) break;
      } else {
        expand(p, w.index, bound * bound);
      }
    }
    return found;
  }

  // Takes note of the next element; false if it and one met before do not touch.
  bool meet(const Waiting& w, Surroundings& found) {
    if (met_.empty()) found.nearest = std::sqrt(w.distance2);
    const std::uint32_t owner = elements_[w.index].owner;
    const auto same = [&](std::uint32_t e) { return elements_[e].owner == owner; };
    if (std::any_of(met_.begin(), met_.end(), same)) return true;
    for (const std::uint32_t other : met_) {
      if (touch(owner, elements_[other].owner)) continue;
      found.size = std::sqrt(w.distance2);
      found.witness = {other, w.index};
      return false;
    }
    met_.push_back(w.index);
    return true;
  }

  // The elements within the bound, the nearest first.
  void gather(const Vec3& p, double bound2) {
    nodes_.assign(1, 0);
    while (!nodes_.empty()) {
      const std::uint32_t n = nodes_.back();
      const BoxTree::Node& node = element_tree_->node(n);
      nodes_.pop_back();
      if (node.is_leaf()) {
        for (std::uint32_t i = node.begin; i < node.end; ++i) {
          if (squared_distance({p, p}, element_tree_->item_box(i)) >= bound2) continue;
          const std::uint32_t e = element_tree_->item(i);
          const double d = distance2(p, elements_[e]);
          if (d < bound2) waiting_.push_back({d, e, true});
        }
        continue;
      }
      for (const std::uint32_t child : {n + 1, node.right}) {
        if (squared_distance({p, p}, element_tree_->node(child).box) < bound2)
          nodes_.push_back(child);
      }
    }
    std::sort(waiting_.begin(), waiting_.end(),
              [](const Waiting& a, const Waiting& b) { return b < a; });
  }

  double witness_distance(const Vec3& p, const Surroundings& s) const {
    return std::sqrt(
        std::max(distance2(p, elements_[s.witness[0]]), distance2(p, elements_[s.witness[1]])));
  }

  void expand(const Vec3& p, std::uint32_t n, double bound2) {
    const auto wait = [&](double distance2, std::uint32_t index, bool is_element) {
      if (distance2 >= bound2) return;
      waiting_.push_back({distance2, index, is_element});
      std::push_heap(waiting_.begin(), waiting_.end());
    };
    const BoxTree::Node& node = element_tree_->node(n);
    if (!node.is_leaf()) {
      for (const std::uint32_t child : {n + 1, node.right}) {
        wait(squared_distance({p, p}, element_tree_->node(child).box), child, false);
      }
      return;
    }
    for (std::uint32_t i = node.begin; i < node.end; ++i) {
      if (squared_distance({p, p}, element_tree_->item_box(i)) >= bound2) continue;
      const std::uint32_t e = element_tree_->item(i);
      wait(distance2(p, elements_[e]), e, true);
    }
  }

  // Parity of the crossings of a ray with the surface, in doubles: good enough for an estimate.
  bool inside(const Vec3& p) const {
    Box ray{p, p};
    ray.hi[0] = surface_.node(0).box.hi[0];
    bool odd = false;
    surface_.query(ray, [&](std::uint32_t t) {
      const auto& v = topology_.triangles[t];
      double area[3];
      for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 a = points_.nearest(v[i]), b = points_.nearest(v[(i + 1) % 3]);
        area[i] = (a[1] - p[1]) * (b[2] - p[2]) - (a[2] - p[2]) * (b[1] - p[1]);
      }
      const bool hit = (area[0] > 0) == (area[1] > 0) && (area[1] > 0) == (area[2] > 0);
      const double total = area[0] + area[1] + area[2];
      if (!hit || total == 0) return true;
      double x = 0;
      for (std::size_t i = 0; i < 3; ++i) x += area[(i + 1) % 3] / total * points_.nearest(v[i])[0];
      odd ^= x > p[0];
      return true;
    });
    return odd;
  }

  std::uint32_t next_random() { return (random_ = random_ * 1664525U + 1013904223U) >> 16U; }

  double predicted() const { return sum_ * kPerUnit[options_.region == Region::hull ? 1 : 0]; }

  void visit(const Cell& cell, Where where) {
    if (predicted() > options_.enough) return;
    control_.poll();
    ++cells_;
    if (cell.depth < kMinDepth) return divide(cell, cell.parent, where);
    Surroundings around = surroundings(cell.center, cell.side, cell.parent);
    double size = around.size;
    if (options_.sizes != nullptr) {
      size = std::min(size, kOfBound * options_.sizes->at(cell.center));
    }
    const bool crossed = around.nearest < 0.8660254 * cell.side;
    const bool interior = options_.region == Region::interior;
    if (where == Where::unknown && interior && !crossed) {
      where = inside(cell.center) ? Where::inside : Where::outside;
    }
    if (where == Where::outside) return;
    if (cell.side > kCellSize * size) {
      if (is_divisible(cell)) return divide(cell, around, where);
      size = cell.side / kCellSize;
    }
    if (cell.depth == kMinDepth && size >= cell.side) {
      size = surroundings(cell.center, kFarReach * cell.side, around).size;
    }
    const bool bounded = options_.max_edge > 0 && !interior;
    const double target = bounded ? std::min(size, kOfBound * options_.max_edge) : size;
    const double ratio = cell.side / target;
    const bool half = crossed && interior;
    sum_ += (half ? 0.5 : 1) * cell.weight * ratio * ratio * ratio;
  }

  static bool is_divisible(const Cell& cell) {
    double largest = 0;
    for (const double x : cell.center) largest = std::max(largest, std::fabs(x));
    return cell.depth < kMaxDepth && cell.side > kSmallestCell * 0x1p-52 * largest;
  }

  void divide(const Cell& cell, const Surroundings& around, Where where) {
    const bool sampled = cell.depth >= kSampledDepth;
    const bool too_many = sampled && cells_ > kMostCells;
    const unsigned random = next_random(), colour = random & 1U;
    const double each = too_many ? 8 : sampled ? 2 : 1;
    for (unsigned child = 0; child < 8; ++child) {
      if (too_many && child != (random & 7U)) continue;
      if (sampled && !too_many && (std::popcount(child) & 1U) != colour) continue;
      Cell next{cell.center, cell.side / 2, cell.depth + 1, each * cell.weight, around};
      for (std::size_t k = 0; k < 3; ++k) {
        next.center[k] += ((child >> k & 1) != 0 ? 0.25 : -0.25) * cell.side;
      }
      visit(next, where);
    }
  }

  const Plc& plc_;
  const SurfaceTopology& topology_;
  const std::vector<std::uint8_t>& facet_kept_;
  const PointStore& points_;
  const PredictionOptions& options_;
  Control& control_;
  BoxTree surface_;
  std::vector<Element> elements_;
  std::optional<BoxTree> element_tree_;
  std::vector<VertexId> vertices_;           // per owner, ascending
  std::vector<std::uint32_t> first_vertex_;  // of each owner, and the end
  FlatMap touching_;
  std::vector<Waiting> waiting_;  // scratch of surroundings()
  std::vector<std::uint32_t> nodes_;
  std::vector<std::uint32_t> met_;  // an element of each owner met there
  double sum_ = 0;
  std::uint64_t cells_ = 0;  // visited
  std::uint32_t random_ = 1;
};

}  // namespace

double tetrahedra_of_size(double size, double volume, double area) {
  return std::max(kInCube * volume / (size * size * size), kPerSquare * area / (size * size));
}

double size_for(double tetrahedra, double volume, double area) {
  return std::max(std::cbrt(kInCube * volume / tetrahedra),
                  std::sqrt(kPerSquare * area / tetrahedra));
}

double predict_tetrahedra(const Plc& plc, const SurfaceTopology& topology,
                          const std::vector<std::uint8_t>& facet_kept, const PointStore& points,
                          const PredictionOptions& options, Control& control) {
  return Predictor(plc, topology, facet_kept, points, options, control).run();
}

}  // namespace delmesher::refine
