#include "mesher/remesh/state.h"

#include <algorithm>
#include <cmath>

namespace delmesher::remesh {
namespace {

constexpr double kAccepted = 0.34;  // sine of the smallest angle that a collapse may make
constexpr double kRounder = 1.01;   // times the sine: less is not worth a change
constexpr double kThin = 0.25;      // sine of the smallest angle of a triangle that bends wildly
// Cosines: of the bend of lines that may be made, also where thin triangles go, whose bends say
// little; and what roundings may take.
constexpr double kSharp = -0.5, kSharpest = -0.94, kRounding = 1e-9;

PointStore points_of(const Surface& surface) {
  PointStore points;
  points.reserve(surface.vertices.size());
  for (const Vec3& p : surface.vertices) points.add_explicit(p[0], p[1], p[2]);
  return points;
}

std::vector<Simplex> triangles_of(const Surface& surface) {
  std::vector<Simplex> simplices;
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
    const auto& [a, b, c] = surface.triangles[i];
    simplices.emplace_back(Corners{surface.vertices[a], surface.vertices[b], surface.vertices[c]},
                           surface.labels.empty() ? 0 : surface.labels[i]);
  }
  return simplices;
}

std::vector<Simplex> segments_of(const Surface& surface, const std::vector<Line>& lines) {
  std::vector<Simplex> simplices;
  for (const auto& [a, b] : lines) {
    simplices.emplace_back(surface.vertices[a], surface.vertices[b]);
  }
  return simplices;
}

double cosine_of(double degrees) {
  return std::sqrt(predicates::cosine_squared(degrees));
}

// What roundings may be off by is left out.
double reach_of(const Surface& surface, double tolerance) {
  return tolerance - std::max(0x1p-20 * tolerance, 0x1p-48 * largest_coordinate(surface));
}

}  // namespace

State::State(const Surface& surface, const RemeshGoals& goals, const LocalFrame& frame)
    : State(surface, lines_of(surface, goals.feature, goals.tolerance), goals, frame) {}

State::State(const Surface& surface, const SurfaceLines& lines, const RemeshGoals& goals,
             const LocalFrame& frame)
    : goals_(goals),
      frame_(frame),
      steepest_(cosine_of(goals.feature)),
      flattest_(std::sqrt((1 + steepest_) / 2)),
      points_(points_of(surface)),
      mesh_(surface.triangles, surface.labels, lines.lines, surface.vertices.size()),
      reach_(reach_of(surface, goals.tolerance)),
      envelope_(triangles_of(surface), reach_),
      line_envelope_(segments_of(surface, lines.lines), reach_, lines.counts),
      embedding_(mesh_, envelope_.boxes(), points_, predicates_),
      corners_(surface.vertices.size()),
      quadric_(surface.vertices.size()) {
  const Box box = Box::around(surface.vertices);
  const Vec3 extent = subtract(box.hi, box.lo);
  origin_ = add_scaled(box.lo, 0.5, extent);
  diagonal_ = norm(extent);
  for (VertexId v = 0; v < mesh_.vertices(); ++v) {
    if (is_corner_as_given(v, lines.counts)) corners_[v].push_back(at(v));
  }
  measure_planes();
}

// Squared distances from the planes of the triangles, and for lines from planes across these.
void State::measure_planes() {
  for (std::uint32_t t = 0; t < mesh_.triangles(); ++t) {
    const Corners corners = at(mesh_.triangle(t));
    const Vec3 normal = normal_of(corners);
    const double size = norm(normal);
    if (!(size > 0)) continue;
    const Vec3 unit = add_scaled({}, 1 / size, normal);
    Quadric quadric;
    quadric.add_plane(unit, dot(unit, subtract(corners[0], origin_)), size / 6);
    for (std::size_t i = 0; i < 3; ++i) {
      const VertexId a = mesh_.triangle(t)[i], b = mesh_.triangle(t)[(i + 1) % 3];
      quadric_[a] += quadric;
      if (!is_line(a, b)) continue;
      const Vec3 along = subtract(corners[(i + 1) % 3], corners[i]), across = cross(unit, along);
      const double length = norm(across);
      if (!(length > 0)) continue;
      const Vec3 wall = add_scaled({}, 1 / length, across);
      Quadric beside;
      beside.add_plane(wall, dot(wall, subtract(corners[i], origin_)), size / 6);
      quadric_[a] += beside;
      quadric_[b] += beside;
    }
  }
}

// Where lines end, meet or bend, and where the triangles at the vertex do not hang together.
bool State::is_corner_as_given(VertexId v, const std::vector<std::uint8_t>& line_counts) const {
  const std::span<const std::uint32_t> lines = mesh_.lines_at(v);
  const auto certain = static_cast<std::size_t>(
      std::ranges::count_if(lines, [&](std::uint32_t l) { return line_counts[l] != 0; }));
  if (certain > 2 || (certain == 1 && lines.size() == 1)) return true;
  if (certain == 2 && lines.size() == 2) {
    std::array<Vec3, 2> way;
    for (std::size_t i = 0; i < 2; ++i) {
      const Line& line = mesh_.line(lines[i]);
      way[i] = subtract(at(line[0] == v ? line[1] : line[0]), at(v));
    }
    if (-dot(way[0], way[1]) < steepest_ * norm(way[0]) * norm(way[1])) return true;
  }
  return !hangs_together(mesh_, v);
}

VertexId State::add_point(const Vec3& place) {
  const Vec3 p = frame_.written(place);
  return points_.add_explicit(p[0], p[1], p[2]);
}

std::vector<Simplex> State::added_triangles(const Patch& patch) const {
  std::vector<Simplex> result;
  for (std::size_t i = 0; i < patch.added.size(); ++i) {
    result.emplace_back(at(patch.added[i]), patch.labels[i]);
  }
  return result;
}

std::vector<Simplex> State::added_lines(const Patch& patch) const {
  std::vector<Simplex> result;
  for (const auto& [a, b] : patch.added_lines) result.emplace_back(at(a), at(b));
  return result;
}

bool State::is_too_long(const Line& edge) const {
  return (goals_.max_edge > 0 && !(length(edge) <= goals_.max_edge)) ||
         (!goals_.sizes.empty() && goals_.sizes.is_too_long(at(edge[0]), at(edge[1])));
}

double State::sine_of_removed(const Patch& patch) const {
  double least = 1;
  for (const std::uint32_t t : patch.removed) {
    least = std::min(least, least_sine(at(mesh_.triangle(t))));
  }
  return least;
}

double State::sine_of_added(const Patch& patch) const {
  double least = 1;
  for (const Triangle& t : patch.added) least = std::min(least, least_sine(at(t)));
  return least;
}

bool State::is_line_with(const Patch& patch, VertexId a, VertexId b) const {
  return is_line(a, b) || std::ranges::any_of(patch.added_lines, [&](const Line& l) {
           return (l[0] == a && l[1] == b) || (l[0] == b && l[1] == a);
         });
}

// The sharpest bends at edges of the triangles, which are removed or added by the patch.
State::Bends State::bends(const std::vector<Triangle>& triangles,
                          const std::vector<std::int32_t>& labels, const Patch& patch,
                          bool added) const {
  Bends found;
  const auto normal = [&](const Side& side) { return normal_of(at(triangles[side.triangle])); };
  const auto see = [&](const Side& s, const Vec3& n, bool turned, std::int32_t label) {
    const bool is_of_line = added ? is_line_with(patch, s.a, s.b) : is_line(s.a, s.b);
    double& least = is_of_line ? found.of_lines : found.of_others;
    const double cosine = cosine_of_bend(normal(s), s.turned, n, turned);
    if (!(cosine >= least)) least = cosine;
    if (is_of_line && labels[s.triangle] == label) found.lines.push_back({cosine, {s.a, s.b}});
    if (!is_of_line && !(cosine >= steepest_)) found.sharp.push_back({s.a, s.b});
  };
  const std::vector<Side> sides = sides_of(triangles);
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const Side& s = sides[i];
    if (i + 1 < sides.size() && sides[i + 1].is_beside(s)) {
      const Side& t = sides[i + 1];
      see(s, normal(t), t.turned, labels[t.triangle]);
      ++i;
      continue;
    }
    for (const std::uint32_t t : mesh_.triangles_at(s.a, s.b)) {
      if (std::ranges::find(patch.removed, t) != patch.removed.end()) continue;
      const Triangle& other = mesh_.triangle(t);
      const auto first = static_cast<std::size_t>(std::ranges::find(other, s.a) - other.begin());
      see(s, normal_of(at(other)), other[(first + 1) % 3] != s.b, mesh_.label(t));
    }
  }
  return found;
}

// Nothing if anything bends more than it may, or than something did before. Where thin triangles
// go, edges may become sharp that are as near to the input's lines as new lines have to be.
std::optional<State::LineChanges> State::line_changes(const Patch& patch) const {
  const Bends after = bends(patch.added, patch.labels, patch, true);
  if (after.of_others >= steepest_ && after.of_lines >= kSharp &&
      after.flattest_line() <= flattest_) {
    return LineChanges();
  }
  std::vector<Triangle> removed;
  std::vector<std::int32_t> labels;
  for (const std::uint32_t t : patch.removed) {
    removed.push_back(mesh_.triangle(t));
    labels.push_back(mesh_.label(t));
  }
  const Bends before = bends(removed, labels, patch, false);
  const double sine = sine_of_removed(patch);
  const bool thin = sine < kThin && sine_of_added(patch) > kRounder * sine;
  const double sharpest = thin ? kSharpest : kSharp;
  LineChanges changes;
  if (!(after.of_lines >= std::min(sharpest, before.of_lines - kRounding))) return std::nullopt;
  if (!(after.of_others >= std::min(steepest_, before.of_others))) {
    if (!thin || !(after.of_others >= sharpest)) return std::nullopt;
    changes.made = after.sharp;
  }
  const double flattest = std::max(flattest_, before.flattest_line() + kRounding);
  for (const auto& [cosine, line] : after.lines) {
    if (cosine > flattest) changes.gone.push_back(line);
  }
  return changes;
}

bool State::makes_long_edges(const Patch& patch) const {
  return std::ranges::any_of(patch.added, [&](const Triangle& t) {
    return is_too_long({t[0], t[1]}) || is_too_long({t[1], t[2]}) || is_too_long({t[2], t[0]});
  });
}

bool State::makes_rounder(const Patch& patch) const {
  return !makes_long_edges(patch) && sine_of_added(patch) > kRounder * sine_of_removed(patch);
}

bool State::apply(Patch patch) {
  const std::optional<LineChanges> changes = line_changes(patch);
  if (!changes) return false;
  for (const auto& [a, b] : changes->gone) {
    if (const std::uint32_t l = mesh_.line_at(a, b); l != kNone) patch.removed_lines.push_back(l);
    std::erase_if(patch.added_lines, [&, a = a, b = b](const Line& line) {
      return line == Line{a, b} || line == Line{b, a};
    });
  }
  patch.added_lines.insert(patch.added_lines.end(), changes->made.begin(), changes->made.end());
  const std::vector<Simplex> lines = added_lines(patch), triangles = added_triangles(patch);
  const bool has_lines = !patch.removed_lines.empty() || !patch.added_lines.empty();
  if (has_lines && !line_envelope_.allows(patch.removed_lines, lines)) return false;
  if (!envelope_.allows(patch.removed, triangles) || !embedding_.allows(patch)) return false;
  if (has_lines) line_envelope_.commit(patch.removed_lines, lines);
  envelope_.commit(patch.removed, triangles);
  mesh_.apply(patch);
  embedding_.commit();
  corners_.resize(points_.size());
  quadric_.resize(points_.size());
  return true;
}

Quadric State::of_both(VertexId a, VertexId b) const {
  Quadric both = quadric_[a];
  both += quadric_[b];
  return both;
}

double State::error(VertexId a, VertexId b, const Vec3& place) const {
  const Quadric both = of_both(a, b);
  return both.at(subtract(place, origin_)) / (both.weight * goals_.tolerance * goals_.tolerance);
}

// Vertices on lines stay on lines, and corners where they are, unless they join another one.
bool State::may_vanish(VertexId a, VertexId b) const {
  if (is_corner(b)) return true;
  return !is_corner(a) && (mesh_.lines_at(a).empty() || !mesh_.lines_at(b).empty());
}

std::vector<Vec3> State::places(VertexId a, VertexId b) const {
  // Vertices of the input are preferred where they are as good, so that planes stay planes.
  constexpr double kNothing = 1e-12;
  std::vector<Vec3> found;
  if (may_vanish(a, b)) found.push_back(at(b));
  if (may_vanish(b, a)) found.push_back(at(a));
  if (found.size() < 2) return found;
  if (error(a, b, found[1]) < error(a, b, found[0])) std::swap(found[0], found[1]);
  if (error(a, b, found[0]) <= kNothing) return found;
  const Vec3 p = subtract(at(a), origin_), q = subtract(at(b), origin_);
  const Vec3 best = of_both(a, b).least(add_scaled(p, 0.5, subtract(q, p)));
  found.insert(found.begin(), geometry::add(best, origin_));
  return found;
}

VertexId State::collapse(VertexId a, VertexId b, Shapes shapes) {
  for (const Vec3& place : places(a, b)) {
    VertexId p = kNone;
    if (place == at(b)) {
      p = collapse_to(a, b, b, shapes);
    } else if (place == at(a)) {
      p = collapse_to(b, a, a, shapes);
    } else {
      p = collapse_to(a, b, add_point(place), shapes);
      if (p == kNone) points_.pop_back();
    }
    if (p != kNone) return p;
  }
  return kNone;
}

VertexId State::collapse_to(VertexId a, VertexId b, VertexId p, Shapes shapes) {
  std::vector<Vec3> corners = corners_[a];
  corners.insert(corners.end(), corners_[b].begin(), corners_[b].end());
  if (std::ranges::any_of(corners, [&](const Vec3& c) { return distance(c, at(p)) > reach_; })) {
    return kNone;
  }
  const std::optional<Patch> patch = collapse_patch(mesh_, a, b, p);
  if (!patch || patch->added.empty()) return kNone;
  if (shapes == Shapes::rounder
          ? !makes_rounder(*patch)
          : !(sine_of_added(*patch) >= std::min(kAccepted, sine_of_removed(*patch)))) {
    return kNone;
  }
  if (makes_long_edges(*patch) || !envelope_.is_near(at(p), patch->removed)) return kNone;
  const Quadric both = of_both(a, b);
  if (!apply(*patch)) return kNone;
  quadric_[p] = both;
  corners_[p] = std::move(corners);
  return p;
}

VertexId State::split(const Line& edge, double share) {
  const auto& [a, b] = edge;
  const VertexId p = add_point(add_scaled(at(a), share, subtract(at(b), at(a))));
  if (!apply(split_patch(mesh_, a, b, p))) {
    points_.pop_back();
    return kNone;
  }
  quadric_[p] = of_both(a, b);
  return p;
}

bool State::flip(VertexId a, VertexId b) {
  const std::optional<Patch> patch = flip_patch(mesh_, a, b);
  return patch && makes_rounder(*patch) && apply(*patch);
}

bool State::lead_line_over(const Line& line, VertexId v) {
  const std::optional<Patch> patch = bypass_patch(mesh_, line[0], line[1], v);
  return patch && makes_rounder(*patch) && apply(*patch);
}

VertexId State::move(VertexId v, const Vec3& place) {
  const VertexId p = add_point(place);
  const Patch patch = move_patch(mesh_, v, p);
  if (!makes_rounder(patch) || !apply(patch)) {
    points_.pop_back();
    return kNone;
  }
  quadric_[p] = quadric_[v];
  return p;
}

Vec3 State::nearest_given(VertexId v, const Vec3& p) const {
  const std::span<const std::uint32_t> lines = mesh_.lines_at(v);
  return lines.empty() ? envelope_.nearest_given(p, mesh_.star(v))
                       : line_envelope_.nearest_given(p, lines);
}

Surface State::surface() const {
  Surface result;
  std::vector<VertexId> number(mesh_.vertices(), kNone);
  for (std::uint32_t t = 0; t < mesh_.triangles(); ++t) {
    if (!mesh_.has_triangle(t)) continue;
    Triangle corner = mesh_.triangle(t);
    for (VertexId& v : corner) {
      if (number[v] == kNone) {
        number[v] = static_cast<VertexId>(result.vertices.size());
        result.vertices.push_back(at(v));
      }
      v = number[v];
    }
    result.triangles.push_back(corner);
    result.labels.push_back(mesh_.label(t));
  }
  return result;
}

}  // namespace delmesher::remesh
