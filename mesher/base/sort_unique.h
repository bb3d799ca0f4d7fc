// Lists as sets.
#pragma once

#include <algorithm>
#include <vector>

#include "mesher/base/namespaces.h"

namespace delmesher::base {

// Ascending, each value once.
template <class T>
void sort_unique(std::vector<T>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

}  // namespace delmesher::base
