#include "oracles/verify_command.h"

#include <gmp.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <new>
#include <stdexcept>

#include "oracles/base/heap.h"
#include "oracles/base/text_reader.h"
#include "oracles/envelope.h"
#include "oracles/files/sidecar.h"
#include "oracles/files/surface_file.h"
#include "oracles/improvement/improved.h"
#include "oracles/plane/verify.h"
#include "oracles/verify.h"

namespace tetproof::oracles {
namespace {

enum ExitCode {
  kDone = 0,
  kFailed = 1,
  kUsage = 2,
  kUnreadable = 3,
  kInvalid = 4,
  kLimit = 5,  // also if a file alone leaves the verdict undecided
  kInternal = 6
};

struct Arguments {
  std::string input, mesh, exact, promised = "mesh";
  bool json = false;
  double envelope = 0;  // not 0: the mesh has a surface of its own, so near
  std::optional<Stage> stage;
  VerifyOptions options;
};

// CLI11's own description of the choices shows the numbers behind the names.
template <class Choice>
CLI::Validator one_of(const std::map<std::string, Choice>& choices) {
  std::string names;
  for (const auto& [name, choice] : choices) names += (names.empty() ? "" : "|") + name;
  return CLI::CheckedTransformer(choices).description("{" + names + "}");
}

void declare(CLI::App& app, Arguments& arguments) {
  app.add_option("INPUT", arguments.input,
                 "surface: OFF, OBJ, STL, PLY, 3MF, .smesh or .poly; in the plane .poly, OFF, OBJ "
                 "or rings; of an "
                 "improved mesh the one that was given")
      ->required();
  app.add_option("MESH", arguments.mesh,
                 "mesh: .mesh, .msh, .vtu, .node or .ele, .tet; in the plane .node or .ele, .msh, "
                 ".vtu, .off")
      ->required();
  app.add_option("--exact", arguments.exact, "sidecar with exact coordinates");
  app.add_option("--stage", arguments.stage,
                 "what is checked (final; with a sidecar, what it holds)")
      ->transform(one_of<Stage>({{"refined", Stage::refined}, {"final", Stage::final}}))
      ->type_name("STAGE");
  app.add_option("--promised", arguments.promised,
                 "what the mesher was asked for: 'mesh OPTIONS', 'cdt OPTIONS', 'plane OPTIONS', "
                 "'improve OPTIONS' (mesh)");
  app.add_option("--declared-deviation", arguments.options.declared_deviation,
                 "deviation that is not a failure, as a fraction of the diagonal (0)");
  app.add_option("--envelope", arguments.envelope,
                 "the mesh has a surface of its own, at most this fraction of the diagonal (from "
                 "1e-7 to 1) "
                 "from the input, and the input from it")
      ->check(CLI::PositiveNumber);
  app.add_option("--threads", arguments.options.threads,
                 "threads that share the checks, 0: one per core (1)")
      ->check(CLI::Range(0, 1024));
  app.add_flag("--json", arguments.json, "report as JSON");
}

// On a terminal, a line that names the last check and the time taken so far, cleared at the end.
// Elsewhere nothing.
class Terminal {
 public:
  void say(const std::string& what) {
    if (!terminal_) return;
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
    std::fprintf(stderr, "\r\033[Kverify: %.1f s: %s", elapsed.count(), what.c_str());
    std::fflush(stderr);
  }
  ~Terminal() {
    if (terminal_) std::fputs("\r\033[K", stderr);
  }

 private:
  bool terminal_ = isatty(STDERR_FILENO) != 0;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

void* allocate(std::size_t size) {
  void* block = std::malloc(size);
  if (block == nullptr) throw std::bad_alloc();
  return block;
}
void* reallocate(void* block, std::size_t, std::size_t size) {
  void* larger = std::realloc(block, size);
  if (larger == nullptr) throw std::bad_alloc();
  return larger;
}
void release(void* block, std::size_t) {
  std::free(block);
}

// One line: the verdict and the first thing that is wrong.
std::string reason(const VerifyReport& report) {
  std::string line = verdict_name(report.verdict);
  for (const OracleReport& oracle : report.oracles) {
    if (oracle.passed()) continue;
    line += ": " + oracle.name;
    if (oracle.undecided) return line + ": " + oracle.notes.back();
    return line + ": " + (oracle.findings.empty() ? "nothing to check" : oracle.findings[0]);
  }
  return line + " by more than declared";
}

// The second kernel reads the record's text once more.
void refuse_pipe(const std::string& path) {
  std::error_code unknown;
  const auto kind = std::filesystem::status(path, unknown).type();
  if (kind != std::filesystem::file_type::fifo && kind != std::filesystem::file_type::character)
    return;
  throw ReadError(path + ": a record is read twice, so it has to be a file");
}

// Empty on success, else why the input bounds no solid.
std::string verify_mesh(const Arguments& arguments, VerifyReport& report) {
  Terminal terminal;
  terminal.say("reading " + arguments.mesh);
  const Polyhedron input = read_surface(arguments.input);
  MeshFile mesh = read_mesh(arguments.mesh);
  if (arguments.envelope > 0) {
    return verify_envelope(input, mesh, arguments.envelope, arguments.options, report);
  }
  delmesher::ExactRecord record;
  VerifyOptions options = arguments.options;
  if (!arguments.exact.empty()) {
    refuse_pipe(arguments.exact);
    record = read_sidecar(arguments.exact, &options.record_version);
  }
  options.sidecar = arguments.exact;
  options.stage = arguments.stage.value_or(stage_of(options.promised, !arguments.exact.empty()));
  terminal.say(std::to_string(mesh.tetrahedra.size()) + " tetrahedra read");
  options.progress = [&](const OracleReport& oracle) {
    terminal.say(oracle.name + ": " + std::to_string(oracle.checked) + " " + oracle.checked_what);
  };
  delmesher::ExactRecord* exact = arguments.exact.empty() ? nullptr : &record;
  return verify(input, mesh, exact, options, report, {&mesh, exact});
}

// Where findings are; what they are of was given up, so it is read again. In the plane there is no
// more to know.
void locate_findings(const Arguments& arguments, VerifyReport& report) {
  const auto has_site = [](const OracleReport& oracle) {
    return std::ranges::any_of(oracle.spots,
                               [](const Spot& spot) { return spot.site.has_value(); });
  };
  const auto is_file = [](const std::string& path) {
    std::error_code unknown;
    return std::filesystem::is_regular_file(path, unknown);
  };
  if (!is_file(arguments.input) || !is_file(arguments.mesh)) return;
  if (std::ranges::none_of(report.oracles, has_site)) return;
  const bool of_surface = arguments.options.promised.task != Task::improve;
  try {
    locate(of_surface ? read_surface(arguments.input) : Polyhedron(), read_mesh(arguments.mesh),
           report);
  } catch (const std::exception&) {
    // The verdict counts without places: there is no memory left, or the files have changed.
  }
}

// The same in the plane.
std::string verify_plane_mesh(const Arguments& arguments, VerifyReport& report) {
  Terminal terminal;
  terminal.say("reading " + arguments.mesh);
  const delmesher::PlanarGraph graph = read_plane_graph(arguments.input);
  const PlaneFile file = read_plane_file(arguments.mesh);
  delmesher::PlaneRecord record;
  PlaneVerifyOptions options;
  options.promised = arguments.options.promised;
  options.declared_deviation = arguments.options.declared_deviation;
  const bool exact = !arguments.exact.empty();
  if (exact) record = read_plane_sidecar(arguments.exact, &options.record_version);
  terminal.say(std::to_string(file.triangles.size()) + " triangles read");
  return verify_plane(graph, file, exact ? &record : nullptr, options, report);
}

// The same for what was improved.
std::string verify_improved_mesh(const Arguments& arguments, VerifyReport& report) {
  Terminal terminal;
  terminal.say("reading " + arguments.mesh);
  const MeshFile given = read_mesh(arguments.input), mesh = read_mesh(arguments.mesh);
  terminal.say(std::to_string(mesh.tetrahedra.size()) + " tetrahedra read");
  return verify_improved(given, mesh, arguments.options, report);
}

// What to do about a mesh that is wrong in nothing but that its surface is another one; else empty.
std::string way_on(const Arguments& arguments, const VerifyReport& report) {
  const bool is_own = arguments.envelope > 0 || arguments.options.promised.tolerance != 0;
  if (is_own || !arguments.exact.empty() || !only_surface_differs(report)) return {};
  const auto near = nearness(read_surface(arguments.input), read_mesh(arguments.mesh));
  if (!near) return {};
  char text[200];
  std::snprintf(text, sizeof text,
                "the surface is another one, at most %.2g away: --envelope %s judges such a mesh\n",
                near->farthest, near->envelope);
  return text;
}

int verify_files(const Arguments& arguments) {
  VerifyReport report;
  const Task task = arguments.options.promised.task;
  const std::string why = task == Task::plane     ? verify_plane_mesh(arguments, report)
                          : task == Task::improve ? verify_improved_mesh(arguments, report)
                                                  : verify_mesh(arguments, report);
  if (!why.empty()) {
    const bool of_edges = why.starts_with("edge ") && task == Task::mesh;
    std::fprintf(stderr, "tetproof: %s: %s%s\n", arguments.input.c_str(), why.c_str(),
                 of_edges ? ", so it bounds no solid; several regions need --promised "
                            "'mesh --regions all'"
                          : "");
    return kInvalid;
  }
  if (arguments.json) locate_findings(arguments, report);
  std::fputs((arguments.json ? to_json(report) : to_text(report)).c_str(), stdout);
  if (!arguments.json && (task == Task::mesh || task == Task::cdt)) {
    std::fputs(way_on(arguments, report).c_str(), stdout);
  }
  const bool bad = arguments.envelope > 0 ? report.verdict == Verdict::broken
                                          : failed(report, arguments.options);
  const int code = bad ? kFailed : report.verdict == Verdict::undecided ? kLimit : kDone;
  // As text, the report has given the reason.
  if (code != kDone && arguments.json) {
    std::fprintf(stderr, "tetproof: %s: %s\n", arguments.mesh.c_str(), reason(report).c_str());
  }
  return code;
}

}  // namespace
}  // namespace tetproof::oracles

namespace tetproof {

void survive_lack_of_memory() {
  mp_set_memory_functions(oracles::allocate, oracles::reallocate, oracles::release);
}

int run_verify(int argc, char** argv) {
  using namespace oracles;
  CLI::App app("Checks a mesh of a surface, or of a planar graph, exactly.", "tetproof verify");
  Arguments arguments;
  declare(app, arguments);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kDone : kUsage;
  }
  if (const std::string why = parse_promise(arguments.promised, arguments.options.promised);
      !why.empty()) {
    std::fprintf(stderr, "tetproof: --promised: %s\n", why.c_str());
    return kUsage;
  }
  // Comparisons with NaN are false.
  if (const double declared = arguments.options.declared_deviation;
      !(declared >= 0 && std::isfinite(declared))) {
    std::fprintf(stderr, "tetproof: --declared-deviation: must be a finite number >= 0, got %g\n",
                 declared);
    return kUsage;
  }
  const Task task = arguments.options.promised.task;
  const bool surface = task == Task::mesh || task == Task::cdt;
  const double envelope = arguments.envelope;
  if (envelope != 0 && !(envelope >= kLeastEnvelope && envelope <= 1)) {
    std::fputs("tetproof: --envelope: must be a fraction from 1e-7 to 1\n", stderr);
    return kUsage;
  }
  if (arguments.envelope > 0 && (!surface || !arguments.exact.empty())) {
    std::fputs("tetproof: --envelope works only for surface meshes without --exact\n", stderr);
    return kUsage;
  }
  if (arguments.options.promised.tolerance != 0 && (envelope > 0 || !arguments.exact.empty())) {
    std::fputs("tetproof: --promised: a tolerance works only without --envelope and --exact\n",
               stderr);
    return kUsage;
  }
  if (task == Task::improve && (arguments.stage || !arguments.exact.empty())) {
    std::fputs("tetproof: an improved mesh has no record and no stages\n", stderr);
    return kUsage;
  }
  if (arguments.stage && task == Task::plane) {
    std::fputs("tetproof: --stage: use --promised 'plane --approximate' in the plane\n", stderr);
    return kUsage;
  }
  return_large_blocks();
  try {
    return verify_files(arguments);
  } catch (const ReadError& error) {
    std::fprintf(stderr, "tetproof: %s\n", error.what());
    return kUnreadable;
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "tetproof: %s: not enough memory\n", arguments.mesh.c_str());
    return kLimit;
  } catch (const std::length_error&) {
    std::fprintf(stderr, "tetproof: %s: more than this machine can number\n",
                 arguments.mesh.c_str());
    return kLimit;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "tetproof: %s: internal error: %s\n", arguments.mesh.c_str(),
                 error.what());
    return kInternal;
  }
}

}  // namespace tetproof
