#include "mesher/plane/graph.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>

#include "mesher/base/check.h"
#include "mesher/base/moved_away.h"
#include "mesher/plane/spatial_order.h"

namespace delmesher::plane {
namespace {

[[noreturn]] void refuse(const std::string& reason) {
  throw Stopped{{StatusCode::invalid_surface, reason}};
}

std::string both(const char* what, std::uint32_t i, std::uint32_t j) {
  if (j < i) std::swap(i, j);
  return std::string(what) + " " + std::to_string(i) + " and " + std::to_string(j);
}

constexpr const char* kCounting = " (numbered from 0)";

// As short as reads back as the same doubles.
std::string at(const std::array<double, 2>& p) {
  std::string text = "(";
  for (std::size_t k = 0; k < 2; ++k) {
    char digits[40];
    const auto end = std::to_chars(digits, digits + sizeof digits, p[k]).ptr;
    text.append(digits, end).append(k == 0 ? ", " : ")");
  }
  return text;
}

}  // namespace

void check_numbers(const PlanarGraph& g) {
  const auto n = g.vertices.size();
  if (n >= 0xfffffff0U || g.segments.size() >= 0xfffffff0U) refuse("too many vertices or segments");
  if (!g.markers.empty() && g.markers.size() != g.segments.size()) {
    refuse(std::to_string(g.markers.size()) + " markers for " + std::to_string(g.segments.size()) +
           " segments: as many are needed, or none");
  }
  if (!g.partitions.empty() && g.partitions.size() != g.segments.size()) {
    refuse("as many partition flags as segments are needed");
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (const double x : g.vertices[i]) {
      if (!std::isfinite(x)) refuse("vertex " + std::to_string(i) + " is not finite" + kCounting);
    }
  }
  for (std::size_t i = 0; i < g.segments.size(); ++i) {
    const auto [a, b] = g.segments[i];
    const std::string name = "segment " + std::to_string(i);
    if (a >= n || b >= n) {
      refuse(name + " has the vertex " + std::to_string(std::max(a, b)) + " of " +
             std::to_string(n) + kCounting);
    }
  }
  if (g.segments.empty()) refuse("no segments");
}

namespace {

constexpr const char* kMerges = "; `delmesher repair` merges and drops such";

void check_lengths(const PlanarGraph& g) {
  for (std::size_t i = 0; i < g.segments.size(); ++i) {
    const auto [a, b] = g.segments[i];
    if (a != b) continue;
    refuse("segment " + std::to_string(i) + " begins and ends at vertex " + std::to_string(a) +
           kCounting + kMerges);
  }
}

// The power of two that brings the largest coordinate to around 1, if that is exact for all.
int choose_scale(const PlanarGraph& g) {
  double largest = 0;
  for (const auto& p : g.vertices) {
    largest = std::max({largest, std::fabs(p[0]), std::fabs(p[1])});
  }
  const int scale = largest > 0 ? std::ilogb(largest) : 0;
  const auto exact = [](double x, int shift) {
    return std::ldexp(std::ldexp(x, -shift), shift) == x;
  };
  for (const auto& p : g.vertices) {
    if (exact(p[0], scale) && exact(p[1], scale)) continue;
    // Tiny coordinates besides large ones: only coordinates that would overflow are scaled.
    if (scale < 240) return 0;
    refuse("coordinates differ by too many orders of magnitude");
  }
  return scale;
}

class Builder {
 public:
  Builder(const PlanarGraph& input, PointStore& points, PlanePredicates& predicates,
          Control& control)
      : points_(points),
        control_(control),
        graph_{.input = &input,
               .id = {},
               .number = {},
               .pieces = {},
               .base = Triangulation(predicates),
               .inside = {},
               .warnings = {}} {}

  InputGraph run() {
    check_numbers(input());
    check_lengths(input());
    add_points();
    insert_vertices();
    for (const std::uint32_t i : order_of_segments()) {
      control_.poll(points_.size());
      insert_segment(i);
    }
    if (duplicates_ > 0) {
      graph_.warnings.push_back(std::to_string(duplicates_) +
                                " segments ignored that are given more than once");
    }
    if (splits_ > 0) {
      graph_.warnings.push_back(std::to_string(splits_) +
                                " segments split at vertices that lie on them");
    }
    classify();
    return std::move(graph_);
  }

 private:
  const PlanarGraph& input() const { return *graph_.input; }

  void add_points() {
    graph_.scale = choose_scale(input());
    graph_.unit = std::ldexp(1.0, std::min(-1074 - graph_.scale, 0));
    graph_.vertices = static_cast<VertexId>(input().vertices.size());
    points_.reserve(2 * input().vertices.size());
    std::vector<std::array<double, 2>> scaled;
    scaled.reserve(input().vertices.size());
    for (const auto& p : input().vertices) scaled.push_back(to_store(graph_, p));
    graph_.number = order_along_curve(scaled);
    graph_.id.resize(graph_.vertices);
    std::array<double, 2> low = scaled[0], high = low;
    for (VertexId v = 0; v < graph_.vertices; ++v) {
      graph_.id[graph_.number[v]] = v;
      const auto& x = scaled[graph_.number[v]];
      points_.add_explicit(x[0], x[1], 0);
      for (std::size_t k = 0; k < 2; ++k) {
        low[k] = std::min(low[k], x[k]);
        high[k] = std::max(high[k], x[k]);
      }
    }
    graph_.diagonal = std::ldexp(std::hypot(high[0] - low[0], high[1] - low[1]), graph_.scale);
    // The box is grown by half the larger side, as in space (section 5.1).
    double extent = std::max(high[0] - low[0], high[1] - low[1]);
    if (extent > 0 && extent < 0x1p30 * graph_.unit) {
      refuse("the extent of the graph is below 5.3e-315, where doubles leave no room for a mesh");
    }
    if (extent == 0) extent = std::max({std::fabs(low[0]), std::fabs(low[1]), 0x1p-1000});
    const auto grown = [&](double x, double by) {
      return moved_away(to_unit(graph_, x + by), x, by / 2);
    };
    const std::array<double, 2> l = {grown(low[0], -extent / 2), grown(low[1], -extent / 2)};
    const std::array<double, 2> h = {grown(high[0], extent / 2), grown(high[1], extent / 2)};
    std::array<VertexId, 4> corner;
    corner[0] = points_.add_explicit(l[0], l[1], 0);
    corner[1] = points_.add_explicit(h[0], l[1], 0);
    corner[2] = points_.add_explicit(h[0], h[1], 0);
    corner[3] = points_.add_explicit(l[0], h[1], 0);
    for (std::size_t i = 0; i < 4; ++i) {
      graph_.pieces.push_back({corner[i], corner[(i + 1) % 4], kNone});
    }
    graph_.base.reserve(points_.size());
    graph_.base.start(corner, {0, 1, 2, 3});
  }

  void insert_vertices() {
    std::vector<VertexId> order(graph_.vertices);
    std::iota(order.begin(), order.end(), VertexId{0});
    arrange_in_rounds(order);
    TriangleId hint = 0;
    for (const VertexId v : order) {
      control_.poll(points_.size());
      const VertexId there = graph_.base.insert(v, hint);
      if (there != v) {
        const VertexId i = graph_.number[v], j = graph_.number[there];
        refuse(both("vertices", i, j) + " coincide at " + at(input().vertices[i]) + kCounting +
               kMerges);
      }
      hint = graph_.base.around(v);
    }
    graph_.base.renumber();
  }

  // By the smaller ids of their ends: along the curve as well.
  std::vector<std::uint32_t> order_of_segments() const {
    const auto& segments = input().segments;
    const auto end = [&](const std::array<std::uint32_t, 2>& s) {
      return std::min(graph_.id[s[0]], graph_.id[s[1]]);
    };
    std::vector<std::uint32_t> next_place(std::size_t{graph_.vertices} + 1, 0);
    for (const auto& s : segments) ++next_place[std::size_t{end(s)} + 1];
    for (std::size_t v = 1; v < next_place.size(); ++v) next_place[v] += next_place[v - 1];
    std::vector<std::uint32_t> order(segments.size());
    for (std::uint32_t i = 0; i < segments.size(); ++i) order[next_place[end(segments[i])]++] = i;
    return order;
  }

  void insert_segment(std::uint32_t i) {
    const auto [first, last] = input().segments[i];
    const VertexId a = graph_.id[first], b = graph_.id[last];
    const auto id = static_cast<PieceId>(graph_.pieces.size());
    const auto obstacle = graph_.base.insert_segment(a, b, id, chain_);
    if (obstacle.kind != Triangulation::Obstacle::Kind::none) {
      const std::uint32_t other = graph_.pieces[obstacle.piece].segment;
      DELMESHER_CHECK(other != kNone, "a segment meets the outer box, which contains the graph");
      if (obstacle.kind == Triangulation::Obstacle::Kind::crossing) {
        refuse(both("segments", i, other) + " cross: " + where(i, other) + kCounting +
               "; `delmesher repair` makes a vertex there");
      }
      const auto [c, d] = input().segments[other];
      if (std::minmax(first, last) != std::minmax(c, d)) {
        refuse(both("segments", i, other) + " overlap: " + where(i, other) + kCounting +
               "; `delmesher repair` makes one of them");
      }
      ++duplicates_;
      return;
    }
    graph_.pieces.push_back({chain_[0], chain_[1], i});
    if (chain_.size() == 2) return;
    ++splits_;
    for (std::size_t k = 1; k + 1 < chain_.size(); ++k) {
      const EdgeId e = graph_.base.find_edge(chain_[k], chain_[k + 1]);
      graph_.base.set_piece(e, static_cast<PieceId>(graph_.pieces.size()));
      graph_.pieces.push_back({chain_[k], chain_[k + 1], i});
    }
  }

  // Files of rings do not number their segments: where they are tells.
  std::string where(std::uint32_t i, std::uint32_t j) const {
    const auto ends = [&](std::uint32_t segment) {
      const auto [a, b] = input().segments[segment];
      return at(input().vertices[a]) + " to " + at(input().vertices[b]);
    };
    return i < j ? ends(i) + " and " + ends(j) : ends(j) + " and " + ends(i);
  }

  void classify() {
    Triangulation& base = graph_.base;
    graph_.inside = find_faces(graph_, base, points_, &graph_.warnings).inside;
    for (TriangleId t = 0; t < base.size(); ++t) {
      for (int i = 0; i < 3; ++i) {
        const EdgeId e = edge_of(t, i);
        if (base.piece(e) == kNone) continue;
        Piece& piece = graph_.pieces[base.piece(e)];
        (base.origin(e) == piece.a ? piece.inside_left : piece.inside_right) =
            graph_.inside[t] != 0;
      }
    }
  }

  PointStore& points_;
  Control& control_;
  InputGraph graph_;
  std::vector<VertexId> chain_;
  std::uint64_t duplicates_ = 0, splits_ = 0;
};

class FaceFinder {
 public:
  FaceFinder(const InputGraph& graph, Triangulation& mesh, PointStore& points,
             std::vector<std::string>* notes)
      : graph_(graph), mesh_(mesh), points_(points), notes_(notes) {}

  Faces run() {
    const PlanarGraph& input = *graph_.input;
    if (input.insideness == Insideness::nested) {
      nest();
    } else {
      faces_.inside.assign(mesh_.size(), 1);
      empty(outermost());
      for (std::size_t i = 0; i < input.holes.size(); ++i) {
        const TriangleId t = triangle_inside(input.holes[i], "hole " + std::to_string(i));
        if (t != kNone) empty(t);
      }
    }
    if (!input.regions.empty()) attribute();
    return std::move(faces_);
  }

 private:
  TriangleId outermost() const { return mesh_.around(graph_.vertices); }  // at a box corner

  void note(const std::string& text) {
    if (notes_ != nullptr) notes_->push_back(text + kCounting);
  }

  // kNone, and a note, if the point is outside, or on a segment, where it means no face.
  TriangleId triangle_inside(const std::array<double, 2>& point, const std::string& name) {
    const Location at = locate(point);
    if (at.triangle != kNone && on_segment(at)) {
      note(name + " ignored: it is on a segment");
      return kNone;
    }
    if (at.triangle == kNone || faces_.inside[at.triangle] == 0) {
      note(name + " ignored: it is not inside");
      return kNone;
    }
    return at.triangle;
  }

  // No triangle if the point is not in the box.
  Location locate(const std::array<double, 2>& point) {
    const auto p = to_store(graph_, point);
    const auto low = points_.nearest(graph_.vertices);
    const auto high = points_.nearest(graph_.vertices + 2);
    if (!(p[0] >= low[0] && p[0] <= high[0] && p[1] >= low[1] && p[1] <= high[1]))
      return {kNone, 0};
    const VertexId v = points_.add_explicit(p[0], p[1], 0);
    const Location at = mesh_.locate(v, outermost());
    points_.pop_back();
    return at;
  }

  bool on_segment(const Location& at) const {
    for (int i = 0; i < 3; ++i) {
      const unsigned others = 7U & ~(1U << i);
      if (at.zeros == others) return has_segment(mesh_.opposite(edge_of(at.triangle, i)));
      if (at.zeros == 1U << i) return mesh_.piece(edge_of(at.triangle, i)) != kNone;
    }
    return false;
  }

  bool has_segment(VertexId v) const {
    std::vector<EdgeId> star;
    mesh_.star(v, star);
    return std::any_of(star.begin(), star.end(), [&](EdgeId e) {
      return mesh_.piece(edge_of(triangle_of(e), next(index_of(e)))) != kNone ||
             mesh_.piece(edge_of(triangle_of(e), previous(index_of(e)))) != kNone;
    });
  }

  // Calls visit(triangle) for all triangles of the face of t that `accept` accepts.
  template <class Accept>
  void flood(TriangleId t, Accept&& accept) {
    std::vector<TriangleId> stack = {t};
    if (!accept(t)) return;
    while (!stack.empty()) {
      const TriangleId u = stack.back();
      stack.pop_back();
      for (int i = 0; i < 3; ++i) {
        const EdgeId e = edge_of(u, i), f = mesh_.twin(e);
        if (f != kNone && mesh_.piece(e) == kNone && accept(triangle_of(f))) {
          stack.push_back(triangle_of(f));
        }
      }
    }
  }

  void empty(TriangleId t) {
    flood(t, [&](TriangleId u) {
      if (faces_.inside[u] == 0) return false;
      faces_.inside[u] = 0;
      return true;
    });
  }

  // Fewest separating segments between each triangle and the outside.
  void nest() {
    std::vector<std::uint32_t> depth(mesh_.size(), kNone);
    std::vector<TriangleId> present = {outermost()}, deeper;
    depth[outermost()] = 0;
    for (std::uint32_t d = 0; !present.empty(); ++d) {
      deeper.clear();
      while (!present.empty()) {
        const TriangleId t = present.back();
        present.pop_back();
        for (int i = 0; i < 3; ++i) {
          const EdgeId e = edge_of(t, i), f = mesh_.twin(e);
          if (f == kNone || depth[triangle_of(f)] != kNone) continue;
          if (separates(mesh_.piece(e))) {
            deeper.push_back(triangle_of(f));
          } else {
            depth[triangle_of(f)] = d;
            present.push_back(triangle_of(f));
          }
        }
      }
      for (const TriangleId t : deeper) {
        if (depth[t] == kNone) {
          depth[t] = d + 1;
          present.push_back(t);
        }
      }
    }
    faces_.inside.resize(mesh_.size());
    for (std::size_t t = 0; t < mesh_.size(); ++t) {
      faces_.inside[t] = static_cast<std::uint8_t>(depth[t] % 2);
    }
  }

  bool separates(PieceId piece) const {
    if (piece == kNone) return false;
    const auto& partitions = graph_.input->partitions;
    const std::uint32_t segment = graph_.pieces[piece].segment;
    return segment != kNone && (partitions.empty() || partitions[segment] == 0);
  }

  void attribute() {
    faces_.attributes.assign(mesh_.size(), 0);
    std::vector<std::uint32_t> done(mesh_.size(), kNone);
    const auto& regions = graph_.input->regions;
    for (std::uint32_t r = 0; r < regions.size(); ++r) {
      const TriangleId t = triangle_inside(regions[r].point, "region " + std::to_string(r));
      if (t == kNone) continue;
      flood(t, [&](TriangleId u) {
        if (done[u] == r) return false;
        done[u] = r;
        faces_.attributes[u] = regions[r].attribute;
        return true;
      });
    }
  }

  const InputGraph& graph_;
  Triangulation& mesh_;
  PointStore& points_;
  std::vector<std::string>* notes_;
  Faces faces_;
};

}  // namespace

InputGraph build_graph(const PlanarGraph& input, PointStore& points, PlanePredicates& predicates,
                       Control& control) {
  return Builder(input, points, predicates, control).run();
}

Faces find_faces(const InputGraph& graph, Triangulation& mesh, PointStore& points,
                 std::vector<std::string>* notes) {
  return FaceFinder(graph, mesh, points, notes).run();
}

}  // namespace delmesher::plane
