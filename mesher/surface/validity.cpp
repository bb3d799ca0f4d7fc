#include "mesher/surface/validity.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <concepts>
#include <numeric>
#include <optional>

#include "mesher/base/disjoint_sets.h"
#include "mesher/base/parallel.h"
#include "mesher/geometry/box_tree.h"
#include "mesher/geometry/vector.h"
#include "mesher/predicates/predicates.h"
#include "mesher/surface/half_edges.h"
#include "mesher/surface/nesting.h"
#include "mesher/surface/triangle_contact.h"

namespace delmesher::surface {
namespace {

constexpr std::uint64_t kListed = 10;  // defects of each kind that are described

std::string text(double x) {
  std::array<char, 32> buffer;
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), x).ptr;
  return {buffer.data(), end};
}

std::string text(const Vec3& p) {
  std::string result = "(";
  result += text(p[0]) + ", ";
  result += text(p[1]) + ", ";
  result += text(p[2]) + ")";
  return result;
}

std::string text(std::integral auto n) {
  return std::to_string(n);
}

// "3, 5 and 7"; long lists are cut.
std::string list(const std::vector<std::uint32_t>& ids) {
  constexpr std::size_t kMost = 6;
  std::string result;
  for (std::size_t i = 0; i < std::min(ids.size(), kMost); ++i) {
    if (i > 0) result += i + 1 == ids.size() ? " and " : ", ";
    result += text(std::uint64_t{ids[i]});
  }
  if (ids.size() > kMost) result += " and " + text(ids.size() - kMost) + " more";
  return result;
}

double diagonal(const Box& box) {
  Vec3 d;
  int exponent = 0;
  for (std::size_t i = 0; i < 3; ++i) d[i] = box.hi[i] * 0.5 - box.lo[i] * 0.5;
  std::frexp(largest_component(d), &exponent);
  return std::ldexp(norm(times_power_of_two(d, -exponent)), exponent + 1);
}

class Checker {
 public:
  Checker(const Surface& surface, bool stop_at_first, Control& control, std::uint64_t most_places,
          Rules rules)
      : surface_(surface),
        triangles_(surface.triangles),
        stop_at_first_(stop_at_first),
        most_places_(most_places),
        rules_(rules),
        control_(control),
        predicates_(points_) {}

  ValidityResult run() {
    if (!surface_.labels.empty() && surface_.labels.size() != triangles_.size()) {
      result_.report.vertices = surface_.vertices.size();
      result_.report.triangles = triangles_.size();
      result_.report.status = {StatusCode::invalid_surface,
                               text(surface_.labels.size()) + " labels for " +
                                   text(triangles_.size()) +
                                   " triangles: as many are needed, or none"};
      return std::move(result_);
    }
    result_.report.vertices = surface_.vertices.size();
    result_.report.triangles = triangles_.size();
    result_.reverse_triangle.assign(triangles_.size(), 0);
    check_everything();
    conclude();
    return std::move(result_);
  }

 private:
  using Kind = Defect::Kind;

  void check_everything() {
    check_input();
    if (any_defect()) {
      result_.report.warnings.push_back("only coordinates and indices were checked");
      return;
    }
    for (const auto& v : surface_.vertices) points_.add_explicit(v[0], v[1], v[2]);
    check_triangles();
    if (ends()) return;
    check_duplicates();
    if (ends()) return;
    if (rules_ == Rules::solid) {
      check_edges();
      if (ends()) return;
      check_fans();
      if (ends()) return;
    }
    check_intersections();
    if (ends() || rules_ == Rules::complex) return;
    if (any_defect()) {
      result_.report.warnings.push_back("nesting and volume are not known: the surface is invalid");
    } else {
      check_nesting();
    }
  }

  bool any_defect() const { return !result_.report.defects.empty(); }
  bool ends() const { return stop_at_first_ && any_defect(); }

  using Place = std::array<std::uint32_t, 2>;

  std::vector<Place>& places(Kind kind) {
    return result_.report.places[static_cast<std::size_t>(kind)];
  }
  std::uint64_t& count(Kind kind) {
    return result_.report.defect_counts[static_cast<std::size_t>(kind)];
  }

  void add(Kind kind, const Place& place, std::vector<std::uint32_t> vertices,
           std::vector<std::uint32_t> triangles, const std::string& message) {
    if (places(kind).size() < most_places_) places(kind).push_back(place);
    if (count(kind)++ < kListed) {
      result_.report.defects.push_back({kind, std::move(vertices), std::move(triangles), message});
    }
  }

  std::string at(VertexId v) const { return text(surface_.vertices[v]); }

  std::string edge_text(std::uint32_t a, std::uint32_t b) const {
    return text(std::uint64_t{a}) + "-" + text(std::uint64_t{b}) + " from " + at(a) + " to " +
           at(b);
  }

  void check_input() {
    if (triangles_.empty()) {
      ++count(Kind::empty);
      result_.report.defects.push_back({Kind::empty, {}, {}, "the surface has no triangles"});
    }
    for (std::uint32_t v = 0; v < surface_.vertices.size(); ++v) {
      const Vec3& p = surface_.vertices[v];
      if (std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2])) continue;
      add(Kind::non_finite, {v, v}, {v}, {},
          "vertex " + text(std::uint64_t{v}) +
              " has a coordinate that is not a finite number: " + at(v));
    }
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
      for (const std::uint32_t v : triangles_[t]) {
        if (v < surface_.vertices.size()) continue;
        add(Kind::index_out_of_range, {t, t}, {v}, {t},
            "triangle " + text(std::uint64_t{t}) + " refers to vertex " + text(std::uint64_t{v}) +
                ", but there are " + text(surface_.vertices.size()) + " vertices (indices from 0)");
        break;
      }
    }
  }

  // Degenerate triangles; also prepares projections, boxes and counts.
  void check_triangles() {
    std::vector<std::uint8_t> used(surface_.vertices.size(), 0);
    Box box;
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
      control_.poll();
      const auto [a, b, c] = triangles_[t];
      for (const VertexId v : triangles_[t]) used[v] = 1;
      const std::array<Vec3, 3> p{points_.nearest(a), points_.nearest(b), points_.nearest(c)};
      boxes_.push_back(Box::around(p));
      box.extend(boxes_.back());
      if (a == b || b == c || c == a) {
        projections_.push_back({});
        add(Kind::degenerate_triangle, {t, t}, {a, b, c}, {t},
            "triangle " + text(std::uint64_t{t}) + " has vertex " +
                text(std::uint64_t{b == c ? b : a}) + " twice, at " + at(b == c ? b : a));
        continue;
      }
      projections_.push_back(find_projection(predicates_, triangles_[t]));
      if (projections_.back().sign != 0) continue;
      add(Kind::degenerate_triangle, {t, t}, {a, b, c}, {t},
          "triangle " + text(std::uint64_t{t}) + " has no area: its vertices " + list({a, b, c}) +
              " are collinear, at " + at(a) + ", " + at(b) + ", " + at(c));
    }
    used_vertices_ = static_cast<std::uint64_t>(std::count(used.begin(), used.end(), 1));
    result_.report.unused_vertices = surface_.vertices.size() - used_vertices_;
    result_.report.bbox_diagonal = diagonal(box);
  }

  void check_duplicates() {
    std::vector<Corners> sorted = triangles_;
    for (Corners& t : sorted) std::sort(t.begin(), t.end());
    std::vector<std::uint32_t> order(sorted.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
      return sorted[i] != sorted[j] ? sorted[i] < sorted[j] : i < j;
    });
    std::vector<std::array<std::uint32_t, 2>> pairs;
    std::size_t first = 0;
    for (std::size_t i = 1; i < order.size(); ++i) {
      if (sorted[order[i]] != sorted[order[first]]) first = i;
      const Corners& t = sorted[order[i]];
      if (first != i && t[0] != t[1] && t[1] != t[2]) pairs.push_back({order[first], order[i]});
    }
    std::sort(pairs.begin(), pairs.end());
    for (const auto [t, u] : pairs) {
      add(Kind::duplicate_triangle, {t, u}, {sorted[t].begin(), sorted[t].end()}, {t, u},
          "triangles " + list({t, u}) + " have the same vertices " +
              list({triangles_[t].begin(), triangles_[t].end()}));
    }
  }

  void check_edges() {
    edges_.emplace(triangles_, surface_.vertices.size());
    DisjointSets components(triangles_.size());
    for (std::size_t e = 0; e < edges_->size(); ++e) {
      const auto group = (*edges_)[e];
      const std::uint32_t a = from(group[0]), b = to(group[0]);
      std::vector<std::uint32_t> around;
      for (const std::uint32_t h : group) {
        around.push_back(h / 3);
        components.join(h / 3, around[0]);
      }
      if (group.size() == 1) {
        add(Kind::open_edge, {a, b}, {a, b}, around,
            "edge " + edge_text(a, b) + " belongs to triangle " + list(around) + " only");
      } else if (group.size() > 2) {
        add(Kind::non_manifold_edge, {a, b}, {a, b}, around,
            "edge " + edge_text(a, b) + " belongs to " + text(group.size()) +
                " triangles: " + list(around));
      } else if (from(group[1]) == a) {
        add(Kind::inconsistent_orientation, {a, b}, {a, b}, around,
            "triangles " + list(around) + " run along their edge " + edge_text(a, b) +
                " in the same direction");
      }
    }
    number_components(components);
    result_.report.euler_characteristic = static_cast<std::int64_t>(used_vertices_) -
                                          static_cast<std::int64_t>(edges_->size()) +
                                          static_cast<std::int64_t>(triangles_.size());
  }

  void number_components(DisjointSets& sets) {
    component_of_.resize(triangles_.size());
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
      const std::uint32_t root = sets.smallest(t);  // already numbered
      component_of_[t] =
          root == t ? static_cast<std::uint32_t>(result_.report.components++) : component_of_[root];
    }
  }

  // Corners of triangles at one vertex are in one fan if they are linked by edges at that vertex.
  // Triangles with a repeated vertex take no part.
  void check_fans() {
    DisjointSets corners(3 * triangles_.size());
    const auto corner_at = [&](std::uint32_t h, VertexId v) {
      return from(h) == v ? h : h - h % 3 + (h + 1) % 3;
    };
    for (std::size_t e = 0; e < edges_->size(); ++e) {
      std::uint32_t first = kNone;
      for (const std::uint32_t h : (*edges_)[e]) {
        if (repeats_vertex(h / 3)) continue;
        if (first == kNone) first = h;
        for (const VertexId v : {from(h), to(h)}) {
          corners.join(corner_at(h, v), corner_at(first, v));
        }
      }
    }
    // Roots are the smallest of their sets, so the triangles of the fans come in order.
    std::vector<std::vector<std::uint32_t>> fans(surface_.vertices.size());
    for (std::uint32_t h = 0; h < 3 * triangles_.size(); ++h) {
      if (corners.smallest(h) == h && !repeats_vertex(h / 3)) fans[from(h)].push_back(h / 3);
    }
    for (VertexId v = 0; v < fans.size(); ++v) {
      if (fans[v].size() < 2) continue;
      add(Kind::non_manifold_vertex, {v, v}, {v}, fans[v],
          "vertex " + text(std::uint64_t{v}) + " at " + at(v) + " joins " + text(fans[v].size()) +
              " separate fans of triangles, containing triangles " + list(fans[v]));
    }
  }

  bool repeats_vertex(std::uint32_t t) const {
    const auto [a, b, c] = triangles_[t];
    return a == b || b == c || c == a;
  }

  // Degenerate triangles and duplicates are reported already and take no part.
  void check_intersections() {
    triangle_tree_.emplace(boxes_);
    const std::vector<BoxTree::PairTask> tasks = triangle_tree_->pair_tasks();
    PerWorker<Predicates> predicates(control_, points_);
    std::vector<Place>& all = places(Kind::self_intersection);
    // A part of the tasks at a time: what they find is put together before it takes much memory.
    constexpr std::size_t kTogether = 256;
    for (std::size_t begin = 0; begin < tasks.size(); begin += kTogether) {
      std::vector<std::vector<Place>> of_task(std::min(kTogether, tasks.size() - begin));
      for_chunks(control_, of_task.size(), 1, [&](Worker& worker, const Chunk& chunk) {
        const BoxTree::PairTask& task = tasks[begin + chunk.index];
        return triangle_tree_->pairs(task, [&](std::uint32_t t, std::uint32_t u) {
          worker.poll();
          if (t > u) std::swap(t, u);
          if (!intersect(predicates[worker], t, u)) return true;
          of_task[chunk.index].push_back({t, u});
          return !stop_at_first_;
        });
      });
      for (const std::vector<Place>& found : of_task) {
        count(Kind::self_intersection) += found.size();
        const std::size_t room = std::min<std::uint64_t>(found.size(), most_places_ - all.size());
        all.insert(all.end(), found.begin(), found.begin() + static_cast<std::ptrdiff_t>(room));
        if (stop_at_first_ && !found.empty()) break;  // others were found later, by other threads
      }
      if (stop_at_first_ && !all.empty()) break;
    }
    std::sort(all.begin(), all.end());
    for (std::size_t i = 0; i < all.size() && i < kListed; ++i) {
      describe_intersection(all[i][0], all[i][1]);
    }
  }

  bool intersect(Predicates& predicates, std::uint32_t t, std::uint32_t u) const {
    if (projections_[t].sign == 0 || projections_[u].sign == 0 || same_corners(t, u)) return false;
    return meet_outside_shared(predicates, triangles_[t], triangles_[u], projections_[t],
                               projections_[u]);
  }

  bool same_corners(std::uint32_t t, std::uint32_t u) const {
    return std::all_of(triangles_[t].begin(), triangles_[t].end(), [&](VertexId v) {
      return std::find(triangles_[u].begin(), triangles_[u].end(), v) != triangles_[u].end();
    });
  }

  void describe_intersection(std::uint32_t t, std::uint32_t u) {
    Vec3 near;
    for (std::size_t i = 0; i < 3; ++i) {
      near[i] = std::max(boxes_[t].lo[i], boxes_[u].lo[i]) * 0.5 +
                std::min(boxes_[t].hi[i], boxes_[u].hi[i]) * 0.5;
    }
    std::vector<std::uint32_t> corners(triangles_[t].begin(), triangles_[t].end());
    corners.insert(corners.end(), triangles_[u].begin(), triangles_[u].end());
    const auto names = [&](std::uint32_t x) {
      return text(std::uint64_t{x}) + " (vertices " +
             list({triangles_[x].begin(), triangles_[x].end()}) + ")";
    };
    result_.report.defects.push_back(
        {Kind::self_intersection,
         std::move(corners),
         {t, u},
         "triangles " + names(t) + " and " + names(u) + " intersect or touch near " + text(near)});
  }

  void check_nesting() {
    const auto nesting = analyze_nesting(triangles_, component_of_, result_.report.components,
                                         predicates_, *triangle_tree_, control_);
    std::vector<std::uint8_t> wrong;
    for (const ComponentNesting& c : nesting) {
      const int wanted = c.depth % 2 == 0 ? 1 : -1;
      wrong.push_back(c.volume_sign != wanted);
      result_.report.volume += wanted * c.volume;
    }
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
      result_.reverse_triangle[t] = wrong[component_of_[t]];
    }
    const auto reversed = static_cast<std::uint64_t>(std::count(wrong.begin(), wrong.end(), 1));
    if (reversed == wrong.size()) {
      result_.report.flipped = true;
      result_.report.warnings.push_back("the surface was inside out and has been flipped");
    } else if (reversed > 0) {
      warn_about_components(wrong, nesting, reversed);
    }
  }

  void warn_about_components(const std::vector<std::uint8_t>& wrong,
                             const std::vector<ComponentNesting>& nesting, std::uint64_t reversed) {
    std::vector<std::uint32_t> first(wrong.size()), size(wrong.size(), 0);
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
      if (size[component_of_[t]]++ == 0) first[component_of_[t]] = t;
    }
    std::uint64_t listed = 0;
    for (std::size_t c = 0; c < wrong.size() && listed < kListed; ++c) {
      if (wrong[c] == 0) continue;
      ++listed;
      const std::uint64_t depth = nesting[c].depth;
      result_.report.warnings.push_back(
          "the closed surface of triangle " + text(std::uint64_t{first[c]}) + " (" +
          text(std::uint64_t{size[c]}) + " triangles) was turned round: it is inside " +
          (depth == 0   ? "no other"
           : depth == 1 ? "another"
                        : text(depth) + " others") +
          (depth % 2 == 1 ? ", so it bounds a cavity, which is not meshed (--regions all meshes it)"
                          : ", so it bounds a solid, which is meshed"));
    }
    if (reversed > listed) {
      result_.report.warnings.push_back(text(reversed - listed) +
                                        " more closed surfaces were turned round");
    }
  }

  void conclude() {
    SurfaceReport& report = result_.report;
    if (!any_defect()) return;
    for (std::size_t k = 0; k < report.places.size(); ++k) {
      const std::uint64_t kept = report.places[k].size();
      if (kept != most_places_ || kept == report.defect_counts[k]) continue;
      report.warnings.push_back(
          text(kept) + " of " + text(report.defect_counts[k]) +
          " places are kept for files of defects: " + defect_name(static_cast<Kind>(k)));
    }
    const std::uint64_t total =
        std::accumulate(report.defect_counts.begin(), report.defect_counts.end(), std::uint64_t{0});
    const Defect& worst = report.defects.front();
    report.status.code = StatusCode::invalid_surface;
    report.status.message = std::string(defect_name(worst.kind)) + ": " + worst.message;
    if (worst.kind != Kind::index_out_of_range && worst.kind != Kind::empty) {
      report.status.message += " (indices from 0)";
    }
    if (stop_at_first_ || total == 1) return;
    report.status.message += "; " + text(total - 1) + " more defects";
  }

  std::uint32_t from(std::uint32_t h) const { return triangles_[h / 3][h % 3]; }
  std::uint32_t to(std::uint32_t h) const { return triangles_[h / 3][(h % 3 + 1) % 3]; }

  const Surface& surface_;
  const Triangles& triangles_;
  const bool stop_at_first_;
  const std::uint64_t most_places_;
  const Rules rules_;
  Control& control_;
  PointStore points_;
  Predicates predicates_;
  ValidityResult result_;
  std::uint64_t used_vertices_ = 0;
  std::vector<Projection> projections_;
  std::vector<Box> boxes_;
  std::optional<HalfEdgeGroups> edges_;
  std::vector<std::uint32_t> component_of_;
  std::optional<BoxTree> triangle_tree_;
};

}  // namespace

ValidityResult check_validity(const Surface& surface, bool stop_at_first, Control& control,
                              std::uint64_t most_places, Rules rules) {
  return Checker(surface, stop_at_first, control, most_places, rules).run();
}

Surface oriented_outwards(const Surface& surface, const ValidityResult& validity) {
  Surface result = surface;
  for (std::size_t t = 0; t < result.triangles.size(); ++t) {
    if (validity.reverse_triangle[t] != 0)
      std::swap(result.triangles[t][1], result.triangles[t][2]);
  }
  return result;
}

}  // namespace delmesher::surface
