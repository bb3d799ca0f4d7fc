#include "oracles/conformity.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <unordered_map>

#include "oracles/distances.h"

namespace tetproof::oracles {
namespace {

std::uint64_t edge_key(Index a, Index b) {
  return static_cast<std::uint64_t>(a) << 32 | b;
}

// The corners of two triangles are the same in this order, whichever comes first.
bool same_cycle(const Face& a, const Face& b) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (a[0] == b[i]) return a[1] == b[(i + 1) % 3] && a[2] == b[(i + 2) % 3];
  }
  return false;
}

// The check as a whole; the functions appear in the order in which they run.
class Conformity {
 public:
  Conformity(const TetComplex& complex, const Neighbours& neighbours, const InputSurface& surface,
             const ConformityOptions& options)
      : complex_(complex),
        points_(*complex.points),
        neighbours_(neighbours),
        surface_(surface),
        options_(options) {}

  ConformityResult run() {
    collect_faces();
    collect_edges();
    match_vertices();
    follow_edges();
    if (!ended()) grow_patches();
    if (!ended()) check_borders();
    if (!ended()) check_facets();
    result_.report.checked = result_.faces.size();
    result_.report.figures.emplace_back("facets", surface_.facets().size());
    result_.report.figures.emplace_back("edges", surface_.edges().size());
    result_.report.figures.emplace_back("input vertices", surface_.used_vertices().size());
    result_.report.figures.emplace_back("deviation", result_.deviation);
    return std::move(result_);
  }

 private:
  void collect_faces();
  void collect_edges();
  void match_vertices();
  void sort_by_position();
  Index nearest_surface_vertex(Index input_vertex) const;
  void follow_edges();
  bool follow(const InputSurface::Edge& edge, double tolerance, std::vector<Index>& chain) const;
  bool is_chain(const InputSurface::Edge& edge, const std::vector<Index>& chain) const;
  bool find_chain(const InputSurface::Edge& edge, std::vector<Index>& chain) const;
  double progress(const InputSurface::Edge& edge, Index v, double& distance) const;
  bool ended() const { return options_.first_failure_ends && result_.report.violations > 0; }
  bool is_matched(Index v) const { return matched_[v] != 0; }
  bool advances(const InputSurface::Edge& edge, Index here, Index next) const;
  void grow_patches();
  void check_borders();
  void check_border(Index a, std::size_t edge);
  void check_facets();
  bool is_triangle(Index facet, std::span<const Index> triangles,
                   const std::vector<Index>& faces) const;
  void check_facet(Index facet, std::span<const Index> triangles, const std::vector<Index>& faces);
  // Is a point certainly no farther from the line of an edge, or the plane of a facet, than the
  // largest deviation so far? Then its distance need not be known.
  bool surely_seen(const InputSurface::Edge& edge, Index v) const;
  bool surely_seen(const InputSurface::Facet& facet, Index v) const;
  void deviate(double distance) {
    // The few roundings of measuring stay below this factor.
    result_.deviation = std::max(result_.deviation, distance * (1 + 1e-12));
  }
  void fail(const std::string& what) {
    ++result_.failed_elsewhere;
    result_.report.fail(what);
  }
  void fail_edge(const InputSurface::Edge& edge, const std::string& what) {
    result_.failed_edges.push_back(static_cast<Index>(&edge - surface_.edges().data()));
    result_.report.fail(what);
  }
  void fail_facet(Index facet, const std::string& what) {
    result_.failed_facets.push_back(facet);
    result_.report.fail(what);
  }
  std::string input_edge_name(const InputSurface::Edge& e) const {
    return "input edge " + std::to_string(e.from) + "-" + std::to_string(e.to);
  }
  // The directed edges a -> b.
  std::pair<std::size_t, std::size_t> edges_at(Index a, Index b) const {
    if (a >= points_.size()) return {0, 0};
    const auto begin = edges_.begin() + first_edge_[a], end = edges_.begin() + first_edge_[a + 1];
    const auto first = std::lower_bound(
        begin, end, b, [](const DirectedEdge& edge, Index to) { return edge.to < to; });
    auto last = first;
    while (last != end && last->to == b) ++last;
    return {first - edges_.begin(), last - edges_.begin()};
  }
  bool on_boundary(Index v) const { return first_edge_[v] < first_edge_[v + 1]; }
  // The facet on the left of the chain through a directed edge; kNone if there is none.
  Index left_of(std::size_t edge) const { return edges_[edge].chain_facet; }
  bool in_chain(Index a, Index b) const {
    const auto [first, last] = edges_at(a, b);
    return first < last && left_of(first) != kNone;
  }
  bool put_in_chain(Index a, Index b, Index facet);

  const TetComplex& complex_;
  const ExactPoints& points_;
  const Neighbours& neighbours_;
  const InputSurface& surface_;
  const ConformityOptions& options_;
  ConformityResult result_;
  struct DirectedEdge {
    Index to, face;
    Index chain_facet = kNone;  // known at the first of equal edges
  };
  std::vector<DirectedEdge> edges_;      // of the boundary faces, by their start, then by their end
  std::vector<Index> first_edge_;        // per point: its first edge; and the end of the last one
  std::vector<Index> surface_vertices_;  // by their nearest positions, once these are needed
  std::vector<Index> match_;             // input vertex -> mesh vertex
  std::vector<std::uint8_t> matched_;    // per point: is it one of these mesh vertices?
};

void Conformity::collect_faces() {
  for (Index t = 0; t < complex_.tetrahedra.size(); ++t) {
    if (!complex_.inside[t]) continue;
    for (int i = 0; i < 4; ++i) {
      const Index other = neighbours_.across[4 * t + i];
      if (other == kNone || !complex_.inside[other / 4]) {
        result_.faces.push_back(face_of(complex_.tetrahedra[t], i));
      }
    }
  }
  result_.facets.assign(result_.faces.size(), kNone);
}

void Conformity::collect_edges() {
  first_edge_.assign(points_.size() + 1, 0);
  for (const Face& face : result_.faces) {
    for (const Index v : face) ++first_edge_[v + 1];
  }
  std::partial_sum(first_edge_.begin(), first_edge_.end(), first_edge_.begin());
  edges_.resize(3 * result_.faces.size());
  std::vector<Index> next(first_edge_.begin(), first_edge_.end() - 1);
  for (Index f = 0; f < result_.faces.size(); ++f) {
    const Face& face = result_.faces[f];
    for (std::size_t i = 0; i < 3; ++i) edges_[next[face[i]]++] = {face[(i + 1) % 3], f};
  }
  for (Index v = 0; v < points_.size(); ++v) {
    std::sort(edges_.begin() + first_edge_[v], edges_.begin() + first_edge_[v + 1],
              [](const DirectedEdge& a, const DirectedEdge& b) {
                return std::pair(a.to, a.face) < std::pair(b.to, b.face);
              });
  }
}

void Conformity::sort_by_position() {
  if (!surface_vertices_.empty()) return;
  for (Index v = 0; v < points_.size(); ++v) {
    if (on_boundary(v)) surface_vertices_.push_back(v);
  }
  std::sort(surface_vertices_.begin(), surface_vertices_.end(), [&](Index a, Index b) {
    const Position &p = points_.nearest(a), &q = points_.nearest(b);
    return p != q ? p < q : a < b;
  });
}

// Input vertices are matched by equal coordinates; failing that, and if allowed, by distance.
void Conformity::match_vertices() {
  match_.assign(surface_.used_vertices().back() + 1, kNone);
  std::uint64_t moved = 0;
  for (const Index v : surface_.used_vertices()) {
    if (on_boundary(v)) {
      match_[v] = v;
      continue;
    }
    sort_by_position();
    const Position& p = points_.nearest(v);
    auto found = std::lower_bound(
        surface_vertices_.begin(), surface_vertices_.end(), p,
        [&](Index a, const Position& position) { return points_.nearest(a) < position; });
    while (found != surface_vertices_.end() && points_.nearest(*found) == p) {
      if (exact::equal(points_, *found, v)) match_[v] = *found;
      ++found;
    }
    if (match_[v] == kNone && !options_.exact) {
      match_[v] = nearest_surface_vertex(v);
      ++moved;
      if (match_[v] != kNone) {
        deviate(exact::distance(points_, v, match_[v]));
      }
    }
    if (match_[v] == kNone) fail("input vertex " + std::to_string(v) + " is not on the boundary");
  }
  matched_.assign(points_.size(), 0);
  for (const Index v : surface_.used_vertices()) {
    if (match_[v] != kNone) matched_[match_[v]] = 1;
  }
  result_.report.figures.emplace_back("input vertices moved", moved);
  if (moved > 0) result_.report.notes.push_back(std::to_string(moved) + " input vertices moved");
}

Index Conformity::nearest_surface_vertex(Index input_vertex) const {
  const Position p = points_.nearest(input_vertex);
  Index best = kNone;
  double distance = options_.largest_tolerance * surface_.diagonal();
  const auto first =
      std::lower_bound(surface_vertices_.begin(), surface_vertices_.end(), p[0] - distance,
                       [&](Index a, double x) { return points_.nearest(a)[0] < x; });
  for (auto i = first; i != surface_vertices_.end(); ++i) {
    const Position q = points_.nearest(*i);
    if (q[0] > p[0] + distance) break;
    const double d = std::hypot(q[0] - p[0], q[1] - p[1], q[2] - p[2]);
    if (d < distance) {
      distance = d;
      best = *i;
    }
  }
  return best;
}

// Position of v along the edge (0 at its start, 1 at its end) and distance from its line, in
// doubles: for choosing among neighbours when there is a tolerance.
double Conformity::progress(const InputSurface::Edge& edge, Index v, double& distance) const {
  const Position p = points_.nearest(edge.from), q = points_.nearest(edge.to),
                 r = points_.nearest(v);
  double uu = 0, uw = 0, u[3], w[3];
  for (int i = 0; i < 3; ++i) {
    u[i] = q[i] - p[i];
    w[i] = r[i] - p[i];
    uu += u[i] * u[i];
    uw += u[i] * w[i];
  }
  distance =
      std::hypot(u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0]) /
      std::sqrt(uu);
  return uw / uu;
}

// Exactly: is `next` on the line of the edge, beyond `here` and not beyond the edge's end?
bool Conformity::advances(const InputSurface::Edge& edge, Index here, Index next) const {
  return exact::collinear(points_, edge.from, edge.to, next) &&
         exact::dot_sign(points_, edge.from, edge.to, here, next) > 0 &&
         exact::dot_sign(points_, edge.from, edge.to, next, edge.to) >= 0;
}

// A chain of boundary edges from one end of the input edge to the other that stays on it, always
// advancing. Input edges meet at common ends only, so no other input vertex and no edge of another
// chain belongs to it, however close they are.
bool Conformity::follow(const InputSurface::Edge& edge, double tolerance,
                        std::vector<Index>& chain) const {
  const Index goal = match_[edge.to];
  chain = {match_[edge.from]};
  if (edges_at(chain[0], goal).first < edges_at(chain[0], goal).second &&
      !in_chain(chain[0], goal)) {
    chain.push_back(goal);
    return true;
  }
  double distance = 0, reached = progress(edge, chain[0], distance);
  while (chain.back() != goal) {
    Index best = kNone;
    double best_distance = 0, best_progress = 0;
    for (std::size_t i = first_edge_[chain.back()]; i < first_edge_[chain.back() + 1]; ++i) {
      const Index next = edges_[i].to;
      if (next != goal && (is_matched(next) || in_chain(chain.back(), next))) continue;
      const double at = progress(edge, next, distance);
      if (options_.exact) {
        if (!advances(edge, chain.back(), next)) continue;
      } else if (next != goal && (at <= reached || at >= 1 + tolerance ||
                                  distance > tolerance * surface_.diagonal())) {
        continue;
      }
      if (best == kNone || distance < best_distance) {
        best = next;
        best_distance = distance;
        best_progress = at;
      }
    }
    if (best == kNone) return false;
    reached = best_progress;
    chain.push_back(best);
    if (chain.size() > result_.faces.size()) return false;
  }
  return true;
}

// Has a given chain the structure of a chain of the edge?
bool Conformity::is_chain(const InputSurface::Edge& edge, const std::vector<Index>& chain) const {
  if (chain.size() < 2 || chain.front() != match_[edge.from] || chain.back() != match_[edge.to]) {
    return false;
  }
  for (std::size_t i = 1; i < chain.size(); ++i) {
    const auto [first, last] = edges_at(chain[i - 1], chain[i]);
    if (first == last || left_of(first) != kNone) return false;
    if (i + 1 < chain.size() && is_matched(chain[i])) return false;
  }
  return true;
}

bool Conformity::find_chain(const InputSurface::Edge& edge, std::vector<Index>& chain) const {
  if (options_.exact) return follow(edge, 0, chain);
  if (options_.chains != nullptr) {
    const auto& given = (*options_.chains)[&edge - surface_.edges().data()];
    if (is_chain(edge, given)) {
      chain = given;
      return true;
    }
  }
  for (double tolerance = std::min(1e-15, options_.largest_tolerance);
       tolerance <= options_.largest_tolerance; tolerance *= 100) {
    if (follow(edge, tolerance, chain)) return true;
  }
  return false;
}

// The square of a height times a length is at most the square of the deviation so far times the
// square of the length, with far more room than the roundings of measuring take.
bool Conformity::surely_seen(const InputSurface::Edge& edge, Index v) const {
  const IntervalVector along = points_.rough_difference(edge.from, edge.to);
  const IntervalVector off = exact::cross(along, points_.rough_difference(edge.from, v));
  const double most = result_.deviation * (1 - 1e-9);
  return exact::dot(off, off).high <= most * most * exact::dot(along, along).low;
}

bool Conformity::surely_seen(const InputSurface::Facet& facet, Index v) const {
  const IntervalVector& normal = facet.rough_normal;
  const Interval off = exact::dot(normal, points_.rough_difference(facet.span[0], v));
  const double most = result_.deviation * (1 - 1e-9);
  return (off * off).high <= most * most * exact::dot(normal, normal).low;
}

// Says that a facet is to the left of a directed edge; false if that was said before. An edge of no
// face is left to check_borders.
bool Conformity::put_in_chain(Index a, Index b, Index facet) {
  const auto [first, last] = edges_at(a, b);
  if (first == last) return true;
  if (left_of(first) != kNone) return false;
  edges_[first].chain_facet = facet;
  return true;
}

void Conformity::follow_edges() {
  std::vector<Index> chain;
  if (options_.want_chains) result_.chains.resize(surface_.edges().size());
  for (const InputSurface::Edge& edge : surface_.edges()) {
    if (ended()) return;
    if (match_[edge.from] == kNone || match_[edge.to] == kNone) continue;  // already reported
    if (!find_chain(edge, chain)) {
      fail_edge(edge, input_edge_name(edge) + " is not a chain of boundary edges; it ends at " +
                          complex_.vertex_name(chain.back()));
      continue;
    }
    if (options_.want_chains) result_.chains[&edge - surface_.edges().data()] = chain;
    for (std::size_t i = 1; i < chain.size(); ++i) {
      const bool fresh = put_in_chain(chain[i - 1], chain[i], edge.left);
      const bool back = put_in_chain(chain[i], chain[i - 1], edge.right);
      if (!fresh || !back) {
        fail_edge(edge, input_edge_name(edge) + " shares boundary edge " +
                            complex_.vertex_name(chain[i - 1]) + " - " +
                            complex_.vertex_name(chain[i]) + " with another input edge");
      }
      ++result_.chain_edges;
      if (options_.exact || surely_seen(edge, chain[i])) continue;
      if (exact::equal(points_, chain[i], edge.to)) continue;
      const ExactVector direction = exact::difference(points_, edge.from, edge.to);
      const ExactVector off =
          exact::cross(direction, exact::difference(points_, edge.from, chain[i]));
      if (!exact::is_zero(off)) {
        deviate(length(off, 2 * points_.exponent()) / length(direction, points_.exponent()));
      }
    }
  }
  result_.report.figures.emplace_back("edges of chains", result_.chain_edges);
}

// Faces beside a chain belong to the facet on that side, and so do those reached without crossing a
// chain.
void Conformity::grow_patches() {
  std::vector<Index> queue;
  const auto reach = [&](Index face, Index facet) {
    if (result_.facets[face] != kNone) return;
    result_.facets[face] = facet;
    queue.push_back(face);
  };
  for (Index v = 0; v < points_.size(); ++v) {
    for (std::size_t i = first_edge_[v]; i < first_edge_[v + 1]; ++i) {
      const auto [first, last] = edges_at(v, edges_[i].to);
      if (left_of(first) != kNone) reach(edges_[i].face, left_of(first));
    }
  }
  while (!queue.empty()) {
    const Index f = queue.back();
    queue.pop_back();
    const Face face = result_.faces[f];
    for (std::size_t i = 0; i < 3; ++i) {
      const Index a = face[i], b = face[(i + 1) % 3];
      if (in_chain(a, b)) continue;
      const auto [first, last] = edges_at(b, a);
      for (std::size_t k = first; k < last; ++k) reach(edges_[k].face, result_.facets[f]);
    }
  }
  for (std::size_t f = 0; f < result_.faces.size(); ++f) {
    if (result_.facets[f] == kNone) {
      fail("boundary " + complex_.face_name(result_.faces[f]) + " lies on no input facet");
    }
  }
}

// Each boundary edge has one face on either side; they belong to the same facet, or the edge is in
// a chain that separates just these two facets.
void Conformity::check_borders() {
  for (Index a = 0; a < points_.size(); ++a) {
    for (std::size_t i = first_edge_[a]; i < first_edge_[a + 1]; ++i) check_border(a, i);
  }
}

void Conformity::check_border(Index a, std::size_t edge) {
  const Index b = edges_[edge].to;
  const auto [first, last] = edges_at(b, a);
  const auto name = [&] {
    return "boundary edge " + complex_.vertex_name(a) + " - " + complex_.vertex_name(b);
  };
  if (last - first != 1 || (edge > first_edge_[a] && edges_[edge - 1].to == b)) {
    return fail(name() + " has not one face on either side");
  }
  const Index mine = result_.facets[edges_[edge].face], other = result_.facets[edges_[first].face];
  const Index wanted = left_of(edge) == kNone ? other : left_of(edge);
  if (mine != wanted && mine != kNone && wanted != kNone) {
    fail_facet(mine, name() + " separates facets " + std::to_string(surface_.facets()[mine].id) +
                         " and " + std::to_string(surface_.facets()[wanted].id) +
                         ", which do not meet there");
  }
}

void Conformity::check_facets() {
  std::vector<std::vector<Index>> patches(surface_.facets().size());
  for (Index f = 0; f < result_.faces.size(); ++f) {
    if (result_.facets[f] != kNone) patches[result_.facets[f]].push_back(f);
  }
  const InputSurface::Members members = surface_.members();
  for (Index facet = 0; facet < patches.size() && !ended(); ++facet) {
    if (!is_triangle(facet, members.of(facet), patches[facet])) {
      check_facet(facet, members.of(facet), patches[facet]);
    }
  }
}

// Is the facet a triangle, and tiled by a face on the same three points, so that there is nothing
// to decide?
bool Conformity::is_triangle(Index facet, std::span<const Index> triangles,
                             const std::vector<Index>& faces) const {
  if (triangles.size() != 1 || faces.size() != 1) return false;
  Face corners = surface_.triangles()[triangles[0]];
  for (Index& v : corners) {
    if (match_[v] == kNone || !exact::equal(points_, v, match_[v])) return false;
    v = match_[v];
  }
  const Face& face = result_.faces[faces[0]];
  return same_cycle(face, corners) && surface_.facets()[facet].facing(points_, face) > 0;
}

void Conformity::check_facet(Index facet, std::span<const Index> triangles,
                             const std::vector<Index>& faces) {
  const InputSurface::Facet& input = surface_.facets()[facet];
  const std::string name = "facet " + std::to_string(input.id);
  if (faces.empty()) return fail_facet(facet, name + " has no boundary faces");
  std::vector<Face> corners;
  std::vector<Index> vertices;
  std::vector<std::uint64_t> edges;
  std::uint64_t folded = 0;
  for (const Index f : faces) {
    const Face& face = result_.faces[f];
    corners.push_back(face);
    for (std::size_t i = 0; i < 3; ++i) {
      vertices.push_back(face[i]);
      edges.push_back(
          edge_key(std::min(face[i], face[(i + 1) % 3]), std::max(face[i], face[(i + 1) % 3])));
    }
    if (input.facing(points_, face) <= 0) {
      ++folded;
      if (options_.exact)
        fail_facet(facet, "boundary " + complex_.face_name(face) + " is folded over on " + name);
    }
  }
  const auto make_unique = [](auto& list) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  };
  make_unique(vertices);
  make_unique(edges);
  for (const Index v : vertices) {
    if (!options_.exact && surely_seen(input, v)) continue;
    if (input.side(points_, v) == 0) continue;
    const ExactVector normal = input.area2(points_);
    const ExactNumber off = exact::dot(normal, exact::difference(points_, input.span[0], v));
    const double distance =
        std::fabs(to_double(off, 3 * points_.exponent())) / length(normal, 2 * points_.exponent());
    const double most = options_.off_plane > 0 ? options_.off_plane
                                               : options_.largest_tolerance * surface_.diagonal();
    if (options_.exact || !(distance <= most)) {
      fail_facet(facet, complex_.vertex_name(v) + " is off the plane of " + name);
    } else {
      deviate(distance);
    }
  }
  // Rounded vertices change the area.
  if (options_.exact && !(sum_of_areas2(points_, corners) == surface_.area2(points_, triangles)))
    fail_facet(facet, "the faces on " + name + " do not add up to it");
  const std::int64_t euler = static_cast<std::int64_t>(vertices.size() + faces.size()) -
                             static_cast<std::int64_t>(edges.size());
  if (euler != input.euler)
    fail_facet(facet, "the faces on " + name + " have another topology than it");
  if (folded > 0 && !options_.exact) {
    result_.report.notes.push_back(std::to_string(folded) + " faces folded over on " + name);
  }
}

// Is the root of a squared distance at most `distance`?
bool within(const ExactPoints& points, const mpq_class& squared, double distance) {
  return square_root(squared, points.exponent()) <= distance;
}

// Does the bounding box of an edge, widened, contain a vertex?
bool boxed(const ExactPoints& points, const InputSurface::Edge& edge, Index v, double distance) {
  const Position p = points.nearest(edge.from), q = points.nearest(edge.to), x = points.nearest(v);
  for (std::size_t i = 0; i < 3; ++i) {
    if (x[i] < std::min(p[i], q[i]) - 2 * distance || x[i] > std::max(p[i], q[i]) + 2 * distance) {
      return false;
    }
  }
  return true;
}

// Finds the edges for which a file cannot tell whether a vertex is on them or on another edge.
class Ambiguity {
 public:
  Ambiguity(const TetComplex& complex, const InputSurface& surface,
            const ConformityResult& conformity, double distance)
      : points_(*complex.points), surface_(surface), distance_(distance) {
    for (const Face& face : conformity.faces) {
      vertices_.insert(vertices_.end(), face.begin(), face.end());
    }
    std::sort(vertices_.begin(), vertices_.end());
    vertices_.erase(std::unique(vertices_.begin(), vertices_.end()), vertices_.end());
  }

  bool at(Index edge) const {
    return std::any_of(vertices_.begin(), vertices_.end(), [&](Index v) {
      const InputSurface::Edge& e = surface_.edges()[edge];
      if (!near(e, v) || exact::equal(points_, v, e.from) || exact::equal(points_, v, e.to)) {
        return false;
      }
      return std::any_of(
          surface_.edges().begin(), surface_.edges().end(),
          [&](const InputSurface::Edge& other) { return &other != &e && near(other, v); });
    });
  }

 private:
  bool near(const InputSurface::Edge& edge, Index v) const {
    return boxed(points_, edge, v, distance_) &&
           within(points_, squared_distance_to_segment(points_, v, edge.from, edge.to), distance_);
  }

  const ExactPoints& points_;
  const InputSurface& surface_;
  double distance_;
  std::vector<Index> vertices_;
};

// Is every face of the boundary, with all its corners, within `distance` of one facet?
bool along_surface(const TetComplex& complex, const InputSurface& surface,
                   const std::vector<Face>& faces, double distance) {
  const ExactPoints& points = *complex.points;
  std::unordered_map<Index, std::vector<Index>> near;  // the facets near each vertex, sorted
  std::vector<Index> found;
  const auto facets_near = [&](Index v) -> const std::vector<Index>& {
    const auto [at, fresh] = near.try_emplace(v);
    if (!fresh) return at->second;
    found.clear();
    surface.triangles_near(enlarged(box_around(points, std::array{v}), 2 * distance), found);
    for (const Index t : found) {
      const auto& triangle = surface.triangles()[t];
      if (!within(points, squared_distance_to_triangle(points, v, triangle), distance)) continue;
      at->second.push_back(surface.facet_of_triangle()[t]);
    }
    std::sort(at->second.begin(), at->second.end());
    at->second.erase(std::unique(at->second.begin(), at->second.end()), at->second.end());
    return at->second;
  };
  return std::all_of(faces.begin(), faces.end(), [&](const Face& face) {
    const std::vector<Index> first = facets_near(face[0]);
    return std::any_of(first.begin(), first.end(), [&](Index f) {
      const auto has = [&](Index v) {
        const std::vector<Index>& list = facets_near(v);
        return std::binary_search(list.begin(), list.end(), f);
      };
      return has(face[1]) && has(face[2]);
    });
  });
}

}  // namespace

bool undecidable(const TetComplex& complex, const InputSurface& surface,
                 const ConformityResult& conformity, double distance) {
  if (conformity.failed_elsewhere > 0 || conformity.report.passed()) return false;
  if (!along_surface(complex, surface, conformity.faces, distance)) return false;
  const Ambiguity ambiguity(complex, surface, conformity, distance);
  const auto& edges = surface.edges();
  return std::all_of(conformity.failed_edges.begin(), conformity.failed_edges.end(),
                     [&](Index e) { return ambiguity.at(e); }) &&
         std::all_of(conformity.failed_facets.begin(), conformity.failed_facets.end(),
                     [&](Index facet) {
                       for (Index e = 0; e < edges.size(); ++e) {
                         if (edges[e].left != facet && edges[e].right != facet) continue;
                         if (ambiguity.at(e)) return true;
                       }
                       return false;
                     });
}

ConformityResult check_conformity(const TetComplex& complex, const Neighbours& neighbours,
                                  const InputSurface& surface, const ConformityOptions& options) {
  return Conformity(complex, neighbours, surface, options).run();
}

OracleReport check_boundary_list(const TetComplex& complex, const Neighbours& neighbours,
                                 const InputSurface& surface, const ConformityResult& conformity,
                                 const std::vector<Face>& listed,
                                 const std::vector<std::int32_t>& labels) {
  OracleReport report("boundary-list", "listed triangles");
  const auto sorted = [](Face face) {
    std::sort(face.begin(), face.end());
    return face;
  };
  std::vector<std::pair<Face, Index>> actual;
  for (Index f = 0; f < conformity.faces.size(); ++f) {
    actual.emplace_back(sorted(conformity.faces[f]), f);
  }
  std::sort(actual.begin(), actual.end());
  std::vector<std::uint8_t> found(actual.size(), 0);
  std::vector<Face> hull;
  for (Index i = 0; i < neighbours.across.size(); ++i) {
    if (neighbours.across[i] != kNone || complex.inside[i / 4]) continue;
    hull.push_back(sorted(face_of(complex.tetrahedra[i / 4], static_cast<int>(i % 4))));
  }
  std::sort(hull.begin(), hull.end());
  for (std::size_t i = 0; i < listed.size(); ++i) {
    ++report.checked;
    const auto at =
        std::lower_bound(actual.begin(), actual.end(), std::pair(sorted(listed[i]), Index{0}));
    if (at == actual.end() || at->first != sorted(listed[i])) {
      if (std::binary_search(hull.begin(), hull.end(), sorted(listed[i]))) continue;
      report.fail("listed triangle " + std::to_string(i) + " is no boundary face of the solid");
      continue;
    }
    if (found[at - actual.begin()]++) {
      report.fail("listed triangle " + std::to_string(i) + " is listed twice");
    }
    const Index facet = conformity.facets[at->second];
    if (!labels.empty() && facet != kNone && surface.facets()[facet].label != labels[i]) {
      report.fail("listed triangle " + std::to_string(i) + " has label " +
                  std::to_string(labels[i]) + ", its facet " +
                  std::to_string(surface.facets()[facet].label));
    }
  }
  for (std::size_t i = 0; i < actual.size(); ++i) {
    if (!found[i]) report.fail("boundary " + complex.face_name(actual[i].first) + " is not listed");
  }
  return report;
}

}  // namespace tetproof::oracles
