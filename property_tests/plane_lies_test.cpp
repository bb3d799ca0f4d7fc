// Lies of a record of the plane, as lies_test.cpp tells them in space: relaxed promises; sections
// emptied, cut short, doubled, swapped; records and files of other runs; lies that change mesh and
// record together. Each has to be caught by the oracle meant for it. At the end they are printed
// as a table.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "mesher/delmesher_plane.h"
#include "oracles/plane_verify.h"
#include "property_tests/score_table.h"

namespace tetproof {
namespace {

using delmesher::ExactPoint;
using delmesher::Options;
using delmesher::PlanarGraph;
using delmesher::PlaneRecord;
using delmesher::PlaneResult;
using oracles::PlaneFile;
using Side = PlaneRecord::Side;
using Index = std::uint32_t;

// A run as it is told, and what was asked for.
struct Told {
  PlanarGraph graph;
  PlaneFile file;
  PlaneRecord record;
  PlaneVerifyOptions how;
};

// A square with a sharp dent and a slender hole: chamfers. Two lines inside with a channel of
// 1 : 2000 between them: one is dropped. Holes decide what is inside, not parity.
PlanarGraph honest_graph() {
  PlanarGraph graph;
  graph.vertices = {{0, 0},     {4.5, 0},      {4, 4},    {2.2, 1.1}, {0, 4},      {1, 1},
                    {1.5, 0.5}, {1.25, 0.875}, {0.25, 2}, {0.25, 3},  {0.2505, 2}, {0.2505, 3}};
  graph.segments = {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 0},
                    {5, 6}, {6, 7}, {7, 5}, {8, 9}, {10, 11}};
  graph.markers = {1, 1, 2, 2, 1, 3, 3, 3, 4, 5};
  graph.holes = {{1.25, 0.8125}};
  return graph;
}

Options honest_options() {
  Options options = delmesher::plane_options();
  options.want_exact = true;
  options.tau = 1e-2;
  return options;
}

Told run_of(const Options& options, const PlanarGraph& graph = honest_graph()) {
  const PlaneResult result = delmesher::triangulate_polygon(graph, options);
  EXPECT_TRUE(result.status.ok()) << result.status.message;
  Told told{graph, oracles::plane_file_of(result.mesh), result.exact, {}};
  told.how.promised = oracles::promise_of(options, oracles::Task::plane);
  return told;
}

const Told& honest() {
  static const Told told = run_of(honest_options());
  return told;
}

// A run with other options, told to be the honest one.
template <class Change>
void claim_for(Told& told, Change change) {
  Options options = honest_options();
  change(options);
  const PlaneVerifyOptions promised = told.how;
  const double delta = told.record.delta, acute = told.record.acute;
  told = run_of(options);
  told.how = promised;
  told.record.delta = delta;
  told.record.acute = acute;
}

std::array<Index, 3> turned(std::array<Index, 3> t) {
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return t;
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

PlaneRecord::Triangle& some(std::vector<PlaneRecord::Triangle>& triangles, Side side) {
  return *std::find_if(triangles.begin(), triangles.end(),
                       [side](const auto& t) { return t.side == side; });
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

// The first written vertex that is not of the input.
std::size_t steiner(const Told& told) {
  for (std::size_t i = 0; i < told.record.mesh_vertices.size(); ++i) {
    if (told.record.mesh_vertices[i] >= told.graph.vertices.size()) return i;
  }
  ADD_FAILURE() << "no Steiner point";
  return 0;
}

struct Lie {
  const char* name;
  const char* oracle;  // the one meant to catch it
  void (*tell)(Told&);
};

void PrintTo(const Lie& lie, std::ostream* stream) {
  *stream << lie.name;
}

const Lie kRelaxed[] = {
    {"delta relaxed to nothing", "promise", [](Told& t) { t.record.delta = 0x1p-20; }},
    {"delta that is no number", "promise", [](Told& t) { t.record.delta = NAN; }},
    {"delta that no triangle has", "promise", [](Told& t) { t.record.delta = 1000; }},
    {"threshold of corners relaxed", "promise", [](Told& t) { t.record.acute = 1; }},
    {"an old version", "promise", [](Told& t) { t.how.record_version = 0; }},
    {"a radius half as large again", "refined-chamfer-radius",
     [](Told& t) { t.record.corners.front().radius *= 1.5; }},
    {"a radius half as large", "refined-chamfer-cuts",
     [](Told& t) { t.record.corners.front().radius /= 2; }},
    {"a radius of nothing", "refined-chamfer-radius",
     [](Told& t) { t.record.corners.front().radius = 0; }},
    {"radii of 2^60", "refined-chamfer-radius",
     [](Told& t) {
       for (auto& corner : t.record.corners) corner.radius = 0x1p60;
     }},
    {"a corner fewer", "refined-chamfer-need", [](Told& t) { t.record.corners.pop_back(); }},
    {"a corner fewer, by its cuts", "refined-chamfer-cuts",
     [](Told& t) { t.record.corners.pop_back(); }},
    {"no corners", "refined-chamfer-need", [](Told& t) { t.record.corners.clear(); }},
    {"a corner twice", "refined-chamfer-radius",
     [](Told& t) { t.record.corners.push_back(t.record.corners.front()); }},
    {"a corner that is not acute", "refined-chamfer-need",
     [](Told& t) {
       t.record.corners.push_back({0, 0x1p-4});
     }},
    {"a corner that is no vertex of the input", "refined-chamfer-radius",
     [](Told& t) {
       t.record.corners.push_back({static_cast<Index>(t.graph.vertices.size()), 0x1p-4});
     }},
    {"a dropped segment that is not called so", "refined-drops",
     [](Told& t) { t.record.dropped.clear(); }},
    {"a segment called dropped that is there", "refined-drops",
     [](Told& t) { t.record.dropped.push_back(0); }},
    {"a segment dropped twice", "refined-drops",
     [](Told& t) { t.record.dropped.push_back(t.record.dropped.front()); }},
    {"a dropped segment that is none", "refined-drops",
     [](Told& t) { t.record.dropped.push_back(77); }},
};

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
    {"a triangle of no points", "sidecar",
     [](Told& t) { t.record.final.front().vertices[0] = 0xfffffff0U; }},
};

const Lie kForeign[] = {
    {"file of another run", "same-mesh",
     [](Told& t) {
       Options options = honest_options();
       options.max_edge = 0.5;
       t.file = run_of(options).file;
     }},
    {"the same, every written vertex point 0", "rounding",
     [](Told& t) {
       Options options = honest_options();
       options.max_edge = 0.5;
       t.file = run_of(options).file;
       t.record.mesh_vertices.assign(t.file.vertices.size(), 0);
     }},
    {"file of another run, its vertices right", "same-mesh",
     [](Told& t) {
       Options options = honest_options();
       options.max_edge = 0.5;
       const Told other = run_of(options);
       t.file = other.file;
       t.record.points = other.record.points;
       t.record.mesh_vertices = other.record.mesh_vertices;
     }},
    {"record of another input", "sidecar",
     [](Told& t) {
       PlanarGraph graph = honest_graph();
       graph.vertices[3] = {2.25, 1.125};
       t.record = run_of(honest_options(), graph).record;
     }},
    {"two written vertices exchanged in the record", "rounding",
     [](Told& t) { std::swap(t.record.mesh_vertices[0], t.record.mesh_vertices[5]); }},
    {"a written vertex 6 ulp off", "rounding",
     [](Told& t) { t.file.vertices[steiner(t)][0] += 6 * 0x1p-50; }},  // of the largest, 4.5
    {"an input vertex an ulp off", "rounding", [](Told& t) { t.file.vertices[0][0] = 0x1p-60; }},
    {"a written vertex that is infinite", "complex",
     [](Told& t) { t.file.vertices[steiner(t)][0] = HUGE_VAL; }},
    {"an input vertex that is infinite", "complex",
     [](Told& t) { t.file.vertices[0][0] = HUGE_VAL; }},
    {"a triangle of the file twice, another missing", "same-mesh",
     [](Told& t) { t.file.triangles[1] = t.file.triangles[0]; }},
    {"the corners of two triangles of the file exchanged", "same-mesh",
     [](Told& t) { std::swap(t.file.triangles[0][0], t.file.triangles[7][1]); }},
    {"a triangle of the file missing", "same-mesh",
     [](Told& t) {
       t.file.triangles.pop_back();
       t.file.inside.pop_back();
     }},
    {"a triangle of the file turned over", "orientation",
     [](Told& t) { std::swap(t.file.triangles[0][0], t.file.triangles[0][1]); }},
    {"a triangle of the file with a corner twice", "complex",
     [](Told& t) { t.file.triangles[0][0] = t.file.triangles[0][1]; }},
    {"a triangle of the file of no vertices", "complex",
     [](Told& t) { t.file.triangles[0][0] = 0xfffffff0U; }},
    {"a triangle of the file called outside", "same-mesh", [](Told& t) { t.file.inside[0] = 0; }},
    {"a listed edge with another marker", "same-mesh", [](Told& t) { t.file.markers[2] = 77; }},
    {"a listed edge fewer", "same-mesh",
     [](Told& t) {
       t.file.edges.pop_back();
       t.file.markers.pop_back();
       t.file.segments.pop_back();
     }},
    {"a listed edge twice", "edge-list",
     [](Told& t) {
       t.file.edges.push_back(t.file.edges.front());
       t.file.markers.push_back(t.file.markers.front());
       t.file.segments.push_back(t.file.segments.front());
     }},
};

// Mesh and record agree in all of these.
const Lie kConsistent[] = {
    {"a run with delta 5", "refined-angles",
     [](Told& t) { claim_for(t, [](Options& o) { o.delta = 5; }); }},
    {"a run with corners below 90 degrees chamfered", "refined-chamfer-need",
     [](Told& t) { claim_for(t, [](Options& o) { o.acute = 90; }); }},
    {"a run with chamfers wider than promised", "refined-chamfer-radius",
     [](Told& t) { t.how.promised.chamfer_radius = 0x1p-8; }},
    {"a run with edges longer than promised", "refined-edges",
     [](Told& t) { t.how.promised.max_edge = 0x1p-4; }},
    {"a run that drops more than tau allows", "refined-drops",
     [](Told& t) { t.how.promised.tau = 1e-4; }},
    {"a run of the other region", "same-mesh",
     [](Told& t) { t.how.promised.region = delmesher::Region::hull; }},
    {"a run that stopped before the last step", "promise",
     [](Told& t) { claim_for(t, [](Options& o) { o.approximate = true; }); }},
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
    {"the same, by the file", "conformity",
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
    {"the same, by the file", "sides",
     [](Told& t) {
       t.graph.holes = {{0.515625, 0.53125}};
     }},
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

class PlaneLies : public testing::TestWithParam<Lie> {};

TEST_P(PlaneLies, AreCaughtByTheOracleMeantForThem) {
  Told told = honest();
  const auto verdict = [](const Told& t) {
    oracles::VerifyReport report;
    EXPECT_EQ(verify_plane(t.graph, t.file, &t.record, t.how, report), "");
    return report;
  };
  static const oracles::VerifyReport good = verdict(told);
  ASSERT_TRUE(good.all_passed()) << to_text(good);
  GetParam().tell(told);
  judge("square with a dent", GetParam().name, GetParam().oracle, verdict(told));
}

std::string lie_name(const testing::TestParamInfo<Lie>& tested) {
  std::string name = tested.param.name;
  for (char& c : name) {
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  }
  return name + "_" + std::to_string(tested.index);
}

INSTANTIATE_TEST_SUITE_P(Relaxed, PlaneLies, testing::ValuesIn(kRelaxed), lie_name);
INSTANTIATE_TEST_SUITE_P(Sections, PlaneLies, testing::ValuesIn(kSections), lie_name);
INSTANTIATE_TEST_SUITE_P(Foreign, PlaneLies, testing::ValuesIn(kForeign), lie_name);
INSTANTIATE_TEST_SUITE_P(Consistent, PlaneLies, testing::ValuesIn(kConsistent), lie_name);

// Without corners and drops the lies would be empty.
TEST(PlaneLies, AreToldOfARunThatChamfersAndDrops) {
  EXPECT_GE(honest().record.corners.size(), 2U);
  EXPECT_EQ(honest().record.dropped.size(), 1U);
}

oracles::VerifyReport verdict_on(const Told& told, bool with_record = true) {
  oracles::VerifyReport report;
  EXPECT_EQ(
      verify_plane(told.graph, told.file, with_record ? &told.record : nullptr, told.how, report),
      "");
  return report;
}

TEST(PlaneTruths, DeviationIsToldInUnitsOfTheLargestCoordinate) {
  Told told = honest();
  told.file.vertices[steiner(told)][0] += 3 * 0x1p-50;  // of the largest, 4.5
  for (const bool with_record : {false, true}) {
    const oracles::VerifyReport report = verdict_on(told, with_record);
    EXPECT_GT(report.deviation, 0x1p-50);
    EXPECT_DOUBLE_EQ(report.deviation_ulps, report.deviation / 0x1p-50);
  }
}

bool says(const oracles::VerifyReport& report, const char* oracle, const std::string& words) {
  const oracles::OracleReport* found = report.find(oracle);
  return found != nullptr && std::ranges::any_of(found->findings, [&](const std::string& finding) {
           return finding.find(words) != std::string::npos;
         });
}

TEST(PlaneTruths, AnglesOfATriangleFarFromTheOrigin) {
  Told told;
  told.graph.vertices = {{10, 20}, {14, 20}, {10, 23}};
  told.graph.segments = {{0, 1}, {1, 2}, {2, 0}};
  told.file.vertices = told.graph.vertices;
  for (const std::array<Index, 3>& corners :
       {std::array<Index, 3>{0, 1, 2}, {1, 2, 0}, {2, 0, 1}}) {
    told.file.triangles = {corners};
    const oracles::VerifyReport report = verdict_on(told, false);
    const oracles::OracleReport* angles = report.find("angles");
    ASSERT_NE(angles, nullptr) << to_text(report);
    EXPECT_NEAR(angles->figures.at(0).second, std::atan2(3, 4) * 57.29577951308232, 1e-9);
    EXPECT_NEAR(angles->figures.at(1).second, 90, 1e-9);
  }
}

// An angle that cannot be promised is not demanded, and the report says so.
TEST(PlaneTruths, AnAngleThatWasNotReachedIsTold) {
  Told told = honest();
  told.how.promised.delta = 30;
  const oracles::VerifyReport report = verdict_on(told);
  const oracles::OracleReport* promise = report.find("promise");
  ASSERT_NE(promise, nullptr);
  EXPECT_TRUE(promise->passed()) << to_text(report);
  EXPECT_TRUE(std::ranges::any_of(promise->figures, [&](const auto& figure) {
    return figure.first == "delta reached" && figure.second == told.record.delta;
  }));
}

TEST(PlaneLies, NameAVertexOfTheInputThatNothingReaches) {
  Told told = honest();
  told.graph.vertices.push_back({3, 1});
  const oracles::VerifyReport report = verdict_on(told, false);
  ASSERT_NE(report.find("conformity"), nullptr);
  EXPECT_FALSE(report.find("conformity")->passed()) << to_text(report);
}

TEST(PlaneLies, NamePointsThatTheInputHasAndTheRecordHasNot) {
  for (const std::size_t missing : {1U, 2U}) {
    Told told = honest();
    told.record.points.resize(told.graph.vertices.size() - missing);
    EXPECT_TRUE(says(verdict_on(told), "sidecar", "fewer points than input vertices"));
  }
}

// The tip of a slender triangle whose neighbours are all far away, but for the inside of a segment.
TEST(PlaneLies, AboutARadiusThatReachesToASegment) {
  PlanarGraph graph;
  graph.vertices = {{0, 0}, {8, -1}, {8, 1}, {-0.5, -9}, {-0.5, 9}};
  graph.segments = {{0, 1}, {1, 2}, {2, 0}, {3, 4}};
  Told told = run_of(honest_options(), graph);
  const oracles::VerifyReport good = verdict_on(told);
  ASSERT_TRUE(good.all_passed()) << to_text(good);
  const auto tip = std::ranges::find(told.record.corners, 0U, &PlaneRecord::Corner::vertex);
  ASSERT_NE(tip, told.record.corners.end());
  tip->radius = 0.2;  // 0.5 / 3 is what the segment leaves
  EXPECT_TRUE(says(verdict_on(told), "refined-chamfer-radius", "corner 0 is cut beyond a third"));
}

// A vertex lies on a segment; two edges of the refined mesh that end there are told as one.
TEST(PlaneLies, AboutAnEdgeOverAVertex) {
  PlanarGraph graph;
  graph.vertices = {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {2, 0}};
  graph.segments = {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
  Told told = run_of(honest_options(), graph);
  const oracles::VerifyReport good = verdict_on(told);
  ASSERT_TRUE(good.all_passed()) << to_text(good);
  std::vector<Index> beside;  // on the segment, next to the vertex
  auto& edges = told.record.refined_edges;
  for (const auto& e : edges) {
    for (const std::size_t k : {0U, 1U}) {
      if (e.segment == 0 && e.vertices[k] == 4) beside.push_back(e.vertices[1 - k]);
    }
  }
  ASSERT_EQ(beside.size(), 2U);
  std::erase_if(edges, [](const auto& e) {
    return e.segment == 0 && (e.vertices[0] == 4 || e.vertices[1] == 4);
  });
  edges.push_back({{beside[0], beside[1]}, 0});
  EXPECT_TRUE(says(verdict_on(told), "refined-segments", "has an edge over a vertex"));
}

// A vertex index that is too large by one.
TEST(PlaneLies, NamesTheTriangleThatRefersToNoVertex) {
  Told told = honest();
  told.file.triangles[2][1] = static_cast<Index>(told.file.vertices.size());
  const oracles::VerifyReport report = verdict_on(told, false);
  const oracles::OracleReport* complex = report.find("complex");
  ASSERT_NE(complex, nullptr);
  EXPECT_NE(std::find(complex->findings.begin(), complex->findings.end(),
                      "triangle 2 refers to no vertex"),
            complex->findings.end());
}

// The area of a single ring is known from the input alone.
TEST(PlaneLies, AboutTheInsideOfASingleRingShowInItsArea) {
  PlanarGraph arrow;
  arrow.vertices = {{0, 0}, {4, 0}, {1, 1}, {0, 4}};
  arrow.segments = {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
  Told told = run_of(honest_options(), arrow);
  const oracles::VerifyReport good = verdict_on(told);
  ASSERT_TRUE(good.all_passed()) << to_text(good);
  ASSERT_NE(good.find("exact-area"), nullptr);
  EXPECT_EQ(good.find("exact-area")->checked, told.record.final.size());
  some(told.record.final, Side::inside).side = Side::outside;
  const oracles::VerifyReport bad = verdict_on(told);
  ASSERT_NE(bad.find("exact-area"), nullptr);
  EXPECT_EQ(bad.find("exact-area")->violations, 1U);
}

}  // namespace
}  // namespace tetproof
