#include "oracles/base/heap.h"

#include <cstdlib>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace tetproof::oracles {

#ifdef __GLIBC__
void return_large_blocks() {
  constexpr int kLarge = 1 << 16;
  mallopt(M_MMAP_THRESHOLD, kLarge);
}

void return_free_pages() {
  malloc_trim(0);
}
#else
void return_large_blocks() {}
void return_free_pages() {}
#endif

}  // namespace tetproof::oracles
