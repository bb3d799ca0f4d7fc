#include "mesher/remesh/envelope.h"

#include <algorithm>
#include <utility>

namespace delmesher::remesh {
namespace {

constexpr std::size_t kMostCovers = 16;  // of a piece that is not split

std::vector<Box> boxes_of(const std::vector<Simplex>& simplices) {
  std::vector<Box> boxes;
  boxes.reserve(simplices.size());
  for (const Simplex& simplex : simplices) boxes.push_back(simplex.box);
  return boxes;
}

}  // namespace

Envelope::Envelope(std::vector<Simplex> given, double distance, std::vector<std::uint8_t> counts)
    : distance_(distance),
      given_(std::move(given)),
      there_(given_),
      counts_(std::move(counts)),
      given_boxes_(boxes_of(given_)),
      there_boxes_(boxes_of(given_)),
      coverage_(distance) {
  counts_.resize(given_.size(), 1);
  for (std::uint32_t i = 0; i < given_.size(); ++i) {
    pieces_.push_back({given_[i], i, {i}});
    covered_by_.push_back({i});
  }
}

Box Envelope::grown(Box box) const {
  for (std::size_t i = 0; i < 3; ++i) {
    box.lo[i] -= distance_;
    box.hi[i] += distance_;
  }
  return box;
}

bool Envelope::is_near(const Vec3& p, std::span<const std::uint32_t> there) const {
  const double least = distance_ * distance_;
  return std::ranges::any_of(there, [&](std::uint32_t t) {
    return std::ranges::any_of(covered_by_[t], [&](std::uint32_t n) {
      return squared_distance(p, given_[pieces_[n].given]) < least;
    });
  });
}

Vec3 Envelope::nearest_given(const Vec3& p, std::span<const std::uint32_t> there) const {
  Vec3 best = p;
  double least = HUGE_VAL;
  for (const std::uint32_t t : there) {
    for (const std::uint32_t n : covered_by_[t]) {
      const Vec3 q = nearest_point(p, given_[pieces_[n].given]);
      const double d = squared_norm(subtract(p, q));
      if (d >= least) continue;
      least = d;
      best = q;
    }
  }
  return best;
}

bool Envelope::is_covered_by_given(const Simplex& simplex) {
  constexpr std::size_t kMany = 24;
  const bool many = affected_.size() > kMany;
  coverage_.clear(many);
  const auto add = [&](std::uint32_t g) {
    if (given_[g].label == simplex.label) coverage_.add(g, given_[g]);
    return true;
  };
  if (!many) {
    for (const std::uint32_t n : affected_) add(pieces_[n].given);
  }
  return coverage_.covers(simplex, affected_.size(), [&](const Vec3& p) {
    given_boxes_.query(grown({p, p}), add);
  });
}

bool Envelope::still_covers(const Piece& piece, std::span<const std::uint32_t> removed,
                            std::span<const Simplex> added) {
  coverage_.clear();
  const Simplex& simplex = piece.simplex;
  const auto add = [&](std::uint32_t t, const Simplex& there) {
    if (there.label == simplex.label) coverage_.add(t, there);
  };
  const auto stays = [&](std::uint32_t t) {
    return std::ranges::find(removed, t) == removed.end();
  };
  for (std::uint32_t i = 0; i < added.size(); ++i) {
    add(static_cast<std::uint32_t>(there_.size()) + i, added[i]);
  }
  for (const std::uint32_t t : piece.cover) {
    if (stays(t)) add(t, there_[t]);
  }
  return coverage_.covers(simplex, added.size() + piece.cover.size(), [&](const Vec3& p) {
    there_boxes_.query(grown({p, p}), [&](std::uint32_t t) {
      if (stays(t)) add(t, there_[t]);
      return true;
    });
  });
}

bool Envelope::allows(std::span<const std::uint32_t> removed, std::span<const Simplex> added) {
  affected_.clear();
  for (const std::uint32_t t : removed) {
    affected_.insert(affected_.end(), covered_by_[t].begin(), covered_by_[t].end());
  }
  std::ranges::sort(affected_);
  affected_.erase(std::unique(affected_.begin(), affected_.end()), affected_.end());
  new_cover_.clear();
  for (const std::uint32_t n : affected_) {
    const bool covered = still_covers(pieces_[n], removed, added);
    if (!covered && counts_[pieces_[n].given] != 0) return false;
    new_cover_.push_back(covered ? coverage_.used() : std::vector<std::uint32_t>());
  }
  return std::ranges::all_of(added, [&](const Simplex& s) { return is_covered_by_given(s); });
}

void Envelope::commit(std::span<const std::uint32_t> removed, std::span<const Simplex> added) {
  for (const std::uint32_t t : removed) {
    there_boxes_.remove(t);
    covered_by_[t].clear();
  }
  for (const Simplex& simplex : added) {
    there_boxes_.add(static_cast<std::uint32_t>(there_.size()), simplex.box);
    there_.push_back(simplex);
    covered_by_.emplace_back();
  }
  for (std::size_t i = 0; i < affected_.size(); ++i) {
    set_cover(affected_[i], std::move(new_cover_[i]));
    split(affected_[i]);
  }
}

void Envelope::set_cover(std::uint32_t piece, std::vector<std::uint32_t> cover) {
  for (const std::uint32_t t : pieces_[piece].cover) std::erase(covered_by_[t], piece);
  pieces_[piece].cover = std::move(cover);
  for (const std::uint32_t t : pieces_[piece].cover) covered_by_[t].push_back(piece);
}

// In the middles of its sides, if many cover it. It is covered as before, so its parts are, if not
// for roundings.
void Envelope::split(std::uint32_t piece) {
  const std::vector<std::uint32_t> cover = pieces_[piece].cover;
  if (cover.size() <= kMostCovers) return;
  const Simplex whole = pieces_[piece].simplex;
  const auto& [a, b, c] = whole.corner;
  const auto middle = [](const Vec3& p, const Vec3& q) {
    return add_scaled(p, 0.5, subtract(q, p));
  };
  std::vector<Simplex> parts;
  if (whole.is_segment) {
    parts = {Simplex(a, middle(a, b)), Simplex(middle(a, b), b)};
  } else {
    const Vec3 ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    for (const std::array<Vec3, 3>& part :
         {std::array<Vec3, 3>{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}}) {
      parts.emplace_back(part, whole.label);
    }
  }
  std::vector<std::vector<std::uint32_t>> covers;
  for (const Simplex& part : parts) {
    coverage_.clear();
    for (const std::uint32_t t : cover) coverage_.add(t, there_[t]);
    if (!coverage_.covers(part, cover.size(), [](const Vec3&) {})) return;
    covers.push_back(coverage_.used());
  }
  const std::uint32_t given = pieces_[piece].given;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const auto part = i == 0 ? piece : static_cast<std::uint32_t>(pieces_.size());
    if (i != 0) pieces_.push_back({parts[i], given, {}});
    pieces_[part].simplex = parts[i];
    set_cover(part, std::move(covers[i]));
  }
}

}  // namespace delmesher::remesh
