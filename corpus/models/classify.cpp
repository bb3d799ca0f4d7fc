#include "corpus/models/classify.h"

#include <fmt/format.h>
#include <poll.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <list>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <tuple>

#include "corpus/campaigns/campaign.h"
#include "corpus/campaigns/disposition.h"
#include "corpus/campaigns/process.h"
#include "reports/csv.h"
#include "reports/table.h"

namespace tetproof {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::array kValidities = {"valid", "invalid", "unreadable", "undecided"};

std::optional<bool> without(const Classification& c, std::initializer_list<const char*> kinds) {
  if (c.validity != Validity::valid && c.validity != Validity::invalid) return std::nullopt;
  // With these defects the check goes no further.
  for (const char* fatal : {"non-finite coordinate", "vertex index out of range", "no triangles"}) {
    if (c.defects.contains(fatal)) return std::nullopt;
  }
  return std::none_of(kinds.begin(), kinds.end(),
                      [&](const char* kind) { return c.defects.contains(kind); });
}

// Runs `delmesher check` on one file.
class Check {
 public:
  Check(const Model& model, const ClassifyOptions& options, fs::path output)
      : output_(std::move(output)), path_(model.path.string()) {
    result_.file = model.name;
    result_.sha256 = model.sha256;
    result_.bytes = model.bytes;
    // Through a shell, because only the end of a child's output is kept.
    process_ = std::make_unique<SupervisedProcess>(
        options.supervisor,
        ProcessSpec{.argv = {"/bin/sh", "-c", "exec \"$0\" check \"$1\" --json > \"$2\"",
                             options.delmesher.string(), model.path.string(), output_.string()},
                    .directory = output_.parent_path(),
                    .limits = options.limits});
  }

  int fd() const { return process_->fd(); }

  // True once decided.
  bool advance() {
    if (!process_->advance()) return false;
    decide(process_->outcome());
    fs::remove(output_);
    return true;
  }

  Classification take() { return std::move(result_); }

 private:
  void decide(const Outcome& outcome) {
    std::ifstream file(output_);
    const Json json = Json::parse(file, nullptr, false);
    const bool exited = outcome.ending == Ending::exited;
    if (exited && json.is_object() && (outcome.exit_code == 0 || outcome.exit_code == 4)) {
      result_.validity = json.value("valid", false) ? Validity::valid : Validity::invalid;
      result_.vertices = json.value("vertices", std::uint64_t{0});
      result_.triangles = json.value("triangles", std::uint64_t{0});
      result_.components = json.value("components", std::uint64_t{0});
      const Json counts = json.value("defect_counts", Json::object());
      for (const auto& [kind, count] : counts.items()) {
        result_.defects[kind] = count.get<std::uint64_t>();
      }
      if (result_.validity == Validity::invalid) result_.reason = json.value("message", "");
    } else if (exited && (outcome.exit_code == 3 || outcome.exit_code == 4)) {
      result_.validity = Validity::unreadable;
      result_.reason = last_line(outcome.stderr_tail);
    } else {
      result_.reason = judge(outcome, ExitCodes::ours).reason;
    }
    // "delmesher: FILE: reason" or "delmesher: FILE:LINE: reason"
    const auto at = result_.reason.find(path_ + ":");
    if (at == std::string::npos) return;
    const std::string rest = result_.reason.substr(at + path_.size() + 1);
    result_.reason = rest.starts_with(" ") ? rest.substr(1) : "line " + rest;
  }

  fs::path output_;
  std::string path_;
  Classification result_;
  std::unique_ptr<SupervisedProcess> process_;
};

std::string text_of(std::optional<bool> value) {
  return value ? (*value ? "yes" : "no") : "";
}

std::string defect_list(const Classification& c) {
  std::string text;
  for (const auto& [kind, count] : c.defects) {
    text += fmt::format("{}{}:{}", text.empty() ? "" : "; ", kind, count);
  }
  return text;
}

void sort_by_file(std::vector<Classification>& all) {
  std::sort(all.begin(), all.end(), [](const Classification& a, const Classification& b) {
    return std::tie(a.file, a.sha256) < std::tie(b.file, b.sha256);
  });
}

std::map<std::string, std::uint64_t> defects_from(const std::string& list) {
  std::map<std::string, std::uint64_t> defects;
  std::istringstream pieces(list);
  for (std::string piece; std::getline(pieces, piece, ';');) {
    const auto colon = piece.rfind(':'), start = piece.find_first_not_of(' ');
    if (colon == std::string::npos || start > colon) continue;
    defects[piece.substr(start, colon - start)] = std::stoull(piece.substr(colon + 1));
  }
  return defects;
}

}  // namespace

std::optional<bool> Classification::closed() const {
  return without(*this, {"open edge"});
}

std::optional<bool> Classification::manifold() const {
  return without(*this, {"non-manifold edge", "non-manifold vertex", "duplicate triangle"});
}

std::optional<bool> Classification::oriented() const {
  return without(*this, {"inconsistent orientation"});
}

std::optional<bool> Classification::self_intersecting() const {
  const auto free = without(*this, {"self-intersection"});
  return free ? std::optional(!*free) : std::nullopt;
}

const char* validity_name(Validity validity) {
  return kValidities[static_cast<std::size_t>(validity)];
}

std::vector<Classification> classify(const std::vector<Model>& models,
                                     const ClassifyOptions& options,
                                     const std::function<void(const Classification&)>& done) {
  std::vector<Classification> results;
  std::list<Check> running;
  std::size_t next = 0;
  fs::create_directories(options.scratch);
  while (!campaign_interrupted() && (next < models.size() || !running.empty())) {
    while (running.size() < options.jobs && next < models.size()) {
      running.emplace_back(models[next], options,
                           options.scratch / (std::to_string(next) + ".json"));
      ++next;
    }
    std::vector<pollfd> fds;
    for (const Check& check : running) fds.push_back({check.fd(), POLLIN, 0});
    poll(fds.data(), fds.size(), 250);
    for (auto it = running.begin(); it != running.end() && !campaign_interrupted();) {
      if (!it->advance()) {
        ++it;
        continue;
      }
      results.push_back(it->take());
      done(results.back());
      it = running.erase(it);
    }
  }
  return results;
}

std::string manifest_csv(std::vector<Classification> all) {
  sort_by_file(all);
  Table table;
  table.header = {"file",    "sha256",  "bytes",  "vertices", "triangles", "components",
                  "licence", "verdict", "closed", "manifold", "oriented",  "self_intersecting",
                  "defects", "reason"};
  const auto number = [](const auto& value) { return value ? std::to_string(*value) : ""; };
  for (const Classification& c : all) {
    table.rows.push_back({c.file, c.sha256, std::to_string(c.bytes), number(c.vertices),
                          number(c.triangles), number(c.components), c.licence,
                          validity_name(c.validity), text_of(c.closed()), text_of(c.manifold()),
                          text_of(c.oriented()), text_of(c.self_intersecting()), defect_list(c),
                          c.reason});
  }
  return to_csv(table);
}

std::string manifest_json(std::vector<Classification> all) {
  sort_by_file(all);
  const auto or_null = [](const auto& value) { return value ? Json(*value) : Json(); };
  std::string text = "[";
  for (const Classification& c : all) {
    const Json json = {{"file", c.file},
                       {"sha256", c.sha256},
                       {"bytes", c.bytes},
                       {"vertices", or_null(c.vertices)},
                       {"triangles", or_null(c.triangles)},
                       {"components", or_null(c.components)},
                       {"licence", c.licence},
                       {"verdict", validity_name(c.validity)},
                       {"closed", or_null(c.closed())},
                       {"manifold", or_null(c.manifold())},
                       {"oriented", or_null(c.oriented())},
                       {"self_intersecting", or_null(c.self_intersecting())},
                       {"defects", c.defects},
                       {"reason", c.reason}};
    text += (text.size() == 1 ? "\n" : ",\n") +
            json.dump(-1, ' ', false, Json::error_handler_t::replace);
  }
  return text + "\n]\n";
}

std::vector<Classification> read_manifest(const fs::path& path) {
  std::vector<Classification> all;
  const auto number = [](const std::string& text) {
    return text.empty() ? std::optional<std::uint64_t>() : std::stoull(text);
  };
  for (const CsvRecord& record : read_csv(path)) {
    Classification c;
    c.file = record.at("file");
    c.sha256 = record.at("sha256");
    c.licence = record.at("licence");
    c.bytes = number(record.at("bytes")).value_or(0);
    const auto found = std::find(kValidities.begin(), kValidities.end(), record.at("verdict"));
    if (found == kValidities.end()) throw std::runtime_error(path.string() + ": no such verdict");
    c.validity = static_cast<Validity>(found - kValidities.begin());
    c.vertices = number(record.at("vertices"));
    c.triangles = number(record.at("triangles"));
    c.components = number(record.at("components"));
    c.defects = defects_from(record.at("defects"));
    c.reason = record.at("reason");
    all.push_back(std::move(c));
  }
  return all;
}

}  // namespace tetproof
