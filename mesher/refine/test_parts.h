// Subsegments and subfacets of a small complex, for the tests of these and of the parts that use
// them.
#pragma once

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "mesher/geometry/vector.h"
#include "mesher/refine/cavity_constraints.h"
#include "mesher/refine/subfacets.h"
#include "mesher/refine/subsegments.h"
#include "mesher/refine/test_complexes.h"

namespace delmesher::refine {

// Breaks its invariant.
struct WorkQueueBreaker {
  WorkQueue& queue;

  void claim_to_wait(std::uint32_t n) const {
    if (n >= queue.waits_.size()) queue.waits_.resize(std::size_t{n} + 1, 0);
    queue.waits_[n] = 1;
  }
  void put_in(std::uint32_t n) const { queue.queue_.push_back(n); }
  void wait_instead(std::uint32_t n, std::uint32_t other) const {
    std::swap(queue.waits_[n], queue.waits_[other]);
  }
};

// In the Delaunay tetrahedrization of the complex's vertices. That of the box has all of them: its
// corners are on one sphere, with nothing inside, and those of the outer box are the hull.
struct Parts : Complex {
  Tetrahedrization dt{predicates};
  Subsegments subsegments;
  Subfacets subfacets;
  FacetTriangulations& planar = subfacets.planar();
  CavityConstraints constraints{dt, subsegments, subfacets};

  explicit Parts(bool gabriel = false, const Surface& surface = box())
      : Complex(surface),
        subsegments(plc(), dt, gabriel),
        subfacets(plc(), points, dt, subsegments, gabriel) {
    dt.build(vertices(), control);
    for (std::uint32_t s = 0; s < subsegments.size(); ++s) {
      subsegments.settle(s, dt.find_edge(subsegments[s].a, subsegments[s].b));
    }
    subfacets.build(control);
    for (std::uint32_t s = 0; s < subfacets.size(); ++s) {
      const auto& v = subfacets[s].v;
      subfacets.settle(s, dt.find_face(v[0], v[1], v[2]));
    }
  }

  // A cavity with the constraints in it.
  void find_cavity(VertexId v) {
    constraints.begin();
    dt.grow_cavity(v, dt.locate(v, dt.incident(0)), [&](TetId t) {
      constraints.collect(t);
      return true;
    });
  }
  void fill_cavity(VertexId v) {
    dt.fill_cavity(v);
    subfacets.begin_insertion();
    for (std::size_t n = 0; n < dt.created().size(); ++n) {
      const auto [inner, face] = dt.cavity_boundary()[n];
      subsegments.inherit(dt.created()[n], inner, face);
      subfacets.inherit(dt.created()[n], inner, face);
    }
  }

  // Insert a point at its given place.
  VertexId insert_in_volume(const Vec3& p) {
    const VertexId v = points.add_explicit(p[0], p[1], p[2]);
    find_cavity(v);
    fill_cavity(v);
    constraints.requeue_lost();
    return v;
  }
  VertexId insert_in_facet(std::uint32_t facet, const Vec3& p) {
    const VertexId v = points.add_explicit(p[0], p[1], p[2]);
    find_cavity(v);
    fill_cavity(v);
    planar.insert(v, planar.locate(v, live_in(facet).front()).subfacet);
    subfacets.settle_created();
    constraints.requeue_lost();
    return v;
  }
  // In the middle of a subsegment. Returns the second half.
  std::uint32_t split(std::uint32_t s) {
    const VertexId a = subsegments[s].a, b = subsegments[s].b;
    const Vec3 p = points.nearest(a), q = points.nearest(b);
    const VertexId v = points.add_explicit((p[0] + q[0]) / 2, (p[1] + q[1]) / 2, (p[2] + q[2]) / 2);
    const SubfacetEdge sides[2] = {subsegments[s].side[0], subsegments[s].side[1]};
    find_cavity(v);
    fill_cavity(v);
    const std::uint32_t half = subsegments.split(s, v);
    for (const SubfacetEdge side : sides) planar.insert_on_edge(v, side, s, half);
    subsegments.settle(s, dt.find_edge(a, v));
    subsegments.settle(half, dt.find_edge(v, b));
    subfacets.settle_created();
    constraints.requeue_lost();
    return half;
  }
  // A few of each kind, after which nothing is missing.
  void insert_some() {
    split(split(segment(0, 1)));
    split(segment(0, 1));
    split(segment(2, 3));
    const std::uint32_t bottom = facet_through({{{0, 0, 0}, {3, 0, 0}, {3, 2, 0}}});
    insert_in_facet(bottom, {1.25, 0.75, 0});
    insert_in_facet(bottom, {1.5, 1.0625, 0});
    insert_in_volume({1.5, 1, 0.5});
  }

  // The segment of the complex between two of its vertices.
  std::uint32_t segment(VertexId a, VertexId b) const {
    const auto found = std::ranges::find_if(plc().segments, [&](const PlcSegment& s) {
      return std::ranges::is_permutation(s.vertex, std::array{a, b});
    });
    DELMESHER_CHECK(found != plc().segments.end(), "no such segment");
    return static_cast<std::uint32_t>(found - plc().segments.begin());
  }
  // The facet of the complex that has these corners.
  std::uint32_t facet_through(const std::array<Vec3, 3>& corners) const {
    for (std::uint32_t f = 0; f < plc().facets.size(); ++f) {
      std::vector<Vec3> here;
      for (const PlcFacet::Side& side : plc().facets[f].boundary) {
        for (const VertexId v : plc().segments[side.segment].vertex) {
          here.push_back(points.nearest(v));
        }
      }
      if (std::ranges::all_of(
              corners, [&](const Vec3& c) { return std::ranges::find(here, c) != here.end(); })) {
        return f;
      }
    }
    DELMESHER_CHECK(false, "no such facet");
    return kNone;
  }

  std::vector<std::uint32_t> live_in(std::uint32_t facet) const {
    std::vector<std::uint32_t> live;
    for (std::uint32_t s = 0; s < subfacets.size(); ++s) {
      if (subfacets[s].alive && subfacets[s].facet == facet) live.push_back(s);
    }
    return live;
  }
  // Twice the area of a triangle, as a vector.
  Vec3 area(VertexId a, VertexId b, VertexId c) const {
    const Vec3 o = points.nearest(a);
    return cross(subtract(points.nearest(b), o), subtract(points.nearest(c), o));
  }
  std::vector<TetId> live_tetrahedra() const {
    std::vector<TetId> live;
    for (TetId t = 0; t < dt.capacity(); ++t) {
      if (dt.alive(t)) live.push_back(t);
    }
    return live;
  }
  // All vertices of the tetrahedrization.
  std::vector<VertexId> all_vertices() const {
    std::vector<VertexId> all;
    for (VertexId v = 0; v < points.size(); ++v) {
      if (dt.incident(v) != kNone) all.push_back(v);
    }
    return all;
  }
};

// The numbers in the queue of a part, which is empty afterwards.
template <class Part>
std::vector<std::uint32_t> taken_from(Part& part) {
  std::vector<std::uint32_t> taken;
  for (std::uint32_t s = part.take_queued(); s != kNone; s = part.take_queued()) taken.push_back(s);
  std::ranges::sort(taken);
  return taken;
}

}  // namespace delmesher::refine
