#include "mesher/refine/facet_triangulations.h"

#include <algorithm>
#include <cmath>

#include "mesher/base/check.h"
#include "mesher/base/numbering.h"
#include "mesher/base/sort_unique.h"
#include "mesher/geometry/vector.h"
#include "mesher/refine/facet_boundary.h"

namespace delmesher::refine {

std::uint32_t FacetTriangulations::add(const std::array<VertexId, 3>& v, std::uint32_t facet) {
  constexpr std::size_t kMost = SubfacetEdge::kMostSubfacets;
  if (list_.size() >= kMost) stop_at_size(kMost, "subfacets");
  const std::uint32_t s = size();
  list_.push_back({v, {}, {kNone, kNone, kNone}, facet});
  return s;
}

// --------------------------------------------------------------------------------- triangulating

void FacetTriangulations::build(Control& control) {
  planes_.resize(plc_.facets.size());
  for (std::uint32_t f = 0; f < plc_.facets.size(); ++f) {
    control.poll(points_.size(), static_cast<double>(f) / static_cast<double>(plc_.facets.size()));
    make_point_off_plane(f);
    build_facet(f);
  }
  built_ = true;
}

// An explicit point off the facet's plane, on its outer side, about as far as the facet's frame is
// long.
void FacetTriangulations::make_point_off_plane(std::uint32_t f) {
  const PlcFacet& facet = plc_.facets[f];
  const Vec3 a = points_.nearest(facet.frame[0]);
  const Vec3 ab = subtract(points_.nearest(facet.frame[1]), a);
  const Vec3 ac = subtract(points_.nearest(facet.frame[2]), a);
  double size = 0;
  for (int k = 0; k < 3; ++k) size = std::max({size, std::abs(ab[k]), std::abs(ac[k])});
  VertexId point = kNone;
  for (; std::isfinite(size); size *= 2) {
    Vec3 p = a;
    p[facet.axis] += facet.axis_sign * size;
    point = points_.add_explicit(p[0], p[1], p[2]);
    if (predicates_.orient3d(facet.frame[0], facet.frame[1], facet.frame[2], point) > 0) break;
    points_.pop_back();
    point = kNone;
  }
  DELMESHER_CHECK(point != kNone, "no double is off a facet's plane");
  planes_[f] = {facet.axis, facet.axis_sign, point};
}

void FacetTriangulations::build_facet(std::uint32_t f) {
  const PlcFacet& facet = plc_.facets[f];
  std::vector<DirectedSide> sides;
  std::vector<VertexId> vertices = facet.isolated;
  for (const PlcFacet::Side& side : facet.boundary) {
    for (std::uint32_t s = side.segment; s != kNone; s = subsegments_[s].next) {
      const VertexId a = subsegments_[s].a, b = subsegments_[s].b;
      sides.push_back(side.reversed ? DirectedSide{b, a, s} : DirectedSide{a, b, s});
      vertices.push_back(a);
      vertices.push_back(b);
    }
  }
  sort_unique(vertices);
  const FacetBoundary boundary(std::move(sides));
  if (boundary.empty()) return;
  const PlanarTriangulation planar = triangulate_planar(predicates_, planes_[f], vertices);
  const std::vector<std::uint8_t> inside = boundary.inside(planar);

  std::vector<std::uint32_t> id(planar.triangles.size(), kNone);
  for (std::uint32_t t = 0; t < planar.triangles.size(); ++t) {
    if (inside[t] != 0) id[t] = add(planar.triangles[t], f);
  }
  for (std::uint32_t t = 0; t < planar.triangles.size(); ++t) {
    if (id[t] == kNone) continue;
    for (std::uint32_t i = 0; i < 3; ++i) {
      bool inward = false;
      const auto [from, to] = ends({id[t], i});
      const std::uint32_t subsegment = boundary.find(from, to, &inward);
      if (subsegment != kNone) {
        link(id[t], i, subsegment);
        continue;
      }
      const std::uint32_t next = planar.neighbors[t][i];
      DELMESHER_CHECK(next != kNone && id[next / 3] != kNone,
                      "the boundary of a facet is not closed");
      list_[id[t]].neighbor[i] = {id[next / 3], next % 3};
    }
  }
}

// The edge of the subfacet is the subsegment, which learns of it.
void FacetTriangulations::link(std::uint32_t s, std::uint32_t edge, std::uint32_t subsegment) {
  list_[s].subsegment[edge] = subsegment;
  subsegments_.attach(subsegment, {s, edge});
}

// ------------------------------------------------------------------------- inserting in the plane

FacetTriangulations::Location FacetTriangulations::locate(VertexId v, std::uint32_t start) const {
  std::uint32_t s = start;
  std::uint32_t entered = kNone;
  for (;;) {
    const Subfacet& f = list_[s];
    std::uint32_t leave = kNone;
    for (std::uint32_t i = 0; i < 3 && leave == kNone; ++i) {
      if (i == entered) continue;
      if (orient(f.facet, f.v[(i + 1) % 3], f.v[(i + 2) % 3], v) < 0) leave = i;
    }
    if (leave == kNone) return {s, kNone};
    if (f.subsegment[leave] != kNone) return {kNone, f.subsegment[leave]};
    s = f.neighbor[leave].subfacet();
    entered = f.neighbor[leave].edge();
  }
}

void FacetTriangulations::insert(VertexId v, std::uint32_t container) {
  cavity_.find(*this, v, container, {});
  fill_cavity(v, kNone, kNone);
}

void FacetTriangulations::insert_on_edge(VertexId v, SubfacetEdge side, std::uint32_t half_a,
                                         std::uint32_t half_b) {
  subsegments_.replace_side(half_a, side, {});
  cavity_.find(*this, v, side.subfacet(), side);
  fill_cavity(v, half_a, half_b);
}

// Replaces the cavity by the triangles from v to its skin. A side of v that no other triangle has
// must be one of the two halves of a subsegment.
void FacetTriangulations::fill_cavity(VertexId v, std::uint32_t half_a, std::uint32_t half_b) {
  const std::uint32_t facet = list_[cavity_.subfacets().front()].facet;
  spokes_.clear();
  for (const SubfacetEdge e : cavity_.skin()) {
    const auto [x, y] = ends(e);
    const std::uint32_t created = add({v, x, y}, facet);
    const SubfacetEdge base(created, 0);
    const SubfacetEdge beyond = list_[e.subfacet()].neighbor[e.edge()];
    const std::uint32_t subsegment = list_[e.subfacet()].subsegment[e.edge()];
    list_[created].neighbor[0] = beyond;
    list_[created].subsegment[0] = subsegment;
    if (beyond.exists()) list_[beyond.subfacet()].neighbor[beyond.edge()] = base;
    if (subsegment != kNone) subsegments_.replace_side(subsegment, e, base);
    spokes_.push_back({x, created});
    created_.push_back(created);
  }
  std::sort(spokes_.begin(), spokes_.end(),
            [](const Spoke& a, const Spoke& b) { return a.from < b.from; });
  const auto attach_half = [&](std::uint32_t created, std::uint32_t edge, VertexId end) {
    DELMESHER_CHECK(half_a != kNone, "a planar cavity is open");
    const bool first = subsegments_[half_a].a == end || subsegments_[half_a].b == end;
    link(created, edge, first ? half_a : half_b);
  };
  for (const Spoke& spoke : spokes_) {
    const VertexId y = list_[spoke.subfacet].v[2];
    const auto next = std::lower_bound(spokes_.begin(), spokes_.end(), y,
                                       [](const Spoke& a, VertexId b) { return a.from < b; });
    if (next != spokes_.end() && next->from == y) {
      list_[spoke.subfacet].neighbor[1] = {next->subfacet, 2};
      list_[next->subfacet].neighbor[2] = {spoke.subfacet, 1};
    } else {
      attach_half(spoke.subfacet, 1, y);
    }
  }
  for (const Spoke& spoke : spokes_) {
    if (!list_[spoke.subfacet].neighbor[2].exists()) attach_half(spoke.subfacet, 2, spoke.from);
  }
  for (const std::uint32_t s : cavity_.subfacets()) list_[s].alive = false;
  dead_ += cavity_.subfacets().size();
}

// ----------------------------------------------------------------------------------- renumbering

bool FacetTriangulations::sparse() const {
  constexpr std::size_t kFew = 4096;
  return dead_ >= kFew && 2 * dead_ >= list_.size();
}

std::vector<std::uint32_t> FacetTriangulations::renumber() {
  std::vector<std::uint32_t> number(list_.size(), kNone);
  std::uint32_t count = 0;
  for (std::uint32_t s = 0; s < list_.size(); ++s) {
    if (!list_[s].alive) continue;
    number[s] = count;
    list_[count++] = list_[s];
  }
  list_.resize(count);
  dead_ = 0;
  const auto renumbered = [&](SubfacetEdge e) {
    return e.exists() ? SubfacetEdge(number[e.subfacet()], e.edge()) : e;
  };
  for (Subfacet& f : list_) {
    for (SubfacetEdge& e : f.neighbor) e = renumbered(e);
  }
  subsegments_.renumber_sides(renumbered);
  return number;
}

// ------------------------------------------------------------------------------------ validation

void FacetTriangulations::validate(Control& control) const {
  validate_dead();
  for (std::uint32_t s = 0; s < list_.size(); ++s) {
    control.poll();
    if (list_[s].alive) validate_subfacet(s);
  }
}

void FacetTriangulations::validate_dead() const {
  std::size_t dead = 0;
  for (const Subfacet& f : list_) dead += f.alive ? 0 : 1;
  DELMESHER_CHECK(dead == dead_, "dead subfacets are not counted");
}

void FacetTriangulations::validate_subfacet(std::uint32_t s) const {
  const Subfacet& f = list_[s];
  DELMESHER_CHECK(orient(f.facet, f.v[0], f.v[1], f.v[2]) > 0, "a subfacet is turned over");
  for (std::uint32_t i = 0; i < 3; ++i) {
    const SubfacetEdge here(s, i), there = f.neighbor[i];
    DELMESHER_CHECK(there.exists() != (f.subsegment[i] != kNone),
                    "an edge of a subfacet has no other side, or two");
    if (!there.exists()) continue;
    DELMESHER_CHECK(there.subfacet() < list_.size() && there.edge() < 3,
                    "a subfacet has no such neighbour");
    const Subfacet& g = list_[there.subfacet()];
    const auto [x, y] = ends(here);
    const std::array<VertexId, 2> back = {y, x};
    DELMESHER_CHECK(
        g.alive && g.facet == f.facet && g.neighbor[there.edge()] == here && ends(there) == back,
        "two subfacets disagree about their common edge");
    DELMESHER_CHECK(!in_circle(s, g.v[there.edge()]), "an edge of a facet is not locally Delaunay");
  }
}

}  // namespace delmesher::refine
