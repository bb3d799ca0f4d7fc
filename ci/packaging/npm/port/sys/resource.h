// What a process used, with the memory, which WASI's own header has not.
#pragma once

#include <sys/time.h>

#define RUSAGE_SELF 0

struct rusage {
  struct timeval ru_utime, ru_stime;
  long ru_maxrss;  // in KiB
};

#ifdef __cplusplus
extern "C"
#endif
    int
    getrusage(int who, struct rusage* usage);
