// Lies: sections emptied, swapped, doubled, cut short, out of date.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "property_tests/lies/told.h"

namespace tetproof::lies {
namespace {

using namespace oracles;  // NOLINT
using delmesher::ExactPoint;
using delmesher::ExactRecord;

// A point put into the volume is moved a little, in file and record, so that it can be given on a
// triangle of three input vertices; the record says nothing more of how it came about.
void give_as_surface_point(Told& told) {
  ExactRecord& r = told.record;
  const auto& x = told.sample.input.vertices;
  double nearest = HUGE_VAL;
  std::size_t chosen = 0;
  ExactPoint best;
  for (std::size_t n = 0; n < r.balls.size(); ++n) {
    const ExactPoint& p = r.points[r.balls[n].vertex];
    for (Index i = 2; i < x.size(); ++i) {
      for (Index j = 1; j < i; ++j) {
        for (Index k = 0; k < j; ++k) {
          Position u, v, w;
          for (int axis = 0; axis < 3; ++axis) {
            u[axis] = x[i][axis] - x[k][axis];
            v[axis] = x[j][axis] - x[k][axis];
          }
          w = {p.x - x[k][0], p.y - x[k][1], p.z - x[k][2]};
          const auto dot = [](const Position& a, const Position& b) {
            return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
          };
          const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v);
          const double d = uu * vv - uv * uv;
          if (d < 1e-3) continue;
          const double s = (dot(u, w) * vv - dot(v, w) * uv) / d,
                       t = (dot(v, w) * uu - dot(u, w) * uv) / d;
          Position off;
          for (int axis = 0; axis < 3; ++axis) {
            off[axis] = w[axis] - s * u[axis] - t * v[axis];
          }
          if (dot(off, off) >= nearest) continue;
          nearest = dot(off, off);
          chosen = n;
          best = {ExactPoint::Kind::on_triangle,
                  i,
                  j,
                  k,
                  std::ldexp(std::round(s * 0x1p20), -20),
                  std::ldexp(std::round(t * 0x1p20), -20),
                  0};
        }
      }
    }
  }
  const Index vertex = r.balls[chosen].vertex;
  r.points[vertex] = best;
  r.balls.erase(r.balls.begin() + static_cast<std::ptrdiff_t>(chosen));
  ExactPoints points;
  ASSERT_EQ(points.assign(r.points), "");
  for (std::size_t i = 0; i < r.mesh_vertices.size(); ++i) {
    if (r.mesh_vertices[i] == vertex) told.sample.mesh.vertices[i] = points.nearest(vertex);
  }
}

// Gives a volume Steiner point another ball that has it inside: one corner is exchanged for a
// vertex that was there before (or was not), so that another vertex of that time is in the ball as
// well (where all were there).
void exchange_corner_of_a_ball(Told& told, bool there_before) {
  ExactRecord& r = told.record;
  ExactPoints points;
  ASSERT_EQ(points.assign(r.points), "");
  std::vector<std::uint8_t> used(points.size());
  for (const auto& tet : r.refined) {
    for (const Index v : tet.vertices) used[v] = 1;
  }
  for (auto& ball : r.balls) {
    for (Index w = 0; w < points.size(); ++w) {
      const auto& corners = ball.tetrahedron;
      if (used[w] == 0 || w == ball.vertex || (w < ball.vertex) != there_before ||
          std::find(corners.begin(), corners.end(), w) != corners.end()) {
        continue;
      }
      for (std::size_t i = 0; i < 4; ++i) {
        auto other = corners;
        other[i] = w;
        const int sign = exact::orient3d(points, other[0], other[1], other[2], other[3]);
        const auto is_in = [&](Index v) {
          return sign * exact::insphere(points, other[0], other[1], other[2], other[3], v) > 0;
        };
        if (!is_in(ball.vertex)) continue;
        bool was_in = !there_before;
        for (Index v = 0; v < ball.vertex && !was_in; ++v) was_in = used[v] != 0 && is_in(v);
        if (was_in) return void(ball.tetrahedron = other);
      }
    }
  }
  ADD_FAILURE() << "no such ball";
}

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
    {"no origin of a run far away", "sidecar",
     [](Told& t) {
       run_far_away(t);
       t.record.origin = {};
     }},
    {"an origin that is a rounding away", "sidecar",
     [](Told& t) {
       run_far_away(t);
       t.record.origin[0] += 0x1p-12;
     }},
    {"an origin so far away that nothing is exact", "frame",
     [](Told& t) {
       t.record.origin = {0x1p60, 0, 0};
     }},
    {"an origin that is not a number", "frame",
     [](Told& t) {
       t.record.origin = {0, NAN, 0};
     }},
    {"an origin beside an honest record", "frame",
     [](Told& t) {
       t.record.origin = {0, 0, -1};
     }},
    // Roundings of points so far from it would be larger.
    {"an origin that the points are moved away from", "frame",
     [](Told& t) {
       t.record.origin = {-0x1p30, 0, 0};
       for (auto& p : t.record.points) {
         if (p.kind == delmesher::ExactPoint::Kind::explicit_point) p.x += 0x1p30;
       }
     }},
    {"an origin of a run far away that is not beside it", "frame",
     [](Told& t) {
       run_far_away(t);
       t.record.origin[0] -= 0x1p10;
     }},
    {"a file far away that was moved beside the origin", "frame",
     [](Told& t) {
       run_far_away(t);
       for (auto& p : t.sample.mesh.vertices) {
         for (std::size_t i = 0; i < 3; ++i) p[i] -= t.record.origin[i];
       }
     }},
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
       t.record.corners.push_back({1, 0x1p-4});
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
    {"another label of a facet", "refined-segments",
     [](Told& t) { t.record.facets[kept_facet(t.record)].label = 17; }},
    {"a facet of a triangle that does not exist", "sidecar",
     [](Told& t) { t.record.facets.front().triangles.back() = 4294967295U; }, "crashed"},
    {"a segment over a point that does not exist", "sidecar",
     [](Told& t) { t.record.segments.front().vertices.back() = 4294967295U; }, "crashed"},
    {"a ball of a point that does not exist", "sidecar",
     [](Told& t) { t.record.balls.front().tetrahedron[2] = 4294967295U; }, "crashed"},
    {"a point made by chamfering twice", "refined-chamfer-extent",
     [](Told& t) { t.record.chamfer_points.push_back(t.record.chamfer_points.front()); }, "passed"},
    {"a point made by chamfering for no corner", "refined-chamfer-extent",
     [](Told& t) { t.record.chamfer_points.front()[1] = 8; }},
    {"an input vertex called made by chamfering", "refined-chamfer-extent",
     [](Told& t) {
       t.record.chamfer_points.push_back({0, t.record.corners.front().vertex});
     }},
    {"a corner that is not a vertex of the input", "refined-chamfer-need",
     [](Told& t) {
       t.record.corners.push_back({t.record.chamfer_points.front()[0], 0x1p-4});
     }},
    {"an artificial segment called one of the input", "refined-segments",
     [](Told& t) {
       for (auto& chain : t.record.segments) {
         if (chain.artificial) return void(chain.artificial = false);
       }
     }},
    {"a segment of the input called artificial", "refined-segments",
     [](Told& t) {
       for (auto& chain : t.record.segments) {
         if (chain.artificial) continue;
         chain.artificial = true;
         chain.facet = t.record.facets[kept_facet(t.record)].id;
         return;
       }
     }},
    {"a volume point given on a triangle, without a ball", "refined-steiner-balls",
     give_as_surface_point, "caught by enrichment"},
    {"faces before repairs without a mesh before them", "promise",
     [](Told& t) {
       t.record.unrepaired.clear();
       t.record.unrepaired_facets = t.record.final_facets;
     },
     "passed"},
    {"a face before repairs twice, another not at all", "unrepaired-facets",
     [](Told& t) {
       t.record.unrepaired = t.record.final;
       t.record.unrepaired_facets = t.record.final_facets;
       t.record.unrepaired_facets.back() = t.record.unrepaired_facets.front();
     },
     "passed"},
    {"a face before repairs turned over", "unrepaired-facets",
     [](Told& t) {
       t.record.unrepaired = t.record.final;
       t.record.unrepaired_facets = t.record.final_facets;
       auto& face = t.record.unrepaired_facets.front();
       std::swap(face[0], face[1]);
     },
     "not caught by it"},
    {"no tetrahedra outside before repairs", "unrepaired-hull",
     [](Told& t) {
       t.record.unrepaired = t.record.final;
       std::erase_if(t.record.unrepaired, [](const auto& tet) { return !tet.inside; });
     }},
    {"a tetrahedron before repairs turned over", "unrepaired-complex",
     [](Told& t) {
       t.record.unrepaired = t.record.final;
       auto& tet = t.record.unrepaired.front().vertices;
       std::swap(tet[0], tet[1]);
     }},
    {"all tetrahedra before repairs turned over", "unrepaired-orientation",
     [](Told& t) {
       t.record.unrepaired = t.record.final;
       for (auto& tet : t.record.unrepaired) std::swap(tet.vertices[0], tet.vertices[1]);
     }},
    {"a tetrahedron before repairs twice", "unrepaired-complex",
     [](Told& t) {
       t.record.unrepaired = t.record.final;
       t.record.unrepaired.push_back(t.record.unrepaired.front());
     }},
    {"a tetrahedron before repairs called outside", "unrepaired-conformity",
     [](Told& t) {
       t.record.unrepaired = t.record.final;
       std::find_if(t.record.unrepaired.begin(), t.record.unrepaired.end(), [](const auto& tet) {
         return tet.inside;
       })->inside = false;
     }},
    {"the refined mesh before repairs", "unrepaired-conformity",
     [](Told& t) {
       t.record.unrepaired = t.record.refined;
       t.record.unrepaired_facets = t.record.refined_facets;
     }},
    {"a face of the final mesh twice, another not at all", "exact-facets",
     [](Told& t) {
       t.sample.mesh.lists_boundary = false;
       t.sample.mesh.boundary.clear();
       t.sample.mesh.labels.clear();
       t.sample.mesh.facets.clear();
       t.record.final_facets.back() = t.record.final_facets.front();
     },
     "caught by exact-second-kernel"},
    {"a face of the final mesh turned over", "exact-facets",
     [](Told& t) {
       auto& face = t.record.final_facets.front();
       std::swap(face[0], face[1]);
     },
     "caught by exact-second-kernel"},
    {"a refined mesh with a plain tetrahedrization", "promise",
     [](Told& t) {
       run_cdt(t);
       t.record.refined = t.record.final;
     },
     "passed"},
    {"a facet of a plain tetrahedrization called dropped", "promise",
     [](Told& t) {
       run_cdt(t);
       t.record.facets.front().filtered = 1;
     },
     "passed"},
    {"a region of a plain tetrahedrization", "promise",
     [](Told& t) {
       run_cdt(t);
       t.record.parameters.region = delmesher::Region::hull;
     },
     "passed"},
    {"balls that need not be empty in a plain tetrahedrization", "promise",
     [](Told& t) {
       run_cdt(t);
       t.record.parameters.gabriel = false;
     },
     "passed"},
    {"an angle bound of a plain tetrahedrization", "promise",
     [](Told& t) {
       run_cdt(t);
       t.record.parameters.delta = 14;
     },
     "passed"},
    {"planar facets in a plain tetrahedrization", "promise",
     [](Told& t) {
       run_cdt(t);
       t.record.parameters.planar = 0x1p-20;
     },
     "passed"},
    {"triangles that bound nothing", "sidecar",
     [](Told& t) {
       t.record.triangles = t.sample.input.triangles;
       t.record.triangles.back() = t.record.triangles.front();
     },
     "called an invalid input"},
    {"a segment without vertices", "refined-segments",
     [](Told& t) {
       t.record.segments.push_back({false, kNone, {}});
     }},
    {"an artificial segment without vertices", "refined-segments",
     [](Told& t) {
       t.record.segments.push_back({true, t.record.facets[kept_facet(t.record)].id, {}});
     }},
    {"a segment of one vertex", "refined-segments",
     [](Told& t) {
       t.record.segments.push_back({false, kNone, {0}});
     }},
    {"an artificial segment from a vertex to itself", "refined-segments",
     [](Told& t) {
       for (auto& chain : t.record.segments) {
         if (chain.artificial) return void(chain.vertices.back() = chain.vertices.front());
       }
     }},
    {"an artificial segment said to be in another facet", "refined-segments",
     [](Told& t) {
       for (auto& chain : t.record.segments) {
         if (!chain.artificial) continue;
         for (const auto& facet : t.record.facets) {
           if (facet.filtered != 0 || facet.id == chain.facet) continue;
           chain.facet = facet.id;
           return;
         }
       }
     }},
    {"a face of the refined mesh on another facet", "refined-facets",
     [](Told& t) {
       auto& faces = t.record.refined_facets;
       for (auto& face : faces) {
         if (face[3] != faces.front()[3]) return void(face[3] = faces.front()[3]);
       }
     }},
    {"a face of the refined mesh turned over", "refined-facets",
     [](Told& t) {
       auto& face = t.record.refined_facets.front();
       std::swap(face[0], face[1]);
     }},
    {"a face of the refined mesh twice", "refined-facets",
     [](Told& t) { t.record.refined_facets.push_back(t.record.refined_facets.front()); }},
    {"a kept facet called dropped, with all its faces", "refined-facets",
     [](Told& t) { t.record.facets[kept_facet(t.record)].filtered = 1; }},
    {"a dropped facet called kept, without faces", "refined-chamfer-cuts",
     [](Told& t) {
       for (auto& facet : t.record.facets) {
         if (facet.filtered != 0) return void(facet.filtered = 0);
       }
     }},
    {"a facet of the first step called one of the second", "refined-filter",
     [](Told& t) {
       for (auto& facet : t.record.facets) {
         if (facet.filtered == 1) return void(facet.filtered = 2);
       }
     }},
    {"all facets of the first step called ones of the second, of a flat wedge", "refined-filter",
     [](Told& t) {
       t = run_of(honest_options(), Task::mesh, flat_wedge());
       for (auto& facet : t.record.facets) {
         if (facet.filtered == 1) facet.filtered = 2;
       }
     },
     "passed"},
    {"a facet near one dropped for its chamfers called so, too", "refined-filter",
     [](Told& t) {
       dagger(t);
       const auto dropped = [](const auto& facet) { return facet.filtered == 2; };
       ASSERT_EQ(std::ranges::count_if(t.record.facets, dropped), 1);
       // The side across from the sharp edge: no chamfer of it is small.
       const auto across = std::ranges::find(t.record.facets, 4U, &ExactRecord::Facet::id);
       ASSERT_NE(across, t.record.facets.end());
       across->filtered = 2;
       std::erase_if(t.record.refined_facets, [](const auto& face) { return face[3] == 4; });
     },
     "not caught by it"},
    {"a tetrahedron of the final mesh of a point that does not exist", "sidecar",
     [](Told& t) { t.record.final.front().vertices[1] = 4294967295U; }},
    {"a tetrahedron of the refined mesh of a point that does not exist", "sidecar",
     [](Told& t) { t.record.refined.front().vertices[1] = 4294967295U; }},
    {"points on the surface given by their nearest doubles", "exact-conformity",
     [](Told& t) {
       ExactPoints points;
       ASSERT_EQ(points.assign(t.record.points), "");
       for (const auto& [a, b, c, id] : t.record.final_facets) {
         for (const Index v : {a, b, c}) {
           if (points.is_double(v)) continue;
           const Position x = points.nearest(v);
           ExactPoint p;
           p.x = x[0];
           p.y = x[1];
           p.z = x[2];
           t.record.points[v] = p;
         }
       }
     }},
    {"a vertex of the final mesh as two points at one place", "exact-hull",
     [](Told& t) {
       const Index v = t.record.mesh_vertices.back();
       t.record.points.push_back(t.record.points[v]);
       for (auto& tet : t.record.final) {
         for (Index& w : tet.vertices) {
           if (w == v) return void(w = static_cast<Index>(t.record.points.size()) - 1);
         }
       }
     }},
    {"a ball for a point of no mesh", "refined-steiner-balls",
     [](Told& t) {
       t.record.points.push_back(t.record.points[t.record.balls.front().vertex]);
       t.record.balls.push_back(t.record.balls.front());
       t.record.balls.back().vertex = static_cast<Index>(t.record.points.size()) - 1;
     }},
    {"a ball of a tetrahedron with a corner in no mesh", "refined-steiner-balls",
     [](Told& t) {
       Index& corner = t.record.balls.front().tetrahedron[0];
       t.record.points.push_back(t.record.points[corner]);
       corner = static_cast<Index>(t.record.points.size()) - 1;
     },
     "passed"},
    {"a ball of a tetrahedron with a corner that came later", "refined-steiner-balls",
     [](Told& t) { exchange_corner_of_a_ball(t, false); }, "passed"},
    {"a ball in which another vertex was before", "refined-steiner-balls",
     [](Told& t) { exchange_corner_of_a_ball(t, true); }, "passed"},
    {"a point made by chamfering that is in no mesh", "refined-chamfer-extent",
     [](Told& t) {
       t.record.points.push_back(t.record.points[t.record.chamfer_points.front()[0]]);
       t.record.chamfer_points.push_back(t.record.chamfer_points.front());
       t.record.chamfer_points.back()[0] = static_cast<Index>(t.record.points.size()) - 1;
     },
     "passed"},
    {"a facet's label in the record alone", "facet-list",
     [](Told& t) {
       run_cdt(t);
       t.record.facets.back().label = 5;
     }},
    {"a point that nothing uses", "sidecar",
     [](Told& t) { t.record.points.push_back(t.record.points.front()); }, "passed"},
    {"a point on a segment that nothing uses", "sidecar",
     [](Told& t) {
       t.record.points.push_back({ExactPoint::Kind::on_segment, 0, 1, 0, 0.5, 0, 0});
     },
     "passed"},
    {"triangles that are those of the input", "promise",
     [](Told& t) { t.record.triangles = t.sample.input.triangles; }, "passed"},
    {"triangles turned inwards", "stand-in",
     [](Told& t) {
       t.record.triangles = t.sample.input.triangles;
       for (auto& corners : t.record.triangles) std::swap(corners[0], corners[1]);
     }},
};

}  // namespace

std::span<const Lie> sections() {
  return kSections;
}

}  // namespace tetproof::lies
