// Edges or faces of a mesh, to be looked up by their corners.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "oracles/base/exact_points.h"

namespace tetproof::oracles {

// Each simplex once, whatever the order of its corners. Few have the same lowest corner, so one is
// found among those of that corner, without a search through all.
template <std::size_t N>
class SimplexSet {
  static_assert(N == 2 || N == 3);

 public:
  using Simplex = std::array<Index, N>;

  SimplexSet() = default;
  explicit SimplexSet(const std::vector<Simplex>& given) {
    Index last = 0;
    for (const Simplex& s : given) last = std::max(last, sorted(s)[0]);
    first_.assign(given.empty() ? 1 : std::size_t{last} + 2, 0);
    for (const Simplex& s : given) ++first_[sorted(s)[0] + 1];
    for (std::size_t v = 1; v < first_.size(); ++v) first_[v] += first_[v - 1];
    simplices_.resize(given.size());
    for (const Simplex& s : given) {
      for (const Index v : s) {
        if (v >= is_corner_.size()) is_corner_.resize(std::size_t{v} + 1);
        is_corner_[v] = 1;
      }
    }
    std::vector<Index> next = first_;
    for (const Simplex& s : given) {
      const Simplex ascending = sorted(s);
      simplices_[next[ascending[0]]++] = ascending;
    }
    remove_duplicates();
  }

  std::size_t size() const { return simplices_.size(); }
  // Corners ascending; simplices ascending.
  const Simplex& operator[](std::size_t n) const { return simplices_[n]; }
  // size() if it is not among them.
  std::size_t find(const Simplex& simplex) const {
    const Simplex wanted = sorted(simplex);
    if (std::size_t{wanted[0]} + 1 >= first_.size()) return size();
    const auto begin = simplices_.begin() + first_[wanted[0]];
    const auto end = simplices_.begin() + first_[wanted[0] + 1];
    const auto found = std::lower_bound(begin, end, wanted);
    return found != end && *found == wanted ? found - simplices_.begin() : size();
  }
  bool contains(const Simplex& simplex) const { return find(simplex) < size(); }
  bool has_corner(Index v) const { return v < is_corner_.size() && is_corner_[v] != 0; }
  // The corners of a tetrahedron that are corners of simplices, as bits.
  unsigned corners_among(const std::array<Index, 4>& tetrahedron) const {
    unsigned among = 0;
    for (unsigned i = 0; i < 4; ++i) {
      among |= static_cast<unsigned>(has_corner(tetrahedron[i])) << i;
    }
    return among;
  }

 private:
  static Simplex sorted(Simplex s) {
    if constexpr (N == 3) {
      if (s[1] > s[2]) std::swap(s[1], s[2]);
    }
    if (s[0] > s[1]) std::swap(s[0], s[1]);
    if constexpr (N == 3) {
      if (s[1] > s[2]) std::swap(s[1], s[2]);
    }
    return s;
  }

  void remove_duplicates() {
    std::size_t kept = 0;
    for (std::size_t v = 0; v + 1 < first_.size(); ++v) {
      const auto begin = simplices_.begin() + first_[v], end = simplices_.begin() + first_[v + 1];
      std::sort(begin, end);
      const auto last = std::unique(begin, end);
      first_[v] = static_cast<Index>(kept);
      for (auto s = begin; s != last; ++s) simplices_[kept++] = *s;
    }
    first_.back() = static_cast<Index>(kept);
    simplices_.resize(kept);
  }

  std::vector<Simplex> simplices_;
  std::vector<std::uint8_t> is_corner_;  // per vertex
  std::vector<Index> first_;  // per lowest corner, where its simplices begin; and the end
};

}  // namespace tetproof::oracles
