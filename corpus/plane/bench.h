// Declarations that the parts of tetproof-plane share.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "mesher/delmesher_plane.h"
#include "reports/thread_seconds.h"

namespace tetproof::plane_bench {

using delmesher::PlanarGraph;

struct Input {
  std::string name;
  PlanarGraph graph;
};

// A member of a family: "koch:4", "star:12", ... Throws std::invalid_argument.
Input family(const std::string& what);
Input file(const std::string& path);

// One mesher on one input. Plain data: it crosses a pipe.
struct Measurement {
  bool ok = false;
  char reason[160] = {};
  std::uint64_t triangles = 0;
  double refined_angle = 0;  // smallest, degrees, before the last step; negative: not known
  double final_angle = 0;    // smallest, degrees
  double mean_angle = 0;     // of the smallest per triangle, degrees
  double seconds = 0;        // processor time
  double peak_megabytes = 0;
  std::uint64_t acute = 0, dropped = 0;
  std::uint64_t checks = 0;  // signs that the oracles decided
};

struct Mesher {
  std::string name;
  // Fills in all but the memory. The time is that of meshing alone, without reading, writing and
  // counting (a foreign command's includes its reading and writing). Throws if the mesher fails.
  std::function<void(const PlanarGraph&, Measurement&)> run;
  // Called after the time was taken, if wanted. Throws if the check fails.
  std::function<void(const PlanarGraph&, Measurement&)> verify = nullptr;
};

// `verified`: a second run has to pass the oracles, after the time was taken.
Mesher delmesher_plane(const delmesher::PlaneOptions& options, bool verified);
Mesher cgal_mesh_2();
// The graph as Triangle wants it: with a point in each hole.
PlanarGraph with_hole_points(const PlanarGraph& graph);
// `command` with {in} for a .poly file.
Mesher foreign_command(const std::string& command);

struct Limits {
  double seconds = 300;     // of processor time
  double megabytes = 4000;  // of address space
};

// Runs the mesher in a child process, which is ended at the limits.
Measurement measure(const Mesher& mesher, const PlanarGraph& graph, const Limits& limits);

// Sets the smallest and the mean smallest angle.
void count_angles(const std::vector<std::array<double, 2>>& vertices,
                  const std::vector<std::array<std::uint32_t, 3>>& triangles, Measurement& m);

struct Row {
  std::string input;
  std::size_t vertices;
  std::string mesher;
  Measurement measurement;
};
// Markdown.
std::string table_head();
std::string table_row(const Row& row);
std::string summary(const std::vector<Row>& rows);

// The paper's figure 2 for an input: five pictures as one SVG, and its numbers as a table. Throws
// std::runtime_error.
void write_figure(const Input& input, const delmesher::PlaneOptions& options,
                  const std::string& folder);

}  // namespace tetproof::plane_bench
