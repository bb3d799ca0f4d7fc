// What a wheel asks of the C library, in the oldest version that has it: for ci/machines/wheels,
// included before everything. A newer hypot (2.35) differs in what it tells of errors, not in its
// values.
#pragma once

#if defined(__x86_64__)
__asm__(".symver hypot, hypot@GLIBC_2.2.5");
#elif defined(__aarch64__)
__asm__(".symver hypot, hypot@GLIBC_2.17");
#endif
