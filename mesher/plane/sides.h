// Which triangles of the refined mesh are inside, kept up to date during refinement.
//
// The segments of the chamfered graph leak at the cut points, so that triangles cannot be
// classified by flooding alone. The missing parts of the segments that separate the inside from the
// outside, the gaps, are remembered by the triangles that they run through (mixed). Every other
// triangle lies on one side, although parts of other segments may run through it. If these made it
// count, it would ask for points at sharp corners that have nothing of the inside in them and are
// not chamfered.
//
// Invariants from start() to settle(), between insertions:
//  - every triangle has a side; two neighbours that are not mixed have the same one, or there is a
//    piece between them, and then each has the one that the piece says;
//  - a triangle has a list of gaps if and only if a gap meets its interior or part of an edge. Then
//    it is mixed, and has just these gaps in its list. Without a list it is mixed only if its side
//    could not be decided;
//  - a list that is free is empty and of no triangle.
#pragma once

#include <algorithm>
#include <iterator>
#include <span>
#include <vector>

#include "mesher/plane/chamfer.h"
#include "mesher/plane/graph.h"
#include "mesher/plane/triangulation.h"
#include "mesher/predicates/predicates.h"

namespace delmesher::plane {

using Side = PlaneRecord::Side;

class Sides {
 public:
  // `everywhere`: triangles outside count as well.
  Sides(InputGraph& graph, Triangulation& mesh, PointStore& points, PlanePredicates& predicates,
        const std::vector<Gap>& gaps, bool everywhere)
      : graph_(graph),
        mesh_(mesh),
        points_(points),
        predicates_(predicates),
        spatial_(points),
        everywhere_(everywhere) {
    std::ranges::copy_if(gaps, std::back_inserter(gaps_), [&graph](const Gap& gap) {
      return graph.pieces[gap.piece].inside_left != graph.pieces[gap.piece].inside_right;
    });
  }

  // Classifies all triangles of the mesh, which must have all segments of the chamfered graph.
  void start();
  Side of(TriangleId t) const { return static_cast<Side>(side_[t]); }
  // Is it where the bound is to hold?
  bool counts(TriangleId t) const { return everywhere_ || of(t) != Side::outside; }

  // Around every Triangulation::fill_cavity.
  void before_fill();
  void after_fill();

  // Decides for mixed triangles that gaps only touch: contained in the inside or not.
  void settle();

  // Throws InternalError at the first broken invariant. A gap that only touches a neighbour's gaps
  // at a vertex is not looked for.
  void validate();

 private:
  friend struct SidesBreaker;  // of the tests of validate()

  enum class Contact : std::uint8_t { none, point, proper };
  // How a gap meets a triangle: `proper` if it meets the interior or part of an edge.
  Contact contact(TriangleId t, const Gap& gap);
  void trace(std::uint32_t gap);
  Side beside(EdgeId e);
  Side beside(TriangleId t, const Gap& gap);
  bool is_along_edge(TriangleId t, const Gap& gap);
  Side told_at_edges(TriangleId t);
  VertexId near(TriangleId t) const;
  Side resolve(TriangleId t, VertexId from);
  void flood();
  void spread(TriangleId t, std::vector<TriangleId>& stack);
  std::span<const std::uint32_t> gaps_at(TriangleId t) const;
  void validate_neighbours(TriangleId t);
  void validate_gaps(TriangleId t);

  InputGraph& graph_;
  Triangulation& mesh_;
  PointStore& points_;
  PlanePredicates& predicates_;
  Predicates spatial_;
  std::vector<Gap> gaps_;  // that separate
  const bool everywhere_;
  std::vector<std::uint8_t> side_;
  // Gaps at the mixed triangles, as an index into lists_ (or kNone); empty if there are no gaps.
  std::vector<std::uint32_t> list_of_;
  std::vector<std::vector<std::uint32_t>> lists_;
  std::vector<std::uint32_t> free_lists_;
  std::vector<std::uint32_t> seen_;  // while gaps are traced: the last gap, plus one
  // Between before_fill and after_fill.
  std::vector<std::uint8_t> old_sides_;
  std::vector<std::uint32_t> candidates_;
  bool any_mixed_ = false;
};

}  // namespace delmesher::plane
