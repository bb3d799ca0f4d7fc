// The largest index.
#pragma once

#include <cstdint>
#include <string>

#include "mesher/base/control.h"
#include "mesher/base/namespaces.h"

namespace delmesher::base {

// Throws Stopped, as a limit of size: there are more of `what` ("tetrahedra") than `most`, the
// largest number that indices can express.
[[noreturn]] inline void stop_at_size(std::uint64_t most, const std::string& what) {
  throw Stopped{
      {StatusCode::limit_reached,
       "more than " + std::to_string(most) + " " + what + ", more than indices can number",
       Limit::size}};
}

}  // namespace delmesher::base
