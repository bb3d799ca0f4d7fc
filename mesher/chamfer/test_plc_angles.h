// For tests: the angles of a piecewise linear complex, measured with quadruple-precision positions
// and no code of the mesher.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "mesher/predicates/points.h"
#include "mesher/surface/plc.h"

namespace delmesher::chamfer::plc_angles {

__extension__ using Quad = __float128;
using QuadPoint = std::array<Quad, 3>;
using Vector = std::array<double, 3>;

inline QuadPoint position(const PointStore& points, VertexId v) {
  const PointDefinition& d = points.definition(v);
  const auto given = [&](VertexId w) {
    const Approximation &p = points.approximation(w), rest = points.remainder(w);
    return QuadPoint{Quad(p.x) + rest.x, Quad(p.y) + rest.y, Quad(p.z) + rest.z};
  };
  const auto corner = [&](int k) { return given(d.corner[k]); };
  if (points.is_corner(v)) return given(v);
  const QuadPoint p = corner(0), q = corner(1);
  QuadPoint result;
  for (int i = 0; i < 3; ++i) {
    if (d.kind == PointKind::on_segment) {
      result[i] = q[i] + Quad(d.u) * (p[i] - q[i]);
    } else {
      const QuadPoint r = corner(2);
      result[i] = r[i] + Quad(d.u) * (p[i] - r[i]) + Quad(d.v) * (q[i] - r[i]);
    }
  }
  return result;
}

inline double dot(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
// Unit vector of b - a.
inline Vector direction(const QuadPoint& a, const QuadPoint& b) {
  Quad largest = 0;
  std::array<Quad, 3> d;
  for (int i = 0; i < 3; ++i) {
    d[i] = b[i] - a[i];
    largest = std::max(largest, d[i] < 0 ? -d[i] : d[i]);
  }
  Vector v;
  for (int i = 0; i < 3; ++i) v[i] = static_cast<double>(d[i] / largest);
  const double length = std::sqrt(dot(v, v));
  for (double& x : v) x /= length;
  return v;
}
inline double degrees(const Vector& a, const Vector& b) {
  const Vector c = cross(a, b);
  return std::atan2(std::sqrt(dot(c, c)), dot(a, b)) * 180 / 3.14159265358979323846;
}

struct Angle {
  double degrees = 180;
  VertexId vertex = kNone;
  bool offer(double value, VertexId v) {
    if (!(value < degrees)) return false;
    degrees = value;
    vertex = v;
    return true;
  }
};

struct Report {
  Angle edge_edge, edge_facet, dihedral;
  // The smallest of all angles, each enlarged by as much as half an ulp of the complex's size, at
  // the ends of its shortest segment, can turn it.
  double smallest_if_turned = 180;
  std::string defect;  // boundary loops that are not closed, and the like
  double smallest() const {
    return std::min({edge_edge.degrees, edge_facet.degrees, dihedral.degrees});
  }
};

// Lengths of segments over the diagonal of the complex.
class RelativeLengths {
 public:
  explicit RelativeLengths(const std::map<VertexId, QuadPoint>& at) : at_(at) {
    QuadPoint low{}, high{};
    for (const auto& [v, p] : at) {
      for (int i = 0; i < 3; ++i) {
        low[i] = v == at.begin()->first ? p[i] : std::min(low[i], p[i]);
        high[i] = v == at.begin()->first ? p[i] : std::max(high[i], p[i]);
      }
    }
    diagonal_ = distance(low, high);
  }
  double operator()(VertexId v, VertexId w) const {
    return static_cast<double>(distance(at_.at(v), at_.at(w)) / diagonal_);
  }

 private:
  static Quad distance(const QuadPoint& p, const QuadPoint& q) {
    Quad largest = 0;
    for (int i = 0; i < 3; ++i)
      largest = std::max(largest, p[i] < q[i] ? q[i] - p[i] : p[i] - q[i]);
    double sum = 0;
    for (int i = 0; i < 3 && largest > 0; ++i) {
      const auto d = static_cast<double>((p[i] - q[i]) / largest);
      sum += d * d;
    }
    return largest * std::sqrt(sum);
  }

  const std::map<VertexId, QuadPoint>& at_;
  Quad diagonal_;
};

struct SectorAt {
  VertexId out, in;  // the sector is counter-clockwise from out to in
  Vector normal;
};

// Every facet's boundary sides must come loop by loop, in order.
inline Report measure(const Plc& plc, const PointStore& points) {
  Report report;
  std::map<VertexId, QuadPoint> at;
  std::map<VertexId, std::vector<VertexId>> neighbours;
  for (const PlcSegment& s : plc.segments) {
    for (int k = 0; k < 2; ++k) {
      at.try_emplace(s.vertex[k], position(points, s.vertex[k]));
      neighbours[s.vertex[k]].push_back(s.vertex[1 - k]);
    }
  }
  const RelativeLengths length_of(at);
  const auto offer = [&](Angle& of_kind, double value, VertexId v, double shortest) {
    of_kind.offer(value, v);
    const double turned = 2 * 0x1p-53 / shortest * 180 / 3.14159265358979323846;
    report.smallest_if_turned = std::min(report.smallest_if_turned, value + turned);
  };
  std::map<VertexId, std::vector<SectorAt>> sectors;
  struct Use {
    std::uint32_t facet;
    Vector inward;
  };
  std::map<std::uint32_t, std::vector<Use>> uses;
  for (std::uint32_t f = 0; f < plc.facets.size(); ++f) {
    const PlcFacet& facet = plc.facets[f];
    std::array<QuadPoint, 3> frame;
    for (int k = 0; k < 3; ++k) frame[k] = position(points, facet.frame[k]);
    Vector normal = cross(direction(frame[0], frame[1]), direction(frame[0], frame[2]));
    const double length = std::sqrt(dot(normal, normal));
    for (double& x : normal) x /= length;
    // A needle's normal vanishes in doubles.
    constexpr double kNeedle = 0x1p-40;
    if (length > kNeedle && (normal[facet.axis] > 0) != (facet.axis_sign > 0)) {
      report.defect = "axis of a facet";
    }
    std::vector<std::array<VertexId, 2>> sides;
    for (const PlcFacet::Side& side : facet.boundary) {
      auto v = plc.segments[side.segment].vertex;
      if (side.reversed) std::swap(v[0], v[1]);
      sides.push_back(v);
      uses[side.segment].push_back({f, cross(normal, direction(at[v[0]], at[v[1]]))});
    }
    std::size_t first = 0;
    for (std::size_t i = 0; i < sides.size(); ++i) {
      std::size_t next = i + 1;
      if (next == sides.size() || sides[next][0] != sides[i][1]) {
        if (sides[first][0] != sides[i][1]) report.defect = "open boundary loop";
        if (i - first < 2) report.defect = "boundary loop of two sides";
        next = first;
        first = i + 1;
      }
      sectors[sides[i][1]].push_back({sides[next][1], sides[i][0], normal});
    }
  }
  for (const auto& [segment, use] : uses) {
    if (use.size() > 2) report.defect = "segment of more than two facets";
    if (use.size() == 2) {
      const auto& ends = plc.segments[segment].vertex;
      offer(report.dihedral, degrees(use[0].inward, use[1].inward), ends[0],
            length_of(ends[0], ends[1]));
    }
  }
  if (uses.size() != plc.segments.size()) report.defect = "segment of no facet";
  for (const auto& [v, list] : neighbours) {
    for (std::size_t i = 0; i < list.size(); ++i) {
      const Vector a = direction(at[v], at[list[i]]);
      for (std::size_t j = 0; j < i; ++j) {
        if (list[i] == list[j]) report.defect = "two segments with the same ends";
        offer(report.edge_edge, degrees(a, direction(at[v], at[list[j]])), v,
              std::min(length_of(v, list[i]), length_of(v, list[j])));
      }
      for (const SectorAt& sector : sectors[v]) {
        if (list[i] == sector.out || list[i] == sector.in) continue;
        const double height = dot(a, sector.normal);
        const Vector flat = {a[0] - height * sector.normal[0], a[1] - height * sector.normal[1],
                             a[2] - height * sector.normal[2]};
        const Vector x = direction(at[v], at[sector.out]), y = cross(sector.normal, x);
        const Vector end = direction(at[v], at[sector.in]);
        const auto turn = [&](const Vector& d) {
          const double angle = std::atan2(dot(d, y), dot(d, x));
          return angle < 0 ? angle + 2 * 3.14159265358979323846 : angle;
        };
        const double size = std::sqrt(dot(flat, flat));
        if (size < 1e-9 || !(turn(flat) < turn(end))) continue;
        offer(report.edge_facet, std::atan2(std::abs(height), size) * 180 / 3.14159265358979323846,
              v, length_of(v, list[i]));
      }
    }
  }
  return report;
}

}  // namespace delmesher::chamfer::plc_angles
