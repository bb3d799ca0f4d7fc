#include "oracles/record/same_mesh.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>

#include "oracles/base/buckets.h"
#include "oracles/base/distances.h"
#include "oracles/base/simplex_set.h"
#include "oracles/base/vectors.h"

namespace tetproof::oracles {
namespace {

using delmesher::ExactRecord;

constexpr double kUlps = 4;

template <class Simplex>
Simplex sorted(Simplex simplex) {
  std::sort(simplex.begin(), simplex.end());
  return simplex;
}

struct LabelledFace {
  Face face;
  std::int32_t label;
  Index facet;
  bool even;  // `face` is an even permutation of the face seen from outside
  auto operator<=>(const LabelledFace&) const = default;
};

// A tetrahedron of the file or of the record that the other one does not have, by its points.
struct Difference {
  Tet tet;
  std::size_t index;
  bool written;  // in the file
};

// Differences that are connected over common faces, and their effect.
struct Change {
  std::vector<Difference> differences;
  bool same_surface = true;  // the faces that bound those of the file bound those of the record
};

std::vector<Change> changes_of(const std::vector<Difference>& differences) {
  struct SideOfFace {
    Face face;
    std::size_t difference;
    int sign;  // of the face seen from outside the tetrahedron; the other way in the record
  };
  std::vector<SideOfFace> sides;
  for (std::size_t d = 0; d < differences.size(); ++d) {
    for (int i = 0; i < 4; ++i) {
      Face face = face_of(differences[d].tet, i);
      const bool even = sort_face(face);
      sides.push_back({face, d, even == differences[d].written ? 1 : -1});
    }
  }
  std::ranges::sort(sides, {}, &SideOfFace::face);
  std::vector<std::size_t> change_of(differences.size());
  std::iota(change_of.begin(), change_of.end(), std::size_t{0});
  const auto find = [&](std::size_t d) {
    while (change_of[d] != d) d = change_of[d] = change_of[change_of[d]];
    return d;
  };
  for (std::size_t i = 1; i < sides.size(); ++i) {
    if (sides[i].face != sides[i - 1].face) continue;
    const auto [first, second] =
        std::minmax({find(sides[i].difference), find(sides[i - 1].difference)});
    change_of[second] = first;
  }
  std::map<std::size_t, Change> changes;
  for (std::size_t d = 0; d < differences.size(); ++d) {
    changes[find(d)].differences.push_back(differences[d]);
  }
  for (std::size_t i = 0, end = 0; i < sides.size(); i = end) {
    int sum = 0;
    for (; end < sides.size() && sides[end].face == sides[i].face; ++end) sum += sides[end].sign;
    if (sum != 0) changes[find(sides[i].difference)].same_surface = false;
  }
  std::vector<Change> result;
  for (auto& [first, change] : changes) result.push_back(std::move(change));
  return result;
}

class SameMesh {
 public:
  SameMesh(const MeshFile& mesh, const ExactRecord& record, const Promise& promise,
           const std::vector<std::int32_t>& labels)
      : mesh_(mesh),
        record_(record),
        labels_(labels),
        all_(promise.region == delmesher::Region::hull),
        approximate_(promise.approximate),
        tets_(record.final.empty() ? record.refined : record.final),
        faces_(record.final.empty() ? record.refined_facets : record.final_facets) {}

  OracleReport run() {
    if (record_.mesh_vertices.size() != mesh_.vertices.size()) {
      report_.fail("the record knows " + std::to_string(record_.mesh_vertices.size()) +
                   " written vertices, the file has " + std::to_string(mesh_.vertices.size()));
      return std::move(report_);
    }
    compare_tetrahedra();
    if (!report_.passed()) return std::move(report_);
    if (mesh_.lists_boundary) {
      compare_boundary();
    } else if (!mesh_.boundary.empty()) {
      report_.fail("the file lists boundary triangles, which its format does not have");
    }
    return std::move(report_);
  }

 private:
  struct Sorted {
    Tet tet;
    Index index;
    bool operator<(const Sorted& other) const { return tet < other.tet; }
  };
  // Numbers of tetrahedra by their lowest point. What is no point comes last.
  class ByLowest {
   public:
    explicit ByLowest(std::size_t points)
        : points_(static_cast<Index>(points)), numbers_(points + 1) {}

    void count(const Tet& tet) { numbers_.count(lowest(tet)); }
    void allot() { numbers_.allot(); }
    void put(const Tet& tet, std::size_t t) { numbers_.put(lowest(tet), static_cast<Index>(t)); }
    template <class Corners>
    void get(Index v, const Corners& corners, std::vector<Sorted>& list) const {
      list.clear();
      for (const Index t : numbers_.of(v)) list.push_back({sorted(corners(t)), t});
      std::sort(list.begin(), list.end());
    }

   private:
    Index lowest(const Tet& tet) const {
      return std::min(points_, *std::min_element(tet.begin(), tet.end()));
    }

    Index points_;
    Buckets numbers_;
  };

  // Only the numbers of tetrahedra are held all at once: sorting the tetrahedra themselves takes
  // more memory than both meshes.
  void compare_tetrahedra() {
    const std::size_t points = record_.points.size();
    const auto corners_written = [this](Index t) { return points_of(mesh_.tetrahedra[t]); };
    const auto corners_recorded = [this](Index t) { return tets_[t].vertices; };
    ByLowest by_written(points), by_recorded(points);
    const auto for_each_recorded = [this](const auto& visit) {
      for (std::size_t t = 0; t < tets_.size(); ++t) {
        if (all_ || tets_[t].inside) visit(tets_[t].vertices, t);
      }
    };
    std::size_t recorded_count = 0;
    for (const Tet& tet : mesh_.tetrahedra) by_written.count(points_of(tet));
    for_each_recorded([&](const Tet& tet, std::size_t) {
      by_recorded.count(tet);
      ++recorded_count;
    });
    by_written.allot();
    by_recorded.allot();
    for (std::size_t t = 0; t < mesh_.tetrahedra.size(); ++t) {
      by_written.put(points_of(mesh_.tetrahedra[t]), t);
    }
    for_each_recorded([&](const Tet& tet, std::size_t t) { by_recorded.put(tet, t); });
    report_.checked = mesh_.tetrahedra.size();
    if (mesh_.tetrahedra.empty() && recorded_count == 0 && approximate_) {
      report_.checked = tets_.size();
      report_.notes.emplace_back("nothing of the refined mesh is to be written");
    }
    std::vector<Difference> differences;
    std::vector<Sorted> written, recorded;
    for (std::size_t v = 0; v <= points; ++v) {
      by_written.get(static_cast<Index>(v), corners_written, written);
      by_recorded.get(static_cast<Index>(v), corners_recorded, recorded);
      compare_sorted(written, recorded, differences);
    }
    if (!differences.empty()) judge(differences);
  }

  void compare_sorted(const std::vector<Sorted>& written, const std::vector<Sorted>& recorded,
                      std::vector<Difference>& differences) {
    std::size_t w = 0, r = 0;
    while (w < written.size() || r < recorded.size()) {
      if (r == recorded.size() || (w < written.size() && written[w] < recorded[r])) {
        const Index t = written[w++].index;
        differences.push_back({points_of(mesh_.tetrahedra[t]), t, true});
      } else if (w == written.size() || recorded[r] < written[w]) {
        const Index t = recorded[r++].index;
        differences.push_back({tets_[t].vertices, t, false});
      } else {
        compare_regions(written[w++].index, recorded[r++].index);
      }
    }
  }

  void judge(const std::vector<Difference>& differences) {
    for (Index v = 0; v < record_.mesh_vertices.size(); ++v) {
      written_as_.emplace(record_.mesh_vertices[v], v);
    }
    std::size_t repaired = 0;
    for (const Change& change : changes_of(differences)) {
      if (is_repair(change)) {
        compare_regions(change);
        repaired += change.differences.size();
        continue;
      }
      for (const Difference& d : change.differences) {
        report_.fail("tetrahedron " + std::to_string(d.index) +
                     (d.written ? " of the file is not in the record"
                                : " of the record is not in the file"));
      }
    }
    if (repaired > 0) {
      report_.figures.emplace_back("changed to repair rounding", static_cast<double>(repaired));
    }
  }

  Tet points_of(Tet tet) const {
    for (Index& v : tet) v = v < record_.mesh_vertices.size() ? record_.mesh_vertices[v] : kNone;
    return tet;
  }

  // The record of a refined mesh holds it as it was before it was rounded. Where rounding made a
  // tetrahedron flat or inverted, other tetrahedra of the same points may fill the same place, a
  // few for each; that they are positive and fit together is for the oracles of the file.
  bool is_repair(const Change& change) const {
    constexpr std::size_t kMostForOne = 32;
    if (!record_.final.empty() || !change.same_surface) return false;
    std::size_t spoilt = 0, written = 0;
    for (const Difference& d : change.differences) {
      if (d.written) {
        ++written;
      } else if (sign_as_written(d.tet) <= 0) {
        ++spoilt;
      }
    }
    return written > 0 && change.differences.size() <= kMostForOne * spoilt;
  }

  // 1 also if not all of its corners are written.
  int sign_as_written(const Tet& tet) const {
    std::array<std::array<mpq_class, 3>, 4> p;
    for (std::size_t i = 0; i < 4; ++i) {
      const auto at = written_as_.find(tet[i]);
      if (at == written_as_.end()) return 1;
      const Position& x = mesh_.vertices[at->second];
      for (std::size_t k = 0; k < 3; ++k) {
        if (!std::isfinite(x[k])) return 1;
        p[i][k] = x[k];
      }
    }
    for (std::size_t i = 1; i < 4; ++i) {
      for (std::size_t k = 0; k < 3; ++k) p[i][k] -= p[0][k];
    }
    const mpq_class volume = p[1][0] * (p[2][1] * p[3][2] - p[2][2] * p[3][1]) -
                             p[1][1] * (p[2][0] * p[3][2] - p[2][2] * p[3][0]) +
                             p[1][2] * (p[2][0] * p[3][1] - p[2][1] * p[3][0]);
    return sgn(volume);
  }

  // All of a change is on one side of the surface.
  void compare_regions(const Change& change) {
    const auto recorded = std::ranges::find(change.differences, false, &Difference::written);
    for (const Difference& d : change.differences) {
      if (d.written) {
        compare_regions(d.index, recorded->index);
      } else if (tets_[d.index].inside != tets_[recorded->index].inside) {
        report_.fail("a repair of rounding reaches through the surface at tetrahedron " +
                     std::to_string(d.index) + " of the record");
      }
    }
  }

  // Region 1 is inside. The outside is called 2, or 0 where a format says "inside" or not.
  void compare_regions(std::size_t w, std::size_t r) {
    const bool inside = tets_[r].inside;
    if (!mesh_.inside.empty() && (mesh_.inside[w] != 0) != inside) {
      report_.fail("the file calls tetrahedron " + std::to_string(w) +
                   (inside ? " outside, the record inside" : " inside, the record outside"));
    }
    if (w >= mesh_.regions.size()) {
      // If all tetrahedra are inside, a .tet does not say so.
      if (!inside || mesh_.names_sides || !mesh_.regions.empty()) {
        report_.fail("the file does not say on which side tetrahedron " + std::to_string(w) +
                     " is");
      }
      return;
    }
    const std::int64_t region = mesh_.regions[w];
    if (!inside && region != 1 && !outside_) outside_ = region;
    if (inside ? region != 1 : (region != 0 && region != 2) || region != *outside_) {
      report_.fail("tetrahedron " + std::to_string(w) + " of the file is in region " +
                   std::to_string(region) + ", the record calls it " +
                   (inside ? "inside" : "outside"));
    }
  }

  // A facet's number is that of a triangle of the input. The record's own list lacks facets of the
  // surface as given where another one was refined. 0 if there are no labels, or no such facet.
  std::int32_t label_of(Index facet) const { return facet < labels_.size() ? labels_[facet] : 0; }

  // Which of the faces on facets are faces of the tetrahedra inside (of a refined mesh: of all that
  // are written), and how these are oriented seen from outside their tetrahedron.
  enum class Turned : std::uint8_t { odd, even, no_face };
  std::vector<Turned> turned_in_tets(const SimplexSet<3>& listed) const {
    std::vector<Turned> turned(listed.size(), Turned::no_face);
    for (const ExactRecord::Tet& tet : tets_) {
      if (!tet.inside && !(all_ && record_.final.empty())) continue;
      for (int i = 0; i < 4; ++i) {
        Face face = face_of(tet.vertices, i);
        const bool even = sort_face(face);
        const std::size_t n = listed.find(face);
        if (n < turned.size()) turned[n] = std::min(turned[n], even ? Turned::even : Turned::odd);
      }
    }
    return turned;
  }

  // For a refined mesh only the faces on facets whose tetrahedra are written.
  std::vector<LabelledFace> recorded_faces() const {
    std::vector<Face> corners;
    corners.reserve(faces_.size());
    for (const auto& [a, b, c, id] : faces_) corners.push_back({a, b, c});
    const SimplexSet<3> listed(corners);
    corners = {};
    const std::vector<Turned> turned = turned_in_tets(listed);
    std::vector<LabelledFace> faces;
    faces.reserve(faces_.size());
    for (const auto& [a, b, c, id] : faces_) {
      Face face = {a, b, c};
      bool even = sort_face(face);
      const Turned in_tets = turned[listed.find(face)];
      if (record_.final.empty()) {
        // Tetrahedra on both sides may be written: the faces oracle decides which way it is turned.
        if (in_tets == Turned::no_face) continue;
      } else if (in_tets != Turned::no_face) {
        even = in_tets == Turned::even;
      }
      faces.push_back({face, label_of(id), id, even});
    }
    std::sort(faces.begin(), faces.end());
    return faces;
  }

  void compare_boundary() {
    const std::size_t triangles = mesh_.boundary.size();
    if (mesh_.facets.size() != triangles) {
      report_.fail("the file names " + std::to_string(mesh_.facets.size()) + " facets for " +
                   std::to_string(triangles) + " boundary triangles");
    }
    if (!labels_.empty() && mesh_.labels.size() != triangles) {
      report_.fail("the file has " + std::to_string(mesh_.labels.size()) + " labels for " +
                   std::to_string(triangles) + " boundary triangles");
    }
    if (mesh_.labels_contradict) {
      report_.fail("the file has a group of triangles that is called by the label of another one");
    }
    if (mesh_.groups_differ) {
      report_.fail("the file has elements in no physical group, or in several");
    }
    if (mesh_.tags_shared) {
      report_.fail("the file has a group of triangles and one of tetrahedra with one tag");
    }
    if (mesh_.sides_contradict) {
      report_.fail("the names of the file's regions are not those of their numbers");
    }
    if (mesh_.comments_within) {
      report_.fail("the file has comments where some readers take them for entries");
    }
    if (mesh_.more_than_single) {
      report_.fail(
          "the file says that its coordinates are of single precision, which they are not");
    }
    if (mesh_.boxes_differ) {
      report_.fail("the file has an entity whose box is not that of its elements");
    }
    const std::vector<LabelledFace> recorded = recorded_faces();
    std::vector<std::uint8_t> seen(recorded.size());
    for (std::size_t n = 0; n < mesh_.boundary.size(); ++n) {
      Face face = mesh_.boundary[n];
      for (Index& v : face) v = v < record_.mesh_vertices.size() ? record_.mesh_vertices[v] : kNone;
      const bool even = sort_face(face);
      const auto found = std::lower_bound(
          recorded.begin(), recorded.end(), face,
          [](const LabelledFace& other, const Face& wanted) { return other.face < wanted; });
      const std::string name = "boundary triangle " + std::to_string(n) + " of the file";
      if (found == recorded.end() || found->face != face) {
        report_.fail(name + " is not a face on a facet of the record");
        continue;
      }
      if (n < mesh_.labels.size() && found->label != mesh_.labels[n]) {
        report_.fail(name + " has another label in the record");
      }
      if (n < mesh_.facets.size() && found->facet != mesh_.facets[n]) {
        report_.fail(name + " is on another facet in the record");
      }
      if (found->even != even) report_.fail(name + " is turned inwards");
      if (seen[found - recorded.begin()]++ != 0) report_.fail(name + " is listed twice");
    }
    const auto missing = static_cast<std::size_t>(std::count(seen.begin(), seen.end(), 0));
    if (missing > 0) {
      report_.fail(std::to_string(missing) + " faces on facets are not listed in the file");
    }
  }

  const MeshFile& mesh_;
  const ExactRecord& record_;
  const std::vector<std::int32_t>& labels_;  // per triangle of the input, or empty
  bool all_, approximate_;
  const std::vector<ExactRecord::Tet>& tets_;
  const std::vector<std::array<std::uint32_t, 4>>& faces_;
  std::optional<std::int64_t> outside_;
  std::map<Index, Index> written_as_;  // point -> vertex of the file; if there are differences
  OracleReport report_{"same-mesh", "tetrahedra of the file"};
};

// The square of the exact distance of a written position from the point, in squares of input units.
mpq_class exact_distance2(const Position& written, const ExactPoints& points, Index v) {
  const ExactVector exact = points.exact(v);
  mpq_class sum = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const mpq_class off =
        mpq_class(written[axis]) - times_power_of_two(exact[axis].rational(), points.exponent());
    sum += off * off;
  }
  return sum;
}

}  // namespace

double largest_rounding(const MeshFile& mesh, const ExactRecord& record,
                        const ExactPoints& points) {
  double largest = 0;
  for (std::size_t i = 0; i < std::min(mesh.vertices.size(), record.mesh_vertices.size()); ++i) {
    const Index v = record.mesh_vertices[i];
    const Position& q = mesh.vertices[i];
    const bool finite = std::ranges::all_of(q, [](double x) { return std::isfinite(x); });
    if (v >= points.size() || !finite) continue;  // check_rounding reports them
    if (points.is_double(v) && points.nearest(v) == q) continue;
    largest = std::max(largest, std::sqrt(exact_distance2(q, points, v).get_d()) * (1 + 1e-12));
  }
  return largest;
}

OracleReport check_same_mesh(const MeshFile& mesh, const ExactRecord& record,
                             const Promise& promise, const std::vector<std::int32_t>& labels) {
  return SameMesh(mesh, record, promise, labels).run();
}

OracleReport check_rounding(const MeshFile& mesh, const ExactRecord& record,
                            const ExactPoints& points, const SameMeshOptions& options) {
  OracleReport report("rounding", "written vertices");
  if (record.mesh_vertices.size() != mesh.vertices.size()) {
    report.fail("the record knows " + std::to_string(record.mesh_vertices.size()) +
                " written vertices, the file has " + std::to_string(mesh.vertices.size()));
    return report;
  }
  if (mesh.vertices.empty()) report.checked = 1;  // of a refined mesh; else the promise is broken
  const double gate = std::max(kUlps * options.ulp, options.allowed);
  double largest = 0;
  std::uint64_t moved = 0;
  std::vector<std::uint8_t> used(points.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Index v = record.mesh_vertices[i];
    ++report.checked;
    if (v >= points.size()) {
      report.fail("written vertex " + std::to_string(i) + " is not a point of the record");
      continue;
    }
    if (used[v]++ != 0) {
      report.fail("written vertex " + std::to_string(i) + " is point " + std::to_string(v) +
                  ", as another one is");
    }
    const Position p = points.nearest(v), q = mesh.vertices[i];
    const double distance = oracles::distance(p, q);
    largest = std::max(largest, distance);
    if (v < options.input_vertices && p != q && options.allowed == 0) {
      report.fail("input vertex " + std::to_string(v) + " is not written where it was given");
    }
    // The distance in doubles is off by less than two ulp.
    if (distance <= gate - 2 * options.ulp) continue;
    if (std::isfinite(distance) &&
        exact_distance2(q, points, v) <= mpq_class(gate) * mpq_class(gate)) {
      continue;
    }
    ++moved;
    report.fail("written vertex " + std::to_string(i) + " is " +
                std::to_string(distance / options.ulp) + " ulp from its exact place");
  }
  report.figures.emplace_back("largest distance", largest);
  report.figures.emplace_back("moved by more than 4 ulp", static_cast<double>(moved));
  return report;
}

}  // namespace tetproof::oracles
