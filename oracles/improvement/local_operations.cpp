#include "oracles/improvement/local_operations.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <optional>
#include <tuple>

#include "oracles/base/box_tree.h"
#include "oracles/base/edge_key.h"
#include "oracles/base/union_find.h"
#include "oracles/mesh/angles.h"
#include "oracles/record/record_origin.h"
#include "oracles/surface/input_surface.h"
#include "oracles/verdict/edge_sizes.h"

namespace tetproof::oracles {
namespace {

using delmesher::ExactRecord;

// The nearest doubles of a point without denominators, as all written points are.
Position rounded(const ExactPoints& points, Index v) {
  if (points.is_double(v)) return points.nearest(v);
  const ExactVector exact = points.exact(v);
  Position result;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const mpz_class& x = exact[axis].numerator();
    const std::size_t bits = x == 0 ? 0 : mpz_sizeinbase(x.get_mpz_t(), 2);
    if (bits <= 53) {
      result[axis] = to_double(x, points.exponent());
      continue;
    }
    // Adding half of the last place before truncation rounds to nearest.
    mpz_class half;
    mpz_ui_pow_ui(half.get_mpz_t(), 2, bits - 54);
    result[axis] = to_double(x > 0 ? mpz_class(x + half) : mpz_class(x - half), points.exponent());
  }
  return result;
}

// As doubles; those that are doubles in given coordinates, too, if these have another origin.
ExactPoints all_rounded(const ExactPoints& points, const Position& origin) {
  std::vector<Position> nearest(points.size());
  for (Index v = 0; v < points.size(); ++v) {
    nearest[v] = rounded(points, v);
    for (std::size_t i = 0; i < 3; ++i) {
      if (origin[i] != 0) nearest[v][i] = (origin[i] + nearest[v][i]) - origin[i];
    }
  }
  ExactPoints doubles;
  doubles.assign(nearest);
  return doubles;
}

std::string name_of(const Tet& tet) {
  std::string name = "tetrahedron (";
  for (int i = 0; i < 4; ++i) name += (i > 0 ? " " : "") + std::to_string(tet[i]);
  return name + ")";
}

class Repairs {
 public:
  Repairs(const ExactRecord& record, const ExactPoints& points, const Promise& promise)
      : record_(record), points_(points), all_(promise.region == delmesher::Region::hull) {}

  OracleReport run() {
    constexpr int kReach = kOperationsReach;
    check_vertices();
    find_defects();
    const std::vector<Tet> before = sorted(record_.unrepaired), after = sorted(record_.final);
    std::vector<Tet> changed;
    std::set_difference(before.begin(), before.end(), after.begin(), after.end(),
                        std::back_inserter(changed));
    report_.checked += before.size();
    report_.figures.emplace_back("tetrahedra changed", static_cast<double>(changed.size()));
    report_.figures.emplace_back("not positive on doubles", static_cast<double>(defects_));
    spread(kReach);
    int farthest = 0;
    for (const Tet& tet : changed) {
      int nearest = kReach + 1;
      for (const Index v : tet) nearest = std::min<int>(nearest, ring_[v]);
      farthest = std::max(farthest, nearest);
      if (nearest > kReach) {
        report_.fail(name_of(tet) + " was changed far from all that doubles are too coarse for");
      }
    }
    report_.figures.emplace_back("edges from there", farthest);
    return std::move(report_);
  }

 private:
  static std::vector<Tet> sorted(const std::vector<ExactRecord::Tet>& tets) {
    std::vector<Tet> list;
    list.reserve(tets.size());
    for (const ExactRecord::Tet& tet : tets) {
      list.push_back(tet.vertices);
      std::sort(list.back().begin(), list.back().end());
    }
    std::sort(list.begin(), list.end());
    return list;
  }

  void check_vertices() {
    const std::vector<std::uint8_t> before = used_in(record_.unrepaired, points_.size()),
                                    after = used_in(record_.final, points_.size());
    for (Index v = 0; v < points_.size(); ++v) {
      report_.checked += after[v];
      if (after[v] != 0 && before[v] == 0) {
        report_.fail("vertex " + std::to_string(v) + " came with the repairs");
      }
    }
  }

  void find_defects() {
    const ExactPoints doubles = all_rounded(points_, record_.origin);
    ring_.assign(points_.size(), kFar);
    for (const ExactRecord::Tet& tet : record_.unrepaired) {
      if (!all_ && !tet.inside) continue;
      const auto& [a, b, c, d] = tet.vertices;
      if (exact::orient3d(doubles, a, b, c, d) > 0) continue;
      ++defects_;
      for (const Index v : tet.vertices) ring_[v] = 0;
    }
  }

  // Finds how many edges every vertex is from the nearest defect.
  void spread(int reach) {
    for (std::uint8_t ring = 1; ring <= reach; ++ring) {
      for (const ExactRecord::Tet& tet : record_.unrepaired) {
        const bool touched = std::any_of(tet.vertices.begin(), tet.vertices.end(),
                                         [&](Index v) { return ring_[v] == ring - 1; });
        if (!touched) continue;
        for (const Index v : tet.vertices) ring_[v] = std::min(ring_[v], ring);
      }
    }
  }

  static constexpr std::uint8_t kFar = 255;
  const ExactRecord& record_;
  const ExactPoints& points_;
  bool all_;
  std::vector<std::uint8_t> ring_;
  std::uint64_t defects_ = 0;
  OracleReport report_{"repairs", "vertices and tetrahedra"};
};

// --- improvement

class Improvement {
 public:
  Improvement(const ExactRecord& record, const ExactPoints& points, const Promise& promise,
              const std::vector<Index>& returned)
      : record_(record),
        doubles_(all_rounded(points, {})),
        all_(promise.region == delmesher::Region::hull),
        goal_{promise.guaranteed_delta(), kImprovedDihedral},
        halves_(promise.task == Task::mesh),
        longest_(promise.max_edge),
        sizes_(promise.size_field, promise.size_growth),
        bound_(promise.size_field, promise.size_growth, promise.longest_whole()),
        excused_from_(returned) {
    if (names_origin(record)) written_ = all_rounded(points, record.origin);
  }

  OracleReport run() {
    measure_before();
    measure_after();
    report_.figures = {{"smallest face angle before", before_.face},
                       {"smallest face angle after", after_.face},
                       {"flattest dihedral angle before", before_.dihedral},
                       {"flattest dihedral angle after", after_.dihedral},
                       {"tetrahedra before", static_cast<double>(record_.unrepaired.size())},
                       {"not positive on doubles", static_cast<double>(defects_)},
                       {"below the goals after", static_cast<double>(bad_.size())}};
    explain();
    if (!bad_.empty()) explain_by_place();
    find_long_edges();
    if (!excused_from_.empty()) excuse();
    for (const Bad& bad : bad_) {
      report_.fail(name_of(bad.tet) + " has a face angle of " + std::to_string(bad.angles.face) +
                   " degrees and lacks " + std::to_string(bad.angles.dihedral) +
                   " of being flat, and nothing near was as bad before");
    }
    count();
    if (longest_ > 0) {
      check_edges("--max-edge",
                  [&](Index v, Index w) { return exact::distance(doubles_, v, w) / longest_; });
    }
    if (!sizes_.empty()) {
      check_edges("--size-field", [&](Index v, Index w) {
        return sizes_.excess(doubles_.nearest(v), doubles_.nearest(w));
      });
    }
    return std::move(report_);
  }

 private:
  struct Bad {
    Tet tet;
    WorstAngles angles;
    WorstAngles there_before{};  // the worst near its place, once that is asked
  };

  static WorstAngles worse(const WorstAngles& a, const WorstAngles& b) {
    return {std::min(a.face, b.face), std::min(a.dihedral, b.dihedral)};
  }
  bool counts(const ExactRecord::Tet& tet) const { return all_ || tet.inside; }
  bool reaches(const WorstAngles& angles, const WorstAngles& least) const {
    return angles.face >= std::min(least.face, goal_.face) * kSlack &&
           angles.dihedral >= std::min(least.dihedral, goal_.dihedral) * kSlack - kRoundings;
  }

  // Zero if it is not positive, and only then.
  WorstAngles angles_of(const ExactRecord::Tet& tet) const {
    const auto& [a, b, c, d] = tet.vertices;
    if (exact::orient3d(doubles_, a, b, c, d) <= 0) return {0, 0};
    if (written_ && exact::orient3d(*written_, a, b, c, d) <= 0) return {0, 0};
    return worst_angles(doubles_, tet.vertices);
  }

  void measure_before() {
    worst_.assign(doubles_.size(), {});
    for (const ExactRecord::Tet& tet : record_.unrepaired) {
      if (!counts(tet)) continue;
      const WorstAngles angles = angles_of(tet);
      if (angles.dihedral == 0) ++defects_;
      before_ = worse(before_, angles);
      for (const Index v : tet.vertices) worst_[v] = worse(worst_[v], angles);
    }
  }

  void measure_after() {
    for (const ExactRecord::Tet& tet : record_.final) {
      if (!counts(tet)) continue;
      ++report_.checked;
      const WorstAngles angles = angles_of(tet);
      after_ = worse(after_, angles);
      if (reaches(angles, goal_)) continue;
      bad_.push_back({tet.vertices, angles});
      bad_after_.push_back(tet.vertices);
    }
  }

  // A bad tetrahedron has to be near one that was as bad before.
  void explain() {
    int edges = 0;
    for (;; ++edges) {
      std::erase_if(bad_, [&](const Bad& bad) {
        WorstAngles least;
        for (const Index v : bad.tet) least = worse(least, worst_[v]);
        return reaches(bad.angles, least);
      });
      if (bad_.empty() || edges == kOperationsReach) break;
      spread();
    }
    report_.figures.emplace_back("edges from what was as bad", edges);
  }

  // Where all vertices of a neighbourhood have moved, none of their names leads to the mesh before:
  // then what was where the bad tetrahedron is now tells what was near. How many need this is told.
  void explain_by_place() {
    std::vector<BoxTree::Box> boxes;
    boxes.reserve(bad_.size());
    for (const Bad& bad : bad_) boxes.push_back(box_around(doubles_, bad.tet));
    const BoxTree tree(std::move(boxes));
    std::vector<Index> here;
    for (const ExactRecord::Tet& tet : record_.unrepaired) {
      if (!counts(tet)) continue;
      here.clear();
      tree.query(box_around(doubles_, tet.vertices), here);
      WorstAngles least;
      for (const Index v : tet.vertices) least = worse(least, worst_[v]);
      for (const Index b : here) bad_[b].there_before = worse(bad_[b].there_before, least);
    }
    const std::size_t explained =
        std::erase_if(bad_, [&](const Bad& bad) { return reaches(bad.angles, bad.there_before); });
    report_.figures.emplace_back(kByPlace, static_cast<double>(explained));
  }

  // Edges that were too long are halved, whatever becomes of the angles there; as many tetrahedra
  // come as cubes of the length asked for are in one of the length that was there.
  void find_long_edges() {
    if (!halves_ || bound_.empty()) return;
    for (const ExactRecord::Tet& tet : record_.unrepaired) {
      if (!counts(tet)) continue;
      double most = 1;
      for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = 0; j < i; ++j) {
          const Index v = tet.vertices[i], w = tet.vertices[j];
          const double excess = bound_.excess(doubles_.nearest(v), doubles_.nearest(w));
          if (excess > EdgeSizes::kMost) excused_from_.insert(excused_from_.end(), {v, w});
          most = std::max(most, excess);
        }
      }
      halves_expected_ += std::pow(most, 3) - 1;
    }
  }

  // What is left may be beside an edge of the surface that the mesh before did not have, or one
  // that was too long. How many, how bad and how far from such edges is told.
  void excuse() {
    std::vector<std::uint8_t> near(doubles_.size());
    for (const Index v : excused_from_) near[v] = 1;
    std::size_t excused = 0;
    WorstAngles worst;
    int farthest = 0;
    for (int edges = 0;; ++edges) {
      const std::size_t here = std::erase_if(bad_, [&](const Bad& bad) {
        const bool is_near = std::ranges::any_of(bad.tet, [&](Index v) { return near[v] != 0; });
        if (is_near) worst = worse(worst, bad.angles);
        return is_near;
      });
      if (here > 0) farthest = edges;
      excused += here;
      if (edges == kOperationsReach) break;
      const std::vector<std::uint8_t> before = near;
      for (const ExactRecord::Tet& tet : record_.final) {
        const bool reached =
            std::ranges::any_of(tet.vertices, [&](Index v) { return before[v] != 0; });
        if (!reached || !counts(tet)) continue;
        for (const Index v : tet.vertices) near[v] = 1;
      }
    }
    excused_ = near;
    report_.figures.emplace_back("below the goals beside edges that came back or were too long",
                                 static_cast<double>(excused));
    if (excused == 0) return;
    report_.figures.emplace_back("smallest face angle there", worst.face);
    report_.figures.emplace_back("flattest dihedral angle there", worst.dihedral);
    report_.figures.emplace_back("edges from there", farthest);
  }

  bool is_excused(const Tet& tet) const {
    return !excused_.empty() && std::ranges::any_of(tet, [&](Index v) { return excused_[v] != 0; });
  }

  // Passes the worst angles known at every vertex on to its neighbours.
  void spread() {
    const std::vector<WorstAngles> known = worst_;
    for (const auto* mesh : {&record_.unrepaired, &record_.final}) {
      for (const ExactRecord::Tet& tet : *mesh) {
        if (!counts(tet)) continue;
        WorstAngles least;
        for (const Index v : tet.vertices) least = worse(least, known[v]);
        for (const Index v : tet.vertices) worst_[v] = worse(worst_[v], least);
      }
    }
  }

  // How many are how bad: in all, and in each part of the mesh that is within reach of what is bad
  // now, at most four times as many angles as were as bad, within a factor of two, however small
  // they are; what is not below the goal is as good as that. One operation may trade a few angles
  // that are nearly as bad for one that was worst. Nor are there more than twice as many
  // tetrahedra; a few may be new where there are few.
  void count() {
    std::uint64_t inside_before = 0;
    for (const ExactRecord::Tet& tet : record_.unrepaired) inside_before += counts(tet) ? 1 : 0;
    report_.figures.emplace_back("counted before", static_cast<double>(inside_before));
    const double expected = static_cast<double>(inside_before) + halves_expected_;
    if (static_cast<double>(report_.checked) > 2 * expected + kFew) {
      report_.fail("there are " + std::to_string(report_.checked) + " tetrahedra, and were " +
                   std::to_string(inside_before));
    }
    const std::vector<Index> part = parts();
    for (const auto& [member, goal, name] :
         {std::tuple(&WorstAngles::face, goal_.face, "face"),
          std::tuple(&WorstAngles::dihedral, goal_.dihedral, "dihedral")}) {
      const std::vector<Graded> was = graded(record_.unrepaired, part, member, goal),
                                is = graded(record_.final, part, member, goal);
      report_.figures.emplace_back(std::string(name) + " angles below the goal before",
                                   static_cast<double>(was.size()));
      report_.figures.emplace_back(std::string(name) + " angles below the goal after",
                                   static_cast<double>(is.size()));
      compare(was, is, goal, name);
    }
  }

  // Of each vertex within reach of a tetrahedron that is bad now the part of the mesh that it is
  // in; of others kNone.
  std::vector<Index> parts() const {
    UnionFind united(doubles_.size());
    std::vector<std::uint8_t> ring(doubles_.size(), kFar);
    for (const Tet& tet : bad_after_) {
      for (const Index v : tet) ring[v] = 0;
    }
    for (std::uint8_t edges = 1; edges <= kOperationsReach; ++edges) {
      for (const auto* mesh : {&record_.unrepaired, &record_.final}) {
        for (const ExactRecord::Tet& tet : *mesh) {
          const bool touched =
              std::ranges::any_of(tet.vertices, [&](Index v) { return ring[v] < edges; });
          if (!touched || !counts(tet)) continue;
          for (const Index v : tet.vertices) {
            ring[v] = std::min(ring[v], edges);
            united.unite(v, tet.vertices[0]);
          }
        }
      }
    }
    std::vector<Index> part(doubles_.size(), kNone);
    for (Index v = 0; v < part.size(); ++v) {
      if (ring[v] != kFar) part[v] = united.find(v);
    }
    return part;
  }

  struct Graded {
    Index part;
    double angle;
    auto operator<=>(const Graded&) const = default;
  };

  // The angles below the goal, the worst of each part first. Beside edges that came back anything
  // may be bad.
  std::vector<Graded> graded(const std::vector<ExactRecord::Tet>& tets,
                             const std::vector<Index>& part, double WorstAngles::*member,
                             double goal) const {
    std::vector<Graded> list;
    for (const ExactRecord::Tet& tet : tets) {
      if (!counts(tet)) continue;
      const double angle = angles_of(tet).*member;
      if (angle >= goal * kSlack) continue;
      const auto near =
          std::ranges::find_if(tet.vertices, [&](Index v) { return part[v] != kNone; });
      if (&tets == &record_.final && is_excused(tet.vertices)) continue;
      list.push_back({near == tet.vertices.end() ? kNone : part[*near], angle});
    }
    std::ranges::sort(list);
    return list;
  }

  void compare(std::vector<Graded> was, std::vector<Graded> is, double goal, const char* name) {
    compare_parts(was, is, goal, name);
    for (auto* list : {&was, &is}) {
      for (Graded& g : *list) g.part = kAll;
      std::ranges::sort(*list);
    }
    compare_parts(was, is, goal, name);
  }

  void compare_parts(const std::vector<Graded>& was, const std::vector<Graded>& is, double goal,
                     const char* name) {
    for (std::size_t i = 0, first = 0; i < is.size(); ++i) {
      if (is[i].part != is[first].part) first = i;
      const auto begin = std::ranges::lower_bound(was, is[i].part, {}, &Graded::part);
      // Where all vertices have moved, nothing that was there before has a name in this part.
      const bool named = begin != was.end() && begin->part == is[i].part;
      if (!named && is[i].part != kAll) continue;
      const std::size_t k = (i - first) / kTimesAsMany;
      const std::size_t there = k < static_cast<std::size_t>(was.end() - begin) &&
                                begin[static_cast<std::ptrdiff_t>(k)].part == is[i].part;
      const double least = there != 0 ? begin[static_cast<std::ptrdiff_t>(k)].angle : goal;
      if (is[i].angle >= kTraded * least - kRoundings) continue;
      report_.fail("the " + std::string(name) + " angle of rank " + std::to_string(i - first + 1) +
                   " is " + std::to_string(is[i].angle) + " degrees, and that of rank " +
                   std::to_string(k + 1) + " was " + std::to_string(least));
    }
  }

  // A vertex that is moved becomes another point, so that an edge to it is new by name. A new edge
  // that is too long takes the place of one that was no less so: its middle is within the length of
  // that one from its middle. Each may be replaced once.
  struct Long {
    std::uint64_t edge;
    double excess;  // over what is allowed
  };

  template <class Excess>
  void check_edges(const std::string& option, const Excess& excess) {
    const std::vector<Long> before = long_edges(record_.unrepaired, excess),
                            after = long_edges(record_.final, excess);
    std::vector<Long> fresh, lost;
    std::ranges::set_difference(after, before, std::back_inserter(fresh), {}, &Long::edge,
                                &Long::edge);
    std::ranges::set_difference(before, after, std::back_inserter(lost), {}, &Long::edge,
                                &Long::edge);
    std::vector<BoxTree::Box> boxes;
    for (const Long& edge : lost) {
      const Position at = middle(edge.edge);
      const double reach = length(edge.edge);
      boxes.push_back({at, at});
      for (std::size_t axis = 0; axis < 3; ++axis) {
        boxes.back().low[axis] -= reach;
        boxes.back().high[axis] += reach;
      }
    }
    const BoxTree places(std::move(boxes));
    std::vector<std::uint8_t> replaced(lost.size());
    // The longest first; it takes the shortest that will do.
    std::ranges::stable_sort(fresh, std::greater{}, &Long::excess);
    std::vector<Index> near;
    for (const Long& edge : fresh) {
      near.clear();
      const Position at = middle(edge.edge);
      places.query({at, at}, near);
      Index best = kNone;
      for (const Index n : near) {
        if (replaced[n] != 0 || lost[n].excess * kLongSlack < edge.excess) continue;
        if (best == kNone || std::pair(lost[n].excess, n) < std::pair(lost[best].excess, best)) {
          best = n;
        }
      }
      if (best != kNone) {
        replaced[best] = 1;
        continue;
      }
      const auto [v, w] = ends(edge.edge);
      report_.fail("edge (" + std::to_string(v) + " " + std::to_string(w) + ") is new and " +
                   std::to_string(edge.excess) + " times what " + option +
                   " allows, and no edge there was so long before");
    }
    report_.figures.emplace_back("edges above " + option + ", as before",
                                 static_cast<double>(after.size() - fresh.size()));
    report_.figures.emplace_back("to vertices that moved", static_cast<double>(fresh.size()));
  }

  static std::pair<Index, Index> ends(std::uint64_t edge) {
    return {static_cast<Index>(edge >> 32), static_cast<Index>(edge & 0xffffffffU)};
  }
  double length(std::uint64_t edge) const {
    const auto [v, w] = ends(edge);
    return exact::distance(doubles_, v, w);
  }
  Position middle(std::uint64_t edge) const {
    const auto [v, w] = ends(edge);
    const Position &a = doubles_.nearest(v), &b = doubles_.nearest(w);
    return {a[0] / 2 + b[0] / 2, a[1] / 2 + b[1] / 2, a[2] / 2 + b[2] / 2};
  }

  // Once each, ascending.
  template <class Excess>
  std::vector<Long> long_edges(const std::vector<ExactRecord::Tet>& tets,
                               const Excess& excess) const {
    std::vector<std::uint64_t> edges;
    for (const ExactRecord::Tet& tet : tets) {
      if (!counts(tet)) continue;
      for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < i; ++j) edges.push_back(edge_key(tet.vertices[i], tet.vertices[j]));
      }
    }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    std::vector<Long> list;
    for (const std::uint64_t edge : edges) {
      const auto [v, w] = ends(edge);
      const double above = excess(v, w);
      if (above > kLongSlack) list.push_back({edge, above});
    }
    return list;
  }

  static constexpr std::uint8_t kFar = 255;
  static constexpr Index kAll = kNone - 1;  // no vertex: the part that is all of the mesh
  static constexpr double kTraded = 0.5;
  static constexpr std::size_t kTimesAsMany = 4;
  static constexpr std::uint64_t kFew = 100;  // tetrahedra
  static constexpr double kSlack = 1 - 1e-6;  // of angles, computed in doubles
  // Degrees: which of two tetrahedra that are flat but for roundings is flatter, doubles do not
  // tell.
  static constexpr double kRoundings = 1e-12;
  static constexpr double kLongSlack = 1 + 1e-9;
  const ExactRecord& record_;
  const ExactPoints doubles_;           // the nearest ones
  std::optional<ExactPoints> written_;  // in given coordinates, where these have another origin
  const bool all_;
  const WorstAngles goal_;
  const bool halves_;  // edges that were too long
  const double longest_;
  const EdgeSizes sizes_, bound_;    // the field alone, and with --max-edge
  double halves_expected_ = 0;       // tetrahedra
  std::vector<Index> excused_from_;  // on edges that came back or were too long
  std::vector<WorstAngles> worst_;   // per point, of the tetrahedra there before
  WorstAngles before_, after_;
  std::vector<Bad> bad_;               // those that nothing explains so far
  std::vector<Tet> bad_after_;         // all of them
  std::vector<std::uint8_t> excused_;  // vertices near these
  std::uint64_t defects_ = 0;
  OracleReport report_{"improvement", "tetrahedra"};
};

}  // namespace

OracleReport check_repairs(const ExactRecord& record, const ExactPoints& points,
                           const Promise& promise) {
  return Repairs(record, points, promise).run();
}

OracleReport check_improvement(const ExactRecord& record, const ExactPoints& points,
                               const Promise& promise, const std::vector<Index>& returned) {
  return Improvement(record, points, promise, returned).run();
}

}  // namespace tetproof::oracles
