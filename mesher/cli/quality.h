// The messages at the end of a run about the quality of the mesh that it wrote.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "mesher/delmesher_plane.h"

namespace delmesher::cli {

// One line on the angles and shapes of the tetrahedra, or triangles inside, without the file's
// name; empty if there are none.
std::string quality_text(const Result& result);
std::string quality_text(const PlaneResult& result);

// Of a size that was chosen, or of a budget (0: none) that no size fills; else empty.
std::string size_text(const Statistics& statistics, std::uint64_t budget);

// Warnings where angles are smaller than asked for, or dihedral angles below 5 degrees: where, and
// whether an edge or a corner of the input forces it. `delta`: Options::delta.
std::vector<std::string> quality_warnings(const Result& result, double delta);

// Warnings where edges of the mesh are longer than max_edge, `sizes` with size_growth, or, in their
// regions, region_sizes allow: how many, and the longest.
std::vector<std::string> edge_warnings(const Result& result, const Options& options,
                                       const std::vector<SizeSource>& sizes,
                                       const std::map<std::int32_t, std::string>& label_names);

}  // namespace delmesher::cli
