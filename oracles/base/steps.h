// What the oracles have done, in steps that neither a clock nor a machine decides.
#pragma once

#include <cstdint>

namespace tetproof::oracles {

// On this thread so far, each about 10 nanoseconds: signs and vectors of exact points, boxes that
// were compared, candidates for the next edge of a chain, words of texts. Every search makes some,
// so what takes quadratic time takes quadratically many (fuzz/oracle_cost_property.cpp).
inline constinit thread_local std::uint64_t steps = 0;

}  // namespace tetproof::oracles
