// One line on a terminal that shows the progress of the run.
#pragma once

#include <chrono>
#include <cstdio>
#include <string>

#include "mesher/delmesher.h"

namespace delmesher::cli {

// "refine   about 45 %, 12 s left  123456 vertices", `seconds` after the phase began. Unknown
// numbers are left out, and while refining the share comes from the prediction.
std::string progress_text(const Progress& progress, double seconds = 0,
                          const char* cells = "tetrahedra");

class ProgressLine {
 public:
  // Prints only if `enabled`; rewrites the line with escape sequences only if `escapes`.
  ProgressLine(std::FILE* stream, bool enabled, bool escapes, const char* cells = "tetrahedra")
      : stream_(stream), cells_(cells), enabled_(enabled), escapes_(escapes) {}
  ~ProgressLine() { clear(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void show(const Progress& progress);
  void clear();

 private:
  void write(const std::string& text);

  std::FILE* stream_;
  const char* cells_;
  bool enabled_, escapes_;
  std::size_t width_ = 0;  // of the text on the line
  Phase phase_ = Phase::read;
  std::chrono::steady_clock::time_point last_{}, phase_began_{};
};

// Whether standard error is a terminal, and one that takes escape sequences (NO_COLOR, TERM=dumb).
bool stderr_is_terminal();
bool stderr_takes_escapes();

}  // namespace delmesher::cli
