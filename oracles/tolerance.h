// What is promised of a surface within a tolerance beyond its distance.
//
// Laws: it has the shells of the input, solid ones and cavities, with their genus; of each label
// the triangles are within the tolerance of the input's, and conversely; every border of labels,
// and every edge that bends by more than the feature angle, is within it of the input's lines,
// which are the same kinds of edges; each of these is within it of edges of the mesh that bend by
// half as much, and each corner of the input, where lines end, meet or bend by more than that
// angle, of a vertex. Angles and distances are in doubles; an edge counts only where roundings do
// not decide what it is, and one of the input is asked for only if it is a line however its
// vertices move by half of the tolerance.
#pragma once

#include <vector>

#include "oracles/files/polyhedron.h"
#include "oracles/verdict/report.h"

namespace tetproof::oracles {

// Both surfaces turned outwards.
struct WithinTolerance {
  const Polyhedron& input;
  const Polyhedron& own;  // the boundary of the mesh
  double allowed;         // distance
  double feature;         // degrees
  double slab;            // vertices of the mesh may be so far from the planes of their facets
  int exponent;           // lengths are in units of 2^exponent
  bool labels_listed;     // by the file
};

std::vector<OracleReport> check_tolerance(const WithinTolerance& surfaces);

}  // namespace tetproof::oracles
