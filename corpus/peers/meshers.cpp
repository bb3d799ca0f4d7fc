#include "corpus/peers/meshers.h"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include "corpus/campaigns/process.h"
#include "corpus/campaigns/shell.h"
#include "corpus/peers/peers.h"
#include "mesher/delmesher/option_table.h"
#include "oracles/base/text_reader.h"
#include "oracles/envelope.h"
#include "reports/sha256.h"

namespace tetproof {
namespace {

namespace fs = std::filesystem;

struct OwnVariant {
  const char* name;
  const char* arguments;
};

// The paper's experiments by their names ("--preset paper" is delta 14.47, tau 1e-4, corners
// below 90 degrees chamfered, empty diametral balls, the surface to the last bit, and everything
// down to the outer box).
constexpr OwnVariant kOwn[] = {
    {"delmesher", "mesh"},
    {"delmesher-e4", "mesh --preset paper"},
    {"safe-delmesher-e4", "mesh --preset paper --slivers off"},
    {"delmesher-nofilter", "mesh --preset paper --tau 0"},
    {"delmesher-nobridges", "mesh --preset paper --simplify-bridges off"},
    {"delmesher-split", "mesh --surface split"},
    {"delmesher-keep", "mesh --surface keep"},
    {"cdt", "cdt --region hull"},
    {"plane", "plane"}};
// One deviation from delmesher-split at a time, towards the paper: of the parameters and of
// section 8.3. Each of the choices of --as-paper is another one.
constexpr OwnVariant kDeviations[] = {
    {"gabriel", "mesh --gabriel"},         {"acute-90", "mesh --acute 90 --corner 90"},
    {"planar-0", "mesh --planar 0"},       {"improve-off", "mesh --improve off --slivers off"},
    {"slivers-off", "mesh --slivers off"}, {"hull", "mesh --region hull"}};

std::vector<std::string> words_of(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

std::string build_id(const fs::path& program) {
  return sha256_of_file(program).substr(0, 12);
}

std::string version_of(const fs::path& program, const MesherPrograms& programs,
                       const char* option = "--version") {
  if (!fs::exists(program)) throw std::runtime_error(program.string() + ": no such program");
  const ProcessSpec spec = {
      .argv = {program.string(), option}, .directory = "/", .limits = {.wall_seconds = 30}};
  const Outcome outcome = run_supervised(programs.supervisor, spec);
  if (outcome.ending != Ending::exited || outcome.exit_code != 0) {
    throw std::runtime_error(program.string() + ": does not tell its version: " + outcome.error +
                             last_line(outcome.stderr_tail));
  }
  const std::string said = last_line(outcome.stdout_tail);
  return (said.empty() ? last_line(outcome.stderr_tail) : said) + " (build " + build_id(program) +
         ")";
}

// What --tolerance is set to; empty without it.
std::string tolerance_of(const std::string& options) {
  constexpr std::string_view kOption = "--tolerance";
  const auto at = options.find(kOption);
  if (at == std::string::npos) return {};
  std::istringstream rest(options.substr(at + kOption.size() + 1));
  std::string value;
  rest >> value;
  return value;
}

Mesher own_mesher(const std::string& name, const std::string& arguments,
                  const MesherPrograms& programs) {
  Mesher mesher;
  mesher.name = name;
  mesher.version = version_of(programs.delmesher, programs);
  mesher.flags = arguments;
  const bool hull = arguments.find("--preset paper") != std::string::npos ||
                    arguments.find("--region hull") != std::string::npos;
  const bool plane = arguments.starts_with("plane");
  mesher.region = plane ? "plane" : hull ? "hull" : "interior";
  mesher.mesh_extension = plane ? ".vtu" : ".mesh";
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
    if (!files.chamfered.empty() && !words.empty() && words.front() == "mesh") {
      argv.insert(argv.end(), {"--save-chamfered", files.chamfered.string()});
    }
    return argv;
  };
  mesher.promised = arguments;
  if (mesher.own_surface()) return mesher;
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

// The names that --as-paper takes.
std::vector<std::string> paper_choices() {
  std::vector<std::string> names;
  for (const std::string& name : delmesher::options::paper_choices<delmesher::Options>()) {
    names.push_back(delmesher::options::argument_name(name));
  }
  return names;
}

// The options of `delmesher+NAME`; empty if nothing is called NAME.
std::string deviation(const std::string& name) {
  for (const OwnVariant& variant : kDeviations) {
    if (name == variant.name) return variant.arguments;
  }
  for (const std::string& choice : paper_choices()) {
    if (name == choice) return "mesh --as-paper " + name;
  }
  return {};
}

void replace_all(std::string& text, const std::string& from, const std::string& to) {
  for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
}

// The program file that a command line begins with; nothing if the line begins otherwise.
std::optional<fs::path> program_of(const std::string& line) {
  const auto words = words_of(line);
  if (words.empty()) return std::nullopt;
  const auto is_program = [](const fs::path& path) {
    return fs::is_regular_file(path) && access(path.c_str(), X_OK) == 0;
  };
  if (words[0].find('/') != std::string::npos) {
    return is_program(words[0]) ? std::optional<fs::path>(words[0]) : std::nullopt;
  }
  const char* path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (is_program(fs::path(folder) / words[0])) return fs::path(folder) / words[0];
  }
  return std::nullopt;
}

// The program that a peer's script runs; nothing if it is not there.
std::optional<fs::path> program_of(const Peer& peer) {
  const char* chosen = std::getenv(peer.variable);
  return program_of(chosen != nullptr && *chosen != 0 ? chosen : peer.program);
}

// "Build options     : ... Netgen ..." on the error stream.
bool has_feature(const Peer& peer, const MesherPrograms& programs) {
  const ProcessSpec spec = {.argv = {program_of(peer).value().string(), "-info"},
                            .directory = "/",
                            .limits = {.wall_seconds = 30}};
  const Outcome outcome = run_supervised(programs.supervisor, spec);
  std::istringstream lines(outcome.stdout_tail + "\n" + outcome.stderr_tail);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("Build options")) continue;
    const std::vector<std::string> words = words_of(line);
    return std::find(words.begin(), words.end(), peer.feature) != words.end();
  }
  return false;
}

// "NAME VERSION" of a peer that is a Python package; empty if the interpreter has no such package.
std::string package_version(const Peer& peer, const MesherPrograms& programs) {
  const ProcessSpec spec = {.argv = {program_of(peer).value().string(),
                                     (programs.adapters / peer.adapter).string(), "--version"},
                            .directory = "/",
                            .limits = {.wall_seconds = 60}};
  const Outcome outcome = run_supervised(programs.supervisor, spec);
  const bool told = outcome.ending == Ending::exited && outcome.exit_code == 0;
  return told ? last_line(outcome.stdout_tail) : "";
}

std::string version_of(const Peer& peer, const MesherPrograms& programs) {
  if (peer.program == nullptr) return version_of(programs.adapters / peer.adapter, programs);
  if (peer.package != nullptr) {
    const fs::path adapter = programs.adapters / peer.adapter;
    return package_version(peer, programs) + " (adapter " + build_id(adapter) + ", contract " +
           build_id(adapter.parent_path() / "contract.py") + ")";
  }
  const fs::path program = program_of(peer).value();
  const std::string said =
      *peer.version_option != 0
          ? peer.program + (" " + version_of(program, programs, peer.version_option))
          : std::string(peer.program) + " (build " + build_id(program) + ")";
  // What the script asks for is a part of what was run.
  return said + " (adapter " + build_id(programs.adapters / peer.adapter) + ")";
}

// The command of a program or a Python script with our contract, or of another script.
std::vector<std::string> peer_command(const Peer& peer, const fs::path& folder,
                                      const RunFiles& files) {
  const std::string adapter = (folder / peer.adapter).string();
  if (peer.program == nullptr) {
    return {adapter, peer.switches, files.input.string(), files.mesh.string(),
            files.stats.string()};
  }
  std::vector<std::string> argv = {"/usr/bin/env", "TETPROOF=" + (folder / "tetproof").string()};
  if (peer.package != nullptr) {
    for (const std::string& word :
         {program_of(peer).value().string(), adapter, std::string(peer.switches),
          files.input.string(), files.mesh.string(), files.stats.string()}) {
      argv.push_back(word);
    }
    return argv;
  }
  argv.insert(argv.end(), {adapter, files.input.string(), files.mesh.string()});
  for (const std::string& word : words_of(peer.switches)) argv.push_back(word);
  return argv;
}

Mesher peer_mesher(const Peer& peer, const MesherPrograms& programs) {
  const std::string missing = why_not_at_hand(peer.name, programs);
  if (!missing.empty()) throw std::runtime_error(std::string(peer.name) + ": " + missing);
  Mesher mesher;
  mesher.name = peer.name;
  mesher.version = version_of(peer, programs);
  mesher.flags = peer.switches;
  mesher.region = peer.region;
  if (mesher.of_plane()) mesher.promised = "plane";
  mesher.declared_deviation = peer.deviation;
  mesher.envelope = peer.envelope;
  mesher.mesh_extension = peer.extension;
  mesher.exit_codes = peer.program == nullptr ? ExitCodes::ours : ExitCodes::unknown;
  mesher.command = [&peer, folder = programs.adapters](const RunFiles& files) {
    return peer_command(peer, folder, files);
  };
  return mesher;
}

// A share of the diagonal; nothing if the text is none.
std::optional<double> share_of(const std::string& text) {
  char* end = nullptr;
  const double share = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != 0 || !(share >= 0 && share <= 1)) return std::nullopt;
  return share;
}

// "key=value" pieces between "cmd" and ':'.
void take_declarations(const std::string& text, Mesher& mesher) {
  std::istringstream pieces(text);
  for (std::string piece; std::getline(pieces, piece, ',');) {
    if (piece.empty()) continue;
    const auto equals = piece.find('=');
    const std::string key = piece.substr(0, equals);
    const std::string value = equals == std::string::npos ? "" : piece.substr(equals + 1);
    const std::optional<double> share = share_of(value);
    if (key == "region" && (value == "hull" || value == "interior" || value == "plane")) {
      mesher.region = value;
      if (mesher.of_plane()) mesher.promised = "plane";
    } else if (key == "deviation" && share) {
      mesher.declared_deviation = *share;
    } else if (key == "envelope" && share && *share >= oracles::kLeastEnvelope) {
      mesher.envelope = *share;
    } else {
      throw std::runtime_error("cmd," + piece +
                               ": region=hull, region=interior, region=plane, "
                               "deviation=FRACTION or envelope=FRACTION (from 1e-7 to 1) is "
                               "expected");
    }
  }
}

// Extensions of the files that `tetproof measure` and `verify` read.
constexpr const char* kMeshExtensions[] = {".mesh", ".msh",  ".vtu", ".node",
                                           ".ele",  ".face", ".tet"};
constexpr const char* kPlaneExtensions[] = {".msh", ".vtu", ".node", ".ele", ".off"};

Mesher command_mesher(const std::string& name, const std::string& text) {
  const auto colon = text.find(':');
  const std::string line = text.substr(colon + 1);
  const auto start = line.find("{out.");
  const auto end = start == std::string::npos ? start : line.find('}', start);
  if (line.find("{in}") == std::string::npos || end == std::string::npos) {
    throw std::runtime_error("cmd:'" + line + "' needs {in} and {out.EXTENSION}");
  }
  Mesher mesher;
  mesher.name = name;
  take_declarations(text.substr(3, colon - 3), mesher);
  const auto program = program_of(line);
  mesher.version = program ? "cmd (build " + build_id(*program) + ")" : "cmd";
  mesher.flags = line;
  mesher.line = line;
  mesher.mesh_extension = line.substr(start + 4, end - start - 4);
  const fs::path plain = oracles::without_gz("mesh" + mesher.mesh_extension);
  const auto known = mesher.of_plane() ? std::span<const char* const>(kPlaneExtensions)
                                       : std::span<const char* const>(kMeshExtensions);
  if (std::ranges::find(known, plain.extension()) == known.end()) {
    std::string message = "{out" + mesher.mesh_extension + "}: one of";
    for (const char* extension : known) message += std::string(" ") + extension;
    throw std::runtime_error(message + " is expected");
  }
  mesher.command = [line, place = line.substr(start, end + 1 - start)](const RunFiles& files) {
    std::string command = line;
    replace_all(command, place, shell_quoted(files.mesh.string()));
    replace_all(command, "{in}", shell_quoted(files.input.string()));
    replace_all(command, "{stats}", shell_quoted(files.stats.string()));
    return std::vector<std::string>{"/bin/sh", "-c", command};
  };
  return mesher;
}

bool is_command(const std::string& text) {
  return text.starts_with("cmd:") ||
         (text.starts_with("cmd,") && text.find(':') != std::string::npos);
}

}  // namespace

std::vector<std::string> Mesher::verify_options() const {
  if (envelope > 0) return {"--envelope", fmt::format("{}", envelope)};
  return {"--declared-deviation", fmt::format("{}", declared_deviation), "--promised", promised};
}

bool Mesher::own_surface() const {
  return envelope > 0 || !tolerance_of(promised).empty();
}

std::string Mesher::promise() const {
  std::ostringstream text;
  if (envelope > 0) {
    text << "envelope " << envelope;
  } else if (declared_deviation > 0) {
    text << "within " << declared_deviation;
  } else if (own_surface()) {
    text << "tolerance " << tolerance_of(promised);
  } else if (promised.starts_with("mesh") && promised.find("--planar 0") == std::string::npos &&
             promised.find("--preset paper") == std::string::npos) {
    text << "planar but for rounding";
  } else {
    text << "exact";
  }
  return text.str();
}

Mesher make_mesher(const std::string& text, const MesherPrograms& programs) {
  for (const OwnVariant& own : kOwn) {
    if (text == own.name) return own_mesher(own.name, own.arguments, programs);
  }
  constexpr std::string_view kPlus = "delmesher+";
  if (text.starts_with(kPlus)) {
    const std::string arguments = deviation(text.substr(kPlus.size()));
    if (!arguments.empty()) return own_mesher(text, arguments, programs);
  }
  if (const Peer* peer = peer_of(text.c_str())) return peer_mesher(*peer, programs);
  if (is_command(text)) return command_mesher(text, text);
  const auto equals = text.find('=');
  if (equals != std::string::npos && equals > 0) {
    const std::string name = text.substr(0, equals), rest = text.substr(equals + 1);
    // Its rows would be taken for those of the mesher that is known by it.
    const std::vector<std::string> known = mesher_names();
    if (std::find(known.begin(), known.end(), name) != known.end() ||
        name.starts_with("delmesher+")) {
      throw std::runtime_error(name +
                               " is a mesher that is known by name: call this one otherwise");
    }
    if (is_command(rest)) return command_mesher(name, rest);
    if (rest.starts_with("delmesher:")) return own_mesher(name, rest.substr(10), programs);
  }
  throw std::runtime_error("unknown mesher: " + text);
}

std::vector<std::string> mesher_names() {
  std::vector<std::string> names;
  for (const OwnVariant& own : kOwn) names.emplace_back(own.name);
  for (const Peer& peer : peers()) names.emplace_back(peer.name);
  return names;
}

std::string why_not_at_hand(const std::string& name, const MesherPrograms& programs) {
  const Peer* peer = peer_of(name.c_str());
  if (peer == nullptr) return "no peer has this name";
  const fs::path adapter = programs.adapters / peer->adapter;
  if (!fs::exists(adapter)) {
    return adapter.filename().string() + " is missing; it is built where the library is (" +
           peer->from + ")";
  }
  if (peer->program != nullptr && !program_of(*peer)) {
    return std::string(peer->program) + " is neither on the PATH nor named by $" + peer->variable +
           " (" + peer->from + ")";
  }
  if (peer->package != nullptr && package_version(*peer, programs).empty()) {
    return "python3 (or $" + std::string(peer->variable) + ") has no package " + peer->package +
           "; ci/campaigns/peers makes an environment that has it";
  }
  if (peer->feature != nullptr && !has_feature(*peer, programs)) {
    return std::string("this build of ") + peer->program + " is without " + peer->feature;
  }
  return "";
}

std::vector<std::string> ablation_names() {
  std::vector<std::string> names = {"delmesher-split"};
  for (const OwnVariant& variant : kDeviations) {
    names.push_back(std::string("delmesher+") + variant.name);
  }
  for (const std::string& choice : paper_choices()) names.push_back("delmesher+" + choice);
  names.emplace_back("delmesher-e4");
  return names;
}

}  // namespace tetproof
