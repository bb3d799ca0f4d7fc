// tetproof-plane: meshers of the plane side by side. README.md says how to use it.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "corpus/plane/bench.h"
#include "mesher/io/write_plane.h"
#include "oracles/plane_shapes.h"

namespace {

using namespace tetproof::plane_bench;

struct Arguments {
  std::vector<std::string> files, families, write;
  std::string command, growth;
  int tiny = 0, repeat = 1;
  double timeout = 300, delta = 20.7;
  bool summary = false, alone = false;
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

int run(const Arguments& arguments) {
  if (!arguments.write.empty()) return write_family(arguments);
  delmesher::Options options = delmesher::plane_options();
  options.delta = arguments.delta;
  std::vector<Mesher> meshers = {delmesher_plane(options)};
  if (!arguments.alone) meshers.push_back(cgal_mesh_2());
  if (!arguments.command.empty()) meshers.push_back(foreign_command(arguments.command));
  std::vector<Row> rows;
  for (const Input& input : inputs(arguments)) {
    for (const Mesher& mesher : meshers) {
      Measurement best = measure(mesher, input.graph, arguments.timeout);
      for (int k = 1; k < arguments.repeat && best.ok; ++k) {
        const Measurement again = measure(mesher, input.graph, arguments.timeout);
        if (again.ok && again.seconds < best.seconds) best = again;
      }
      rows.push_back({input.name, input.graph.vertices.size(), mesher.name, best});
    }
  }
  std::fputs(markdown(rows, arguments.summary).c_str(), stdout);
  return rows.empty() ? 2 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app("Meshers of the plane side by side: delmesher plane and CGAL's Mesh_2.");
  app.add_option("files", arguments.files, "planar graphs, as delmesher plane reads them");
  app.add_option("--family", arguments.families, "NAME:SIZE; may be repeated");
  app.add_option("--tiny", arguments.tiny, "so many generated inputs with tiny angles");
  app.add_option("--growth", arguments.growth, "a family at 10^3, 10^4, 10^5, 10^6");
  app.add_option("--command", arguments.command, "another mesher, with {in} for a .poly file");
  app.add_option("--timeout", arguments.timeout, "processor seconds per run (300)");
  app.add_option("--repeat", arguments.repeat, "runs of which the fastest counts (1)");
  app.add_option("--delta", arguments.delta, "angle bound of ours; the peer's is 20.7");
  app.add_option("--write", arguments.write, "FAMILY FILE.poly: writes a family")->expected(2);
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
