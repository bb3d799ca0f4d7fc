#include "mesher/cli/arguments.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <sstream>

#include "mesher/io/read_mesh.h"
#include "mesher/io/text.h"
#include "mesher/io/write_mesh.h"
#include "mesher/io/write_plane.h"

namespace delmesher::cli {
namespace {

// The options as the user gave them. Where one was not given, the preset's value stands.
struct Given {
  // As text, so that they are read like numbers in files: in no locale, and never inf or nan.
  std::map<std::string, std::string> numbers;
  std::optional<bool> slivers, improve;
  std::optional<Region> region;
  std::optional<AsPaper> as_paper;
  bool approximate = false, gabriel = false, no_bridges = false, paper = false;
};

// The option is to be left out where the library says 0 for none.
Bounds positive(Bounds bounds) {
  bounds.above_low = true;
  return bounds;
}
Bounds at_least_one(Bounds bounds) {
  bounds.low = 1;
  return bounds;
}

CLI::Validator number_within(Bounds bounds) {
  return CLI::Validator(
      [bounds](std::string& text) -> std::string {
        double value = 0;
        if (io::parse_double(text, value) != io::NumberStatus::ok) return "not a number: " + text;
        return bounds.allow(value) ? "" : "out of range: " + text;
      },
      "NUMBER");
}

void add_number(CLI::App& app, Given& given, const std::string& name, const char* help,
                Bounds bounds) {
  app.add_option_function<std::string>(
         "--" + name, [&given, name](const std::string& text) { given.numbers[name] = text; }, help)
      ->check(number_within(bounds))
      ->type_name("X");
}

constexpr const char* kAuto = "auto";

void add_planar(CLI::App& app, Given& given) {
  app.add_option_function<std::string>(
         "--planar", [&given](const std::string& text) { given.numbers["planar"] = text; },
         "facets that are planar within this fraction of the diagonal, 0 is as given (auto)")
      ->check(CLI::IsMember({kAuto}) | number_within(kBounds.planar))
      ->type_name("X");
}

constexpr const char* kSurfaces = "surface: OFF, OBJ, STL, PLY, .smesh or .poly";
void add_common(CLI::App& app, Command& command, const char* input = kSurfaces) {
  app.add_option("input", command.input, input)->required();
  auto* quiet = app.add_flag("-q,--quiet", command.quiet, "say nothing but errors");
  app.add_flag("-v,--verbose", command.verbose, "say what each phase did")->excludes(quiet);
}

void add_threads(CLI::App& app, Given& given) {
  add_number(app, given, "threads", "threads that share the work, 0: one per core (1)",
             kBounds.threads);
}

// What every job has that writes a mesh.
void add_outputs(CLI::App& app, Command& command, Given& given, const std::string& extensions) {
  app.add_option("-o,--output", command.outputs,
                 "mesh to write: " + extensions + "; may be repeated")
      ->required()
      ->expected(1)
      ->take_all();
  add_number(app, given, "max-vertices", "stop beyond this many vertices (exit 5)",
             at_least_one(kBounds.max_vertices));
  add_number(app, given, "time-limit", "stop after this many seconds (exit 5)",
             positive(kBounds.seconds));
  app.add_option("--stats", command.stats_file, "write statistics as JSON");
}

void add_run(CLI::App& app, Command& command, Given& given,
             const std::string& extensions = io::mesh_extensions()) {
  add_outputs(app, command, given, extensions);
  app.add_option_function<std::string>(
         "--region",
         [&given](const std::string& text) {
           given.region = text == "hull" ? Region::hull : Region::interior;
         },
         "what is written: interior or hull")
      ->check(CLI::IsMember({"interior", "hull"}));
  app.add_option("--exact", command.exact_file, "write the exact form of everything");
}

// Names with commas between them, or none. Empty if there is another name.
std::optional<AsPaper> as_paper_of(const std::string& text) {
  AsPaper choices;
  if (text == "none") return choices;
  std::istringstream names(text + ",");
  for (std::string name; std::getline(names, name, ',');) {
    if (name == "order") {
      choices.order = true;
    } else if (name == "steiner-point") {
      choices.steiner_point = true;
    } else {
      return {};
    }
  }
  return choices;
}

void add_as_paper(CLI::App& app, Given& given) {
  app.add_option_function<std::string>(
         "--as-paper", [&given](const std::string& text) { given.as_paper = as_paper_of(text); },
         "what is done as the paper says: order, steiner-point, with commas, or none (none)")
      ->check(CLI::Validator(
          [](std::string& text) -> std::string {
            return as_paper_of(text) ? "" : "none of order, steiner-point, none: " + text;
          },
          "LIST"))
      ->type_name("LIST");
}

void add_names(CLI::App& app, Command& command) {
  app.add_option("--names", command.names_file, "file of lines LABEL NAME: what labels are called");
}

void add_mesh(CLI::App& app, Command& command, Given& given) {
  add_common(app, command);
  add_run(app, command, given);
  add_names(app, command);
  add_number(app, given, "delta", "smallest face angle, degrees (14.47)", kBounds.delta);
  add_number(app, given, "tau", "input filter, fraction of the diagonal, 0 is off (1e-4)",
             kBounds.tau);
  add_planar(app, given);
  add_number(app, given, "budget", "raise tau until no more tetrahedra than this are predicted",
             at_least_one(kBounds.budget));
  add_number(app, given, "acute", "chamfer corners below this angle, degrees (60)", kBounds.acute);
  add_number(app, given, "corner", "the same for the angle of two edges, degrees (20)",
             kBounds.corner);
  app.add_flag("--gabriel", given.gabriel,
               "split constraints until their diametral balls are empty");
  app.add_option_function<std::string>(
         "--slivers", [&given](const std::string& text) { given.slivers = text == "on"; },
         "treat slivers in the refinement: on or off (off; on if nothing is improved)")
      ->check(CLI::IsMember({"on", "off"}));
  app.add_option_function<std::string>(
         "--improve", [&given](const std::string& text) { given.improve = text == "on"; },
         "fewer and better tetrahedra by local operations: on or off (on)")
      ->check(CLI::IsMember({"on", "off"}));
  app.add_flag("--approximate", given.approximate,
               "stop before restoring the input: a mesh of the chamfered surface");
  add_number(app, given, "chamfer-radius", "largest chamfer distance", positive(kBounds.length));
  add_number(app, given, "max-edge", "largest edge", positive(kBounds.length));
  add_as_paper(app, given);
  app.add_flag("--no-bridge-simplification", given.no_bridges, "keep every bridge (section 4.4)");
  app.add_option_function<std::string>(
         "--preset", [&given](const std::string&) { given.paper = true; },
         "paper: delta 14.47, tau 1e-4, planar 0, acute 90, corner 90, gabriel, improve off, "
         "as-paper order,steiner-point, region hull; other options override it")
      ->check(CLI::IsMember({"paper"}));
  app.add_option("--save-chamfered", command.chamfered_file, "write the chamfered surface, OFF");
  add_threads(app, given);
}

void add_improve(CLI::App& app, Command& command, Given& given) {
  const std::string input = "mesh of tetrahedra: " + io::read_mesh_extensions();
  add_common(app, command, input.c_str());
  add_outputs(app, command, given, io::mesh_extensions());
  add_names(app, command);
  add_number(app, given, "delta", "no smaller face angle is made, degrees (14.47)", kBounds.delta);
  add_number(app, given, "max-edge", "no longer edge is made", positive(kBounds.length));
  add_threads(app, given);
}

void add_plane(CLI::App& app, Command& command, Given& given) {
  add_common(app, command, "planar graph: .poly, OFF or OBJ with z = 0, or rings of x y lines");
  add_run(app, command, given, io::plane_extensions());
  add_number(app, given, "delta", "smallest angle, degrees (20.7)", kPlaneBounds.delta);
  add_number(app, given, "tau", "narrowest channel refined, width over length, 0 is off (1e-4)",
             kPlaneBounds.tau);
  add_number(app, given, "acute", "chamfer corners below this angle, degrees (60)",
             kPlaneBounds.acute);
  app.add_flag("--approximate", given.approximate,
               "stop before restoring the input: a mesh of the chamfered graph");
  add_number(app, given, "chamfer-radius", "largest chamfer distance",
             positive(kPlaneBounds.length));
  add_number(app, given, "max-edge", "largest edge", positive(kPlaneBounds.length));
  app.add_option_function<std::string>(
         "--preset", [&given](const std::string&) { given.paper = true; },
         "paper: delta 20.7, tau 0, acute 90, region hull; other options override it")
      ->check(CLI::IsMember({"paper"}));
  app.add_option("--save-chamfered", command.chamfered_file, "write the chamfered graph, .poly");
}

void apply(const Given& given, Command& command) {
  Options& options = command.options;
  if (command.job == Job::plane) {
    options = given.paper ? paper_plane_options() : plane_options();
  } else if (given.paper) {
    options = paper_options();
  }
  if (command.job == Job::cdt) options.region = Region::hull;
  const auto number = [&](const char* name, double& target) {
    const auto found = given.numbers.find(name);
    if (found != given.numbers.end()) io::parse_double(found->second, target);
  };
  number("delta", options.delta);
  number("tau", options.tau);
  number("planar", options.planar);
  if (const auto found = given.numbers.find("planar");
      found != given.numbers.end() && found->second == kAuto) {
    options.planar = kPlanarAuto;
  }
  number("acute", options.acute);
  number("corner", options.corner);
  options.gabriel |= given.gabriel;
  number("chamfer-radius", options.chamfer_radius);
  number("max-edge", options.max_edge);
  number("time-limit", options.time_limit_seconds);
  double vertices = 0, budget = 0, threads = 1;
  number("max-vertices", vertices);
  number("budget", budget);
  number("threads", threads);
  options.threads = static_cast<unsigned>(threads);
  options.budget = static_cast<std::uint64_t>(budget);
  options.max_vertices = static_cast<std::uint64_t>(vertices);
  options.improve = given.improve.value_or(options.improve);
  options.slivers = given.slivers.value_or(options.slivers || !options.improve);
  options.as_paper = given.as_paper.value_or(options.as_paper);
  options.region = given.region.value_or(options.region);
  options.approximate = given.approximate;
  options.simplify_bridges = !given.no_bridges;
  options.want_exact = !command.exact_file.empty();
  options.want_chamfered = !command.chamfered_file.empty();
}

// Files that would overwrite each other or the input; unknown formats.
std::string output_error(const Command& command) {
  // An .ele stands for several files; those beside are read, too.
  std::vector<std::string> files = {command.input};
  if (command.job == Job::improve) files = io::mesh_files_read(command.input);
  const bool plane = command.job == Job::plane;
  for (const std::string& output : command.outputs) {
    const std::vector<std::string> made =
        plane ? io::plane_files_of(output) : io::mesh_files_of(output);
    if (made.empty()) {
      return output + ": unknown mesh format (" +
             (plane ? io::plane_extensions() : io::mesh_extensions()) + ")";
    }
    files.insert(files.end(), made.begin(), made.end());
  }
  for (const std::string* file :
       {&command.stats_file, &command.chamfered_file, &command.exact_file, &command.names_file}) {
    if (!file->empty()) files.push_back(*file);
  }
  std::vector<std::filesystem::path> seen;
  for (const std::string& file : files) {
    std::error_code error;
    std::filesystem::path path =
        std::filesystem::weakly_canonical(std::filesystem::absolute(file, error), error);
    if (error) path = file;
    if (std::find(seen.begin(), seen.end(), path) != seen.end()) {
      return file + ": named twice, or the same as the input";
    }
    if (!std::filesystem::is_character_file(path, error)) seen.push_back(path);
  }
  return {};
}

Parsed usage_error(const std::string& text) {
  Parsed parsed;
  parsed.exit_code = kUsage;
  parsed.error = "delmesher: " + text + "\n";
  return parsed;
}

void default_to_mesh(std::vector<std::string>& arguments) {
  static constexpr std::array<std::string_view, 8> kFirst = {
      "mesh", "cdt", "plane", "check", "improve", "--help", "-h", "--version"};
  if (arguments.empty() || std::find(kFirst.begin(), kFirst.end(), arguments[0]) == kFirst.end()) {
    arguments.insert(arguments.begin(), "mesh");
  }
}

}  // namespace

Parsed parse_arguments(std::vector<std::string> arguments) {
  Command command;
  Given given;
  CLI::App app("Tetrahedral meshes of closed surfaces, exactly conforming.", "delmesher");
  app.require_subcommand(1);
  app.set_version_flag("--version", std::string("delmesher ") + version());
  CLI::App* mesh = app.add_subcommand("mesh", "tetrahedralize a closed surface (the default)");
  CLI::App* cdt = app.add_subcommand(
      "cdt", "constrained Delaunay tetrahedrization of the convex hull, no quality");
  CLI::App* plane = app.add_subcommand("plane", "mesh a planar graph with triangles");
  CLI::App* check = app.add_subcommand("check", "is this a valid surface? if not, what is wrong?");
  CLI::App* improve = app.add_subcommand(
      "improve", "fewer and better tetrahedra of a mesh, its boundary kept exactly");
  add_mesh(*mesh, command, given);
  add_common(*cdt, command);
  add_run(*cdt, command, given);
  add_names(*cdt, command);
  add_threads(*cdt, given);
  add_plane(*plane, command, given);
  add_improve(*improve, command, given);
  add_common(*check, command);
  add_planar(*check, given);
  check->add_flag("--json", command.json, "report as JSON");
  add_number(*check, given, "acute", "corners below this angle are acute, degrees (60)",
             kBounds.acute);
  add_number(*check, given, "corner", "the same for the angle of two edges, degrees (20)",
             kBounds.corner);
  add_threads(*check, given);

  default_to_mesh(arguments);
  std::reverse(arguments.begin(), arguments.end());  // as CLI11 wants them
  Parsed parsed;
  try {
    app.parse(arguments);
  } catch (const CLI::Success& success) {
    std::ostringstream out, error;
    app.exit(success, out, error);
    parsed.out = out.str();
    return parsed;
  } catch (const CLI::ParseError& error) {
    std::string line = error.what();
    std::replace(line.begin(), line.end(), '\n', ' ');
    return usage_error(line);
  }
  command.job = plane->parsed()     ? Job::plane
                : cdt->parsed()     ? Job::cdt
                : check->parsed()   ? Job::check
                : improve->parsed() ? Job::improve
                                    : Job::mesh;
  apply(given, command);
  const std::string error = output_error(command);
  if (!error.empty()) return usage_error(error);
  parsed.run = true;
  parsed.command = std::move(command);
  return parsed;
}

}  // namespace delmesher::cli
