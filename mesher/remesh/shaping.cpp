#include "mesher/remesh/shaping.h"

#include <algorithm>
#include <functional>
#include <utility>
#include <vector>

namespace delmesher::remesh {
namespace {

// Sines of the smallest angle: of a triangle that is left alone, and of one that points are for.
constexpr double kRound = 0.5;
constexpr double kCramped = 0.45;
constexpr int kPasses = 100;
constexpr std::size_t kMostMore = 8, kAndMore = 10000;  // times the triangles, for their shapes

// The longest first.
std::array<Line, 3> edges_of(const State& state, std::uint32_t t) {
  const auto& [a, b, c] = state.mesh().triangle(t);
  std::array<Line, 3> edges{{{a, b}, {b, c}, {c, a}}};
  std::ranges::stable_sort(edges, std::greater{},
                           [&](const Line& edge) { return state.length(edge); });
  return edges;
}

class Shaping {
 public:
  Shaping(State& state, State::Shapes collapses)
      : state_(state), mesh_(state.mesh()), collapses_(collapses) {}

  bool is_round(std::uint32_t t) const {
    return least_sine(state_.at(mesh_.triangle(t))) >= kRound;
  }
  bool make_rounder(std::uint32_t t);
  // A point on a long edge.
  bool make_room(std::uint32_t t);

 private:
  Vec3 better_place(VertexId v) const;
  bool move(VertexId v);
  bool draw_onto_line(std::uint32_t t);
  bool is_forced(std::uint32_t t) const;
  Line terminal_edge(std::uint32_t t) const;

  State& state_;
  const TriangleMesh& mesh_;
  const State::Shapes collapses_;
};

// The middle of the triangles around it, or of its line, drawn to the input.
Vec3 Shaping::better_place(VertexId v) const {
  Vec3 middle{};
  double weight = 0;
  const auto add = [&](const Vec3& p, double w) {
    middle = add_scaled(middle, w, p);
    weight += w;
  };
  for (const std::uint32_t l : mesh_.lines_at(v)) {
    for (const VertexId w : mesh_.line(l)) {
      if (w != v) add(state_.at(w), 1);
    }
  }
  if (mesh_.lines_at(v).empty()) {
    for (const std::uint32_t t : mesh_.star(v)) {
      const Corners corners = state_.at(mesh_.triangle(t));
      for (const Vec3& p : corners) add(p, norm(normal_of(corners)));
    }
  }
  return state_.nearest_given(v, add_scaled({}, 1 / weight, middle));
}

bool Shaping::move(VertexId v) {
  const std::size_t lines = mesh_.lines_at(v).size();
  if (state_.is_corner(v) || (lines != 0 && lines != 2)) return false;
  const Vec3 from = state_.at(v), way = subtract(better_place(v), from);
  for (double step = 1; step > 0.2; step /= 2) {
    if (state_.move(v, add_scaled(from, step, way)) != kNone) return true;
  }
  return false;
}

bool Shaping::make_rounder(std::uint32_t t) {
  const std::array<Line, 3> edges = edges_of(state_, t);
  for (const auto& [a, b] : edges) {
    if (state_.flip(a, b)) return true;
  }
  for (const VertexId v : mesh_.triangle(t)) {
    if (move(v)) return true;
  }
  return state_.collapse(edges[2][0], edges[2][1], collapses_) != kNone || draw_onto_line(t);
}

// A flat triangle on a line: onto the line with its third vertex if that is free, else to that
// vertex with the line.
bool Shaping::draw_onto_line(std::uint32_t t) {
  const Line base = edges_of(state_, t)[0];
  const VertexId v = third(mesh_.triangle(t), base[0], base[1]);
  if (!state_.is_line(base[0], base[1])) return false;
  if (!state_.is_free(v)) return state_.lead_line_over(base, v);
  const Vec3 from = state_.at(base[0]), along = subtract(state_.at(base[1]), from);
  const double share = dot(subtract(state_.at(v), from), along) / squared_norm(along);
  if (!(share > 0 && share < 1)) return false;
  const VertexId p = state_.split(base, share);
  if (p == kNone) return false;
  state_.collapse_to(v, p, p);
  return true;
}

// Is the smallest angle one between two lines?
bool Shaping::is_forced(std::uint32_t t) const {
  const std::array<Line, 3> edges = edges_of(state_, t);
  return state_.is_line(edges[0][0], edges[0][1]) && state_.is_line(edges[1][0], edges[1][1]);
}

// An edge that is the longest one of its triangles, on the way along longest edges (Rivara 1997).
Line Shaping::terminal_edge(std::uint32_t t) const {
  Line edge = edges_of(state_, t)[0];
  for (bool found = true; found;) {
    found = false;
    for (const std::uint32_t s : mesh_.triangles_at(edge[0], edge[1])) {
      const Line longest = edges_of(state_, s)[0];
      if (state_.length(longest) <= state_.length(edge)) continue;
      edge = longest;
      found = true;
      break;
    }
  }
  return edge;
}

// Not where edges are shorter than the tolerance: what is so small has no shape.
bool Shaping::make_room(std::uint32_t t) {
  return state_.length(edges_of(state_, t)[2]) > state_.tolerance() && !is_forced(t) &&
         state_.split(terminal_edge(t), 0.5) != kNone;
}

}  // namespace

// The least round first, then those that came of it, and those near which room was made.
void make_rounder(State& state, bool new_points, Control& control) {
  // What made room must not collapse again.
  Shaping shaping(state, new_points ? State::Shapes::rounder : State::Shapes::as_round);
  const TriangleMesh& mesh = state.mesh();
  const std::size_t most = new_points ? kMostMore * mesh.count() + kAndMore : 0;
  std::uint32_t seen = 0;
  std::vector<std::uint32_t> again;
  for (int pass = 0; pass < kPasses; ++pass) {
    std::vector<std::pair<double, std::uint32_t>> order;
    const auto look_at = [&](std::uint32_t t) {
      if (!mesh.has_triangle(t) || shaping.is_round(t)) return;
      order.emplace_back(least_sine(state.at(mesh.triangle(t))), t);
    };
    std::ranges::for_each(again, look_at);
    again.clear();
    for (; seen < mesh.triangles(); ++seen) look_at(seen);
    if (order.empty()) break;
    std::ranges::sort(order);
    for (const auto& [sine, t] : order) {
      control.poll(mesh.count() / 2);
      if (!mesh.has_triangle(t) || shaping.make_rounder(t)) continue;
      if (sine < kCramped && mesh.count() < most && shaping.make_room(t)) again.push_back(t);
    }
  }
}

bool split_long(State& state, Control& control) {
  bool any = false;
  for (std::uint32_t t = 0; t < state.mesh().triangles(); ++t) {
    control.poll(state.mesh().count() / 2);
    if (!state.mesh().has_triangle(t)) continue;
    const Line longest = edges_of(state, t)[0];
    if (state.is_too_long(longest) && state.split(longest, 0.5) != kNone) any = true;
  }
  return any;
}

}  // namespace delmesher::remesh
