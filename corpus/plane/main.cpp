// tetproof-plane: meshers of the plane side by side. README.md says how to use it.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "corpus/plane/bench.h"
#include "mesher/io/write_plane.h"
#include "oracles/plane/shapes.h"

namespace {

using namespace tetproof::plane_bench;

struct Arguments {
  std::vector<std::string> files, families, write;
  std::string command, growth;
  int tiny = 0, repeat = 1;
  Limits limits;
  double delta = 20.7;
  std::string figure;
  bool summary = false, alone = false, verify = false;
};

int write_family(const Arguments& arguments) {
  delmesher::io::OutputSet outputs;
  delmesher::io::WriteStatus status =
      delmesher::io::write_poly(outputs, arguments.write[1], family(arguments.write[0]).graph);
  if (status.ok()) status = outputs.commit();
  if (!status.ok()) std::fprintf(stderr, "tetproof-plane: %s\n", status.error.c_str());
  return status.ok() ? 0 : 3;
}

std::vector<Input> inputs(const Arguments& arguments) {
  std::vector<Input> result;
  for (const std::string& name : arguments.families) result.push_back(family(name));
  for (int seed = 0; seed < arguments.tiny; ++seed) {
    auto shape = tetproof::shapes::tiny_angles(static_cast<std::uint64_t>(seed));
    result.push_back({shape.name + " " + std::to_string(seed), std::move(shape.graph)});
  }
  if (!arguments.growth.empty()) {
    for (const int n : {1000, 10000, 100000, 1000000}) {
      result.push_back(family(arguments.growth + ":" + std::to_string(n)));
    }
  }
  for (const std::string& path : arguments.files) result.push_back(file(path));
  return result;
}

// On a terminal only.
void show_progress(std::size_t done, std::size_t all) {
  if (isatty(STDERR_FILENO) == 0) return;
  std::fprintf(stderr, "\r%zu of %zu inputs%s", done, all, done == all ? "\n" : "");
}

// The meshers run in turns, so that other load of the machine affects all; the fastest run of each
// counts.
std::vector<Row> measured(const Input& input, const std::vector<Mesher>& meshers,
                          const Arguments& arguments) {
  std::vector<Row> rows;
  for (const Mesher& mesher : meshers) {
    rows.push_back({input.name, input.graph.vertices.size(), mesher.name,
                    measure(mesher, input.graph, arguments.limits)});
  }
  for (int k = 1; k < arguments.repeat; ++k) {
    for (std::size_t i = 0; i < meshers.size(); ++i) {
      Measurement& best = rows[i].measurement;
      if (!best.ok) continue;
      const Measurement again = measure(meshers[i], input.graph, arguments.limits);
      if (again.ok && again.seconds < best.seconds) best = again;
    }
  }
  return rows;
}

int run(const Arguments& arguments) {
  if (!arguments.write.empty()) return write_family(arguments);
  delmesher::PlaneOptions options;
  options.delta = arguments.delta;
  if (!arguments.figure.empty()) {
    write_figure(arguments.files.empty() ? family("figure") : file(arguments.files[0]), options,
                 arguments.figure);
    return 0;
  }
  std::vector<Mesher> meshers = {delmesher_plane(options, arguments.verify)};
  if (!arguments.alone) meshers.push_back(cgal_mesh_2());
  if (!arguments.command.empty()) meshers.push_back(foreign_command(arguments.command));
  std::vector<Row> rows;
  bool all = true;
  const std::vector<Input> given = inputs(arguments);
  if (!arguments.summary) std::fputs(table_head().c_str(), stdout);
  for (const Input& input : given) {
    show_progress(rows.size() / meshers.size(), given.size());
    for (Row& row : measured(input, meshers, arguments)) {
      all = all && (row.measurement.ok || row.mesher != meshers[0].name);
      if (!arguments.summary) std::fputs(table_row(row).c_str(), stdout);
      rows.push_back(std::move(row));
    }
    std::fflush(stdout);  // long runs can be watched, and are not lost when they are stopped
  }
  show_progress(given.size(), given.size());
  std::fputs(summary(rows).c_str(), stdout);
  return rows.empty() ? 2 : all ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app("Meshers of the plane side by side: delmesher plane and CGAL's Mesh_2.");
  app.add_option("files", arguments.files, "planar graphs, as delmesher plane reads them");
  app.add_option("--family", arguments.families, "NAME:SIZE; may be repeated")
      ->allow_extra_args(false);
  app.add_option("--tiny", arguments.tiny, "so many generated inputs with tiny angles");
  app.add_option("--growth", arguments.growth, "a family at 10^3, 10^4, 10^5, 10^6");
  app.add_option("--command", arguments.command, "another mesher, with {in} for a .poly file");
  app.add_option("--timeout", arguments.limits.seconds, "processor seconds per run (300)");
  app.add_option("--memory", arguments.limits.megabytes, "megabytes per run (4000)");
  app.add_option("--repeat", arguments.repeat, "runs of which the fastest counts (1)");
  app.add_option("--delta", arguments.delta, "angle bound of ours; the peer's is 20.7");
  app.add_option("--write", arguments.write, "FAMILY FILE.poly: writes a family")->expected(2);
  app.add_flag("--verify", arguments.verify, "delmesher's results have to pass the oracles");
  app.add_option("--figure", arguments.figure, "folder for the paper's figure 2, re-made");
  app.add_flag("--summary", arguments.summary, "only the last table");
  app.add_flag("--alone", arguments.alone, "without the peer");
  CLI11_PARSE(app, argc, argv);
  try {
    return run(arguments);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "tetproof-plane: %s\n", error.what());
    return 2;
  }
}
