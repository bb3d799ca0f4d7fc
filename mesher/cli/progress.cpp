#include "mesher/cli/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string_view>

namespace delmesher::cli {

namespace {

// A number rounded to two significant digits: more would pretend to precision.
std::string two_digits(double value) {
  double unit = 1;
  while (value / unit >= 100) unit *= 10;
  return std::to_string(static_cast<std::uint64_t>(std::round(value / unit) * unit));
}

// Refined meshes, with what is outside of the solid, had 1.8 to 2.3 times as many tetrahedra
// predicted as they had vertices in the end.
constexpr double kPredictedPerVertex = 2.1;

struct Share {
  double done = -1;    // negative if nothing is known
  bool about = false;  // from a prediction, which may be wrong by half
};

Share share_of(const Progress& progress) {
  if (progress.done >= 0) return {std::min(progress.done, 1.0), false};
  if (progress.phase != Phase::refine || !(progress.predicted_tetrahedra > 0)) return {};
  const double vertices = progress.predicted_tetrahedra / kPredictedPerVertex;
  return {std::min(static_cast<double>(progress.vertices) / vertices, 0.99), true};
}

// "12 s", "3 min", "2 h"
std::string duration(double seconds) {
  const double unit = seconds < 100 ? 1 : seconds < 6000 ? 60 : 3600;
  const char* name = seconds < 100 ? " s" : seconds < 6000 ? " min" : " h";
  return std::to_string(static_cast<std::uint64_t>(std::ceil(seconds / unit))) + name;
}

}  // namespace

std::string progress_text(const Progress& progress, double seconds, const char* cells) {
  std::string text = phase_name(progress.phase);
  const Share share = share_of(progress);
  if (share.done >= 0) {
    text.resize(10, ' ');
    text += share.about ? "about " : "";
    text += std::to_string(static_cast<int>(share.done * 100)) + " %";
    // Sooner, and at the end of a prediction, it would jump.
    if (seconds > 2 && share.done > 0.05 && share.done < (share.about ? 0.99 : 1)) {
      text += ", " + duration(seconds * (1 - share.done) / share.done) + " left";
    }
  }
  if (progress.vertices > 0) text += "  " + std::to_string(progress.vertices) + " vertices";
  if (progress.predicted_tetrahedra > 0) {
    text += "  (about " + two_digits(progress.predicted_tetrahedra) + " " + cells + " predicted)";
  }
  return text;
}

void ProgressLine::write(const std::string& text) {
  std::string out = "\r" + text;
  if (escapes_) {
    out += "\x1b[K";
  } else if (text.size() < width_) {
    out += std::string(width_ - text.size(), ' ');
  }
  if (text.empty()) out += "\r";
  std::fwrite(out.data(), 1, out.size(), stream_);
  std::fflush(stream_);
  width_ = text.size();
}

void ProgressLine::show(const Progress& progress) {
  if (!enabled_) return;
  const auto now = std::chrono::steady_clock::now();
  const bool soon = now - last_ < std::chrono::milliseconds(100);
  if (soon && progress.phase == phase_ && width_ > 0) return;
  last_ = now;
  if (progress.phase != phase_ || width_ == 0) phase_began_ = now;
  phase_ = progress.phase;
  write(progress_text(progress, std::chrono::duration<double>(now - phase_began_).count(), cells_));
}

void ProgressLine::clear() {
  if (enabled_ && width_ > 0) write("");
}

bool stderr_is_terminal() {
  return ::isatty(STDERR_FILENO) == 1;
}

bool stderr_takes_escapes() {
  const char* no_color = std::getenv("NO_COLOR");
  const char* term = std::getenv("TERM");
  const bool dumb = term == nullptr || std::string_view(term) == "dumb";
  return stderr_is_terminal() && !dumb && (no_color == nullptr || *no_color == '\0');
}

}  // namespace delmesher::cli
