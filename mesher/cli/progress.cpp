#include "mesher/cli/progress.h"

#include <unistd.h>

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

}  // namespace

std::string progress_text(const Progress& progress) {
  std::string text = phase_name(progress.phase);
  if (progress.done >= 0) {
    text.resize(10, ' ');
    const int percent = progress.done >= 1 ? 100 : static_cast<int>(progress.done * 100);
    text += std::to_string(percent) + " %";
  }
  if (progress.vertices > 0) text += "  " + std::to_string(progress.vertices) + " vertices";
  if (progress.predicted_tetrahedra > 0) {
    text += "  (about " + two_digits(progress.predicted_tetrahedra) + " tetrahedra predicted)";
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
  phase_ = progress.phase;
  write(progress_text(progress));
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
