#include "oracles/mesh/parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "oracles/base/distances.h"
#include "oracles/base/union_find.h"
#include "oracles/mesh/conformity.h"
#include "oracles/mesh/region_points.h"
#include "oracles/mesh/shells.h"
#include "oracles/mesh/solids.h"
#include "oracles/mesh/split_triangles.h"
#include "oracles/surface/input_surface.h"
#include "oracles/verdict/edge_sizes.h"

namespace tetproof::oracles {
namespace {

constexpr Index kNobody = kNone;

// A triangle of the input, once, by the vertices of the mesh where these are at its corners.
struct Triangle {
  Face corners;
  Face sorted;
  Face whole;  // the corners of the given one, of which it may be a part
  std::vector<std::int32_t> labels;
  std::vector<bool> even;     // per label: how its triangle is turned, as sort_face says
  Index given = 0;            // the first one
  bool is_ambiguous = false;  // as of SplitTriangles
  // The tetrahedron in front, where its corners are seen counter-clockwise, and the one behind.
  std::array<Index, 2> beside = {kNobody, kNobody};

  bool is_bare() const { return beside[0] == kNobody && beside[1] == kNobody; }
  bool is_wall() const { return beside[0] != kNobody && beside[1] != kNobody; }
};

class Parts {
 public:
  Parts(const Polyhedron& input, const MeshFile& mesh, const TetComplex& complex,
        const Neighbours& neighbours, const Promise& promise)
      : input_(input),
        mesh_(mesh),
        complex_(complex),
        neighbours_(neighbours),
        points_(*complex.points),
        promise_(promise),
        region_points_(input.region_points, complex) {}

  PartsResult run(double near) {
    collect_triangles();
    result_.parts.checked = triangles_.size();
    connect();
    near_ = near;
    if (near > 0 && read_split()) connect();
    find_unread();
    find_solids();
    check_strays();
    find_parts_of_points();
    check_outer_faces();
    check_bare();
    check_missing();
    check_regions();
    check_wanted();
    bound_edges();
    check_names();
    check_names_by_points();
    check_list();
    for (Index t = 0; t < part_.size(); ++t) result_.part.push_back(part_.find(t));
    if (splits_walls()) {
      for (const auto& [part, t] : parts()) result_.called[part] = called(t);
    }
    excuse();
    return std::move(result_);
  }

 private:
  // A mesh that splits more has not kept the surface.
  static constexpr std::size_t kMostSplit = 1000;

  std::string name(const Triangle& t) const { return "triangle " + std::to_string(t.given); }
  static Site site(const Triangle& t) { return {Site::Kind::input_triangle, {t.given, 0, 0}}; }

  // One vertex of several at the same place: one of the mesh, if there is one.
  std::vector<Index> vertices_by_place() {
    std::vector<Index> order(input_.vertices.size() + mesh_.vertices.size()), first(order.size());
    for (Index v = 0; v < order.size(); ++v) order[v] = v;
    const auto place = [&](Index v) -> const Position& {
      return v < complex_.first_vertex ? input_.vertices[v]
                                       : mesh_.vertices[v - complex_.first_vertex];
    };
    std::ranges::sort(order, [&](Index a, Index b) {
      if (place(a) != place(b)) return place(a) < place(b);
      return (a < complex_.first_vertex) != (b < complex_.first_vertex) ? a >= complex_.first_vertex
                                                                        : a < b;
    });
    for (std::size_t n = 0; n < order.size(); ++n) {
      const bool same = n > 0 && place(order[n]) == place(order[n - 1]);
      first[order[n]] = same ? first[order[n - 1]] : order[n];
      torn_ = torn_ || (same && order[n] >= complex_.first_vertex);
    }
    return first;
  }

  void collect_triangles() {
    const std::vector<Index> vertex = vertices_by_place();
    std::map<Face, Index> known;
    for (Index t = 0; t < input_.triangles.size(); ++t) {
      Triangle triangle;
      for (std::size_t k = 0; k < 3; ++k) triangle.corners[k] = vertex[input_.triangles[t][k]];
      triangle.sorted = triangle.whole = triangle.corners;
      const bool even = sort_face(triangle.sorted);
      triangle.given = t;
      const auto [at, fresh] =
          known.try_emplace(triangle.sorted, static_cast<Index>(triangles_.size()));
      if (fresh) triangles_.push_back(triangle);
      triangles_[at->second].labels.push_back(input_.labels.empty() ? 0 : input_.labels[t]);
      triangles_[at->second].even.push_back(even);
    }
    by_corners_ = std::move(known);
    given_ = static_cast<Index>(triangles_.size());
    for (const Triangle& t : triangles_) corners_.push_back(t.corners);
  }

  Index triangle_of(Face face) const {
    sort_face(face);
    const auto at = by_corners_.find(face);
    return at == by_corners_.end() ? kNobody : at->second;
  }

  // Replaces triangles that the mesh has in several faces by these. False if there are none.
  bool read_split() {
    std::vector<Index> asked;
    std::vector<Face> faces;
    for (Index n = 0; n < triangles_.size(); ++n) {
      const Triangle& t = triangles_[n];
      if (!t.is_bare()) continue;
      if (*std::ranges::min_element(t.corners) < complex_.first_vertex) continue;
      asked.push_back(n);
      faces.push_back(t.corners);
    }
    if (asked.empty()) return false;
    SplitTriangles split(complex_, mesh_.regions, corners_, near_);
    const std::vector<SplitTriangles::Split> parts = split.read(neighbours_, faces);
    for (std::size_t n = 0; n < asked.size(); ++n) {
      const auto& [own, is_ambiguous] = parts[n];
      triangles_[asked[n]].is_ambiguous = is_ambiguous;
      if (!own.empty() && put_in_place(asked[n], own)) ++result_.split;
    }
    if (result_.split == 0) return false;
    result_.deviation = split.deviation();
    result_.parts.figures.emplace_back("deviation", result_.deviation);
    corners_.clear();
    for (const Triangle& t : triangles_) corners_.push_back(t.corners);
    return true;
  }
  // Of a triangle; they look to where it does. False if one is a triangle already.
  bool put_in_place(Index n, const std::vector<Face>& parts) {
    if (std::ranges::any_of(parts, [&](const Face& part) { return triangle_of(part) != kNobody; }))
      return false;
    const Triangle given = triangles_[n];
    by_corners_.erase(given.sorted);
    for (std::size_t k = 0; k < parts.size(); ++k) {
      Triangle part = given;
      part.corners = part.sorted = parts[k];
      const bool even = sort_face(part.sorted);
      for (std::size_t label = 0; label < given.even.size(); ++label) {
        part.even[label] = (given.even[label] == given.even[0]) == even;
      }
      const Index at = k == 0 ? n : static_cast<Index>(triangles_.size());
      by_corners_.emplace(part.sorted, at);
      result_.pieces.emplace(part.sorted, PartsResult::Piece{part.corners, part.given});
      if (k == 0) {
        triangles_[n] = part;
      } else {
        triangles_.push_back(part);
      }
    }
    return true;
  }

  // --- what triangles explain whose reading is ambiguous
  // Is it one, and no face?
  bool is_unread(Index n) const { return triangles_[n].is_ambiguous && triangles_[n].is_bare(); }
  // Is it one, or does it have an edge in common with one?
  bool is_beside_unread(Index n) const {
    const Face& t = triangles_[n].whole;
    return std::ranges::any_of(unread_, [&](const Face& other) {
      return std::ranges::count_if(
                 other, [&](Index v) { return std::ranges::find(t, v) != t.end(); }) >= 2;
    });
  }
  void find_unread() {
    const auto count = std::count_if(triangles_.begin(), triangles_.begin() + given_,
                                     [](const Triangle& t) { return t.is_ambiguous; });
    if (torn_ || count > static_cast<std::ptrdiff_t>(kMostSplit)) {
      for (Triangle& t : triangles_) t.is_ambiguous = false;
    }
    for (Index n = 0; n < given_; ++n) {
      if (triangles_[n].is_ambiguous) ambiguous_.push_back(triangles_[n].whole);
      if (is_unread(n)) unread_.push_back(triangles_[n].whole);
    }
  }
  // Does the face lie on one of these?
  bool lies_on(const std::vector<Face>& triangles, const Face& face) const {
    return std::ranges::any_of(triangles, [&](const Face& t) {
      return std::ranges::all_of(
          face, [&](Index v) { return distance_rounded_up(points_, v, t) <= near_; });
    });
  }
  // Of what is no triangle: where some are not read, others may be read as they are not.
  bool is_explained(const Face& face) const {
    return !unread_.empty() && lies_on(ambiguous_, face);
  }
  void fail(OracleReport& report, const std::string& finding, const Site& site, bool explained) {
    report.fail(finding, site);
    if (explained) ++explained_[&report];
  }
  // Where they explain every violation of a report, nothing is known to be wrong.
  void excuse() {
    if (explained_.empty()) return;
    for (OracleReport* report : {&result_.parts, &result_.regions, &result_.list}) {
      report->undecided = report->violations > 0 && explained_[report] == report->violations;
    }
    result_.split += unread_.size();
    result_.parts.notes.emplace_back(
        "several faces may tile triangles that are split: which ones do is not decided");
  }

  // Tetrahedra across faces that are not triangles become one part.
  void connect() {
    part_ = UnionFind(complex_.tetrahedra.size());
    strays_.clear();
    outer_faces_.clear();
    for (Triangle& t : triangles_) t.beside = {kNobody, kNobody};
    for (Index t = 0; t < complex_.tetrahedra.size(); ++t) {
      for (int i = 0; i < 4; ++i) {
        const Face face = face_of(complex_.tetrahedra[t], i);
        const Index across = neighbours_.across[4 * t + static_cast<Index>(i)];
        const Index n = triangle_of(face);
        if (n == kNobody && across == kNone) {
          strays_.push_back(face);
        } else if (n == kNobody) {
          part_.unite(t, across / 4);
        } else {
          // The face is seen counter-clockwise from outside the tetrahedron.
          Face sorted = face, corners = triangles_[n].corners;
          const bool same = sort_face(sorted) == sort_face(corners);
          triangles_[n].beside[same ? 1 : 0] = t;
        }
        if (across == kNone) outer_faces_.push_back(face);
      }
    }
  }

  void check_strays() {
    for (const Face& face : strays_) {
      fail(result_.parts,
           complex_.face_name(face) + " is of one tetrahedron alone, and no triangle of the input",
           complex_.face_site(face), strays_.size() <= kMostSplit && is_explained(face));
    }
  }

  // The ray begins just beyond the face, on the side to which it was moved or goes up.
  void check_outer_faces() {
    outer_.emplace(points_, std::move(outer_faces_));
    for (Index n = 0; n < outer_->faces().size(); ++n) {
      const Face& face = outer_->faces()[n];
      const RayCrossings above = outer_->above(face, n);
      if (above.on_triangle) {
        result_.parts.fail(complex_.face_name(face) + " lies on another outer face",
                           complex_.face_site(face));
      } else if (above.winding != (looks_up(points_, face) ? 0 : 1)) {
        result_.parts.fail("beside " + complex_.face_name(face) +
                               " the outer faces wind around a point not 0 or 1 times",
                           complex_.face_site(face));
      }
    }
  }

  // Triangles that are not faces are outside of all tetrahedra, and so are both of their sides.
  void check_bare() {
    std::uint64_t bare = 0;
    for (Index n = 0; n < triangles_.size(); ++n) {
      const Triangle& t = triangles_[n];
      if (!t.is_bare()) continue;
      ++bare;
      const RayCrossings above = outer_->above(t.corners);
      if (above.on_triangle || above.winding != 0) {
        fail(result_.parts, name(t) + " is not a face of the mesh", site(t), is_unread(n));
      }
    }
    result_.parts.figures.emplace_back("triangles that bound nothing", static_cast<double>(bare));
  }

  void check_missing() {
    std::vector<std::uint8_t> empty;
    for (const Triangle& t : triangles_) {
      for (const Index tet : t.beside) empty.push_back(tet == kNobody ? 1 : 0);
    }
    shells_.emplace(points_, corners_, std::move(empty));
    for (const auto& [here, next] : shells_->broken_wedges()) {
      fail(result_.parts,
           "between " + name(triangles_[here]) + " and " + name(triangles_[next]) +
               " there is a part of a wedge",
           site(triangles_[here]), is_beside_unread(here) || is_beside_unread(next));
    }
    find_points_of_shells();
    for (const auto& [number, shell] : shells_->all()) {
      if (shell.volume.sign() <= 0 || !is_wanted(shell)) continue;
      fail(result_.parts,
           "a part that is bounded by " + name(triangles_[shell.sides.front() / 2]) +
               " has no tetrahedra",
           site(triangles_[shell.sides.front() / 2]),
           std::ranges::any_of(shell.sides, [&](Index side) { return is_unread(side / 2); }));
    }
  }

  // --- points that tell of their region
  // The part in which a point is; none if it is on a wall between two, or in no tetrahedron.
  void find_parts_of_points() {
    for (Index n = 0; n < input_.region_points.size(); ++n) {
      std::set<Index> parts;
      for (const Index t : region_points_.around(n)) parts.insert(part_.find(t));
      if (parts.size() == 1) points_of_[*parts.begin()].push_back(n);
      if (input_.region_points[n].is_hole && parts.size() == 1) {
        result_.parts.fail(
            complex_.tet_name(region_points_.around(n).front()) + " is of a part with a hole point",
            complex_.tet_site(region_points_.around(n).front()));
      }
    }
  }
  std::string name_by_points(const std::vector<Index>& points) const {
    for (const Index n : points) {
      if (!input_.region_points[n].name.empty()) return input_.region_points[n].name;
    }
    return "";
  }
  std::vector<Index> points_of(Index t) {
    const auto at = points_of_.find(part_.find(t));
    return at == points_of_.end() ? std::vector<Index>() : at->second;
  }
  // What the part of a tetrahedron is called.
  std::string called(Index t) {
    const std::string name = name_by_points(points_of(t));
    return name.empty() ? called(solids_->around(complex_.tetrahedra[t])) : name;
  }
  // Those in no tetrahedron may be in a part that the mesh does not have.
  void find_points_of_shells() {
    for (Index n = 0; n < input_.region_points.size(); ++n) {
      if (!region_points_.around(n).empty()) continue;
      Shell* shell = shells_->innermost([&](const Shell& other) {
        return region_points_.is_within(n, shells_->faces_of(other));
      });
      if (shell != nullptr) shell->points.push_back(n);
    }
  }

  // --- which parts are asked for
  bool splits_walls() const { return promise_.split_walls != Promise::Split::none; }
  bool asks_for_some() const { return promise_.largest_region || !promise_.region_names.empty(); }

  // What is only asked of names; none where every part is asked for.
  void find_solids() {
    if (promise_.region_names.empty() && promise_.region_sizes.empty() && !splits_walls()) return;
    std::vector<std::vector<std::int32_t>> labels;
    for (const Triangle& t : triangles_) labels.push_back(t.labels);
    solids_ = std::make_unique<Solids>(points_, corners_, labels);
  }
  std::string called(const std::optional<std::int32_t>& label) const {
    const auto known = label ? input_.names.find({2, *label}) : input_.names.end();
    return known == input_.names.end() ? "" : known->second;
  }
  bool is_asked_for(const std::string& name) const {
    return !name.empty() &&
           std::ranges::any_of(promise_.region_names,
                               [&](const std::string& asked) { return is_called(name, asked); });
  }

  // Is the part with this shell around it, which the mesh does not have, to be there?
  bool is_wanted(const Shell& shell) {
    if (std::ranges::any_of(shell.points,
                            [&](Index p) { return input_.region_points[p].is_hole; })) {
      return false;
    }
    if (!asks_for_some()) return true;
    if (!promise_.region_names.empty()) {
      const std::string name = name_by_points(shell.points);
      const Index first = shell.sides.front();
      return is_asked_for(name.empty() ? called(solids_->beside(first / 2, first % 2 != 0)) : name);
    }
    if (!largest_) {
      largest_.emplace();
      for (const auto& [part, volume] : volumes()) {
        largest_ = std::max(*largest_, volume.rounded());
      }
    }
    return shell.volume.rounded() > *largest_ &&
           shells_->without_cavities(shell).rounded() > *largest_;
  }

  // A tetrahedron of each part.
  std::map<Index, Index> parts() {
    std::map<Index, Index> first;
    for (Index t = 0; t < complex_.tetrahedra.size(); ++t) first.try_emplace(part_.find(t), t);
    return first;
  }

  // Names that are asked for are names of labels, where these have any.
  void check_known() {
    if (input_.names.empty() && input_.region_points.empty()) return;
    const auto check = [&](const std::string& name) {
      if (std::ranges::any_of(
              input_.names,
              [&](const auto& set) { return set.first.first == 2 && set.second == name; }) ||
          std::ranges::count(input_.region_points, name, &RegionPoint::name) > 0) {
        return;
      }
      result_.parts.fail("nothing is called \"" + name + "\"");
    };
    std::ranges::for_each(promise_.region_names, check);
    for (const auto& [region, size] : promise_.region_sizes) check(region);
  }

  void check_wanted() {
    check_known();
    if (!asks_for_some()) return;
    const std::map<Index, Index> first = parts();
    if (promise_.largest_region && first.size() > 1) {
      result_.parts.fail("there are " + std::to_string(first.size()) +
                         " parts, promised was the largest");
    }
    if (promise_.region_names.empty()) return;
    for (const auto& [part, t] : first) {
      const std::string name = called(t);
      if (is_asked_for(name)) continue;
      result_.parts.fail(complex_.tet_name(t) + " is of a part that is called \"" + name +
                             "\", which is not promised",
                         complex_.tet_site(t));
    }
  }

  void bound_edges() {
    const bool by_points = std::ranges::any_of(input_.region_points,
                                               [](const RegionPoint& p) { return p.volume > 0; });
    if (promise_.region_sizes.empty() && !by_points) return;
    std::map<Index, double> longest;  // of parts
    for (const auto& [part, t] : parts()) {
      double& most = longest[part] = promise_.max_edge;
      const auto bound = [&most](double size) {
        if (most == 0 || size < most) most = size;
      };
      const std::string name = promise_.region_sizes.empty() ? "" : called(t);
      for (const auto& [region, size] : promise_.region_sizes) {
        if (region == name) bound(size);
      }
      // The edge of the regular tetrahedron of this volume.
      for (const Index n : points_of(t)) {
        const double volume = input_.region_points[n].volume;
        if (volume > 0) bound(std::cbrt(volume * 6 * std::numbers::sqrt2));
      }
    }
    for (Index t = 0; t < complex_.tetrahedra.size(); ++t) {
      result_.longest.push_back(longest[part_.find(t)]);
    }
    for (const Triangle& t : triangles_) {
      for (const Index tet : t.beside) {
        const double most = tet != kNobody ? result_.longest[tet] * EdgeSizes::kMost : 0;
        for (std::size_t k = 0; most > 0 && k < 3; ++k) {
          const double length = exact::distance(points_, t.whole[k], t.whole[(k + 1) % 3]);
          if (length > most) result_.triangles_fit = false;
        }
      }
    }
  }

  // Do faces between them, one region after the other, lie on triangles that are not read?
  bool are_joined(std::int64_t region, std::int64_t other) {
    if (unread_.empty()) return false;
    if (joined_.empty()) find_joined();
    return joined_.at(region) == joined_.at(other);
  }
  void find_joined() {
    std::size_t asked = 0;
    for (const std::int64_t region : mesh_.regions) joined_.try_emplace(region, region);
    for (Index t = 0; t < complex_.tetrahedra.size(); ++t) {
      for (int i = 0; i < 4; ++i) {
        const Index across = neighbours_.across[4 * t + static_cast<Index>(i)];
        if (across == kNone || across / 4 > t) continue;
        const std::int64_t here = joined_[mesh_.regions[t]],
                           there = joined_[mesh_.regions[across / 4]];
        const Face face = face_of(complex_.tetrahedra[t], i);
        if (here == there || triangle_of(face) != kNobody || ++asked > kMostSplit ||
            !lies_on(unread_, face)) {
          continue;
        }
        for (auto& [region, first] : joined_) {
          if (first == there) first = here;
        }
      }
    }
  }

  void check_regions() {
    std::map<Index, std::int64_t> region_of;
    std::map<std::int64_t, Index> part_of;
    for (Index t = 0; t < complex_.tetrahedra.size(); ++t) {
      const Index part = part_.find(t);
      if (mesh_.regions.empty()) {
        region_of.try_emplace(part, 0);
        continue;
      }
      const std::int64_t region = mesh_.regions[t];
      const std::int64_t other = region_of.try_emplace(part, region).first->second;
      if (other != region) {
        fail(result_.regions,
             complex_.tet_name(t) + " is of region " + std::to_string(region) +
                 ", others of its part are of region " + std::to_string(other),
             complex_.tet_site(t), are_joined(region, other));
      } else if (part_of.try_emplace(region, part).first->second != part) {
        result_.regions.fail(complex_.tet_name(t) + " is of region " + std::to_string(region) +
                                 ", and so is another part",
                             complex_.tet_site(t));
      }
    }
    check_order(part_of);
    result_.regions.checked = region_of.size();
    result_.regions.figures.emplace_back("parts", static_cast<double>(region_of.size()));
    if (!mesh_.regions.empty()) return;
    if (region_of.size() > 1 && mesh_.names_sides) {
      result_.regions.fail("the file has no regions, and the input has several");
    } else {
      result_.regions.notes.emplace_back("the file has no regions");
    }
  }

  // Of parts, what their triangles bound as they are given.
  std::map<Index, ExactSum> volumes() {
    std::map<Index, ExactSum> volumes;
    exact::Volume6 volume6;
    for (Index n = 0; n < given_; ++n) {
      const auto& [front, behind] = triangles_[n].beside;
      const ExactNumber& cone = volume6.from_origin(points_, triangles_[n].whole);
      if (front != kNobody) volumes[part_.find(front)] -= cone;
      if (behind != kNobody) volumes[part_.find(behind)] += cone;
    }
    return volumes;
  }

  // The largest part has the least number; those of one volume, as it is rounded to be compared,
  // are in any order.
  void check_order(const std::map<std::int64_t, Index>& part_of) {
    if (!result_.parts.passed()) return;  // they are not what the triangles bound
    const std::map<Index, ExactSum> volumes = this->volumes();
    std::array<std::uint64_t, 2> least = {~std::uint64_t{0}, 0};
    for (const auto& [region, part] : part_of) {
      const auto known = volumes.find(part);
      if (known == volumes.end()) {
        result_.regions.fail("region " + std::to_string(region) + " is bounded by no triangle");
        continue;
      }
      const auto volume = known->second.rounded();
      if (volume > least) {
        result_.regions.fail("region " + std::to_string(region) +
                             " is larger than one of a smaller number");
      }
      least = std::min(least, volume);
    }
  }

  // By a point of the region; the whole region is on the same side, as no triangle enters it.
  void check_names() {
    std::map<std::string, std::set<std::int32_t>> labels;
    for (const auto& [key, text] : input_.names) {
      if (key.first == 2) labels[text].insert(static_cast<std::int32_t>(key.second));
    }
    std::set<std::int64_t> seen;
    for (Index t = 0; t < mesh_.regions.size(); ++t) {
      if (!seen.insert(mesh_.regions[t]).second) continue;
      const auto named = mesh_.names.find({3, mesh_.regions[t]});
      if (named == mesh_.names.end()) continue;
      if (!promise_.region_names.empty() && !is_asked_for(named->second)) {
        result_.regions.fail("region " + std::to_string(mesh_.regions[t]) + " is called " +
                                 named->second + ", which is not promised",
                             complex_.tet_site(t));
      }
      const auto label = labels.find(named->second);
      if (label == labels.end() || label->second.size() > 1) continue;
      std::vector<Face> surface;
      for (const Triangle& triangle : triangles_) {
        if (std::ranges::count(triangle.labels, *label->second.begin()) % 2 != 0) {
          surface.push_back(triangle.corners);
        }
      }
      const RayCrossings above =
          RayTarget(points_, std::move(surface)).above(complex_.tetrahedra[t]);
      if (above.on_triangle || above.count % 2 == 0) {
        result_.regions.fail("region " + std::to_string(mesh_.regions[t]) + " is called " +
                                 named->second + ", and lies outside of that",
                             complex_.tet_site(t));
      }
    }
  }

  // A region with a point of its own is called like that; of several, all but the first with a
  // number after it.
  void check_names_by_points() {
    if (mesh_.regions.empty() || points_of_.empty()) return;
    const auto is_of_region = [](const auto& set) { return set.first.first == 3; };
    if (std::ranges::none_of(mesh_.names, is_of_region)) {
      result_.regions.notes.emplace_back("the file has no names of regions");
      return;
    }
    for (const auto& [part, points] : points_of_) {
      const std::string wanted = name_by_points(points);
      if (wanted.empty()) continue;
      const std::int64_t region = mesh_.regions[region_points_.around(points.front()).front()];
      const auto known = mesh_.names.find({3, region});
      const std::string name = known == mesh_.names.end() ? "" : known->second;
      const auto points_with = std::ranges::count(input_.region_points, wanted, &RegionPoint::name);
      if (name == wanted || (points_with > 1 && is_called(name, wanted))) continue;
      result_.regions.fail("region " + std::to_string(region) + " is called \"" + name +
                           "\", and a point in it calls it \"" + wanted + "\"");
    }
  }

  // Is one of those given as that listed one is? Those of split walls are two of the file.
  bool is_as_given(const Triangle& t, std::size_t listed, bool even) const {
    if (splits_walls() && t.is_wall()) return true;
    const bool labelled = listed < mesh_.labels.size() && !input_.labels.empty();
    for (std::size_t n = 0; n < t.labels.size(); ++n) {
      if (t.even[n] == even && (!labelled || t.labels[n] == mesh_.labels[listed])) return true;
    }
    return false;
  }

  void check_list() {
    if (mesh_.boundary.empty()) {
      if (mesh_.lists_boundary) result_.list.fail("the file lists no triangles");
      return;
    }
    std::vector<std::uint8_t> listed(triangles_.size(), 0);
    result_.list.checked = mesh_.boundary.size();
    std::uint64_t turned = 0;
    for (std::size_t n = 0; n < mesh_.boundary.size(); ++n) {
      Face face = mesh_.boundary[n];
      const std::string what = "listed triangle " + std::to_string(n);
      const Site here = {Site::Kind::listed_triangle, {static_cast<Index>(n), 0, 0}};
      for (Index& v : face) v += complex_.first_vertex;
      const Index t = triangle_of(face);
      if (t == kNobody) {
        fail(result_.list, what + " is none of the input", here, is_explained(face));
        continue;
      }
      if (listed[t]++ != 0) result_.list.fail(what + " is listed twice", here);
      // Which side of a split wall is listed here, and so which label, is seen by its own oracle.
      const bool is_labelled = n < mesh_.labels.size() && !input_.labels.empty() &&
                               !(splits_walls() && triangles_[t].is_wall() &&
                                 result_.pieces.contains(triangles_[t].sorted));
      if (is_labelled && std::ranges::count(triangles_[t].labels, mesh_.labels[n]) == 0) {
        result_.list.fail(what + " has label " + std::to_string(mesh_.labels[n]) + ", and " +
                              name(triangles_[t]) + " has not",
                          here);
      } else if (!is_as_given(triangles_[t], n, sort_face(face))) {
        ++turned;
      }
    }
    if (turned > 0) result_.list.figures.emplace_back(kTurned, static_cast<double>(turned));
    for (Index t = 0; t < triangles_.size(); ++t) {
      if (!triangles_[t].is_bare() && listed[t] == 0) {
        fail(result_.list, name(triangles_[t]) + " is not listed", site(triangles_[t]),
             !unread_.empty() && triangles_[t].is_ambiguous);
      }
    }
  }

  const Polyhedron& input_;
  const MeshFile& mesh_;
  const TetComplex& complex_;
  const Neighbours& neighbours_;
  const ExactPoints& points_;
  const Promise& promise_;
  std::vector<Triangle> triangles_;
  Index given_ = 0;            // so many are given; the others are further parts of these
  std::vector<Face> corners_;  // of the triangles
  std::unique_ptr<Solids> solids_;
  std::map<Face, Index> by_corners_;
  UnionFind part_{0};
  std::optional<Shells> shells_;
  std::optional<std::array<std::uint64_t, 2>> largest_;  // the volume of the largest part, rounded
  RegionPoints region_points_;
  std::map<Index, std::vector<Index>> points_of_;  // of parts
  double near_ = 0;
  bool torn_ = false;         // the mesh has several vertices at one place
  std::vector<Face> strays_;  // faces of one tetrahedron alone that are no triangles
  std::vector<Face> outer_faces_;
  std::optional<RayTarget> outer_;
  // Triangles whose reading is ambiguous, of these those that are no faces, and how many violations
  // of each report they explain; by region the least of those that are one where they are not read.
  std::vector<Face> ambiguous_, unread_;
  std::map<const OracleReport*, std::uint64_t> explained_;
  std::map<std::int64_t, std::int64_t> joined_;
  PartsResult result_;
};

}  // namespace

PartsResult check_parts(const Polyhedron& input, const MeshFile& mesh, const TetComplex& complex,
                        const Neighbours& neighbours, const Promise& promise, double near) {
  return Parts(input, mesh, complex, neighbours, promise).run(near);
}

}  // namespace tetproof::oracles
