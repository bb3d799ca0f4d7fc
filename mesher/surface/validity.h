// Exact validity of a surface: closed, 2-manifold, consistently oriented, no degenerate triangle,
// no self-intersection. Of a complex: no degenerate or repeated triangle, no self-intersection.
#pragma once

#include "mesher/base/control.h"
#include "mesher/delmesher/surface.h"
#include "mesher/delmesher/surface_report.h"
#include "mesher/surface/rules.h"

namespace delmesher::surface {

struct ValidityResult {
  SurfaceReport report;
  std::vector<std::uint8_t> reverse_triangle;  // per triangle: must it be reversed?
};

constexpr std::uint64_t kMostPlaces = 1'000'000;  // of each kind in SurfaceReport::places

// Everything check_surface() reports except facets, acute corners and local feature size. With
// `stop_at_first`, ends at the first kind of defect found (tetrahedralize() needs no more to refuse
// a surface). An inside-out surface is not a defect but sets `report.flipped`. Components oriented
// otherwise than parity asks for are reported in warnings. Of a complex neither nesting nor volume
// is found.
ValidityResult check_validity(const Surface& surface, bool stop_at_first, Control& control,
                              std::uint64_t most_places = kMostPlaces, Rules rules = Rules::solid);

// The surface with the triangles marked by check_validity reversed: outwards by parity.
Surface oriented_outwards(const Surface& surface, const ValidityResult& validity);

}  // namespace delmesher::surface
