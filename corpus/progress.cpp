#include "corpus/progress.h"

#include <fmt/core.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdio>

namespace tetproof {
namespace {

std::size_t terminal_width() {
  winsize size{};
  return ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 20 ? size.ws_col : 100;
}

std::string one_line(std::string text, std::size_t limit) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 32) c = ' ';
  }
  if (text.size() > limit) text.resize(limit);
  return text;
}

}  // namespace

void Progress::done(const RunRow& row) {
  ++finished_;
  ok_ += row.disposition == Disposition::ok;
  if (terminal_) return;
  const std::string result = row.disposition == Disposition::ok
                                 ? fmt::format("{} tetrahedra", row.mesh ? row.mesh->tetrahedra : 0)
                                 : one_line(row.reason, 120);
  fmt::print("[{}/{}] {} {}: {}, {:.2f} s, {:.0f} MB, {}\n", finished_, total_, row.key.mesher,
             row.model_name, disposition_name(row.disposition), row.wall_seconds,
             static_cast<double>(row.peak_rss_bytes) / 1e6, result);
  std::fflush(stdout);
}

void Progress::running(const std::string& what) {
  if (!terminal_) return;
  const std::string line = fmt::format("{}/{} done, {} ok, {} not, {} left: {}", finished_, total_,
                                       ok_, finished_ - ok_, eta(), what);
  fmt::print("\r\033[K{}", one_line(line, terminal_width() - 1));
  std::fflush(stdout);
}

void Progress::finish() {
  if (terminal_) fmt::print("\r\033[K");
  std::fflush(stdout);
}

std::string Progress::eta() const {
  const std::size_t here = finished_ - present_;
  if (here == 0) return "?";
  const double elapsed =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  const double left = elapsed / static_cast<double>(here) * static_cast<double>(total_ - finished_);
  if (left < 90) return fmt::format("{:.0f} s", left);
  return left < 5400 ? fmt::format("{:.0f} min", left / 60) : fmt::format("{:.1f} h", left / 3600);
}

}  // namespace tetproof
