#include "corpus/generators/shrink.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "corpus/generators/certify.h"
#include "corpus/generators/edits.h"
#include "corpus/generators/random.h"
#include "corpus/generators/shapes.h"

namespace tetproof {
namespace {

using delmesher::Surface;
using shapes::Point;

// Parts of the triangles that are connected by vertices.
std::vector<std::vector<std::size_t>> components(const Surface& s) {
  std::vector<std::uint32_t> root(s.vertices.size());
  std::iota(root.begin(), root.end(), 0U);
  const auto find = [&](std::uint32_t v) {
    while (root[v] != v) v = root[v] = root[root[v]];
    return v;
  };
  for (const auto& [a, b, c] : s.triangles) {
    root[find(a)] = find(b);
    root[find(b)] = find(c);
  }
  std::map<std::uint32_t, std::vector<std::size_t>> parts;
  for (std::size_t t = 0; t < s.triangles.size(); ++t) parts[find(s.triangles[t][0])].push_back(t);
  std::vector<std::vector<std::size_t>> result;
  for (auto& [v, part] : parts) result.push_back(std::move(part));
  return result;
}

// Leaves out vertices without triangles and merges those of equal coordinates. The others keep
// their order, because some meshers fail with one numbering alone.
Surface in_order_welded(const Surface& s) {
  std::vector<bool> used(s.vertices.size(), false);
  for (const auto& t : s.triangles) {
    for (const std::uint32_t v : t) used[v] = true;
  }
  Surface result;
  std::map<Point, std::uint32_t> ids;
  std::vector<std::uint32_t> number(s.vertices.size());
  for (std::uint32_t v = 0; v < s.vertices.size(); ++v) {
    if (!used[v]) continue;
    const auto fresh = static_cast<std::uint32_t>(result.vertices.size());
    const auto [at, added] = ids.emplace(s.vertices[v], fresh);
    if (added) result.vertices.push_back(s.vertices[v]);
    number[v] = at->second;
  }
  for (const auto& [a, b, c] : s.triangles) {
    result.triangles.push_back({number[a], number[b], number[c]});
  }
  return result;
}

struct Range {
  Point low, high;
  double size() const { return std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]}); }
};

Range range_of(const Surface& s) {
  Range r{s.vertices[0], s.vertices[0]};
  for (const Point& p : s.vertices) {
    for (std::size_t i = 0; i < 3; ++i) {
      r.low[i] = std::min(r.low[i], p[i]);
      r.high[i] = std::max(r.high[i], p[i]);
    }
  }
  return r;
}

// The edge from a to b becomes b.
void collapse(Surface& s, std::uint32_t a, std::uint32_t b) {
  for (auto& t : s.triangles) {
    for (auto& v : t) {
      if (v == a) v = b;
    }
  }
  std::erase_if(s.triangles,
                [](const auto& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
}

std::size_t digits(const Surface& s) {
  std::size_t bits = 0;
  for (const Point& p : s.vertices) {
    for (const double x : p) {
      int exponent = 0;
      double mantissa = std::frexp(std::fabs(x), &exponent);
      for (; mantissa != 0; mantissa = mantissa * 2 - std::floor(mantissa * 2)) ++bits;
    }
  }
  return bits;
}

class Shrinker {
 public:
  Shrinker(const Surface& surface, const OneThatFails& fails, const ShrinkLimits& limits,
           ShrinkProgress& progress)
      : best_(surface), fails_(fails), limits_(limits), progress_(progress) {}

  Surface run() {
    if (in_order_welded(best_).vertices.size() < best_.vertices.size()) accept(best_);
    // Single collapses are many runs, and wait until nothing else helps.
    for (bool better = true; better && !spent();) {
      better = false;
      better |= step("components", [&] { return remove_components(); });
      better |= step("cuts", [&] { return cut_away(); });
      better |= step("collapses", [&] { return collapse_edges(false); });
      if (!better) better = step("collapses", [&] { return collapse_edges(true); });
    }
    // Coordinates come last, as a collapse keeps them simple; a collapse may become possible again.
    for (bool better = true; better && !spent();) {
      better = step("coordinates", [&] { return simplify_coordinates(); });
      step("collapses", [&] { return collapse_edges(true); });
    }
    return best_;
  }

 private:
  using Clock = std::chrono::steady_clock;

  bool spent() const {
    const std::chrono::duration<double> taken = Clock::now() - start_;
    return limits_.stop() || progress_.runs >= limits_.runs || taken.count() > limits_.seconds;
  }

  template <class Body>
  bool step(const char* name, Body&& body) {
    if (spent() || !body()) return false;
    if (progress_.tell) progress_.tell(name, best_);
    return true;
  }

  // Keeps the first of the surfaces that is known to fail, of those that are valid. Takes them in
  // their order, as many at once as are judged together.
  bool accept(const std::vector<Surface>& candidates) {
    std::vector<Surface> together;
    for (std::size_t i = 0; i < candidates.size() && !spent(); ++i) {
      if (auto valid = valid_form(candidates[i])) together.push_back(std::move(*valid));
      if (together.size() < limits_.at_once && i + 1 < candidates.size()) continue;
      if (take_first_failing(together)) return true;
      together.clear();
    }
    return false;
  }
  // Welded; nothing unless that certainly is valid.
  static std::optional<Surface> valid_form(const Surface& candidate) {
    Surface welded = in_order_welded(candidate);
    if (welded.triangles.empty() || !certified_valid(welded)) return std::nullopt;
    return welded;
  }
  // Takes the first failing one of these valid surfaces, which are judged together.
  bool take_first_failing(std::vector<Surface>& valid) {
    if (valid.empty()) return false;
    progress_.runs += valid.size();
    const auto one = fails_(valid);
    if (one) best_ = std::move(valid[*one]);
    return one.has_value();
  }
  bool accept(const Surface& candidate) { return accept(std::vector<Surface>{candidate}); }

  // Halves of the components first, then single ones.
  bool remove_components() {
    bool better = false;
    for (std::size_t share = 2;; share *= 2) {
      auto parts = components(best_);
      if (parts.size() < 2) return better;
      const std::size_t group = std::max<std::size_t>(1, parts.size() / share);
      for (std::size_t first = 0; first < parts.size();) {
        Surface rest = best_;
        rest.triangles.clear();
        for (std::size_t i = 0; i < parts.size(); ++i) {
          if (i >= first && i < first + group) continue;
          for (const std::size_t t : parts[i]) rest.triangles.push_back(best_.triangles[t]);
        }
        if (accept(rest)) {
          better = true;
          parts = components(best_);
        } else {
          first += group;
        }
      }
      if (group == 1) return better;
    }
  }

  // The largest cuts first; after one that failed too, the same share of what is left.
  bool cut_away() {
    bool better = false;
    for (const double share : {0.5, 0.25, 0.125, 1.0 / 32}) {
      while (!spent() && accept(cuts(share))) better = true;
    }
    return better;
  }

  // What is left after about this share of the extent is removed at either end of an axis, the
  // smallest first.
  std::vector<Surface> cuts(double share) const {
    std::vector<Surface> left;
    for (const std::size_t axis : {0U, 1U, 2U}) {
      for (const bool upper : {false, true}) {
        Surface part = cut_once(axis, upper, share);
        if (part.triangles.size() < best_.triangles.size()) left.push_back(std::move(part));
      }
    }
    std::stable_sort(left.begin(), left.end(), [](const Surface& a, const Surface& b) {
      return a.triangles.size() < b.triangles.size();
    });
    return left;
  }

  Surface cut_once(std::size_t axis, bool upper, double share) const {
    const Range r = range_of(best_);
    const double width = (r.high[axis] - r.low[axis]) * share;
    if (upper) return cut(best_, static_cast<int>(axis), r.high[axis] - width);
    Surface mirrored = best_;
    mirror(mirrored, axis);
    Surface part = cut(mirrored, static_cast<int>(axis), -(r.low[axis] + width));
    mirror(part, axis);
    return part;
  }
  static void mirror(Surface& s, std::size_t axis) {
    for (Point& p : s.vertices) p[axis] = -p[axis];
    shapes::reverse(s);
  }

  // Collapses many edges at once, then fewer; down to one by one if `single`, else to groups.
  bool collapse_edges(bool single) {
    constexpr std::size_t kMisses = 6;  // in a row, of candidates judged together
    bool better = false;
    for (std::size_t batch = std::max<std::size_t>(1, best_.triangles.size() / 8);; batch /= 2) {
      if (batch == 1) return (single && collapse_one_by_one()) || better;
      for (std::size_t misses = 0; misses < kMisses && !spent();) {
        std::vector<Surface> groups = some_collapses(batch);
        if (!spent() && take_first_failing(groups)) {
          better = true;
          misses = 0;
        } else {
          ++misses;
        }
      }
      if (spent()) return better;
    }
  }
  bool collapse_one_by_one() {
    bool better = false;
    for (std::size_t i = 0; i < 2 * best_.triangles.size() && !spent();) {
      std::vector<Surface> candidates;
      for (std::size_t n = 0; n < limits_.at_once; ++n) candidates.push_back(edge_collapsed(i++));
      if (accept(candidates)) better = true;
    }
    return better;
  }
  // As many different groups as are judged together, in their valid form.
  std::vector<Surface> some_collapses(std::size_t count) {
    constexpr int kTries = 24;
    std::vector<Surface> groups;
    for (int i = 0; i < kTries && groups.size() < limits_.at_once; ++i) {
      Surface s = collapse_some(count);
      if (s.triangles.size() >= best_.triangles.size()) continue;
      if (auto valid = valid_form(s)) groups.push_back(std::move(*valid));
    }
    return groups;
  }
  Surface collapse_some(std::size_t count) {
    Surface s = best_;
    std::vector<bool> touched(s.vertices.size(), false);
    for (std::size_t i = 0; i < count && s.triangles.size() > 4; ++i) {
      const auto& t = s.triangles[random_.below(s.triangles.size())];
      const auto k = random_.below(3);
      const auto a = t[k], b = t[(k + 1) % 3];
      if (touched[a] || touched[b]) continue;
      for (const auto& u : best_.triangles) {  // neighbours stay for this round
        if (u[0] == a || u[1] == a || u[2] == a)
          touched[u[0]] = touched[u[1]] = touched[u[2]] = true;
      }
      Surface next = s;
      collapse(next, a, b);
      s = std::move(next);
    }
    return s;
  }
  Surface edge_collapsed(std::size_t i) {
    const auto& t = best_.triangles[(i / 2) % best_.triangles.size()];
    const std::size_t k = random_.below(3);
    const auto a = t[k], b = t[(k + 1) % 3];
    Surface s = best_;
    collapse(s, i % 2 == 0 ? a : b, i % 2 == 0 ? b : a);
    return s;
  }

  // Fewer bits for all coordinates, then for single ones.
  bool simplify_coordinates() {
    bool better = simplify_all();
    for (std::size_t v = 0; v < best_.vertices.size(); ++v) {
      for (std::size_t i = 0; i < 3 && !spent(); ++i) better |= simplify_one(v, i);
    }
    return better;
  }
  bool accept_if_simpler(const Surface& s) { return digits(s) < digits(best_) && accept(s); }

  bool simplify_all() {
    const Range r = range_of(best_);
    Surface moved = best_;
    shapes::move(moved, [&](const Point& p) {
      return Point{p[0] - r.low[0], p[1] - r.low[1], p[2] - r.low[2]};
    });
    bool better = accept_if_simpler(moved);
    // As integers of few bits, and at the original size, because failures may depend on the scale.
    int exponent = 0;
    std::frexp(range_of(best_).size(), &exponent);
    for (int bits = 4; bits <= 40; bits += bits < 16 ? 1 : 4) {
      for (const bool integers : {true, false}) {
        Surface coarse = best_;
        shapes::move(coarse, [&](const Point& p) {
          Point q;
          for (std::size_t i = 0; i < 3; ++i) {
            q[i] = std::nearbyint(std::ldexp(p[i], bits - exponent)) + 0.0;
            if (!integers) q[i] = std::ldexp(q[i], exponent - bits);
          }
          return q;
        });
        if (accept_if_simpler(coarse)) return true;
      }
    }
    return better;
  }
  bool simplify_one(std::size_t v, std::size_t i) {
    const double x = best_.vertices[v][i];
    if (x == 0) return false;
    int exponent = 0;
    std::frexp(range_of(best_).size(), &exponent);
    for (int bits = 0; bits <= 24; bits += bits < 8 ? 1 : 4) {
      const double step = std::ldexp(1, exponent - bits);
      const double simple = std::nearbyint(x / step) * step + 0.0;
      if (simple == x) return false;
      Surface s = best_;
      s.vertices[v][i] = simple;
      if (accept_if_simpler(s)) return true;
    }
    return false;
  }

  Surface best_;
  const OneThatFails& fails_;
  const ShrinkLimits& limits_;
  ShrinkProgress& progress_;
  Random random_{1};
  Clock::time_point start_ = Clock::now();
};

}  // namespace

Surface shrink(const Surface& surface, const OneThatFails& fails, const ShrinkLimits& limits,
               ShrinkProgress& progress) {
  return Shrinker(surface, fails, limits, progress).run();
}

}  // namespace tetproof
