#include "oracles/record/enrichment.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "oracles/base/distances.h"
#include "oracles/mesh/angles.h"

namespace tetproof::oracles {
namespace {

using delmesher::ExactPoint;
using delmesher::ExactRecord;

bool lies_on_surface(const ExactPoints& points, const InputSurface& surface, Index v) {
  std::vector<Index> found;
  surface.triangles_near(box_around(points, std::array{v}), found);
  return std::any_of(found.begin(), found.end(),
                     [&](Index t) { return lies_on_face(points, v, surface.triangles()[t]); });
}

class Enrichment {
 public:
  explicit Enrichment(const RefinedMesh& mesh)
      : mesh_(mesh),
        record_(*mesh.record),
        points_(*mesh.points),
        surface_(*mesh.surface),
        complex_(*mesh.complex),
        facets_(surface_, record_),
        inputs_(mesh.input_vertices),
        enriched_(record_.unrepaired.empty() ? record_.final : record_.unrepaired),
        refined_(used_in(complex_)),
        final_(used_in(enriched_, points_.size())) {}

  OracleReport run() {
    check_vertices();
    if (mesh_.promise->enrichment || !is_plain()) check_missing();
    report_.figures.emplace_back("left out in chamfers", in_chamfer_);
    report_.figures.emplace_back("left out on artificial segments", on_artificial_);
    report_.figures.emplace_back("left out beside dropped facets", crowded_);
    return std::move(report_);
  }

 private:
  struct Round {  // a sphere around a corner, or a cylinder around an edge
    Index a, b;
    double radius;
  };

  void check_vertices() {
    std::uint64_t on_surface = 0;
    for (Index v = 0; v < points_.size(); ++v) {
      if (final_[v] == 0) continue;
      ++report_.checked;
      if (v < inputs_ || refined_[v] != 0) continue;
      ++on_surface;
      if (!lies_on_surface(points_, surface_, v)) {
        report_.fail(
            complex_.vertex_name(v) +
            " of the final mesh is not a vertex of the refined one and not on the surface");
      }
    }
    report_.figures.emplace_back("new on the surface", static_cast<double>(on_surface));
  }

  // Has the final mesh no vertices but those of the input, and does it keep the bound?
  bool is_plain() {
    constexpr std::size_t kMostTriangles = 1000;
    for (Index v = 0; v < points_.size(); ++v) {
      if (final_[v] != 0 && v >= inputs_) return false;
    }
    const Promise& promise = *mesh_.promise;
    if (promise.region != delmesher::Region::interior || promise.max_edge > 0 ||
        !promise.size_field.empty() || surface_.triangles().size() > kMostTriangles) {
      return false;
    }
    TetComplex plain{&points_, {}, {}, 0, 0};
    for (const ExactRecord::Tet& tet : enriched_) {
      plain.tetrahedra.push_back(tet.vertices);
      plain.inside.push_back(tet.inside);
    }
    Neighbours neighbours;
    if (!check_complex(plain, neighbours).passed()) return false;
    const bool good = check_angles(plain, neighbours, Places(plain, neighbours, surface_),
                                   promise.guaranteed_delta(), AngleScope::solid)
                          .passed();
    if (good) report_.notes.emplace_back("the input alone keeps the bound: it was not enriched");
    return good;
  }

  void check_missing() {
    std::vector<Index> missing;
    for (Index v = inputs_; v < points_.size(); ++v) {
      if (refined_[v] == 0) continue;
      ++report_.checked;
      if (final_[v] == 0) missing.push_back(v);
    }
    for (Index v = 0; v < inputs_; ++v) {
      if (refined_[v] != 0 && final_[v] == 0) {
        report_.fail("input vertex " + std::to_string(v) + " is in the refined mesh only");
      }
    }
    if (missing.empty()) return;
    volume_.resize(points_.size());
    for (const ExactRecord::Ball& ball : record_.balls) volume_[ball.vertex] = 1;
    collect_rounds();
    collect_artificial();
    collect_spacings(missing);
    for (const Index v : missing) {
      if (artificial_[v] != 0 && !mesh_.promise->kept_points) {
        ++on_artificial_;
      } else if (coincides(v)) {
        continue;
      } else if (volume_[v] == 0) {
        report_.fail(complex_.vertex_name(v) +
                     " of the refined mesh is on the surface or the box " +
                     "and not in the final mesh");
      } else if (in_chamfer(v)) {
        ++in_chamfer_;
      } else if (crowded(v)) {
        ++crowded_;
      } else {
        report_.fail(complex_.vertex_name(v) +
                     " of the refined mesh is not in the final mesh, and in no chamfer");
      }
    }
  }

  void collect_artificial() {
    artificial_.resize(points_.size());
    std::vector<std::uint8_t> on_edge(points_.size());
    for (const ExactRecord::Chain& chain : record_.segments) {
      for (const Index v : chain.vertices) (chain.artificial ? artificial_ : on_edge)[v] = 1;
    }
    for (std::size_t v = 0; v < on_edge.size(); ++v) {
      if (on_edge[v] != 0) artificial_[v] = 0;
    }
  }

  void collect_rounds() {
    std::unordered_map<Index, double> radius;
    std::unordered_map<Index, Index> made_for;
    for (const ExactRecord::Corner& corner : record_.corners)
      radius[corner.vertex] = corner.distance;
    for (const auto& [point, vertex] : record_.chamfer_points) {
      made_for[point] = vertex;
      double& r = radius[vertex];
      r = std::max(r, exact::distance(points_, point, vertex));
    }
    for (const auto& [v, r] : radius) rounds_.push_back({v, v, r});
    const InputEdges edges(surface_);
    for (const ExactRecord::Chain& chain : record_.segments) {
      if (!chain.artificial || chain.vertices.size() < 2) continue;
      const auto u = made_for.find(chain.vertices.front()),
                 w = made_for.find(chain.vertices.back());
      if (u == made_for.end() || w == made_for.end() || u->second == w->second) continue;
      if (edges.find(u->second, w->second) == kNone) continue;
      double width = 0;
      for (const Index p : {chain.vertices.front(), chain.vertices.back()}) {
        width = std::max(width,
                         square_root(squared_distance_to_segment(points_, p, u->second, w->second),
                                     points_.exponent()));
      }
      rounds_.push_back({u->second, w->second, width});
    }
    std::vector<BoxTree::Box> boxes;
    for (const Round& round : rounds_) {
      boxes.push_back(enlarged(box_around(points_, std::array{round.a, round.b}), round.radius));
    }
    if (!boxes.empty()) round_tree_ = std::make_unique<BoxTree>(std::move(boxes));
  }

  bool in_chamfer(Index v) {
    if (!round_tree_) return false;
    found_.clear();
    round_tree_->query(box_around(points_, std::array{v}), found_);
    return std::any_of(found_.begin(), found_.end(), [&](Index n) {
      const Round& round = rounds_[n];
      const double distance =
          round.a == round.b
              ? exact::distance(points_, v, round.a)
              : square_root(squared_distance_to_segment(points_, v, round.a, round.b),
                            points_.exponent());
      return distance < round.radius * (1 + 1e-9);
    });
  }

  // The distances of the missing vertices from their nearest neighbours.
  void collect_spacings(const std::vector<Index>& missing) {
    for (const Index v : missing) spacing_[v] = std::numeric_limits<double>::infinity();
    for (const Tet& tet : complex_.tetrahedra) {
      for (const Index v : tet) {
        const auto at = spacing_.find(v);
        if (at == spacing_.end()) continue;
        for (const Index w : tet) {
          if (w != v) at->second = std::min(at->second, exact::distance(points_, v, w));
        }
      }
    }
  }

  bool crowded(Index v) {
    constexpr double kCrowding = 0.3;
    const double share = mesh_.promise->kept_points ? 0x1p-20 : 1;
    const double reach = share * kCrowding * spacing_.at(v) * (1 + 1e-9);
    found_.clear();
    surface_.triangles_near(enlarged(box_around(points_, std::array{v}), reach), found_);
    return std::any_of(found_.begin(), found_.end(), [&](Index t) {
      if (facets_.kept(surface_.facet_of_triangle()[t])) return false;
      const mpq_class square = squared_distance_to_triangle(points_, v, surface_.triangles()[t]);
      return square_root(square, points_.exponent()) <= reach;
    });
  }

  bool coincides(Index v) {
    found_.clear();
    surface_.triangles_near(box_around(points_, std::array{v}), found_);
    return std::any_of(found_.begin(), found_.end(), [&](Index t) {
      const auto& corners = surface_.triangles()[t];
      return std::any_of(corners.begin(), corners.end(),
                         [&](Index w) { return exact::equal(points_, v, w); });
    });
  }

  const RefinedMesh& mesh_;
  const ExactRecord& record_;
  const ExactPoints& points_;
  const InputSurface& surface_;
  const TetComplex& complex_;
  const FacetIndex facets_;
  Index inputs_;
  const std::vector<ExactRecord::Tet>& enriched_;
  std::vector<std::uint8_t> refined_, final_, artificial_, volume_;
  std::vector<Round> rounds_;
  std::unique_ptr<BoxTree> round_tree_;
  std::unordered_map<Index, double> spacing_;
  std::vector<Index> found_;
  double in_chamfer_ = 0, on_artificial_ = 0, crowded_ = 0;
  OracleReport report_{"enrichment", "vertices of both meshes"};
};

}  // namespace

std::vector<std::uint8_t> used_in(const std::vector<ExactRecord::Tet>& tets, std::size_t points) {
  std::vector<std::uint8_t> used(points);
  for (const ExactRecord::Tet& tet : tets) {
    for (const Index v : tet.vertices) used[v] = 1;
  }
  return used;
}

std::vector<std::uint8_t> used_in(const TetComplex& complex) {
  std::vector<std::uint8_t> used(complex.points->size());
  for (const Tet& tet : complex.tetrahedra) {
    for (const Index v : tet) used[v] = 1;
  }
  return used;
}

OracleReport check_enrichment(const RefinedMesh& mesh) {
  return Enrichment(mesh).run();
}

OracleReport check_origins(const ExactRecord& record, const ExactPoints& points,
                           const InputSurface& surface, Index input_vertices) {
  OracleReport report("origins", "vertices");
  const std::vector<std::uint8_t> used = used_in(record.final, points.size());
  std::uint64_t fresh = 0;
  for (Index v = 0; v < points.size(); ++v) {
    report.checked += used[v];
    if (used[v] == 0 || v < input_vertices) continue;
    ++fresh;
    if (!lies_on_surface(points, surface, v)) {
      report.fail("vertex " + std::to_string(v) + " is neither of the input nor on the surface");
    }
  }
  report.figures.emplace_back("new on the surface", static_cast<double>(fresh));
  return report;
}

}  // namespace tetproof::oracles
