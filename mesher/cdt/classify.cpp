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

constexpr RegionId kUnknown = kNone;

// Which faces of each tetrahedron are on the surface: bit i for face i. Empty if one of the surface
// is missing.
std::vector<std::uint8_t> find_walls(Tetrahedrization& mesh, std::span<const SurfaceFace> surface,
                                     std::span<const FaceHandle> found, const Chains& chains,
                                     Control& control, std::size_t* missing) {
  std::vector<std::uint8_t> walls(mesh.capacity(), 0);
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
  return walls;
}

class Flood {
 public:
  Flood(const Tetrahedrization& mesh, const std::vector<std::uint8_t>& walls, Control& control)
      : mesh_(mesh), walls_(walls), control_(control), region_(mesh.capacity(), kUnknown) {}

  std::vector<RegionId> run(Partition partition) {
    for (TetId t = 0; t < mesh_.capacity(); ++t) {
      if (mesh_.alive(t) && mesh_.is_ghost(t)) enter(t, kOutside);
    }
    spread(partition);
    RegionId next = kInside;
    for (TetId t = 0; t < mesh_.capacity(); ++t) {
      if (!mesh_.alive(t) || region_[t] != kUnknown) continue;
      enter(t, next++);
      spread(partition);
    }
    return std::move(region_);
  }

 private:
  void enter(TetId t, RegionId region) {
    region_[t] = region;
    queue_.push_back(t);
  }
  void spread(Partition partition) {
    while (!queue_.empty()) {
      control_.poll();
      const TetId t = queue_.back();
      queue_.pop_back();
      for (int i = 0; i < 4; ++i) {
        const TetId u = mesh_.neighbor(t, i);
        const bool wall = ((walls_[t] >> i) & 1U) != 0;
        if (wall && partition == Partition::regions) continue;
        const RegionId value = wall ? kInside - region_[t] : region_[t];
        if (region_[u] == kUnknown) enter(u, value);
        DELMESHER_CHECK(region_[u] == value, "the surface does not separate inside from outside");
      }
    }
  }

  const Tetrahedrization& mesh_;
  const std::vector<std::uint8_t>& walls_;
  Control& control_;
  std::vector<RegionId> region_;
  std::vector<TetId> queue_;
};

}  // namespace

std::vector<RegionId> classify_tetrahedra(Tetrahedrization& mesh,
                                          std::span<const SurfaceFace> surface,
                                          std::span<const FaceHandle> found, const Chains& chains,
                                          Partition partition, Control& control,
                                          std::size_t* missing) {
  const std::vector<std::uint8_t> walls =
      find_walls(mesh, surface, found, chains, control, missing);
  return walls.empty() ? std::vector<RegionId>() : Flood(mesh, walls, control).run(partition);
}

}  // namespace delmesher::cdt
