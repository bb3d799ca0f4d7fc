// What the reports of all oracles come to.
#pragma once

#include "oracles/verify.h"

namespace tetproof::oracles {

// A deviation of so many ulp is that of rounding.
inline constexpr double kRoundedUlps = 4;

// Sets the verdict, and the deviation in units of `ulp` and as a share of the diagonal; of both 0
// stands for unknown.
void conclude(double ulp, double diagonal, VerifyReport& report);

}  // namespace tetproof::oracles
