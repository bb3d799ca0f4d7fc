// Lies in the plane: sections emptied, swapped, doubled, cut short, out of date.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "property_tests/plane_lies/told.h"

namespace tetproof::plane_lies {
namespace {

using delmesher::ExactPoint;
using delmesher::PlaneRecord;
using Side = PlaneRecord::Side;
using Index = std::uint32_t;

// An edge of the refined mesh that is on no segment.
PlaneRecord::Edge free_edge(const PlaneRecord& r) {
  for (const auto& triangle : r.refined) {
    if (triangle.side != Side::inside) continue;
    const auto& v = triangle.vertices;
    const auto marked = std::any_of(r.refined_edges.begin(), r.refined_edges.end(), [&](auto& e) {
      return std::minmax(e.vertices[0], e.vertices[1]) == std::minmax(v[0], v[1]);
    });
    if (!marked) return {{v[0], v[1]}, 0};
  }
  ADD_FAILURE() << "no free edge";
  return {};
}

std::size_t edge_on_a_segment(const std::vector<PlaneRecord::Edge>& edges) {
  return static_cast<std::size_t>(
      std::find_if(edges.begin(), edges.end(), [](auto& e) { return e.segment != 0xffffffffU; }) -
      edges.begin());
}

// An edge at both ends of which its segment goes on.
std::size_t edge_between_others(const std::vector<PlaneRecord::Edge>& edges) {
  std::map<std::pair<Index, Index>, int> count;  // by vertex and segment
  for (const auto& e : edges) {
    for (const Index v : e.vertices) ++count[{v, e.segment}];
  }
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const auto& [a, b] = edges[i].vertices;
    const Index s = edges[i].segment;
    if (s != 0xffffffffU && count[{a, s}] == 2 && count[{b, s}] == 2) return i;
  }
  ADD_FAILURE() << "no edge between others";
  return 0;
}

const Lie kSections[] = {
    {"no points", "promise", [](Told& t) { t.record.points.clear(); }},
    {"no refined mesh", "promise", [](Told& t) { t.record.refined.clear(); }},
    {"no edges of the refined mesh", "promise", [](Told& t) { t.record.refined_edges.clear(); }},
    {"no final mesh", "promise", [](Told& t) { t.record.final.clear(); }},
    {"no edges of the final mesh", "promise", [](Told& t) { t.record.final_edges.clear(); }},
    {"no written vertices", "promise", [](Told& t) { t.record.mesh_vertices.clear(); }},
    {"points cut short", "sidecar", [](Told& t) { t.record.points.pop_back(); }},
    {"refined mesh cut short", "refined-complex", [](Told& t) { t.record.refined.pop_back(); }},
    {"final mesh cut short", "exact-complex", [](Told& t) { t.record.final.pop_back(); }},
    {"written vertices cut short", "same-mesh", [](Told& t) { t.record.mesh_vertices.pop_back(); }},
    {"a refined triangle twice", "refined-complex",
     [](Told& t) { t.record.refined.push_back(t.record.refined.front()); }},
    {"a final triangle twice", "exact-complex",
     [](Told& t) { t.record.final.push_back(t.record.final.front()); }},
    {"an edge of the final mesh twice", "exact-complex",
     [](Told& t) { t.record.final_edges.push_back(t.record.final_edges.front()); }},
    {"an edge of the refined mesh fewer", "refined-segments",
     [](Told& t) {
       auto& edges = t.record.refined_edges;
       edges.erase(edges.begin() + static_cast<std::ptrdiff_t>(edge_between_others(edges)));
     }},
    {"the edges of the refined mesh at a vertex fewer", "refined-chamfer-cuts",
     [](Told& t) {
       std::erase_if(t.record.refined_edges,
                     [](const auto& e) { return e.vertices[0] == 0 || e.vertices[1] == 0; });
     }},
    {"an edge of the final mesh fewer", "exact-conformity",
     [](Told& t) {
       auto& edges = t.record.final_edges;
       edges.erase(edges.begin() + static_cast<std::ptrdiff_t>(edge_on_a_segment(edges)));
     }},
    {"an edge of the final mesh on another segment", "exact-conformity",
     [](Told& t) { t.record.final_edges[edge_on_a_segment(t.record.final_edges)].segment ^= 1U; }},
    {"an edge inside called one of the outer box", "refined-complex",
     [](Told& t) {
       t.record.refined_edges.push_back(free_edge(t.record));
       t.record.refined_edges.back().segment = 0xffffffffU;
     }},
    {"an edge inside called one of a segment", "refined-segments",
     [](Told& t) { t.record.refined_edges.push_back(free_edge(t.record)); }},
    {"refined mesh instead of the final one", "exact-conformity",
     [](Told& t) {
       t.record.final = t.record.refined;
       t.record.final_edges = t.record.refined_edges;
     }},
    {"final mesh instead of the refined one", "refined-chamfer-cuts",
     [](Told& t) {
       t.record.refined = t.record.final;
       t.record.refined_edges = t.record.final_edges;
     }},
    {"the refined mesh called outside", "refined-sides",
     [](Told& t) {
       for (auto& triangle : t.record.refined) triangle.side = Side::outside;
     }},
    {"a refined triangle called mixed", "refined-sides",
     [](Told& t) { some(t.record.refined, Side::inside).side = Side::mixed; }},
    {"a refined triangle that a segment crosses, called outside", "refined-sides",
     [](Told& t) { some(t.record.refined, Side::mixed).side = Side::outside; }},
    {"a refined triangle turned over", "refined-orientation",
     [](Told& t) {
       auto& v = t.record.refined.front().vertices;
       std::swap(v[0], v[1]);
     }},
    {"two input vertices exchanged", "sidecar",
     [](Told& t) { std::swap(t.record.points[0], t.record.points[1]); }},
    {"a point beyond its segment", "sidecar",
     [](Told& t) {
       for (auto& p : t.record.points) {
         if (p.kind != ExactPoint::Kind::on_segment) continue;
         p.x = 1.5;
         return;
       }
     }},
    {"a point on a segment of points that do not exist", "sidecar",
     [](Told& t) {
       for (auto& p : t.record.points) {
         if (p.kind == ExactPoint::Kind::on_segment) return void(p.j = 0xfffffff0U);
       }
     }},
    {"a point that is not a number", "sidecar",
     [](Told& t) { t.record.points.back() = {ExactPoint::Kind::explicit_point, 0, 0, 0, NAN, 0}; }},
    {"an edge of the refined mesh between points that do not exist", "sidecar",
     [](Told& t) { t.record.refined_edges.front().vertices[1] = 0xfffffff0U; }},
    {"an edge of the final mesh on a segment that does not exist", "exact-conformity",
     [](Told& t) { t.record.final_edges.front().segment = 7777; }},
    {"a triangle of the final mesh called mixed", "exact-sides",
     [](Told& t) { some(t.record.final, Side::inside).side = Side::mixed; }},
    {"a written vertex twice, another not at all", "rounding",
     [](Told& t) { t.record.mesh_vertices.back() = t.record.mesh_vertices.front(); }},
    {"a vertex of the final mesh as two points at one place", "exact-complex",
     [](Told& t) {
       auto& vertices = t.record.final.back().vertices;
       t.record.points.push_back(t.record.points[vertices[0]]);
       vertices[0] = static_cast<Index>(t.record.points.size()) - 1;
     }},
    {"a point that nothing uses", "sidecar",
     [](Told& t) { t.record.points.push_back(t.record.points.back()); }},
    {"an edge of the border of the refined mesh fewer", "refined-complex",
     [](Told& t) {
       auto& edges = t.record.refined_edges;
       edges.erase(std::ranges::find(edges, 0xffffffffU, &PlaneRecord::Edge::segment));
     }},
    {"an edge of the border of the final mesh fewer", "exact-complex",
     [](Told& t) {
       auto& edges = t.record.final_edges;
       edges.erase(std::ranges::find(edges, 0xffffffffU, &PlaneRecord::Edge::segment));
     }},
    {"a triangle of no points", "sidecar",
     [](Told& t) { t.record.final.front().vertices[0] = 0xfffffff0U; }},
};

}  // namespace

std::span<const Lie> sections() {
  return kSections;
}

}  // namespace tetproof::plane_lies
