#include "mesher/plane/refine.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "mesher/base/check.h"
#include "mesher/plane/bad_triangles.h"
#include "mesher/plane/shape.h"
#include "mesher/plane/spatial_order.h"
#include "mesher/predicates/placement.h"

namespace delmesher::plane {
namespace {

double square(double x) {
  return x * x;
}

class Refiner {
 public:
  Refiner(InputGraph& graph, const Chamfered& chamfered, PointStore& points,
          PlanePredicates& predicates, const RefineOptions& options, Control& control)
      : graph_(graph),
        chamfered_(chamfered),
        points_(points),
        predicates_(predicates),
        options_(options),
        control_(control),
        result_{.mesh = Triangulation(predicates),
                .side = {},
                .carrier = {},
                .crowded_pieces = {},
                .crowded_vertices = {}},
        mesh_(result_.mesh),
        sides_(graph, result_.mesh, points, predicates, chamfered.gaps),
        bad_(points, box(graph, points)) {}

  RefinedMesh run() {
    begin(RefineStep::delaunay);
    build();
    begin(RefineStep::segments);
    splits_.assign(graph_.pieces.size(), 0);
    sides_.start();
    queue_all_segments();
    split_segments();
    begin(RefineStep::triangles);
    result_.delta = std::min(options_.delta, kProvenDelta);
    refine_to(result_.delta, 0);
    if (options_.delta > kProvenDelta) try_for(options_.delta);
    if (!hopeless_) sides_.settle();
    result_.side.resize(mesh_.size());
    for (TriangleId t = 0; t < mesh_.size(); ++t) result_.side[t] = sides_.of(t);
    carry(static_cast<VertexId>(points_.size() - 1), kNone);
    return std::move(result_);
  }

 private:
  void begin(RefineStep step) const {
    if (options_.on_step) options_.on_step(step);
  }

  static SpatialKey box(const InputGraph& graph, const PointStore& points) {
    const Vec3 low = points.nearest(graph.vertices), high = points.nearest(graph.vertices + 2);
    return {{low[0], low[1]}, {high[0], high[1]}};
  }

  bool counts(TriangleId t) const { return options_.everywhere || sides_.of(t) != Side::outside; }

  void carry(VertexId v, PieceId piece) {
    if (v >= result_.carrier.size()) result_.carrier.resize(std::size_t{v} + 1, kNone);
    result_.carrier[v] = piece;
  }

  // The vertices of the chamfered graph: those of the input as they come, cut points where their
  // corners would be.
  std::vector<VertexId> along_curve() const {
    std::vector<std::pair<VertexId, VertexId>> cuts;
    for (const Gap& gap : chamfered_.gaps) {
      if (gap.b >= graph_.vertices) cuts.emplace_back(gap.a, gap.b);
    }
    std::sort(cuts.begin(), cuts.end());
    std::vector<VertexId> order;
    auto cut = cuts.begin();
    for (VertexId v = 0; v < graph_.vertices; ++v) {
      if (chamfered_.vertex_kept[v] != 0) order.push_back(v);
      for (; cut != cuts.end() && cut->first == v; ++cut) order.push_back(cut->second);
    }
    return order;
  }

  // The chamfered graph, triangulated.
  void build() {
    const bool unchanged =
        chamfered_.gaps.empty() &&
        std::count(chamfered_.vertex_kept.begin(), chamfered_.vertex_kept.end(), 0) == 0;
    carry(static_cast<VertexId>(points_.size() - 1), kNone);
    if (unchanged) {
      mesh_ = graph_.base;
      return;
    }
    corner_of_.assign(points_.size(), kNone);
    for (const Gap& gap : chamfered_.gaps) {
      if (gap.b >= graph_.vertices) corner_of_[gap.b] = gap.a;
    }
    for (PieceId id = kBoxPieces; id < graph_.pieces.size(); ++id) {
      for (const VertexId v : chamfered_.ends[id]) {
        if (v != kNone && v >= graph_.vertices) carry(v, id);
      }
    }
    std::vector<VertexId> order = along_curve();
    mesh_.reserve(2 * points_.size());
    const VertexId c = graph_.vertices;
    mesh_.start({c, c + 1, c + 2, c + 3}, {0, 1, 2, 3});
    arrange_in_rounds(order);
    TriangleId hint = 0;
    for (const VertexId v : order) {
      control_.poll(points_.size());
      DELMESHER_CHECK(mesh_.insert(v, hint) == v, "chamfering made vertices coincide");
      hint = mesh_.around(v);
    }
    mesh_.renumber();
    std::vector<VertexId> chain;
    for (PieceId id = kBoxPieces; id < graph_.pieces.size(); ++id) {
      const auto [a, b] = chamfered_.ends[id];
      if (a == kNone) continue;
      control_.poll(points_.size());
      const auto obstacle = mesh_.insert_segment(a, b, id, chain);
      DELMESHER_CHECK(obstacle.kind == Triangulation::Obstacle::Kind::none && chain.size() == 2,
                      "chamfered segments meet");
    }
  }

  // ---------------------------------------------------------------- segments

  struct Subsegment {
    VertexId a, b;
    EdgeId edge;  // where it was: mostly it still is
  };

  // The edge of a subsegment, or kNone if it is no more.
  EdgeId find(const Subsegment& s) const {
    if (mesh_.origin(s.edge) == s.a && mesh_.target(s.edge) == s.b) return s.edge;
    return mesh_.find_edge(s.a, s.b);
  }

  bool encroached(EdgeId e) {
    const VertexId a = mesh_.origin(e), b = mesh_.target(e);
    for (const EdgeId f : {e, mesh_.twin(e)}) {
      if (f == kNone || !counts(triangle_of(f))) continue;
      if (predicates_.dot(a, mesh_.opposite(f), b) < 0) return true;
    }
    return false;
  }

  void queue_all_segments() {
    for (TriangleId t = 0; t < mesh_.size(); ++t) {
      for (int i = 0; i < 3; ++i) {
        const EdgeId e = edge_of(t, i), f = mesh_.twin(e);
        if (mesh_.piece(e) == kNone || (f != kNone && f < e)) continue;
        if (encroached(e)) segments_.push_back({mesh_.origin(e), mesh_.target(e), e});
      }
    }
  }

  void split_segments() {
    for (; segment_head_ < segments_.size() && !hopeless_; ++segment_head_) {
      const Subsegment s = segments_[segment_head_];
      const EdgeId e = find(s);
      if (e != kNone && mesh_.piece(e) != kNone && encroached(e)) split_segment(e);
    }
    segments_.clear();
    segment_head_ = 0;
  }

  // False if there is no room for a point between the ends.
  bool split_segment(EdgeId e) {
    const VertexId a = mesh_.origin(e), b = mesh_.target(e);
    const PieceId id = mesh_.piece(e);
    const Approximation& pa = points_.approximation(a);
    const Approximation& pb = points_.approximation(b);
    const double dx = pb.x - pa.x, dy = pb.y - pa.y;
    const double length = norm(dx, dy);
    const double room = kFloor * std::max(magnitude(points_, a), magnitude(points_, b));
    if (!(length > 2 * std::max(room, graph_.unit * 0x1p21))) {
      crowd(a, b);
      return false;
    }
    const Vec3 middle = {pa.x + dx / 2, pa.y + dy / 2, 0};
    VertexId p;
    if (id < kBoxPieces) {
      // On the side: one coordinate is constant.
      p = points_.add_explicit(to_unit(graph_, middle[0]), to_unit(graph_, middle[1]), 0);
    } else {
      const Piece& piece = graph_.pieces[id];
      p = points_.add(place_on_segment(points_, piece.a, piece.b, middle, length * 0x1p-21));
      if (!(predicates_.dot(a, p, b) < 0)) {
        points_.pop_back();
        crowd(a, b);
        return false;
      }
      carry(p, id);
      if (++splits_[id] == options_.most_splits) crowd_piece(id);
    }
    ++result_.on_segments;
    mesh_.find_cavity(p, triangle_of(e), e);
    fill(p);
    for (std::size_t k = 0; k < mesh_.created().size(); ++k) {
      const TriangleId t = mesh_.created()[k];
      for (int i = 0; i < 3; ++i) {
        const EdgeId f = edge_of(t, i);
        if (mesh_.piece(f) == kNone || !counts(t)) continue;
        const VertexId u = mesh_.origin(f), w = mesh_.target(f);
        if (predicates_.dot(u, mesh_.opposite(f), w) < 0) segments_.push_back({u, w, f});
      }
    }
    return true;
  }

  // Gaps may make triangles count that did not before: their segments were not asked about.
  void queue_beside_created() {
    for (const TriangleId t : mesh_.created()) {
      const EdgeId e = edge_of(t, 0);
      if (mesh_.piece(e) == kNone || !counts(t)) continue;
      const VertexId a = mesh_.origin(e), b = mesh_.target(e);
      if (predicates_.dot(a, mesh_.opposite(e), b) < 0) segments_.push_back({a, b, e});
    }
  }

  void fill(VertexId p) {
    sides_.before_fill();
    mesh_.fill_cavity(p);
    sides_.after_fill();
    if (refining_) {
      for (const TriangleId t : mesh_.created()) judge(t);
    }
    control_.poll(points_.size());
  }

  // ---------------------------------------------------------------- triangles

  void judge(TriangleId t) {
    if (!counts(t)) return;
    const auto& v = mesh_[t].vertex;
    const Shape shape = shape_of(points_, v[0], v[1], v[2]);
    if (shape.sine_squared < sine_squared_) {
      bad_.push(shape.sine_squared, {t, v});
    } else if (shape.longest_squared > square(max_edge_ * shape.scale)) {
      bad_.push(1, {t, v});
    }
  }

  // Until every triangle keeps the bound, or (if `most` is not 0) so many points are in.
  bool refine_to(double degrees, std::uint64_t most) {
    // The computed squared sine is off by less than 1e-14 of itself; doubles as written may be off
    // more.
    sine_squared_ = (1 - cosine_squared(degrees)) * (1 + 1e-9);
    max_edge_ = options_.max_edge > 0 ? options_.max_edge : HUGE_VAL;
    const double cosine = std::sqrt(cosine_squared(degrees));
    // Half the cotangent of half the angle, less five percent so that rounding makes no new one.
    off_centre_ = 0.475 * std::sqrt((1 + cosine) / (1 - cosine));
    split_segments();
    refining_ = true;
    bad_.gather();
    for (TriangleId t = 0; t < mesh_.size(); ++t) judge(t);
    bad_.sort();
    const std::size_t limit = points_.size() + most;
    BadTriangles::Entry entry;
    while (!hopeless_ && bad_.pop(entry)) {
      const std::array<VertexId, 3>& v = mesh_[entry.triangle].vertex;
      if (v[0] != entry.vertex[0] || v[1] != entry.vertex[1] || v[2] != entry.vertex[2]) continue;
      if (most > 0 && points_.size() > limit) {
        bad_.clear();
        return false;
      }
      split_triangle(entry.triangle);
      split_segments();
    }
    return true;
  }

  // Beyond what is proven: within a multiple of what the proven bound took.
  void try_for(double degrees) {
    result_.delta = degrees;
    if (result_.crowded) return;
    const std::uint64_t most = 8 * points_.size() + 1000;
    if (refine_to(degrees, most) && !result_.crowded) return;
    bad_.clear();
    hopeless_ = result_.crowded = false;  // not what was asked to be certain
    result_.crowded_pieces.clear();
    result_.crowded_vertices.clear();
    result_.delta = kProvenDelta;
    refine_to(kProvenDelta, 0);
  }

  // The chamfered corner that a new point would come close to, if any: the cut points around one
  // lie on a circle, whose centre it is. The corner itself instead makes no needles when its
  // segments come back, and happens once per corner, so that it does not touch termination.
  VertexId corner_near(const std::array<VertexId, 3>& v, const Vec3& place, const Shape& shape) {
    for (const VertexId u : v) {
      const VertexId corner = u < corner_of_.size() ? corner_of_[u] : kNone;
      if (corner == kNone || mesh_.has_vertex(corner)) continue;
      const Approximation& a = points_.approximation(corner);
      const double distance = norm(place[0] - a.x, place[1] - a.y) * shape.scale;
      if (square(distance) < shape.shortest_squared &&
          predicates_.in_circle(v[0], v[1], v[2], corner) > 0) {
        return corner;
      }
    }
    return kNone;
  }

  // A point that would make a bad triangle go. Either new, and the last of the store until it is
  // taken back, or a chamfered corner.
  struct Candidate {
    VertexId vertex = kNone;  // kNone: no room between doubles
    bool restored = false;
  };

  // Inserts the triangle's off-centre or circumcentre, or splits the segments that it encroaches
  // upon, or notes that there is no room for either.
  void split_triangle(TriangleId t) {
    const std::array<VertexId, 3> v = mesh_[t].vertex;
    const Candidate candidate = candidate_for(v);
    if (candidate.vertex == kNone) return crowd(t);
    const Triangulation::Sight sight = mesh_.look(candidate.vertex, t);
    const bool coincides = sight.blocked == kNone && std::popcount(sight.location.zeros) > 1;
    if (!coincides) find_encroached(candidate.vertex, sight);
    if (coincides || (encroached_.empty() && !in_cavity(t))) {
      take_back(candidate);
      return crowd(t);
    }
    if (encroached_.empty()) {
      if (!candidate.restored) ++result_.in_faces;
      fill(candidate.vertex);
      return queue_beside_created();
    }
    take_back(candidate);
    const bool progress = split_encroached();
    if (mesh_[t].vertex != v) return;
    if (progress) {
      judge(t);
    } else {
      crowd(t);
    }
  }

  Candidate candidate_for(const std::array<VertexId, 3>& v) {
    const Shape shape = shape_of(points_, v[0], v[1], v[2]);
    // The new point comes near the shortest edge: only there room between doubles is needed.
    const double size =
        std::max(magnitude(points_, v[static_cast<std::size_t>(next(shape.sharpest))]),
                 magnitude(points_, v[static_cast<std::size_t>(previous(shape.sharpest))]));
    // It is placed on a grid of a millionth of that edge or two.
    const double room = std::max(size * kFloor, graph_.unit * 0x1p22);
    if (!(shape.shortest_squared > square(room * shape.scale))) return {};
    const double reach = shape.sine_squared < sine_squared_
                             ? std::min(shape.circumcentre, off_centre_)
                             : shape.circumcentre;
    const Vec3 place = shape.place(points_, v, reach);
    if (!std::isfinite(place[0]) || !std::isfinite(place[1])) return {};
    const VertexId corner = corner_near(v, place, shape);
    if (corner != kNone) return {corner, true};
    return {points_.add_explicit(place[0], place[1], 0), false};
  }
  void take_back(const Candidate& candidate) {
    if (!candidate.restored) points_.pop_back();
  }

  // Puts into encroached_ the segment that hides p from the triangle or on which p lies, else those
  // whose open diametral disc contains p. If there are none, the cavity of p has been found.
  void find_encroached(VertexId p, const Triangulation::Sight& sight) {
    encroached_.clear();
    EdgeId blocked = sight.blocked;
    for (int i = 0; blocked == kNone && i < 3; ++i) {
      const EdgeId e = edge_of(sight.location.triangle, i);
      if ((sight.location.zeros >> i & 1) != 0 && mesh_.piece(e) != kNone) blocked = e;
    }
    if (blocked != kNone) {
      encroached_.push_back({mesh_.origin(blocked), mesh_.target(blocked), blocked});
      return;
    }
    mesh_.find_cavity(p, sight.location.triangle, kNone);
    for (const auto& edge : mesh_.boundary()) {
      if (edge.piece != kNone && counts(edge.inner) && predicates_.dot(edge.from, p, edge.to) < 0) {
        // For the sides of the box, any edge will do: they are looked up.
        const EdgeId inner = edge.outer != kNone ? mesh_.twin(edge.outer) : 0;
        encroached_.push_back({edge.from, edge.to, inner});
      }
    }
  }
  bool in_cavity(TriangleId t) const {
    const auto& cavity = mesh_.cavity();
    return std::find(cavity.begin(), cavity.end(), t) != cavity.end();
  }
  // Has one of them been split, or is it gone?
  bool split_encroached() {
    bool progress = false;
    for (const Subsegment& s : encroached_) {
      const EdgeId e = find(s);
      if (e == kNone || split_segment(e)) progress = true;
    }
    return progress;
  }

  // ---------------------------------------------------------------- no room

  void crowd(TriangleId t) {
    for (const VertexId v : mesh_[t].vertex) crowd_at(v);
  }
  void crowd(VertexId a, VertexId b) {
    crowd_at(a);
    crowd_at(b);
  }
  // A channel that the filter overlooked. It would take long, so stop right now.
  void crowd_piece(PieceId id) {
    result_.crowded = hopeless_ = true;
    result_.crowded_pieces.push_back(id);
  }
  void crowd_at(VertexId v) {
    result_.crowded = true;
    if (v < graph_.vertices) {
      result_.crowded_vertices.push_back(v);
    } else if (v < result_.carrier.size() && result_.carrier[v] != kNone) {
      result_.crowded_pieces.push_back(result_.carrier[v]);
    }
  }

  InputGraph& graph_;
  const Chamfered& chamfered_;
  PointStore& points_;
  PlanePredicates& predicates_;
  const RefineOptions& options_;
  Control& control_;
  RefinedMesh result_;
  Triangulation& mesh_;
  Sides sides_;
  std::vector<VertexId> corner_of_;  // of cut points, by id; kNone for others
  std::vector<Subsegment> segments_, encroached_;
  std::size_t segment_head_ = 0;
  BadTriangles bad_;
  bool refining_ = false, hopeless_ = false;
  std::vector<std::uint64_t> splits_;  // per piece
  double sine_squared_ = 0, max_edge_ = 0, off_centre_ = 0;
};

}  // namespace

RefinedMesh refine(InputGraph& graph, const Chamfered& chamfered, PointStore& points,
                   PlanePredicates& predicates, const RefineOptions& options, Control& control) {
  return Refiner(graph, chamfered, points, predicates, options, control).run();
}

}  // namespace delmesher::plane
