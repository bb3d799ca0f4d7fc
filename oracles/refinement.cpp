#include "oracles/refinement.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "oracles/ball_side.h"
#include "oracles/sample.h"
#include "oracles/simplex_set.h"

namespace tetproof::oracles {
namespace {

using delmesher::ExactPoint;
using delmesher::ExactRecord;

std::uint64_t directed_key(Index a, Index b) {
  return static_cast<std::uint64_t>(a) << 32 | b;
}
std::uint64_t edge_key(Index a, Index b) {
  return directed_key(std::min(a, b), std::max(a, b));
}

SimplexSet<2> edges_of_chains(const ExactRecord& record) {
  std::vector<std::array<Index, 2>> edges;
  for (const ExactRecord::Chain& chain : record.segments) {
    for (std::size_t i = 1; i < chain.vertices.size(); ++i) {
      edges.push_back({chain.vertices[i - 1], chain.vertices[i]});
    }
  }
  return SimplexSet<2>(edges);
}

SimplexSet<3> faces_on_facets(const ExactRecord& record) {
  std::vector<Face> faces;
  faces.reserve(record.refined_facets.size());
  for (const auto& [a, b, c, id] : record.refined_facets) faces.push_back({a, b, c});
  return SimplexSet<3>(faces);
}

std::string chain_name(std::size_t n, const ExactRecord::Chain& chain) {
  return (chain.artificial ? "artificial segment " : "segment ") + std::to_string(n);
}

// --- chains

class Segments {
 public:
  explicit Segments(const RefinedMesh& mesh)
      : record_(*mesh.record),
        points_(*mesh.points),
        surface_(*mesh.surface),
        complex_(*mesh.complex),
        facets_(surface_, record_),
        input_edges_(surface_),
        edges_(edges_of_chains(record_)),
        in_mesh_(edges_.size()),
        chain_of_(edges_.size(), kNone),
        first_(surface_.edges().size(), kNone),
        last_(surface_.edges().size(), kNone) {
    for (const auto& corner : record_.corners) corner_[corner.vertex] = &corner;
  }

  OracleReport run() {
    if (!facets_.defect().empty()) report_.fail(facets_.defect());
    find_mesh_edges();
    for (std::size_t n = 0; n < record_.segments.size(); ++n) {
      const ExactRecord::Chain& chain = record_.segments[n];
      if (!check_mesh_edges(n, chain)) continue;
      chain.artificial ? check_artificial(n, chain) : check_input(n, chain);
    }
    check_ends();
    report_.checked += surface_.edges().size();
    report_.figures.emplace_back("segments", record_.segments.size());
    report_.figures.emplace_back("artificial segments", artificial_);
    report_.figures.emplace_back("largest bend of an artificial segment", largest_bend_);
    return std::move(report_);
  }

 private:
  void find_mesh_edges();
  bool check_mesh_edges(std::size_t n, const ExactRecord::Chain& chain);
  void check_artificial(std::size_t n, const ExactRecord::Chain& chain);
  void check_input(std::size_t n, const ExactRecord::Chain& chain);
  void check_ends();
  void check_gap(const InputSurface::Edge& edge, Index input_vertex, Index end);
  std::string edge_name(const InputSurface::Edge& edge) const {
    return "input edge " + std::to_string(edge.from) + "-" + std::to_string(edge.to);
  }

  const ExactRecord& record_;
  const ExactPoints& points_;
  const InputSurface& surface_;
  const TetComplex& complex_;
  const FacetIndex facets_;
  const InputEdges input_edges_;
  const SimplexSet<2> edges_;          // of chains
  std::vector<std::uint8_t> in_mesh_;  // per edge of a chain
  std::vector<std::size_t> chain_of_;  // the same; kNone: none yet
  std::unordered_map<Index, const ExactRecord::Corner*> corner_;
  std::vector<Index> first_, last_;  // per input edge: ends of its chain
  std::uint64_t artificial_ = 0;
  double largest_bend_ = 0;
  OracleReport report_{"segments", "input edges and edges of segments"};
};

void Segments::find_mesh_edges() {
  for (const Tet& t : complex_.tetrahedra) {
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < i; ++j) {
        if (const std::size_t e = edges_.find({t[i], t[j]}); e < edges_.size()) in_mesh_[e] = 1;
      }
    }
  }
}

bool Segments::check_mesh_edges(std::size_t n, const ExactRecord::Chain& chain) {
  if (chain.vertices.size() < 2) {
    report_.fail(chain_name(n, chain) + " has fewer than two vertices");
    return false;
  }
  for (std::size_t i = 1; i < chain.vertices.size(); ++i) {
    const Index a = chain.vertices[i - 1], b = chain.vertices[i];
    ++report_.checked;
    const std::size_t e = edges_.find({a, b});
    if (in_mesh_[e] == 0) {
      report_.fail(chain_name(n, chain) + ": " + complex_.vertex_name(a) + " - " +
                   complex_.vertex_name(b) + " is no edge of the refined mesh");
    }
    if (chain_of_[e] != kNone) {
      report_.fail(chain_name(n, chain) + " shares an edge with segment " +
                   std::to_string(chain_of_[e]));
    } else {
      chain_of_[e] = n;
    }
  }
  return true;
}

void Segments::check_artificial(std::size_t n, const ExactRecord::Chain& chain) {
  ++artificial_;
  const std::string name = chain_name(n, chain);
  const Index facet = facets_.find(chain.facet);
  if (facet == kNone || !facets_.kept(facet)) {
    return report_.fail(name + " lies in facet " + std::to_string(chain.facet) +
                        ", which is none that was kept");
  }
  const InputSurface::Facet& plane = surface_.facets()[facet];
  std::vector<Index> sorted = chain.vertices;
  std::sort(sorted.begin(), sorted.end());
  if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) {
    report_.fail(name + " passes a vertex twice");
  }
  const Index from = chain.vertices.front(), to = chain.vertices.back();
  const ExactVector along = exact::difference(points_, from, to);
  const ExactNumber length2 = exact::squared(along);
  ExactNumber reached = 0;
  for (const Index v : chain.vertices) {
    if (plane.side(points_, v) != 0) {
      report_.fail(name + ": " + complex_.vertex_name(v) + " is off the plane of facet " +
                   std::to_string(chain.facet));
    }
    if (v == from) continue;
    const ExactVector w = exact::difference(points_, from, v);
    const ExactNumber position = exact::dot(along, w);
    if (position <= reached || position > length2) report_.fail(name + " turns back");
    reached = position;
    if (v == to) continue;
    // The distance from the straight line is |along x w| / |along|.
    const ExactNumber off2 = exact::squared(exact::cross(along, w));
    if (off2 == 0) continue;
    if (off2.shifted(40) > length2 * length2) {
      report_.fail(name + ": " + complex_.vertex_name(v) +
                   " is farther than 2^-20 of the length from the straight line");
    }
    largest_bend_ = std::max(largest_bend_, std::sqrt(ratio(off2, length2 * length2).get_d()));
  }
}

void Segments::check_input(std::size_t n, const ExactRecord::Chain& chain) {
  const std::string name = chain_name(n, chain);
  const Index e = input_edges_.of_chain(record_, chain.vertices);
  if (e == kNone) return report_.fail(name + " lies on no input edge between two facets");
  const InputSurface::Edge& edge = surface_.edges()[e];
  if (!facets_.kept(edge.left) && !facets_.kept(edge.right)) {
    report_.fail(name + " lies between two filtered facets");
  }
  std::vector<Index> ordered = chain.vertices;
  if (along_edge(points_, edge, ordered.front(), ordered.back()) < 0) {
    std::reverse(ordered.begin(), ordered.end());
  }
  for (std::size_t i = 0; i < ordered.size(); ++i) {
    const Index v = ordered[i];
    const bool on = exact::collinear(points_, edge.from, edge.to, v);
    if (!on) report_.fail(name + ": " + complex_.vertex_name(v) + " is off " + edge_name(edge));
    const bool on_way = i == 0 ? along_edge(points_, edge, edge.from, v) >= 0
                               : along_edge(points_, edge, ordered[i - 1], v) > 0;
    if (!on_way) report_.fail(name + " turns back on " + edge_name(edge));
  }
  if (along_edge(points_, edge, ordered.back(), edge.to) < 0) {
    report_.fail(name + " leaves " + edge_name(edge));
  }
  if (first_[e] != kNone) return report_.fail(edge_name(edge) + " has two segments");
  first_[e] = ordered.front();
  last_[e] = ordered.back();
}

// Of an edge with a kept facet, a part may be missing at an end that was chamfered. All of it may
// be missing if both ends were chamfered and its dihedral angle, between kept facets, is below 90
// degrees. Whether it is below the threshold in force, check_chamfer_need decides.
void Segments::check_ends() {
  std::uint64_t missing = 0;
  for (std::size_t e = 0; e < surface_.edges().size(); ++e) {
    const InputSurface::Edge& edge = surface_.edges()[e];
    if (!facets_.kept(edge.left) && !facets_.kept(edge.right)) continue;
    if (first_[e] == kNone) {
      ++missing;
      const ExactVector n = surface_.facets()[edge.left].normal(points_),
                        m = surface_.facets()[edge.right].normal(points_);
      // The dihedral angle is acute exactly if that of the outward normals is obtuse.
      const bool acute = facets_.kept(edge.left) && facets_.kept(edge.right) &&
                         exact::dot(n, m) < 0 && corner_.contains(edge.from) &&
                         corner_.contains(edge.to);
      if (!acute) report_.fail(edge_name(edge) + " has no segment and is not acute");
      continue;
    }
    check_gap(edge, edge.from, first_[e]);
    check_gap(edge, edge.to, last_[e]);
  }
  report_.figures.emplace_back("acute edges", missing);
}

void Segments::check_gap(const InputSurface::Edge& edge, Index input_vertex, Index end) {
  if (end == input_vertex) return;
  const auto corner = corner_.find(input_vertex);
  if (corner == corner_.end()) {
    return report_.fail(edge_name(edge) + " has no segment near input vertex " +
                        std::to_string(input_vertex) + ", which was not chamfered");
  }
  const double cut = exact::distance(points_, input_vertex, end);
  // Cut points are placed with a relative accuracy of 2^-20.
  if (!(cut <= corner->second->distance * (1 + 0x1p-16))) {
    report_.fail(edge_name(edge) + " is cut off farther than the distance at input vertex " +
                 std::to_string(input_vertex));
  }
}

// --- faces on facets

class RefinedFacets {
 public:
  explicit RefinedFacets(const RefinedMesh& mesh)
      : record_(*mesh.record),
        points_(*mesh.points),
        surface_(*mesh.surface),
        complex_(*mesh.complex),
        facets_(surface_, record_),
        faces_(faces_on_facets(record_)),
        in_mesh_(faces_.size()) {}

  OracleReport run() {
    find_mesh_faces();
    for (const auto& [a, b, c, id] : record_.refined_facets) check_face({a, b, c}, id);
    report_.checked += surface_.facets().size();
    collect_chains();
    check_borders();
    return std::move(report_);
  }

 private:
  void find_mesh_faces();
  void check_face(Face face, Index id);
  void collect_chains();
  void check_borders();

  const ExactRecord& record_;
  const ExactPoints& points_;
  const InputSurface& surface_;
  const TetComplex& complex_;
  const FacetIndex facets_;
  const SimplexSet<3> faces_;
  std::vector<std::uint8_t> in_mesh_;                     // per face
  std::vector<std::pair<Index, std::uint64_t>> sides_;    // facet, directed edge of a face
  std::vector<std::pair<Index, std::uint64_t>> chained_;  // facet, edge of a chain
  OracleReport report_{"facets", "facets and faces"};
};

void RefinedFacets::find_mesh_faces() {
  for (const Tet& tet : complex_.tetrahedra) {
    for (int i = 0; i < 4; ++i) {
      if (const std::size_t f = faces_.find(face_of(tet, i)); f < faces_.size()) in_mesh_[f] = 1;
    }
  }
}

void RefinedFacets::check_face(Face face, Index id) {
  ++report_.checked;
  if (in_mesh_[faces_.find(face)] == 0) {
    return report_.fail(complex_.face_name(face) + " is no face of the refined mesh");
  }
  const Index f = facets_.find(id);
  if (f == kNone) {
    return report_.fail(complex_.face_name(face) + ": there is no facet " + std::to_string(id));
  }
  const InputSurface::Facet& facet = surface_.facets()[f];
  for (const Index v : face) {
    if (facet.side(points_, v) != 0) {
      report_.fail(complex_.vertex_name(v) + " is off the plane of facet " + std::to_string(id));
    }
  }
  if (!facets_.kept(f)) report_.fail(complex_.face_name(face) + " lies on a filtered facet");
  if (facet.facing(points_, face) <= 0) {
    report_.fail(complex_.face_name(face) + " is folded over on facet " + std::to_string(id));
  }
  for (int i = 0; i < 3; ++i) sides_.emplace_back(f, directed_key(face[i], face[(i + 1) % 3]));
}

void RefinedFacets::collect_chains() {
  const InputEdges input_edges(surface_);
  for (const ExactRecord::Chain& chain : record_.segments) {
    std::array<Index, 2> of = {kNone, kNone};
    if (chain.artificial) {
      of[0] = facets_.find(chain.facet);
    } else if (const Index e = input_edges.of_chain(record_, chain.vertices); e != kNone) {
      of = {surface_.edges()[e].left, surface_.edges()[e].right};
    }
    for (const Index f : of) {
      if (f == kNone || !facets_.kept(f)) continue;
      for (std::size_t i = 1; i < chain.vertices.size(); ++i) {
        chained_.emplace_back(f, edge_key(chain.vertices[i - 1], chain.vertices[i]));
      }
    }
  }
  std::sort(chained_.begin(), chained_.end());
}

// A side of a face has its opposite among the faces of the facet, or lies on a chain of the facet;
// and on every edge of a chain there is exactly one side.
void RefinedFacets::check_borders() {
  std::sort(sides_.begin(), sides_.end());
  const auto name = [&](const std::pair<Index, std::uint64_t>& side) {
    return "edge " + complex_.vertex_name(static_cast<Index>(side.second >> 32)) + " - " +
           complex_.vertex_name(static_cast<Index>(side.second)) + " of facet " +
           std::to_string(surface_.facets()[side.first].id);
  };
  if (const auto twice = std::adjacent_find(sides_.begin(), sides_.end()); twice != sides_.end()) {
    report_.fail(name(*twice) + " has two faces on one side");
  }
  std::vector<std::pair<Index, std::uint64_t>> open;
  for (const auto& side : sides_) {
    const auto a = static_cast<Index>(side.second >> 32), b = static_cast<Index>(side.second);
    const bool pair =
        std::binary_search(sides_.begin(), sides_.end(), std::pair(side.first, directed_key(b, a)));
    if (!pair) open.emplace_back(side.first, edge_key(a, b));
  }
  std::sort(open.begin(), open.end());
  for (const auto& side : open) {
    if (!std::binary_search(chained_.begin(), chained_.end(), side)) {
      report_.fail(name(side) + " has a face on one side only and is on no segment");
    }
  }
  for (const auto& side : chained_) {
    if (!std::binary_search(open.begin(), open.end(), side)) {
      report_.fail(name(side) + " is on a segment but does not bound the faces");
    }
  }
  report_.figures.emplace_back("edges on segments", chained_.size());
}

}  // namespace

FacetIndex::FacetIndex(const InputSurface& surface, const ExactRecord& record) : surface_(surface) {
  kept_.assign(surface.facets().size(), 1);
  std::uint64_t named = 0;
  std::vector<std::uint8_t> seen(surface.triangles().size());
  for (const ExactRecord::Facet& facet : record.facets) {
    const Index f = find(facet.id);
    if (f == kNone || surface.facets()[f].label != facet.label) {
      defect_ = "facet " + std::to_string(facet.id) + " of the record is none of the surface";
      continue;
    }
    ++named;
    kept_[f] = facet.filtered ? 0 : 1;
    for (const Index t : facet.triangles) {
      if (t >= surface.triangles().size() || surface.facet_of_triangle()[t] != f) {
        defect_ = "facet " + std::to_string(facet.id) + " of the record has triangle " +
                  std::to_string(t) + ", which is not its";
      } else if (seen[t]++ != 0) {
        defect_ = "triangle " + std::to_string(t) + " is in facets of the record twice";
      }
    }
  }
  if (!record.facets.empty() && defect_.empty()) {
    const auto missing = std::count(seen.begin(), seen.end(), 0);
    if (missing > 0) {
      defect_ = std::to_string(missing) + " triangles are in no facet of the record";
    }
  }
  if (!record.facets.empty() && named != surface.facets().size()) {
    defect_ = "the record has " + std::to_string(named) + " of the " +
              std::to_string(surface.facets().size()) + " facets";
  }
}

// A facet's id is its smallest triangle.
Index FacetIndex::find(Index id) const {
  if (id >= surface_.triangles().size()) return kNone;
  const Index facet = surface_.facet_of_triangle()[id];
  return surface_.facets()[facet].id == id ? facet : kNone;
}

InputEdges::InputEdges(const InputSurface& surface) {
  std::vector<std::array<Index, 2>> ends;
  ends.reserve(surface.edges().size());
  for (const InputSurface::Edge& edge : surface.edges()) ends.push_back({edge.from, edge.to});
  ends_ = SimplexSet<2>(ends);
  edge_.assign(ends_.size(), kNone);
  for (Index e = 0; e < ends.size(); ++e) {
    Index& first = edge_[ends_.find(ends[e])];
    if (first == kNone) first = e;
  }
}

Index InputEdges::find(Index a, Index b) const {
  const std::size_t n = ends_.find({a, b});
  return n < ends_.size() ? edge_[n] : kNone;
}

Index InputEdges::of_chain(const ExactRecord& record, const std::vector<Index>& chain) const {
  if (chain.empty()) return kNone;
  for (const Index v : chain) {
    const ExactPoint& p = record.points[v];
    if (p.kind == ExactPoint::Kind::on_segment) return find(p.i, p.j);
  }
  return find(chain.front(), chain.back());
}

int along_edge(const ExactPoints& points, const InputSurface::Edge& edge, Index p, Index q) {
  if (p == q) return 0;
  if (p == edge.from && q == edge.to) return 1;
  return exact::dot_sign(points, edge.from, edge.to, p, q);
}

OracleReport check_segments(const RefinedMesh& mesh) {
  return Segments(mesh).run();
}

OracleReport check_refined_facets(const RefinedMesh& mesh) {
  return RefinedFacets(mesh).run();
}

namespace {

// Points that are neither of the input nor on the outer box were put into the volume, if they are
// explicit, or on no segment and no facet, however they are given.
std::vector<std::uint8_t> volume_points(const RefinedMesh& mesh) {
  std::vector<std::uint8_t> is_volume(mesh.points->size()), on_surface(mesh.points->size());
  for (const ExactRecord::Chain& chain : mesh.record->segments) {
    for (const Index v : chain.vertices) on_surface[v] = 1;
  }
  for (const auto& [a, b, c, id] : mesh.record->refined_facets) {
    on_surface[a] = on_surface[b] = on_surface[c] = 1;
  }
  const auto& tets = mesh.complex->tetrahedra;
  for (const Index v : used_vertices(*mesh.complex)) {
    const bool is_explicit = mesh.record->points[v].kind == ExactPoint::Kind::explicit_point;
    is_volume[v] = v >= mesh.input_vertices && (is_explicit || on_surface[v] == 0);
  }
  for (Index i = 0; i < mesh.neighbours->across.size(); ++i) {
    if (mesh.neighbours->across[i] != kNone) continue;
    for (const Index v : face_of(tets[i / 4], static_cast<int>(i % 4))) is_volume[v] = 0;
  }
  return is_volume;
}

// Volume Steiner points are put on a grid of 2^-10 of the shortest edge, and may be twice that away
// from their place: 2^-kGridBits of it.
constexpr long kGridBits = 9;

enum class SplitAt : std::uint8_t { circumcentre, centroid, elsewhere };

// Where a vertex is in a tetrahedron (a, b, c, d) that is not flat, to 2^-9 of the shortest edge.
SplitAt place_in(const ExactPoints& points, const std::array<Index, 4>& tetrahedron, Index vertex) {
  const Index a = tetrahedron[0];
  const ExactVector u = exact::difference(points, a, tetrahedron[1]),
                    v = exact::difference(points, a, tetrahedron[2]),
                    w = exact::difference(points, a, tetrahedron[3]),
                    x = exact::difference(points, a, vertex);
  ExactNumber shortest = exact::squared(u);
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < i; ++j) {
      shortest = std::min(
          shortest, exact::squared(exact::difference(points, tetrahedron[i], tetrahedron[j])));
    }
  }
  // The circumcentre is (|u|^2 v x w + |v|^2 w x u + |w|^2 u x v) / 2 det(u, v, w) away from a.
  const ExactVector vw = exact::cross(v, w), wu = exact::cross(w, u), uv = exact::cross(u, v);
  const ExactNumber uu = exact::squared(u), vv = exact::squared(v), ww = exact::squared(w);
  const ExactNumber twice = ExactNumber(2) * exact::dot(u, vw);
  ExactVector off_centre, off_centroid;
  for (std::size_t i = 0; i < 3; ++i) {
    off_centre[i] = twice * x[i] - (uu * vw[i] + vv * wu[i] + ww * uv[i]);
    off_centroid[i] = ExactNumber(4) * x[i] - (u[i] + v[i] + w[i]);
  }
  const auto within = [&](const ExactVector& off, const ExactNumber& scale) {
    return exact::squared(off).shifted(2 * kGridBits) <= scale * scale * shortest;
  };
  if (within(off_centre, twice)) return SplitAt::circumcentre;
  return within(off_centroid, 4) ? SplitAt::centroid : SplitAt::elsewhere;
}

}  // namespace

OracleReport check_balls(const RefinedMesh& mesh) {
  OracleReport report("steiner-balls", "vertices");
  const ExactPoints& points = *mesh.points;
  std::uint64_t on_sphere = 0, at_centroids = 0;
  std::vector<std::uint8_t> waiting = volume_points(mesh);
  report.checked = used_vertices(*mesh.complex).size();
  for (const ExactRecord::Ball& ball : mesh.record->balls) {
    const auto& [a, b, c, d] = ball.tetrahedron;
    const std::string name = mesh.complex->vertex_name(ball.vertex);
    if (waiting[ball.vertex] == 0) {
      report.fail(name + " has a ball too many, or is no volume Steiner point");
    }
    waiting[ball.vertex] = 0;
    const int sign = exact::orient3d(points, a, b, c, d);
    const int inside = sign * exact::insphere(points, a, b, c, d, ball.vertex);
    if (sign == 0) {
      report.fail(name + " was made for a flat tetrahedron");
    } else if (inside <= 0) {
      on_sphere += inside == 0;
      report.fail(name + " is " + (inside == 0 ? "on" : "outside") +
                  " the circumsphere that it was made for");
    }
    if (sign == 0 || !mesh.promise->steiner_point) continue;
    const SplitAt place = place_in(points, ball.tetrahedron, ball.vertex);
    at_centroids += place == SplitAt::centroid;
    if (place == SplitAt::elsewhere) {
      report.fail(name + " is not at the circumcentre of the tetrahedron that it was made for");
    }
  }
  for (Index v = 0; v < waiting.size(); ++v) {
    if (waiting[v] != 0) {
      report.fail(mesh.complex->vertex_name(v) + " was put into the volume for no ball");
    }
  }
  report.figures.emplace_back("on the sphere", on_sphere);
  if (mesh.promise->steiner_point) report.figures.emplace_back("at centroids", at_centroids);
  return report;
}

namespace {

class Encroachment {
 public:
  explicit Encroachment(const RefinedMesh& mesh)
      : record_(*mesh.record),
        points_(*mesh.points),
        complex_(*mesh.complex),
        edges_(edges_of_chains(record_)),
        faces_(faces_on_facets(record_)) {}

  OracleReport run() {
    report_.checked = edges_.size() + faces_.size();
    check_neighbours();
    check_sample();
    report_.figures.emplace_back("edges", edges_.size());
    report_.figures.emplace_back("faces", faces_.size());
    report_.promised = record_.parameters.gabriel;
    if (!report_.promised) report_.figures.emplace_back("vertices in a ball", found_);
    return std::move(report_);
  }

 private:
  void check_neighbours() {
    for (const Tet& t : complex_.tetrahedra) {
      for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < i; ++j) {
          if (!edges_.contains({t[i], t[j]})) continue;
          for (int k = 0; k < 4; ++k) {
            if (k != i && k != j) check_edge(t[i], t[j], t[k]);
          }
        }
        const std::size_t face = faces_.find(face_of(t, i));
        if (face < faces_.size()) check_face(faces_[face], t[i]);
      }
    }
  }

  void check_sample() {
    const std::vector<Index> vertices = used_vertices(complex_);
    Sample sample(edges_.size() + faces_.size(), vertices.size());
    for (std::size_t i = sample.first(); i < edges_.size() + faces_.size(); i += sample.step()) {
      const bool edge = i < edges_.size();
      const auto [a, b] = edge ? edges_[i] : std::array<Index, 2>{};
      const Face face = edge ? Face{} : faces_[i - edges_.size()];
      const BallSide ball =
          edge ? BallSide::diametral(points_, a, b) : BallSide::diametral(points_, face);
      for (const Index v : vertices) {
        if (ball.side(v) > 0) continue;
        edge ? check_edge(a, b, v) : check_face(face, v);
      }
      ++tried_;
    }
    report_.figures.emplace_back("tried against all vertices", tried_);
  }

  void check_edge(Index a, Index b, Index v) {
    if (v == a || v == b || exact::dot_sign(points_, v, a, b) >= 0) return;
    offend(v, "edge " + complex_.vertex_name(a) + " - " + complex_.vertex_name(b));
  }

  void check_face(const Face& f, Index v) {
    if (v == f[0] || v == f[1] || v == f[2]) return;
    if (!exact::in_diametral_ball(points_, f[0], f[1], f[2], v)) return;
    offend(v, complex_.face_name(f));
  }

  void offend(Index v, const std::string& what) {
    ++found_;
    if (record_.parameters.gabriel) report_.fail(complex_.vertex_name(v) + " encroaches " + what);
  }

  const ExactRecord& record_;
  const ExactPoints& points_;
  const TetComplex& complex_;
  const SimplexSet<2> edges_;
  const SimplexSet<3> faces_;
  std::uint64_t tried_ = 0, found_ = 0;
  OracleReport report_{"encroachment", "edges of segments and faces on facets"};
};

}  // namespace

OracleReport check_encroachment(const RefinedMesh& mesh) {
  return Encroachment(mesh).run();
}

}  // namespace tetproof::oracles
