// The tetrahedra under test, on exact points, and the faces between them.
#pragma once

#include <cstdint>
#include <vector>

#include "oracles/base/exact_points.h"
#include "oracles/base/simplex.h"
#include "oracles/verdict/report.h"

namespace tetproof::oracles {

struct TetComplex {
  const ExactPoints* points = nullptr;
  std::vector<Tet> tetrahedra;       // indices into points
  std::vector<std::uint8_t> inside;  // per tetrahedron: belongs to the solid
  // The points [first, last) must be used by some tetrahedron. Reports number elements from
  // `first` on, as the file does.
  Index first_vertex = 0, last_vertex = 0;

  std::string vertex_name(Index v) const;
  std::string tet_name(std::size_t t) const;
  std::string face_name(const Face& face) const;
  Site vertex_site(Index v) const { return {Site::Kind::vertex, {v - first_vertex, 0, 0}}; }
  Site edge_site(Index v, Index w) const {
    return {Site::Kind::edge, {v - first_vertex, w - first_vertex, 0}};
  }
  Site face_site(const Face& face) const {
    return {Site::Kind::face,
            {face[0] - first_vertex, face[1] - first_vertex, face[2] - first_vertex}};
  }
  static Site tet_site(std::size_t t) {
    return {Site::Kind::tetrahedron, {static_cast<Index>(t), 0, 0}};
  }
};

// Across each face: tetrahedron * 4 + face, or kNone.
struct Neighbours {
  std::vector<Index> across;
  // How many pairs of faces were compared to find them; no time is quadratic while that is not.
  std::uint64_t compared = 0;
};

// Complex oracle: indices in range, corners distinct, no duplicate tetrahedra, every face shared by
// one or two with opposite orientation, no vertex unused, boundary closed. The Euler characteristic
// is half that of the boundary, as for every manifold of odd dimension, so solids that hang
// together at a vertex or an edge only fail. Fills `neighbours` as far as the complex allows.
// `is_part`: the complex is the inside of a refined mesh, without the tetrahedra that lie across
// the chamfered or dropped part of the surface. It may be empty, and need not be a manifold; its
// characteristic is reported only.
OracleReport check_complex(const TetComplex& complex, Neighbours& neighbours, bool is_part = false);

// Orientation oracle: every tetrahedron is positive, by its exact sign. The report has the figures
// `inverted` and `flat`.
OracleReport check_orientation(const TetComplex& complex);

}  // namespace tetproof::oracles
