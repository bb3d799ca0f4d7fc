// The points of an arrangement: the vertices that are given, and new ones at exact places.
#pragma once

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>

#include <map>
#include <span>
#include <vector>

#include "corpus/union/soup.h"

namespace tetproof::unite {

using Exact = CGAL::Exact_predicates_exact_constructions_kernel;

class Points {
 public:
  // No two of the given ones are equal. They have the first numbers.
  explicit Points(std::span<const Position> given)
      : given_(given.begin(), given.end()), entered_(given.size()) {}

  Index size() const { return static_cast<Index>(given_.size() + made_.size()); }
  bool is_given(Index i) const { return i < given_.size(); }
  Exact::Point_3 operator[](Index i) const {
    if (!is_given(i)) return made_[i - given_.size()];
    const Position& p = given_[i];
    return {p[0], p[1], p[2]};
  }
  // From now on number_of() finds this given point. Most are far from all new ones.
  void enter(Index given) {
    if (entered_[given]) return;
    entered_[given] = true;
    numbers_.emplace((*this)[given], given);
  }
  // The number of the equal point that is entered or new; if there is none, of a new one.
  Index number_of(const Exact::Point_3& p) {
    const auto [at, fresh] = numbers_.try_emplace(p, size());
    if (fresh) made_.push_back(p);
    return at->second;
  }
  // The nearest doubles.
  Position rounded(Index i) const;
  // Something near it.
  Position approximate(Index i) const;

 private:
  std::vector<Position> given_;
  std::vector<bool> entered_;
  std::vector<Exact::Point_3> made_;
  std::map<Exact::Point_3, Index> numbers_;  // lexicographically
};

// The axis along which the normal of a triangle has its largest coordinate.
int axis_across(const Points& points, const Triangle& triangle);

// Along that axis into the plane of the two others, which keeps turns as they are seen from above.
Exact::Point_2 projected(const Exact::Point_3& p, int axis);

}  // namespace tetproof::unite
