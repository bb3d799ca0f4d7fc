#include "mesher/output/thinning.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "mesher/base/sort_unique.h"
#include "mesher/geometry/vector.h"
#include "mesher/tetmesh/contract_edge.h"
#include "mesher/tetmesh/placed_mesh.h"

namespace delmesher::output {
namespace {

// Volume by the third power of the longest edge, roughly.
double shape_of(const PointStore& points, const Tet& t) {
  double longest2 = 0;
  for (int i = 0; i < 4; ++i) {
    for (int j = i + 1; j < 4; ++j) {
      longest2 = std::max(longest2, squared_norm(points.difference(t[i], t[j])));
    }
  }
  const double longest = std::sqrt(longest2);
  const auto edge = [&](int i) {
    Vec3 e = points.difference(t[0], t[i]);
    for (double& x : e) x /= longest;
    return e;
  };
  const double volume = dot(cross(edge(1), edge(2)), edge(3));
  return std::isfinite(volume) ? std::fabs(volume) : 0;
}

// Vertices have the numbers of their points.
class Thinning final : public PlacedMesh {
 public:
  Thinning(std::size_t fixed_vertices, const LocalFrame& frame, const PointStore& points,
           Predicates& predicates, ConformingMesh given)
      : PlacedMesh(numbered_by_points(std::move(given), points.size())),
        fixed_vertices_(fixed_vertices),
        points_(points),
        judge_{*this, points, predicates},
        operation_(mesh) {
    for (const VertexId v : point_) position_.push_back(frame.written(points.nearest(v)));
  }

  std::vector<VertexId> removable_around(std::span<const VertexId> around, int rings) {
    std::vector<VertexId> reached(around.begin(), around.end());
    sort_unique(reached);
    for (int i = 0; i < rings; ++i) {
      std::vector<VertexId> next = reached;
      for (const VertexId v : reached) {
        if (mesh.incident(v) == kNone) continue;
        operation_.begin(v);
        for (const TetId t : operation_.star()) {
          next.insert(next.end(), mesh.tet(t).begin(), mesh.tet(t).end());
        }
      }
      sort_unique(next);
      reached = std::move(next);
    }
    std::erase_if(reached, [&](VertexId v) {
      return mesh.incident(v) == kNone || v < fixed_vertices_ ||
             (points_.is_explicit(v) && !points_.planes(v).empty());
    });
    return reached;
  }

  // Collapses v to the best of its neighbours, if there is one to which it can go.
  bool remove(VertexId v) {
    operation_.begin(v);
    const auto bad = static_cast<std::size_t>(std::ranges::count_if(
        operation_.star(), [&](TetId t) { return sign_of(mesh.tet(t)) <= 0; }));
    const VertexId target = operation_.find({bad + 1, -HUGE_VAL}, judge_);
    if (target == kNone) return false;
    contract(v, target, operation_.star());
    return true;
  }

 private:
  // The best target is that with the fewest tetrahedra that are not positive on nearest doubles,
  // then that with the best worst shape.
  struct Judge {
    using Value = std::pair<std::size_t, double>;  // how many are not, and minus the worst shape

    const Thinning& thinning;
    const PointStore& points;
    Predicates& predicates;

    static Value nothing() { return {0, -HUGE_VAL}; }
    bool add(TetId t, int i, VertexId w, Value& value) {
      Tet moved = thinning.mesh.tet(t);
      moved[i] = w;
      if (predicates.orient3d(moved[0], moved[1], moved[2], moved[3]) <= 0) return false;
      value.first += thinning.sign_of(moved) <= 0 ? 1 : 0;
      value.second = std::max(value.second, -shape_of(points, moved));
      return true;
    }
    static bool is_better(const Value& value, const Value& best) { return value < best; }
  };

  void note(TetId) override {}

  std::size_t fixed_vertices_;
  const PointStore& points_;
  Judge judge_;
  ContractEdge<Judge> operation_;
};

}  // namespace

std::size_t thin_out(std::span<const VertexId> around, int rings, std::size_t fixed_vertices,
                     const LocalFrame& frame, const PointStore& points, Predicates& predicates,
                     Control& control, ConformingMesh& mesh) {
  Thinning thinning(fixed_vertices, frame, points, predicates, std::move(mesh));
  std::vector<VertexId> left = thinning.removable_around(around, rings);
  const std::size_t candidates = left.size();
  // One that could not go may be able to when its neighbours have gone.
  for (std::size_t before = left.size() + 1; left.size() < before;) {
    before = left.size();
    std::erase_if(left, [&](VertexId v) {
      control.poll_now(0, -1);
      return thinning.remove(v);
    });
  }
  mesh = thinning.conforming();
  return candidates - left.size();
}

}  // namespace delmesher::output
