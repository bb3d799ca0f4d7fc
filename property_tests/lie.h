// Lies and damages as parameters of tests.
#pragma once

#include <gtest/gtest.h>

#include <cctype>
#include <ostream>
#include <string>

namespace tetproof {

// The false account of a run, and the oracle that should see through it. `Told`: a run as it is
// told, and what was asked for.
template <class Told>
struct LieAbout {
  const char* name;
  const char* oracle;  // the one meant to catch it
  void (*tell)(Told&);
  const char* before = "";  // for the table: its fate before its row was there
};

template <class Told>
void PrintTo(const LieAbout<Told>& lie, std::ostream* stream) {
  *stream << lie.name;
}

template <class Param>
std::string test_name(const testing::TestParamInfo<Param>& tested) {
  std::string name = tested.param.name;
  for (char& c : name) {
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  }
  return name;
}

}  // namespace tetproof
