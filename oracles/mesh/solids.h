// The solids that labels of a complex bound. A label is that of one if its triangles are closed: an
// even number of them at each edge.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "oracles/base/box_tree.h"
#include "oracles/base/exact_points.h"
#include "oracles/base/exact_sum.h"
#include "oracles/files/mesh_file.h"
#include "oracles/surface/input_surface.h"

namespace tetproof::oracles {

// Does a face look up, or, if it is upright, to where the rays of crossings_above() are moved?
bool looks_up(const ExactPoints& points, const Face& face);

// Faces that rays cross, in a tree.
class RayTarget {
 public:
  RayTarget(const ExactPoints& points, std::vector<Face> faces);

  // Is a point beside a face, in front of it, where its corners are seen counter-clockwise, or
  // behind, surrounded by an odd number of the faces? `own`: its number among them, or kNone.
  bool surrounds(const Face& face, bool behind, Index own) const;
  // Or the centroid of corners?
  bool surrounds(std::span<const Index> corners) const;
  // What a ray upwards from the centroid of corners crosses, `except` for one face.
  RayCrossings above(std::span<const Index> corners, Index except = kNone) const;
  const std::vector<Face>& faces() const { return faces_; }

 private:
  const ExactPoints* points_;
  std::vector<Face> faces_;
  std::unique_ptr<BoxTree> tree_;
  RayParts parts_;
};

class Solids {
 public:
  // `labels`: all of each face.
  Solids(const ExactPoints& points, const std::vector<Face>& faces,
         const std::vector<std::vector<std::int32_t>>& labels);

  // Of the smallest solid around a point beside face n, in front or behind, or around the centroid
  // of corners. None: it is in none.
  std::optional<std::int32_t> beside(Index n, bool behind) const;
  std::optional<std::int32_t> around(std::span<const Index> corners) const;

 private:
  struct Solid {
    std::int32_t label;
    RayTarget target;
    std::vector<Index> faces;  // their numbers, ascending
    ExactSum volume;
  };

  Index own(const Solid& solid, Index face) const;
  void add(std::int32_t label, const std::vector<Index>& numbers);
  template <class Surrounds>
  std::optional<std::int32_t> smallest(const Surrounds& surrounds) const;

  const ExactPoints& points_;
  const std::vector<Face>& faces_;
  std::vector<Solid> solids_;
};

}  // namespace tetproof::oracles
