// Leniencies: cases in which a check is content with less than it says. Each is counted, so that
// somebody sees how often it is taken, and has a bound on that.
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

  // Counts, once per execution however often it is taken in it.
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

// Of one input: it was given to a target.
void executed();
// A property begins: the input has got as far as that, and these may be taken. At most once per
// input, and before any is taken.
void judging(std::initializer_list<Leniency*> leniencies);

// "12 executions, 11 judged", and a line per leniency: "NAME TAKEN of JUDGED (SHARE %, at most
// BOUND %)", with "TOO OFTEN" behind those beyond their bound. Fewer than 100 judged are no sample:
// nothing is beyond its bound then.
std::string leniency_table();
bool leniencies_within_bounds();

// Where the environment's TETPROOF_COUNTERS names a folder, every process keeps its counters in a
// file of its own there, at any moment, so that they survive every way to end: lines
// "NAME COUNT BOUND", the first two "executed" and "judged" with bound 1. ci/fuzz adds them up.

}  // namespace tetproof
