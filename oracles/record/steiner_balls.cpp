#include "oracles/record/refinement.h"

#include <algorithm>
#include <optional>

#include "oracles/base/ball_side.h"
#include "oracles/base/earlier_vertices.h"
#include "oracles/mesh/sample.h"

namespace tetproof::oracles {
namespace {

using delmesher::ExactPoint;
using delmesher::ExactRecord;

// Points that are neither of the input nor on the outer box were put into the volume, if they are
// explicit, or on no segment and no facet, however they are given.
std::vector<std::uint8_t> volume_points(const RefinedMesh& mesh) {
  std::vector<std::uint8_t> is_volume(mesh.points->size()), on_surface(mesh.points->size());
  for (const ExactRecord::Chain& chain : mesh.record->segments) {
    for (const Index v : chain.vertices) on_surface[v] = 1;
  }
  for (const auto& [a, b, c, id] : mesh.record->refined_facets) {
    on_surface[a] = on_surface[b] = on_surface[c] = 1;
  }
  const auto& tets = mesh.complex->tetrahedra;
  for (const Index v : used_vertices(*mesh.complex)) {
    const bool is_explicit = mesh.record->points[v].kind == ExactPoint::Kind::explicit_point;
    is_volume[v] = v >= mesh.input_vertices && (is_explicit || on_surface[v] == 0);
  }
  for (Index i = 0; i < mesh.neighbours->across.size(); ++i) {
    if (mesh.neighbours->across[i] != kNone) continue;
    for (const Index v : face_of(tets[i / 4], static_cast<int>(i % 4))) is_volume[v] = 0;
  }
  return is_volume;
}

// Volume Steiner points are put on a grid of 2^-10 of the shortest edge, and may be twice that away
// from their place: 2^-kGridBits of it.
constexpr long kGridBits = 9;

enum class SplitAt : std::uint8_t { circumcentre, centroid, elsewhere };

// Where a vertex is in a tetrahedron (a, b, c, d) that is not flat, to 2^-9 of the shortest edge.
SplitAt place_in(const ExactPoints& points, const std::array<Index, 4>& tetrahedron, Index vertex) {
  const Index a = tetrahedron[0];
  const ExactVector u = exact::difference(points, a, tetrahedron[1]),
                    v = exact::difference(points, a, tetrahedron[2]),
                    w = exact::difference(points, a, tetrahedron[3]),
                    x = exact::difference(points, a, vertex);
  ExactNumber shortest = exact::squared(u);
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < i; ++j) {
      shortest = std::min(
          shortest, exact::squared(exact::difference(points, tetrahedron[i], tetrahedron[j])));
    }
  }
  // The circumcentre is (|u|^2 v x w + |v|^2 w x u + |w|^2 u x v) / 2 det(u, v, w) away from a.
  const ExactVector vw = exact::cross(v, w), wu = exact::cross(w, u), uv = exact::cross(u, v);
  const ExactNumber uu = exact::squared(u), vv = exact::squared(v), ww = exact::squared(w);
  const ExactNumber twice = ExactNumber(2) * exact::dot(u, vw);
  ExactVector off_centre, off_centroid;
  for (std::size_t i = 0; i < 3; ++i) {
    off_centre[i] = twice * x[i] - (uu * vw[i] + vv * wu[i] + ww * uv[i]);
    off_centroid[i] = ExactNumber(4) * x[i] - (u[i] + v[i] + w[i]);
  }
  const auto within = [&](const ExactVector& off, const ExactNumber& scale) {
    return exact::squared(off).shifted(2 * kGridBits) <= scale * scale * shortest;
  };
  if (within(off_centre, twice)) return SplitAt::circumcentre;
  return within(off_centroid, 4) ? SplitAt::centroid : SplitAt::elsewhere;
}

// Points have numbers in the order in which they were made. So the ball was one of the Delaunay
// tetrahedrization of that time exactly if its corners were there, and none of the other vertices
// that were there is strictly inside.
class BallsInTheirTime {
 public:
  explicit BallsInTheirTime(const RefinedMesh& mesh)
      : points_(*mesh.points), complex_(*mesh.complex), is_vertex_(mesh.points->size()) {
    std::vector<Index> vertices = used_vertices(complex_);
    for (const Index v : vertices) is_vertex_[v] = 1;
    earlier_.emplace(points_, std::move(vertices));
  }

  // Empty, or why there was no such tetrahedron, which must not be flat.
  std::string why_not(const ExactRecord::Ball& ball, int sign) const {
    for (const Index v : ball.tetrahedron) {
      if (is_vertex_[v] == 0) return complex_.vertex_name(v) + " of it is not a vertex of the mesh";
      if (v >= ball.vertex) return complex_.vertex_name(v) + " of it was not there yet";
    }
    std::array<Index, 4> corners = ball.tetrahedron;
    if (sign < 0) std::swap(corners[0], corners[1]);
    const BallSide side = BallSide::circumscribed(points_, corners);
    std::string why;
    earlier_->near_ball(corners, ball.vertex, [&](Index v) {
      if (side.side(v) > 0 || std::find(corners.begin(), corners.end(), v) != corners.end()) {
        return false;
      }
      if (exact::insphere(points_, corners[0], corners[1], corners[2], corners[3], v) <= 0) {
        return false;
      }
      why = complex_.vertex_name(v) + ", which was there before, is inside its circumsphere";
      return true;
    });
    return why;
  }

 private:
  const ExactPoints& points_;
  const TetComplex& complex_;
  std::vector<std::uint8_t> is_vertex_;
  std::optional<EarlierVertices> earlier_;
};

}  // namespace

OracleReport check_balls(const RefinedMesh& mesh) {
  OracleReport report("steiner-balls", "vertices");
  const ExactPoints& points = *mesh.points;
  std::uint64_t on_sphere = 0, at_centroids = 0;
  std::vector<std::uint8_t> waiting = volume_points(mesh);
  report.checked = used_vertices(*mesh.complex).size();
  const BallsInTheirTime in_time(mesh);
  for (const ExactRecord::Ball& ball : mesh.record->balls) {
    const auto& [a, b, c, d] = ball.tetrahedron;
    const std::string name = mesh.complex->vertex_name(ball.vertex);
    if (waiting[ball.vertex] == 0) {
      report.fail(name + " has a ball too many, or is not a volume Steiner point");
    }
    waiting[ball.vertex] = 0;
    const int sign = exact::orient3d(points, a, b, c, d);
    const int inside = sign * exact::insphere(points, a, b, c, d, ball.vertex);
    if (sign == 0) {
      report.fail(name + " was made for a flat tetrahedron");
    } else if (inside <= 0) {
      on_sphere += inside == 0;
      report.fail(name + " is " + (inside == 0 ? "on" : "outside") +
                  " the circumsphere that it was made for");
    } else if (const std::string why = in_time.why_not(ball, sign); !why.empty()) {
      report.fail(name + " was made for no tetrahedron of that time: " + why);
    }
    if (sign == 0 || !mesh.promise->steiner_point) continue;
    const SplitAt place = place_in(points, ball.tetrahedron, ball.vertex);
    at_centroids += place == SplitAt::centroid;
    if (place == SplitAt::elsewhere) {
      report.fail(name + " is not at the circumcentre of the tetrahedron that it was made for");
    }
  }
  for (Index v = 0; v < waiting.size(); ++v) {
    if (waiting[v] != 0) {
      report.fail(mesh.complex->vertex_name(v) + " was put into the volume for no ball");
    }
  }
  report.figures.emplace_back("on the sphere", on_sphere);
  if (mesh.promise->steiner_point) report.figures.emplace_back("at centroids", at_centroids);
  return report;
}

}  // namespace tetproof::oracles
