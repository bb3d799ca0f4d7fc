#include "mesher/improve/face_removal.h"

#include <algorithm>

namespace delmesher::improve {
namespace {

// Tetrahedra that are replaced at most.
constexpr std::size_t kMost = 16;

}  // namespace

bool FaceRemoval::run(TetId t, int i) {
  const MeshTopology& mesh = state_.mesh;
  const TetId u = mesh.neighbor(t, i);
  if (u == kNone || mesh.facet(t, i) != kNone || !state_.counts(t)) return false;
  const Tet& v = mesh.tet(t);
  above_ = v[i];
  below_ = mesh.tet(u)[mesh.mirror(t, i)];
  if (state_.too_long(state_.position(above_), state_.position(below_))) return false;
  removed_ = {t, u};
  created_.clear();
  quality_.clear();
  const VertexId corner[3] = {v[kFace[i][0]], v[kFace[i][1]], v[kFace[i][2]]};
  for (int k = 0; k < 3; ++k) {
    const Quality q = fill({t, u, corner[k], corner[(k + 1) % 3], corner[(k + 2) % 3]});
    if (!(q.dihedral > 0)) return false;
  }
  const Quality least = state_.to_be_better(state_.worst_of(removed_));
  for (const Quality& quality : quality_) {
    if (!State::reaches(quality, least)) return false;
  }
  for (const CreatedTet& tet : created_) {
    if (!state_.is_positive(tet.vertices)) return false;
  }
  state_.replace(removed_, created_, {});
  return true;
}

// The best filling beyond edge x, y of a face that goes: one tetrahedron at that edge, or, if the
// face beyond it goes as well, the fillings beyond that face's other edges.
Quality FaceRemoval::fill(const Side& side) {
  const std::size_t created = created_.size(), removed = removed_.size();
  const CreatedTet tet = {{side.x, side.y, above_, below_}, state_.mesh.region(side.above)};
  const Quality alone = state_.quality_of(tet.vertices);
  create(tet, alone);
  Side next{};
  if (state_.good(alone) || removed >= kMost || !beyond(side, next)) return alone;
  created_.pop_back();
  quality_.pop_back();
  removed_.insert(removed_.end(), {next.above, next.below});
  Quality both = fill({next.above, next.below, side.x, next.z, side.y});
  if (state_.score(both) > state_.score(alone)) {
    both = worse(both, fill({next.above, next.below, next.z, side.y, side.x}));
    if (state_.score(both) > state_.score(alone)) return both;
  }
  created_.resize(created);
  quality_.resize(created);
  removed_.resize(removed);
  create(tet, alone);
  return alone;
}

void FaceRemoval::create(const CreatedTet& tet, const Quality& quality) {
  created_.push_back(tet);
  quality_.push_back(quality);
}

// The face beyond edge x, y, if there is one between the same two vertices.
bool FaceRemoval::beyond(const Side& side, Side& next) const {
  const MeshTopology& mesh = state_.mesh;
  const auto across = [&](TetId t, VertexId v) {
    const int i = mesh.index_of(t, v);
    return mesh.facet(t, i) == kNone ? mesh.neighbor(t, i) : kNone;
  };
  const TetId above = across(side.above, side.z), below = across(side.below, side.z);
  if (above == kNone || below == kNone || above == below || across(above, above_) != below) {
    return false;
  }
  if (std::find(removed_.begin(), removed_.end(), above) != removed_.end()) return false;
  for (const VertexId v : mesh.tet(above)) {
    if (v != above_ && v != side.x && v != side.y) next = {above, below, side.x, side.y, v};
  }
  return true;
}

}  // namespace delmesher::improve
