#include <gmpxx.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "fuzz/properties.h"
#include "mesher/io/read_plane.h"
#include "mesher/io/write_plane.h"
#include "oracles/plane/verify.h"
#include "property_tests/leniency.h"

namespace tetproof::fuzz {
namespace {

using delmesher::Insideness;
using delmesher::PlanarGraph;
using delmesher::PlaneOptions;
using delmesher::PlaneResult;
using delmesher::StatusCode;
using Point = std::array<double, 2>;

// A run that reaches this limit is not a finding.
constexpr std::uint64_t kMostVertices = 3000;

Leniency too_many_vertices("stopped-at-3000-vertices", 0.05);
Leniency too_precise("stopped-features-below-2^-40", 0.1);
Leniency nothing_to_mesh("refused-encloses-nothing", 0.3);
Leniency no_numbers("refused-out-of-range", 0.1);
Leniency invalid_graph("refused-segments-conflict", 0.5);
Leniency reader_refused("refused-in-one-line", 0.999);

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

// Leaves out the elements that would make the graph invalid.
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

// Adds copies of the first ring, each half as large as the one before, about the mean of its
// vertices: inside each other if it is convex.
void nest_rings(PlanarGraph& graph, std::uint32_t ring, std::uint32_t copies) {
  for (std::uint32_t c = 0; c < copies; ++c) {
    const auto first = static_cast<std::uint32_t>(graph.vertices.size());
    Point middle{};
    for (std::uint32_t v = 0; v < ring; ++v) {
      for (std::size_t k = 0; k < 2; ++k) middle[k] += graph.vertices[v][k] / ring;
    }
    const double size = std::ldexp(1.0, -static_cast<int>(c) - 1);
    for (std::uint32_t v = 0; v < ring; ++v) {
      Point p = graph.vertices[v];
      for (std::size_t k = 0; k < 2; ++k) p[k] = middle[k] * (1 - size) + p[k] * size;
      graph.vertices.push_back({p[0] + 0.0, p[1] + 0.0});
      graph.segments.push_back({first + v, first + (v + 1) % ring});
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
  // A ring, others within it, and chords as long as there are bytes.
  const std::uint32_t ring = 3 + bytes.below(vertices - 2);
  for (std::uint32_t v = 0; v < ring; ++v) graph.segments.push_back({v, (v + 1) % ring});
  if ((flags & 8) != 0) nest_rings(graph, ring, 1 + bytes.below(3));
  if ((flags & 2) != 0) graph.holes.push_back({bytes.coordinate(), bytes.coordinate()});
  if ((flags & 4) != 0) graph.regions.push_back({{bytes.coordinate(), bytes.coordinate()}, 7});
  while (!bytes.empty() && graph.segments.size() < 60) {
    const std::uint32_t a = bytes.below(vertices), b = bytes.below(vertices);
    if (a != b) graph.segments.push_back({a, b});
  }
  if ((flags & 0x70) != 0) make_valid(graph);
  return graph;
}

PlaneOptions options_for(Bytes& bytes) {
  const std::uint32_t flags = bytes.byte();
  PlaneOptions options;
  options.want_exact = true;
  options.max_vertices = kMostVertices;
  options.acute = (flags & 1) != 0 ? 60 : 90;
  options.approximate = (flags & 14) == 0;
  options.tau = (flags & 16) != 0 ? 1e-2 : 0.1;  // narrow channels take many points
  options.region = (flags & 96) == 0 ? delmesher::Region::hull : delmesher::Region::interior;
  options.delta = (flags & 128) != 0 ? 20.7 : 27;
  options.as_paper.steiner_point = (flags & 0x90) == 0x90;
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

double largest_coordinate(const PlanarGraph& graph) {
  double largest = 0;
  for (const Point& p : graph.vertices) largest = std::max({largest, p[0], -p[0], p[1], -p[1]});
  return largest;
}

mpq_class squared_distance(const Point& p, const Point& a, const Point& b) {
  const mpq_class ux = mpq_class(b[0]) - a[0], uy = mpq_class(b[1]) - a[1],
                  wx = mpq_class(p[0]) - a[0], wy = mpq_class(p[1]) - a[1];
  const mpq_class all = ux * ux + uy * uy;
  mpq_class along = all == 0 ? mpq_class(0) : mpq_class((ux * wx + uy * wy) / all);
  if (along < 0) along = 0;
  if (along > 1) along = 1;
  const mpq_class dx = wx - along * ux, dy = wy - along * uy;
  return dx * dx + dy * dy;
}

// Do all vertices and segments that do not meet keep this distance, as a share of the largest
// coordinate? Decided in rationals, over all pairs. The graph must be valid.
bool features_above(const PlanarGraph& graph, double share) {
  const mpq_class least = mpq_class(share) * mpq_class(largest_coordinate(graph));
  const mpq_class squared = least * least;
  const auto near = [&](const Point& p, const Point& a, const Point& b) {
    const mpq_class d = squared_distance(p, a, b);
    return d != 0 && d < squared;
  };
  for (const Point& p : graph.vertices) {
    for (const Point& q : graph.vertices) {
      if (p != q && near(p, q, q)) return false;
    }
    for (const auto& [a, b] : graph.segments) {
      if (near(p, graph.vertices[a], graph.vertices[b])) return false;
    }
  }
  return true;
}

// The graph was refused although no two segments conflict: for one of the remaining reasons?
bool other_reason(const PlanarGraph& graph, const std::string& message) {
  if (message == "no segments" || message == "the segments enclose nothing") {
    nothing_to_mesh.take();
    return true;
  }
  if ((message.find("no room for a mesh") != std::string::npos && extent(graph) < 0x1p-1044) ||
      (message.find("orders of magnitude") != std::string::npos &&
       largest_coordinate(graph) > 0x1p200) ||
      (message.find("largest double") != std::string::npos &&
       largest_coordinate(graph) > 0x1p1022)) {
    no_numbers.take();
    return true;
  }
  return false;
}

// Limits are not findings: the limit on vertices, and that of precision where there is no room.
Finding at_limit(const PlanarGraph& graph, const delmesher::Status& status) {
  switch (status.limit) {
    case delmesher::Limit::size:
      too_many_vertices.take();
      return {};
    case delmesher::Limit::precision:
      if (features_above(graph, 0x1p-40)) break;
      too_precise.take();
      return {};
    default:
      break;
  }
  return "plane limit: " + status.message;
}

Finding judged(const PlanarGraph& graph, const PlaneOptions& options) {
  const PlaneResult result = delmesher::triangulate_polygon(graph, options);
  const bool refused = result.status.code == StatusCode::invalid_surface;
  if (!is_valid(graph)) {
    if (!refused) return "plane check: an invalid graph passes: " + result.status.message;
    invalid_graph.take();
    return {};
  }
  if (refused && other_reason(graph, result.status.message)) return {};
  if (result.status.code == StatusCode::limit_reached) return at_limit(graph, result.status);
  if (!result.status.ok()) return "plane status: " + result.status.message;
  if (result.statistics.rounding_inverted + result.statistics.rounding_flat > 0) {
    return "plane rounding: inverted or flat triangles left";
  }
  const PlaneVerdict verdict = verify_plane(graph, options, result);
  if (!verdict.failures.empty()) return "plane " + verdict.failures[0];
  return {};
}

// Prints, for people, the command line that does the same, and its input.
void print(const PlanarGraph& graph, const PlaneOptions& options) {
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
  judging({&too_many_vertices, &too_precise, &nothing_to_mesh, &no_numbers, &invalid_graph});
  // Most graphs have one scale, so that they are meshed: others are rejected, or stop among
  // thousands of vertices between one size and the other. And most have room between near features.
  const std::uint32_t scale = bytes.below(16);
  if (scale != 15) bytes.narrow(6);
  if (scale < 14) bytes.spread();
  const PlaneOptions options = options_for(bytes);
  const PlanarGraph graph = read_graph(bytes);
  const Finding finding = judged(graph, options);
  if (!finding.empty()) print(graph, options);
  return finding;
}

Finding plane_reader_holds(const std::string& text, const std::string& name) {
  judging({&reader_refused});
  const auto first = delmesher::io::parse_plane(text, name);
  if (!first.ok()) {
    reader_refused.take();
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
