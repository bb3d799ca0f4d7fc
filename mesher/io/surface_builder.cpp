#include "mesher/io/surface_builder.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "mesher/geometry/orientation.h"
#include "mesher/geometry/triangulate.h"
#include "mesher/io/text.h"

namespace delmesher::io {

void SurfaceBuilder::expect(std::uint64_t vertices, std::uint64_t polygons, std::uint64_t bytes) {
  // Three coordinates with separators, or three corners and a count, take six bytes and more, so
  // an absurd count in a header reserves no more than a small multiple of the file's size.
  surface_.vertices.reserve(std::min(vertices, bytes / 6));
  polygons_.reserve(std::min(polygons, bytes / 6));
  corners_.reserve(std::min(polygons, bytes / 6) * 3);
}

void SurfaceBuilder::add_vertex(double x, double y, double z, Position position) {
  if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z)) {
    fail(position, "non-finite coordinate");
  }
  if (surface_.vertices.size() >= kMaxVertices) fail(position, "too many vertices");
  polling_.poll(8);
  surface_.vertices.push_back({x, y, z});
}

void SurfaceBuilder::add_polygon(std::span<const std::uint32_t> corners, std::int32_t label,
                                 Position position) {
  if (corners.size() < 3) {
    fail(position,
         "a face needs at least 3 corners, this one has " + std::to_string(corners.size()));
  }
  if (corners.size() > kMaxPolygonCorners) {
    fail(position, "a face with " + std::to_string(corners.size()) + " corners (the limit is " +
                       std::to_string(kMaxPolygonCorners) + ")");
  }
  polling_.poll(8);
  corners_.insert(corners_.end(), corners.begin(), corners.end());
  polygons_.push_back({corners_.size(), label, position});
}

void SurfaceBuilder::add_polygon_with_holes(std::span<const std::vector<std::uint32_t>> loops,
                                            std::int32_t label, Position position) {
  std::size_t corners = 0;
  for (const auto& loop : loops) {
    check_corners(loop, position);
    corners += loop.size();
  }
  if (corners > kMaxPolygonCorners) {
    fail(position, "a facet with more than " + std::to_string(kMaxPolygonCorners) + " corners");
  }
  triangulate(loops, label, position);
}

void SurfaceBuilder::warn(const std::string& text) {
  if (std::find(warnings_.begin(), warnings_.end(), text) == warnings_.end()) {
    warnings_.push_back(text);
  }
}

void SurfaceBuilder::forget_labels() {
  names_.clear();
  for (Polygon& polygon : polygons_) polygon.label = 0;
}

void SurfaceBuilder::weld() {
  auto& vertices = surface_.vertices;
  for (auto& v : vertices) {
    for (double& x : v) x += 0.0;  // turns -0 into +0
  }
  // By sorting, not by hashing: no input can make it slow.
  std::vector<std::uint32_t> order(vertices.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return vertices[a] != vertices[b] ? vertices[a] < vertices[b] : a < b;
  });
  std::vector<std::uint32_t> target(vertices.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && vertices[order[i]] == vertices[order[i - 1]];
    target[order[i]] = same ? target[order[i - 1]] : order[i];
  }
  // A vertex keeps the rank of its first appearance.
  std::uint32_t kept = 0;
  for (std::uint32_t v = 0; v < target.size(); ++v) {
    if (target[v] == v) {
      vertices[kept] = vertices[v];
      target[v] = kept++;
    } else {
      target[v] = target[target[v]];
    }
  }
  note("welded " + std::to_string(vertices.size()) + " corners into " + std::to_string(kept) +
       " vertices");
  vertices.resize(kept);
  for (std::uint32_t& corner : corners_) corner = target[corner];
}

void SurfaceBuilder::check_corners(std::span<const std::uint32_t> corners,
                                   Position position) const {
  for (std::uint32_t corner : corners) {
    if (corner >= surface_.vertices.size()) {
      fail(position, "vertex index out of range: number " + std::to_string(corner) +
                         " (counted from 0) of " + std::to_string(surface_.vertices.size()));
    }
  }
}

void SurfaceBuilder::add_triangle(const std::array<std::uint32_t, 3>& triangle,
                                  std::int32_t label) {
  if (surface_.triangles.size() >= kMaxTriangles) fail({}, "too many triangles");
  if (label != 0) labelled_ = true;
  surface_.triangles.push_back(triangle);
  surface_.labels.push_back(label);
}

void SurfaceBuilder::triangulate(std::span<const std::vector<std::uint32_t>> loops,
                                 std::int32_t label, Position position) {
  const FaceTriangulation result = triangulate_face(surface_.vertices, loops, polling_);
  for (const auto& triangle : result.triangles) add_triangle(triangle, label);
  ++triangulated_;
  if (!result.simple && non_simple_++ == 0) first_non_simple_ = position;
  if (!result.planar && non_planar_++ == 0) first_non_planar_ = position;
  deviation_ = std::max(deviation_, result.deviation);
}

// Only ends of edges with one triangle are joined, so bodies that touch stay two.
void SurfaceBuilder::join_seams() {
  auto& vertices = surface_.vertices;
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const auto& t : surface_.triangles) {
    for (std::size_t k = 0; k < 3; ++k) ++edges[std::minmax(t[k], t[(k + 1) % 3])];
  }
  std::vector<bool> at_seam(vertices.size(), false);
  for (const auto& [ends, count] : edges) {
    if (count == 1) at_seam[ends.first] = at_seam[ends.second] = true;
  }
  std::map<std::array<double, 3>, std::uint32_t> first;  // -0 and +0 are equal
  std::vector<std::uint32_t> target(vertices.size());
  std::uint32_t kept = 0, joined = 0;
  std::vector<std::array<double, 3>> places;
  for (std::uint32_t v = 0; v < vertices.size(); ++v) {
    polling_.poll(8);
    if (at_seam[v]) {
      const auto [found, is_new] = first.try_emplace(vertices[v], kept);
      target[v] = found->second;
      if (!is_new) {
        ++joined;
        continue;
      }
    }
    target[v] = kept++;
    places.push_back(vertices[v]);
  }
  if (joined == 0) return;
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> after;
  std::size_t open_before = 0, open_after = 0;
  for (const auto& [ends, count] : edges) {
    open_before += count == 1 ? 1 : 0;
    after[std::minmax(target[ends.first], target[ends.second])] += count;
  }
  for (const auto& [ends, count] : after) open_after += count == 1 ? 1 : 0;
  if (open_after >= open_before) return;
  vertices = std::move(places);
  for (auto& triangle : surface_.triangles) {
    for (std::uint32_t& v : triangle) v = target[v];
  }
  for (auto& line : lines_) {
    for (std::uint32_t& v : line) v = target[v];
  }
  warn(std::to_string(joined) + (joined == 1 ? " vertex" : " vertices") +
       " along seams joined to others at the same place");
}

void SurfaceBuilder::report_polygons() {
  if (triangulated_ > 0) note("triangulated " + std::to_string(triangulated_) + " polygons");
  if (non_planar_ > 0) {
    std::string text = std::to_string(non_planar_) + " of " + std::to_string(triangulated_) +
                       " polygons not exactly planar (by up to ";
    append_double(text, deviation_);
    warn(text + "; the first at " + describe(first_non_planar_) + "), triangulated as they are");
  }
  if (non_simple_ > 0) {
    warn(std::to_string(non_simple_) + " polygons without a simple projection (the first at " +
         describe(first_non_simple_) + "); their triangles overlap");
  }
}

void SurfaceBuilder::report_unused_vertices() {
  std::vector<std::uint8_t> used(surface_.vertices.size(), 0);
  for (const auto& triangle : surface_.triangles) {
    for (std::uint32_t v : triangle) used[v] = 1;
  }
  for (const auto& line : lines_) {
    for (std::uint32_t v : line) used[v] = 1;
  }
  const auto unused = std::count(used.begin(), used.end(), std::uint8_t{0});
  if (unused == 0) return;
  const auto first = std::find(used.begin(), used.end(), std::uint8_t{0}) - used.begin();
  warn(std::to_string(unused) + (unused == 1 ? " vertex" : " vertices") +
       " used by no face (the first is number " + std::to_string(first) + ", counted from 0)");
}

Surface SurfaceBuilder::finish() {
  surface_.triangles.reserve(surface_.triangles.size() + polygons_.size());
  surface_.labels.reserve(surface_.labels.size() + polygons_.size());
  std::uint64_t begin = 0;
  std::vector<std::vector<std::uint32_t>> loop(1);
  for (const Polygon& polygon : polygons_) {
    const std::span<const std::uint32_t> corners(corners_.data() + begin, polygon.end - begin);
    begin = polygon.end;
    polling_.poll();
    check_corners(corners, polygon.position);
    if (corners.size() == 3) {
      add_triangle({corners[0], corners[1], corners[2]}, polygon.label);
      continue;
    }
    loop[0].assign(corners.begin(), corners.end());
    triangulate(loop, polygon.label, polygon.position);
  }
  if (surface_.triangles.empty() && lines_.empty()) fail({}, "no faces");
  if (seams_) join_seams();
  if (holes_) {
    for (const std::string& text : orient_facets(surface_, *holes_, polling_)) warn(text);
  }
  report_polygons();
  report_unused_vertices();
  if (!labelled_) surface_.labels.clear();
  return std::move(surface_);
}

}  // namespace delmesher::io
