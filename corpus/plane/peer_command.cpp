// Ours through the public header, and foreign programs through files in Triangle's format.
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <stdexcept>

#include "corpus/plane/bench.h"
#include "mesher/io/write_plane.h"
#include "oracles/plane/verify.h"

namespace tetproof::plane_bench {
namespace {

namespace fs = std::filesystem;

std::string with(std::string command, const std::string& file) {
  const std::size_t at = command.find("{in}");
  if (at == std::string::npos) throw std::invalid_argument("no {in} in the command");
  return command.replace(at, 4, file);
}

// Triangle's .node and .ele; the numbers begin at 0 or 1.
void read_result(const std::string& stem, Measurement& m) {
  std::ifstream node(stem + ".1.node"), ele(stem + ".1.ele");
  std::size_t n = 0, corners = 0, skip = 0, attributes = 0;
  std::string rest;
  node >> n >> skip >> attributes;
  std::getline(node, rest);
  std::vector<std::array<double, 2>> vertices(n);
  std::size_t base = 0;
  for (std::size_t i = 0; i < n; ++i) {
    std::size_t number = 0;
    node >> number >> vertices[i][0] >> vertices[i][1];
    if (i == 0) base = number;
    node.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
  }
  std::size_t count = 0;
  ele >> count >> corners >> attributes;
  std::vector<std::array<std::uint32_t, 3>> triangles(count);
  for (auto& triangle : triangles) {
    std::size_t number = 0;
    ele >> number;
    for (std::uint32_t& v : triangle) {
      std::size_t index = 0;
      ele >> index;
      v = static_cast<std::uint32_t>(index - base);
      if (index < base || v >= n) throw std::runtime_error("bad triangle in its result");
    }
    ele.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
  }
  if (!node || !ele || n == 0) throw std::runtime_error("no result");
  count_angles(vertices, triangles, m);
}

std::string ending(int status) {
  return WIFEXITED(status) ? "exit code " + std::to_string(WEXITSTATUS(status))
                           : "ended by a signal";
}

double seconds_of_children() {
  struct rusage usage = {};
  getrusage(RUSAGE_CHILDREN, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

// A run with its record, for the oracles.
void verify(const PlanarGraph& graph, delmesher::PlaneOptions options, Measurement& m) {
  options.want_exact = true;
  const delmesher::PlaneResult result = delmesher::triangulate_polygon(graph, options);
  if (result.mesh.triangles.size() != m.triangles ||
      result.statistics.final.mean_min_angle != m.mean_angle) {
    throw std::runtime_error("two runs differ");
  }
  const PlaneVerdict verdict = verify_plane(graph, options, result);
  if (!verdict.ok()) throw std::runtime_error(verdict.failures[0]);
  m.checks = verdict.checks;
}

}  // namespace

Mesher delmesher_plane(const delmesher::PlaneOptions& options, bool verified) {
  Mesher mesher;
  mesher.name = "delmesher plane";
  mesher.run = [options](const PlanarGraph& graph, Measurement& m) {
    const double start = thread_seconds();
    const delmesher::PlaneResult result = delmesher::triangulate_polygon(graph, options);
    m.seconds = thread_seconds() - start;
    if (!result.status.ok()) throw std::runtime_error(result.status.message);
    const auto& s = result.statistics;
    if (s.rounding_inverted > 0) throw std::runtime_error("inverted triangles");
    m.triangles = s.final.triangles;
    m.refined_angle = s.refined.min_angle;
    m.final_angle = s.final.min_angle;
    m.mean_angle = s.final.mean_min_angle;
    m.acute = s.acute_vertices;
    m.dropped = s.dropped_segments;
  };
  if (verified) {
    mesher.verify = [options](const PlanarGraph& graph, Measurement& m) {
      verify(graph, options, m);
    };
  }
  return mesher;
}

Mesher foreign_command(const std::string& command) {
  return {command.substr(0, command.find(' ')),
          [command](const PlanarGraph& graph, Measurement& m) {
            const fs::path folder =
                fs::temp_directory_path() / ("tetproof-plane-" + std::to_string(getpid()));
            fs::create_directories(folder);
            const std::string stem = (folder / "input").string();
            delmesher::io::OutputSet outputs;
            delmesher::io::WriteStatus status =
                delmesher::io::write_poly(outputs, stem + ".poly", with_hole_points(graph));
            if (status.ok()) status = outputs.commit();
            if (!status.ok()) throw std::runtime_error(status.error);
            const double before = seconds_of_children();
            const int code = std::system(with(command, stem + ".poly").c_str());
            m.seconds = seconds_of_children() - before;  // with its reading and writing
            std::exception_ptr failure;
            try {
              if (code != 0) throw std::runtime_error(ending(code));
              read_result(stem, m);
            } catch (...) {
              failure = std::current_exception();
            }
            fs::remove_all(folder);
            if (failure) std::rethrow_exception(failure);
            m.refined_angle = -1;
          }};
}

}  // namespace tetproof::plane_bench
