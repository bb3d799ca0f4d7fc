#include "property_tests/leniency.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

namespace tetproof {
namespace {

constexpr std::size_t kFileSize = 4096, kName = 40, kDigits = 16, kLine = 64;
constexpr std::uint64_t kSample = 100;

// A file mapped into memory: its contents stay however the process ends. Null if no folder is
// named.
char* map_file() {
  const char* folder = std::getenv("TETPROOF_COUNTERS");
  if (folder == nullptr) return nullptr;
  std::string name = std::string(folder) + "/counters-XXXXXX";
  const int file = mkstemp(name.data());
  if (file < 0 || ftruncate(file, kFileSize) != 0) {
    std::fprintf(stderr, "cannot write %s\n", name.c_str());
    std::abort();
  }
  void* memory = mmap(nullptr, kFileSize, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  close(file);
  if (memory == MAP_FAILED) std::abort();
  return static_cast<char*>(memory);
}

// How many inputs at the beginning are not counted.
std::uint64_t inputs_to_skip() {
  const char* number = std::getenv("TETPROOF_COUNTERS_AFTER");
  return number == nullptr ? 0 : std::strtoull(number, nullptr, 10);
}

// Adds one to a decimal number with leading zeros, in place.
void count(char* digits) {
  if (digits == nullptr) return;
  for (std::size_t i = kDigits; i-- > 0;) {
    if (digits[i] != '9') {
      ++digits[i];
      return;
    }
    digits[i] = '0';
  }
}

class Counters {
 public:
  Counters() : skip_(inputs_to_skip()), memory_(map_file()) {
    executed_digits_ = line("executed", 1);
    judged_digits_ = line("judged", 1);
  }

  void execute() {
    counting_ = skipped_ == skip_;
    if (!counting_) {
      ++skipped_;
      return;
    }
    ++executed_;
    count(executed_digits_);
  }
  void judge() {
    if (!counting_) return;
    ++judged_;
    count(judged_digits_);
  }
  // The place of the digits of a new line, or null without a file.
  char* line(const char* name, double most) {
    if (memory_ == nullptr) return nullptr;
    if ((lines_ + 1) * kLine > kFileSize || std::strlen(name) >= kName) std::abort();
    char text[kLine + 1];
    std::snprintf(text, sizeof text, "%-*s%0*d %6.4f\n", static_cast<int>(kName), name,
                  static_cast<int>(kDigits), 0, most);
    char* place = memory_ + lines_++ * kLine;
    std::memcpy(place, text, kLine);
    return place + kName;
  }

  // Does the input of now count?
  bool counting() const { return counting_; }
  std::uint64_t executed() const { return executed_; }
  std::uint64_t judged() const { return judged_; }

  std::vector<Leniency*> listed;

 private:
  std::uint64_t skip_, skipped_ = 0, executed_ = 0, judged_ = 0;
  bool counting_ = true;
  char* memory_;
  char *executed_digits_ = nullptr, *judged_digits_ = nullptr;
  std::size_t lines_ = 0;
};

Counters& counters() {
  static Counters all;
  return all;
}

bool too_often(const Leniency& leniency) {
  const auto judged = static_cast<double>(counters().judged());
  return counters().judged() >= kSample &&
         static_cast<double>(leniency.taken()) > leniency.most() * judged;
}

}  // namespace

void executed() {
  counters().execute();
}

void judging(std::initializer_list<Leniency*> leniencies) {
  counters().judge();
  for (Leniency* leniency : leniencies) {
    if (leniency->listed_) continue;
    leniency->listed_ = true;
    leniency->digits_ = counters().line(leniency->name(), leniency->most());
    counters().listed.push_back(leniency);
  }
}

void Leniency::take() {
  if (!listed_) {
    std::fprintf(stderr, "leniency %s is not named by its property\n", name_);
    std::abort();
  }
  if (!counters().counting() || last_ == counters().judged()) return;
  last_ = counters().judged();
  ++taken_;
  count(digits_);
}

std::string leniency_table() {
  const Counters& all = counters();
  std::string text =
      std::to_string(all.executed()) + " executions, " + std::to_string(all.judged()) + " judged\n";
  for (const Leniency* leniency : all.listed) {
    char line[160];
    const double share = all.judged() == 0 ? 0
                                           : 100 * static_cast<double>(leniency->taken()) /
                                                 static_cast<double>(all.judged());
    std::snprintf(line, sizeof line, "  %-36s %llu of %llu (%.3g %%, at most %.3g %%)%s\n",
                  leniency->name(), static_cast<unsigned long long>(leniency->taken()),
                  static_cast<unsigned long long>(all.judged()), share, 100 * leniency->most(),
                  too_often(*leniency) ? " TOO OFTEN" : "");
    text += line;
  }
  return text;
}

bool leniencies_within_bounds() {
  for (const Leniency* leniency : counters().listed) {
    if (too_often(*leniency)) return false;
  }
  return true;
}

}  // namespace tetproof
