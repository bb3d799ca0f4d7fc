#include "mesher/output/thinning.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "mesher/base/sort_unique.h"
#include "mesher/geometry/vector.h"
#include "mesher/predicates/signs_of_doubles.h"
#include "mesher/tetmesh/contract_edge.h"
#include "mesher/tetmesh/numbering.h"

namespace delmesher::output {
namespace {

// The best target is that with the fewest tetrahedra that are not positive on nearest doubles, then
// that with the best worst shape.
class Judge {
 public:
  using Value = std::pair<std::size_t, double>;  // how many are not, and minus
                                                 // the worst shape

  Judge(const LocalFrame& frame, const PointStore& points, Predicates& predicates,
        const MeshTopology& mesh)
      : frame_(frame), points_(points), predicates_(predicates), mesh_(mesh) {}

  static Value nothing() { return {0, -HUGE_VAL}; }
  bool add(TetId t, int i, VertexId w, Value& value) {
    Tet moved = mesh_.tet(t);
    moved[i] = w;
    if (predicates_.orient3d(moved[0], moved[1], moved[2], moved[3]) <= 0) return false;
    value.first += is_bad_as_written(moved) ? 1 : 0;
    value.second = std::max(value.second, -shape(moved));
    return true;
  }
  static bool is_better(const Value& value, const Value& best) { return value < best; }

  bool is_bad_as_written(const Tet& t) const {
    const auto at = [&](int i) { return frame_.written(points_.nearest(t[i])); };
    return orient3d_sign(at(0), at(1), at(2), at(3)) <= 0;
  }

 private:
  // Volume by the third power of the longest edge, roughly.
  double shape(const Tet& t) const {
    double longest2 = 0;
    for (int i = 0; i < 4; ++i) {
      for (int j = i + 1; j < 4; ++j) {
        longest2 = std::max(longest2, squared_norm(points_.difference(t[i], t[j])));
      }
    }
    const double longest = std::sqrt(longest2);
    const auto edge = [&](int i) {
      Vec3 e = points_.difference(t[0], t[i]);
      for (double& x : e) x /= longest;
      return e;
    };
    const double volume = dot(cross(edge(1), edge(2)), edge(3));
    return std::isfinite(volume) ? std::fabs(volume) : 0;
  }

  const LocalFrame& frame_;
  const PointStore& points_;
  Predicates& predicates_;
  const MeshTopology& mesh_;
};

// Vertices have the numbers of their points.
class Thinning {
 public:
  Thinning(std::size_t fixed_vertices, const LocalFrame& frame, const PointStore& points,
           Predicates& predicates, ConformingMesh& mesh)
      : fixed_vertices_(fixed_vertices),
        points_(points),
        topology_(std::move(mesh.tetrahedra), mesh.region, mesh.boundary, points.size()),
        judge_(frame, points, predicates, topology_),
        operation_(topology_) {}

  std::vector<VertexId> removable_around(std::span<const VertexId> around, int rings) {
    std::vector<VertexId> reached(around.begin(), around.end());
    sort_unique(reached);
    for (int i = 0; i < rings; ++i) {
      std::vector<VertexId> next = reached;
      for (const VertexId v : reached) {
        if (topology_.incident(v) == kNone) continue;
        operation_.begin(v);
        for (const TetId t : operation_.star()) {
          next.insert(next.end(), topology_.tet(t).begin(), topology_.tet(t).end());
        }
      }
      sort_unique(next);
      reached = std::move(next);
    }
    std::erase_if(reached, [&](VertexId v) {
      return topology_.incident(v) == kNone || v < fixed_vertices_ ||
             (points_.is_explicit(v) && !points_.planes(v).empty());
    });
    return reached;
  }

  // Collapses v to the best of its neighbours, if there is one to which it can go.
  bool remove(VertexId v) {
    operation_.begin(v);
    const auto bad = static_cast<std::size_t>(std::ranges::count_if(
        operation_.star(), [&](TetId t) { return judge_.is_bad_as_written(topology_.tet(t)); }));
    const VertexId target = operation_.find({bad + 1, -HUGE_VAL}, judge_);
    if (target == kNone) return false;
    topology_.contract(v, target, operation_.star());
    return true;
  }

  ConformingMesh result() const {
    std::vector<VertexId> point(topology_.vertices());
    std::iota(point.begin(), point.end(), 0U);
    return mesh_of(topology_, point);
  }

 private:
  std::size_t fixed_vertices_;
  const PointStore& points_;
  MeshTopology topology_;
  Judge judge_;
  ContractEdge<Judge> operation_;
};

}  // namespace

std::size_t thin_out(std::span<const VertexId> around, int rings, std::size_t fixed_vertices,
                     const LocalFrame& frame, const PointStore& points, Predicates& predicates,
                     Control& control, ConformingMesh& mesh) {
  Thinning thinning(fixed_vertices, frame, points, predicates, mesh);
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
  mesh = thinning.result();
  return candidates - left.size();
}

}  // namespace delmesher::output
