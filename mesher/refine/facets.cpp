// Local Delaunay triangulations of the facets and facet recovery (section 5.3).
#include <algorithm>
#include <cmath>

#include "mesher/base/check.h"
#include "mesher/base/numbering.h"
#include "mesher/predicates/vector.h"
#include "mesher/refine/refiner.h"

namespace delmesher {
namespace {

struct DirectedSide {
  VertexId from, to;
  std::uint32_t subsegment;
  bool operator<(const DirectedSide& other) const {
    return from != other.from ? from < other.from : to < other.to;
  }
};

const DirectedSide* find_side(const std::vector<DirectedSide>& sides, VertexId from, VertexId to) {
  const DirectedSide key{from, to, 0};
  const auto found = std::lower_bound(sides.begin(), sides.end(), key);
  return found != sides.end() && found->from == from && found->to == to ? &*found : nullptr;
}

}  // namespace

int Refiner::orient(std::uint32_t facet, VertexId a, VertexId b, VertexId c) {
  return planes_[facet].axis_sign * predicates_.orient2d(planes_[facet].axis, a, b, c);
}

bool Refiner::in_circle(const Subfacet& f, VertexId v) {
  return predicates_.insphere_perturbed(f.v[0], f.v[1], f.v[2], planes_[f.facet].apex, v) > 0;
}

// An explicit point off the facet's plane, on its outer side, about as far as the facet's frame is
// long.
void Refiner::make_apex(std::uint32_t f) {
  const PlcFacet& facet = plc_.facets[f];
  const Vec3 a = points_.nearest(facet.frame[0]);
  const Vec3 ab = subtract(points_.nearest(facet.frame[1]), a);
  const Vec3 ac = subtract(points_.nearest(facet.frame[2]), a);
  double size = 0;
  for (int k = 0; k < 3; ++k) size = std::max({size, std::abs(ab[k]), std::abs(ac[k])});
  VertexId apex = kNone;
  for (; std::isfinite(size); size *= 2) {
    Vec3 p = a;
    p[facet.axis] += facet.axis_sign * size;
    apex = points_.add_explicit(p[0], p[1], p[2]);
    if (predicates_.orient3d(facet.frame[0], facet.frame[1], facet.frame[2], apex) > 0) break;
    points_.pop_back();
    apex = kNone;
  }
  DELMESHER_CHECK(apex != kNone, "no point off a facet's plane");
  planes_[f] = {facet.axis, facet.axis_sign, apex};
}

std::uint32_t Refiner::new_subfacet(const std::array<VertexId, 3>& v, std::uint32_t facet) {
  constexpr std::size_t kMost = kNone / 3;  // edges are numbered as 3 * subfacet + edge
  if (subfacets_.size() >= kMost) stop_at_size(kMost, "subfacets");
  const auto s = static_cast<std::uint32_t>(subfacets_.size());
  subfacets_.push_back({v, {kNone, kNone, kNone}, {kNone, kNone, kNone}, facet});
  return s;
}

void Refiner::build_facets() {
  planes_.resize(plc_.facets.size());
  on_facet_.resize(plc_.facets.size());
  for (std::uint32_t f = 0; f < plc_.facets.size(); ++f) {
    control_.poll(points_.size(), static_cast<double>(f) / static_cast<double>(plc_.facets.size()));
    make_apex(f);
    build_facet(f);
  }
  facets_built_ = true;
}

void Refiner::build_facet(std::uint32_t f) {
  const PlcFacet& facet = plc_.facets[f];
  std::vector<DirectedSide> sides;
  std::vector<VertexId> vertices = facet.isolated;
  for (const PlcFacet::Side& side : facet.boundary) {
    for (std::uint32_t s = first_subsegment_[side.segment]; s != kNone; s = subsegments_[s].next) {
      const Subsegment& sub = subsegments_[s];
      sides.push_back(side.reversed ? DirectedSide{sub.b, sub.a, s}
                                    : DirectedSide{sub.a, sub.b, s});
      vertices.push_back(sub.a);
      vertices.push_back(sub.b);
    }
  }
  std::sort(sides.begin(), sides.end());
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  if (sides.empty()) return;
  const PlanarTriangulation planar = triangulate_planar(predicates_, planes_[f], vertices);

  // 1: inside, 2: outside; decided at the sides and flooded between them.
  std::vector<std::uint8_t> place(planar.triangles.size(), 0);
  std::vector<std::uint32_t> stack;
  std::size_t found = 0;
  const auto side_of = [&](std::uint32_t t, int i, bool* inward) -> const DirectedSide* {
    const VertexId from = planar.triangles[t][(i + 1) % 3];
    const VertexId to = planar.triangles[t][(i + 2) % 3];
    const DirectedSide* side = find_side(sides, from, to);
    *inward = side != nullptr;
    return side != nullptr ? side : find_side(sides, to, from);
  };
  for (std::uint32_t t = 0; t < planar.triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      bool inward = false;
      if (side_of(t, i, &inward) == nullptr) continue;
      found += inward ? 1 : 0;
      if (place[t] == 0) stack.push_back(t);
      DELMESHER_CHECK(place[t] == 0 || place[t] == (inward ? 1 : 2),
                      "facet boundary not consistent");
      place[t] = inward ? 1 : 2;
    }
  }
  DELMESHER_CHECK(found == sides.size(), "subsegment is no edge of its facet's triangulation");
  while (!stack.empty()) {
    const std::uint32_t t = stack.back();
    stack.pop_back();
    for (int i = 0; i < 3; ++i) {
      bool inward = false;
      const std::uint32_t next = planar.neighbors[t][i];
      if (next == kNone || side_of(t, i, &inward) != nullptr || place[next / 3] != 0) continue;
      place[next / 3] = place[t];
      stack.push_back(next / 3);
    }
  }

  std::vector<std::uint32_t> id(planar.triangles.size(), kNone);
  for (std::uint32_t t = 0; t < planar.triangles.size(); ++t) {
    if (place[t] == 1) id[t] = new_subfacet(planar.triangles[t], f);
  }
  for (std::uint32_t t = 0; t < planar.triangles.size(); ++t) {
    if (id[t] == kNone) continue;
    Subfacet& sub = subfacets_[id[t]];
    for (int i = 0; i < 3; ++i) {
      bool inward = false;
      if (const DirectedSide* side = side_of(t, i, &inward)) {
        sub.subsegment[i] = side->subsegment;
        auto& handles = subsegments_[side->subsegment].side;
        (handles[0] == kNone ? handles[0] : handles[1]) = 3 * id[t] + static_cast<std::uint32_t>(i);
      } else {
        const std::uint32_t next = planar.neighbors[t][i];
        DELMESHER_CHECK(next != kNone && id[next / 3] != kNone, "facet boundary not closed");
        sub.neighbor[i] = 3 * id[next / 3] + next % 3;
      }
    }
  }
}

void Refiner::recover_facets() {
  const auto count = static_cast<std::uint32_t>(subfacets_.size());
  for (std::uint32_t s = 0; s < count; ++s) {
    control_.poll(points_.size());
    const auto& v = subfacets_[s].v;
    check_subfacet(s, dt_.find_face(v[0], v[1], v[2]));
  }
  drain();
}

// Marks the subfacet on face `face` (4 * tet + index, or kNone) of the tetrahedrization; queues it
// if it is missing or encroached. For a present face only the two opposite vertices matter.
void Refiner::check_subfacet(std::uint32_t s, std::uint32_t face) {
  if (face == kNone) {
    queue_subfacet(s);
    return;
  }
  const auto& c = subfacets_[s].v;
  const TetId t[2] = {face >> 2, dt_.neighbor(face >> 2, static_cast<int>(face & 3U))};
  const int i[2] = {static_cast<int>(face & 3U),
                    dt_.mirror(face >> 2, static_cast<int>(face & 3U))};
  for (int k = 0; k < 2; ++k) {
    subfacet_[t[k]][i[k]] = s;
    note(t[k], kFaces) |= static_cast<std::uint8_t>(1U << i[k]);
    const VertexId v = dt_.vertex(t[k], i[k]);
    if (!options_.gabriel || v == kInfinite) continue;
    if (predicates_.in_diametral_ball(c[0], c[1], c[2], v) > 0) queue_subfacet(s);
  }
}

std::uint32_t Refiner::locate_subfacet(VertexId v, std::uint32_t start, std::uint32_t* blocked) {
  *blocked = kNone;
  std::uint32_t s = start;
  int entered = -1;
  for (;;) {
    const Subfacet& f = subfacets_[s];
    int leave = -1;
    for (int i = 0; i < 3 && leave < 0; ++i) {
      if (i != entered && orient(f.facet, f.v[(i + 1) % 3], f.v[(i + 2) % 3], v) < 0) leave = i;
    }
    if (leave < 0) return s;
    if (f.subsegment[leave] != kNone) {
      *blocked = f.subsegment[leave];
      return kNone;
    }
    const std::uint32_t next = f.neighbor[leave];
    s = next / 3;
    entered = static_cast<int>(next % 3);
  }
}

void Refiner::split_subfacet(std::uint32_t s) {
  const std::uint32_t facet = subfacets_[s].facet;
  const VertexId v = steiner_.in_facet(facet, subfacets_[s].v);
  std::uint32_t blocked = kNone;
  const std::uint32_t container = locate_subfacet(v, s, &blocked);
  if (container == kNone) {
    // Only possible while a subsegment of the facet is encroached or bent: it goes first.
    points_.pop_back();
    queue_subsegment(blocked);
    queue_subfacet(s);
    return;
  }
  VertexId duplicate = kNone;
  const TetId start = dt_.locate(v, dt_.incident(subfacets_[container].v[0]), &duplicate);
  DELMESHER_CHECK(duplicate == kNone, "split point of a subfacet coincides with a vertex");
  if (!find_free_cavity(v, start, false)) {
    points_.pop_back();
    queue_subfacet(s);
    return;
  }
  ++on_facets_;
  on_facet_[facet].push_back(v);
  if (options_.gabriel) queue_encroached_subfacets(v);
  commit(v);
  new_subfacets_.clear();
  insert_in_facet(v, container, kNone, kNone, kNone);
  after_insertion();
}

void Refiner::insert_in_facet(VertexId v, std::uint32_t start, std::uint32_t split,
                              std::uint32_t half_a, std::uint32_t half_b) {
  const std::uint32_t facet = subfacets_[start].facet;
  std::vector<std::uint32_t> cavity;
  std::vector<std::uint32_t> rim;  // boundary edges as 3 * subfacet + edge
  std::vector<std::uint32_t> excluded;
  const auto contains = [](const std::vector<std::uint32_t>& list, std::uint32_t x) {
    return std::find(list.begin(), list.end(), x) != list.end();
  };
  // The cavity is star-shaped in theory; a point that bends an artificial edge may see a far rim
  // edge from behind: such subfacets are left out.
  for (bool again = true; again;) {
    again = false;
    cavity.assign(1, start);
    rim.clear();
    for (std::size_t n = 0; n < cavity.size(); ++n) {
      const std::uint32_t s = cavity[n];
      for (std::uint32_t i = 0; i < 3; ++i) {
        const std::uint32_t next = subfacets_[s].neighbor[i];
        if (next != kNone && contains(cavity, next / 3)) continue;
        if (next != kNone && !contains(excluded, next / 3) && in_circle(subfacets_[next / 3], v)) {
          cavity.push_back(next / 3);
          continue;
        }
        rim.push_back(3 * s + i);
      }
    }
    // An edge may have been put on the rim before the subfacet beyond it joined the cavity.
    std::erase_if(rim, [&](std::uint32_t e) {
      const std::uint32_t next = subfacets_[e / 3].neighbor[e % 3];
      return e == split || (next != kNone && contains(cavity, next / 3));
    });
    for (const std::uint32_t e : rim) {
      const auto& c = subfacets_[e / 3].v;
      if (orient(facet, c[(e + 1) % 3], c[(e + 2) % 3], v) > 0) continue;
      DELMESHER_CHECK(e / 3 != start, "planar cavity is not star-shaped");
      excluded.push_back(e / 3);
      again = true;
      break;
    }
  }

  struct Spoke {
    VertexId from;
    std::uint32_t subfacet;
  };
  std::vector<Spoke> spokes;
  for (const std::uint32_t e : rim) {
    const auto c = subfacets_[e / 3].v;
    const VertexId x = c[(e + 1) % 3];
    const VertexId y = c[(e + 2) % 3];
    const std::uint32_t created = new_subfacet({v, x, y}, facet);
    const std::uint32_t beyond = subfacets_[e / 3].neighbor[e % 3];
    const std::uint32_t subsegment = subfacets_[e / 3].subsegment[e % 3];
    subfacets_[created].neighbor[0] = beyond;
    subfacets_[created].subsegment[0] = subsegment;
    if (beyond != kNone) subfacets_[beyond / 3].neighbor[beyond % 3] = 3 * created;
    if (subsegment != kNone) {
      for (std::uint32_t& handle : subsegments_[subsegment].side) {
        if (handle == e) handle = 3 * created;
      }
    }
    spokes.push_back({x, created});
    new_subfacets_.push_back(created);
  }
  std::sort(spokes.begin(), spokes.end(),
            [](const Spoke& a, const Spoke& b) { return a.from < b.from; });
  const auto attach_half = [&](std::uint32_t created, std::uint32_t edge, VertexId end) {
    DELMESHER_CHECK(half_a != kNone, "planar cavity is open");
    const std::uint32_t half =
        subsegments_[half_a].a == end || subsegments_[half_a].b == end ? half_a : half_b;
    subfacets_[created].subsegment[edge] = half;
    auto& handles = subsegments_[half].side;
    (handles[0] == kNone ? handles[0] : handles[1]) = 3 * created + edge;
  };
  for (const Spoke& spoke : spokes) {
    const VertexId y = subfacets_[spoke.subfacet].v[2];
    const auto next = std::lower_bound(spokes.begin(), spokes.end(), y,
                                       [](const Spoke& a, VertexId b) { return a.from < b; });
    if (next != spokes.end() && next->from == y) {
      subfacets_[spoke.subfacet].neighbor[1] = 3 * next->subfacet + 2;
      subfacets_[next->subfacet].neighbor[2] = 3 * spoke.subfacet + 1;
    } else {
      attach_half(spoke.subfacet, 1, y);
    }
  }
  for (const Spoke& spoke : spokes) {
    if (subfacets_[spoke.subfacet].neighbor[2] == kNone) attach_half(spoke.subfacet, 2, spoke.from);
  }
  for (const std::uint32_t s : cavity) subfacets_[s].alive = false;
  dead_subfacets_ += cavity.size();
}

// Dead subfacets keep their slots, so that stale references to them are recognized; where they
// outnumber the living, all are renumbered, in the same order. Not to be called during a split.
void Refiner::compact_subfacets() {
  constexpr std::size_t kFew = 4096;
  if (dead_subfacets_ < kFew || 2 * dead_subfacets_ < subfacets_.size()) return;
  std::vector<std::uint32_t> renumbered(subfacets_.size(), kNone);
  std::uint32_t count = 0;
  for (std::uint32_t s = 0; s < subfacets_.size(); ++s) {
    if (!subfacets_[s].alive) continue;
    renumbered[s] = count;
    subfacets_[count++] = subfacets_[s];
  }
  subfacets_.resize(count);
  dead_subfacets_ = 0;
  const auto renumber = [&](std::uint32_t& handle) {  // 3 * subfacet + edge
    if (handle != kNone) handle = 3 * renumbered[handle / 3] + handle % 3;
  };
  for (Subfacet& f : subfacets_) {
    for (std::uint32_t& handle : f.neighbor) renumber(handle);
  }
  for (Subsegment& s : subsegments_) {
    if (!s.alive) continue;
    for (std::uint32_t& handle : s.side) renumber(handle);
  }
  for (TetId t = 0; t < dt_.capacity(); ++t) {
    if (note(t, kFaces) == 0 || !dt_.alive(t)) continue;
    for (int i = 0; i < 4; ++i) {
      if ((note(t, kFaces) >> i & 1) == 0) continue;
      std::uint32_t& s = subfacet_[t][i];
      s = renumbered[s];
      if (s == kNone) note(t, kFaces) &= static_cast<std::uint8_t>(~(1U << i));
    }
  }
  std::deque<std::uint32_t> queue;
  for (const std::uint32_t s : subfacet_queue_) {
    if (renumbered[s] != kNone) queue.push_back(renumbered[s]);
  }
  subfacet_queue_.swap(queue);
  subfacet_stamp_.assign(count, 0);
}

}  // namespace delmesher
