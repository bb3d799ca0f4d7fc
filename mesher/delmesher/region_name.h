// What a region is called.
#pragma once

#include <map>
#include <string>

#include "tet_mesh.h"

namespace delmesher {

// By a region point in it, else as its label; empty if that has no name, or it has no label.
inline std::string name_of_region(const MeshRegion& region,
                                  const std::map<std::int32_t, std::string>& label_names) {
  if (!region.name.empty()) return region.name;
  const auto found = region.label ? label_names.find(*region.label) : label_names.end();
  return found == label_names.end() ? "" : found->second;
}

}  // namespace delmesher
