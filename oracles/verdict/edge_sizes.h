// The sizes of edges that were asked for from place to place (--size-field).
#pragma once

#include <string>
#include <vector>

#include "mesher/delmesher.h"
#include "oracles/base/exact_points.h"

namespace tetproof::oracles {

// At x an edge may be as long as the smallest of size + growth |x - point| over all sources.
class EdgeSizes {
 public:
  // An edge that exceeds its size by more than this is too long: both are computed in doubles.
  static constexpr double kMost = 1 + 1e-9;

  EdgeSizes(std::vector<delmesher::SizeSource> sources, double growth);

  bool empty() const { return blocks_.empty(); }
  // The edge's length over the smallest size at any of its points. Above 1 it is too long.
  double excess(const Position& a, const Position& b) const;

 private:
  struct Block {  // neighbours, with the box around them and the smallest of their sizes
    std::vector<delmesher::SizeSource> sources;
    Position low, high;
    double size;
  };

  void divide(std::vector<delmesher::SizeSource> sources);

  double growth_;
  std::vector<Block> blocks_;
};

// Lines X Y Z SIZE, the first of which may be of words; or a .pos of Gmsh, whose corners are the
// sources. Empty on success, else the mistake.
std::string read_size_field(const std::string& path, std::vector<delmesher::SizeSource>& sources);

}  // namespace tetproof::oracles
