#include "mesher/remesh/envelope.h"

#include <algorithm>

namespace delmesher::remesh {
namespace {

std::vector<Box> boxes_of(const std::vector<Simplex>& simplices) {
  std::vector<Box> boxes;
  boxes.reserve(simplices.size());
  for (const Simplex& simplex : simplices) boxes.push_back(simplex.box);
  return boxes;
}

}  // namespace

Envelope::Envelope(std::vector<Simplex> given, double distance)
    : distance_(distance),
      given_(std::move(given)),
      there_(given_),
      given_boxes_(boxes_of(given_)),
      there_boxes_(boxes_of(given_)),
      coverage_(distance) {
  for (std::uint32_t i = 0; i < given_.size(); ++i) {
    cover_.push_back({i});
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
    return std::ranges::any_of(
        covered_by_[t], [&](std::uint32_t g) { return squared_distance(p, given_[g]) < least; });
  });
}

Vec3 Envelope::nearest_given(const Vec3& p, std::span<const std::uint32_t> there) const {
  Vec3 best = p;
  double least = HUGE_VAL;
  for (const std::uint32_t t : there) {
    for (const std::uint32_t g : covered_by_[t]) {
      const Vec3 q = nearest_point(p, given_[g]);
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
  if (!many) std::ranges::for_each(affected_, add);
  return coverage_.covers(simplex, affected_.size(), [&](const Vec3& p) {
    given_boxes_.query(grown({p, p}), add);
  });
}

bool Envelope::still_covers(std::uint32_t given, std::span<const std::uint32_t> removed,
                            std::span<const Simplex> added) {
  coverage_.clear();
  const Simplex& simplex = given_[given];
  const auto add = [&](std::uint32_t t, const Simplex& there) {
    if (there.label == simplex.label) coverage_.add(t, there);
  };
  const auto stays = [&](std::uint32_t t) {
    return std::ranges::find(removed, t) == removed.end();
  };
  for (std::uint32_t i = 0; i < added.size(); ++i) {
    add(static_cast<std::uint32_t>(there_.size()) + i, added[i]);
  }
  for (const std::uint32_t t : cover_[given]) {
    if (stays(t)) add(t, there_[t]);
  }
  return coverage_.covers(simplex, added.size() + cover_[given].size(), [&](const Vec3& p) {
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
  for (const std::uint32_t g : affected_) {
    if (!still_covers(g, removed, added)) return false;
    new_cover_.push_back(coverage_.used());
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
    const std::uint32_t g = affected_[i];
    for (const std::uint32_t t : cover_[g]) std::erase(covered_by_[t], g);
    cover_[g] = new_cover_[i];
    for (const std::uint32_t t : cover_[g]) covered_by_[t].push_back(g);
  }
}

}  // namespace delmesher::remesh
