#include "oracles/mesh/conformity.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <span>

#include "oracles/base/buckets.h"
#include "oracles/base/distances.h"
#include "oracles/base/edge_key.h"
#include "oracles/base/triangle_distance.h"
#include "oracles/mesh/edge_chains.h"

namespace tetproof::oracles {
namespace {

// The corners of two triangles are the same in this order, whichever comes first.
bool same_cycle(const Face& a, const Face& b) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (a[0] == b[i]) return a[1] == b[(i + 1) % 3] && a[2] == b[(i + 2) % 3];
  }
  return false;
}

// The square of a height times a length is at most the square of a distance times the square of the
// length, with far more room than the roundings of measuring take. Squares that over- or underflow
// are sure of nothing.
bool surely_at_most(const Interval& squared, double distance, const Interval& squared_length) {
  const double most = distance * (1 - 1e-9), bound = most * most * squared_length.low;
  return most * most > 0x1p-900 && bound < HUGE_VAL && squared.high <= bound;
}

template <class T>
void make_unique(std::vector<T>& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
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
    edges_.emplace(result_.faces, points_.size());
    match_vertices();
    follow_edges();
    result_.off_edges = result_.deviation;
    result_.off_edges_ulps = result_.ulps;
    if (!ended()) grow_patches();
    if (!ended()) check_borders();
    if (!ended()) check_facets();
    name_failed_triangles();
    result_.report.checked = result_.faces.size();
    result_.report.figures.emplace_back("facets", surface_.facets().size());
    result_.report.figures.emplace_back("edges", surface_.edges().size());
    result_.report.figures.emplace_back("input vertices", surface_.used_vertices().size());
    result_.report.figures.emplace_back("deviation", result_.deviation);
    return std::move(result_);
  }

 private:
  void collect_faces();
  void match_vertices();
  void follow_edges();
  void put_in_chains(const InputSurface::Edge& edge, const std::vector<Index>& chain);
  bool ended() const { return options_.first_failure_ends && result_.report.violations > 0; }
  void grow_patches();
  void check_borders();
  void check_border(Index a, std::size_t edge);
  void check_facets();
  void name_failed_triangles();
  bool is_triangle(Index facet, std::span<const Index> triangles,
                   std::span<const Index> faces) const;
  void check_facet(Index facet, std::span<const Index> triangles, std::span<const Index> faces);
  std::vector<Face> folded_faces(Index facet, const std::vector<Face>& faces) const;
  void check_folded(Index facet, const std::vector<Face>& folded, std::span<const Index> triangles);
  double width_of(const Face& face) const;
  double reach_of(const Face& face, std::span<const Corners> triangles, double least,
                  double most) const;
  void check_in_plane(Index facet, Index v);
  // How far a vertex may be off the plane of its facet, in input units.
  double plane_tolerance(Index facet) const {
    return options_.off_plane > 0 ? surface_.facets()[facet].slab + options_.off_plane
                                  : options_.largest_tolerance * surface_.diagonal();
  }
  double most_off_plane(Index facet, double distance);
  // Is a point certainly no farther from the line of an edge, or the plane of a facet, than the
  // largest deviation so far? Then its distance need not be known.
  bool surely_seen(const InputSurface::Edge& edge, Index v) const;
  bool surely_seen(const InputSurface::Facet& facet, Index v) const;
  double ulp_on(const auto& place) const { return surface_.ulp_on(place, options_.largest_given); }
  void deviate(double distance, double ulp) {
    // The few roundings of measuring stay below this factor.
    distance *= 1 + 1e-12;
    result_.deviation = std::max(result_.deviation, distance);
    result_.ulps = std::max(result_.ulps, distance / ulp);
  }
  // No point within this distance changes what is known.
  double known_deviation(double ulp) const {
    return std::min(result_.deviation, result_.ulps * ulp);
  }
  void fail(const std::string& what, const Site& site) {
    ++result_.failed_elsewhere;
    result_.report.fail(what, site);
  }
  void fail_edge(const InputSurface::Edge& edge, const std::string& what) {
    result_.failed_edges.push_back(static_cast<Index>(&edge - surface_.edges().data()));
    result_.report.fail(what, {Site::Kind::input_edge, {edge.from, edge.to, 0}});
  }
  // All triangles of the facet are named in the end.
  void fail_facet(Index facet, const std::string& what, const std::optional<Site>& site = {}) {
    result_.failed_facets.push_back(facet);
    const Site any = {Site::Kind::input_triangle, {surface_.facets()[facet].id, 0, 0}};
    result_.report.fail(what, Spot{site.value_or(any)});
    if (site) result_.report.add_site(*site);
  }
  std::string facet_name(Index facet) const {
    return "facet " + std::to_string(surface_.facets()[facet].id);
  }
  static std::string input_edge_name(const InputSurface::Edge& e) {
    return "input edge " + std::to_string(e.from) + "-" + std::to_string(e.to);
  }

  const TetComplex& complex_;
  const ExactPoints& points_;
  const Neighbours& neighbours_;
  const InputSurface& surface_;
  const ConformityOptions& options_;
  ConformityResult result_;
  std::optional<BoundaryEdges> edges_;  // of the boundary faces
  std::optional<VertexMatch> match_;
  std::map<Index, bool> flat_with_another_;  // of the facets that were asked about
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

void Conformity::match_vertices() {
  match_.emplace(points_, *edges_, surface_, options_);
  for (const Index v : surface_.used_vertices()) {
    if (match_->of(v) == kNone) {
      fail("input vertex " + std::to_string(v) + " is not on the boundary",
           {Site::Kind::input_vertex, {v, 0, 0}});
    }
  }
  const std::vector<Index>& moved = match_->moved();
  result_.report.figures.emplace_back("input vertices moved", moved.size());
  if (moved.empty()) return;
  result_.report.notes.push_back(std::to_string(moved.size()) + " input vertices moved");
  std::vector<double> ulp(points_.size(), HUGE_VAL);
  for (Index t = 0; t < surface_.triangles().size(); ++t) {
    const double here = ulp_on(surface_.facet_of_triangle()[t]);
    for (const Index v : surface_.triangles()[t]) ulp[v] = std::min(ulp[v], here);
  }
  for (const Index v : moved) {
    if (match_->of(v) != kNone) deviate(exact::distance(points_, v, match_->of(v)), ulp[v]);
  }
}

void Conformity::follow_edges() {
  const EdgeChains chains(points_, *edges_, surface_, *match_, options_);
  std::vector<Index> chain;
  for (const InputSurface::Edge& edge : surface_.edges()) {
    if (ended()) return;
    const bool reported = match_->of(edge.from) == kNone || match_->of(edge.to) == kNone;
    const bool found = !reported && chains.find(edge, chain);
    if (options_.want_chains) result_.chains.add(std::span(chain).first(found ? chain.size() : 0));
    if (found) {
      put_in_chains(edge, chain);
    } else if (!reported) {
      fail_edge(edge, input_edge_name(edge) + " is not a chain of boundary edges; it ends at " +
                          complex_.vertex_name(chain.back()));
    }
  }
  result_.report.figures.emplace_back("edges of chains", result_.chain_edges);
}

void Conformity::put_in_chains(const InputSurface::Edge& edge, const std::vector<Index>& chain) {
  for (std::size_t i = 1; i < chain.size(); ++i) {
    const bool fresh = edges_->put_in_chain(chain[i - 1], chain[i], edge.left);
    const bool back = edges_->put_in_chain(chain[i], chain[i - 1], edge.right);
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
      deviate(length_over(off, direction, points_.exponent()), ulp_on(edge));
    }
  }
}

bool Conformity::surely_seen(const InputSurface::Edge& edge, Index v) const {
  const IntervalVector along = points_.rough_difference(edge.from, edge.to);
  const IntervalVector off = exact::cross(along, points_.rough_difference(edge.from, v));
  return surely_at_most(exact::dot(off, off), known_deviation(ulp_on(edge)),
                        exact::dot(along, along));
}

bool Conformity::surely_seen(const InputSurface::Facet& facet, Index v) const {
  const IntervalVector& normal = facet.rough_normal;
  const Interval off = exact::dot(normal, points_.rough_difference(facet.span[0], v));
  // What is farther than this may be too far for this facet, however far others reach.
  const double own = options_.off_plane > 0 ? facet.slab + options_.off_plane : HUGE_VAL;
  const Index number = static_cast<Index>(&facet - surface_.facets().data());
  return surely_at_most(off * off, std::min(known_deviation(ulp_on(number)), own),
                        exact::dot(normal, normal));
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
    const auto [begin, end] = edges_->from(v);
    for (std::size_t i = begin; i < end; ++i) {
      const Index facet = edges_->left_of(edges_->between(v, (*edges_)[i].to).first);
      if (facet != kNone) reach((*edges_)[i].face, facet);
    }
  }
  while (!queue.empty()) {
    const Index f = queue.back();
    queue.pop_back();
    const Face face = result_.faces[f];
    for (std::size_t i = 0; i < 3; ++i) {
      const Index a = face[i], b = face[(i + 1) % 3];
      if (edges_->in_chain(a, b)) continue;
      const auto [first, last] = edges_->between(b, a);
      for (std::size_t k = first; k < last; ++k) reach((*edges_)[k].face, result_.facets[f]);
    }
  }
  for (std::size_t f = 0; f < result_.faces.size(); ++f) {
    if (result_.facets[f] == kNone) {
      fail("boundary " + complex_.face_name(result_.faces[f]) + " lies on no input facet",
           complex_.face_site(result_.faces[f]));
    }
  }
}

// Each boundary edge has one face on either side; they belong to the same facet, or the edge is in
// a chain that separates just these two facets.
void Conformity::check_borders() {
  for (Index a = 0; a < points_.size(); ++a) {
    const auto [begin, end] = edges_->from(a);
    for (std::size_t i = begin; i < end; ++i) check_border(a, i);
  }
}

void Conformity::check_border(Index a, std::size_t edge) {
  const BoundaryEdges& edges = *edges_;
  const Index b = edges[edge].to;
  const BoundaryEdges::Range back = edges.between(b, a);
  const auto name = [&] {
    return "boundary edge " + complex_.vertex_name(a) + " - " + complex_.vertex_name(b);
  };
  const bool again = edge > edges.from(a).first && edges[edge - 1].to == b;
  if (back.size() != 1 || again) {
    return fail(name() + " does not have one face on either side", complex_.edge_site(a, b));
  }
  const Index mine = result_.facets[edges[edge].face],
              other = result_.facets[edges[back.first].face];
  const Index wanted = edges.left_of(edge) == kNone ? other : edges.left_of(edge);
  if (mine != wanted && mine != kNone && wanted != kNone) {
    fail_facet(mine,
               name() + " separates facets " + std::to_string(surface_.facets()[mine].id) +
                   " and " + std::to_string(surface_.facets()[wanted].id) +
                   ", which do not meet there",
               complex_.edge_site(a, b));
  }
}

void Conformity::check_facets() {
  Buckets patches(surface_.facets().size());
  for (const Index facet : result_.facets) {
    if (facet != kNone) patches.count(facet);
  }
  patches.allot();
  for (Index f = 0; f < result_.faces.size(); ++f) {
    if (result_.facets[f] != kNone) patches.put(result_.facets[f], f);
  }
  const InputSurface::Members members = surface_.members();
  for (Index facet = 0; facet < surface_.facets().size() && !ended(); ++facet) {
    if (!is_triangle(facet, members.of(facet), patches.of(facet))) {
      check_facet(facet, members.of(facet), patches.of(facet));
    }
  }
}

void Conformity::name_failed_triangles() {
  std::vector<Index> failed = result_.failed_facets;
  if (failed.empty()) return;
  make_unique(failed);
  const InputSurface::Members members = surface_.members();
  for (const Index facet : failed) {
    for (const Index t : members.of(facet)) {
      result_.report.add_site({Site::Kind::input_triangle, {t, 0, 0}});
    }
  }
}

// Is the facet a triangle, and tiled by a face on the same three points, so that there is nothing
// to decide?
bool Conformity::is_triangle(Index facet, std::span<const Index> triangles,
                             std::span<const Index> faces) const {
  if (triangles.size() != 1 || faces.size() != 1) return false;
  Face corners = surface_.triangles()[triangles[0]];
  for (Index& v : corners) {
    if (match_->of(v) == kNone || !exact::equal(points_, v, match_->of(v))) return false;
    v = match_->of(v);
  }
  const Face& face = result_.faces[faces[0]];
  return same_cycle(face, corners) && surface_.facets()[facet].facing(points_, face) > 0;
}

void Conformity::check_facet(Index facet, std::span<const Index> triangles,
                             std::span<const Index> faces) {
  const InputSurface::Facet& input = surface_.facets()[facet];
  const std::string name = facet_name(facet);
  if (faces.empty()) return fail_facet(facet, name + " has no boundary faces");
  std::vector<Face> corners;
  std::vector<Index> vertices;
  std::vector<std::uint64_t> edges;
  for (const Index f : faces) {
    const Face& face = result_.faces[f];
    corners.push_back(face);
    for (std::size_t i = 0; i < 3; ++i) {
      vertices.push_back(face[i]);
      edges.push_back(edge_key(face[i], face[(i + 1) % 3]));
    }
  }
  make_unique(vertices);
  make_unique(edges);
  for (const Index v : vertices) check_in_plane(facet, v);
  if (const std::vector<Face> folded = folded_faces(facet, corners); !folded.empty()) {
    check_folded(facet, folded, triangles);
  }
  // Rounded vertices change the area.
  if (options_.exact && surface_.excess2(points_, corners, triangles) != std::array<ExactSum, 3>{})
    fail_facet(facet, "the faces on " + name + " do not add up to it");
  const std::int64_t euler = static_cast<std::int64_t>(vertices.size() + faces.size()) -
                             static_cast<std::int64_t>(edges.size());
  if (euler != input.euler)
    fail_facet(facet, "the faces on " + name + " have another topology than it");
}

// Those turned against their facet.
std::vector<Face> Conformity::folded_faces(Index facet, const std::vector<Face>& faces) const {
  std::vector<Face> folded;
  for (const Face& face : faces) {
    if (surface_.facets()[facet].facing(points_, face) <= 0) folded.push_back(face);
  }
  return folded;
}

// The smallest altitude.
double Conformity::width_of(const Face& face) const {
  const ExactVector sides[] = {exact::difference(points_, face[0], face[1]),
                               exact::difference(points_, face[1], face[2]),
                               exact::difference(points_, face[2], face[0])};
  const ExactVector area2 = exact::cross(sides[0], sides[1]);
  double width = HUGE_VAL;
  for (const ExactVector& side : sides) {
    if (exact::is_zero(side)) return 0;
    width = std::min(width, length_over(area2, side, points_.exponent()));
  }
  return width;
}

// Rounding that moves points by some distance turns over a face whose altitude is at most twice
// that, and leaves it within the distance of the facet.
void Conformity::check_folded(Index facet, const std::vector<Face>& folded,
                              std::span<const Index> triangles) {
  const auto fail_folded = [&](const Face& face) {
    fail_facet(facet,
               "boundary " + complex_.face_name(face) + " is folded over on " + facet_name(facet),
               complex_.face_site(face));
  };
  if (options_.exact) {
    for (const Face& face : folded) fail_folded(face);
    return;
  }
  std::vector<Corners> corners;
  for (const Index t : triangles) {
    Corners& triangle = corners.emplace_back();
    for (std::size_t i = 0; i < 3; ++i) triangle[i] = points_.nearest(surface_.triangles()[t][i]);
  }
  const double widest = 2 * plane_tolerance(facet), most = most_off_plane(facet, HUGE_VAL);
  double distance = std::min(known_deviation(ulp_on(facet)), most);
  for (const Face& face : folded) {
    const double width = width_of(face);
    if (!(width <= widest)) return fail_folded(face);
    distance = reach_of(face, corners, std::max(distance, width / 2), most);
    if (!(distance <= most)) return fail_folded(face);
  }
  deviate(distance, ulp_on(facet));
  result_.report.notes.push_back(std::to_string(folded.size()) + " faces folded over on " +
                                 facet_name(facet));
}

// A distance, at least `least`, within which every point of the sides of a face is of the
// triangles, known to a factor; infinite if it is larger than `most`.
double Conformity::reach_of(const Face& face, std::span<const Corners> triangles, double least,
                            double most) const {
  constexpr double kFactor = 1.05;
  // Doubles tell nothing smaller.
  double distance = std::max(least, surface_.largest_coordinate() * 0x1p-55);
  for (const Index v : face) {
    double nearest = HUGE_VAL;
    for (const Corners& triangle : triangles) {
      nearest = std::min(nearest, distance_to_triangle(points_.nearest(v), triangle));
    }
    distance = std::max(distance, nearest);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const Position &a = points_.nearest(face[i]), &b = points_.nearest(face[(i + 1) % 3]);
    const auto is_near = [&](double d) { return is_segment_near(a, b, triangles, d); };
    double below = distance;
    while (!(distance <= most && is_near(distance))) {
      if (!(distance < most)) return HUGE_VAL;
      below = distance;
      distance = std::min(2 * distance, most);
    }
    while (distance > kFactor * below) {
      const double middle = std::sqrt(distance) * std::sqrt(below);
      (is_near(middle) ? distance : below) = middle;
    }
  }
  return distance;
}

// How far a vertex may be off the plane of its facet, where one is so far.
double Conformity::most_off_plane(Index facet, double distance) {
  const double most = plane_tolerance(facet);
  if (distance <= most || !(options_.off_plane > 0) || options_.planar == 0) return most;
  const auto [known, fresh] = flat_with_another_.try_emplace(facet, false);
  if (fresh) known->second = surface_.is_flat_with_another(facet, options_.planar, points_);
  return known->second ? options_.planar + options_.off_plane : most;
}

void Conformity::check_in_plane(Index facet, Index v) {
  const InputSurface::Facet& input = surface_.facets()[facet];
  if (!options_.exact && surely_seen(input, v)) return;
  if (input.side(points_, v) == 0) return;
  const ExactVector normal = input.area2(points_);
  const ExactNumber off = exact::dot(normal, exact::difference(points_, input.span[0], v));
  const double distance = std::fabs(component(off, normal, points_.exponent()));
  if (options_.exact || !(distance <= most_off_plane(facet, distance))) {
    fail_facet(facet, complex_.vertex_name(v) + " is off the plane of " + facet_name(facet),
               complex_.vertex_site(v));
  } else {
    deviate(distance, ulp_on(facet));
  }
}

}  // namespace

ConformityResult check_conformity(const TetComplex& complex, const Neighbours& neighbours,
                                  const InputSurface& surface, const ConformityOptions& options) {
  return Conformity(complex, neighbours, surface, options).run();
}

}  // namespace tetproof::oracles
