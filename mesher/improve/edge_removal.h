// Edges go where the tetrahedra around them become better (tetmesh/remove_edge.h).
#pragma once

#include <cstdint>
#include <span>

#include "mesher/improve/state.h"
#include "mesher/tetmesh/remove_edge.h"

namespace delmesher::improve {

class EdgeRemoval {
 public:
  explicit EdgeRemoval(State& state) : state_(state), operation_(state.mesh), judge_(state) {}

  // Removes edge i-j of t if that makes the worst tetrahedron of the ring better. `failed`: per
  // slot, the clock plus 1 when the edges of its tetrahedron had been tried; whatever tetrahedron
  // of the ring they were tried from, there is no use in trying again before one of their ends
  // changes.
  bool run(TetId t, int i, int j, std::span<const std::uint32_t> failed);
  // Removes it if the tetrahedra are rounder on average afterwards, and the worst of them stay good
  // enough.
  bool round_off(TetId t, int i, int j, std::span<const std::uint32_t> failed);
  // Removes edge i-j of t, which lies within a facet, if what replaces the ring is positive,
  // however bad.
  bool flip(TetId t, int i, int j);

 private:
  // The measure by which fillings of a polygon are compared.
  enum class Aim : std::uint8_t { best_worst, roundest };

  // The value of a filling; nothing has been found while its worst is flat. `roundness`: how much
  // rounder than is asked for on average, summed over its tetrahedra, if that is the aim.
  struct Filling {
    Quality worst;
    double roundness = 0;
  };

  class Judge {
   public:
    using Value = Filling;
    explicit Judge(const State& state) : state_(state) {}

    // The edge, and what is known of earlier attempts.
    void look_at(VertexId a, VertexId b, std::span<const std::uint32_t> failed) {
      a_ = a;
      b_ = b;
      failed_ = failed;
    }
    // `least`: the quality that the new tetrahedra have to reach.
    void want(Aim aim, const Quality& least) {
      aim_ = aim;
      least_ = least;
    }
    static double roundness(const Quality& q);

    static Filling nothing() { return {kNotCounted, 0}; }
    static Filling impossible() { return {}; }
    static Filling both(const Filling& a, const Filling& b) {
      return {worse(a.worst, b.worst), a.roundness + b.roundness};
    }
    static bool is_possible(const Filling& filling) { return filling.worst.dihedral > 0; }
    // Has a-b been tried from t, and no tetrahedron at a or none at b has changed since?
    bool is_known(TetId t) const {
      return t < failed_.size() &&
             (failed_[t] > state_.changed_at(a_) || failed_[t] > state_.changed_at(b_));
    }
    void begin(RegionId region) {
      region_ = region;
      counts_ = state_.counts_in(region);
      asked_ = counts_ ? least_ : Quality{};
    }
    bool may_join(VertexId v, VertexId w) const {
      return !counts_ || !state_.too_long(state_.position(v), state_.position(w), region_);
    }
    bool add(const Tet& tet, Filling& filling) const {
      const Quality q = state_.quality_of(tet, asked_);
      filling.worst = worse(filling.worst, q);
      if (counts_ && aim_ == Aim::roundest) filling.roundness += roundness(q);
      return true;
    }
    bool is_worth(const Filling& filling, const Filling& best) const {
      return is_possible(filling) && State::reaches(filling.worst, asked_) &&
             (aim_ != Aim::best_worst || is_better(filling, best));
    }
    bool is_better(const Filling& filling, const Filling& best) const {
      return aim_ == Aim::best_worst ? state_.score(filling.worst) > state_.score(best.worst)
                                     : !is_possible(best) || filling.roundness > best.roundness;
    }
    bool is_enough(const Filling&) const { return !counts_; }

   private:
    const State& state_;
    VertexId a_ = 0, b_ = 0;
    std::span<const std::uint32_t> failed_;
    Aim aim_ = Aim::best_worst;
    Quality least_, asked_;
    RegionId region_ = kOutside;  // of the tetrahedra around the edge
    bool counts_ = true;
  };

  using Operation = RemoveEdge<Judge>;
  // The same for roundness, and its longest polygon: of longer ones hardly any becomes rounder.
  static constexpr int kLongestForRoundness = 6, kLargestForRoundness = 4;

  bool find(TetId t, int i, int j, std::size_t longest, std::span<const std::uint32_t> failed);
  bool refill(double least_roundness);

  State& state_;
  Operation operation_;
  Judge judge_;
};

}  // namespace delmesher::improve
