#include "oracles/record/chamfer.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <unordered_map>
#include <unordered_set>

#include "oracles/base/buckets.h"
#include "oracles/mesh/angles.h"
#include "oracles/record/enrichment.h"
#include "oracles/surface/corners.h"

namespace tetproof::oracles {
namespace {

using delmesher::ExactPoint;
using delmesher::ExactRecord;

// The largest shortfall below the threshold, in degrees, of an angle at a rounded point: points are
// placed within 2^-20 of the chamfer distance, and the shortest bridges are a few hundredths of it.
constexpr double kRounding = 1e-3;

// An angle within rounding of the threshold is not below it.
class Threshold : public AngleBound {
 public:
  explicit Threshold(double degrees) : AngleBound(degrees, Doubt::not_acute), degrees_(degrees) {}
  double degrees() const { return degrees_; }

 private:
  double degrees_;
};

struct Segment {
  Index from, to;     // ends of the chain
  bool artificial;    // else on an input edge
  Index input_edge;   // of the surface, or kNone
  Index left, right;  // kept facets, or kNone
};

// A corner of a facet at a vertex: counter-clockwise, seen from outside, from the segment towards
// `out` to the one towards `in`.
struct Sector {
  Index facet, out, in;
};

class ChamferedSurface {
 public:
  explicit ChamferedSurface(const RefinedMesh& mesh)
      : record_(*mesh.record),
        points_(*mesh.points),
        surface_(*mesh.surface),
        facets_(surface_, record_),
        with_facets_(record_.parameters.acute),
        of_edges_(thresholds_of(record_.parameters).of_edges) {
    for (const auto& corner : record_.corners) corner_.insert(corner.vertex);
    for (const auto& made : record_.chamfer_points) made_for_.insert(made[0]);
    collect_segments();
  }

  const std::vector<Segment>& segments() const { return segments_; }
  const std::vector<Index>& vertices() const { return vertices_; }
  // The segments at a vertex, by its place among the vertices.
  std::span<const Index> at(std::size_t slot) const { return at_.of(static_cast<Index>(slot)); }
  std::vector<Sector> sectors(std::size_t slot) const;

  const Threshold& with_facets() const { return with_facets_; }
  // For the angle of two edges.
  const Threshold& of_edges(Index p) const {
    const bool chamfered = made_for_.contains(p) || corner_.contains(p);
    return chamfered ? with_facets_ : of_edges_;
  }

 private:
  void collect_segments();
  void pair_sides(Index v, Index facet, const std::vector<Index>& outs,
                  const std::vector<Index>& ins, std::vector<Sector>& sectors) const;

  const ExactRecord& record_;
  const ExactPoints& points_;
  const InputSurface& surface_;
  const FacetIndex facets_;
  Threshold with_facets_, of_edges_;
  std::unordered_set<Index> corner_;
  std::unordered_set<Index> made_for_;
  std::vector<Segment> segments_;
  std::vector<Index> vertices_;  // ends of segments, ascending
  Buckets at_{0};
};

// Only the faces on its facet tell on which side of an artificial segment the facet is.
class SidesOfFacets {
 public:
  explicit SidesOfFacets(const ExactRecord& record) {
    for (const ExactRecord::Chain& chain : record.segments) {
      if (chain.artificial && chain.vertices.size() > 1) asked_.push_back(side(chain));
    }
    std::sort(asked_.begin(), asked_.end());
    found_.resize(asked_.size());
    if (asked_.empty()) return;
    for (const auto& [a, b, c, id] : record.refined_facets) {
      for (const auto& [p, q] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
        const auto place = std::lower_bound(asked_.begin(), asked_.end(), Side{id, p, q});
        if (place != asked_.end() && *place == Side{id, p, q}) found_[place - asked_.begin()] = 1;
      }
    }
  }
  // Has a face on the facet of this artificial segment the segment's first edge on its left?
  bool has_left_of(const ExactRecord::Chain& chain) const {
    const auto place = std::lower_bound(asked_.begin(), asked_.end(), side(chain));
    return found_[place - asked_.begin()] != 0;
  }

 private:
  using Side = std::array<Index, 3>;  // facet, from, to
  static Side side(const ExactRecord::Chain& chain) {
    return {chain.facet, chain.vertices[0], chain.vertices[1]};
  }

  std::vector<Side> asked_;
  std::vector<std::uint8_t> found_;  // per side
};

void ChamferedSurface::collect_segments() {
  const SidesOfFacets sides(record_);
  const InputEdges input_edges(surface_);
  for (const ExactRecord::Chain& chain : record_.segments) {
    if (chain.vertices.size() < 2) continue;  // the segment oracle reports it
    Segment s{chain.vertices.front(), chain.vertices.back(), chain.artificial, kNone, kNone, kNone};
    if (chain.artificial) {
      (sides.has_left_of(chain) ? s.left : s.right) = facets_.find(chain.facet);
    } else {
      s.input_edge = input_edges.of_chain(record_, chain.vertices);
      if (s.input_edge == kNone) continue;
      const InputSurface::Edge& edge = surface_.edges()[s.input_edge];
      if (along_edge(points_, edge, s.from, s.to) < 0) std::swap(s.from, s.to);
      s.left = facets_.kept(edge.left) ? edge.left : kNone;
      s.right = facets_.kept(edge.right) ? edge.right : kNone;
    }
    segments_.push_back(s);
    vertices_.push_back(s.from);
    vertices_.push_back(s.to);
  }
  std::sort(vertices_.begin(), vertices_.end());
  vertices_.erase(std::unique(vertices_.begin(), vertices_.end()), vertices_.end());
  at_ = Buckets(vertices_.size());
  const auto slot = [this](Index v) {
    return static_cast<Index>(std::lower_bound(vertices_.begin(), vertices_.end(), v) -
                              vertices_.begin());
  };
  for (const Segment& s : segments_) {
    at_.count(slot(s.from));
    at_.count(slot(s.to));
  }
  at_.allot();
  for (Index n = 0; n < segments_.size(); ++n) {
    at_.put(slot(segments_[n].from), n);
    at_.put(slot(segments_[n].to), n);
  }
}

std::vector<Sector> ChamferedSurface::sectors(std::size_t slot) const {
  const Index v = vertices_[slot];
  std::vector<Index> facets;
  for (const Index n : at(slot)) {
    for (const Index f : {segments_[n].left, segments_[n].right}) {
      if (f != kNone) facets.push_back(f);
    }
  }
  std::sort(facets.begin(), facets.end());
  facets.erase(std::unique(facets.begin(), facets.end()), facets.end());
  std::vector<Sector> sectors;
  for (const Index f : facets) {
    std::vector<Index> outs, ins;
    for (const Index n : at(slot)) {
      const Segment& s = segments_[n];
      const Index other = s.from == v ? s.to : s.from;
      // The facet is on the left of the direction in which it traverses the segment.
      if ((s.left == f) == (s.from == v) && (s.left == f || s.right == f)) outs.push_back(other);
      if ((s.left == f) != (s.from == v) && (s.left == f || s.right == f)) ins.push_back(other);
    }
    pair_sides(v, f, outs, ins, sectors);
  }
  return sectors;
}

// Each outgoing side begins the sector that the next incoming one, counter-clockwise, ends.
void ChamferedSurface::pair_sides(Index v, Index facet, const std::vector<Index>& outs,
                                  const std::vector<Index>& ins,
                                  std::vector<Sector>& sectors) const {
  if (outs.size() == 1 && ins.size() == 1) {  // nothing to choose
    if (ins[0] != outs[0]) sectors.push_back({facet, outs[0], ins[0]});
    return;
  }
  const ExactVector normal = surface_.facets()[facet].normal(points_);
  const auto direction = [&](Index to) { return exact::difference(points_, v, to); };
  for (const Index out : outs) {
    const ExactVector o = direction(out);
    // 0: turned by less than 180 degrees from o, 1: by 180 or more.
    const auto half = [&](const ExactVector& d) {
      const int side = sgn(exact::dot(normal, exact::cross(o, d)));
      return side > 0 || (side == 0 && exact::dot(o, d) > 0) ? 0 : 1;
    };
    Index best = kNone;
    for (const Index in : ins) {
      if (in == out) continue;
      if (best == kNone) {
        best = in;
        continue;
      }
      const ExactVector d = direction(in), e = direction(best);
      const bool nearer =
          half(d) != half(e) ? half(d) < half(e) : exact::dot(normal, exact::cross(d, e)) > 0;
      if (nearer) best = in;
    }
    if (best != kNone) sectors.push_back({facet, out, best});
  }
}

class ChamferAngles {
 public:
  explicit ChamferAngles(const RefinedMesh& mesh)
      : points_(*mesh.points), surface_(*mesh.surface), complex_(*mesh.complex), chamfered_(mesh) {}

  OracleReport run() {
    for (const Segment& s : chamfered_.segments()) {
      if (s.left != kNone && s.right != kNone) check_dihedral(s);
    }
    for (std::size_t slot = 0; slot < chamfered_.vertices().size(); ++slot) check_vertex(slot);
    report_.figures.emplace_back("below the threshold by rounding", below_);
    report_.figures.emplace_back("largest shortfall in degrees", shortfall_);
    if (below_ > 0 || report_.violations > 0) {
      report_.figures.emplace_back("smallest angle", smallest_);
    }
    return std::move(report_);
  }

 private:
  void check_dihedral(const Segment& s);
  void check_vertex(std::size_t slot);
  void check_pair(Index v, const Segment& s, const Segment& t);
  void check_sector(Index v, const Segment& s, const Sector& sector, const Threshold& threshold);
  void judge(const ExactNumber& cosine, const ExactNumber& norms, const ExactNumber& sine_squared,
             const Threshold& threshold, bool rounded, const std::string& what);
  void offend(double angle, const Threshold& threshold, bool rounded, const std::string& what);
  std::string segment_name(const Segment& s) const {
    return (s.artificial ? "artificial segment " : "segment ") + complex_.vertex_name(s.from) +
           " - " + complex_.vertex_name(s.to);
  }

  const ExactPoints& points_;
  const InputSurface& surface_;
  const TetComplex& complex_;
  const ChamferedSurface chamfered_;
  std::uint64_t below_ = 0;
  double shortfall_ = 0, smallest_ = 180;
  OracleReport report_{"chamfer-angles", "angles of constraints"};
};

void ChamferAngles::judge(const ExactNumber& cosine, const ExactNumber& norms,
                          const ExactNumber& sine_squared, const Threshold& threshold, bool rounded,
                          const std::string& what) {
  if (threshold.above(cosine, norms)) {
    offend(exact_angle(sine_squared, cosine), threshold, rounded, what);
  }
}

void ChamferAngles::offend(double angle, const Threshold& threshold, bool rounded,
                           const std::string& what) {
  smallest_ = std::min(smallest_, angle);
  const double missing = threshold.degrees() - angle;
  if (rounded && missing <= kRounding) {
    ++below_;
    shortfall_ = std::max(shortfall_, missing);
    return;
  }
  char text[96];
  std::snprintf(text, sizeof text, " form an angle of %.9g degrees, less than %g", angle,
                threshold.degrees());
  report_.fail(what + text);
}

void ChamferAngles::check_dihedral(const Segment& s) {
  ++report_.checked;
  const InputSurface::Facet &left = surface_.facets()[s.left], &right = surface_.facets()[s.right];
  const IntervalVector &p = left.rough_normal, &q = right.rough_normal;
  const Threshold& threshold = chamfered_.with_facets();
  if (threshold.surely_not_above(-exact::dot(p, q), exact::dot(p, p) * exact::dot(q, q))) return;
  const ExactVector m = left.normal(points_), n = right.normal(points_);
  const ExactNumber cosine = -exact::dot(m, n);
  if (cosine <= 0) return;
  judge(cosine, exact::squared(m) * exact::squared(n), exact::squared(exact::cross(m, n)),
        threshold, false,
        "facets " + std::to_string(surface_.facets()[s.left].id) + " and " +
            std::to_string(surface_.facets()[s.right].id) + " at " + segment_name(s));
}

void ChamferAngles::check_vertex(std::size_t slot) {
  const Index v = chamfered_.vertices()[slot];
  const std::span<const Index> at = chamfered_.at(slot);
  const std::vector<Sector> sectors = chamfered_.sectors(slot);
  const Threshold& threshold = chamfered_.with_facets();
  for (std::size_t i = 0; i < at.size(); ++i) {
    const Segment& s = chamfered_.segments()[at[i]];
    for (std::size_t j = 0; j < i; ++j) {
      check_pair(v, s, chamfered_.segments()[at[j]]);
    }
    for (const Sector& sector : sectors) {
      if (sector.facet != s.left && sector.facet != s.right) check_sector(v, s, sector, threshold);
    }
  }
}

void ChamferAngles::check_pair(Index v, const Segment& s, const Segment& t) {
  ++report_.checked;
  const Index p = s.from == v ? s.to : s.from, q = t.from == v ? t.to : t.from;
  const IntervalVector x = points_.rough_difference(v, p), y = points_.rough_difference(v, q);
  const Threshold& threshold = chamfered_.of_edges(v);
  if (threshold.surely_not_above(exact::dot(x, y), exact::dot(x, x) * exact::dot(y, y))) return;
  if (exact::dot_sign(points_, v, p, q) <= 0) return;
  const ExactVector a = exact::difference(points_, v, p), b = exact::difference(points_, v, q);
  const ExactNumber cosine = exact::dot(a, b), norms = exact::squared(a) * exact::squared(b);
  judge(cosine, norms, exact::squared(exact::cross(a, b)), threshold, s.artificial || t.artificial,
        segment_name(s) + " and " + segment_name(t));
}

// The angle of a segment and a facet counts if the segment projects into the sector's interior.
void ChamferAngles::check_sector(Index v, const Segment& s, const Sector& sector,
                                 const Threshold& threshold) {
  ++report_.checked;
  const InputSurface::Facet& facet = surface_.facets()[sector.facet];
  const Index end = s.from == v ? s.to : s.from;
  const IntervalVector &r = facet.rough_normal, w = points_.rough_difference(v, end);
  const Interval rough_height = exact::dot(r, w);
  const Interval rough_norms = exact::dot(r, r) * exact::dot(w, w);
  if (threshold.surely_not_beyond(rough_norms - rough_height * rough_height, rough_norms)) return;
  const auto left = [&](Index x, Index y) { return left_turn(points_, facet, v, x, y); };
  const Index o = sector.out, i = sector.in;
  const bool inside = left(o, i) > 0 ? left(o, end) > 0 && left(end, i) > 0
                                     : !(left(i, end) >= 0 && left(end, o) >= 0);
  if (!inside) return;
  const ExactVector n = facet.normal(points_);
  const ExactVector d = exact::difference(points_, v, end);
  const ExactNumber height = exact::dot(n, d);
  const ExactNumber norms = exact::squared(n) * exact::squared(d), sine_squared = height * height;
  if (!threshold.beyond(norms - sine_squared, norms)) return;  // cos^2 = 1 - sin^2
  const double angle = 90 - exact_angle(norms - sine_squared, abs(height));
  offend(angle, threshold, true, segment_name(s) + " and facet " + std::to_string(facet.id));
}

// --- extent

class ChamferExtent {
 public:
  explicit ChamferExtent(const RefinedMesh& mesh)
      : record_(*mesh.record),
        points_(*mesh.points),
        surface_(*mesh.surface),
        complex_(*mesh.complex),
        facets_(surface_, record_),
        limit_(mesh.promise->chamfer_radius),
        widest_(mesh.promise->bridges ? kStraight : kThird) {
    for (const auto& corner : record_.corners) corner_[corner.vertex] = &corner;
  }

  OracleReport run() {
    const std::vector<std::uint8_t> used = used_in(complex_);
    std::vector<std::uint8_t> made(points_.size());
    for (const auto& [point, vertex] : record_.chamfer_points) {
      check_point(point, vertex);
      if (used[point] == 0) {
        report_.fail(complex_.vertex_name(point) + " was made by chamfering and is in no mesh");
      }
      if (made[point]++ != 0) {
        report_.fail(complex_.vertex_name(point) + " was made by chamfering twice");
      }
    }
    for (const ExactRecord::Chain& chain : record_.segments) {
      if (chain.artificial) check_chain(chain);
    }
    check_areas();
    report_.figures.emplace_back("edges of artificial segments", edges_);
    report_.figures.emplace_back("largest distance over chamfer distance", farthest_);
    return std::move(report_);
  }

 private:
  void check_point(Index p, Index vertex);
  void check_chain(const ExactRecord::Chain& chain);
  int side_of_midpoint(const InputSurface::Facet& facet, Index p, Index q, Index a, Index b) const;
  bool contains_midpoint(Index facet, Index a, Index b) const;
  bool crosses_border(Index facet, Index a, Index b) const;
  bool is_whole(std::span<const Index> triangles, const std::vector<Face>& faces) const;
  bool surely_covers_less(const InputSurface::Facet& facet, const std::vector<Face>& faces,
                          std::span<const Index> triangles) const;
  void check_areas();

  const ExactRecord& record_;
  const ExactPoints& points_;
  const InputSurface& surface_;
  const TetComplex& complex_;
  const FacetIndex facets_;
  // |VP| / |VA| where A is the cut point of a sector and |AP| = |PQ| = |QB|. Sectors are at most
  // 120 degrees wide, those of triangles less than 180.
  static constexpr double kThird = 1.3228756555322954;      // sqrt(7) / 2
  static constexpr double kStraight = 2.23606797749978969;  // sqrt(5)
  double limit_;                                            // --chamfer-radius, or 0
  double widest_;
  std::unordered_map<Index, const ExactRecord::Corner*> corner_;
  std::vector<Index> found_;
  std::uint64_t edges_ = 0;
  double farthest_ = 0;
  OracleReport report_{"chamfer-extent", "points made by chamfering"};
};

void ChamferExtent::check_point(Index p, Index vertex) {
  constexpr double kPlacement = 1 + 0x1p-16;
  ++report_.checked;
  const ExactPoint& point = record_.points[p];
  const bool on_edge = point.kind == ExactPoint::Kind::on_segment;
  if (point.kind != ExactPoint::Kind::on_segment && point.kind != ExactPoint::Kind::on_triangle) {
    return report_.fail(complex_.vertex_name(p) + " was made by chamfering, but is not given on " +
                        "an input edge or triangle");
  }
  // check_chain decides where bridge points lie, because a facet may have many triangles, any of
  // which may serve as the point's frame.
  if (on_edge && !(point.x >= 0 && point.x <= 1)) {
    report_.fail(complex_.vertex_name(p) + " lies beyond the ends of its edge");
  }
  if (on_edge && point.i != vertex && point.j != vertex) {
    report_.fail(complex_.vertex_name(p) + " is on no edge of input vertex " +
                 std::to_string(vertex));
  }
  const auto corner = corner_.find(vertex);
  if (corner == corner_.end()) {
    return report_.fail(complex_.vertex_name(p) + " was made for input vertex " +
                        std::to_string(vertex) + ", which was not chamfered");
  }
  const double distance = exact::distance(points_, p, vertex);
  const double reach = corner->second->distance;
  farthest_ = std::max(farthest_, distance / reach);
  // Cut points are at the distance along their edge, those of bridges to the side of such a place.
  if (!(distance * kPlacement >= reach)) {
    report_.fail(complex_.vertex_name(p) + " is nearer than the chamfer distance to input vertex " +
                 std::to_string(vertex));
  }
  if (!(distance <= reach * (on_edge ? 1 : widest_) * kPlacement)) {
    report_.fail(complex_.vertex_name(p) +
                 " is farther than the chamfer distance from input vertex " +
                 std::to_string(vertex));
  }
  if (limit_ > 0 && !(distance <= limit_ * kPlacement)) {
    report_.fail(complex_.vertex_name(p) + " is farther than --chamfer-radius from input vertex " +
                 std::to_string(vertex));
  }
}

void ChamferExtent::check_chain(const ExactRecord::Chain& chain) {
  const Index facet = facets_.find(chain.facet);
  if (facet == kNone) return;  // the segment oracle reports it
  for (std::size_t n = 1; n < chain.vertices.size(); ++n) {
    const Index a = chain.vertices[n - 1], b = chain.vertices[n];
    ++edges_;
    found_.clear();
    surface_.triangles_near(box_around(points_, std::array{a, b}), found_);
    if (!contains_midpoint(facet, a, a) || !contains_midpoint(facet, b, b) ||
        !contains_midpoint(facet, a, b) || crosses_border(facet, a, b)) {
      report_.fail("artificial edge " + complex_.vertex_name(a) + " - " + complex_.vertex_name(b) +
                   " leaves facet " + std::to_string(chain.facet));
    }
  }
}

// The side of p -> q on which the midpoint of two points of the facet's plane lies: 1 inside of the
// facet where that is to the left.
int ChamferExtent::side_of_midpoint(const InputSurface::Facet& facet, Index p, Index q, Index a,
                                    Index b) const {
  const auto on_line = [&](Index v) {
    return v == p || v == q || points_.is_combination(v, {p, q, q});
  };
  if (on_line(a) && on_line(b)) return 0;
  if (a == b) return facet.facing(points_, {p, q, a});
  const IntervalVector s = exact::rough_area2(points_, p, q, a),
                       t = exact::rough_area2(points_, p, q, b);
  const int rough =
      exact::dot(facet.rough_normal, IntervalVector{s[0] + t[0], s[1] + t[1], s[2] + t[2]}).sign();
  if (rough != 2) return rough;
  const ExactVector u = exact::area2(points_, p, q, a), v = exact::area2(points_, p, q, b);
  const ExactVector sum = {ExactNumber(u[0] + v[0]), ExactNumber(u[1] + v[1]),
                           ExactNumber(u[2] + v[2])};
  return sgn(exact::dot(facet.normal(points_), sum));
}

// Is the midpoint in the closed facet, that is, in one of its closed triangles?
bool ChamferExtent::contains_midpoint(Index facet, Index a, Index b) const {
  return std::any_of(found_.begin(), found_.end(), [&](Index t) {
    if (surface_.facet_of_triangle()[t] != facet) return false;
    const auto& [p, q, r] = surface_.triangles()[t];
    const InputSurface::Facet& plane = surface_.facets()[facet];
    return side_of_midpoint(plane, p, q, a, b) >= 0 && side_of_midpoint(plane, q, r, a, b) >= 0 &&
           side_of_midpoint(plane, r, p, a, b) >= 0;
  });
}

// Does the edge cross the facet's border properly, through the inside of both?
bool ChamferExtent::crosses_border(Index facet, Index a, Index b) const {
  const auto side = [&](Index p, Index q, Index r) {
    return side_of_midpoint(surface_.facets()[facet], p, q, r, r);
  };
  return std::any_of(found_.begin(), found_.end(), [&](Index t) {
    if (surface_.facet_of_triangle()[t] != facet) return false;
    for (int i = 0; i < 3; ++i) {
      if (surface_.facet_of_triangle()[surface_.neighbour(t, i)] == facet) continue;
      const Index p = surface_.triangles()[t][i], q = surface_.triangles()[t][(i + 1) % 3];
      if (side(p, q, a) * side(p, q, b) < 0 && side(a, b, p) * side(a, b, q) < 0) return true;
    }
    return false;
  });
}

// Is a facet one triangle, and that the only face on it?
bool ChamferExtent::is_whole(std::span<const Index> triangles,
                             const std::vector<Face>& faces) const {
  if (triangles.size() != 1 || faces.size() != 1) return false;
  Face corners = surface_.triangles()[triangles[0]];
  for (int turn = 0; turn < 3; ++turn) {
    if (corners == faces[0]) return true;
    std::rotate(corners.begin(), corners.begin() + 1, corners.end());
  }
  return false;
}

// Do intervals say that the faces cover less than the facet? So it is where something was cut off.
bool ChamferExtent::surely_covers_less(const InputSurface::Facet& facet,
                                       const std::vector<Face>& faces,
                                       std::span<const Index> triangles) const {
  Interval excess = 0;
  for (const auto& [a, b, c] : faces) {
    excess = excess + exact::dot(facet.rough_normal, exact::rough_area2(points_, a, b, c));
  }
  for (const Index t : triangles) {
    const auto& [a, b, c] = surface_.triangles()[t];
    excess = excess - exact::dot(facet.rough_normal, exact::rough_area2(points_, a, b, c));
  }
  return excess.sign() == -1;
}

void ChamferExtent::check_areas() {
  Buckets faces_of(surface_.facets().size());
  const auto for_each_face = [this](const auto& visit) {
    for (Index n = 0; n < record_.refined_facets.size(); ++n) {
      if (const Index f = facets_.find(record_.refined_facets[n][3]); f != kNone) visit(f, n);
    }
  };
  for_each_face([&faces_of](Index f, Index) { faces_of.count(f); });
  faces_of.allot();
  for_each_face([&faces_of](Index f, Index n) { faces_of.put(f, n); });
  const InputSurface::Members members = surface_.members();
  std::vector<Face> faces;
  for (Index f = 0; f < surface_.facets().size(); ++f) {
    faces.clear();
    for (const Index n : faces_of.of(f)) {
      const auto& [a, b, c, id] = record_.refined_facets[n];
      faces.push_back({a, b, c});
    }
    // A facet of which nothing is left, or all as it was, takes no arithmetic.
    if (faces.empty() || is_whole(members.of(f), faces)) continue;
    const InputSurface::Facet& facet = surface_.facets()[f];
    if (surely_covers_less(facet, faces, members.of(f))) continue;
    const std::array<ExactSum, 3> excess = surface_.excess2(points_, faces, members.of(f));
    const ExactVector normal = facet.normal(points_);
    // All areas are multiples of one vector, so one component of it that is not zero decides.
    std::size_t axis = 0;
    while (axis < 2 && sgn(normal[axis]) == 0) ++axis;
    if (excess[axis] == ExactSum()) continue;
    if (excess[axis].sign() * sgn(normal[axis]) > 0) {
      report_.fail("the faces on facet " + std::to_string(facet.id) + " cover more than the facet");
    }
  }
}

}  // namespace

OracleReport check_chamfer_angles(const RefinedMesh& mesh) {
  return ChamferAngles(mesh).run();
}

OracleReport check_chamfer_extent(const RefinedMesh& mesh) {
  return ChamferExtent(mesh).run();
}

}  // namespace tetproof::oracles
