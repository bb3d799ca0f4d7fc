// What the parts of tetproof-plane share.
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

// "koch:4", "star:12", ...; throws std::invalid_argument.
Input family(const std::string& what);
const std::vector<std::string>& family_names();
Input file(const std::string& path);

// One mesher on one input. Plain data: it crosses a pipe.
struct Measurement {
  bool ok = false;
  char reason[160] = {};
  std::uint64_t triangles = 0;
  double refined_angle = 0;  // smallest, before the exact end; negative: not told apart
  double final_angle = 0;    // smallest
  double mean_angle = 0;     // of the smallest per triangle
  double seconds = 0;        // processor time
  double peak_megabytes = 0;
  std::uint64_t acute = 0, dropped = 0;
  std::uint64_t checks = 0;  // signs that the oracles decided
};

struct Mesher {
  std::string name;
  // Fills in all but the memory; the time is that of meshing alone, without reading, writing and
  // counting. Throws to fail.
  std::function<void(const PlanarGraph&, Measurement&)> run;
  // After the time was taken, if wanted; throws to fail.
  std::function<void(const PlanarGraph&, Measurement&)> verify = nullptr;
};

// `verified`: a second run has to pass the oracles, after the time was taken.
Mesher delmesher_plane(const delmesher::Options& options, bool verified);
Mesher cgal_mesh_2();
// The graph as Triangle wants it: with a point in each hole.
PlanarGraph with_hole_points(const PlanarGraph& graph);
// `command` with {in} for a .poly file.
Mesher foreign_command(const std::string& command);

struct Limits {
  double seconds = 300;     // of processor time
  double megabytes = 4000;  // of address space
};

// In a child process, which the limits end.
Measurement measure(const Mesher& mesher, const PlanarGraph& graph, const Limits& limits);

// Smallest and mean smallest angle.
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

// The paper's figure 2 on the family `figure`, or on a file: five pictures as one SVG, and its
// numbers as a table. Throws std::runtime_error.
void write_figure(const Input& input, const delmesher::Options& options, const std::string& folder);

}  // namespace tetproof::plane_bench
