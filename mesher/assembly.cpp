#include "mesher/assembly.h"

#include <algorithm>
#include <cmath>

#include "mesher/output/statistics.h"
#include "mesher/surface/bvh.h"
#include "mesher/surface/feature_size.h"

namespace delmesher {
namespace {

// What the refinement did not see: the spheres and cylinders of the chamfering, and the filtered
// facets. A volume vertex in the former or crowding the latter would make needless bad tetrahedra
// when they return.
class RemovedSurface {
 public:
  RemovedSurface(const ChamferResult& chamfered, const std::vector<std::uint8_t>& facet_kept,
                 const SurfaceTopology& topology, const PointStore& points)
      : points_(points),
        topology_(topology),
        chamfers_(build_chamfers(chamfered)),
        dropped_(build_dropped(facet_kept)) {}

  // `spacing` is the distance of p to its nearest neighbour in the refined mesh.
  bool crowded(const Vec3& p, double spacing) const {
    const bool in_chamfer = !chamfers_.query({p, p}, [&](std::uint32_t n) {
      return !(point_segment_distance(p, items_[n].a, items_[n].b) < items_[n].radius);
    });
    if (in_chamfer) return true;
    // Nearer than this fraction of its spacing, a vertex sees a filtered facet under too small
    // angles.
    constexpr double kCrowding = 0.3;
    const double reach = kCrowding * spacing;
    Box box{p, p};
    for (int k = 0; k < 3; ++k) {
      box.lo[k] -= reach;
      box.hi[k] += reach;
    }
    return !dropped_.query(box, [&](std::uint32_t n) {
      return !(point_triangle_distance(p, corners(dropped_triangles_[n])) <= reach);
    });
  }

 private:
  struct Item {
    Vec3 a, b;  // the same for a sphere
    double radius;
  };

  std::array<Vec3, 3> corners(std::uint32_t t) const {
    const auto& v = topology_.triangles[t];
    return {points_.nearest(v[0]), points_.nearest(v[1]), points_.nearest(v[2])};
  }

  void add(VertexId a, VertexId b, double radius, std::vector<Box>& boxes) {
    if (!(radius > 0)) return;
    items_.push_back({points_.nearest(a), points_.nearest(b), radius});
    Box box = Box::around(std::array<Vec3, 2>{items_.back().a, items_.back().b});
    for (int k = 0; k < 3; ++k) {
      box.lo[k] -= radius;
      box.hi[k] += radius;
    }
    boxes.push_back(box);
  }

  Bvh build_chamfers(const ChamferResult& chamfered) {
    std::vector<Box> boxes;
    for (VertexId v = 0; v < chamfered.vertex_radius.size(); ++v) {
      add(v, v, chamfered.vertex_radius[v], boxes);
    }
    for (std::uint32_t e = 0; e < chamfered.edge_radius.size(); ++e) {
      const auto ends = topology_.edge_vertices(e);
      add(ends[0], ends[1], chamfered.edge_radius[e], boxes);
    }
    return Bvh(boxes);
  }

  Bvh build_dropped(const std::vector<std::uint8_t>& facet_kept) {
    std::vector<Box> boxes;
    for (std::uint32_t t = 0; t < topology_.triangles.size() && !facet_kept.empty(); ++t) {
      if (facet_kept[topology_.facet_of[t]] != 0) continue;
      dropped_triangles_.push_back(t);
      boxes.push_back(Box::around(corners(t)));
    }
    return Bvh(boxes);
  }

  const PointStore& points_;
  const SurfaceTopology& topology_;
  std::vector<Item> items_;
  std::vector<std::uint32_t> dropped_triangles_;
  Bvh chamfers_, dropped_;
};

// Per point of the store: distance to its nearest neighbour along an edge of the refined mesh.
std::vector<double> spacings(const RefineResult& refined, const PointStore& points) {
  std::vector<double> spacing(points.size(), HUGE_VAL);
  for (const auto& t : refined.tetrahedra) {
    for (const auto& e : kEdge) {
      const Vec3 p = points.nearest(t[e[0]]);
      const double length =
          point_segment_distance(p, points.nearest(t[e[1]]), points.nearest(t[e[1]]));
      for (const int end : e) spacing[t[end]] = std::min(spacing[t[end]], length);
    }
  }
  return spacing;
}

void sort_unique(std::vector<VertexId>& v) {
  std::sort(v.begin(), v.end());
  v.erase(std::unique(v.begin(), v.end()), v.end());
}

// Points of the refined complex on input edges and inside input facets; everything else on the
// complex (the box) goes to `vertices`. Not those on artificial segments: beside the edges of the
// corner that was cut off, inside their diametral balls, they would have these edges split once
// more, next to the corner, and three of four small angles came from there.
void add_complex_points(const ChamferResult& chamfered, const RefineResult& refined,
                        const SurfaceTopology& topology, const PointStore& points,
                        Predicates& predicates, CdtInput& input) {
  const Plc& plc = chamfered.plc;
  for (std::size_t n = 0; n < plc.segments.size(); ++n) {
    const std::uint32_t e = plc.segments[n].input_edge;
    if (e == kNone) continue;
    for (const VertexId v : refined.chain[n]) {
      if (!points.is_explicit(v)) input.on_edge[e].push_back(v);
    }
  }
  for (std::uint32_t f = 0; f < plc.facets.size(); ++f) {
    const FacetId facet = plc.facets[f].input_facet;
    std::vector<VertexId>& inside = facet == kNone ? input.vertices : input.on_facet[facet];
    inside.insert(inside.end(), refined.on_facet[f].begin(), refined.on_facet[f].end());
    if (facet != kNone) continue;
    for (const PlcFacet::Side& side : plc.facets[f].boundary) {
      const std::vector<VertexId>& chain = refined.chain[side.segment];
      inside.insert(inside.end(), chain.begin(), chain.end());
    }
  }
  for (std::uint32_t e = 0; e < input.on_edge.size(); ++e) {
    std::vector<VertexId>& chain = input.on_edge[e];
    const auto ends = topology.edge_vertices(e);
    sort_unique(chain);
    std::sort(chain.begin(), chain.end(), [&](VertexId a, VertexId b) {
      return a != b && predicates.dot_difference_sign(a, b, ends[0], ends[1]) > 0;
    });
    input.vertices.insert(input.vertices.end(), chain.begin(), chain.end());
  }
  for (std::vector<VertexId>& inside : input.on_facet) {
    sort_unique(inside);
    input.vertices.insert(input.vertices.end(), inside.begin(), inside.end());
  }
}

// Drops points that coincide with an input vertex which the complex lacks, e.g. the midpoint of a
// chamfered region that happens to be a flat vertex: one of coincident points stays, the input
// vertex.
void drop_coincident(const PointStore& points, Predicates& predicates, CdtInput& input) {
  std::vector<VertexId>& all = input.vertices;
  sort_unique(all);
  std::vector<VertexId> order = all;
  std::sort(order.begin(), order.end(), [&](VertexId a, VertexId b) {
    const Vec3 p = points.nearest(a);
    const Vec3 q = points.nearest(b);
    return p != q ? p < q : a < b;
  });
  std::vector<VertexId> dropped;
  for (std::size_t n = 0; n + 1 < order.size(); ++n) {
    // Equal points have equal nearest doubles; a run of those is short.
    for (std::size_t m = n + 1; m < order.size(); ++m) {
      if (points.nearest(order[m]) != points.nearest(order[n])) break;
      if (predicates.compare_xyz(order[n], order[m]) == 0) dropped.push_back(order[m]);
    }
  }
  if (dropped.empty()) return;
  std::sort(dropped.begin(), dropped.end());
  const auto prune = [&](std::vector<VertexId>& list) {
    std::erase_if(
        list, [&](VertexId v) { return std::binary_search(dropped.begin(), dropped.end(), v); });
  };
  prune(all);
  for (auto& list : input.on_edge) prune(list);
  for (auto& list : input.on_facet) prune(list);
}

using FaceKey = std::array<VertexId, 3>;

FaceKey face_key(VertexId a, VertexId b, VertexId c) {
  FaceKey key = {a, b, c};
  std::sort(key.begin(), key.end());
  return key;
}

RoundingInput rounding_input(const PointStore& points, std::size_t input_vertices) {
  RoundingInput input;
  input.points = &points;
  input.fixed.resize(points.size());
  input.on_surface.resize(points.size());
  for (VertexId v = 0; v < points.size(); ++v) {
    // Only points of the input and of the box have supports.
    input.on_surface[v] = points.planes(v).empty() ? 0 : 1;
    input.fixed[v] = v < input_vertices || (points.is_explicit(v) && input.on_surface[v] != 0);
  }
  return input;
}

}  // namespace

void tighten_corners(const Vec3& place, double otherwise, const SurfaceTopology& topology,
                     const PointStore& points, std::vector<double>& vertex_cosine_squared) {
  if (vertex_cosine_squared.empty()) {
    vertex_cosine_squared.assign(topology.vertex_half_edge.size(), otherwise);
  }
  // The nearest vertex that is not tight yet, and those that share an edge with it: where the
  // refinement runs away, at least one corner between the two thresholds is left.
  VertexId nearest = kNone;
  double smallest = 0;
  for (VertexId v = 0; v < topology.vertex_half_edge.size(); ++v) {
    if (topology.vertex_half_edge[v] == kNone || vertex_cosine_squared[v] == 0) continue;
    const double distance = point_segment_distance(place, points.nearest(v), points.nearest(v));
    if (nearest == kNone || distance < smallest) {
      nearest = v;
      smallest = distance;
    }
  }
  if (nearest == kNone) return;
  vertex_cosine_squared[nearest] = 0;
  for (std::uint32_t e = 0; e < topology.edge_count(); ++e) {
    const auto ends = topology.edge_vertices(e);
    if (ends[0] == nearest) vertex_cosine_squared[ends[1]] = 0;
    if (ends[1] == nearest) vertex_cosine_squared[ends[0]] = 0;
  }
}

std::vector<Box> removed_boxes(const ChamferResult& chamfered,
                               const std::vector<std::uint8_t>& facet_kept,
                               const SurfaceTopology& topology, const PointStore& points) {
  // The refinement bends artificial edges by a millionth of their length; a hundredth of the radius
  // is ample.
  constexpr double kMargin = 1.01;
  std::vector<Box> boxes;
  const auto add = [&](std::span<const VertexId> corners, double radius) {
    Box box = Box::empty();
    for (const VertexId v : corners) box.extend({points.nearest(v), points.nearest(v)});
    for (int k = 0; k < 3; ++k) {
      box.lo[k] -= radius;
      box.hi[k] += radius;
    }
    boxes.push_back(box);
  };
  for (VertexId v = 0; v < chamfered.vertex_radius.size(); ++v) {
    const double radius = chamfered.vertex_radius[v];
    if (radius > 0) add(std::array{v}, radius * kMargin);
  }
  for (std::uint32_t e = 0; e < chamfered.edge_radius.size(); ++e) {
    const double radius = chamfered.edge_radius[e];
    if (radius > 0) add(topology.edge_vertices(e), radius * kMargin);
  }
  for (std::uint32_t t = 0; t < topology.triangles.size(); ++t) {
    if (!facet_kept.empty() && facet_kept[topology.facet_of[t]] == 0) add(topology.triangles[t], 0);
  }
  return boxes;
}

CdtInput plain_input(const SurfaceTopology& topology) {
  CdtInput input;
  input.topology = &topology;
  input.on_edge.resize(topology.edge_count());
  input.on_facet.resize(topology.facet_triangles.size());
  for (VertexId v = 0; v < topology.vertex_half_edge.size(); ++v) {
    if (topology.vertex_half_edge[v] != kNone) input.vertices.push_back(v);
  }
  return input;
}

CdtInput enriched_input(const ChamferResult& chamfered, const std::vector<std::uint8_t>& facet_kept,
                        const RefineResult& refined, const SurfaceTopology& topology,
                        const PointStore& points, Predicates& predicates, Control& control) {
  CdtInput input = plain_input(topology);
  add_complex_points(chamfered, refined, topology, points, predicates, input);
  const RemovedSurface removed(chamfered, facet_kept, topology, points);
  const std::vector<double> spacing = spacings(refined, points);
  for (const VertexId v : refined.in_volume) {
    control.poll(points.size());
    if (!removed.crowded(points.nearest(v), spacing[v])) input.vertices.push_back(v);
  }
  drop_coincident(points, predicates, input);
  return input;
}

namespace {

// Of a tetrahedron's repeated faces, those repeated within the region.
std::uint8_t within(Region region, std::uint8_t repeated) {
  return static_cast<std::uint8_t>(region == Region::interior ? repeated >> 4U : repeated & 15U);
}

}  // namespace

MeshToWrite conforming_mesh(const CdtResult& cdt, const SurfaceTopology& topology,
                            const PointStore& points, Region region) {
  MeshToWrite mesh{rounding_input(points, topology.vertex_half_edge.size()), {}, {}};
  RoundingInput& input = mesh.rounding;
  const auto inside = static_cast<std::size_t>(std::count(cdt.inside.begin(), cdt.inside.end(), 1));
  input.tetrahedra.reserve(region == Region::interior ? inside : cdt.tetrahedra.size());
  input.inside.reserve(input.tetrahedra.capacity());
  mesh.repeated_faces.reserve(input.tetrahedra.capacity());
  for (std::size_t n = 0; n < cdt.tetrahedra.size(); ++n) {
    if (region == Region::interior && cdt.inside[n] == 0) continue;
    input.tetrahedra.push_back(cdt.tetrahedra[n]);
    input.inside.push_back(cdt.inside[n]);
    if (!cdt.repeated_faces.empty()) {
      mesh.repeated_faces.push_back(within(region, cdt.repeated_faces[n]));
    }
  }
  for (const SurfaceFace& face : cdt.boundary) {
    input.boundary.push_back(face.vertices);
    mesh.boundary_facet.push_back(face.facet);
  }
  return mesh;
}

MeshToWrite approximate_mesh(const ChamferResult& chamfered, const RefineResult& refined,
                             const SurfaceTopology& topology, const PointStore& points,
                             Region region) {
  MeshToWrite mesh{rounding_input(points, topology.vertex_half_edge.size()), {}, {}};
  RoundingInput& input = mesh.rounding;
  std::vector<FaceKey> written;
  for (std::size_t n = 0; n < refined.tetrahedra.size(); ++n) {
    const bool inside = refined.side[n] == Side::inside;
    if (region == Region::interior && !inside) continue;
    const auto& t = refined.tetrahedra[n];
    input.tetrahedra.push_back(t);
    input.inside.push_back(inside ? 1 : 0);
    for (const auto& f : kFace) written.push_back(face_key(t[f[0]], t[f[1]], t[f[2]]));
  }
  std::sort(written.begin(), written.end());
  for (const RefinedFace& face : refined.faces) {
    const FacetId facet = chamfered.plc.facets[face.facet].input_facet;
    const auto& v = face.vertices;
    if (facet == kNone ||
        !std::binary_search(written.begin(), written.end(), face_key(v[0], v[1], v[2]))) {
      continue;
    }
    input.boundary.push_back(v);
    mesh.boundary_facet.push_back(facet);
  }
  return mesh;
}

namespace {

// Of those tetrahedra of the region that `is_inside` tells apart by their number.
template <class IsInside>
MeshStatistics region_statistics(const std::vector<std::array<VertexId, 4>>& all,
                                 const IsInside& is_inside,
                                 const std::vector<std::uint8_t>& repeated_faces,
                                 const PointStore& points, Region region, Control& control) {
  std::vector<std::array<double, 3>> coordinates(points.size());
  for (VertexId v = 0; v < points.size(); ++v) coordinates[v] = points.nearest(v);
  std::vector<std::array<std::uint32_t, 4>> tetrahedra;
  std::vector<std::uint8_t> repeated;
  std::vector<std::uint8_t> used(points.size(), 0);
  std::uint64_t interior = 0;
  for (std::size_t n = 0; n < all.size(); ++n) {
    const bool inside = is_inside(n);
    interior += inside ? 1 : 0;
    if (region == Region::interior && !inside) continue;
    tetrahedra.push_back(all[n]);
    repeated.push_back(within(region, repeated_faces[n]));
    for (const VertexId v : all[n]) used[v] = 1;
  }
  const auto vertices = static_cast<std::uint64_t>(std::count(used.begin(), used.end(), 1));
  return mesh_statistics(coordinates, tetrahedra, repeated, vertices, interior, control);
}

}  // namespace

MeshStatistics refined_statistics(const RefineResult& refined, const PointStore& points,
                                  Region region, Control& control) {
  const auto is_inside = [&](std::size_t n) { return refined.side[n] == Side::inside; };
  return region_statistics(refined.tetrahedra, is_inside, refined.repeated_faces, points, region,
                           control);
}

MeshStatistics interior_statistics(const CdtResult& cdt, const PointStore& points,
                                   Control& control) {
  const auto is_inside = [&](std::size_t n) { return cdt.inside[n] != 0; };
  return region_statistics(cdt.tetrahedra, is_inside, cdt.repeated_faces, points, Region::interior,
                           control);
}

Surface chamfered_surface(const ChamferResult& chamfered, const RefineResult& refined,
                          const SurfaceTopology& topology, const PointStore& points) {
  Surface surface;
  std::vector<std::uint32_t> number(points.size(), kNone);
  for (const RefinedFace& face : refined.faces) {
    const FacetId facet = chamfered.plc.facets[face.facet].input_facet;
    if (facet == kNone) continue;
    std::array<std::uint32_t, 3> triangle;
    for (int k = 0; k < 3; ++k) {
      std::uint32_t& n = number[face.vertices[k]];
      if (n == kNone) {
        n = static_cast<std::uint32_t>(surface.vertices.size());
        surface.vertices.push_back(points.nearest(face.vertices[k]));
      }
      triangle[k] = n;
    }
    surface.triangles.push_back(triangle);
    surface.labels.push_back(topology.labels[topology.facet_triangles[facet][0]]);
  }
  return surface;
}

}  // namespace delmesher
