// Marks that are forgotten all at once: an element is marked if its mark is the present epoch.
#pragma once

#include <algorithm>
#include <cstdint>

#include "mesher/base/namespaces.h"

namespace delmesher::base {

// Begins the next epoch of some marks, which are 0 (never marked) or an earlier epoch. When all
// numbers have been used, the marks are set to 0 and the count begins again.
template <class... Marks>
void next_epoch(std::uint32_t& epoch, Marks&... marks) {
  if (++epoch != 0) return;
  (std::fill(marks.begin(), marks.end(), 0U), ...);
  epoch = 1;
}

}  // namespace delmesher::base
