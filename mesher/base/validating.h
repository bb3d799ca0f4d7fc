// Whether the stages check the invariants of their own state.
#pragma once

#include "mesher/base/namespaces.h"

namespace delmesher::base {

// Do the stages check their invariants after each step, at about the cost of the step itself? In
// debug and fuzz builds; a test asks for it in any build.
#if !defined(NDEBUG) || defined(DELMESHER_VALIDATE)
inline constexpr bool kValidating = true;
#else
inline constexpr bool kValidating = false;
#endif

}  // namespace delmesher::base
