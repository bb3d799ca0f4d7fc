#include "oracles/plane/refined.h"

#include <algorithm>
#include <cmath>

#include "oracles/plane/chamfer.h"
#include "oracles/plane/faces.h"

namespace tetproof::oracles {

namespace {

using Side = delmesher::PlaneRecord::Side;
using Index = PlaneComplex::Index;
using Point = PlaneComplex::Point;
using Triangle = PlaneComplex::Triangle;

// ------------------------------------------------------------------------------------ segments

// What is left of the pieces of one segment, given the edges on it in its order.
class SegmentRest {
 public:
  SegmentRest(const RecordedPlane& recorded, Index segment, const std::vector<SegmentPart>& parts,
              OracleReport& oracle)
      : recorded_(recorded),
        segment_(segment),
        ends_(recorded.graph().segments[segment]),
        part_(parts.begin()),
        end_(parts.end()),
        oracle_(oracle) {}

  void run(std::vector<PieceRest>& rests) {
    for (const Index p : recorded_.input.pieces_of()[segment_]) {
      rests[p] = rest_of(recorded_.input.pieces()[p]);
    }
    if (part_ != end_) fail(" has an edge beyond its ends");
  }

 private:
  void fail(const char* what) { oracle_.fail("segment " + std::to_string(segment_) + what); }

  PieceRest rest_of(const PlaneGraph::Piece& piece) {
    const auto [a, b] = ends_;
    const mpq_class begin = recorded_.exact.parameter(piece.a, a, b),
                    end = recorded_.exact.parameter(piece.b, a, b);
    if (part_ == end_ || part_->from >= end) return {};
    const mpq_class low = part_->from;
    mpq_class at = low;
    for (; part_ != end_ && part_->from < end; ++part_) {
      if (part_->from < at) fail(" is covered twice");
      if (part_->from > at) fail(" has a hole away from vertices");
      at = part_->to;
    }
    if (low < begin || at > end) fail(" has an edge that passes through a vertex");
    const double length = recorded_.exact.distance(a, b);
    return {true, mpq_class(low - begin).get_d() * length, mpq_class(end - at).get_d() * length};
  }

  const RecordedPlane& recorded_;
  const Index segment_;
  const std::array<std::uint32_t, 2> ends_;
  std::vector<SegmentPart>::const_iterator part_;
  const std::vector<SegmentPart>::const_iterator end_;
  OracleReport& oracle_;
};

std::vector<PieceRest> check_segments(const RecordedPlane& recorded, VerifyReport& report) {
  OracleReport oracle("refined-segments", "edges");
  oracle.checked = recorded.input.pieces().size();
  const auto parts = parts_of(recorded.refined, recorded.input, oracle);
  std::vector<PieceRest> rests(recorded.input.pieces().size());
  for (Index s = 0; s < parts.size(); ++s) SegmentRest(recorded, s, parts[s], oracle).run(rests);
  report.oracles.push_back(std::move(oracle));
  return rests;
}

// ------------------------------------------------------------------------------------ promises

class Promises {
 public:
  explicit Promises(const RecordedPlane& recorded)
      : recorded_(recorded),
        mesh_(recorded.refined),
        delta_(bound_of(recorded)),
        longest_(recorded.promise.max_edge * (1 + 1e-9)) {
    const long double radians = static_cast<long double>(delta_) * 3.14159265358979323846L / 180;
    sine_squared_ = static_cast<double>(std::sin(radians) * std::sin(radians) * (1 - 1e-15L));
  }

  void run(VerifyReport& report) {
    for (Index t = 0; t < mesh_.triangles().size(); ++t) {
      const Triangle& triangle = mesh_.triangles()[t];
      if (!recorded_.hull() && triangle.side == Side::outside) continue;
      for (OracleReport* oracle : {&angles_, &balls_, &edges_}) ++oracle->checked;
      check_discs(t);
      check_lengths(t);
    }
    report.oracles.push_back(std::move(angles_));
    report.oracles.push_back(std::move(balls_));
    if (recorded_.promise.max_edge > 0) report.oracles.push_back(std::move(edges_));
  }

 private:
  // The record's claim counts if it is larger. No triangle can keep a bound above 60 degrees, so
  // such a claim is ignored.
  static double bound_of(const RecordedPlane& recorded) {
    const double promised = recorded.promise.guaranteed_delta(), claimed = recorded.record.delta;
    return claimed <= 60 ? std::max(promised, claimed) : promised;
  }

  void check_discs(Index t) {
    const auto& v = mesh_.triangles()[t].vertices;
    for (std::size_t i = 0; i < 3; ++i) {
      const PlaneEdge edge = undirected(v[i], v[(i + 1) % 3]);
      if (mesh_.segment_of().contains(edge) &&
          mesh_.exact().encroaches(edge.first, v[(i + 2) % 3], edge.second)) {
        balls_.fail(triangle_name(t) + " has a corner in the disc of an edge on a segment");
      }
    }
  }

  // The smallest angle is between the two longest edges.
  void check_lengths(Index t) {
    const Triangle& triangle = mesh_.triangles()[t];
    std::array<mpq_class, 3> squares;
    for (std::size_t i = 0; i < 3; ++i) {
      const Point &p = mesh_.point(triangle.vertices[i]),
                  &q = mesh_.point(triangle.vertices[(i + 1) % 3]);
      squares[i] = (q.x - p.x) * (q.x - p.x) + (q.y - p.y) * (q.y - p.y);
    }
    std::sort(squares.begin(), squares.end());
    const mpq_class area = mesh_.doubled_area(triangle);
    if (area * area < sine_squared_ * squares[1] * squares[2]) {
      char bound[32];
      std::snprintf(bound, sizeof bound, "%.9g", delta_);
      angles_.fail(triangle_name(t) + " has an angle below " + bound);
    }
    if (squares[2] > longest_ * longest_) {
      edges_.fail(triangle_name(t) + " has an edge above --max-edge");
    }
  }

  const RecordedPlane& recorded_;
  const PlaneComplex& mesh_;
  const double delta_;  // degrees
  const mpq_class longest_;
  mpq_class sine_squared_;
  OracleReport angles_{"refined-angles", "triangles"}, balls_{"refined-encroachment", "triangles"},
      edges_{"refined-edges", "triangles"};
};

// --------------------------------------------------------------------------------------- sides

class Sides {
 public:
  Sides(RecordedPlane& recorded, const std::vector<PieceRest>& rests, PlaneInside& inside)
      : input_(recorded.input), exact_(recorded.exact), mesh_(recorded.refined), inside_(inside) {
    find_missing(rests);
  }

  void run(VerifyReport& report) {
    for (Index t = 0; t < mesh_.triangles().size(); ++t) {
      ++oracle_.checked;
      check(t);
    }
    report.oracles.push_back(std::move(oracle_));
  }

 private:
  void check(Index t) {
    const Triangle& triangle = mesh_.triangles()[t];
    const bool mixed = is_crossed(triangle);
    if (mixed != (triangle.side == Side::mixed)) {
      oracle_.fail(triangle_name(t) + (mixed ? " is crossed by a segment" : " is not mixed"));
    }
    if (mixed) return;
    const bool inside = inside_.contains(mesh_.centroid(triangle));
    if (inside != (triangle.side == Side::inside)) {
      oracle_.fail(triangle_name(t) + (inside ? " is inside" : " is outside"));
    }
  }

  // Where pieces between the inside and the outside are not edges of the mesh. Edges run through no
  // triangle, as all triangles are positive and fill the rectangle.
  void find_missing(const std::vector<PieceRest>& rests) {
    std::vector<PlaneBoxes::Box> boxes;
    const auto add = [&](Index p, Index from, Index to, double length) {
      const Point &a = mesh_.point(from), &b = mesh_.point(to);
      const double share = std::min(1.0, length / exact_.distance(from, to));
      Point end;
      end.dx = a.dx + share * (b.dx - a.dx);
      end.dy = a.dy + share * (b.dy - a.dy);
      boxes.push_back(plane_box({&a, &end}, 1e-9 * length));
      missing_.push_back(p);
    };
    for (Index p = 0; p < rests.size(); ++p) {
      const auto& [a, b, segment] = input_.pieces()[p];
      if (!inside_.ends_at(p)) continue;
      if (!rests[p].kept) add(p, a, b, exact_.distance(a, b));
      if (rests[p].cut_a > 0) add(p, a, b, rests[p].cut_a);
      if (rests[p].cut_b > 0) add(p, b, a, rests[p].cut_b);
    }
    boxes_ = PlaneBoxes(boxes);
  }

  // Does a part of a segment run through the triangle that separates the inside from the outside?
  bool is_crossed(const Triangle& triangle) {
    bool found = false;
    boxes_.visit(mesh_.box(triangle), [&](Index n) {
      const PlaneGraph::Piece& piece = input_.pieces()[missing_[n]];
      found = found || crosses(piece.a, piece.b, triangle);
    });
    return found;
  }

  // Does the segment meet the interior of the triangle? (Separating axes.)
  bool crosses(Index a, Index b, const Triangle& triangle) {
    const auto& v = triangle.vertices;
    if (beside(a, b, triangle, &Point::dx) || beside(a, b, triangle, &Point::dy)) return false;
    const std::array<int, 3> s = {exact_.orient(a, b, v[0]), exact_.orient(a, b, v[1]),
                                  exact_.orient(a, b, v[2])};
    const auto [least, most] = std::minmax({s[0], s[1], s[2]});
    if (least >= 0 || most <= 0) return false;
    for (std::size_t i = 0; i < 3; ++i) {
      const Index p = v[i], q = v[(i + 1) % 3];
      if (exact_.orient(p, q, a) <= 0 && exact_.orient(p, q, b) <= 0) return false;
    }
    return true;
  }

  // Do the rounded coordinates say that the two do not meet?
  bool beside(Index a, Index b, const Triangle& triangle, double Point::*x) const {
    const auto& [p, q, r] = triangle.vertices;
    const auto [low, high] = std::minmax({mesh_.point(p).*x, mesh_.point(q).*x, mesh_.point(r).*x});
    const auto [lo, hi] = std::minmax({mesh_.point(a).*x, mesh_.point(b).*x});
    return hi < low - 2 * exact_.error() || lo > high + 2 * exact_.error();
  }

  PlaneGraph& input_;
  PlanePoints& exact_;
  const PlaneComplex& mesh_;
  PlaneInside& inside_;
  std::vector<Index> missing_;  // pieces
  PlaneBoxes boxes_;            // of what is missing of each of these
  OracleReport oracle_{"refined-sides", "triangles"};
};

// ------------------------------------------------------------------------------------ chamfers

// Is anything inside in the wedge between two directions from a vertex? (WedgeSide)
class Wedges {
 public:
  Wedges(RecordedPlane& recorded, PlaneInside& inside)
      : recorded_(recorded), exact_(recorded.exact), inside_(inside) {}

  bool any_inside(Index v, Index from, Index to) {
    if (v != vertex_) turn_to(v);
    auto next = std::upper_bound(
        inside_from_.begin(), inside_from_.end(), point(from),
        [&](const Point& p, const Point& q) { return exact_.turns_before(point(v), p, q); });
    if (next == inside_from_.end()) next = inside_from_.begin();
    return next != inside_from_.end() && exact_.orient(point(v), point(from), *next) > 0 &&
           exact_.orient(point(v), *next, point(to)) > 0;
  }

 private:
  const Point& point(Index v) const { return recorded_.points()[v]; }

  void turn_to(Index v) {
    vertex_ = v;
    inside_from_.clear();
    if (recorded_.promise.approximate) {
      probe_around(v);
    } else {
      for (const Index t : recorded_.final.at(v)) {
        const Triangle& triangle = recorded_.final.triangles()[t];
        if (triangle.side != Side::inside) continue;
        Point centroid = recorded_.final.centroid(triangle);
        // A triangle without corners of its own may have that, and no direction.
        const bool is_there = centroid.x == point(v).x && centroid.y == point(v).y;
        if (!is_there) inside_from_.push_back(std::move(centroid));
      }
    }
    std::sort(inside_from_.begin(), inside_from_.end(),
              [&](const Point& p, const Point& q) { return exact_.turns_before(point(v), p, q); });
  }

  // Without a final mesh: tries a point close to the vertex between every two neighbouring pieces
  // that are less than half a turn apart.
  void probe_around(Index v) {
    std::vector<Index> ends;
    double near = HUGE_VAL;
    for (const Index p : recorded_.input.pieces_at()[v]) {
      const auto& piece = recorded_.input.pieces()[p];
      ends.push_back(piece.a == v ? piece.b : piece.a);
      near = std::min(near, exact_.distance(v, ends.back()));
    }
    near = std::min(near, recorded_.input.feature_size(v, near)) / 8;
    std::sort(ends.begin(), ends.end(),
              [&](Index p, Index q) { return exact_.turns_before(point(v), point(p), point(q)); });
    for (std::size_t k = 0; k < ends.size(); ++k) {
      const Index first = ends[k], second = ends[(k + 1) % ends.size()];
      if (exact_.orient(v, first, second) <= 0) continue;
      Point p = probe(v, first, second, near);
      if (inside_.contains(p)) inside_from_.push_back(std::move(p));
    }
  }

  // The vertex, moved by `distance` in each of the two directions.
  Point probe(Index v, Index first, Index second, double distance) {
    const Point& o = point(v);
    Point p;
    p.x = o.x;
    p.y = o.y;
    for (const Index end : {first, second}) {
      const mpq_class share = distance / exact_.distance(v, end);
      p.x += share * (point(end).x - o.x);
      p.y += share * (point(end).y - o.y);
    }
    p.dx = p.x.get_d();
    p.dy = p.y.get_d();
    return p;
  }

  RecordedPlane& recorded_;
  PlanePoints& exact_;
  PlaneInside& inside_;
  Index vertex_ = PlaneComplex::kNone;
  std::vector<Point> inside_from_;  // the vertex, counter-clockwise: a point in each wedge inside
};

}  // namespace

void check_plane_refined(RecordedPlane& recorded, VerifyReport& report) {
  const std::vector<PieceRest> rests = check_segments(recorded, report);
  Promises(recorded).run(report);
  PlaneInside inside(recorded.input);
  Sides(recorded, rests, inside).run(report);
  Wedges wedges(recorded, inside);
  check_plane_chamfers(
      recorded.input, recorded.record, rests,
      [&](Index v, Index from, Index to) { return wedges.any_inside(v, from, to); },
      recorded.promise, report);
}

}  // namespace tetproof::oracles
