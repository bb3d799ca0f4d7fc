// Internal invariants. A failed check is a bug of the mesher, never a property of the input.
#pragma once

#include <stdexcept>
#include <string>

#include "mesher/base/namespaces.h"

namespace delmesher::base {

// Thrown by DELMESHER_CHECK; the public API turns it into StatusCode::internal_error.
class InternalError : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

[[noreturn]] inline void fail_check(const char* file, int line, const char* what) {
  throw InternalError(std::string(file) + ":" + std::to_string(line) + ": " + what);
}

}  // namespace delmesher::base

// Always evaluated, also in release builds: cheap conditions only.
#define DELMESHER_CHECK(condition, what) \
  ((condition) ? void(0) : ::delmesher::base::fail_check(__FILE__, __LINE__, what))
