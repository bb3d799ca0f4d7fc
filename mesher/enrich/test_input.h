// What an input of the last step has to satisfy, in rational arithmetic.
#pragma once

#include <set>
#include <string>

#include "mesher/cdt/cdt.h"
#include "mesher/cdt/cdt_reference.h"

namespace delmesher::enrich {

// Which law of cdt::CdtInput is broken: every vertex is there once, no two coincide, the points of
// an edge are strictly inside it and in order from its smaller end, and those of a facet strictly
// inside that. Empty if none is. The input vertices must be explicit.
class InputChecker {
 public:
  InputChecker(const cdt::CdtInput& input, const PointStore& points)
      : input_(input), topology_(*input.topology), points_(points) {}

  std::string run() {
    if (!are_all_different()) return "a vertex is there twice, or two coincide";
    for (std::uint32_t e = 0; e < input_.on_edge.size(); ++e) {
      if (topology_.edge_is_flat[e] != 0 && !input_.on_edge[e].empty()) return "on a flat edge";
      if (!goes_along(e)) return "off its edge, or out of order";
      if (!are_new(input_.on_edge[e])) return "of an edge: no vertex, or there twice";
    }
    for (FacetId f = 0; f < input_.on_facet.size(); ++f) {
      for (const VertexId v : input_.on_facet[f]) {
        if (!is_inside(f, at(v))) return "not strictly inside its facet";
      }
      if (!are_new(input_.on_facet[f])) return "of a facet: no vertex, or there twice";
    }
    return "";
  }

 private:
  using Vector = cdt::rational::Vector;

  Vector at(VertexId v) const { return cdt::rational::exact(points_, v); }

  bool are_all_different() {
    std::set<Vector> places;
    for (const VertexId v : input_.vertices) {
      if (!places.insert(at(v)).second) return false;
      vertices_.insert(v);
    }
    return true;
  }

  bool are_new(const std::vector<VertexId>& list) {
    return std::ranges::all_of(list, [&](VertexId v) {
      return vertices_.count(v) != 0 && v >= topology_.vertex_half_edge.size() &&
             listed_.insert(v).second;
    });
  }

  bool goes_along(std::uint32_t e) const {
    using namespace cdt::rational;
    const auto ends = topology_.edge_vertices(e);
    const Vector a = at(ends[0]), ab = minus(at(ends[1]), a);
    mpq_class before = 0;
    for (const VertexId v : input_.on_edge[e]) {
      const Vector x = minus(at(v), a);
      const mpq_class along = dot(x, ab);
      if (!is_zero(cross(x, ab)) || along <= before) return false;
      before = along;
    }
    return before < dot(ab, ab);
  }

  bool is_inside(FacetId f, const Vector& x) const {
    using namespace cdt::rational;
    bool inside = false;
    for (const std::uint32_t t : topology_.facet_triangles[f]) {
      const auto& [i, j, k] = topology_.triangles[t];
      const Vector normal = area(at(i), at(j), at(k));
      if (sgn(dot(normal, minus(x, at(i)))) != 0) return false;
      bool within = true, on_outline = false;
      for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
        const int side = sgn(dot(normal, area(at(topology_.from(h)), at(topology_.to(h)), x)));
        within = within && side >= 0;
        on_outline = on_outline || (side == 0 && topology_.edge_is_flat[topology_.edge_of[h]] == 0);
      }
      if (within && on_outline) return false;
      inside = inside || within;
    }
    return inside;
  }

  const cdt::CdtInput& input_;
  const SurfaceTopology& topology_;
  const PointStore& points_;
  std::set<VertexId> vertices_, listed_;
};

inline std::string wrong(const cdt::CdtInput& input, const PointStore& points) {
  return InputChecker(input, points).run();
}

}  // namespace delmesher::enrich
