#include "corpus/campaigns/campaign.h"

#include <poll.h>
#include <signal.h>
#include <unistd.h>

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <ctime>
#include <fstream>
#include <list>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "corpus/campaigns/process.h"
#include "corpus/campaigns/progress.h"
#include "corpus/campaigns/runnable.h"
#include "corpus/campaigns/shell.h"
#include "reports/sha256.h"

namespace tetproof {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

using Clock = std::chrono::steady_clock;

volatile sig_atomic_t interrupted = 0;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::vector<std::string> names_of(const std::vector<Mesher>& meshers) {
  std::vector<std::string> names;
  for (const Mesher& mesher : meshers) names.push_back(mesher.name);
  return names;
}

std::string read_if_there(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string json_if_valid(const fs::path& path) {
  const std::string text = read_if_there(path);
  return Json::accept(text) ? text : "";
}

std::string now() {
  const std::time_t time = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&time, &utc);
  std::array<char, 32> text;
  std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text.data();
}

std::string host_name() {
  std::array<char, 256> name{};
  gethostname(name.data(), name.size() - 1);
  return name.data();
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) {
    const bool plain =
        !word.empty() && word.find_first_of(" \t\n'\"\\$&|;<>(){}*?#~`") == std::string::npos;
    text += (text.empty() ? "" : " ") + (plain ? word : shell_quoted(word));
  }
  return text;
}

bool is_file(const fs::path& path) {
  std::error_code none;
  return fs::is_regular_file(path, none);
}

// Is the file still what was to be run?
bool unchanged(const Model& model) {
  try {
    return is_file(model.path) && sha256_of_file(model.path) == model.sha256;
  } catch (const std::runtime_error&) {
    return false;  // gone meanwhile
  }
}

bool same_bytes(const fs::path& a, const fs::path& b) {
  return is_file(b) && fs::file_size(a) == fs::file_size(b) && read_if_there(a) == read_if_there(b);
}

std::string without(const fs::path& folder, std::string text) {
  const std::string prefix = folder.string() + "/";
  for (auto at = text.find(prefix); at != std::string::npos; at = text.find(prefix, at)) {
    text.erase(at, prefix.size());
  }
  return text;
}

// Why a verifier did not come to a verdict. The limit that it reached is given with its size, to
// show whether a larger one might help.
std::string why_unfinished(const Outcome& outcome, const Limits& limits) {
  const std::string reason = judge(outcome, ExitCodes::ours).reason;
  std::ostringstream text;
  switch (outcome.ending) {
    case Ending::wall_limit:
      text << reason << " of " << limits.wall_seconds << " s";
      break;
    case Ending::cpu_limit:
      text << reason << " of " << limits.cpu_seconds << " s";
      break;
    case Ending::memory_limit:
      text << reason << " of " << (limits.memory_bytes >> 20) << " MiB";
      break;
    case Ending::exited:
      text << (outcome.exit_code == 0 ? "no report" : reason);
      break;
    default:
      text << reason;
  }
  return text.str();
}

// Where edges of the input are less than roundings apart, the positions in a file do not tell to
// which of them a mesh edge belongs. A record does, and it is checked like anything else.
bool record_may_tell(int exit_code, const std::string& verdict_json) {
  constexpr int kUndecided = 5;
  if (exit_code == kUndecided) return true;
  if (exit_code != 1) return false;
  for (const Json& oracle : Json::parse(verdict_json).value("oracles", Json::array())) {
    if (oracle.value("name", "") == "conformity") return !oracle.value("passed", false);
  }
  return false;
}

// Does the disposition say nothing about the mesher? With more time or memory it might have ended
// otherwise.
bool is_limit(Disposition disposition) {
  return disposition == Disposition::timeout || disposition == Disposition::out_of_memory ||
         disposition == Disposition::killed;
}

// A mesher's name may be a command.
std::string file_name_of(std::string name) {
  for (char& c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '-' && c != '.') c = '_';
  }
  return name.substr(0, 60);
}

// One model with one mesher: mesh, then measure, then perhaps write a sidecar, then verify, each in
// a child of its own.
class Job {
 public:
  Job(const Model& model, const Mesher& mesher, RunRow row, fs::path folder,
      const CampaignOptions& options)
      : model_(model),
        mesher_(mesher),
        options_(options),
        folder_(std::move(folder)),
        row_(std::move(row)) {
    fs::create_directories(folder_);
    files_ = {model.path, folder_ / ("mesh" + mesher.mesh_extension), folder_ / "stats.json",
              folder_ / ("again" + mesher.mesh_extension), folder_ / "exact.txt"};
    if (!options.keep.empty()) files_.chamfered = folder_ / "mesh.chamfered.off";
    const auto argv = mesher.command(files_);
    row_.command = without(folder_, joined(argv));
    row_.started = now();
    start(argv, options.limits);
  }
  Job(const Job&) = delete;
  Job& operator=(const Job&) = delete;
  ~Job() {
    process_.reset();
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }

  int fd() const { return process_->fd(); }
  const RunRow& row() const { return row_; }
  const Model& model() const { return model_; }
  const Mesher& mesher() const { return mesher_; }
  // Was there a program at all?
  bool cannot_run() const { return cannot_run_; }
  double seconds() const { return seconds_since(begin_); }

  // True once the row is complete.
  bool advance() {
    while (process_->advance()) {
      if (!after(step_)) {
        demand_verdict(row_);
        return true;
      }
      step_ = static_cast<Step>(static_cast<int>(step_) + 1);
    }
    return false;
  }

 private:
  enum class Step : std::uint8_t { mesh, measure, sidecar, verify, picture };

  void start(const std::vector<std::string>& argv, const Limits& limits) {
    process_ = std::make_unique<SupervisedProcess>(
        options_.supervisor, ProcessSpec{.argv = argv, .directory = folder_, .limits = limits});
  }

  // These return whether a further step has been started.
  bool after(Step step) {
    switch (step) {
      case Step::mesh:
        return after_mesh();
      case Step::measure:
        return after_measure();
      case Step::sidecar:
        return after_sidecar();
      case Step::verify:
        return after_verify();
      case Step::picture:
        return after_picture();
    }
    return false;
  }

  bool after_mesh() {
    const Outcome& outcome = process_->outcome();
    cannot_run_ = tetproof::cannot_run(outcome, mesher_.exit_codes, !mesher_.line.empty());
    const Judgement judgement = judge(outcome, mesher_.exit_codes);
    row_.disposition = judgement.disposition;
    row_.reason = without_folder(judgement.reason);
    if (outcome.ending == Ending::exited) row_.exit_code = outcome.exit_code;
    if (outcome.ending == Ending::signalled) row_.signal = outcome.signal;
    row_.wall_seconds = outcome.wall_seconds;
    row_.cpu_seconds = outcome.cpu_seconds;
    row_.peak_rss_bytes = outcome.peak_rss_bytes;
    row_.stderr_tail = outcome.stderr_tail;
    row_.stdout_tail = outcome.stdout_tail;
    row_.stats_json = json_if_valid(files_.stats);
    row_.mesh_seconds = mesh_seconds(row_.stats_json);
    row_.refined = mesh_columns(row_.stats_json, "refined");
    if (!judgement.mesh_expected) return false;
    if (!is_file(files_.mesh)) {
      wrong("no mesh was written");
      return false;
    }
    std::vector<std::string> argv = {options_.self.string(), "measure", files_.mesh.string(), "-o",
                                     measured().string()};
    if (mesher_.of_plane()) argv.emplace_back("--plane");
    if (options_.solver) argv.emplace_back("--solver");
    start(argv, options_.verify_limits);
    return true;
  }

  bool after_measure() {
    row_.mesh_json = json_if_valid(measured());
    const Outcome& outcome = process_->outcome();
    if (row_.mesh_json.empty()) {
      const std::string why = without_folder(why_unfinished(outcome, options_.verify_limits));
      if (judge(outcome, ExitCodes::ours).disposition == Disposition::rejected) {
        wrong("the mesh cannot be measured: " + why);
      } else {
        row_.verdict_json = Json({{"error", "not measured: " + why}}).dump();
      }
      return false;
    }
    take_measurements();
    keep_mesh();
    if (!options_.verify) return false;
    if (sidecar_wanted_) {
      start(mesher_.sidecar_command(files_), options_.verify_limits);
      return true;
    }
    step_ = Step::sidecar;
    return after_sidecar();
  }

  // Starts the oracles, whether there is a sidecar or not.
  bool after_sidecar() {
    if (sidecar_wanted_ && !is_file(files_.exact)) {
      const Judgement judgement = judge(process_->outcome(), mesher_.exit_codes);
      const std::string reason = without_folder(judgement.reason);
      if (is_limit(judgement.disposition)) {
        no_sidecar_ = reason;
      } else {
        wrong("no sidecar: " + reason);
      }
    } else if (sidecar_wanted_ && !same_bytes(files_.mesh, files_.again)) {
      wrong("a second run wrote another mesh");
    }
    // Through a shell, because only the end of a child's output is kept.
    std::vector<std::string> argv = {"/bin/sh",
                                     "-c",
                                     R"(out=$1; shift; exec "$0" verify "$@" --json > "$out")",
                                     options_.self.string(),
                                     verdict().string(),
                                     files_.input.string(),
                                     files_.mesh.string()};
    for (const std::string& word : mesher_.verify_options()) argv.push_back(word);
    if (is_file(files_.exact)) argv.insert(argv.end(), {"--exact", files_.exact.string()});
    start(argv, options_.verify_limits);
    return true;
  }

  bool after_verify() {
    const Outcome& outcome = process_->outcome();
    row_.verify_seconds = row_.verify_seconds.value_or(0) + outcome.wall_seconds;
    row_.verdict_json = json_if_valid(verdict());
    const bool told = outcome.ending == Ending::exited && !row_.verdict_json.empty();
    if (told && !sidecar_wanted_ && mesher_.sidecar_command &&
        record_may_tell(outcome.exit_code, row_.verdict_json)) {
      sidecar_wanted_ = true;
      step_ = Step::measure;
      start(mesher_.sidecar_command(files_), options_.verify_limits);
      return true;
    }
    const bool is_wrong = told && outcome.exit_code == 1;
    if (is_wrong) {
      const std::string said = last_line(outcome.stderr_tail);
      const std::string prefix = "tetproof: " + files_.mesh.string() + ": ";
      wrong("verify: " + (said.starts_with(prefix) ? said.substr(prefix.size()) : said));
    } else if (!told || outcome.exit_code != 0) {
      // This is not the mesher's fault, but no oracle vouches for the mesh: the row becomes
      // unverified.
      const std::string reason = without_folder(why_unfinished(outcome, options_.verify_limits));
      row_.verdict_json = Json({{"error", reason}}).dump();
    }
    if (!no_sidecar_.empty()) {
      Json verdict = Json::parse(row_.verdict_json);
      verdict["no_sidecar"] = no_sidecar_;
      row_.verdict_json = verdict.dump();
    }
    const bool is_drawn = is_wrong && !mesher_.of_plane();
    if (is_drawn) start_picture();
    return is_drawn;
  }

  // A picture of the place that an oracle names. The verdict is as good without it.
  void start_picture() {
    std::vector<std::string> argv = {
        options_.self.string(), "picture", files_.input.string(), files_.mesh.string(), "--verdict",
        verdict().string(),     "-o",      picture().string()};
    if (mesher_.own_surface()) argv.emplace_back("--own-surface");
    start(argv, options_.verify_limits);
  }

  bool after_picture() {
    const std::string svg = read_if_there(picture());
    if (!svg.empty()) {
      Json verdict = Json::parse(row_.verdict_json);
      verdict["picture"] = svg;
      row_.verdict_json = verdict.dump();
    }
    return false;
  }

  fs::path measured() const { return folder_ / "measured.json"; }
  fs::path verdict() const { return folder_ / "verdict.json"; }
  fs::path picture() const { return folder_ / "picture.svg"; }

  void wrong(const std::string& reason) {
    row_.disposition = Disposition::wrong_result;
    row_.reason += (row_.reason.empty() ? "" : "; ") + without_folder(reason);
  }

  // Reasons must not differ between two runs of the same model by the folders of the run or the
  // model.
  std::string without_folder(std::string text) const {
    return without(model_.path.parent_path(), without(folder_, std::move(text)));
  }

  // Wrong results are found here, never by exit status alone.
  void take_measurements() {
    const Json json = Json::parse(row_.mesh_json);
    row_.mesh = mesh_columns(row_.mesh_json, "");
    row_.inside = mesh_columns(row_.mesh_json, "inside");
    row_.inverted = json.at("inverted").get<std::uint64_t>();
    row_.flat = json.at("flat").get<std::uint64_t>();
    const auto crowded = json.at("crowded_faces").get<std::uint64_t>();
    const bool plane = mesher_.of_plane();
    const std::string cells = plane ? "triangles" : "tetrahedra", sides = plane ? "edges" : "faces";
    if (row_.mesh->tetrahedra == 0) wrong("no " + cells);
    if (*row_.inverted > 0) wrong(std::to_string(*row_.inverted) + " inverted " + cells);
    if (crowded > 0) wrong(std::to_string(crowded) + " " + sides + " of more than two " + cells);
  }

  // The mesh, files that belong to it (.ele, .face), and the chamfered surface. The name holds
  // digits of the hash, since models in different folders may have the same name.
  void keep_mesh() {
    if (options_.keep.empty()) return;
    const std::uint64_t bound = options_.keep_tetrahedra;
    if (bound > 0 && row_.mesh->tetrahedra > bound) return;
    const fs::path stem = options_.keep / file_name_of(mesher_.name) /
                          (model_.name + "-" + model_.sha256.substr(0, 8));
    fs::create_directories(stem.parent_path());
    for (const auto& entry : fs::directory_iterator(folder_)) {
      const std::string name = entry.path().filename().string();
      if (!name.starts_with("mesh.")) continue;
      fs::copy_file(entry.path(), stem.string() + name.substr(4),
                    fs::copy_options::overwrite_existing);
    }
    row_.mesh_path = fs::absolute(stem.string() + mesher_.mesh_extension).lexically_normal();
  }

  const Model& model_;
  const Mesher& mesher_;
  const CampaignOptions& options_;
  fs::path folder_;
  RunFiles files_;
  RunRow row_;
  Step step_ = Step::mesh;
  bool cannot_run_ = false;
  bool sidecar_wanted_ = options_.verify && options_.sidecars && mesher_.sidecar_command;
  Clock::time_point begin_ = Clock::now();
  std::string no_sidecar_;  // the limit that kept the second run from writing one
  std::unique_ptr<SupervisedProcess> process_;
};

class Campaign {
 public:
  Campaign(const std::vector<Model>& models, const std::vector<Mesher>& meshers,
           const CampaignOptions& options)
      : models_(models),
        meshers_(meshers),
        options_(options),
        database_(options.database, ResultsDatabase::Mode::write),
        scratch_(fs::absolute(options.database).string() + ".scratch"),
        progress_(names_of(meshers), models.size(), options.jobs, options.terminal) {
    // The lock on the database makes this folder ours. Its contents were left by a killed run,
    // whose last child may still be about to be killed; so this run uses a folder of its own in it.
    std::error_code ignored;
    fs::remove_all(scratch_, ignored);
    for (const Mesher& mesher : meshers) summary_.meshers.push_back({.mesher = mesher.name});
  }
  Campaign(const Campaign&) = delete;
  Campaign& operator=(const Campaign&) = delete;
  ~Campaign() {
    running_.clear();
    std::error_code ignored;
    fs::remove_all(scratch_, ignored);
  }

  CampaignSummary run() {
    probe_meshers();
    const fs::path own = scratch_ / std::to_string(getpid());
    fs::create_directories(own);
    while (interrupted == 0 && (start_jobs(own) || !running_.empty())) {
      wait();
      collect();
      show_progress();
    }
    summary_.interrupted = interrupted != 0;
    summary_.elapsed_seconds = seconds_since(start_);
    running_.clear();
    progress_.finish();
    return summary_;
  }

 private:
  // A program that does not exist would refuse every model.
  void probe_meshers() const {
    for (const Mesher& mesher : meshers_) {
      const std::string why = why_not_runnable(mesher.line, options_.supervisor);
      if (!why.empty()) throw CannotRun(mesher.name + ": " + why);
    }
  }

  MesherCount& count_of(const std::string& mesher) {
    return *std::find_if(summary_.meshers.begin(), summary_.meshers.end(),
                         [&](const MesherCount& count) { return count.mesher == mesher; });
  }

  // Fills the free places; false when there is nothing left to start.
  bool start_jobs(const fs::path& folder) {
    while (running_.size() < options_.jobs && next_ < models_.size() * meshers_.size()) {
      if (next_ % meshers_.size() == 0 && out_of_time()) {
        summary_.models_left_out = models_.size() - next_ / meshers_.size();
        next_ = models_.size() * meshers_.size();
        break;
      }
      const Model& model = models_[next_ / meshers_.size()];
      const Mesher& mesher = meshers_[next_ % meshers_.size()];
      RunRow row;
      row.key = {model.sha256, mesher.name, mesher.version, mesher.flags,
                 describe(options_.limits)};
      const auto present = database_.find(row.key);
      if (present && !options_.retry.contains(present->disposition)) {
        ++summary_.present;
        count_of(mesher.name).add(*present);
        ran_.insert(mesher.name);
        ++next_;
        progress_.already_done(*present);
        continue;
      }
      if (!unchanged(model)) {
        summary_.models_changed.insert(model.name);
        ++next_;
        continue;
      }
      row.model_name = model.name;
      row.model_path = model.path.string();
      row.model_bytes = model.bytes;
      row.region = mesher.region;
      row.promise = mesher.promise();
      row.host = host_;
      running_.push_back(std::make_unique<Job>(model, mesher, std::move(row),
                                               folder / std::to_string(next_), options_));
      ++next_;
    }
    return !running_.empty();
  }

  // Checked between models only, so that every model begun has all its runs.
  bool out_of_time() const {
    return options_.stop_after_seconds > 0 && seconds_since(start_) >= options_.stop_after_seconds;
  }

  void wait() {
    std::vector<pollfd> fds;
    for (const auto& job : running_) fds.push_back({job->fd(), POLLIN, 0});
    poll(fds.data(), fds.size(), 250);
  }

  void collect() {
    for (auto it = running_.begin(); it != running_.end() && interrupted == 0;) {
      Job& job = **it;
      if (!job.advance()) {
        ++it;
        continue;
      }
      const std::string& mesher = job.mesher().name;
      // If it ran on another model before, the reason lies in this model.
      if (job.cannot_run() && !ran_.contains(mesher)) {
        progress_.finish();
        throw CannotRun(mesher + ": " + job.row().reason);
      }
      if (unchanged(job.model())) {
        ran_.insert(mesher);
        database_.store(job.row());
        count_of(mesher).add(job.row());
        progress_.done(job.row(), job.seconds());
      } else {
        summary_.models_changed.insert(job.model().name);
      }
      it = running_.erase(it);
    }
  }

  void show_progress() {
    std::string text;
    for (const auto& job : running_) {
      text += (text.empty() ? "" : ", ") + job->mesher().name + " " + job->model().name;
    }
    progress_.running(text);
  }

  const std::vector<Model>& models_;
  const std::vector<Mesher>& meshers_;
  const CampaignOptions& options_;
  ResultsDatabase database_;
  fs::path scratch_;
  Progress progress_;
  std::string host_ = host_name();
  Clock::time_point start_ = Clock::now();
  std::set<std::string> ran_;  // meshers that could be run at least once
  std::size_t next_ = 0;
  std::list<std::unique_ptr<Job>> running_;
  CampaignSummary summary_;
};

}  // namespace

CampaignSummary run_campaign(const std::vector<Model>& models, const std::vector<Mesher>& meshers,
                             const CampaignOptions& options) {
  return Campaign(models, meshers, options).run();
}

void interrupt_campaign() {
  interrupted = 1;
}

bool campaign_interrupted() {
  return interrupted != 0;
}

std::string describe(const Limits& limits) {
  std::ostringstream text;
  text << "wall " << limits.wall_seconds << " s, cpu " << limits.cpu_seconds << " s, memory "
       << (limits.memory_bytes >> 20) << " MiB";
  return text.str();
}

std::optional<double> mesh_seconds(const std::string& stats_json) {
  const Json json = Json::parse(stats_json, nullptr, false);
  if (!json.is_object() || !json.contains("phases_seconds")) return std::nullopt;
  double sum = 0;
  for (const auto& [phase, seconds] : json.at("phases_seconds").items()) {
    if (phase == "read" || phase == "check" || phase == "write" || !seconds.is_number()) continue;
    sum += seconds.get<double>();
  }
  return sum;
}

}  // namespace tetproof
