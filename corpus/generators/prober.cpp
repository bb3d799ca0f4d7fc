// One supervised run of a mesher on a surface, and what kind of failure it was.
#include <fmt/core.h>
#include <poll.h>

#include <algorithm>
#include <fstream>
#include <future>
#include <mutex>
#include <nlohmann/json.hpp>
#include <regex>

#include "corpus/campaigns/process.h"
#include "corpus/generators/generate.h"
#include "corpus/generators/shrink.h"

namespace tetproof {
namespace {

namespace fs = std::filesystem;

// Paths, numbers and addresses change with the input, with sign, point and exponent.
std::string without_numbers(const std::string& text, const fs::path& folder) {
  std::string plain = text;
  for (auto at = plain.find(folder.string()); at != std::string::npos;
       at = plain.find(folder.string(), at)) {
    plain.erase(at, folder.string().size());
  }
  static const std::regex number("-?[0-9]+([.][0-9]+)?(e[-+]?[0-9]+)?");
  return std::regex_replace(plain, number, "#");
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

Outcome run_until(const fs::path& supervisor, const ProcessSpec& spec,
                  const std::function<bool()>& given_up) {
  constexpr int kMilliseconds = 50;
  SupervisedProcess process(supervisor, spec);
  while (!process.advance()) {
    pollfd wait{process.fd(), POLLIN, 0};
    poll(&wait, 1, kMilliseconds);
    if (given_up()) process.stop();
  }
  return process.outcome();
}

}  // namespace

Probe Prober::probe(const delmesher::Surface& surface) const {
  const std::atomic<bool> never = false;
  return probe(surface, never);
}

Probe Prober::probe(const delmesher::Surface& surface, const std::atomic<bool>& given_up) const {
  const RunFiles files = {folder / "input.off", folder / ("mesh" + mesher.mesh_extension),
                          folder / "stats.json"};
  const fs::path verdict = folder / "verdict.json";
  for (const fs::path& old : {files.mesh, files.stats, verdict}) fs::remove(old);
  std::ofstream(files.input, std::ios::binary) << to_off(surface);
  const auto ends = [&] { return given_up || stop(); };
  const Outcome outcome = run_until(supervisor, {mesher.command(files), folder, limits}, ends);
  const auto ended = [&](const Failure& failure) { return Probe{failure, outcome.cpu_seconds}; };
  const Judgement judgement = judge(outcome, mesher.exit_codes);
  const std::string name = disposition_name(judgement.disposition);
  // At a limit the last words differ each time.
  if (judgement.disposition == Disposition::timeout ||
      judgement.disposition == Disposition::out_of_memory) {
    return ended(name);
  }
  if (judgement.disposition != Disposition::ok) {
    return ended(name + ": " + without_numbers(judgement.reason, folder));
  }
  if (!fs::exists(files.mesh)) return ended("wrong-result: no mesh");
  if (!verify || ends()) return ended({});
  // Through a shell, because only the end of a child's output is kept.
  std::vector<std::string> argv = {"/bin/sh",
                                   "-c",
                                   R"(out=$1; shift; exec "$0" verify "$@" --json > "$out")",
                                   self.string(),
                                   verdict.string(),
                                   files.input.string(),
                                   files.mesh.string()};
  for (const std::string& word : mesher.verify_options()) argv.push_back(word);
  const Outcome checked = run_until(supervisor, {argv, folder, {.wall_seconds = 300}}, ends);
  if (checked.ending != Ending::exited || checked.exit_code != 1) return ended({});
  return ended("wrong-result: " + failed_oracles(verdict));
}

SideBySide::SideBySide(const Prober& prober, const Probe& first)
    : prober_(prober), wanted_(first.failure), limits_(prober.limits) {
  follow(first.cpu_seconds);
}

void SideBySide::follow(double cpu_seconds) {
  constexpr double kSlack = 3, kLeast = 1;  // times as long; seconds
  if (wanted_ == disposition_name(Disposition::timeout)) return;
  limits_.cpu_seconds = std::min(limits_.cpu_seconds, std::max(kLeast, kSlack * cpu_seconds));
}

std::optional<std::size_t> SideBySide::operator()(const std::vector<delmesher::Surface>& surfaces) {
  std::atomic<bool> given_up = false;
  std::optional<std::size_t> found;
  double seconds = 0;
  std::mutex mutex;
  const auto judge_one = [&](std::size_t i) {
    Prober prober = prober_;
    prober.folder /= std::to_string(i);
    prober.limits = limits_;
    fs::create_directories(prober.folder);
    const Probe probe = prober.probe(surfaces[i], given_up);
    const std::lock_guard lock(mutex);
    if (given_up || prober.stop() || probe.failure != wanted_) return;
    given_up = true;
    found = i;
    seconds = probe.cpu_seconds;
  };
  std::vector<std::future<void>> judges;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    judges.push_back(std::async(std::launch::async, judge_one, i));
  }
  for (std::future<void>& judge : judges) judge.get();
  if (found) follow(seconds);
  return found;
}

}  // namespace tetproof
