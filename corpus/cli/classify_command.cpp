#include <fmt/core.h>
#include <unistd.h>

#include <array>
#include <fstream>
#include <map>

#include "corpus/campaigns/campaign.h"
#include "corpus/campaigns/printable.h"
#include "corpus/campaigns/process.h"
#include "corpus/cli/commands.h"
#include "corpus/models/classify.h"
#include "corpus/models/files.h"
#include "reports/csv.h"

namespace tetproof {
namespace {

namespace fs = std::filesystem;

// The decisions of an earlier manifest of this name, by hash.
std::map<std::string, Classification> decided_before(const std::string& output) {
  std::map<std::string, Classification> known;
  if (!fs::exists(output) || fs::path(output).extension() != ".csv") return known;
  for (Classification& c : read_manifest(output)) {
    if (c.validity != Validity::undecided) known.emplace(c.sha256, std::move(c));
  }
  return known;
}

std::map<std::string, std::string> licences_from(const std::string& path) {
  std::map<std::string, std::string> licences;
  if (path.empty()) return licences;
  for (const CsvRecord& record : read_csv(path)) licences[record.at("file")] = record.at("licence");
  return licences;
}

class Manifest {
 public:
  explicit Manifest(const ClassifyArguments& arguments)
      : arguments_(arguments), licences_(licences_from(arguments.licences)) {}

  void add(Classification c) {
    const auto found = licences_.find(c.file);
    if (found != licences_.end()) c.licence = found->second;
    all_.push_back(std::move(c));
  }

  // Called from time to time, so that an end by force loses little.
  void save() const {
    if (!arguments_.output.empty()) write_whole(arguments_.output, text());
  }
  std::string text() const { return arguments_.json ? manifest_json(all_) : manifest_csv(all_); }

  std::string summary() const {
    std::array<std::size_t, 4> counts{};
    for (const Classification& c : all_) ++counts[static_cast<std::size_t>(c.validity)];
    return fmt::format("{} files: {} valid, {} invalid, {} unreadable, {} undecided", all_.size(),
                       counts[0], counts[1], counts[2], counts[3]);
  }

 private:
  const ClassifyArguments& arguments_;
  std::map<std::string, std::string> licences_;
  std::vector<Classification> all_;
};

}  // namespace

int classify_command(const ClassifyArguments& arguments) {
  ModelList list = collect_models({arguments.paths.begin(), arguments.paths.end()});
  if (!arguments.tier.empty()) list.models = tier_of(list.models, tier_from_name(arguments.tier));
  auto known = decided_before(arguments.output);
  Manifest manifest(arguments);
  std::vector<Model> open;
  for (const Model& model : list.models) {
    const auto found = known.find(model.sha256);
    if (found == known.end()) {
      open.push_back(model);
    } else {
      found->second.file = model.name;
      manifest.add(found->second);
    }
  }
  const ScratchFolder scratch("classify");
  ClassifyOptions options;
  options.supervisor = beside_this_program("tetproof-supervise");
  options.delmesher = beside_this_program("delmesher");
  options.scratch = scratch.path();
  options.jobs = std::max(1u, arguments.jobs);
  options.limits.wall_seconds = options.limits.cpu_seconds = arguments.timeout;
  options.limits.memory_bytes = arguments.memory_mebibytes << 20;
  handle_interrupts();
  const bool quiet = arguments.output.empty();
  const bool terminal = isatty(STDERR_FILENO) != 0;
  std::size_t done = list.models.size() - open.size();
  const auto tell = [&](const Classification& c) {
    manifest.add(c);
    if (++done % 100 == 0) manifest.save();
    if (terminal) {
      fmt::print(stderr, "\r\033[K{}/{} {}", done, list.models.size(), printable(c.file));
    } else if (!quiet) {
      fmt::print("[{}/{}] {}: {}{}{}\n", done, list.models.size(), printable(c.file),
                 validity_name(c.validity), c.reason.empty() ? "" : ": ", c.reason);
      std::fflush(stdout);
    }
  };
  classify(open, options, tell);
  if (terminal) fmt::print(stderr, "\r\033[K");
  manifest.save();
  if (quiet) fmt::print("{}", manifest.text());
  if (!quiet) {
    for (const auto& path : list.duplicates) {
      fmt::print("same content as another file, left out: {}\n", printable(path.string()));
    }
    fmt::print("{}{}\n", campaign_interrupted() ? "interrupted; " : "", manifest.summary());
  }
  return campaign_interrupted() ? 130 : 0;
}

}  // namespace tetproof
