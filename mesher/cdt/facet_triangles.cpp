#include "mesher/cdt/facet_triangles.h"

#include <algorithm>

#include "mesher/base/check.h"
#include "mesher/base/sort_unique.h"

namespace delmesher::cdt {
namespace {

std::uint64_t directed(VertexId from, VertexId to) {
  return (std::uint64_t{from} << 32) | to;
}

}  // namespace

FacetTriangulator::FacetTriangulator(const CdtInput& input, const Chains& chains,
                                     Predicates& predicates)
    : input_(input), topology_(*input.topology), chains_(chains), predicates_(predicates) {
  const auto& first = topology_.triangles.front();
  tetrahedron_ = {first[0], first[1], first[2], kNone};
  for (const auto& t : topology_.triangles) {
    for (const VertexId v : t) {
      if (tetrahedron_[3] == kNone && predicates_.orient3d(first[0], first[1], first[2], v) != 0) {
        tetrahedron_[3] = v;
      }
    }
    if (tetrahedron_[3] != kNone) break;
  }
  DELMESHER_CHECK(tetrahedron_[3] != kNone, "a valid surface has all of its vertices in one plane");
}

PlanarTriangulation FacetTriangulator::triangulate(FacetId facet) {
  collect_vertices(facet);
  if (vertices_.size() == 3 && topology_.facet_triangles[facet].size() == 1) {
    return {{topology_.triangles[topology_.facet_triangles[facet][0]]}, {{kNone, kNone, kNone}}};
  }
  collect_boundary(facet);
  bool flipped = false;
  const FacetPlane plane = plane_of(facet, flipped);
  PlanarTriangulation all = triangulate_planar(predicates_, plane, vertices_);
  if (flipped) {
    for (auto& t : all.triangles) std::swap(t[1], t[2]);
    for (auto& n : all.neighbors) {
      std::swap(n[1], n[2]);
      for (std::uint32_t& side : n) {
        if (side != kNone && side % 3 != 0) side = side / 3 * 3 + 3 - side % 3;
      }
    }
  }
  return restrict_to_polygon(std::move(all));
}

void FacetTriangulator::collect_vertices(FacetId facet) {
  vertices_.clear();
  for (const std::uint32_t t : topology_.facet_triangles[facet]) {
    for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
      vertices_.push_back(topology_.from(h));
      const std::uint32_t edge = topology_.edge_of[h];
      if (topology_.edge_is_flat[edge] != 0) continue;
      for (std::uint32_t n = chains_.first(edge); n != kNone; n = chains_.node(n).next) {
        vertices_.push_back(chains_.node(n).vertex);
      }
    }
  }
  if (facet < input_.on_facet.size()) {
    const std::vector<VertexId>& inside = input_.on_facet[facet];
    vertices_.insert(vertices_.end(), inside.begin(), inside.end());
  }
  sort_unique(vertices_);
}

void FacetTriangulator::collect_boundary(FacetId facet) {
  boundary_.clear();
  for (const std::uint32_t t : topology_.facet_triangles[facet]) {
    for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
      const std::uint32_t edge = topology_.edge_of[h];
      if (topology_.edge_is_flat[edge] != 0) continue;
      const bool forward = topology_.from(h) < topology_.to(h);
      for (std::uint32_t n = chains_.first(edge); chains_.is_subsegment(n);
           n = chains_.node(n).next) {
        const VertexId a = chains_.node(n).vertex, b = chains_.next(n).vertex;
        boundary_.push_back(forward ? directed(a, b) : directed(b, a));
      }
    }
  }
  std::sort(boundary_.begin(), boundary_.end());
}

// The planar predicates need a point off the plane, whichever side it is on: the facet of a convex
// solid has none on its outer side. With one on the inner side the plane is described from inside,
// and the triangles are to be flipped.
FacetPlane FacetTriangulator::plane_of(FacetId facet, bool& flipped) {
  FacetPlane plane{topology_.facet_axis[facet], topology_.facet_axis_sign[facet], kNone};
  const std::uint32_t first = topology_.facet_triangles[facet][0];
  const auto& t = topology_.triangles[first];
  int side = 0;
  const auto try_point = [&](VertexId v) {
    if (side != 0) return;
    side = predicates_.orient3d(t[0], t[1], t[2], v);
    if (side != 0) plane.off_plane = v;
  };
  // A near vertex makes the filter of the predicate sharper than any other.
  for (std::uint32_t h = 3 * first; h < 3 * first + 3; ++h) {
    try_point(topology_.from(SurfaceTopology::previous(topology_.opposite[h])));
  }
  for (const VertexId v : tetrahedron_) try_point(v);
  flipped = side < 0;
  if (flipped) plane.axis_sign = -plane.axis_sign;
  return plane;
}

bool FacetTriangulator::is_boundary(VertexId from, VertexId to) const {
  return std::binary_search(boundary_.begin(), boundary_.end(), directed(from, to));
}

PlanarTriangulation FacetTriangulator::restrict_to_polygon(PlanarTriangulation&& all) const {
  std::vector<std::uint32_t> stack, number(all.triangles.size(), kNone);
  PlanarTriangulation out;
  const auto take = [&](std::uint32_t t) {
    if (number[t] != kNone) return;
    number[t] = static_cast<std::uint32_t>(out.triangles.size());
    out.triangles.push_back(all.triangles[t]);
    out.neighbors.push_back(all.neighbors[t]);
    stack.push_back(t);
  };
  std::size_t sides = 0;
  for (std::uint32_t t = 0; t < all.triangles.size(); ++t) {
    for (std::uint32_t i = 0; i < 3; ++i) {
      const auto& v = all.triangles[t];
      if (!is_boundary(v[(i + 1) % 3], v[(i + 2) % 3])) continue;
      ++sides;
      all.neighbors[t][i] = kNone;
      if (number[t] != kNone) out.neighbors[number[t]][i] = kNone;
      take(t);
    }
  }
  DELMESHER_CHECK(sides == boundary_.size(), "a facet's side is not Delaunay in its plane");
  while (!stack.empty()) {
    const std::uint32_t t = stack.back();
    stack.pop_back();
    for (const std::uint32_t side : all.neighbors[t]) {
      if (side != kNone) take(side / 3);
    }
  }
  for (auto& n : out.neighbors) {
    for (std::uint32_t& side : n) {
      if (side != kNone) side = 3 * number[side / 3] + side % 3;
    }
  }
  return out;
}

}  // namespace delmesher::cdt
