// Leniencies: cases in which a check is content with less than it says. Each is counted, so that
// people see how often it is taken, and the share is bounded.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>

namespace tetproof {

// Made once per program (static), and named in judging() by every property that may take it.
class Leniency {
 public:
  // `most`: the largest share of the executions judged in which it may be taken, in [0, 1].
  constexpr Leniency(const char* name, double most) : name_(name), most_(most) {}

  // Counts the leniency, once per execution however often it is taken in it. Aborts if judging()
  // has not named it.
  void take();

  const char* name() const { return name_; }
  double most() const { return most_; }
  std::uint64_t taken() const { return taken_; }

 private:
  friend void judging(std::initializer_list<Leniency*> leniencies);

  const char* name_;
  double most_;
  std::uint64_t taken_ = 0, last_ = 0;
  char* digits_ = nullptr;  // in the file of the process
  bool listed_ = false;
};

// Counts an input that was given to a target.
void executed();
// To be called where a property begins: the input has got that far, and these leniencies may be
// taken. At most once per input, and before any is taken.
void judging(std::initializer_list<Leniency*> leniencies);

// "12 executions, 11 judged", and a line per leniency: "NAME TAKEN of JUDGED (SHARE %, at most
// BOUND %)", with "TOO OFTEN" behind if it is beyond its bound. Fewer than 100 judged are no
// sample, so none is beyond its bound then.
std::string leniency_table();
bool leniencies_within_bounds();

// If the environment's TETPROOF_COUNTERS names a folder, every process keeps its counters in a file
// of its own there at all times, so that they survive every way to end. Its lines are "NAME COUNT
// BOUND", the first two "executed" and "judged" with bound 1. ci/campaigns/fuzz adds them up. If
// TETPROOF_COUNTERS_AFTER is a number, so many inputs at the beginning of a process are not
// counted: the inputs that a campaign begins with were chosen because they are special.

}  // namespace tetproof
