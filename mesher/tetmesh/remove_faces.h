// Removes the faces that are sandwiched between two vertices, one above them and one below, in
// favour of an edge between the two (Shewchuk 2002, "Two discrete optimization algorithms for the
// topological improvement of tetrahedral meshes"). One face is the 2-3 flip; more are the inverse
// of edge removal.
//
// The operation only proposes a change. A judge says what tetrahedra are worth:
//   Value value_of(Tet, RegionId)
//   Value both(Value, Value)           the worse of two
//   bool is_possible(Value)            may there be such tetrahedra?
//   bool is_enough(Value)              then nothing better is tried
//   bool is_better(Value, Value)
//   bool may_join(VertexId, VertexId)  may there be an edge between them?
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "mesher/tetmesh/mesh_topology.h"

namespace delmesher::tetmesh {

template <class Judge>
class RemoveFaces {
 public:
  using Value = typename Judge::Value;

  explicit RemoveFaces(const MeshTopology& mesh) : mesh_(mesh) {}

  // Removes face i of t, and the faces beside it with which the new tetrahedra are best. False if
  // it is on the surface or the hull, or if tetrahedra would not be possible.
  bool find(TetId t, int i, Judge& judge) {
    const TetId u = mesh_.neighbor(t, i);
    if (u == kNone || mesh_.facet(t, i) != kNone) return false;
    const Tet& v = mesh_.tet(t);
    above_ = v[i];
    below_ = mesh_.tet(u)[mesh_.mirror(t, i)];
    if (!judge.may_join(above_, below_)) return false;
    change_.removed = {t, u};
    change_.created.clear();
    values_.clear();
    const VertexId corner[3] = {v[kFace[i][0]], v[kFace[i][1]], v[kFace[i][2]]};
    for (int k = 0; k < 3; ++k) {
      const Side side = {t, u, corner[k], corner[(k + 1) % 3], corner[(k + 2) % 3]};
      if (!judge.is_possible(fill(side, judge))) return false;
    }
    return true;
  }
  const Change& change() const { return change_; }
  // Of the tetrahedra created.
  const std::vector<Value>& values() const { return values_; }

 private:
  // Tetrahedra that are replaced at most.
  static constexpr std::size_t kMost = 16;

  // A face x, y, z between the two vertices, by the tetrahedra above and below; x to y is
  // counter-clockwise seen from below.
  struct Side {
    TetId above, below;
    VertexId x, y, z;
  };

  // The best filling beyond edge x, y of a face that goes: one tetrahedron at that edge, or, if the
  // face beyond it goes as well, the fillings beyond that face's other edges.
  Value fill(const Side& side, Judge& judge) {
    std::vector<TetId>& removed = change_.removed;
    const std::size_t created = change_.created.size(), before = removed.size();
    const CreatedTet tet = {{side.x, side.y, above_, below_}, mesh_.region(side.above)};
    const Value alone = judge.value_of(tet.vertices, tet.region);
    create(tet, alone);
    Side next{};
    if (judge.is_enough(alone) || before >= kMost || !beyond(side, next)) return alone;
    change_.created.pop_back();
    values_.pop_back();
    removed.insert(removed.end(), {next.above, next.below});
    Value both = fill({next.above, next.below, side.x, next.z, side.y}, judge);
    if (judge.is_better(both, alone)) {
      both = judge.both(both, fill({next.above, next.below, next.z, side.y, side.x}, judge));
      if (judge.is_better(both, alone)) return both;
    }
    change_.created.resize(created);
    values_.resize(created);
    removed.resize(before);
    create(tet, alone);
    return alone;
  }

  void create(const CreatedTet& tet, const Value& value) {
    change_.created.push_back(tet);
    values_.push_back(value);
  }

  // The face beyond edge x, y, if there is one between the same two vertices.
  bool beyond(const Side& side, Side& next) const {
    const auto across = [&](TetId t, VertexId v) {
      const int i = mesh_.index_of(t, v);
      return mesh_.facet(t, i) == kNone ? mesh_.neighbor(t, i) : kNone;
    };
    const TetId above = across(side.above, side.z), below = across(side.below, side.z);
    if (above == kNone || below == kNone || above == below || across(above, above_) != below) {
      return false;
    }
    if (std::ranges::find(change_.removed, above) != change_.removed.end()) return false;
    for (const VertexId v : mesh_.tet(above)) {
      if (v != above_ && v != side.x && v != side.y) next = {above, below, side.x, side.y, v};
    }
    return true;
  }

  const MeshTopology& mesh_;
  VertexId above_ = 0, below_ = 0;
  Change change_;
  std::vector<Value> values_;
};

}  // namespace delmesher::tetmesh
