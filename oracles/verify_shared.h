// What several parts of a verification need of the record.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "mesher/delmesher.h"
#include "oracles/chamfer.h"
#include "oracles/conformity.h"
#include "oracles/input_surface.h"
#include "oracles/parallel.h"
#include "oracles/places.h"
#include "oracles/promise.h"
#include "oracles/report.h"

namespace tetproof::oracles {

// The tetrahedra of the record on its points. Has no vertices of its own.
TetComplex complex_of(const std::vector<delmesher::ExactRecord::Tet>& tets,
                      const ExactPoints& points);

// Data that several parts of a verification need, made by the first that asks.
class SharedData {
 public:
  struct Sidecar {
    ExactPoints points;
    // The same points on the vertices as given, if some were moved: these are written.
    ExactPoints given;
    InputSurface surface;  // that was meshed
    // Is the final mesh one of the surface as given, although another was refined?
    bool as_given = false;
    InputSurface surface_as_given;
    double diagonal = 0;  // of the input
    OracleReport report{"sidecar", "input vertices"};
    std::string why;      // the input bounds no solid
    bool usable = false;  // points and surface have been made

    const ExactPoints& written() const { return given.size() > 0 ? given : points; }
    // Of the final mesh.
    const ExactPoints& final_points() const { return as_given ? given : points; }
    const InputSurface& final_surface() const { return as_given ? surface_as_given : surface; }
  };
  struct Final {
    TetComplex complex;
    Neighbours neighbours;
    OracleReport shape{"complex"};
    ConformityResult conformity;  // with chains; empty unless the shape passed
  };
  struct Refined {
    TetComplex complex;
    Neighbours neighbours;
    OracleReport shape{"complex"};
    std::unique_ptr<const Places> places;
  };

  SharedData(const Polyhedron& input, const delmesher::ExactRecord* exact, const Promise& promise)
      : input_(input), exact_(exact), promise_(promise) {}

  const Sidecar& sidecar() {
    sidecar_once_([this] { read_sidecar(); });
    return sidecar_;
  }
  // The final mesh of the record. Only for a usable sidecar.
  std::shared_ptr<const Final> final();
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
      refined_.shape = check_complex(refined_.complex, refined_.neighbours);
      refined_.places = std::make_unique<const Places>(refined_mesh());
    });
    return refined_;
  }
  std::mutex progress;

 private:
  void read_sidecar();

  const Polyhedron& input_;
  const delmesher::ExactRecord* exact_;
  const Promise& promise_;
  Once sidecar_once_, refined_once_;
  std::mutex final_mutex_;
  std::shared_ptr<const Final> final_;
  Sidecar sidecar_;
  Refined refined_;
};
}  // namespace tetproof::oracles
