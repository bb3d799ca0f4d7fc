#include "corpus/meshers.h"

#include <sstream>
#include <stdexcept>

#include "corpus/process.h"
#include "corpus/sha256.h"

namespace tetproof {
namespace {

namespace fs = std::filesystem;

struct OwnVariant {
  const char* name;
  const char* arguments;
};

// The paper's experiments by their names (design: "--preset paper" is delta 14.47, tau 1e-4,
// corners below 90 degrees chamfered, and everything down to the outer box).
constexpr OwnVariant kOwn[] = {{"delmesher", "mesh"},
                               {"delmesher-e4", "mesh --preset paper"},
                               {"safe-delmesher-e4", "mesh --preset paper --slivers off"},
                               {"delmesher-nofilter", "mesh --preset paper --tau 0"},
                               {"cdt", "cdt --region hull"}};
constexpr OwnVariant kTetgen[] = {{"tetgen", "zpcq"}, {"tetgen-T0", "zpcqT0"}};

std::vector<std::string> words_of(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

std::string build_id(const fs::path& program) {
  return sha256_of_file(program).substr(0, 12);
}

std::string version_of(const fs::path& program, const MesherPrograms& programs) {
  if (!fs::exists(program)) throw std::runtime_error(program.string() + ": no such program");
  const ProcessSpec spec = {
      .argv = {program.string(), "--version"}, .directory = "/", .limits = {.wall_seconds = 30}};
  const Outcome outcome = run_supervised(programs.supervisor, spec);
  if (outcome.ending != Ending::exited || outcome.exit_code != 0) {
    throw std::runtime_error(program.string() + ": does not tell its version: " + outcome.error +
                             last_line(outcome.stderr_tail));
  }
  return last_line(outcome.stdout_tail) + " (build " + build_id(program) + ")";
}

Mesher own_mesher(const std::string& name, const std::string& arguments,
                  const MesherPrograms& programs) {
  Mesher mesher;
  mesher.name = name;
  mesher.version = version_of(programs.delmesher, programs);
  mesher.flags = arguments;
  const bool hull = arguments.find("--preset paper") != std::string::npos ||
                    arguments.find("--region hull") != std::string::npos;
  mesher.region = hull ? "hull" : "interior";
  mesher.mesh_extension = ".mesh";
  mesher.exit_codes = ExitCodes::ours;
  mesher.command = [program = programs.delmesher.string(),
                    words = words_of(arguments)](const RunFiles& files) {
    std::vector<std::string> argv = {program};
    argv.insert(argv.end(), words.begin(), words.end());
    for (const std::string& word :
         {files.input.string(), std::string("-o"), files.mesh.string(), std::string("--stats"),
          files.stats.string(), std::string("-q")}) {
      argv.push_back(word);
    }
    return argv;
  };
  mesher.sidecar_command = [program = programs.delmesher.string(),
                            words = words_of(arguments)](const RunFiles& files) {
    std::vector<std::string> argv = {program};
    argv.insert(argv.end(), words.begin(), words.end());
    argv.insert(argv.end(), {files.input.string(), "-o", files.again.string(), "--exact",
                             files.exact.string(), "-q"});
    return argv;
  };
  return mesher;
}

Mesher tetgen_mesher(const std::string& name, const std::string& switches,
                     const MesherPrograms& programs) {
  if (!fs::exists(programs.tetgen)) {
    throw std::runtime_error(name + ": " + programs.tetgen.string() +
                             " is missing; it is built where TetGen (libtet1.5-dev) is installed");
  }
  Mesher mesher;
  mesher.name = name;
  mesher.version = version_of(programs.tetgen, programs);
  mesher.flags = switches;
  mesher.region = switches.find('c') != std::string::npos ? "hull" : "interior";
  // Without T0 TetGen may move the surface by its default tolerance.
  mesher.declared_deviation = switches.find("T0") != std::string::npos ? 0 : 1e-8;
  mesher.mesh_extension = ".mesh";
  mesher.exit_codes = ExitCodes::ours;
  mesher.command = [program = programs.tetgen.string(), switches](const RunFiles& files) {
    return std::vector<std::string>{program, switches, files.input.string(), files.mesh.string(),
                                    files.stats.string()};
  };
  return mesher;
}

// For a shell, in single quotes.
std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) {
    if (c == '\'') {
      result += "'\\''";
    } else {
      result += c;
    }
  }
  return result + "'";
}

void replace_all(std::string& text, const std::string& from, const std::string& to) {
  for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
}

Mesher command_mesher(const std::string& name, const std::string& line) {
  const auto start = line.find("{out.");
  const auto end = start == std::string::npos ? start : line.find('}', start);
  if (line.find("{in}") == std::string::npos || end == std::string::npos) {
    throw std::runtime_error("cmd:'" + line + "' needs {in} and {out.EXTENSION}");
  }
  Mesher mesher;
  mesher.name = name;
  mesher.version = "cmd";
  mesher.flags = line;
  mesher.mesh_extension = line.substr(start + 4, end - start - 4);
  mesher.command = [line, place = line.substr(start, end + 1 - start)](const RunFiles& files) {
    std::string text = line;
    replace_all(text, place, quoted(files.mesh.string()));
    replace_all(text, "{in}", quoted(files.input.string()));
    replace_all(text, "{stats}", quoted(files.stats.string()));
    return std::vector<std::string>{"/bin/sh", "-c", text};
  };
  return mesher;
}

}  // namespace

Mesher make_mesher(const std::string& text, const MesherPrograms& programs) {
  for (const OwnVariant& own : kOwn) {
    if (text == own.name) return own_mesher(own.name, own.arguments, programs);
  }
  for (const OwnVariant& tetgen : kTetgen) {
    if (text == tetgen.name) return tetgen_mesher(tetgen.name, tetgen.arguments, programs);
  }
  if (text.starts_with("cmd:")) return command_mesher(text, text.substr(4));
  const auto equals = text.find('=');
  if (equals != std::string::npos && equals > 0) {
    const std::string name = text.substr(0, equals), rest = text.substr(equals + 1);
    if (rest.starts_with("cmd:")) return command_mesher(name, rest.substr(4));
    if (rest.starts_with("delmesher:")) return own_mesher(name, rest.substr(10), programs);
  }
  throw std::runtime_error("unknown mesher: " + text);
}

std::vector<std::string> mesher_names() {
  std::vector<std::string> names;
  for (const OwnVariant& own : kOwn) names.emplace_back(own.name);
  for (const OwnVariant& tetgen : kTetgen) names.emplace_back(tetgen.name);
  return names;
}

}  // namespace tetproof
