// tetproof-cgal-mesh2 SWITCHES GRAPH OUT STATS.json: CGAL's 2D Delaunay mesher.
// SWITCHES: "-"; B = 1/8 is an angle of 20.7 degrees. "holes": does not mesh, but writes the graph
// to OUT.poly with a point in each hole, as Triangle wants it.
#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_mesh_face_base_2.h>
#include <CGAL/Delaunay_mesh_size_criteria_2.h>
#include <CGAL/Delaunay_mesh_vertex_base_2.h>
#include <CGAL/Delaunay_mesher_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/version.h>

#include <cstdio>
#include <cstring>
#include <exception>
#include <fstream>
#include <list>
#include <map>
#include <new>
#include <set>

#include "corpus/peers/programs/adapter.h"
#include "mesher/delmesher_files.h"
#include "mesher/io/write_plane.h"

namespace {

using delmesher::PlanarGraph;
using tetproof::adapter::Call;
using tetproof::adapter::finish;
using tetproof::adapter::Stopwatch;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Vertex = CGAL::Delaunay_mesh_vertex_base_2<Kernel>;
using Face = CGAL::Delaunay_mesh_face_base_2<Kernel>;
using Structure = CGAL::Triangulation_data_structure_2<Vertex, Face>;
// As in the examples of its manual: for segments that do not cross.
using Cdt = CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure>;
using Criteria = CGAL::Delaunay_mesh_size_criteria_2<Cdt>;
using Edge = std::pair<std::uint32_t, std::uint32_t>;

// A point in every bounded face of the graph that is outside.
std::list<Kernel::Point_2> seeds(const PlanarGraph& graph, Cdt& cdt,
                                 const std::map<Cdt::Vertex_handle, std::uint32_t>& number) {
  std::list<Kernel::Point_2> result;
  if (graph.insideness == delmesher::Insideness::enclosed) {
    for (const auto& [x, y] : graph.holes) result.emplace_back(x, y);
    return result;
  }
  std::map<Edge, bool> separates;
  for (std::size_t i = 0; i < graph.segments.size(); ++i) {
    const auto [a, b] = graph.segments[i];
    separates[std::minmax(a, b)] = graph.partitions.empty() || graph.partitions[i] == 0;
  }
  const auto wall = [&](Cdt::Face_handle face, int i) {
    if (!face->is_constrained(i)) return false;
    const auto a = number.find(face->vertex(Cdt::cw(i)));
    const auto b = number.find(face->vertex(Cdt::ccw(i)));
    if (a == number.end() || b == number.end()) return true;
    const auto found = separates.find(std::minmax(a->second, b->second));
    return found == separates.end() || found->second;
  };
  std::set<Cdt::Face_handle> seen;
  std::vector<Cdt::Face_handle> present = {cdt.infinite_face()}, deeper;
  for (int d = 0; !present.empty(); ++d) {
    for (const Cdt::Face_handle start : present) {
      if (!seen.insert(start).second) continue;
      // One face of the graph; its largest triangle stands for it.
      Cdt::Face_handle largest;
      double area = -1;
      std::vector<Cdt::Face_handle> stack = {start};
      while (!stack.empty()) {
        const Cdt::Face_handle face = stack.back();
        stack.pop_back();
        const double own = cdt.is_infinite(face) ? -1 : cdt.triangle(face).area();
        if (own > area) largest = face;
        area = std::max(area, own);
        for (int i = 0; i < 3; ++i) {
          const Cdt::Face_handle other = face->neighbor(i);
          if (wall(face, i)) {
            deeper.push_back(other);
          } else if (seen.insert(other).second) {
            stack.push_back(other);
          }
        }
      }
      if (d % 2 == 0 && d > 0 && area > 0) result.push_back(CGAL::centroid(cdt.triangle(largest)));
    }
    present.swap(deeper);
    deeper.clear();
  }
  return result;
}

void insert(const PlanarGraph& graph, Cdt& cdt) {
  std::vector<Kernel::Point_2> points;
  for (const auto& [x, y] : graph.vertices) points.emplace_back(x, y);
  // All at once: CGAL sorts them along a curve.
  std::vector<std::pair<std::size_t, std::size_t>> segments;
  for (const auto& [a, b] : graph.segments) segments.emplace_back(a, b);
  cdt.insert_constraints(points.begin(), points.end(), segments.begin(), segments.end());
}

std::map<Cdt::Vertex_handle, std::uint32_t> numbers(const PlanarGraph& graph, const Cdt& cdt) {
  std::map<Kernel::Point_2, std::uint32_t> place;
  for (std::uint32_t i = 0; i < graph.vertices.size(); ++i) {
    place[Kernel::Point_2(graph.vertices[i][0], graph.vertices[i][1])] = i;
  }
  std::map<Cdt::Vertex_handle, std::uint32_t> number;
  for (const Cdt::Vertex_handle v : cdt.finite_vertex_handles()) {
    const auto found = place.find(v->point());
    if (found != place.end()) number[v] = found->second;
  }
  return number;
}

// Adds to `meshing` the seconds without the search for holes, which other callers know.
delmesher::PlaneMesh mesh(const PlanarGraph& graph, double& meshing) {
  const Stopwatch inserting;
  Cdt cdt;
  insert(graph, cdt);
  meshing += inserting.seconds();
  const std::list<Kernel::Point_2> holes = seeds(graph, cdt, numbers(graph, cdt));
  const Stopwatch refining;
  CGAL::Delaunay_mesher_2<Cdt, Criteria> mesher(cdt, Criteria(0.125, 0));
  if (!holes.empty()) mesher.set_seeds(holes.begin(), holes.end(), false);
  mesher.refine_mesh();
  meshing += refining.seconds();
  delmesher::PlaneMesh result;
  std::map<Cdt::Vertex_handle, std::uint32_t> id;
  for (auto f = cdt.finite_faces_begin(); f != cdt.finite_faces_end(); ++f) {
    if (!f->is_in_domain()) continue;
    std::array<std::uint32_t, 3> triangle;
    for (int i = 0; i < 3; ++i) {
      const auto [found, is_new] =
          id.emplace(f->vertex(i), static_cast<std::uint32_t>(result.vertices.size()));
      if (is_new) result.vertices.push_back({f->vertex(i)->point().x(), f->vertex(i)->point().y()});
      triangle[static_cast<std::size_t>(i)] = found->second;
    }
    result.triangles.push_back(triangle);
  }
  result.inside.assign(result.triangles.size(), 1);
  return result;
}

PlanarGraph with_hole_points(const PlanarGraph& graph) {
  if (graph.insideness == delmesher::Insideness::enclosed) return graph;
  Cdt cdt;
  insert(graph, cdt);
  PlanarGraph result = graph;
  result.insideness = delmesher::Insideness::enclosed;
  result.partitions.clear();
  for (const Kernel::Point_2& p : seeds(graph, cdt, numbers(graph, cdt))) {
    result.holes.push_back({p.x(), p.y()});
  }
  return result;
}

void deliver(const Call& call, const PlanarGraph& graph, double reading) {
  delmesher::io::OutputSet outputs;
  delmesher::io::WriteStatus status;
  double meshing = 0;
  if (call.switches == "holes") {
    status = delmesher::io::write_poly(outputs, call.output, with_hole_points(graph));
  } else {
    status = delmesher::io::write_plane(outputs, call.output, mesh(graph, meshing));
  }
  if (status.ok()) status = outputs.commit();
  if (!status.ok()) finish(call, 3, call.output, status.error);
  std::ofstream(call.stats) << "{\"status\": \"ok\", \"phases_seconds\": {\"read\": " << reading
                            << ", \"triangulate\": " << meshing << "}}\n";
  finish(call, 0, call.input, "");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 2 && std::strcmp(argv[1], "--version") == 0) {
    std::printf("CGAL %s\n", CGAL_VERSION_STR);
    return 0;
  }
  const std::string switches = argc == 5 ? argv[1] : "";
  if (switches != "-" && switches != "holes") {
    std::fputs("usage: tetproof-cgal-mesh2 -|holes GRAPH OUT STATS.json\n", stderr);
    return 2;
  }
  const Call call = {"tetproof-cgal-mesh2", switches, argv[2], argv[3], argv[4]};
  const Stopwatch reading;
  const delmesher::io::PlaneReadResult input = delmesher::io::read_plane(call.input);
  if (!input.ok()) finish(call, 3, call.input, input.error);
  try {
    deliver(call, input.graph, reading.seconds());
  } catch (const std::bad_alloc&) {
    finish(call, 5, call.input, "out of memory");
  } catch (const std::exception& error) {
    finish(call, 4, call.input, std::string("CGAL: ") + error.what());
  }
}
