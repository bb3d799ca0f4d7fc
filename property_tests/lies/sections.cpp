// Lies: sections emptied, swapped, doubled, cut short, out of date.
#include <algorithm>
#include <utility>

#include "property_tests/lies/told.h"

namespace tetproof::lies {
namespace {

using namespace oracles;  // NOLINT

const Lie kSections[] = {
    {"no facets", "promise", [](Told& t) { t.record.facets.clear(); }},
    {"no segments", "promise", [](Told& t) { t.record.segments.clear(); }},
    {"no refined mesh", "promise", [](Told& t) { t.record.refined.clear(); }},
    {"no faces on facets in the refined mesh", "promise",
     [](Told& t) { t.record.refined_facets.clear(); }},
    {"no final mesh", "promise", [](Told& t) { t.record.final.clear(); }},
    {"no faces on facets in the final mesh", "promise",
     [](Told& t) { t.record.final_facets.clear(); }},
    {"no written vertices", "promise", [](Told& t) { t.record.mesh_vertices.clear(); }},
    {"no points made by chamfering", "promise", [](Told& t) { t.record.chamfer_points.clear(); }},
    {"no corners", "refined-chamfer-need", [](Told& t) { t.record.corners.clear(); }},
    {"no balls", "refined-steiner-balls", [](Told& t) { t.record.balls.clear(); }},
    {"one ball fewer", "refined-steiner-balls", [](Told& t) { t.record.balls.pop_back(); }},
    {"one ball twice", "refined-steiner-balls",
     [](Told& t) { t.record.balls.push_back(t.record.balls.front()); }},
    {"a ball of a flat tetrahedron", "refined-steiner-balls",
     [](Told& t) {
       auto& corners = t.record.balls.front().tetrahedron;
       corners[3] = corners[2];
     }},
    {"a ball for an input vertex", "refined-steiner-balls",
     [](Told& t) {
       t.record.balls.push_back(t.record.balls.front());
       t.record.balls.back().vertex = 0;
     }},
    {"a corner fewer", "refined-chamfer-need", [](Told& t) { t.record.corners.pop_back(); }},
    {"a corner twice", "refined-chamfer-need",
     [](Told& t) { t.record.corners.push_back(t.record.corners.front()); }},
    {"a corner that is not acute", "refined-chamfer-need",
     [](Told& t) {
       t.record.corners.push_back({1, 60, 0x1p-4});
     }},
    {"a point made by chamfering fewer", "refined-chamfer-cuts",
     [](Told& t) { t.record.chamfer_points.pop_back(); }},
    {"a point made for two corners", "refined-chamfer-cuts",
     [](Told& t) {
       t.record.chamfer_points.push_back(t.record.chamfer_points.front());
       auto& made = t.record.chamfer_points.back();
       made[1] = made[1] == 0 ? 3 : 0;
     }},
    {"refined mesh instead of the final one", "exact-conformity",
     [](Told& t) {
       t.record.final = t.record.refined;
       t.record.final_facets = t.record.refined_facets;
     }},
    {"final mesh instead of the refined one", "refined-delaunay",
     [](Told& t) { t.record.refined = t.record.final; }},
    {"every tetrahedron of the refined mesh called outside", "refined-contained",
     [](Told& t) {
       for (auto& tet : t.record.refined) tet.inside = false;
     }},
    {"one tetrahedron of the refined mesh called outside", "refined-contained",
     [](Told& t) {
       std::find_if(t.record.refined.begin(), t.record.refined.end(), [](const auto& tet) {
         return tet.inside;
       })->inside = false;
     }},
    {"a facet twice, another one not at all", "facet-list",
     [](Told& t) { t.record.facets.back() = t.record.facets.front(); }},
    {"a facet without its triangles", "facet-list",
     [](Told& t) { t.record.facets.front().triangles.clear(); }},
    {"a triangle twice in its facet", "facet-list",
     [](Told& t) {
       auto& triangles = t.record.facets.front().triangles;
       triangles.push_back(triangles.front());
     }},
    {"facets of a plain tetrahedrization exchanged", "facet-list",
     [](Told& t) {
       run_cdt(t);
       std::swap(t.record.facets.front().id, t.record.facets.back().id);
     }},
    {"a segment cut short", "refined-segments",
     [](Told& t) {
       for (auto& chain : t.record.segments) {
         if (!chain.artificial && chain.vertices.size() > 2) return chain.vertices.pop_back();
       }
     }},
    {"a segment in two pieces", "refined-segments",
     [](Told& t) {
       for (std::size_t n = 0; n < t.record.segments.size(); ++n) {
         auto chain = t.record.segments[n];
         if (chain.artificial || chain.vertices.size() < 3) continue;
         t.record.segments[n].vertices.resize(2);
         chain.vertices.erase(chain.vertices.begin());
         t.record.segments.push_back(chain);
         return;
       }
     }},
    {"a segment twice", "refined-segments",
     [](Told& t) { t.record.segments.push_back(t.record.segments.front()); }},
    {"tetrahedra of balls exchanged", "refined-steiner-balls",
     [](Told& t) {
       auto& balls = t.record.balls;
       std::swap(balls.front().tetrahedron, balls.back().tetrahedron);
     }},
    {"all tetrahedra of the final mesh turned over", "exact-orientation",
     [](Told& t) {
       for (auto& tet : t.record.final) std::swap(tet.vertices[0], tet.vertices[1]);
     }},
    {"two input vertices exchanged", "sidecar",
     [](Told& t) { std::swap(t.record.points[0], t.record.points[1]); }},
    {"labels of facets exchanged", "refined-segments",
     [](Told& t) { t.record.facets[kept_facet(t.record)].label = 17; }},
};

}  // namespace

std::span<const Lie> sections() {
  return kSections;
}

}  // namespace tetproof::lies
