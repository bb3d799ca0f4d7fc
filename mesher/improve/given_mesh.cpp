#include "mesher/improve/given_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "mesher/base/face_key.h"
#include "mesher/base/numbering.h"
#include "mesher/delaunay/tetrahedrization.h"
#include "mesher/predicates/signs_of_doubles.h"
#include "mesher/tetmesh/mesh_topology.h"

namespace delmesher::improve {
namespace {

// Faces have numbers of 32 bits, and so do the corners of tetrahedra.
constexpr std::uint64_t kMostTetrahedra = (std::uint64_t{1} << 30U) - 16;

// Thrown within this file alone.
struct Defect {
  std::string text;
};

template <class... Text>
[[noreturn]] void refuse(const Text&... text) {
  throw Defect{(std::string() + ... + text)};
}

std::string number(std::uint64_t n) {
  return std::to_string(n);
}

template <std::size_t N>
std::string numbers(const std::array<VertexId, N>& vertices) {
  std::string text;
  for (const VertexId v : vertices) text += (text.empty() ? "" : "-") + std::to_string(v);
  return text;
}

class Checker {
 public:
  Checker(const GivenMesh& given, Control& control, CheckedMesh& result)
      : given_(given), control_(control), result_(result) {}

  void run() {
    if (given_.tetrahedra.size() > kMostTetrahedra) stop_at_size(kMostTetrahedra, "tetrahedra");
    if (given_.tetrahedra.empty()) refuse("there are no tetrahedra");
    check_vertices();
    check_cells("tetrahedron ", given_.tetrahedra);
    check_cells("triangle ", given_.triangles);
    result_.mesh.tetrahedra.assign(given_.tetrahedra.begin(), given_.tetrahedra.end());
    result_.mesh.region.assign(given_.region.begin(), given_.region.end());
    orient();
    list_faces();
    pair_faces();
    check_triangles();
    check_vertex_stars();
  }

 private:
  struct Face {
    std::array<VertexId, 3> key;
    std::uint32_t side;  // 4 * tetrahedron + face
    bool kept = false;   // on the surface; true for both sides
  };

  void check_vertices() {
    for (std::size_t v = 0; v < given_.vertices.size(); ++v) {
      const Vec3& p = given_.vertices[v];
      if (!std::all_of(p.begin(), p.end(), [](double x) { return std::isfinite(x); })) {
        refuse("vertex ", number(v), " has a coordinate that is not finite");
      }
    }
  }

  template <class Cells>
  void check_cells(const char* name, const Cells& cells) {
    for (std::size_t n = 0; n < cells.size(); ++n) {
      const auto& cell = cells[n];
      for (auto v = cell.begin(); v != cell.end(); ++v) {
        if (*v >= given_.vertices.size()) {
          refuse(name, number(n), " names vertex ", number(*v), " of ",
                 number(given_.vertices.size()), ", counted from 0");
        }
        if (std::find(cell.begin(), v, *v) != v) {
          refuse(name, number(n), " has vertex ", number(*v), " twice");
        }
      }
    }
  }

  void orient() {
    std::size_t positive = kNobody, negative = kNobody;  // the first ones
    for (std::size_t t = 0; t < given_.tetrahedra.size(); ++t) {
      control_.poll(given_.vertices.size());
      const Tet& v = given_.tetrahedra[t];
      const auto at = [&](int i) -> const Vec3& { return given_.vertices[v[i]]; };
      const int sign = orient3d_sign(at(0), at(1), at(2), at(3));
      if (sign > 0 && positive == kNobody) positive = t;
      if (sign < 0 && negative == kNobody) negative = t;
      if (sign == 0) ++result_.flat;
    }
    if (negative == kNobody) return;
    if (positive != kNobody) {
      refuse("tetrahedra ", number(std::min(positive, negative)), " and ",
             number(std::max(positive, negative)),
             " are of opposite orientation: one of them is inverted");
    }
    result_.turned = true;
    for (Tet& t : result_.mesh.tetrahedra) std::swap(t[2], t[3]);
  }

  void list_faces() {
    const std::vector<Tet>& tetrahedra = result_.mesh.tetrahedra;
    faces_.reserve(4 * tetrahedra.size());
    for (TetId t = 0; t < tetrahedra.size(); ++t) {
      for (std::uint32_t i = 0; i < 4; ++i) {
        const std::array<VertexId, 3> face = corners(4 * t + i);
        faces_.push_back({undirected_face(face[0], face[1], face[2]), 4 * t + i});
      }
    }
    control_.poll_now(given_.vertices.size(), -1);
    std::sort(faces_.begin(), faces_.end(), [](const Face& a, const Face& b) {
      return std::tie(a.key, a.side) < std::tie(b.key, b.side);
    });
    control_.poll_now(given_.vertices.size(), -1);
  }

  std::array<VertexId, 3> corners(std::uint32_t side) const {
    const Tet& t = result_.mesh.tetrahedra[side / 4];
    const int* f = kFace[side % 4];
    return {t[f[0]], t[f[1]], t[f[2]]};
  }

  // Is the face, seen from this side, an even permutation of its key?
  bool is_even(const Face& face) const {
    const std::array<VertexId, 3> v = corners(face.side);
    const auto first = static_cast<std::size_t>(std::min_element(v.begin(), v.end()) - v.begin());
    return v[(first + 1) % 3] < v[(first + 2) % 3];
  }

  void pair_faces() {
    for (std::size_t n = 0; n < faces_.size();) {
      std::size_t end = n + 1;
      while (end < faces_.size() && faces_[end].key == faces_[n].key) ++end;
      const TetId t = faces_[n].side / 4, u = faces_[end - 1].side / 4;
      if (end - n > 2) {
        refuse("more than two tetrahedra have the face ", numbers(faces_[n].key), ": ", number(t),
               ", ", number(faces_[n + 1].side / 4), " and ", number(faces_[n + 2].side / 4));
      }
      if (end - n == 2 && is_even(faces_[n]) == is_even(faces_[n + 1])) {
        refuse("tetrahedra ", number(t), " and ", number(u), " are on the same side of the face ",
               numbers(faces_[n].key));
      }
      // Flat both: they would have all faces in common.
      if (end - n == 2 && result_.mesh.tetrahedra[t][faces_[n].side % 4] ==
                              result_.mesh.tetrahedra[u][faces_[n + 1].side % 4]) {
        refuse("tetrahedra ", number(t), " and ", number(u), " have the same four corners");
      }
      const bool kept = end - n == 1 || result_.mesh.region[t] != result_.mesh.region[u];
      for (; n < end; ++n) faces_[n].kept = kept;
    }
  }

  void check_triangles() {
    for (std::size_t n = 0; n < given_.triangles.size(); ++n) {
      const auto& [a, b, c] = given_.triangles[n];
      const std::array<VertexId, 3> key = undirected_face(a, b, c);
      auto face = std::lower_bound(faces_.begin(), faces_.end(), key,
                                   [](const Face& f, const auto& k) { return f.key < k; });
      if (face == faces_.end() || face->key != key) {
        refuse("triangle ", number(n), " (", numbers(given_.triangles[n]),
               ") is a face of no tetrahedron");
      }
      for (; face != faces_.end() && face->key == key; ++face) face->kept = true;
    }
    for (std::size_t n = 0; n < faces_.size(); ++n) {
      if (!faces_[n].kept || (n > 0 && faces_[n].key == faces_[n - 1].key)) continue;
      result_.mesh.boundary.push_back(
          {corners(faces_[n].side), static_cast<FacetId>(result_.mesh.boundary.size())});
    }
  }

  // Where a vertex can move, its star has to be all of its tetrahedra.
  void check_vertex_stars() {
    std::vector<Face>().swap(faces_);  // gone before the topology, which takes more memory
    const ConformingMesh& mesh = result_.mesh;
    const MeshTopology topology(mesh.tetrahedra, mesh.region, mesh.boundary,
                                given_.vertices.size());
    std::vector<std::uint8_t> fixed(given_.vertices.size(), 0);
    for (const SurfaceFace& face : mesh.boundary) {
      for (const VertexId v : face.vertices) fixed[v] = 1;
    }
    for (const VertexId v : topology.pinched()) {
      if (fixed[v] != 0) continue;
      std::vector<TetId> star;
      topology.star(v, star);
      std::ranges::sort(star);
      TetId other = 0;
      while (topology.index_of(other, v) < 0 || std::ranges::binary_search(star, other)) ++other;
      refuse("the tetrahedra at vertex ", number(v),
             " are not connected by faces: ", number(std::min(other, star[0])), " and ",
             number(std::max(other, star[0])));
    }
  }

  static constexpr std::size_t kNobody = std::numeric_limits<std::size_t>::max();
  const GivenMesh& given_;
  Control& control_;
  CheckedMesh& result_;
  std::vector<Face> faces_;  // of all tetrahedra, by their keys
};

}  // namespace

CheckedMesh check_given(const GivenMesh& given, Control& control) {
  CheckedMesh result;
  try {
    Checker(given, control, result).run();
  } catch (const Defect& defect) {
    result.defect = defect.text;
  }
  return result;
}

}  // namespace delmesher::improve
