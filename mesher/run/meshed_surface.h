// The surface that the stages of a run mesh.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "mesher/predicates/points.h"
#include "mesher/surface/topology.h"

namespace delmesher::run {

// One of three, oriented outwards. Its vertices are the first points of Session::points.
class MeshedSurface {
 public:
  enum class Kind : std::uint8_t {
    given,
    // Near-coplanar triangles lie in exactly one plane, and vertices were moved for that. The mesh
    // is written with the vertices as given.
    planarized,
    // As given, after a mesh of the planarized surface became one of it.
    given_again
  };

  void enter_given(SurfaceTopology topology) { topology_ = std::move(topology); }
  void enter_planarized(SurfaceTopology topology, std::vector<Vec3> given_vertices) {
    kind_ = Kind::planarized;
    topology_ = std::move(topology);
    given_vertices_ = std::move(given_vertices);
  }
  // `planarized_vertices`: the points that the vertices were, and their planes.
  void return_to_given(SurfaceTopology topology, PointStore planarized_vertices) {
    kind_ = Kind::given_again;
    topology_ = std::move(topology);
    planarized_vertices_ = std::move(planarized_vertices);
    given_vertices_.clear();
  }

  bool is_planarized() const { return kind_ == Kind::planarized; }
  const SurfaceTopology& topology() const { return topology_; }
  // Of a planarized surface; else empty.
  std::span<const Vec3> given_vertices() const { return given_vertices_; }
  // Of one that is given again; else null.
  const PointStore* planarized_vertices() const {
    return kind_ == Kind::given_again ? &planarized_vertices_ : nullptr;
  }

 private:
  Kind kind_ = Kind::given;
  SurfaceTopology topology_;
  std::vector<Vec3> given_vertices_;
  PointStore planarized_vertices_;
};

}  // namespace delmesher::run
