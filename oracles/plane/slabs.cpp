#include "oracles/plane/slabs.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace tetproof {

PlaneSlabs::PlaneSlabs(PlanePoints& points, std::vector<Piece> pieces)
    : points_(points), pieces_(std::move(pieces)) {
  for (Piece& piece : pieces_) {
    if (point(piece.b).dy < point(piece.a).dy) std::swap(piece.a, piece.b);
    for (const Index v : {piece.a, piece.b}) heights_.push_back(point(v).dy);
  }
  std::sort(heights_.begin(), heights_.end());
  heights_.erase(std::unique(heights_.begin(), heights_.end()), heights_.end());
  slabs_.resize(2 * std::bit_ceil(heights_.size()));
  for (Index n = 0; n < pieces_.size(); ++n) add(n);
  for (std::size_t at = 1; at < slabs_.size(); ++at) sort(at);
}

// A level piece, which no ray crosses, is in none.
void PlaneSlabs::add(Index piece) {
  const auto leaf = [this](Index v) {
    const auto at = std::lower_bound(heights_.begin(), heights_.end(), point(v).dy);
    return slabs_.size() / 2 + static_cast<std::size_t>(at - heights_.begin());
  };
  for (std::size_t first = leaf(pieces_[piece].a), last = leaf(pieces_[piece].b); first < last;
       first /= 2, last /= 2) {
    if (first % 2 != 0) slabs_[first++].pieces.push_back(piece);
    if (last % 2 != 0) slabs_[--last].pieces.push_back(piece);
  }
}

// Pieces that are in order at both ends of a slab do not cross in it.
void PlaneSlabs::sort(std::size_t at) {
  std::vector<Index>& all = slabs_[at].pieces;
  if (all.size() < 2) return;
  const std::size_t leaves = slabs_.size() / 2, width = leaves >> (std::bit_width(at) - 1);
  const std::size_t first = at * width - leaves;
  const double low = heights_[first], high = heights_[first + width];
  std::sort(all.begin(), all.end(), [&](Index s, Index t) {
    const int below = compare(pieces_[s], pieces_[t], low);
    return below != 0 ? below < 0 : compare(pieces_[s], pieces_[t], high) < 0;
  });
  for (std::size_t k = 0; k + 1 < all.size() && slabs_[at].in_order; ++k) {
    slabs_[at].in_order = compare(pieces_[all[k]], pieces_[all[k + 1]], high) <= 0;
  }
}

// Between which numbers the piece certainly is at this height; between any where doubles overflow.
std::pair<double, double> PlaneSlabs::near(const Piece& piece, double height) const {
  const Point &a = point(piece.a), &b = point(piece.b);
  const double rise = b.dy - a.dy, slope = (b.dx - a.dx) / rise, x = a.dx + (height - a.dy) * slope;
  const double size = std::fabs(a.dx) + std::fabs(a.dy) + std::fabs(height) + std::fabs(x);
  const double error = 1e-12 * (1 + std::fabs(slope)) * size + 1e-300;
  if (!std::isfinite(error + rise)) return {-HUGE_VAL, HUGE_VAL};
  return {x - error, x + error};
}

// Which one is to the left of the other at this height, which both reach? (-1: the first)
int PlaneSlabs::compare(const Piece& s, const Piece& t, double height) const {
  if ((s.a == t.a && point(s.a).dy == height) || (s.b == t.b && point(s.b).dy == height)) return 0;
  const auto [s_from, s_to] = near(s, height);
  const auto [t_from, t_to] = near(t, height);
  if (s_to < t_from) return -1;
  if (t_to < s_from) return 1;
  const auto exact = [&](const Piece& piece) {
    const Point &a = point(piece.a), &b = point(piece.b);
    return mpq_class(a.x + (height - a.y) * (b.x - a.x) / (b.y - a.y));
  };
  return cmp(exact(s), exact(t));
}

// The lowest slab of the tree that a point is in, without its upper end; 0 if there is none.
std::size_t PlaneSlabs::leaf_of(const Point& p) const {
  const auto above = std::upper_bound(
      heights_.begin(), heights_.end(), p,
      [](const Point& q, double height) { return q.dy != height ? q.dy < height : q.y < height; });
  if (above == heights_.begin() || above == heights_.end()) return 0;
  return slabs_.size() / 2 + static_cast<std::size_t>(above - heights_.begin()) - 1;
}

std::size_t PlaneSlabs::first_right_of(std::span<const Index> pieces, const Point& p) {
  const auto first = std::partition_point(pieces.begin(), pieces.end(),
                                          [&](Index piece) { return !is_right_of(piece, p); });
  return static_cast<std::size_t>(first - pieces.begin());
}

// Of a piece that is as high as p. One through p goes to the right or to the left above it.
bool PlaneSlabs::is_right_of(Index piece, const Point& p) {
  const Point &a = point(pieces_[piece].a), &b = point(pieces_[piece].b);
  const int side = points_.orient(a, b, p);
  return side != 0 ? side > 0 : a.dx < b.dx;
}

}  // namespace tetproof
