#include "corpus/campaigns/progress.h"

#include <fmt/core.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "corpus/campaigns/printable.h"

namespace tetproof {
namespace {

std::size_t terminal_width() {
  winsize size{};
  return ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 20 ? size.ws_col : 100;
}

std::string one_line(const std::string& text, std::size_t limit) {
  return printable(text.substr(0, limit));
}

// First column to the left, the others to the right.
std::string aligned(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths(rows.front().size());
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string text;
  for (const auto& row : rows) {
    text += fmt::format("{:<{}}", row[0], widths[0]);
    for (std::size_t i = 1; i < row.size(); ++i) text += fmt::format("  {:>{}}", row[i], widths[i]);
    text += '\n';
  }
  return text;
}

}  // namespace

std::size_t MesherCount::runs() const {
  return std::accumulate(counts.begin(), counts.end(), std::size_t{0});
}

void MesherCount::add(const RunRow& row) {
  ++counts[static_cast<std::size_t>(row.disposition)];
  mesh_seconds += row.wall_seconds;
  verify_seconds += row.verify_seconds.value_or(0);
}

std::string count_table(const std::vector<MesherCount>& meshers) {
  constexpr std::size_t kLongestName = 40;
  std::vector<std::size_t> shown;
  for (std::size_t d = 0; d < kDispositionCount; ++d) {
    const bool always = d <= static_cast<std::size_t>(Disposition::wrong_result);
    const auto any = [d](const MesherCount& mesher) { return mesher.counts[d] > 0; };
    if (always || std::any_of(meshers.begin(), meshers.end(), any)) shown.push_back(d);
  }
  std::vector<std::vector<std::string>> rows(1);
  rows[0] = {"mesher", "runs"};
  for (const std::size_t d : shown) {
    rows[0].emplace_back(disposition_name(static_cast<Disposition>(d)));
  }
  rows[0].insert(rows[0].end(), {"meshing", "verifying"});
  for (const MesherCount& mesher : meshers) {
    std::vector<std::string> row = {one_line(mesher.mesher, kLongestName),
                                    std::to_string(mesher.runs())};
    for (const std::size_t d : shown) row.push_back(std::to_string(mesher.counts[d]));
    row.push_back(duration_text(mesher.mesh_seconds));
    row.push_back(duration_text(mesher.verify_seconds));
    rows.push_back(std::move(row));
  }
  return aligned(rows);
}

std::string duration_text(double seconds) {
  if (seconds < 99.95) return fmt::format("{:.1f} s", seconds);
  const auto whole = static_cast<std::uint64_t>(std::llround(seconds));
  if (whole < 6000) return fmt::format("{}:{:02} min", whole / 60, whole % 60);
  return fmt::format("{}:{:02} h", whole / 3600, whole / 60 % 60);
}

void RemainingTime::done(const std::string& mesher, double seconds) {
  Runs& runs = of_[mesher];
  --runs.left;
  ++runs.made;
  runs.seconds += seconds;
}

std::optional<double> RemainingTime::seconds(unsigned jobs) const {
  Runs all;
  for (const auto& [mesher, runs] : of_) {
    all.made += runs.made;
    all.seconds += runs.seconds;
  }
  if (all.made == 0) return std::nullopt;
  double sum = 0;
  for (const auto& [mesher, runs] : of_) {
    const Runs& like = runs.made > 0 ? runs : all;
    sum += static_cast<double>(runs.left) * like.seconds / static_cast<double>(like.made);
  }
  return sum / std::max(1u, jobs);
}

Progress::Progress(const std::vector<std::string>& meshers, std::size_t models, unsigned jobs,
                   bool terminal)
    : total_(meshers.size() * models), jobs_(jobs), terminal_(terminal) {
  for (const std::string& mesher : meshers) remaining_.expect(mesher, models);
}

void Progress::already_done(const RunRow& row) {
  ++finished_;
  ok_ += row.disposition == Disposition::ok;
  unverified_ += row.disposition == Disposition::unverified;
  remaining_.already_done(row.key.mesher);
}

void Progress::done(const RunRow& row, double seconds) {
  ++finished_;
  ok_ += row.disposition == Disposition::ok;
  unverified_ += row.disposition == Disposition::unverified;
  remaining_.done(row.key.mesher, seconds);
  if (terminal_) return;
  std::string result = row.disposition == Disposition::ok ? "" : ", " + one_line(row.reason, 120);
  const char* cells = row.region == "plane" ? "triangles" : "tetrahedra";
  if (row.mesh) result = fmt::format(", {} {}", row.mesh->tetrahedra, cells) + result;
  if (row.verify_seconds) result += fmt::format(", verified in {:.2f} s", *row.verify_seconds);
  fmt::print("[{}/{}] {} {}: {}, {:.2f} s, {:.0f} MB{}\n", finished_, total_,
             printable(row.key.mesher), printable(row.model_name),
             disposition_name(row.disposition), row.wall_seconds,
             static_cast<double>(row.peak_rss_bytes) / 1e6, result);
  std::fflush(stdout);
}

void Progress::running(const std::string& what) {
  if (!terminal_) return;
  const auto left = remaining_.seconds(jobs_);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
  const std::string line =
      fmt::format("{}/{} done, {} ok, {} unverified, {} not; {}, about {} left: {}", finished_,
                  total_, ok_, unverified_, finished_ - ok_ - unverified_,
                  duration_text(elapsed.count()), left ? duration_text(*left) : "?", what);
  fmt::print("\r\033[K{}", one_line(line, terminal_width() - 1));
  std::fflush(stdout);
}

void Progress::finish() {
  if (terminal_) fmt::print("\r\033[K");
  std::fflush(stdout);
}

}  // namespace tetproof
