// What several steps of a verification need of the record.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "mesher/delmesher.h"
#include "oracles/base/parallel.h"
#include "oracles/memory.h"
#include "oracles/mesh/conformity.h"
#include "oracles/mesh/places.h"
#include "oracles/record/chamfer.h"
#include "oracles/record/cover.h"
#include "oracles/surface/input_surface.h"
#include "oracles/verdict/promise.h"
#include "oracles/verdict/report.h"

namespace tetproof::oracles {

// Of the bounding box of the vertices that have triangles.
double diagonal_of(const Polyhedron& input);

// The tetrahedra of the record on its points. Has no vertices of its own.
TetComplex complex_of(const std::vector<delmesher::ExactRecord::Tet>& tets,
                      const ExactPoints& points);

// Data that several steps of a verification need, made by the first that asks.
class SharedData {
 public:
  struct Sidecar {
    ExactPoints points;
    // The same points on the vertices as given, if the final mesh has them; else see written().
    ExactPoints given;
    bool moved = false;    // are some vertices not where they were given?
    InputSurface surface;  // that was meshed
    // Is the final mesh one of the surface as given, although another was refined?
    bool as_given = false;
    InputSurface surface_as_given;
    double diagonal = 0;  // of the input
    OracleReport report{"sidecar", "input vertices"};
    std::string why;      // the input bounds no solid
    bool usable = false;  // points and surface have been made

    // Of the final mesh.
    const ExactPoints& final_points() const { return as_given ? given : points; }
    const InputSurface& final_surface() const { return as_given ? surface_as_given : surface; }
  };
  struct Final {
    TetComplex complex;
    Neighbours neighbours;
    OracleReport shape{"complex"};
    ConformityResult conformity;  // empty unless the shape passed; without its chains
  };
  struct Refined {
    TetComplex complex;
    Neighbours neighbours;
    OracleReport shape{"complex"};
    std::unique_ptr<const Places> places;
  };

  SharedData(const Polyhedron& input, const delmesher::ExactRecord* exact, const Promise& promise,
             Memory& memory)
      : input_(input),
        exact_(exact),
        promise_(promise),
        memory_(memory),
        has_final_(exact != nullptr && !exact->final.empty()) {}

  // Had the record a final mesh?
  bool has_final() const { return has_final_; }

  const Sidecar& sidecar() {
    sidecar_once_([this] { read_sidecar(); });
    return sidecar_;
  }
  // The points on the vertices as given: these are written. Only for a usable sidecar. They take as
  // much memory as the tetrahedra, and are asked for at the beginning and at the end: the first who
  // asks takes them away, others get them made anew.
  std::shared_ptr<const ExactPoints> written();
  // The final mesh of the record. Only for a usable sidecar.
  std::shared_ptr<const Final> final() {
    const std::lock_guard<std::mutex> lock(final_mutex_);
    make_final();
    return final_;
  }
  // The chain of mesh edges on each edge of its surface; none if it is not a complex. They stay
  // when the mesh is forgotten.
  const Chains& final_chains() {
    const std::lock_guard<std::mutex> lock(final_mutex_);
    if (!final_chains_known_) make_final();
    return final_chains_;
  }
  // Once nobody asks for it any more.
  void forget_refined() { refined_ = Refined(); }
  // Its memory, once its own oracles are done.
  void forget_final() {
    const std::lock_guard<std::mutex> lock(final_mutex_);
    final_.reset();
  }
  // The arguments of the oracles of the refined mesh, once there is one.
  RefinedMesh refined_mesh() const {
    return {exact_,
            &sidecar_.points,
            &sidecar_.surface,
            &refined_.complex,
            &refined_.neighbours,
            &promise_,
            static_cast<Index>(input_.vertices.size())};
  }
  // Only for a usable sidecar.
  const Refined& refined() {
    refined_once_([this] {
      refined_.complex = complex_of(exact_->refined, sidecar().points);
      memory_.done_with(kRefinedTetrahedra);
      refined_.shape = check_complex(refined_.complex, refined_.neighbours);
      refined_.places =
          std::make_unique<const Places>(refined_.complex, refined_.neighbours, sidecar_.surface,
                                         [mesh = refined_mesh()] { return cover_of(mesh); });
    });
    return refined_;
  }
  // Which tetrahedra of the first mesh that is constrained Delaunay, before local operations, are
  // in the refined mesh. Once every face of that has passed, those between two of these need not be
  // decided again. None unless the refined mesh's oracle was done first, as it is on one thread.
  void tell_refined_is_delaunay();
  std::vector<std::uint8_t> known_to_be_delaunay() {
    const std::lock_guard<std::mutex> lock(final_mutex_);
    return std::move(in_refined_);
  }
  std::mutex progress;

 private:
  void read_sidecar();
  std::string place_as_given(ExactPoints& points) const;
  void make_final();

  const Polyhedron& input_;
  const delmesher::ExactRecord* exact_;
  const Promise& promise_;
  Memory& memory_;
  const bool has_final_;
  Once sidecar_once_, refined_once_;
  std::mutex final_mutex_;
  std::shared_ptr<const Final> final_;
  Chains final_chains_;
  std::vector<std::uint8_t> in_refined_;
  std::mutex written_mutex_;
  std::shared_ptr<const ExactPoints> written_;
  bool final_chains_known_ = false;
  Sidecar sidecar_;
  Refined refined_;
};
}  // namespace tetproof::oracles
