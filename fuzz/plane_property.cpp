#include <gmpxx.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "fuzz/properties.h"
#include "mesher/io/read_plane.h"
#include "mesher/io/write_plane.h"
#include "oracles/plane_verify.h"

namespace tetproof::fuzz {
namespace {

using delmesher::Insideness;
using delmesher::Options;
using delmesher::PlanarGraph;
using delmesher::PlaneResult;
using delmesher::StatusCode;
using Point = std::array<double, 2>;

// A run that reaches it has said nothing wrong.
constexpr std::uint64_t kMostVertices = 3000;

int orient(const Point& a, const Point& b, const Point& c) {
  const mpq_class ax = a[0], ay = a[1];
  return sgn((b[0] - ax) * (c[1] - ay) - (b[1] - ay) * (c[0] - ax));
}

// Do two segments cross, or overlap without being the same? (Vertices on segments are fine.)
bool conflict(const PlanarGraph& graph, std::size_t i, std::size_t j) {
  const auto& [a, b] = graph.segments[i];
  const auto& [c, d] = graph.segments[j];
  if (std::minmax(a, b) == std::minmax(c, d)) return false;
  const Point &p = graph.vertices[a], &q = graph.vertices[b], &r = graph.vertices[c],
              &s = graph.vertices[d];
  const int pqr = orient(p, q, r), pqs = orient(p, q, s);
  if (pqr == 0 && pqs == 0) {
    return std::max(std::min(p, q), std::min(r, s)) < std::min(std::max(p, q), std::max(r, s));
  }
  return pqr * pqs < 0 && orient(r, s, p) * orient(r, s, q) < 0;
}

bool is_valid(const PlanarGraph& graph) {
  std::vector<Point> sorted = graph.vertices;
  std::sort(sorted.begin(), sorted.end());
  if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) return false;
  for (std::size_t i = 0; i < graph.segments.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (conflict(graph, i, j)) return false;
    }
  }
  return true;
}

// Leaves out what would make the graph invalid.
void make_valid(PlanarGraph& graph) {
  std::vector<Point> distinct;
  std::vector<std::uint32_t> number;
  for (const Point& p : graph.vertices) {
    const auto found = std::find(distinct.begin(), distinct.end(), p);
    number.push_back(static_cast<std::uint32_t>(found - distinct.begin()));
    if (found == distinct.end()) distinct.push_back(p);
  }
  graph.vertices = std::move(distinct);
  auto wanted = std::move(graph.segments);
  graph.segments.clear();
  for (const auto& [a, b] : wanted) {
    if (number[a] == number[b]) continue;
    graph.segments.push_back({number[a], number[b]});
    const std::size_t last = graph.segments.size() - 1;
    for (std::size_t i = 0; i < last; ++i) {
      if (conflict(graph, i, last)) {
        graph.segments.pop_back();
        break;
      }
    }
  }
}

PlanarGraph read_graph(Bytes& bytes) {
  PlanarGraph graph;
  const std::uint32_t flags = bytes.byte();
  graph.insideness = (flags & 1) != 0 ? Insideness::nested : Insideness::enclosed;
  const std::uint32_t vertices = 3 + bytes.below(20);
  for (std::uint32_t v = 0; v < vertices; ++v) {
    const double x = bytes.coordinate(), y = bytes.coordinate();
    graph.vertices.push_back({x + 0.0, y + 0.0});
  }
  // A ring, and chords as long as there are bytes.
  const std::uint32_t ring = 3 + bytes.below(vertices - 2);
  for (std::uint32_t v = 0; v < ring; ++v) graph.segments.push_back({v, (v + 1) % ring});
  if ((flags & 2) != 0) graph.holes.push_back({bytes.coordinate(), bytes.coordinate()});
  if ((flags & 4) != 0) graph.regions.push_back({{bytes.coordinate(), bytes.coordinate()}, 7});
  while (!bytes.empty() && graph.segments.size() < 60) {
    const std::uint32_t a = bytes.below(vertices), b = bytes.below(vertices);
    if (a != b) graph.segments.push_back({a, b});
  }
  if ((flags & 0x70) != 0) make_valid(graph);
  return graph;
}

Options options_for(Bytes& bytes) {
  const std::uint32_t flags = bytes.byte();
  Options options = delmesher::plane_options();
  options.want_exact = true;
  options.max_vertices = kMostVertices;
  options.acute = (flags & 1) != 0 ? 60 : 90;
  options.approximate = (flags & 14) == 0;
  options.tau = (flags & 16) != 0 ? 1e-2 : 0.1;  // narrow channels take many points
  options.region = (flags & 96) == 0 ? delmesher::Region::hull : delmesher::Region::interior;
  options.delta = (flags & 128) != 0 ? 20.7 : 27;
  return options;
}

double extent(const PlanarGraph& graph) {
  double result = 0;
  for (const Point& p : graph.vertices) {
    for (const Point& q : graph.vertices) {
      result = std::max({result, p[0] - q[0], p[1] - q[1]});
    }
  }
  return result;
}

// Refused although no two segments conflict: the reasons that are left.
bool other_reason(const PlanarGraph& graph, const std::string& message) {
  double largest = 0;
  for (const Point& p : graph.vertices) largest = std::max({largest, p[0], -p[0], p[1], -p[1]});
  return message == "no segments" || message == "the segments enclose nothing" ||
         (message.find("no room for a mesh") != std::string::npos && extent(graph) < 0x1p-1044) ||
         (message.find("orders of magnitude") != std::string::npos && largest > 0x1p200);
}

Finding judged(const PlanarGraph& graph, const Options& options) {
  const PlaneResult result = delmesher::triangulate_polygon(graph, options);
  if (result.status.code == StatusCode::limit_reached) return {};
  if (!is_valid(graph)) {
    return result.status.code == StatusCode::invalid_surface
               ? ""
               : "plane check: an invalid graph passes";
  }
  if (result.status.code == StatusCode::invalid_surface &&
      other_reason(graph, result.status.message)) {
    return {};
  }
  if (!result.status.ok()) return "plane status: " + result.status.message;
  const PlaneVerdict verdict = verify_plane(graph, options, result);
  return verdict.ok() ? "" : "plane " + verdict.failures[0];
}

// For people: the command line that does the same, and its input.
void print(const PlanarGraph& graph, const Options& options) {
  std::fprintf(stderr, "# delmesher plane --tau %g --delta %g --acute %g --region %s%s\n",
               options.tau, options.delta, options.acute,
               options.region == delmesher::Region::hull ? "hull" : "interior",
               options.approximate ? " --approximate" : "");
  if (graph.insideness == Insideness::nested) std::fprintf(stderr, "# but for parity\n");
  const auto list = [](const auto& points) {
    std::fprintf(stderr, "%zu\n", points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      std::fprintf(stderr, "%zu %.17g %.17g\n", i, points[i][0], points[i][1]);
    }
  };
  list(graph.vertices);
  std::fprintf(stderr, "%zu\n", graph.segments.size());
  for (std::size_t i = 0; i < graph.segments.size(); ++i) {
    std::fprintf(stderr, "%zu %u %u\n", i, graph.segments[i][0], graph.segments[i][1]);
  }
  list(graph.holes);
}

}  // namespace

Finding plane_holds(Bytes bytes) {
  const Options options = options_for(bytes);
  const PlanarGraph graph = read_graph(bytes);
  const Finding finding = judged(graph, options);
  if (!finding.empty()) print(graph, options);
  return finding;
}

Finding plane_reader_holds(const std::string& text, const std::string& name) {
  const auto first = delmesher::io::parse_plane(text, name);
  if (!first.ok()) {
    const bool one_line =
        !first.error.empty() && first.error.find_first_of("\r\n") == std::string::npos;
    return one_line ? "" : "reader error: not one line";
  }
  const PlanarGraph& g = first.graph;
  for (const auto& segment : g.segments) {
    for (const std::uint32_t v : segment) {
      if (v >= g.vertices.size()) return "reader index: out of range";
    }
  }
  if (!g.markers.empty() && g.markers.size() != g.segments.size()) return "reader markers: too few";
  if (!g.partitions.empty() && g.partitions.size() != g.segments.size()) {
    return "reader partitions: too few";
  }
  return {};
}

}  // namespace tetproof::fuzz
