#include "mesher/cdt/classify.h"

#include "mesher/base/check.h"

namespace delmesher::cdt {
namespace {

// Has the mesh still that face, if any, and is it this one?
bool is_face(const Tetrahedrization& mesh, FaceHandle face, const std::array<VertexId, 3>& v) {
  const TetId t = face.tet();
  if (!face.exists() || !mesh.alive(t)) return false;
  int others = 6;
  for (const VertexId corner : v) {
    const int i = mesh.index_of(t, corner);
    if (i < 0) return false;
    others -= i;
  }
  return others == face.face();
}

}  // namespace

std::vector<std::uint8_t> classify_tetrahedra(Tetrahedrization& mesh,
                                              std::span<const SurfaceFace> surface,
                                              std::span<const FaceHandle> found,
                                              const Chains& chains, Control& control,
                                              std::size_t* missing) {
  constexpr std::uint8_t kUnknown = 2;
  std::vector<std::uint8_t> walls(mesh.capacity(), 0);  // bit i: face i is on the surface
  for (std::size_t n = 0; n < surface.size(); ++n) {
    control.poll();
    const auto& v = surface[n].vertices;
    const FaceHandle face = is_face(mesh, found[n], v) ? found[n] : find_face(mesh, chains, v);
    if (!face.exists()) {
      *missing = n;
      return {};
    }
    for (const FaceHandle side : {face, mesh.across(face)}) {
      walls[side.tet()] |= static_cast<std::uint8_t>(1U << side.face());
    }
  }
  std::vector<std::uint8_t> inside(mesh.capacity(), kUnknown);
  std::vector<TetId> queue;
  for (TetId t = 0; t < mesh.capacity(); ++t) {
    if (mesh.alive(t) && mesh.is_ghost(t)) {
      inside[t] = 0;
      queue.push_back(t);
    }
  }
  while (!queue.empty()) {
    control.poll();
    const TetId t = queue.back();
    queue.pop_back();
    for (int i = 0; i < 4; ++i) {
      const TetId u = mesh.neighbor(t, i);
      const auto value = static_cast<std::uint8_t>(inside[t] ^ ((walls[t] >> i) & 1U));
      if (inside[u] == kUnknown) {
        inside[u] = value;
        queue.push_back(u);
      }
      DELMESHER_CHECK(inside[u] == value, "the surface does not separate inside from outside");
    }
  }
  return inside;
}

}  // namespace delmesher::cdt
