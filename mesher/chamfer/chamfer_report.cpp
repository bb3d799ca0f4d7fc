// Development tool, not installed: chamfers OFF files and prints one line of figures for each.
//   chamfer_report [--acute DEG] [--tau X] [--fraction X] [--no-simplify] [--segments OUT.obj]
//   FILE...
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <fstream>
#include <iostream>
#include <sstream>

#include "mesher/chamfer/chamfer.h"
#include "mesher/chamfer/filter.h"
#include "mesher/chamfer/plc_angles.h"

namespace {

using namespace delmesher;

bool read_off(const char* path, Surface& surface) {
  std::ifstream in(path);
  std::stringstream text;
  for (std::string line; std::getline(in, line);) text << line.substr(0, line.find('#')) << '\n';
  std::string magic;
  std::size_t vertices = 0, faces = 0, edges = 0;
  if (!(text >> magic >> vertices >> faces >> edges) || magic != "OFF") return false;
  surface.vertices.resize(vertices);
  for (auto& v : surface.vertices) text >> v[0] >> v[1] >> v[2];
  for (std::size_t f = 0; f < faces; ++f) {
    std::size_t n = 0;
    std::array<std::uint32_t, 3> t;
    if (!(text >> n >> t[0] >> t[1] >> t[2]) || n != 3) return false;
    surface.triangles.push_back(t);
    std::getline(text, magic);
  }
  return true;
}

double diagonal(const Surface& surface) {
  double low[3], high[3], sum = 0;
  for (int i = 0; i < 3; ++i) {
    low[i] = high[i] = surface.vertices[0][i];
    for (const auto& v : surface.vertices) {
      low[i] = std::min(low[i], v[i]);
      high[i] = std::max(high[i], v[i]);
    }
    sum += (high[i] - low[i]) * (high[i] - low[i]);
  }
  return std::sqrt(sum);
}

double seconds_since(std::clock_t start) {
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

void write_segments(const char* path, const Plc& plc, const PointStore& points) {
  std::ofstream out(path);
  out.precision(17);
  for (VertexId v = 0; v < points.size(); ++v) {
    const Vec3 p = points.nearest(v);
    out << "v " << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
  }
  for (const PlcSegment& s : plc.segments) {
    out << "l " << s.vertex[0] + 1 << ' ' << s.vertex[1] + 1 << '\n';
  }
}

}  // namespace

int main(int argc, char** argv) {
  ChamferOptions options;
  const char* segments = nullptr;
  double tau = 0, fraction = kChamferedFraction;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--acute") == 0) {
      options.cosine_squared = cosine_squared(std::atof(argv[++i]));
      continue;
    }
    if (std::strcmp(argv[i], "--tau") == 0) {
      tau = std::atof(argv[++i]);
      continue;
    }
    if (std::strcmp(argv[i], "--fraction") == 0) {
      fraction = std::atof(argv[++i]);
      continue;
    }
    if (std::strcmp(argv[i], "--no-simplify") == 0) {
      options.simplify_bridges = false;
      continue;
    }
    if (std::strcmp(argv[i], "--segments") == 0) {
      segments = argv[++i];
      continue;
    }
    Surface surface;
    if (!read_off(argv[i], surface)) {
      std::printf("%s: cannot read\n", argv[i]);
      continue;
    }
    try {
      PointStore points;
      Predicates predicates(points);
      Options control_options;
      Control control(control_options);
      const auto start = std::clock();
      const SurfaceTopology topology = build_topology(surface, points, predicates);
      const double topology_seconds = seconds_since(start);
      const auto chamfer_start = std::clock();
      FilterResult filter;
      const ChamferResult result =
          filter_and_chamfer(topology, points, predicates, options, tau * diagonal(surface),
                             control, filter, fraction);
      const double seconds = seconds_since(chamfer_start);
      plc_angles::Report angles;
      if (!getenv("FAST")) angles = plc_angles::measure(result.plc, points);
      std::printf(
          "%s dropped %llu rounds %llu  triangles %zu facets %zu acute %llu+%llu "
          "points %zu segments %zu topology %.3fs "
          "chamfer %.3fs ee %.6f ef %.6f dihedral %.6f if turned %.6f %s\n",
          argv[i], static_cast<unsigned long long>(filter.dropped_triangles),
          static_cast<unsigned long long>(filter.rounds), topology.triangles.size(),
          topology.facet_triangles.size(), static_cast<unsigned long long>(result.acute_vertices),
          static_cast<unsigned long long>(result.acute_edges),
          points.size() - surface.vertices.size(), result.plc.segments.size(), topology_seconds,
          seconds, angles.edge_edge.degrees, angles.edge_facet.degrees, angles.dihedral.degrees,
          angles.smallest_if_turned, angles.defect.c_str());
      if (segments != nullptr) write_segments(segments, result.plc, points);
    } catch (const std::exception& error) {
      std::printf("%s: %s\n", argv[i], error.what());
    } catch (const Stopped& stopped) {
      std::printf("%s: %s\n", argv[i], stopped.status.message.c_str());
    }
    std::fflush(stdout);
  }
}
