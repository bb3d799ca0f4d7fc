// The sizes of edges that were asked for from place to place (--size-field).
#pragma once

#include <string>
#include <vector>

#include "mesher/delmesher.h"
#include "oracles/base/exact_points.h"
#include "oracles/verdict/report.h"

namespace tetproof::oracles {

// At x an edge may be as long as the smallest of size + growth |x - point| over all sources.
class EdgeSizes {
 public:
  // An edge that exceeds its size by more than this is too long: both are computed in doubles.
  static constexpr double kMost = 1 + 1e-9;

  // `longest`: the same everywhere; 0: any.
  EdgeSizes(std::vector<delmesher::SizeSource> sources, double growth, double longest = 0);

  bool empty() const { return longest_ == 0 && blocks_.empty(); }
  // The edge's length over the smallest size at any of its points. Above 1 it is too long.
  double excess(const Position& a, const Position& b) const;

 private:
  struct Block {  // neighbours, with the box around them and the smallest of their sizes
    std::vector<delmesher::SizeSource> sources;
    Position low, high;
    double size;
  };

  void divide(std::vector<delmesher::SizeSource> sources);

  double growth_, longest_;
  std::vector<Block> blocks_;
};

// Lines X Y Z SIZE, the first of which may be of words; or a .pos of Gmsh, whose corners are the
// sources. Empty on success, else the mistake.
std::string read_size_field(const std::string& path, std::vector<delmesher::SizeSource>& sources);

// The same of lines X Y Z.
std::string read_points(const std::string& path, std::vector<Position>& points);

// Figures of a report on edges: how many are too long, and the largest over what is allowed.
inline constexpr char kTooLong[] = "edges too long", kLargestEdge[] = "largest over its size";

// Names the promise in `unproven` if the report counts edges that are too long, as some are where
// something that the refinement left out came back and could not be halved. Without a record that
// is undecided, with one it is not a violation: there the refined mesh, and what followed, are
// decided.
void excuse_long_edges(const char* option, bool recorded, OracleReport& lengths,
                       std::vector<std::string>& unproven);

}  // namespace tetproof::oracles
