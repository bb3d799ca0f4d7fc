// The queue of refinement: worst triangles first within a neighbourhood, one neighbourhood after
// the other. Worst first makes fewer points; over a large mesh, it would touch another part of the
// memory with every point.
//
// Invariants:
//  - a waiting entry is in a bucket, behind its head, or on the stack of entries for later;
//  - no bucket below the lowest one has entries, and there are count_ in the buckets.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <vector>

#include "mesher/base/check.h"
#include "mesher/plane/spatial_order.h"
#include "mesher/plane/triangulation.h"

namespace delmesher::plane {

class BadTriangles {
 public:
  struct Entry {
    TriangleId triangle;
    std::array<VertexId, 3> vertex;  // as it was: it may be gone by the time of its turn
  };

  BadTriangles(const PointStore& points, const SpatialKey& place)
      : points_(points), place_(place) {}

  // `badness` below 1: squared sine of the smallest angle; 1: for another reason.
  void push(double badness, const Entry& entry) {
    put(bucket(badness), entry);
    if (count_ > kMost && !gathering_) spread();
  }

  // Between these two, entries are only collected.
  void gather() { gathering_ = true; }
  void sort() {
    gathering_ = false;
    if (count_ > kBlock) spread();
  }

  bool pop(Entry& entry) {
    for (;;) {
      for (; lowest_ < kBuckets; ++lowest_) {
        Queue& q = queue_[lowest_];
        if (q.head < q.entries.size()) {
          entry = q.entries[q.head++];
          --count_;
          return true;
        }
        q.entries.clear();
        q.head = 0;
      }
      if (later_.empty()) return false;
      for (std::size_t k = 0; k < kBlock && !later_.empty(); ++k) {
        put(later_.back().bucket, later_.back().entry);
        later_.pop_back();
      }
    }
  }

  void clear() {
    empty_buckets();
    later_.clear();
  }

  // Calls visit(entry) for all entries that wait.
  template <class Visit>
  void for_each(Visit&& visit) const {
    for (const Queue& q : queue_) {
      for (std::size_t k = q.head; k < q.entries.size(); ++k) visit(q.entries[k]);
    }
    for (const Item& item : later_) visit(item.entry);
  }

  // Throws InternalError at the first broken invariant.
  void validate() const {
    std::size_t count = 0;
    for (std::size_t b = 0; b < kBuckets; ++b) {
      const Queue& q = queue_[b];
      DELMESHER_CHECK(q.head <= q.entries.size(), "more was taken from a bucket than is in it");
      DELMESHER_CHECK(b >= lowest_ || q.head == q.entries.size(),
                      "an entry below the lowest bucket");
      count += q.entries.size() - q.head;
    }
    DELMESHER_CHECK(count == count_, "the count of entries is not that of the buckets");
    for (const Item& item : later_) {
      DELMESHER_CHECK(item.bucket < kBuckets, "an entry for no bucket");
    }
  }

 private:
  friend struct BadTrianglesBreaker;  // of the tests of validate()

  static constexpr std::size_t kBuckets = 256;
  // The entries of a neighbourhood at its start, and how many divide it: the memory that they touch
  // stays in a cache of a megabyte.
  static constexpr std::size_t kBlock = 1024, kMost = 8 * kBlock;

  // In the order of arrival among equally bad ones.
  struct Queue {
    std::vector<Entry> entries;
    std::size_t head = 0;
  };
  struct Item {
    std::uint64_t key;
    std::uint32_t position;
    std::uint32_t bucket;
    Entry entry;
  };

  // By the leading bits, monotone: four buckets for each factor of two below 1, the last for all
  // above.
  static std::size_t bucket(double badness) {
    const auto bits = std::bit_cast<std::uint64_t>(std::max(badness, 0.0)) >> 50;
    constexpr std::uint64_t kTop = std::uint64_t{1023} << 2;  // of 1.0
    const std::uint64_t below = bits >= kTop ? 0 : kTop - bits;
    return below >= kBuckets ? 0 : kBuckets - 1 - static_cast<std::size_t>(below);
  }

  void put(std::size_t b, const Entry& entry) {
    Queue& q = queue_[b];
    if (q.head >= kBlock && 2 * q.head > q.entries.size()) {
      q.entries.erase(q.entries.begin(), q.entries.begin() + static_cast<std::ptrdiff_t>(q.head));
      q.head = 0;
    }
    q.entries.push_back(entry);
    lowest_ = std::min(lowest_, b);
    ++count_;
  }

  void empty_buckets() {
    for (Queue& q : queue_) {
      q.entries.clear();
      q.head = 0;
    }
    lowest_ = kBuckets;
    count_ = 0;
  }

  // Moves all waiting entries, in their order in space, onto the stack of entries for later.
  void spread() {
    const auto first = static_cast<std::ptrdiff_t>(later_.size());
    for (std::size_t b = 0; b < kBuckets; ++b) {
      for (std::size_t k = queue_[b].head; k < queue_[b].entries.size(); ++k) {
        const Entry& entry = queue_[b].entries[k];
        const Approximation& x = points_.approximation(entry.vertex[0]);
        later_.push_back({place_(x.x, x.y), static_cast<std::uint32_t>(later_.size()),
                          static_cast<std::uint32_t>(b), entry});
      }
    }
    empty_buckets();
    std::sort(later_.begin() + first, later_.end(), [](const Item& a, const Item& b) {
      return a.key != b.key ? a.key > b.key : a.position > b.position;
    });
  }

  const PointStore& points_;
  SpatialKey place_;
  std::array<Queue, kBuckets> queue_;
  std::size_t lowest_ = kBuckets;
  std::size_t count_ = 0;
  bool gathering_ = false;
  std::vector<Item> later_;  // the next at the end
};

}  // namespace delmesher::plane
