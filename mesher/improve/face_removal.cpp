#include "mesher/improve/face_removal.h"

namespace delmesher::improve {

bool FaceRemoval::run(TetId t, int i) {
  const WorkMesh& mesh = state_.mesh;
  const TetId u = mesh.neighbor(t, i);
  if (u == kNone || mesh.facet(t, i) != kNone) return false;
  const Tet& v = mesh.tet(t);
  const VertexId a = v[kFace[i][0]], b = v[kFace[i][1]], c = v[kFace[i][2]], d = v[i],
                 e = mesh.tet(u)[mesh.mirror(t, i)];
  if (state_.too_long(state_.position(d), state_.position(e))) return false;
  const std::array<TetId, 2> removed = {t, u};
  const Quality least =
      state_.counts(t) ? state_.to_be_better(state_.worst_of(removed)) : kNotCounted;
  const RegionId region = mesh.region(t);
  std::array<CreatedTet, 3> created;
  const VertexId corner[3] = {a, b, c};
  for (int k = 0; k < 3; ++k) {
    created[k] = {{corner[k], corner[(k + 1) % 3], d, e}, region};
    const Quality q = state_.quality_of(created[k].vertices, least);
    if (!(q.dihedral > 0) || !State::reaches(q, least)) return false;
  }
  for (const CreatedTet& tet : created) {
    if (!state_.is_positive(tet.vertices)) return false;
  }
  state_.replace(removed, created, {});
  return true;
}

}  // namespace delmesher::improve
