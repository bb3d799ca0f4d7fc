// Repairs by changing the tetrahedra: flips and collapses that keep every boundary face.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesher/output/rounded_mesh.h"
#include "mesher/predicates/predicates.h"

namespace delmesher::output {

class LocalOperations {
 public:
  LocalOperations(RoundedMesh& mesh, const PointStore& exact_points)
      : mesh_(mesh), exact_(exact_points) {}

  // Removes the bad tetrahedron t by an operation whose new tetrahedra are all positive on the
  // rounded coordinates; with `exact_too`, also on the exact ones, so that the result is valid in
  // both senses. Tries, in this order: removing one of its edges (3-2, 4-4 and longer rings), one
  // of its faces (2-3), collapsing one of its volume vertices. False if none of these can be done.
  bool fix(std::uint32_t t, bool exact_too);

 private:
  bool remove_edge(std::uint32_t t, int i, int j);
  bool find_ring(std::uint32_t t, int i, int j);
  bool triangulate_ring(std::uint32_t a, std::uint32_t b);
  bool remove_face(std::uint32_t t, int i);
  bool collapse(std::uint32_t v);
  bool collapse_to(std::uint32_t v, std::uint32_t w);
  bool positive(const Tet& vertices);
  bool replace();
  bool is_boundary(std::uint32_t a, std::uint32_t b, std::uint32_t c) const;

  RoundedMesh& mesh_;
  Predicates exact_;
  bool exact_too_ = true;
  // The operation being tried.
  std::vector<std::uint32_t> removed_;
  std::vector<Tet> created_;
  std::vector<std::uint32_t> ring_;  // vertices around the edge being removed
};

}  // namespace delmesher::output
