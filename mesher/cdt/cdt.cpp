#include "mesher/cdt/cdt.h"

#include <algorithm>

#include "mesher/base/check.h"
#include "mesher/cdt/chains.h"
#include "mesher/cdt/classify.h"
#include "mesher/cdt/facet_recovery.h"
#include "mesher/cdt/facet_triangles.h"
#include "mesher/cdt/segment_recovery.h"
#include "mesher/cdt/validate.h"

namespace delmesher::cdt {
namespace {

class CdtBuilder {
 public:
  CdtBuilder(const CdtInput& input, PointStore& points, Predicates& predicates, Control& control,
             std::unique_ptr<Tetrahedrization> delaunay)
      : input_(input),
        topology_(*input.topology),
        points_(points),
        predicates_(predicates),
        control_(control),
        chains_(input, points),
        delaunay_(std::move(delaunay)) {}

  CdtResult run() {
    // Facet recovery cannot fail: all segments are edges of a Delaunay tetrahedrization that is
    // generic by perturbation, hence strongly Delaunay, and then a constrained Delaunay
    // tetrahedrization exists (Shewchuk, General-dimensional constrained Delaunay and constrained
    // regular triangulations, I, 2008), in which gift wrapping finds a vertex for every open face.
    // A resource that runs out on the way (memory, time, numbers for the vertices of a cavity, room
    // between doubles) is thrown as a limit and does not come here. So already a first failure is a
    // bug, of which counters.facet_restarts tells; a few more points on the facet's boundary give
    // it another configuration to work on, and when these do not help either it is an internal
    // error.
    constexpr int kAttempts = 8;
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      if (!delaunay_) delaunay_ = std::make_unique<Tetrahedrization>(predicates_);
      const FacetId failed = constrain(*delaunay_);
      if (failed == kNone) return result(*delaunay_);
      delaunay_.reset();
      ++restarts_;
      split_boundary(failed);
    }
    DELMESHER_CHECK(
        false,
        "triangles of a facet are missing after as many attempts, which contradicts the theory");
    return {};
  }

 private:
  // Builds the tetrahedrization with all facets in it. Returns kNone, or the facet that failed.
  FacetId constrain(Tetrahedrization& mesh) {
    std::vector<VertexId> vertices = input_.vertices;
    vertices.insert(vertices.end(), steiner_.begin(), steiner_.end());
    begin(CdtStep::delaunay);
    mesh.change_to(vertices, control_);
    begin(CdtStep::segments);
    const std::vector<VertexId> added = recover_segments(mesh, chains_, points_, control_);
    steiner_.insert(steiner_.end(), added.begin(), added.end());
    if (input_.validate) validate_segments(mesh, chains_);
    surface_.clear();
    found_.clear();
    begin(CdtStep::facets);
    FacetTriangulator triangulator(input_, chains_, predicates_);
    FacetRecovery recovery(mesh, topology_, chains_, control_);
    const auto facets = static_cast<FacetId>(topology_.facet_triangles.size());
    for (FacetId f = 0; f < facets; ++f) {
      control_.poll(points_.size(), static_cast<double>(f) / facets);
      const PlanarTriangulation triangles = triangulator.triangulate(f);
      if (!recovery.recover(f, triangles, found_)) return f;
      for (const auto& t : triangles.triangles) surface_.push_back({t, f});
    }
    result_.counters = recovery.counters();
    result_.counters.facet_restarts = restarts_;
    begin(CdtStep::classify);
    std::size_t missing = 0;
    region_ =
        classify_tetrahedra(mesh, surface_, found_, chains_, input_.partition, control_, &missing);
    if (input_.validate && !region_.empty()) {
      validate_facets(mesh, chains_, surface_, region_, input_.partition);
    }
    return region_.empty() ? surface_[missing].facet : kNone;
  }

  void begin(CdtStep step) const {
    if (input_.on_step) input_.on_step(step);
  }

  void split_boundary(FacetId facet) {
    std::vector<std::uint32_t> nodes;
    for (const std::uint32_t t : topology_.facet_triangles[facet]) {
      for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
        const std::uint32_t edge = topology_.edge_of[h];
        if (topology_.edge_is_flat[edge] != 0) continue;
        for (std::uint32_t n = chains_.first(edge); chains_.is_subsegment(n);
             n = chains_.node(n).next) {
          nodes.push_back(n);
        }
      }
    }
    for (const std::uint32_t n : nodes) {
      steiner_.push_back(split_in_the_middle(chains_, n, points_, predicates_));
    }
  }

  CdtResult result(const Tetrahedrization& mesh) {
    const std::size_t count = mesh.tetrahedra();
    ConformingMesh& result = result_.mesh;
    result.tetrahedra.reserve(count);
    result.region.reserve(count);
    result.repeated_faces.reserve(count);
    for (TetId t = 0; t < mesh.capacity(); ++t) {
      if (!mesh.alive(t) || mesh.is_ghost(t)) continue;
      const VertexId* v = mesh.vertices(t);
      result.tetrahedra.push_back({v[0], v[1], v[2], v[3]});
      result.region.push_back(region_[t]);
      const auto is_written = [&](TetId u) { return region_[u] != kOutside; };
      result.repeated_faces.push_back(
          mesh.repeated_faces(t, [&](TetId u) { return is_written(u) == is_written(t); }));
    }
    result.boundary = std::move(surface_);
    result_.steiner = std::move(steiner_);
    result_.chain.resize(topology_.edge_count());
    for (std::uint32_t e = 0; e < topology_.edge_count(); ++e) {
      if (topology_.edge_is_flat[e] == 0) result_.chain[e] = chains_.vertices(e);
    }
    return std::move(result_);
  }

  const CdtInput& input_;
  const SurfaceTopology& topology_;
  PointStore& points_;
  Predicates& predicates_;
  Control& control_;
  Chains chains_;
  std::unique_ptr<Tetrahedrization> delaunay_;
  std::vector<VertexId> steiner_;
  std::vector<SurfaceFace> surface_;
  std::vector<FaceHandle> found_;  // of each, as it was when it was recovered
  std::vector<RegionId> region_;
  std::uint64_t restarts_ = 0;
  CdtResult result_;
};

}  // namespace

CdtResult constrained_delaunay_tetrahedrization(const CdtInput& input, PointStore& points,
                                                Predicates& predicates, Control& control,
                                                std::unique_ptr<Tetrahedrization> delaunay) {
  return CdtBuilder(input, points, predicates, control, std::move(delaunay)).run();
}

}  // namespace delmesher::cdt
