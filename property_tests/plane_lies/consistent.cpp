// Lies in the plane that change mesh and record together, so that both agree.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "property_tests/plane_lies/told.h"

namespace tetproof::plane_lies {
namespace {

using delmesher::ExactPoint;
using delmesher::PlaneOptions;
using delmesher::PlaneRecord;
using oracles::PlaneFile;
using Side = PlaneRecord::Side;
using Index = std::uint32_t;

// A run with other options, told to be the honest one.
template <class Change>
void claim_for(Told& told, Change change) {
  PlaneOptions options = honest_options();
  change(options);
  const PlaneVerifyOptions promised = told.how;
  const double delta = told.record.delta, acute = told.record.acute;
  told = run_of(options);
  told.how = promised;
  told.record.delta = delta;
  told.record.acute = acute;
}

// The triangle of the record that is triangle t of the file.
PlaneRecord::Triangle& recorded(Told& told, std::size_t t) {
  std::array<Index, 3> wanted;
  for (std::size_t i = 0; i < 3; ++i) {
    wanted[i] = told.record.mesh_vertices[told.file.triangles[t][i]];
  }
  for (auto& triangle : told.record.final) {
    if (turned(triangle.vertices) == turned(wanted)) return triangle;
  }
  ADD_FAILURE() << "no such triangle";
  return told.record.final.front();
}

// The edges between two triangles of the file that are not on segments, by the triangles.
struct Pair {
  std::size_t left, right;
  Index a, b, c, d;  // left is abc, right is bad
};

std::vector<Pair> pairs(const PlaneFile& file) {
  std::map<std::array<Index, 2>, std::pair<std::size_t, Index>> left;
  for (std::size_t t = 0; t < file.triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& v = file.triangles[t];
      left[{v[i], v[(i + 1) % 3]}] = {t, v[(i + 2) % 3]};
    }
  }
  for (const auto& [a, b] : file.edges) {
    left.erase({a, b});
    left.erase({b, a});
  }
  std::vector<Pair> result;
  for (const auto& [edge, at] : left) {
    const auto other = left.find({edge[1], edge[0]});
    if (edge[0] > edge[1] || other == left.end()) continue;
    result.push_back(
        {at.first, other->second.first, edge[0], edge[1], at.second, other->second.second});
  }
  return result;
}

double twice_area(const PlaneFile& file, Index a, Index b, Index c) {
  const auto &p = file.vertices[a], &q = file.vertices[b], &r = file.vertices[c];
  return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
}

// Flips the diagonal of two triangles that form a convex quadrilateral, in file and record. The
// result is not Delaunay where it was strictly so before.
void flip_in_both(Told& told) {
  for (const Pair& p : pairs(told.file)) {
    const double area = twice_area(told.file, p.a, p.b, p.c) / 10;
    if (twice_area(told.file, p.c, p.d, p.b) < area ||
        twice_area(told.file, p.d, p.c, p.a) < area) {
      continue;
    }
    const auto& ids = told.record.mesh_vertices;
    PlaneRecord::Triangle &left = recorded(told, p.left), &right = recorded(told, p.right);
    left.vertices = {ids[p.c], ids[p.d], ids[p.b]};
    right.vertices = {ids[p.d], ids[p.c], ids[p.a]};
    told.file.triangles[p.left] = {p.c, p.d, p.b};
    told.file.triangles[p.right] = {p.d, p.c, p.a};
    return;
  }
  ADD_FAILURE() << "no convex quadrilateral";
}

// Triangle t of the final mesh is split at a new point, in file and record.
void split_in_both(Told& told, std::size_t t) {
  const auto [a, b, c] = told.file.triangles[t];
  std::array<double, 2> centre{};
  for (const Index v : {a, b, c}) {
    for (std::size_t k = 0; k < 2; ++k) centre[k] += told.file.vertices[v][k] / 4;
  }
  for (std::size_t k = 0; k < 2; ++k) centre[k] += told.file.vertices[a][k] / 4;
  const auto in_file = static_cast<Index>(told.file.vertices.size());
  const auto in_record = static_cast<Index>(told.record.points.size());
  told.file.vertices.push_back(centre);
  told.record.mesh_vertices.push_back(in_record);
  ExactPoint point;
  point.x = centre[0];
  point.y = centre[1];
  told.record.points.push_back(point);
  const auto& ids = told.record.mesh_vertices;
  recorded(told, t).vertices = {ids[a], ids[b], in_record};
  told.record.final.push_back({{ids[b], ids[c], in_record}, Side::inside});
  told.record.final.push_back({{ids[c], ids[a], in_record}, Side::inside});
  told.file.triangles[t] = {a, b, in_file};
  told.file.triangles.push_back({b, c, in_file});
  told.file.triangles.push_back({c, a, in_file});
  told.file.inside.resize(told.file.triangles.size(), 1);
}

// The refined mesh is the outer box, cut into two; nothing of the input is left in it.
void empty_box(PlaneRecord& r) {
  std::array<Index, 4> corner{};
  std::array<double, 4> best;
  best.fill(-HUGE_VAL);
  for (const auto& triangle : r.refined) {
    for (const Index v : triangle.vertices) {
      const ExactPoint& p = r.points[v];
      if (p.kind != ExactPoint::Kind::explicit_point) continue;
      const std::array<double, 4> reach = {-p.x - p.y, p.x - p.y, p.x + p.y, p.y - p.x};
      for (std::size_t k = 0; k < 4; ++k) {
        if (reach[k] > best[k]) corner[k] = v;
        best[k] = std::max(best[k], reach[k]);
      }
    }
  }
  r.refined = {{{corner[0], corner[1], corner[2]}, Side::mixed},
               {{corner[2], corner[3], corner[0]}, Side::mixed}};
  r.refined_edges.clear();
  for (std::size_t k = 0; k < 4; ++k) {
    r.refined_edges.push_back({{corner[k], corner[(k + 1) % 4]}, 0xffffffffU});
  }
  r.corners.clear();
}

void drop_all(Told& told) {
  told.record.dropped.clear();
  for (Index s = 0; s < told.graph.segments.size(); ++s) told.record.dropped.push_back(s);
}

std::array<double, 2> place_of(const Told& told, Index v) {
  const ExactPoint& p = told.record.points[v];
  if (p.kind == ExactPoint::Kind::explicit_point) return {p.x, p.y};
  const auto &a = told.graph.vertices[p.i], &b = told.graph.vertices[p.j];
  return {p.x * a[0] + (1 - p.x) * b[0], p.x * a[1] + (1 - p.x) * b[1]};
}

// The file of those triangles of the refined mesh that the record calls inside.
void write_refined(Told& told) {
  constexpr Index kNotWritten = 0xffffffffU;
  std::vector<Index> number(told.record.points.size(), kNotWritten);
  told.record.mesh_vertices.clear();
  PlaneFile file;
  file.lists_edges = told.file.lists_edges;
  file.names_segments = told.file.names_segments;
  std::set<std::pair<Index, Index>> sides;
  for (const PlaneRecord::Triangle& triangle : told.record.refined) {
    if (triangle.side != Side::inside) continue;
    std::array<Index, 3> corners = triangle.vertices;
    for (std::size_t i = 0; i < 3; ++i) {
      sides.insert(std::minmax(triangle.vertices[i], triangle.vertices[(i + 1) % 3]));
      Index& v = corners[i];
      if (number[v] == kNotWritten) {
        number[v] = static_cast<Index>(file.vertices.size());
        file.vertices.push_back(place_of(told, v));
        told.record.mesh_vertices.push_back(v);
      }
      v = number[v];
    }
    file.triangles.push_back(corners);
    file.inside.push_back(1);
  }
  for (const auto& [ends, segment] : told.record.refined_edges) {
    if (segment >= told.graph.segments.size() || !sides.contains(std::minmax(ends[0], ends[1]))) {
      continue;
    }
    file.edges.push_back({number[ends[0]], number[ends[1]]});
    file.segments.push_back(segment);
    file.markers.push_back(told.graph.markers[segment]);
  }
  told.file = file;
}

void run_approximate(Told& told) {
  PlaneOptions options = honest_options();
  options.approximate = true;
  told = run_of(options);
}

const Lie kConsistent[] = {
    {"a run with delta 5", "refined-angles",
     [](Told& t) { claim_for(t, [](PlaneOptions& o) { o.delta = 5; }); }},
    {"a run with corners below 90 degrees chamfered", "refined-chamfer-need",
     [](Told& t) { claim_for(t, [](PlaneOptions& o) { o.acute = 90; }); }},
    {"a run with chamfers wider than promised", "refined-chamfer-distance",
     [](Told& t) { t.how.promised.chamfer_radius = 0x1p-8; }},
    {"a run with edges longer than promised", "refined-edges",
     [](Told& t) { t.how.promised.max_edge = 0x1p-4; }},
    {"a run of more vertices than were allowed", "promise",
     [](Told& t) { t.how.promised.max_vertices = 4; }, "passed"},
    {"a run that drops more than tau allows", "refined-drops",
     [](Told& t) { t.how.promised.tau = 1e-4; }},
    {"a run of the other region", "same-mesh",
     [](Told& t) { t.how.promised.region = delmesher::Region::hull; }},
    {"a run that stopped before the last step", "promise",
     [](Told& t) { claim_for(t, [](PlaneOptions& o) { o.approximate = true; }); }},
    {"all segments dropped, an empty box refined", "refined-drops",
     [](Told& t) {
       empty_box(t.record);
       drop_all(t);
     }},
    {"all segments kept, an empty box refined", "refined-drops",
     [](Told& t) { empty_box(t.record); }},
    {"an outer box that does not hold the input", "refined-complex",
     [](Told& t) {
       t.record.refined = {{{0, 5, 8}, Side::mixed}};
       t.record.refined_edges = {{{0, 5}, 0xffffffffU}};
     }},
    {"an edge that is not Delaunay", "exact-delaunay", [](Told& t) { flip_in_both(t); }},
    {"a point of no origin", "enrichment", [](Told& t) { split_in_both(t, 3); }},
    {"a triangle inverted", "orientation",
     [](Told& t) {
       PlaneRecord::Triangle& triangle = recorded(t, 0);
       std::swap(t.file.triangles[0][0], t.file.triangles[0][1]);
       std::swap(triangle.vertices[0], triangle.vertices[1]);
     }},
    {"the same, by the record", "exact-orientation",
     [](Told& t) {
       PlaneRecord::Triangle& triangle = recorded(t, 0);
       std::swap(t.file.triangles[0][0], t.file.triangles[0][1]);
       std::swap(triangle.vertices[0], triangle.vertices[1]);
     }},
    {"a triangle of the inside left out", "exact-sides",
     [](Told& t) {
       recorded(t, t.file.triangles.size() - 1).side = Side::outside;
       t.file.triangles.pop_back();
       t.file.inside.pop_back();
     }},
    {"a triangle of the inside left out, by the file", "conformity",
     [](Told& t) {
       recorded(t, t.file.triangles.size() / 2).side = Side::outside;
       t.file.triangles.erase(t.file.triangles.begin() +
                              static_cast<std::ptrdiff_t>(t.file.triangles.size() / 2));
       t.file.inside.pop_back();
     }},
    {"the hole filled", "exact-sides",
     [](Told& t) {
       t.graph.holes = {{0.5, 0.5}};
     }},
    {"the hole filled, by the file", "sides",
     [](Told& t) {
       t.graph.holes = {{0.515625, 0.53125}};
     }},
    {"all but one triangle of --approximate called outside", "refined-sides",
     [](Told& t) {
       run_approximate(t);
       const PlaneRecord::Triangle kept = some(t.record.refined, Side::inside);
       for (auto& triangle : t.record.refined) {
         if (triangle.side == Side::inside && triangle.vertices != kept.vertices) {
           triangle.side = Side::outside;
         }
       }
       write_refined(t);
     },
     "passed"},
    {"the hole filled, of --approximate", "refined-sides",
     [](Told& t) {
       run_approximate(t);
       const Index by_hole = 5;  // a vertex
       for (auto& triangle : t.record.refined) {
         const auto& v = triangle.vertices;
         if (triangle.side == Side::outside && std::find(v.begin(), v.end(), by_hole) != v.end()) {
           triangle.side = Side::inside;
         }
       }
       write_refined(t);
     },
     "passed"},
    {"edges of a final mesh that is not there, for --approximate", "promise",
     [](Told& t) {
       const auto edges = t.record.final_edges;
       run_approximate(t);
       t.record.final_edges = edges;
     },
     "passed"},
    {"an edge on a segment not listed, in the file alone", "edge-list",
     [](Told& t) {
       const auto& last = t.file.edges.back();
       const auto a = t.record.mesh_vertices[last[0]];
       const auto b = t.record.mesh_vertices[last[1]];
       std::erase_if(t.record.final_edges, [&](const auto& e) {
         return std::minmax(e.vertices[0], e.vertices[1]) == std::minmax(a, b);
       });
       t.file.markers.back() = 78;
     }},
};

}  // namespace

std::span<const Lie> consistent() {
  return kConsistent;
}

}  // namespace tetproof::plane_lies
