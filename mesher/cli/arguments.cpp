#include "mesher/cli/arguments.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <filesystem>
#include <set>
#include <sstream>
#include <system_error>
#include <thread>

#include "mesher/cli/defects.h"
#include "mesher/cli/help.h"
#include "mesher/cli/job_options.h"
#include "mesher/cli/nearest.h"
#include "mesher/io/output.h"
#include "mesher/io/read_mesh.h"
#include "mesher/io/text.h"
#include "mesher/io/write_mesh.h"
#include "mesher/io/write_plane.h"

namespace delmesher::cli {
namespace {

// What is not in Command yet.
struct Given {
  GivenOptions options;
  std::vector<std::string> inputs;
};

constexpr auto kRepeatable = CLI::MultiOptionPolicy::TakeAll;

constexpr const char* kSurfaces =
    "surface: OFF, OBJ, STL, PLY, 3MF, .smesh or .poly, - is standard input";
constexpr const char* kSurfacesAndGraphs =
    "surface: OFF, OBJ, STL, PLY, 3MF, .smesh or .poly, - is standard input; or planar graph: "
    ".poly or rings of x y lines";
void add_common(CLI::App& app, Command& command, Given& given, const char* input = kSurfaces) {
  app.add_option("input", given.inputs, std::string(input) + "; may be several")->required();
  add_number(app, given.options, "jobs", "inputs at a time, 0: one per core (1)", {.high = 1024},
             true);
  auto* quiet = app.add_flag("-q,--quiet", command.quiet, "print errors only");
  app.add_flag("-v,--verbose", command.verbose, "print what each phase did")->excludes(quiet);
}

// The options of every job that writes something.
void add_outputs(CLI::App& app, Command& command, const std::string& help) {
  app.add_option("-o,--output", command.outputs, help + "; may be repeated")
      ->required()
      ->expected(1)
      ->take_all()
      ->type_name("FILE");
}

void add_file(CLI::App& app, Command& command, const char* name, std::string Command::*file,
              const std::string& help) {
  app.add_option(name, command.*file, help)->type_name("FILE");
}

void add_mesh_outputs(CLI::App& app, Command& command, const std::string& extensions) {
  add_outputs(app, command,
              "mesh to write: " + extensions +
                  "; {name} is the input's name without folder and extension, -.EXT is standard "
                  "output");
  add_file(app, command, "--stats", &Command::stats_file, "write statistics as JSON");
  app.add_flag("--ascii", command.write.ascii, ".msh and .vtu as text, not as bytes");
  app.add_option_function<std::string>(
         "--msh",
         [&command](const std::string& text) {
           command.write.msh = text == "2.2" ? io::MshVersion::v2_2 : io::MshVersion::v4_1;
         },
         "version of .msh: 4.1, or 2.2, which is text (4.1)")
      ->check(CLI::IsMember({"2.2", "4.1"}))
      ->type_name("2.2|4.1");
}

void add_exact(CLI::App& app, Command& command) {
  add_file(app, command, "--exact", &Command::exact_file, "write the exact record of the run");
}

void add_chamfered(CLI::App& app, Command& command, const char* help) {
  add_file(app, command, "--save-chamfered", &Command::chamfered_file, help);
}

void add_names(CLI::App& app, Command& command) {
  add_file(app, command, "--names", &Command::names_file, "names of labels, lines LABEL NAME");
}

void add_label_by_angle(CLI::App& app, Given& given) {
  options::Bounds bounds = options::kDegreesToRight;
  bounds.above_low = true;
  add_number(app, given.options, "label_by_angle",
             "label the faces between edges that bend by this many degrees: face_1, face_2 ...",
             bounds, false);
}

// How a mesh in space is written.
void add_writing(CLI::App& app, Command& command) {
  add_mesh_outputs(app, command, io::mesh_extensions());
  add_names(app, command);
  app.add_option("--order", command.write.order,
                 "1, or 2: ten-node tetrahedra with straight edges (1)")
      ->check(CLI::IsMember({1, 2}))
      ->type_name("N");
}

template <class Job>
void add_options_of(CLI::App& app, Given& given, const std::vector<options::Value>& preset = {}) {
  add_options(app, given.options, options::values_of(Job()), preset);
}

void add_mesh(CLI::App& app, Command& command, Given& given) {
  add_common(app, command, given);
  add_label_by_angle(app, given);
  add_file(app, command, "--points", &Command::points_file,
           "points that become vertices of the mesh: lines X Y Z");
  add_writing(app, command);
  add_exact(app, command);
  add_chamfered(app, command, "write the chamfered surface, OFF");
  add_options_of<Options>(app, given, options::values_of(paper_options()));
}

void add_cdt(CLI::App& app, Command& command, Given& given) {
  add_common(app, command, given);
  add_label_by_angle(app, given);
  add_writing(app, command);
  add_exact(app, command);
  add_options_of<CdtOptions>(app, given);
}

void add_plane(CLI::App& app, Command& command, Given& given) {
  add_common(app, command, given,
             "planar graph: .poly, OFF or OBJ with z = 0, or rings of x y lines");
  add_mesh_outputs(app, command, io::plane_extensions());
  add_exact(app, command);
  add_chamfered(app, command, "write the chamfered graph, .poly");
  add_options_of<PlaneOptions>(app, given, options::values_of(paper_plane_options()));
}

void add_improve(CLI::App& app, Command& command, Given& given) {
  const std::string input =
      "mesh of tetrahedra: " + io::read_mesh_extensions() + ", - is standard input";
  add_common(app, command, given, input.c_str());
  add_writing(app, command);
  add_options_of<ImproveOptions>(app, given);
}

void add_check(CLI::App& app, Command& command, Given& given) {
  add_common(app, command, given, kSurfacesAndGraphs);
  app.add_flag("--json", command.json, "report as JSON");
  add_file(app, command, "--defects", &Command::defects_file,
           "write the surface with its defects: .ply with coloured triangles, or .vtu with "
           "numbers, and those of labels");
  add_label_by_angle(app, given);
  add_options_of<CheckOptions>(app, given);
}

void add_repair(CLI::App& app, Command& command, Given& given) {
  add_common(app, command, given, kSurfacesAndGraphs);
  add_outputs(app, command,
              "surface to write: " + io::boundary_extensions() + "; of a planar graph " +
                  io::kGraphExtensions);
  add_names(app, command);
  add_options_of<RepairOptions>(app, given);
}

void add_remesh(CLI::App& app, Command& command, Given& given) {
  add_common(app, command, given);
  add_label_by_angle(app, given);
  add_outputs(app, command, "surface to write: " + std::string(io::boundary_extensions()));
  add_names(app, command);
  add_options_of<RemeshOptions>(app, given);
}

template <class Job>
Job options_of(const Given& given, Job start = {}) {
  take(given.options, start);
  return start;
}

void apply(Job job, const Given& given, Command& command) {
  const bool paper = given.options.contains("preset");
  if (const auto file = given.options.find("size_field"); file != given.options.end()) {
    command.sizes_file = file->second;
  }
  if (const auto angle = given.options.find("label_by_angle"); angle != given.options.end()) {
    command.label_angle = number_of(angle->second);
  }
  const auto wanted = [&](auto options) {
    options.want_exact = !command.exact_file.empty();
    if constexpr (requires { options.want_chamfered; }) {
      options.want_chamfered = !command.chamfered_file.empty();
    }
    return options;
  };
  switch (job) {
    case Job::mesh:
      command.options = wanted(options_of(given, paper ? paper_options() : Options()));
      break;
    case Job::cdt:
      command.options = wanted(options_of<CdtOptions>(given));
      break;
    case Job::plane:
      command.options = wanted(options_of(given, paper ? paper_plane_options() : PlaneOptions()));
      break;
    case Job::check:
      command.options = options_of<CheckOptions>(given);
      break;
    case Job::improve:
      command.options = options_of<ImproveOptions>(given);
      break;
    case Job::repair:
      command.options = options_of<RepairOptions>(given);
      break;
    case Job::remesh:
      command.options = options_of<RemeshOptions>(given);
      break;
  }
}

unsigned jobs_of(const Given& given) {
  const auto found = given.options.find("jobs");
  if (found == given.options.end()) return 1;
  const auto jobs = static_cast<unsigned>(number_of(found->second));
  return jobs > 0 ? jobs : std::max(1U, std::thread::hardware_concurrency());
}

bool any_is(const std::vector<std::string>& outputs, const char* extension) {
  return std::any_of(outputs.begin(), outputs.end(), [&](const std::string& output) {
    return io::equal_ignoring_case(std::filesystem::path(output).extension().string(), extension);
  });
}

// An option without effect is a mistake.
std::string idle_option(const Command& command, const Given& given) {
  if (given.options.contains("jobs") && given.inputs.size() == 1) {
    return "--jobs: of no effect with one input, see --threads";
  }
  if (given.options.contains("feature") && command.job() == Job::mesh &&
      !given.options.contains("tolerance")) {
    return "--feature: of no effect without --tolerance";
  }
  if (given.options.contains("size_growth") && command.sizes_file.empty()) {
    return "--size-growth: of no effect without --size-field";
  }
  const bool any_msh = any_is(command.outputs, ".msh");
  if (command.write.ascii && !any_msh && !any_is(command.outputs, ".vtu")) {
    return "--ascii: of no effect but on .msh and .vtu";
  }
  if (command.write.msh != io::MshVersion::v4_1 && !any_msh) {
    return "--msh: of no effect but on .msh";
  }
  return {};
}

// Of a surface, or of a planar graph.
std::vector<std::string> mended_files_of(const std::string& output) {
  return io::is_graph_file(output) ? std::vector{output} : io::boundary_files_of(output);
}

// Files that would overwrite each other or the input; unknown formats. `seen`: the files of other
// runs.
std::string output_error(const Command& command, bool several,
                         std::vector<std::filesystem::path>& seen) {
  // An .ele stands for several files; the files beside it are read, too.
  std::vector<std::string> files = {command.input};
  if (command.job() == Job::improve) files = io::mesh_files_read(command.input);
  const bool plane = command.job() == Job::plane;
  for (const std::string& output : command.outputs) {
    const bool repair = command.job() == Job::repair, remesh = command.job() == Job::remesh;
    const bool surface = repair || remesh;
    const std::vector<std::string> made = plane    ? io::plane_files_of(output)
                                          : repair ? mended_files_of(output)
                                          : remesh ? io::boundary_files_of(output)
                                                   : io::mesh_files_of(output);
    if (made.empty() && output == "-") {
      return "-: standard output needs a format: -.EXT, as in " + std::string(surface ? "-.stl"
                                                                              : plane ? "-.vtu"
                                                                                      : "-.msh");
    }
    if (made.empty()) {
      return output + ": unknown " + (surface ? "surface" : "mesh") + " format (" +
             (plane     ? io::plane_extensions()
              : remesh  ? std::string(io::boundary_extensions())
              : surface ? io::boundary_extensions() + "; of a planar graph " + io::kGraphExtensions
                        : io::mesh_extensions()) +
             ")";
    }
    if (command.write.order == 2) {
      if (const std::string error = io::second_order_error(output); !error.empty()) return error;
    }
    files.insert(files.end(), made.begin(), made.end());
  }
  for (const auto file : kWrittenBeside) {
    if (!(command.*file).empty()) files.push_back(command.*file);
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
  for (const std::string* file : {&command.names_file, &command.sizes_file, &command.points_file}) {
    if (!file->empty() && clash(*file)) return *file + kClash;
  }
  return {};
}

// Several runs would mix their output.
bool shares_standard_output(const std::vector<Command>& batch) {
  return batch.size() > 1 && std::any_of(batch.begin(), batch.end(), [](const Command& command) {
           return std::any_of(command.outputs.begin(), command.outputs.end(),
                              io::is_standard_stream) ||
                  std::any_of(std::begin(kWrittenBeside), std::end(kWrittenBeside),
                              [&](auto file) { return io::is_standard_stream(command.*file); });
         });
}

Parsed usage_error(const std::string& text) {
  Parsed parsed;
  parsed.exit_code = kUsage;
  parsed.error = "delmesher: " + text + "\n";
  return parsed;
}

const std::vector<std::string> kCommands = {"mesh",    "cdt",    "plane", "check",
                                            "improve", "repair", "remesh"};

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

// A first word that is not a file and nearly a command.
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

// The first option of the command line that the command has not, or that is there twice; CLI11
// would name something else first.
std::string unknown_option(const CLI::App& app, const std::vector<CLI::App*>& subcommands,
                           const std::vector<std::string>& arguments) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (const std::string& name : option->get_snames()) names.push_back("-" + name);
  }
  std::set<const CLI::Option*> seen;
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
    const bool may_be_repeated = option->get_multi_option_policy() == kRepeatable;
    if (!seen.insert(option).second && !may_be_repeated)
      return io::in_quotes(name) + ": given twice";
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
  for (const auto file : kWrittenBeside) command.*file = with_name(command.*file, input);
  return command;
}

constexpr const char* kExitCodes =
    "Exit codes: 0 done; 1 inverted tetrahedra left, or one of several files failed;\n"
    "  2 usage; 3 file; 4 not valid; 5 limit; 6 a bug; 130 interrupted.";

constexpr const char* kExamples =
    "Examples:\n"
    "  delmesher part.stl -o part.msh                   mesh a part\n"
    "  delmesher part.obj -o part.inp --max-edge 2      for Abaqus, no edge longer\n"
    "  delmesher mesh *.stl -o out/{name}.vtu --jobs 4  a whole folder\n"
    "  delmesher scan.stl -o scan.msh --tolerance 1e-3d on a surface so near\n"
    "  delmesher check part.stl                         what is wrong with it?\n"
    "  delmesher repair part.stl -o mended.stl --fill   mend what is safe to mend\n"
    "`delmesher COMMAND --help` tells the options.";

// Of the commands, in their order below.
constexpr std::array<const char*, 7> kExamplesOf = {
    "  delmesher part.stl -o part.msh -o part.vtu\n"
    "  delmesher part.stl -o part.inp --max-edge 2 --order 2\n"
    "  delmesher mesh *.stl -o out/{name}.msh --stats out/{name}.json --jobs 4\n"
    "  curl -s URL/part.stl.gz | delmesher - -o -.msh > part.msh\n",
    "  delmesher cdt part.stl -o part.vtu\n",
    "  delmesher plane outline.poly -o outline.vtu --max-edge 0.1\n",
    "  delmesher check part.stl --defects where.vtu\n"
    "  delmesher check *.stl --json\n",
    "  delmesher improve part.msh -o better.msh\n",
    "  delmesher repair part.stl -o mended.stl --weld 1e-6 --fill\n",
    "  delmesher remesh scan.ply -o light.stl --tolerance 1e-3d\n"};

// The commands, with their options.
struct Subcommands {
  CLI::App *mesh, *cdt, *plane, *check, *improve, *repair, *remesh;

  Subcommands(CLI::App& app, Command& command, Given& given)
      : mesh(app.add_subcommand("mesh", "tetrahedralize a closed surface (the default)")),
        cdt(app.add_subcommand("cdt",
                               "constrained Delaunay tetrahedrization of the hull, no quality")),
        plane(app.add_subcommand("plane", "mesh a planar graph with triangles")),
        check(app.add_subcommand("check", "is this a valid surface? if not, what is wrong?")),
        improve(app.add_subcommand(
            "improve", "fewer and better tetrahedra of a mesh, its boundary kept exactly")),
        repair(app.add_subcommand("repair", "mend a surface where that is safe")),
        remesh(app.add_subcommand("remesh",
                                  "another surface within a tolerance: few, round triangles")) {
    add_mesh(*mesh, command, given);
    add_cdt(*cdt, command, given);
    add_plane(*plane, command, given);
    add_improve(*improve, command, given);
    add_check(*check, command, given);
    add_repair(*repair, command, given);
    add_remesh(*remesh, command, given);
    for (std::size_t i = 0; i < all().size(); ++i) {
      all()[i]->footer(std::string("Examples:\n") + kExamplesOf[i] + kExitCodes);
    }
  }

  std::array<CLI::App*, 7> all() const {
    return {mesh, cdt, plane, check, improve, repair, remesh};
  }
  // The one that was given.
  Job job() const {
    return plane->parsed()     ? Job::plane
           : cdt->parsed()     ? Job::cdt
           : check->parsed()   ? Job::check
           : improve->parsed() ? Job::improve
           : repair->parsed()  ? Job::repair
           : remesh->parsed()  ? Job::remesh
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
  apply(subcommands.job(), given, command);
  if (const std::string error = idle_option(command, given); !error.empty()) {
    return usage_error(error);
  }
  if (const std::string error = make_batch(command, given, parsed); !error.empty()) {
    return usage_error(error);
  }
  return parsed;
}

}  // namespace delmesher::cli
