// The surface while it changes, and the laws of remesh.h: no change is made that breaks them.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "mesher/remesh/embedding.h"
#include "mesher/remesh/envelope.h"
#include "mesher/remesh/patch.h"
#include "mesher/remesh/remesh.h"
#include "mesher/remesh/shape.h"

namespace delmesher::remesh {

class State {
 public:
  // The surface has to be valid and oriented. `goals.tolerance` is a length.
  State(const Surface& surface, const RemeshGoals& goals, const LocalFrame& frame);
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  const TriangleMesh& mesh() const { return mesh_; }
  double tolerance() const { return goals_.tolerance; }
  double diagonal() const { return diagonal_; }
  Vec3 at(VertexId v) const { return points_.nearest(v); }
  Corners at(const Triangle& t) const { return {at(t[0]), at(t[1]), at(t[2])}; }
  double length(const Line& edge) const { return distance(at(edge[0]), at(edge[1])); }
  bool is_line(VertexId a, VertexId b) const { return mesh_.line_at(a, b) != kNone; }
  // It is on no line, and no corner.
  bool is_free(VertexId v) const { return mesh_.lines_at(v).empty() && corners_[v].empty(); }
  bool is_corner(VertexId v) const { return !corners_[v].empty(); }
  bool is_too_long(const Line& edge) const;

  // The sum over both ends of the squared distances of a place from the planes of the input near
  // them, as a fraction of what the tolerance allows.
  double error(VertexId a, VertexId b, const Vec3& place) const;
  // Where the edge ab may go if it collapses, the best place first; empty: it may not.
  std::vector<Vec3> places(VertexId a, VertexId b) const;

  // Changes that the laws allow are made. The vertex that comes of it, or kNone. Where a collapse
  // makes triangles less round than those that it removes, and than `kAccepted`, it is not made;
  // with Shapes::rounder only if the least round triangle becomes rounder.
  enum class Shapes { as_round, rounder };
  VertexId collapse(VertexId a, VertexId b, Shapes shapes = Shapes::as_round);
  VertexId collapse_to(VertexId a, VertexId b, VertexId p,  // p is b, or new
                       Shapes shapes = Shapes::as_round);
  VertexId split(const Line& edge, double share);
  // Changes that make the least round triangle rounder.
  bool flip(VertexId a, VertexId b);
  bool lead_line_over(const Line& line, VertexId v);
  VertexId move(VertexId v, const Vec3& place);
  // The point of the input, or of its lines for a vertex on a line, that is nearest to p; near v.
  Vec3 nearest_given(VertexId v, const Vec3& p) const;

  Surface surface() const;

 private:
  // Cosines: of the sharpest bends, and of those of each line within a label.
  struct Bends {
    double of_lines = 1, of_others = 1;
    std::vector<std::pair<double, Line>> lines;
    std::vector<Line> sharp;  // others that bend by more than the feature angle

    double flattest_line() const {
      double flattest = -1;
      for (const auto& [cosine, line] : lines) {
        if (!(cosine <= flattest)) flattest = cosine;
      }
      return flattest;
    }
  };

  // Lines that are flat and so none any longer, and sharp edges that become some.
  struct LineChanges {
    std::vector<Line> gone, made;
  };

  State(const Surface& surface, const SurfaceLines& lines, const RemeshGoals& goals,
        const LocalFrame& frame);
  void measure_planes();
  bool is_corner_as_given(VertexId v, const std::vector<std::uint8_t>& line_counts) const;
  VertexId add_point(const Vec3& place);

  std::vector<Simplex> added_triangles(const Patch& patch) const;
  std::vector<Simplex> added_lines(const Patch& patch) const;
  double sine_of_removed(const Patch& patch) const;
  double sine_of_added(const Patch& patch) const;
  bool is_line_with(const Patch& patch, VertexId a, VertexId b) const;
  Bends bends(const std::vector<Triangle>& triangles, const std::vector<std::int32_t>& labels,
              const Patch& patch, bool added) const;
  std::optional<LineChanges> line_changes(const Patch& patch) const;
  bool makes_long_edges(const Patch& patch) const;
  bool makes_rounder(const Patch& patch) const;
  Quadric of_both(VertexId a, VertexId b) const;
  bool may_vanish(VertexId a, VertexId b) const;
  bool apply(Patch patch);

  const RemeshGoals goals_;
  const LocalFrame frame_;
  // Cosines: of the bend of what is not a line, and of the least bend of what is to stay one.
  const double steepest_, flattest_;
  PointStore points_;
  Predicates predicates_{points_};
  Vec3 origin_{};  // of the quadrics
  double diagonal_ = 0;
  TriangleMesh mesh_;
  const double reach_;  // what distances are held to
  Envelope envelope_, line_envelope_;
  Embedding embedding_;
  // By vertex: the corners of the input that it stands for, and planes that it should be near.
  std::vector<std::vector<Vec3>> corners_;
  std::vector<Quadric> quadric_;
};

}  // namespace delmesher::remesh
