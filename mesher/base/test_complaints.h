// What validate() says of structures that a test has broken on purpose.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <utility>

#include "mesher/base/check.h"

namespace delmesher::base {

// The message of the check that fails; "nothing" if none does.
template <class Validate>
std::string complaint(const Validate& validate) {
  try {
    validate();
  } catch (const InternalError& error) {
    return error.what();
  }
  return "nothing";
}
template <class Part, class... Arguments>
std::string complaint_of(Part& part, Arguments&... arguments) {
  return complaint([&] { part.validate(arguments...); });
}

inline void expect_complaint(const std::string& said, const std::string& reason) {
  EXPECT_NE(said.find(reason), std::string::npos) << said << ", not " << reason;
}

// The damages, each with what is said of it. `said_after(damage)` makes a structure, breaks it, and
// returns the complaint.
template <class Damage, std::size_t kCases, class SaidAfter>
void expect_complaints(const std::pair<Damage, const char*> (&cases)[kCases],
                       const SaidAfter& said_after) {
  for (const auto& [damage, reason] : cases) expect_complaint(said_after(damage), reason);
}

}  // namespace delmesher::base
