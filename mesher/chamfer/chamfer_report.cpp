// Development tool, not installed: chamfers OFF files and prints one line of figures for each.
//   chamfer_report [--acute DEG] [--tau X] [--no-simplify] [--segments OUT.obj] FILE...
#include <chrono>
#include <cstdio>
#include <cstring>
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

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
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
  double tau = 0;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--acute") == 0) {
      options.cosine_squared = cosine_squared(std::atof(argv[++i]));
      continue;
    }
    if (std::strcmp(argv[i], "--tau") == 0) {
      tau = std::atof(argv[++i]);
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
      const auto start = std::chrono::steady_clock::now();
      const SurfaceTopology topology = build_topology(surface, points, predicates);
      const double topology_seconds = seconds_since(start);
      const auto filter_start = std::chrono::steady_clock::now();
      const FilterResult filter = filter_input(topology, points, tau * diagonal(surface), control);
      options.facet_kept = filter.facet_kept;
      const double filter_seconds = seconds_since(filter_start);
      const auto chamfer_start = std::chrono::steady_clock::now();
      const ChamferResult result = chamfer(topology, points, predicates, options, control);
      const double seconds = seconds_since(chamfer_start);
      plc_angles::Report angles;
      if (!getenv("FAST")) angles = plc_angles::measure(result.plc, points);
      std::printf(
          "%s dropped %llu rounds %llu filter %.3fs triangles %zu facets %zu acute %llu+%llu "
          "points %zu segments %zu topology %.3fs "
          "chamfer %.3fs ee %.6f ef %.6f dihedral %.6f shortest %.2e %s\n",
          argv[i], static_cast<unsigned long long>(filter.dropped_triangles),
          static_cast<unsigned long long>(filter.rounds), filter_seconds, topology.triangles.size(),
          topology.facet_triangles.size(), static_cast<unsigned long long>(result.acute_vertices),
          static_cast<unsigned long long>(result.acute_edges),
          points.size() - surface.vertices.size(), result.plc.segments.size(), topology_seconds,
          seconds, angles.edge_edge.degrees, angles.edge_facet.degrees, angles.dihedral.degrees,
          angles.smallest_segment, angles.defect.c_str());
      if (segments != nullptr) write_segments(segments, result.plc, points);
    } catch (const std::exception& error) {
      std::printf("%s: %s\n", argv[i], error.what());
    } catch (const Stopped& stopped) {
      std::printf("%s: %s\n", argv[i], stopped.status.message.c_str());
    }
    std::fflush(stdout);
  }
}
