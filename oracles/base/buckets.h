// Lists of numbers by vertex, or by facet, in two arrays.
#pragma once

#include <span>
#include <vector>

#include "oracles/base/exact_points.h"

namespace tetproof::oracles {

// Lists by vertex (or by whatever else is numbered), one after the other: entries are counted, then
// put where they belong. There are fewer than 2^32 in all.
class Buckets {
 public:
  explicit Buckets(std::size_t vertices) : ends_(vertices + 1, 0) {}

  void count(Index vertex) { ++ends_[vertex + 1]; }
  void allot() {
    for (std::size_t v = 1; v < ends_.size(); ++v) ends_[v] += ends_[v - 1];
    entries_.resize(ends_.back());
  }
  // Once for every entry counted; from the first one on, ends_[v] is the end of list v so far.
  void put(Index vertex, Index entry) { entries_[ends_[vertex]++] = entry; }
  // The list of a vertex; all of its entries, and those of the vertices before, must be there.
  std::span<const Index> of(Index vertex) const {
    const Index first = vertex == 0 ? 0 : ends_[vertex - 1];
    return std::span(entries_).subspan(first, ends_[vertex] - first);
  }

 private:
  std::vector<Index> ends_, entries_;
};

}  // namespace tetproof::oracles
