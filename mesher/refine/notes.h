// The four notes of a tetrahedron (Tetrahedrization::Notes), and to which part of the refinement
// each belongs. No other part reads or writes it.
#pragma once

#include "mesher/delaunay/tetrahedrization.h"

namespace delmesher::refine {

enum class Note : std::uint8_t {
  edges,   // Subsegments: bit e: kEdge[e] is a subsegment, or was one
  faces,   // SubfacetMarks: bit i: face i has a mark
  side,    // Sides
  waiting  // BadTetrahedra
};

inline std::uint8_t& note(Tetrahedrization& dt, TetId t, Note kind) {
  return dt.notes(t)[static_cast<std::size_t>(kind)];
}
inline std::uint8_t note(const Tetrahedrization& dt, TetId t, Note kind) {
  return dt.notes(t)[static_cast<std::size_t>(kind)];
}

}  // namespace delmesher::refine
