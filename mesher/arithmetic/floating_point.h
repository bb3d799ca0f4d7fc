// Assumptions about the compiler, on which error bounds and exact transformations rely.
#pragma once

#include <cfloat>

#if defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__ != 0) || \
    defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__)
#error "delmesher needs IEEE arithmetic: compile without -ffast-math and what it implies"
#endif

#if FLT_EVAL_METHOD != 0
#error "delmesher needs doubles that are evaluated as doubles: compile without extended precision"
#endif
