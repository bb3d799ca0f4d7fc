// Concentric shells around apexes. Segments that meet at an acute angle are split at equal
// distances from the vertex where they meet, so that their parts do not encroach each other.
//
// Never changes. Law: the shells around an apex have the radius of its shortest segment, halved and
// doubled again and again; no other vertex has any.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesher/predicates/points.h"
#include "mesher/surface/plc.h"

namespace delmesher::refine {

class Shells {
 public:
  // `apex`: per input vertex, 1 if it is one. Later vertices are not.
  Shells(const Plc& plc, const PointStore& points, std::span<const std::uint8_t> apex);

  // Where to split a subsegment ab of that length, as a fraction from a: if an end is an apex,
  // where a shell of it crosses the middle third of ab; of two such places the one nearer to the
  // middle; without an apex in the middle.
  double split_fraction(VertexId a, VertexId b, double length) const;

 private:
  double fraction_from(VertexId v, double length) const;

  std::vector<double> radius_;  // per input vertex; 0: none
};

}  // namespace delmesher::refine
