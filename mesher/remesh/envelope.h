// Two sets of triangles, or of segments, each within a distance of the other: one stays, the other
// changes.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesher/remesh/changing_box_tree.h"
#include "mesher/remesh/coverage.h"

namespace delmesher::remesh {

// Law: every point of what is given and counts is within `distance` of what is there with the same
// label, and what is there of what is given. At first both are the same.
class Envelope {
 public:
  // Without `counts` all that is given counts.
  Envelope(std::vector<Simplex> given, double distance, std::vector<std::uint8_t> counts = {});

  // Does the law hold with those added in the place of those removed? What is added gets the next
  // numbers, in order, if commit() follows.
  bool allows(std::span<const std::uint32_t> removed, std::span<const Simplex> added);
  void commit(std::span<const std::uint32_t> removed, std::span<const Simplex> added);

  // Is p within the distance of what is given near those that are there?
  bool is_near(const Vec3& p, std::span<const std::uint32_t> there) const;
  // The point of what is given near those that are there that is nearest to p.
  Vec3 nearest_given(const Vec3& p, std::span<const std::uint32_t> there) const;

  const ChangingBoxTree& boxes() const { return there_boxes_; }

 private:
  // Of what is given: as it is, until many cover it. So a change asks for few of its covers.
  struct Piece {
    Simplex simplex;
    std::uint32_t given;
    std::vector<std::uint32_t> cover;  // what there is within whose distance it is
  };

  bool is_covered_by_given(const Simplex& simplex);
  bool still_covers(const Piece& piece, std::span<const std::uint32_t> removed,
                    std::span<const Simplex> added);
  void set_cover(std::uint32_t piece, std::vector<std::uint32_t> cover);
  void split(std::uint32_t piece);
  Box grown(Box box) const;

  double distance_;
  std::vector<Simplex> given_, there_;
  std::vector<std::uint8_t> counts_;  // by what is given
  BoxTree given_boxes_;
  ChangingBoxTree there_boxes_;
  std::vector<Piece> pieces_;
  std::vector<std::vector<std::uint32_t>> covered_by_;  // pieces, by what is there
  // Of the change that is looked at: pieces, and their new covers.
  std::vector<std::uint32_t> affected_;
  std::vector<std::vector<std::uint32_t>> new_cover_;
  Coverage coverage_;
};

}  // namespace delmesher::remesh
