// A surface on its way through the stage, with points of all kinds added if wanted; for tests.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <string>

#include "mesher/cdt/cdt.h"
#include "mesher/cdt/cdt_reference.h"
#include "mesher/surface/validity.h"

namespace delmesher::cdt::test_models {

struct Model {
  using Build = SurfaceTopology (*)(const Surface&, PointStore&, Predicates&);

  static SurfaceTopology build_solid(const Surface& s, PointStore& points, Predicates& predicates) {
    return build_topology(s, points, predicates);
  }

  explicit Model(const Surface& given, Build build = build_solid)
      : control(options), predicates(points) {
    const ValidityResult validity = check_validity(given, true, control);
    valid = validity.report.defects.empty();
    if (!valid) return;
    surface = oriented_outwards(given, validity);
    topology = build(surface, points, predicates);
    input.topology = &topology;
    input.validate = true;  // in every build
    for (VertexId v = 0; v < surface.vertices.size(); ++v) input.vertices.push_back(v);
  }

  CdtResult run() {
    return constrained_delaunay_tetrahedrization(input, points, predicates, control);
  }
  std::string wrong(const CdtResult& result) {
    return rational::Checker(topology, points, result).run();
  }

  Limits options;
  Control control;
  PointStore points;
  Predicates predicates;
  Surface surface;
  SurfaceTopology topology;
  CdtInput input;
  bool valid = false;
};

inline std::set<VertexId> vertices(const ConformingMesh& mesh) {
  std::set<VertexId> used;
  for (const auto& t : mesh.tetrahedra) used.insert(t.begin(), t.end());
  return used;
}

// Six times the volume of all tetrahedra, exactly.
inline mpq_class volume(const PointStore& points, const ConformingMesh& mesh) {
  mpq_class sum = 0;
  for (const auto& t : mesh.tetrahedra) {
    rational::Vector x[4];
    for (int i = 0; i < 4; ++i) x[i] = rational::exact(points, t[i]);
    sum += rational::volume(x[0], x[1], x[2], x[3]);
  }
  return sum;
}

// Adds points of all kinds: on edges, in facets, in the volume, and the corners of a box around.
inline void enrich(Model& model, int density, std::uint32_t seed) {
  std::mt19937 random(seed);
  const SurfaceTopology& s = model.topology;
  const auto add = [&](VertexId v) { model.input.vertices.push_back(v); };
  model.input.on_edge.resize(s.edge_count());
  for (std::uint32_t e = 0; e < s.edge_count(); ++e) {
    if (s.edge_is_flat[e] != 0) continue;
    const auto end = s.edge_vertices(e);
    const int parts = 1 + static_cast<int>(random() % (2 * static_cast<unsigned>(density)));
    for (int i = 1; i < parts; ++i) {
      const double t = std::floor(1024.0 * i / parts) / 1024;  // from end[0]
      const VertexId v = t < 0.5 ? model.points.add_on_segment(end[1], end[0], t)
                                 : model.points.add_on_segment(end[0], end[1], 1 - t);
      model.points.set_supports(v, s.edge_planes(e), {&e, 1});
      model.input.on_edge[e].push_back(v);
      add(v);
    }
  }
  model.input.on_facet.resize(s.facet_triangles.size());
  for (std::uint32_t t = 0; t < s.triangles.size(); ++t) {
    std::set<std::array<unsigned, 2>> taken;
    for (int i = 0; i < density; ++i) {
      const unsigned u = 1 + static_cast<unsigned>(random() % 126);
      const unsigned v = 1 + static_cast<unsigned>(random() % (127 - u));
      if (!taken.insert({u, v}).second) continue;
      const auto& c = s.triangles[t];
      const VertexId p = model.points.add_on_triangle(c[0], c[1], c[2], u / 128.0, v / 128.0);
      const PlaneId plane = s.facet_plane[s.facet_of[t]];
      model.points.set_supports(p, {&plane, 1}, {});
      model.input.on_facet[s.facet_of[t]].push_back(p);
      add(p);
    }
  }
  Vec3 lo = model.points.nearest(0), hi = lo;
  for (VertexId v = 0; v < s.vertex_half_edge.size(); ++v) {
    for (int k = 0; k < 3; ++k) {
      lo[k] = std::min(lo[k], model.points.nearest(v)[k]);
      hi[k] = std::max(hi[k], model.points.nearest(v)[k]);
    }
  }
  for (int i = 0; i < 8; ++i) {
    Vec3 p;
    for (int k = 0; k < 3; ++k) {
      p[k] = ((i >> k) & 1) != 0 ? hi[k] + (hi[k] - lo[k]) / 2 : lo[k] - (hi[k] - lo[k]) / 2;
    }
    add(model.points.add_explicit(p[0], p[1], p[2]));
  }
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 40 * density; ++i) {
    Vec3 p;
    for (int k = 0; k < 3; ++k) p[k] = lo[k] + (hi[k] - lo[k]) * unit(random);
    add(model.points.add_explicit(p[0], p[1], p[2]));
  }
}

}  // namespace delmesher::cdt::test_models
