#include "mesher/cli/arguments.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <sstream>
#include <system_error>
#include <thread>

#include "mesher/cli/defects.h"
#include "mesher/cli/help.h"
#include "mesher/cli/nearest.h"
#include "mesher/io/output.h"
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
  std::vector<std::string> inputs;
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

// "above 0 and at most 30"
std::string range_text(const Bounds& bounds) {
  const auto number = [](double x) {
    std::string text;
    io::append_double(text, x);
    return text;
  };
  const std::string low = (bounds.above_low ? "above " : "at least ") + number(bounds.low);
  return bounds.high == kNoBound ? low : low + ", at most " + number(bounds.high);
}

CLI::Validator number_within(Bounds bounds, bool whole = false) {
  return CLI::Validator(
      [bounds, whole](std::string& text) -> std::string {
        double value = 0;
        if (io::parse_double(text, value) != io::NumberStatus::ok) return "not a number: " + text;
        if (whole && value != std::floor(value)) return "not a whole number: " + text;
        return bounds.allow(value) ? "" : "out of range: " + text + " (" + range_text(bounds) + ")";
      },
      "NUMBER");
}

// "largest angle (30)" -> "largest angle (30; above 0, at most 90)", where there is a limit that
// one may come near.
std::string with_range(std::string help, const Bounds& bounds) {
  constexpr double kFar = 1e6;
  if (bounds.high > kFar) return help;
  if (!help.ends_with(')')) return help + " (" + range_text(bounds) + ")";
  help.back() = ';';
  return help + " " + range_text(bounds) + ")";
}

CLI::Option* add_number(CLI::App& app, Given& given, const std::string& name, const char* help,
                        Bounds bounds) {
  return app
      .add_option_function<std::string>(
          "--" + name, [&given, name](const std::string& text) { given.numbers[name] = text; },
          with_range(help, bounds))
      ->check(number_within(bounds))
      ->type_name("X");
}

// A whole number.
void add_count(CLI::App& app, Given& given, const std::string& name, const char* help,
               Bounds bounds) {
  add_number(app, given, name, help, bounds)->check(number_within(bounds, true))->type_name("N");
}

constexpr const char* kAuto = "auto";

void add_planar(CLI::App& app, Given& given) {
  app.add_option_function<std::string>(
         "--planar", [&given](const std::string& text) { given.numbers["planar"] = text; },
         with_range(
             "facets that are planar within this fraction of the diagonal, 0 is as given (auto)",
             kBounds.planar))
      ->check(CLI::IsMember({kAuto}) | number_within(kBounds.planar))
      ->type_name("X");
}

constexpr const char* kSurfaces =
    "surface: OFF, OBJ, STL, PLY, 3MF, .smesh or .poly, - is standard input";
void add_common(CLI::App& app, Command& command, Given& given, const char* input = kSurfaces) {
  app.add_option("input", given.inputs, std::string(input) + "; may be several")->required();
  add_count(app, given, "jobs", "how many of several inputs at a time, 0: one per core (1)",
            kBounds.threads);
  auto* quiet = app.add_flag("-q,--quiet", command.quiet, "say nothing but errors");
  app.add_flag("-v,--verbose", command.verbose, "say what each phase did")->excludes(quiet);
}

void add_threads(CLI::App& app, Given& given) {
  add_count(app, given, "threads", "threads that share the work, 0: one per core (1)",
            kBounds.threads);
}

// The options of every job that writes a mesh.
void add_outputs(CLI::App& app, Command& command, Given& given, const std::string& extensions) {
  app.add_option("-o,--output", command.outputs,
                 "mesh to write: " + extensions +
                     "; may be repeated; {name} is the input's name without folder and extension, "
                     "-.EXT is standard output")
      ->required()
      ->expected(1)
      ->take_all()
      ->type_name("FILE");
  add_count(app, given, "max-vertices", "stop beyond this many vertices (exit 5)",
            at_least_one(kBounds.max_vertices));
  add_number(app, given, "time-limit", "stop after this many seconds (exit 5)",
             positive(kBounds.seconds));
  app.add_option("--stats", command.stats_file, "write statistics as JSON")->type_name("FILE");
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
      ->check(CLI::IsMember({"interior", "hull"}))
      ->type_name("interior|hull");
  app.add_option("--exact", command.exact_file, "write the exact form of everything")
      ->type_name("FILE");
}

// Names with commas between them, all, or none. Empty if there is another name than those of `all`.
std::optional<AsPaper> as_paper_of(const std::string& text, const AsPaper& all) {
  AsPaper choices;
  if (text == "none") return choices;
  if (text == "all") return all;
  std::istringstream names(text + ",");
  for (std::string name; std::getline(names, name, ',');) {
    const auto* choice =
        std::find_if(std::begin(kPaperChoices), std::end(kPaperChoices),
                     [&](const NamedChoice& c) { return c.name == name && all.*c.member; });
    if (choice == std::end(kPaperChoices)) return {};
    choices.*choice->member = true;
  }
  return choices;
}

std::string paper_choices(const AsPaper& all) {
  std::string names;
  for (const NamedChoice& choice : kPaperChoices) {
    if (all.*choice.member) names += (names.empty() ? "" : ", ") + std::string(choice.name);
  }
  return names;
}

// `all`: those that there are.
void add_as_paper(CLI::App& app, Given& given, const AsPaper& all) {
  app.add_option_function<std::string>(
         "--as-paper",
         [&given, all](const std::string& text) { given.as_paper = as_paper_of(text, all); },
         "what is done as the paper says: " + paper_choices(all) +
             ", with commas, all, or none (none)")
      ->check(CLI::Validator(
          [all](std::string& text) -> std::string {
            return as_paper_of(text, all)
                       ? ""
                       : "none of " + paper_choices(all) + ", all, none: " + text;
          },
          "LIST"))
      ->type_name("LIST");
}

void add_names(CLI::App& app, Command& command) {
  app.add_option("--names", command.names_file, "file of lines LABEL NAME: what labels are called")
      ->type_name("FILE");
}

void add_ascii(CLI::App& app, Command& command) {
  app.add_flag("--ascii", command.write.ascii, ".msh and .vtu as text, not as bytes");
}

// How a mesh in space is written.
void add_writing(CLI::App& app, Command& command) {
  add_names(app, command);
  app.add_option("--order", command.write.order,
                 "1, or 2: ten-node tetrahedra with straight edges (1)")
      ->check(CLI::IsMember({1, 2}))
      ->type_name("N");
  add_ascii(app, command);
}

void add_sizes(CLI::App& app, Command& command, Given& given) {
  app.add_option("--size-field", command.sizes_file,
                 "smaller edges in places: lines X Y Z SIZE, or a .pos of Gmsh")
      ->type_name("FILE");
  add_number(app, given, "size-growth",
             "how much larger edges may be per distance from there (0.3)", kBounds.growth);
}

void add_mesh(CLI::App& app, Command& command, Given& given) {
  add_common(app, command, given);
  add_run(app, command, given);
  add_writing(app, command);
  add_number(app, given, "delta", "smallest face angle, degrees (14.47)", kBounds.delta);
  add_number(app, given, "tau", "input filter, fraction of the diagonal, 0 is off (1e-4)",
             kBounds.tau);
  add_planar(app, given);
  add_count(app, given, "budget", "raise tau until no more tetrahedra than this are predicted",
            at_least_one(kBounds.budget));
  add_number(app, given, "acute", "chamfer corners below this angle, degrees (60)", kBounds.acute);
  add_number(app, given, "corner", "the same for the angle of two edges, degrees (20)",
             kBounds.corner);
  app.add_flag("--gabriel", given.gabriel,
               "split constraints until their diametral balls are empty");
  app.add_option_function<std::string>(
         "--slivers", [&given](const std::string& text) { given.slivers = text == "on"; },
         "treat slivers in the refinement: on or off (on)")
      ->check(CLI::IsMember({"on", "off"}))
      ->type_name("on|off");
  app.add_option_function<std::string>(
         "--improve", [&given](const std::string& text) { given.improve = text == "on"; },
         "fewer and better tetrahedra by local operations: on or off (on)")
      ->check(CLI::IsMember({"on", "off"}))
      ->type_name("on|off");
  app.add_flag("--approximate", given.approximate,
               "stop before restoring the input: a mesh of the chamfered surface");
  add_number(app, given, "chamfer-radius", "how far a chamfer may reach", positive(kBounds.length));
  add_number(app, given, "max-edge", "largest edge", positive(kBounds.length));
  add_sizes(app, command, given);
  add_as_paper(app, given, paper_options().as_paper);
  app.add_flag("--no-bridge-simplification", given.no_bridges, "keep every bridge (section 4.4)");
  app.add_option_function<std::string>(
         "--preset", [&given](const std::string&) { given.paper = true; },
         "paper: delta 14.47, tau 1e-4, planar 0, acute 90, corner 90, gabriel, improve off, "
         "as-paper all, region hull; other options override it")
      ->check(CLI::IsMember({"paper"}))
      ->type_name("paper");
  app.add_option("--save-chamfered", command.chamfered_file, "write the chamfered surface, OFF")
      ->type_name("FILE");
  add_threads(app, given);
}

void add_improve(CLI::App& app, Command& command, Given& given) {
  const std::string input =
      "mesh of tetrahedra: " + io::read_mesh_extensions() + ", - is standard input";
  add_common(app, command, given, input.c_str());
  add_outputs(app, command, given, io::mesh_extensions());
  add_writing(app, command);
  add_number(app, given, "delta", "no smaller face angle is made, degrees (14.47)", kBounds.delta);
  add_number(app, given, "max-edge", "no longer edge is made", positive(kBounds.length));
  add_sizes(app, command, given);
  add_threads(app, given);
}

void add_plane(CLI::App& app, Command& command, Given& given) {
  add_common(app, command, given,
             "planar graph: .poly, OFF or OBJ with z = 0, or rings of x y lines");
  add_run(app, command, given, io::plane_extensions());
  add_ascii(app, command);
  add_number(app, given, "delta", "smallest angle, degrees (20.7)", kPlaneBounds.delta);
  add_number(app, given, "tau", "narrowest channel refined, width over length, 0 is off (1e-4)",
             kPlaneBounds.tau);
  add_number(app, given, "acute", "chamfer corners below this angle, degrees (60)",
             kPlaneBounds.acute);
  app.add_flag("--approximate", given.approximate,
               "stop before restoring the input: a mesh of the chamfered graph");
  add_number(app, given, "chamfer-radius", "how far a chamfer may reach",
             positive(kPlaneBounds.length));
  add_number(app, given, "max-edge", "largest edge", positive(kPlaneBounds.length));
  add_as_paper(app, given, paper_plane_options().as_paper);
  app.add_option_function<std::string>(
         "--preset", [&given](const std::string&) { given.paper = true; },
         "paper: delta 20.7, tau 0, acute 90, as-paper all, region hull; other options override "
         "it")
      ->check(CLI::IsMember({"paper"}))
      ->type_name("paper");
  app.add_option("--save-chamfered", command.chamfered_file, "write the chamfered graph, .poly")
      ->type_name("FILE");
}

void add_repair(CLI::App& app, Command& command, Given& given) {
  add_common(app, command, given);
  app.add_option("-o,--output", command.outputs,
                 "surface to write: " + io::boundary_extensions() + "; may be repeated")
      ->required()
      ->expected(1)
      ->take_all()
      ->type_name("FILE");
  add_number(app, given, "weld", "join vertices no farther apart than this, in units of the input",
             positive(kBounds.length));
  app.add_flag("--fill", command.repair.fill,
               "fill holes that are planar, or narrower than a twentieth of the diagonal");
  add_names(app, command);
  add_threads(app, given);
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
  number("size-growth", options.size_growth);
  number("weld", command.repair.weld);
  number("time-limit", options.time_limit_seconds);
  double vertices = 0, budget = 0, threads = 1;
  number("max-vertices", vertices);
  number("budget", budget);
  number("threads", threads);
  options.threads = static_cast<unsigned>(threads);
  options.budget = static_cast<std::uint64_t>(budget);
  options.max_vertices = static_cast<std::uint64_t>(vertices);
  options.improve = given.improve.value_or(options.improve);
  options.slivers = given.slivers.value_or(options.slivers);
  options.as_paper = given.as_paper.value_or(options.as_paper);
  options.region = given.region.value_or(options.region);
  options.approximate = given.approximate;
  options.simplify_bridges = !given.no_bridges;
  options.want_exact = !command.exact_file.empty();
  options.want_chamfered = !command.chamfered_file.empty();
}

unsigned jobs_of(const Given& given) {
  double jobs = 1;
  if (const auto found = given.numbers.find("jobs"); found != given.numbers.end()) {
    io::parse_double(found->second, jobs);
  }
  return jobs > 0 ? static_cast<unsigned>(jobs) : std::max(1U, std::thread::hardware_concurrency());
}

// Files that would overwrite each other or the input; unknown formats. `seen`: the files of other
// runs.
std::string output_error(const Command& command, bool several,
                         std::vector<std::filesystem::path>& seen) {
  // An .ele stands for several files; the files beside it are read, too.
  std::vector<std::string> files = {command.input};
  if (command.job == Job::improve) files = io::mesh_files_read(command.input);
  const bool plane = command.job == Job::plane;
  for (const std::string& output : command.outputs) {
    const bool surface = command.job == Job::repair;
    const std::vector<std::string> made = plane     ? io::plane_files_of(output)
                                          : surface ? io::boundary_files_of(output)
                                                    : io::mesh_files_of(output);
    if (made.empty() && output == "-") {
      return "-: standard output needs a format: -.EXT, as in " + std::string(surface ? "-.stl"
                                                                              : plane ? "-.vtu"
                                                                                      : "-.msh");
    }
    if (made.empty()) {
      return output + ": unknown " + (surface ? "surface" : "mesh") + " format (" +
             (plane     ? io::plane_extensions()
              : surface ? io::boundary_extensions()
                        : io::mesh_extensions()) +
             ")";
    }
    if (command.write.order == 2) {
      if (const std::string error = io::second_order_error(output); !error.empty()) return error;
    }
    files.insert(files.end(), made.begin(), made.end());
  }
  for (const std::string* file :
       {&command.stats_file, &command.chamfered_file, &command.exact_file, &command.defects_file}) {
    if (!file->empty()) files.push_back(*file);
  }
  if (std::count_if(files.begin() + 1, files.end(), io::is_standard_stream) > 1) {
    return "standard output can take one file";
  }
  if (!command.defects_file.empty() &&
      defects_format(command.defects_file) == DefectsFormat::none) {
    return command.defects_file + ": defects are written as .ply or .vtu";
  }
  const auto where = [](const std::string& file) {
    std::error_code error;
    std::filesystem::path path =
        std::filesystem::weakly_canonical(std::filesystem::absolute(file, error), error);
    return error ? std::filesystem::path(file) : path;
  };
  const auto clash = [&](const std::string& file) {
    return !io::is_standard_stream(file) &&
           std::find(seen.begin(), seen.end(), where(file)) != seen.end();
  };
  constexpr const char* kClash = ": named twice, or the same as the input";
  for (const std::string& file : files) {
    if (clash(file)) {
      return file + kClash +
             (several ? "; of several inputs {name} is the name, as in -o out/{name}.msh" : "");
    }
    std::error_code error;
    if (!std::filesystem::is_character_file(where(file), error)) seen.push_back(where(file));
  }
  // These files are only read, by every run.
  for (const std::string* file : {&command.names_file, &command.sizes_file}) {
    if (!file->empty() && clash(*file)) return *file + kClash;
  }
  return {};
}

// Several runs would mix their output.
bool shares_standard_output(const std::vector<Command>& batch) {
  return batch.size() > 1 && std::any_of(batch.begin(), batch.end(), [](const Command& command) {
           const std::string* files[] = {&command.stats_file, &command.chamfered_file,
                                         &command.exact_file, &command.defects_file};
           return std::any_of(command.outputs.begin(), command.outputs.end(),
                              io::is_standard_stream) ||
                  std::any_of(std::begin(files), std::end(files), [](const std::string* file) {
                    return io::is_standard_stream(*file);
                  });
         });
}

Parsed usage_error(const std::string& text) {
  Parsed parsed;
  parsed.exit_code = kUsage;
  parsed.error = "delmesher: " + text + "\n";
  return parsed;
}

const std::vector<std::string> kCommands = {"mesh", "cdt", "plane", "check", "improve", "repair"};

bool contains(const std::vector<std::string>& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

void default_to_mesh(std::vector<std::string>& arguments) {
  static const std::vector<std::string> kOthers = {"--help", "-h", "--version"};
  if (arguments.empty() ||
      !(contains(kCommands, arguments[0]) || contains(kOthers, arguments[0]))) {
    arguments.insert(arguments.begin(), "mesh");
  }
}

// `help`, `help COMMAND` and `version`, as many programs have them, unless there are such files.
void as_options(std::vector<std::string>& arguments) {
  std::error_code ignored;
  if (std::filesystem::exists(arguments[0], ignored)) return;
  if (arguments[0] == "version" && arguments.size() == 1) arguments[0] = "--version";
  if (arguments[0] != "help") return;
  arguments[0] = "--help";
  if (arguments.size() > 1 && contains(kCommands, arguments[1])) {
    std::swap(arguments[0], arguments[1]);
  }
}

// A first word that is no file and nearly a command.
std::string mistyped_command(const std::vector<std::string>& arguments) {
  if (arguments.empty() || arguments[0].find_first_of("./-") != std::string::npos) return {};
  std::error_code ignored;
  if (contains(kCommands, arguments[0]) || std::filesystem::exists(arguments[0], ignored))
    return {};
  const std::string meant = suggestion(arguments[0], kCommands);
  return meant.empty() ? "" : "no command or file " + io::in_quotes(arguments[0]) + meant;
}

// ", but of repair and union": the commands that have an option.
std::string commands_with(const std::vector<CLI::App*>& subcommands, const std::string& name) {
  std::string commands;
  for (const CLI::App* command : subcommands) {
    if (command->get_option_no_throw(name) == nullptr) continue;
    commands += (commands.empty() ? ", but of " : " and ") + command->get_name();
  }
  return commands;
}

// The first option of the command line that the command has not; CLI11 would name something else
// first.
std::string unknown_option(const CLI::App& app, const std::vector<CLI::App*>& subcommands,
                           const std::vector<std::string>& arguments) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (const std::string& name : option->get_snames()) names.push_back("-" + name);
  }
  for (std::size_t i = 1; i < arguments.size() && arguments[i] != "--"; ++i) {
    const std::string& word = arguments[i];
    if (word.size() < 2 || word[0] != '-' || word[1] == '.') continue;
    const bool is_long = word[1] == '-';
    const std::string name = is_long ? word.substr(0, word.find('=')) : word.substr(0, 2);
    if (!contains(names, name)) {
      const std::string others = commands_with(subcommands, name);
      return io::in_quotes(word) + ": no such option of " + app.get_name() +
             (others.empty() ? suggestion(name, names) : others);
    }
    const CLI::Option* option = app.get_option(name);
    const bool has_value = is_long ? name.size() < word.size() : word.size() > 2;
    if (option->get_expected_max() > 0 && !has_value) ++i;  // whatever its value looks like
  }
  return {};
}

std::string with_name(std::string text, const std::string& input) {
  constexpr std::string_view kName = "{name}";
  const std::filesystem::path path(input);
  const bool compressed = io::equal_ignoring_case(path.extension().string(), ".gz");
  const std::string name = (compressed ? path.stem() : path.filename()).stem().string();
  for (std::size_t at = text.find(kName); at != std::string::npos;
       at = text.find(kName, at + name.size())) {
    text.replace(at, kName.size(), name);
  }
  return text;
}

Command for_input(Command command, const std::string& input) {
  command.input = input;
  for (std::string& output : command.outputs) output = with_name(output, input);
  for (std::string* file :
       {&command.stats_file, &command.chamfered_file, &command.exact_file, &command.defects_file}) {
    *file = with_name(*file, input);
  }
  return command;
}

void add_cdt(CLI::App& app, Command& command, Given& given) {
  add_common(app, command, given);
  add_run(app, command, given);
  add_writing(app, command);
  add_threads(app, given);
}

void add_check(CLI::App& app, Command& command, Given& given) {
  add_common(app, command, given);
  add_planar(app, given);
  app.add_flag("--json", command.json, "report as JSON");
  app.add_option(
         "--defects", command.defects_file,
         "write the surface as .ply, its triangles coloured by what is wrong at them, or as "
         ".vtu with numbers for that")
      ->type_name("FILE");
  add_number(app, given, "acute", "corners below this angle are acute, degrees (60)",
             kBounds.acute);
  add_number(app, given, "corner", "the same for the angle of two edges, degrees (20)",
             kBounds.corner);
  add_threads(app, given);
}

constexpr const char* kExitCodes =
    "Exit codes: 0 done; 1 inverted tetrahedra left, or one of several files failed;\n"
    "  2 usage; 3 file; 4 not valid; 5 limit; 6 a bug; 130 interrupted.";

constexpr const char* kExamples =
    "Examples:\n"
    "  delmesher part.stl -o part.msh                   mesh a part\n"
    "  delmesher part.obj -o part.inp --max-edge 2      for Abaqus, no edge longer\n"
    "  delmesher mesh *.stl -o out/{name}.vtu --jobs 4  a whole folder\n"
    "  delmesher check part.stl                         what is wrong with it?\n"
    "  delmesher repair part.stl -o mended.stl --fill   mend what is safe to mend\n"
    "`delmesher COMMAND --help` tells the options.";

// Of the commands, in their order below.
constexpr std::array<const char*, 6> kExamplesOf = {
    "  delmesher part.stl -o part.msh -o part.vtu\n"
    "  delmesher part.stl -o part.inp --max-edge 2 --order 2\n"
    "  delmesher mesh *.stl -o out/{name}.msh --stats out/{name}.json --jobs 4\n"
    "  curl -s URL/part.stl.gz | delmesher - -o -.msh > part.msh\n",
    "  delmesher cdt part.stl -o part.vtu\n",
    "  delmesher plane outline.poly -o outline.vtu --max-edge 0.1\n",
    "  delmesher check part.stl --defects where.vtu\n"
    "  delmesher check *.stl --json\n",
    "  delmesher improve part.msh -o better.msh\n",
    "  delmesher repair part.stl -o mended.stl --weld 1e-6 --fill\n"};

// The commands, with their options.
struct Subcommands {
  CLI::App *mesh, *cdt, *plane, *check, *improve, *repair;

  Subcommands(CLI::App& app, Command& command, Given& given)
      : mesh(app.add_subcommand("mesh", "tetrahedralize a closed surface (the default)")),
        cdt(app.add_subcommand("cdt",
                               "constrained Delaunay tetrahedrization of the hull, no quality")),
        plane(app.add_subcommand("plane", "mesh a planar graph with triangles")),
        check(app.add_subcommand("check", "is this a valid surface? if not, what is wrong?")),
        improve(app.add_subcommand(
            "improve", "fewer and better tetrahedra of a mesh, its boundary kept exactly")),
        repair(app.add_subcommand("repair", "mend a surface where that is safe")) {
    add_mesh(*mesh, command, given);
    add_cdt(*cdt, command, given);
    add_plane(*plane, command, given);
    add_improve(*improve, command, given);
    add_check(*check, command, given);
    add_repair(*repair, command, given);
    for (std::size_t i = 0; i < all().size(); ++i) {
      all()[i]->footer(std::string("Examples:\n") + kExamplesOf[i] + kExitCodes);
    }
  }

  std::array<CLI::App*, 6> all() const { return {mesh, cdt, plane, check, improve, repair}; }
  // The one that was given.
  Job job() const {
    return plane->parsed()     ? Job::plane
           : cdt->parsed()     ? Job::cdt
           : check->parsed()   ? Job::check
           : improve->parsed() ? Job::improve
           : repair->parsed()  ? Job::repair
                               : Job::mesh;
  }
};

// What is wrong with the words before they are parsed; empty: nothing. CLI11 would not say it in a
// line that helps.
std::string misspelt(const Subcommands& subcommands, const std::vector<std::string>& arguments) {
  for (const CLI::App* subcommand : subcommands.all()) {
    if (subcommand->get_name() == arguments[0]) {
      const auto all = subcommands.all();
      return unknown_option(*subcommand, {all.begin(), all.end()}, arguments);
    }
  }
  return {};
}

// One job for each input. Empty, or what is wrong.
std::string make_batch(const Command& command, const Given& given, Parsed& parsed) {
  std::vector<std::filesystem::path> seen;
  for (const std::string& input : given.inputs) {
    parsed.batch.push_back(for_input(command, input));
    const std::string error = output_error(parsed.batch.back(), given.inputs.size() > 1, seen);
    if (!error.empty()) return error;
  }
  if (shares_standard_output(parsed.batch)) {
    return "standard output can take the file of one input";
  }
  parsed.run = true;
  parsed.jobs = jobs_of(given);
  parsed.command = parsed.batch.front();
  if (parsed.batch.size() == 1) parsed.batch.clear();
  return {};
}

}  // namespace

Parsed parse_arguments(std::vector<std::string> arguments) {
  Command command;
  Given given;
  CLI::App app("Tetrahedral meshes of closed surfaces, exactly conforming.", "delmesher");
  app.require_subcommand(1);
  app.formatter(std::make_shared<Help>());
  app.footer(std::string(kExamples) + "\n" + kExitCodes);
  app.set_version_flag("--version", std::string("delmesher ") + version());
  const Subcommands subcommands(app, command, given);
  if (arguments.empty()) {
    Parsed parsed = usage_error("nothing to do");
    parsed.error += "\n" + app.help();
    return parsed;
  }
  if (const std::string error = mistyped_command(arguments); !error.empty()) {
    return usage_error(error);
  }
  as_options(arguments);
  default_to_mesh(arguments);
  if (const std::string error = misspelt(subcommands, arguments); !error.empty()) {
    return usage_error(error);
  }
  const std::string see = ", see delmesher " + arguments[0] + " --help";
  std::reverse(arguments.begin(), arguments.end());  // as CLI11 wants them
  Parsed parsed;
  try {
    app.parse(arguments);
  } catch (const CLI::Success& success) {
    std::ostringstream out, error;
    app.exit(success, out, error);
    parsed.out = out.str();
    return parsed;
  } catch (const CLI::RequiredError& error) {
    return usage_error(error.what() + see);
  } catch (const CLI::ArgumentMismatch& error) {
    const std::string line = error.what();
    return usage_error(line.substr(0, line.find(':')) + ": its value is missing" + see);
  } catch (const CLI::ParseError& error) {
    std::string line = error.what();
    std::replace(line.begin(), line.end(), '\n', ' ');
    return usage_error(line);
  }
  command.job = subcommands.job();
  apply(given, command);
  if (const std::string error = make_batch(command, given, parsed); !error.empty()) {
    return usage_error(error);
  }
  return parsed;
}

}  // namespace delmesher::cli
