#include "corpus/union/walls.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <utility>

#include "corpus/union/arrangement.h"
#include "corpus/union/snapping.h"
#include "corpus/union/union_run.h"
#include "oracles/surface/surface_validity.h"

namespace tetproof::unite {
namespace {

using delmesher::Surface;

// Has it the bits of a float, or is it text of as few digits?
bool is_single(double x) {
  int exponent = 0;
  const double bits = std::ldexp(std::frexp(x, &exponent), 24);
  if (bits == std::trunc(bits)) return true;
  char text[32];
  std::snprintf(text, sizeof text, "%.8g", x);
  return std::strtod(text, nullptr) == x;
}

bool is_single(const Surface& surface) {
  return std::ranges::all_of(surface.vertices, [](const Position& p) {
    return std::ranges::all_of(p, [](double x) { return is_single(x); });
  });
}

class Walls : UnionRun {
 public:
  Walls(double snap, const std::function<bool()>& go_on) : UnionRun(go_on), snap_(snap) {}
  UnionResult run(const Surface& surface);
  double given_reach() const { return std::ldexp(reach(), unit_); }

 private:
  static constexpr int kRounds = 12;
  using Labels = std::vector<std::int32_t>;  // ascending, without repetition

  bool take(const Surface& surface);
  double reach() const;
  std::int32_t name_of(Labels labels);
  std::int32_t labels_of(const Piece& piece);
  const Labels& named(std::int32_t name) const { return named_[static_cast<std::size_t>(name)]; }
  bool snap_together();
  void cut(const std::vector<MeetingPair>& pairs);
  bool cut_all();
  Surface with_all_labels() const;
  void judge();

  double snap_;
  bool single_ = false;
  std::vector<Labels> named_;  // by the labels of the soup
  std::map<Labels, std::int32_t> names_;
};

bool Walls::take(const Surface& surface) {
  if (!take_soup(surface)) return false;
  single_ = is_single(surface);
  for (std::int32_t& label : soup_.labels) label = name_of({label});
  if (soup_.triangles.empty()) return fail(UnionCode::empty, "there is no triangle");
  if (snap_ < 0) {
    snap_ *= -diagonal(soup_);
  } else if (snap_ > 0) {
    // Beyond these nothing changes.
    snap_ = std::clamp(std::ldexp(snap_, -unit_), 0x1p-200, 0x1p200);
  }
  return true;
}

double Walls::reach() const {
  const int exponent = std::ilogb(largest_coordinate(soup_));
  const double of_doubles = std::ldexp(1, exponent - 50 + 2 * result_.counts.rounds);
  const double of_input = snap_ > 0 ? snap_ : single_ ? std::ldexp(1, exponent - 22) : 0;
  return std::max(of_input, of_doubles);
}

std::int32_t Walls::name_of(Labels labels) {
  std::ranges::sort(labels);
  labels.erase(std::unique(labels.begin(), labels.end()), labels.end());
  const auto [at, is_new] = names_.try_emplace(labels, static_cast<std::int32_t>(named_.size()));
  if (is_new) named_.push_back(std::move(labels));
  return at->second;
}

std::int32_t Walls::labels_of(const Piece& piece) {
  if (piece.parents.size() == 1) return soup_.labels[piece.parent];
  Labels all;
  for (const Index parent : piece.parents) {
    const Labels& labels = named(soup_.labels[parent]);
    all.insert(all.end(), labels.begin(), labels.end());
  }
  return name_of(std::move(all));
}

bool Walls::snap_together() {
  // What is just not near enough may be in the way.
  constexpr int kTries = 4;
  constexpr double kLonger = 1.5;
  double reach = this->reach();
  Snapped snapped = snap(soup_, reach, poll_);
  for (int n = 1; n < kTries && !snapped.done; ++n) {
    reach *= kLonger;
    snapped = snap(soup_, reach, poll_);
  }
  if (!snapped.done) {
    return fail(UnionCode::imprecise, "what is within " + length(reach) +
                                          " of each other does not become one near " +
                                          place(snapped.vertices[snapped.place]));
  }
  result_.counts.largest_move += snapped.moved;
  Surface surface;
  surface.vertices = snapped.vertices;
  for (const Piece& piece : snapped.pieces) {
    surface.triangles.push_back(piece.corners);
    surface.labels.push_back(labels_of(piece));
    result_.counts.cut += piece.cut ? 1 : 0;
  }
  Soup together = soup_of(surface);
  if (together.triangles.empty()) {
    return fail(UnionCode::imprecise, "all is within " + length(reach) + " of each other");
  }
  soup_ = std::move(together);
  return true;
}

void Walls::cut(const std::vector<MeetingPair>& pairs) {
  UnionCounts& counts = result_.counts;
  const Arrangement arrangement = arrange(soup_, pairs, Cancelled::kept, poll_);
  if (counts.rounds++ == 0) counts.pairs = pairs.size();
  const auto labels = [&](const Piece& piece) { return labels_of(piece); };
  soup_ =
      soup_of(rounded(arrangement.points, arrangement.pieces, labels, counts.largest_move, poll_));
}

bool Walls::cut_all() {
  while (true) {
    if (!snap_together()) return false;
    const std::vector<MeetingPair> pairs = meeting_pairs(soup_, poll_);
    if (pairs.empty()) return true;
    if (result_.counts.rounds == kRounds) {
      return fail(UnionCode::imprecise,
                  counted(pairs.size(), "pair", "pairs") +
                      " of triangles are too close for doubles, the first at " +
                      place(soup_.vertices[soup_.triangles[pairs.front().a][0]]));
    }
    cut(pairs);
  }
}

Surface Walls::with_all_labels() const {
  Surface surface;
  surface.vertices = soup_.vertices;
  for (std::size_t t = 0; t < soup_.triangles.size(); ++t) {
    for (const std::int32_t label : named(soup_.labels[t])) {
      surface.triangles.push_back(soup_.triangles[t]);
      surface.labels.push_back(label);
    }
  }
  return surface;
}

void Walls::judge() {
  const UnionCounts& counts = result_.counts;
  result_.surface = with_all_labels();
  result_.done.push_back(counted(soup_.triangles.size(), "triangle", "triangles") + ", " +
                         std::to_string(result_.surface.triangles.size() - soup_.triangles.size()) +
                         " times repeated for a further label");
  if (counts.largest_move > 0) {
    result_.done.push_back("the surface moved by at most " + length(counts.largest_move) +
                           ", where parts lay on each other but for roundings, or were cut");
  }
  const oracles::OracleReport valid =
      oracles::check_complex_validity({soup_.vertices, soup_.triangles, soup_.labels, {}});
  if (!valid.passed()) throw InternalError("the complex is not valid: " + valid.findings.front());
}

UnionResult Walls::run(const Surface& surface) {
  return result_of([&] {
    if (take(surface) && cut_all()) judge();
  });
}

// Which reach does what `reach` does not? Longer ones before shorter ones, which may leave slivers.
void advise(const Surface& surface, double reach, const std::function<bool()>& go_on,
            UnionResult& result) {
  for (const int exponent : {2, -2, 4, -4, 6}) {
    const std::string length = number(std::ldexp(reach, exponent));
    const UnionResult other = Walls(std::strtod(length.c_str(), nullptr), go_on).run(surface);
    if (other.code == UnionCode::stopped) {
      result = other;
      return;
    }
    if (other.code != UnionCode::done) continue;
    result.message += "; `--snap " + length + "` does it, and moves the surface by at most " +
                      number(other.counts.largest_move);
    return;
  }
  result.message += "; none of five other lengths does it: move a body, or leave it out";
}

}  // namespace

UnionResult cut_into_walls(const Surface& surface, double snap,
                           const std::function<bool()>& go_on) {
  Walls walls(snap, go_on);
  UnionResult result = walls.run(surface);
  if (result.code == UnionCode::imprecise) advise(surface, walls.given_reach(), go_on, result);
  return result;
}

}  // namespace tetproof::unite
