#include "oracles/same_mesh.h"

#include <algorithm>
#include <cmath>
#include <map>

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
  auto operator<=>(const LabelledFace&) const = default;
};

class SameMesh {
 public:
  SameMesh(const MeshFile& mesh, const ExactRecord& record, const Promise& promise, bool labelled)
      : mesh_(mesh),
        record_(record),
        labelled_(labelled && mesh.labels.size() == mesh.boundary.size()),
        all_(promise.region == delmesher::Region::hull),
        tets_(record.final.empty() ? record.refined : record.final),
        faces_(record.final.empty() ? record.refined_facets : record.final_facets) {}

  OracleReport run() {
    if (record_.mesh_vertices.size() != mesh_.vertices.size()) {
      report_.fail("the record knows " + std::to_string(record_.mesh_vertices.size()) +
                   " written vertices, the file has " + std::to_string(mesh_.vertices.size()));
      return std::move(report_);
    }
    compare_tetrahedra();
    if (!mesh_.boundary.empty() && report_.passed()) compare_boundary();
    return std::move(report_);
  }

 private:
  struct Written {
    Tet tet;
    std::size_t index;
    bool operator<(const Written& other) const { return tet < other.tet; }
  };

  void compare_tetrahedra() {
    std::vector<Written> written, recorded;
    written.reserve(mesh_.tetrahedra.size());
    for (std::size_t t = 0; t < mesh_.tetrahedra.size(); ++t) {
      Tet tet = mesh_.tetrahedra[t];
      for (Index& v : tet) v = v < record_.mesh_vertices.size() ? record_.mesh_vertices[v] : kNone;
      written.push_back({sorted(tet), t});
    }
    for (std::size_t t = 0; t < tets_.size(); ++t) {
      if (all_ || tets_[t].inside) recorded.push_back({sorted(tets_[t].vertices), t});
    }
    std::sort(written.begin(), written.end());
    std::sort(recorded.begin(), recorded.end());
    report_.checked = written.size();
    std::size_t w = 0, r = 0;
    while (w < written.size() || r < recorded.size()) {
      if (r == recorded.size() || (w < written.size() && written[w] < recorded[r])) {
        report_.fail("tetrahedron " + std::to_string(written[w++].index) +
                     " of the file is none of the record");
      } else if (w == written.size() || recorded[r] < written[w]) {
        report_.fail("tetrahedron " + std::to_string(recorded[r++].index) +
                     " of the record is not in the file");
      } else {
        compare_regions(written[w++].index, recorded[r++].index);
      }
    }
  }

  // No region number stands for tetrahedra on both sides.
  void compare_regions(std::size_t w, std::size_t r) {
    if (mesh_.regions.empty()) return;
    const bool inside = tets_[r].inside;
    const auto [known, fresh] = side_.emplace(mesh_.regions[w], inside);
    if (!fresh && known->second != inside) {
      report_.fail("tetrahedron " + std::to_string(w) + " of the file is in region " +
                   std::to_string(mesh_.regions[w]) + ", the record calls it " +
                   (inside ? "inside" : "outside"));
    }
  }

  std::map<Index, std::int32_t> labels_of_facets() const {
    std::map<Index, std::int32_t> labels;
    for (const ExactRecord::Facet& facet : record_.facets) labels[facet.id] = facet.label;
    return labels;
  }

  // Of a refined mesh, those faces on facets are listed whose tetrahedra are written.
  std::vector<LabelledFace> recorded_faces() const {
    std::vector<Face> of_tets;
    if (record_.final.empty()) {
      for (const ExactRecord::Tet& tet : tets_) {
        if (!all_ && !tet.inside) continue;
        for (int i = 0; i < 4; ++i) of_tets.push_back(sorted(face_of(tet.vertices, i)));
      }
      std::sort(of_tets.begin(), of_tets.end());
    }
    const std::map<Index, std::int32_t> labels = labels_of_facets();
    std::vector<LabelledFace> faces;
    for (const auto& [a, b, c, id] : faces_) {
      const Face face = sorted(Face{a, b, c});
      if (record_.final.empty() && !std::binary_search(of_tets.begin(), of_tets.end(), face)) {
        continue;
      }
      const auto label = labels.find(id);
      faces.push_back({face, labelled_ && label != labels.end() ? label->second : 0});
    }
    std::sort(faces.begin(), faces.end());
    return faces;
  }

  std::vector<Face> hull_faces() const {
    std::vector<Face> faces, once;
    if (!all_) return once;
    for (const ExactRecord::Tet& tet : tets_) {
      for (int i = 0; i < 4; ++i) faces.push_back(sorted(face_of(tet.vertices, i)));
    }
    std::sort(faces.begin(), faces.end());
    for (std::size_t i = 0; i < faces.size(); ++i) {
      const bool pair = i + 1 < faces.size() && faces[i + 1] == faces[i];
      if (!pair) once.push_back(faces[i]);
      i += pair;
    }
    return once;
  }

  void compare_boundary() {
    const std::vector<LabelledFace> recorded = recorded_faces();
    const std::vector<Face> hull = hull_faces();
    std::vector<std::uint8_t> seen(recorded.size());
    for (std::size_t n = 0; n < mesh_.boundary.size(); ++n) {
      Face face = mesh_.boundary[n];
      for (Index& v : face) v = v < record_.mesh_vertices.size() ? record_.mesh_vertices[v] : kNone;
      const LabelledFace listed = {sorted(face), labelled_ ? mesh_.labels[n] : 0};
      const auto found = std::lower_bound(
          recorded.begin(), recorded.end(), listed.face,
          [](const LabelledFace& other, const Face& wanted) { return other.face < wanted; });
      const std::string name = "boundary triangle " + std::to_string(n) + " of the file";
      if (found == recorded.end() || found->face != listed.face) {
        if (std::binary_search(hull.begin(), hull.end(), listed.face)) continue;
        report_.fail(name + " is no face on a facet of the record");
        continue;
      }
      if (found->label != listed.label) report_.fail(name + " has another label in the record");
      if (seen[found - recorded.begin()]++ != 0) report_.fail(name + " is listed twice");
    }
    const auto missing = static_cast<std::size_t>(std::count(seen.begin(), seen.end(), 0));
    if (missing > 0) {
      report_.fail(std::to_string(missing) + " faces on facets are not listed in the file");
    }
  }

  const MeshFile& mesh_;
  const ExactRecord& record_;
  bool labelled_, all_;
  const std::vector<ExactRecord::Tet>& tets_;
  const std::vector<std::array<std::uint32_t, 4>>& faces_;
  std::map<std::int64_t, bool> side_;
  OracleReport report_{"same-mesh", "tetrahedra of the file"};
};

// The exact distance of a written coordinate from the point, squared and summed, in input units.
mpq_class exact_distance2(const Position& written, const ExactPoints& points, Index v) {
  mpq_class sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    mpq_class place(points.integer(v)[axis]);
    const long e = points.exponent();
    if (e >= 0) {
      mpq_mul_2exp(place.get_mpq_t(), place.get_mpq_t(), static_cast<unsigned long>(e));
    } else {
      mpq_div_2exp(place.get_mpq_t(), place.get_mpq_t(), static_cast<unsigned long>(-e));
    }
    const mpq_class off = mpq_class(written[axis]) - place;
    sum += off * off;
  }
  return sum;
}

}  // namespace

OracleReport check_same_mesh(const MeshFile& mesh, const ExactRecord& record,
                             const Promise& promise, bool labelled) {
  return SameMesh(mesh, record, promise, labelled).run();
}

OracleReport check_rounding(const MeshFile& mesh, const ExactRecord& record,
                            const ExactPoints& points, const SameMeshOptions& options) {
  OracleReport report("rounding", "written vertices");
  if (record.mesh_vertices.size() != mesh.vertices.size()) {
    report.fail("the record knows " + std::to_string(record.mesh_vertices.size()) +
                " written vertices, the file has " + std::to_string(mesh.vertices.size()));
    return report;
  }
  const double gate = std::max(kUlps * options.ulp, options.allowed);
  double largest = 0;
  std::uint64_t moved = 0;
  std::vector<std::uint8_t> used(points.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Index v = record.mesh_vertices[i];
    ++report.checked;
    if (v >= points.size()) {
      report.fail("written vertex " + std::to_string(i) + " is no point of the record");
      continue;
    }
    if (used[v]++ != 0) {
      report.fail("written vertex " + std::to_string(i) + " is point " + std::to_string(v) +
                  ", as another one is");
    }
    const Position p = points.nearest(v), q = mesh.vertices[i];
    const double distance = std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
    largest = std::max(largest, distance);
    // What doubles say of it is off by less than two ulp.
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
