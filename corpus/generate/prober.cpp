// One supervised run of a mesher on a surface, and what kind of failure it was.
#include <cctype>
#include <fstream>
#include <nlohmann/json.hpp>

#include "corpus/generate/generate.h"
#include "corpus/generate/shrink.h"
#include "corpus/process.h"

namespace tetproof {
namespace {

namespace fs = std::filesystem;

// Paths, numbers and addresses change with the input.
std::string without_numbers(const std::string& text, const fs::path& folder) {
  std::string plain = text;
  for (auto at = plain.find(folder.string()); at != std::string::npos;
       at = plain.find(folder.string(), at)) {
    plain.erase(at, folder.string().size());
  }
  std::string result;
  for (const char c : plain) {
    const bool digit = std::isdigit(static_cast<unsigned char>(c)) != 0;
    if (!digit) {
      result += c;
    } else if (result.empty() || result.back() != '#') {
      result += '#';
    }
  }
  return result;
}

// Names of the oracles that failed.
std::string failed_oracles(const fs::path& verdict) {
  std::ifstream in(verdict);
  const auto json = nlohmann::json::parse(in, nullptr, false);
  if (json.is_discarded()) return "no verdict";
  std::string names;
  for (const auto& oracle : json.value("oracles", nlohmann::json::array())) {
    if (oracle.value("violations", 0) > 0) names += " " + oracle.value("name", std::string());
  }
  return json.value("verdict", std::string("unknown")) + names;
}

}  // namespace

Failure Prober::failure(const delmesher::Surface& surface) const {
  const RunFiles files = {folder / "input.off", folder / ("mesh" + mesher.mesh_extension),
                          folder / "stats.json"};
  const fs::path verdict = folder / "verdict.json";
  for (const fs::path& old : {files.mesh, files.stats, verdict}) fs::remove(old);
  std::ofstream(files.input, std::ios::binary) << to_off(surface);
  const Outcome outcome = run_supervised(supervisor, {mesher.command(files), folder, limits});
  const Judgement judgement = judge(outcome, mesher.exit_codes);
  const std::string name = disposition_name(judgement.disposition);
  // At a limit the last words differ each time.
  if (judgement.disposition == Disposition::timeout ||
      judgement.disposition == Disposition::out_of_memory) {
    return name;
  }
  if (judgement.disposition != Disposition::ok) {
    return name + ": " + without_numbers(judgement.reason, folder);
  }
  if (!fs::exists(files.mesh)) return "wrong-result: no mesh";
  if (!verify) return {};
  const Outcome checked = run_supervised(
      supervisor, {{"/bin/sh", "-c",
                    "exec \"$0\" verify \"$1\" \"$2\" --declared-deviation 1e-8 --promised \"$4\" "
                    "--json > \"$3\"",
                    self.string(), files.input.string(), files.mesh.string(), verdict.string(),
                    mesher.promised()},
                   folder,
                   {.wall_seconds = 300}});
  if (checked.ending != Ending::exited || checked.exit_code != 1) return {};
  return "wrong-result: " + failed_oracles(verdict);
}

}  // namespace tetproof
