#include "mesher/output/local_operations.h"

#include <algorithm>

#include "mesher/base/sort_unique.h"

namespace delmesher::output {
namespace {

// Longest ring of an edge that is considered for removal.
constexpr std::size_t kLongestRing = 9;

// Vertices of the face opposite vertex i, such that (face, vertex i) is an even permutation.
constexpr int kInward[4][3] = {{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}};

int index_of(const Tet& t, std::uint32_t v) {
  return static_cast<int>(std::find(t.begin(), t.end(), v) - t.begin());
}

bool has(const Tet& t, std::uint32_t v) {
  return index_of(t, v) < 4;
}

// The two vertices of t other than i and j, such that (i, j, x, y) is an even permutation.
std::array<std::uint32_t, 2> opposite_edge(const Tet& t, int i, int j) {
  const int* face = kInward[i];  // (i, face) is odd
  const int k = static_cast<int>(std::find(face, face + 3, j) - face);
  return {t[face[(k + 2) % 3]], t[face[(k + 1) % 3]]};
}

}  // namespace

bool LocalOperations::fix(std::uint32_t t, bool exact_too) {
  exact_too_ = exact_too;
  for (int i = 0; i < 4; ++i) {
    for (int j = i + 1; j < 4; ++j) {
      if (remove_edge(t, i, j)) return true;
    }
  }
  for (int i = 0; i < 4; ++i) {
    if (remove_face(t, i)) return true;
  }
  for (int i = 0; i < 4; ++i) {
    if (collapse(mesh_.tet(t)[i])) return true;
  }
  return false;
}

bool LocalOperations::positive(const Tet& t) {
  if (mesh_.sign_of(t) <= 0) return false;
  return !exact_too_ || exact_.orient3d(mesh_.store_id(t[0]), mesh_.store_id(t[1]),
                                        mesh_.store_id(t[2]), mesh_.store_id(t[3])) > 0;
}

bool LocalOperations::replace() {
  Change change{removed_, {}, {}};
  for (const Tet& t : created_) change.created.push_back({t, mesh_.region(removed_[0])});
  return mesh_.accept(change);
}

bool LocalOperations::is_boundary(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
  for (const std::uint32_t t : mesh_.star(a)) {
    if (!has(mesh_.tet(t), b) || !has(mesh_.tet(t), c)) continue;
    for (int i = 0; i < 4; ++i) {
      const std::uint32_t v = mesh_.tet(t)[i];
      if (v != a && v != b && v != c) return mesh_.topology().facet(t, i) != kNone;
    }
  }
  return false;
}

// Collects the tetrahedra around the edge in removed_, and the vertices around it in ring_, so that
// (v_i, v_j, ring_[k], ring_[k + 1]) is one of them. False if the edge is on the boundary.
bool LocalOperations::find_ring(std::uint32_t t, int i, int j) {
  const std::uint32_t a = mesh_.tet(t)[i], b = mesh_.tet(t)[j];
  removed_.clear();
  ring_.clear();
  std::vector<std::array<std::uint32_t, 2>> steps;
  for (const std::uint32_t r : mesh_.star(a)) {
    const int k = index_of(mesh_.tet(r), b);
    if (k == 4) continue;
    removed_.push_back(r);
    steps.push_back(opposite_edge(mesh_.tet(r), index_of(mesh_.tet(r), a), k));
  }
  if (removed_.size() < 3 || removed_.size() > kLongestRing) return false;
  ring_.push_back(steps[0][0]);
  while (true) {
    const auto next = std::find_if(steps.begin(), steps.end(),
                                   [&](const auto& s) { return s[0] == ring_.back(); });
    if (next == steps.end() || is_boundary(a, b, ring_.back())) return false;
    if ((*next)[1] == ring_[0]) break;
    ring_.push_back((*next)[1]);
    if (ring_.size() > steps.size()) return false;
  }
  return ring_.size() == steps.size();
}

// Fills created_ with two tetrahedra, towards a and b, for each triangle of a triangulation of the
// ring, all positive. False if there is none. (Klincsek's dynamic program.)
bool LocalOperations::triangulate_ring(std::uint32_t a, std::uint32_t b) {
  const std::size_t n = ring_.size();
  std::size_t middle[kLongestRing][kLongestRing] = {};  // 0: cannot be triangulated
  const auto possible = [&](std::size_t i, std::size_t j) { return j == i + 1 || middle[i][j]; };
  for (std::size_t width = 2; width < n; ++width) {
    for (std::size_t i = 0; i + width < n; ++i) {
      const std::size_t j = i + width;
      for (std::size_t k = i + 1; k < j && middle[i][j] == 0; ++k) {
        if (possible(i, k) && possible(k, j) && positive({ring_[i], ring_[k], ring_[j], b}) &&
            positive({ring_[k], ring_[i], ring_[j], a})) {
          middle[i][j] = k;
        }
      }
    }
  }
  if (middle[0][n - 1] == 0) return false;
  created_.clear();
  std::vector<std::array<std::size_t, 2>> open{{0, n - 1}};
  while (!open.empty()) {
    const auto [i, j] = open.back();
    open.pop_back();
    if (j == i + 1) continue;
    const std::size_t k = middle[i][j];
    created_.push_back({ring_[i], ring_[k], ring_[j], b});
    created_.push_back({ring_[k], ring_[i], ring_[j], a});
    open.push_back({i, k});
    open.push_back({k, j});
  }
  return true;
}

bool LocalOperations::remove_edge(std::uint32_t t, int i, int j) {
  const std::uint32_t a = mesh_.tet(t)[i], b = mesh_.tet(t)[j];
  return find_ring(t, i, j) && triangulate_ring(a, b) && replace();
}

bool LocalOperations::remove_face(std::uint32_t t, int i) {
  const Tet& q = mesh_.tet(t);
  const std::uint32_t a = q[kInward[i][0]], b = q[kInward[i][1]], c = q[kInward[i][2]], d = q[i];
  if (is_boundary(a, b, c)) return false;
  for (const std::uint32_t u : mesh_.star(a)) {
    const Tet& r = mesh_.tet(u);
    if (u == t || !has(r, b) || !has(r, c)) continue;
    std::uint32_t e = kNone;
    for (const std::uint32_t v : r) {
      if (v != a && v != b && v != c) e = v;
    }
    removed_ = {t, u};
    created_ = {{a, b, e, d}, {b, c, e, d}, {c, a, e, d}};
    const auto ok = [&](const Tet& created) { return positive(created); };
    return std::all_of(created_.begin(), created_.end(), ok) && replace();
  }
  return false;
}

bool LocalOperations::collapse(std::uint32_t v) {
  if (mesh_.fixed(v) || mesh_.on_surface(v) || !mesh_.is_enclosed(v)) return false;
  std::vector<std::uint32_t> link;
  for (const std::uint32_t t : mesh_.star(v)) {
    for (const std::uint32_t w : mesh_.tet(t)) {
      if (w != v) link.push_back(w);
    }
  }
  sort_unique(link);
  return std::any_of(link.begin(), link.end(), [&](std::uint32_t w) { return collapse_to(v, w); });
}

// A cone from w over the link of v: a sphere, so positive tetrahedra fill exactly the space of the
// star.
bool LocalOperations::collapse_to(std::uint32_t v, std::uint32_t w) {
  const auto star = mesh_.star(v);
  removed_.assign(star.begin(), star.end());
  created_.clear();
  for (const std::uint32_t t : removed_) {
    if (has(mesh_.tet(t), w)) continue;
    Tet moved = mesh_.tet(t);
    moved[index_of(moved, v)] = w;
    if (!positive(moved)) return false;
    created_.push_back(moved);
  }
  return replace();
}

}  // namespace delmesher::output
