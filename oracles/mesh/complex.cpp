#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "oracles/base/buckets.h"
#include "oracles/mesh/tet_complex.h"

namespace tetproof::oracles {
namespace {

// A face, listed among the faces with the same lowest corner. The other two corners are one number,
// as most of the time goes into comparing them.
struct FaceRecord {
  std::uint64_t corners;
  Index opposite;  // the tetrahedron's fourth corner
  Index packed;
  static std::uint64_t pack(const Face& sorted) {
    return static_cast<std::uint64_t>(sorted[1]) << 32 | sorted[2];
  }
  Index middle() const { return static_cast<Index>(corners >> 32); }
  Index high() const { return static_cast<Index>(corners); }
  Index tet_face() const { return packed & ~kEven; }
  bool even() const { return (packed & kEven) != 0; }
  // Set if the face sorted is an even permutation of the face seen from outside.
  static constexpr Index kEven = 0x80000000U;
  auto operator<=>(const FaceRecord&) const = default;
};

// The corners of a tetrahedron, ascending.
Tet ascending(const Tet& tet) {
  const auto [a, b] = std::minmax(tet[0], tet[1]);
  const auto [c, d] = std::minmax(tet[2], tet[3]);
  const auto [second, third] = std::minmax(std::max(a, c), std::min(b, d));
  return {std::min(a, c), second, third, std::max(b, d)};
}

// Indices in range, four different corners. Returns false if faces make no sense.
bool check_corners(const TetComplex& complex, OracleReport& report) {
  bool usable = true;
  for (Index t = 0; t < complex.tetrahedra.size(); ++t) {
    const Tet corners = ascending(complex.tetrahedra[t]);
    if (corners[3] >= complex.points->size() || corners[0] < complex.first_vertex) {
      report.fail(complex.tet_name(t) + " has a corner out of range", complex.tet_site(t));
      usable = false;
    } else if (std::adjacent_find(corners.begin(), corners.end()) != corners.end()) {
      report.fail(complex.tet_name(t) + " repeats a corner", complex.tet_site(t));
      usable = false;
    }
  }
  return usable;
}

std::vector<std::uint8_t> used_by(const TetComplex& complex, const auto& cells) {
  std::vector<std::uint8_t> used(complex.points->size(), 0);
  for (const auto& cell : cells) {
    for (const Index v : cell) used[v] = 1;
  }
  return used;
}

std::int64_t count_used(const TetComplex& complex, const auto& cells) {
  const std::vector<std::uint8_t> used = used_by(complex, cells);
  return std::count(used.begin(), used.end(), 1);
}

// Returns how many vertices are used.
std::int64_t check_used(const TetComplex& complex, OracleReport& report) {
  const std::vector<std::uint8_t> used = used_by(complex, complex.tetrahedra);
  for (Index v = complex.first_vertex; v < complex.last_vertex; ++v) {
    if (used[v]) continue;
    report.fail(complex.vertex_name(v) + " belongs to no tetrahedron", complex.vertex_site(v));
  }
  return std::count(used.begin(), used.end(), 1);
}

// Every edge of the boundary faces is traversed as often in one direction as in the other. Returns
// the number of edges.
std::int64_t check_closed(const TetComplex& complex, const std::vector<Face>& boundary,
                          OracleReport& report) {
  std::vector<std::array<Index, 3>> edges;  // low, high, direction
  edges.reserve(3 * boundary.size());
  for (const Face& face : boundary) {
    for (int i = 0; i < 3; ++i) {
      const Index a = face[i], b = face[(i + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), a < b});
    }
  }
  std::sort(edges.begin(), edges.end());
  std::int64_t distinct = 0;
  for (std::size_t i = 0; i < edges.size(); ++distinct) {
    std::size_t j = i;
    std::int64_t balance = 0;
    for (; j < edges.size() && edges[j][0] == edges[i][0] && edges[j][1] == edges[i][1]; ++j) {
      balance += edges[j][2] ? 1 : -1;
    }
    if (balance != 0) {
      report.fail("the boundary is open at edge " + complex.vertex_name(edges[i][0]) + " - " +
                      complex.vertex_name(edges[i][1]),
                  complex.edge_site(edges[i][0], edges[i][1]));
    }
    i = j;
  }
  return distinct;
}

struct Counts {
  std::uint64_t faces = 0;
  std::int64_t edges = 0, vertices = 0;
};

void check_euler(const TetComplex& complex, const Counts& counts, const std::vector<Face>& boundary,
                 std::int64_t boundary_edges, bool is_part, OracleReport& report) {
  const std::int64_t euler = counts.vertices - counts.edges +
                             static_cast<std::int64_t>(counts.faces) -
                             static_cast<std::int64_t>(complex.tetrahedra.size());
  const std::int64_t of_boundary =
      count_used(complex, boundary) - boundary_edges + static_cast<std::int64_t>(boundary.size());
  report.figures.emplace_back("Euler characteristic", euler);
  if (2 * euler != of_boundary && !is_part) {
    report.fail("the Euler characteristic is " + std::to_string(euler) + ", that of the boundary " +
                std::to_string(of_boundary) + " and not twice as much");
  }
}

// Finds the neighbours across one face, or that it is a boundary face, and reports what is wrong.
void match_face(const TetComplex& complex, const Face& sorted, std::span<const FaceRecord> faces,
                Neighbours& neighbours, std::vector<Face>& boundary, OracleReport& report) {
  // Duplicates are reported once, at the face without the highest corner.
  for (std::size_t i = 1; i < faces.size(); ++i) {
    if (faces[i].opposite == faces[i - 1].opposite && faces[i].opposite > sorted[2]) {
      report.fail(complex.tet_name(faces[i].tet_face() / 4) + " duplicates " +
                      complex.tet_name(faces[i - 1].tet_face() / 4),
                  complex.tet_site(faces[i].tet_face() / 4));
    }
  }
  const Index first = faces[0].tet_face();
  if (faces.size() == 1) {
    boundary.push_back(face_of(complex.tetrahedra[first / 4], static_cast<int>(first % 4)));
    return;
  }
  if (faces.size() > 2) {
    report.fail(
        complex.face_name(sorted) + " belongs to " + std::to_string(faces.size()) + " tetrahedra",
        complex.face_site(sorted));
    return;
  }
  const Index second = faces[1].tet_face();
  if (faces[0].even() == faces[1].even()) {
    report.fail(complex.face_name(sorted) + " has both its tetrahedra, " +
                    std::to_string(first / 4) + " and " + std::to_string(second / 4) +
                    ", on the same side",
                complex.face_site(sorted));
  }
  neighbours.across[first] = second;
  neighbours.across[second] = first;
}

// The faces with some vertices as their lowest corners, and the edges between the two highest
// corners of tetrahedra with some as their lower ends, by vertex. Only their numbers are held:
// sorting the faces themselves takes four times the memory and most of the time. All vertices at
// once would take as much memory again as the mesh.
class ByLowest {
 public:
  ByLowest(const TetComplex& complex, Index first, Index last)
      : complex_(complex), first_(first), last_(last), faces_(last - first), edges_(last - first) {
    for_each([this](Index v, Index) { faces_.count(v); },
             [this](Index v, Index) { edges_.count(v); });
    faces_.allot();
    edges_.allot();
    for_each([this](Index v, Index tet_face) { faces_.put(v, tet_face); },
             [this](Index v, Index other) { edges_.put(v, other); });
  }
  std::span<const Index> faces(Index v) const { return faces_.of(v - first_); }  // 4 * tet + face
  std::span<const Index> higher_ends(Index v) const { return edges_.of(v - first_); }

  // Where vertices are divided, so that each part has about the same number of these.
  static std::vector<Index> parts(const TetComplex& complex) {
    constexpr std::size_t kParts = 4;
    const auto vertices = static_cast<Index>(complex.points->size());
    std::vector<Index> count(vertices);
    for (const Tet& tet : complex.tetrahedra) {
      const Tet sorted = ascending(tet);
      count[sorted[0]] += 3;
      count[sorted[1]] += 1;
      count[sorted[2]] += 1;
    }
    const std::size_t most = 5 * complex.tetrahedra.size() / kParts + 1;
    std::vector<Index> parts = {0};
    std::size_t sum = 0;
    for (Index v = 0; v < vertices; ++v) {
      if (sum > 0 && sum + count[v] > most) {
        parts.push_back(v);
        sum = 0;
      }
      sum += count[v];
    }
    parts.push_back(vertices);
    return parts;
  }

 private:
  // The lowest corner of a face is that of the tetrahedron, or else the second one.
  template <class Face, class Edge>
  void for_each(const Face& face, const Edge& edge) {
    for (Index t = 0; t < complex_.tetrahedra.size(); ++t) {
      const Tet& tet = complex_.tetrahedra[t];
      const Tet sorted = ascending(tet);
      for (Index i = 0; i < 4; ++i) {
        const Index lowest = sorted[tet[i] == sorted[0] ? 1 : 0];
        if (lowest >= first_ && lowest < last_) face(lowest - first_, 4 * t + i);
      }
      if (sorted[2] >= first_ && sorted[2] < last_) edge(sorted[2] - first_, sorted[3]);
    }
  }

  const TetComplex& complex_;
  Index first_, last_;
  Buckets faces_, edges_;
};

// The faces with one lowest corner that have a partner: the same face of another tetrahedron, from
// the other side. Most have one, and few have the same middle corner: sorting takes far longer.
class Partners {
 public:
  explicit Partners(std::size_t vertices) : first_(vertices, kNone) {}

  // False if more than two tetrahedra have a face, or two have it on the same side, or the same
  // four corners; or if so many faces have a middle corner in common that sorting is faster.
  bool find(const std::vector<FaceRecord>& faces) {
    constexpr std::size_t kSteps = 64;  // for each face
    const std::uint64_t most = compared_ + kSteps * faces.size();
    of_.assign(faces.size(), kNone);
    next_.resize(faces.size());
    for (const FaceRecord& face : faces) first_[face.middle()] = kNone;
    for (Index f = 0; f < faces.size(); ++f) {
      Index& first = first_[faces[f].middle()];
      Index other = first;
      while (other != kNone && faces[other].corners != faces[f].corners) {
        if (++compared_ == most) return false;
        other = next_[other];
      }
      if (other == kNone) {
        next_[f] = first;
        first = f;
      } else if (of_[other] != kNone || faces[other].even() == faces[f].even() ||
                 faces[other].opposite == faces[f].opposite) {
        return false;
      } else {
        of_[other] = f;
        of_[f] = other;
      }
    }
    return true;
  }
  // kNone: none.
  Index of(Index face) const { return of_[face]; }
  // How many pairs of faces were compared.
  std::uint64_t compared() const { return compared_; }

 private:
  std::uint64_t compared_ = 0;
  std::vector<Index> first_;  // by middle corner: the last face that had no partner then
  std::vector<Index> next_,
      of_;  // per face: the one before it with the same middle corner, its partner
};

// An edge of a tetrahedron is found at its lower end: from a face with that as its lowest corner,
// unless the edge is between the two highest corners.
Counts match_faces(const TetComplex& complex, Neighbours& neighbours, std::vector<Face>& boundary,
                   OracleReport& report) {
  std::vector<FaceRecord> faces;
  Partners partners(complex.points->size());
  std::vector<Index> seen_from(complex.points->size(), kNone);
  Counts counts;
  const std::vector<Index> parts = ByLowest::parts(complex);
  std::optional<ByLowest> by_lowest;
  std::size_t part = 0;
  for (Index v = 0; v < complex.points->size(); ++v) {
    if (v == parts[part]) {
      by_lowest.reset();  // first, for less memory
      by_lowest.emplace(complex, parts[part], parts[part + 1]);
      ++part;
    }
    const auto see = [&](Index other) {
      counts.edges += seen_from[other] != v;
      seen_from[other] = v;
    };
    faces.clear();
    for (const Index i : by_lowest->faces(v)) {
      const Tet& tet = complex.tetrahedra[i / 4];
      Face face = face_of(tet, static_cast<int>(i % 4));
      const bool even = sort_face(face);
      see(face[1]);
      see(face[2]);
      faces.push_back({FaceRecord::pack(face), tet[i % 4], i | (even ? FaceRecord::kEven : 0)});
    }
    for (const Index other : by_lowest->higher_ends(v)) see(other);
    if (partners.find(faces)) {
      for (Index f = 0; f < faces.size(); ++f) {
        const Index here = faces[f].tet_face(), other = partners.of(f);
        counts.faces += other == kNone || f < other;
        if (other == kNone) {
          boundary.push_back(face_of(complex.tetrahedra[here / 4], static_cast<int>(here % 4)));
        } else {
          neighbours.across[here] = faces[other].tet_face();
        }
      }
      continue;
    }
    // If something is wrong, it is reported in order.
    std::sort(faces.begin(), faces.end(), [&](const FaceRecord& a, const FaceRecord& b) {
      ++neighbours.compared;
      return a < b;
    });
    for (std::size_t i = 0; i < faces.size(); ++counts.faces) {
      std::size_t j = i + 1;
      while (j < faces.size() && faces[j].corners == faces[i].corners) ++j;
      match_face(complex, {v, faces[i].middle(), faces[i].high()},
                 std::span(faces).subspan(i, j - i), neighbours, boundary, report);
      i = j;
    }
  }
  neighbours.compared += partners.compared();
  return counts;
}

}  // namespace

std::string TetComplex::vertex_name(Index v) const {
  return v < first_vertex ? "input vertex " + std::to_string(v)
                          : "vertex " + std::to_string(v - first_vertex);
}

std::string TetComplex::tet_name(std::size_t t) const {
  std::string name = "tetrahedron " + std::to_string(t) + " (";
  for (int i = 0; i < 4; ++i) {
    name += (i ? " " : "") + std::to_string(tetrahedra[t][i] - first_vertex);
  }
  return name + ")";
}

std::string TetComplex::face_name(const Face& face) const {
  std::string name = "face (";
  for (int i = 0; i < 3; ++i) name += (i ? " " : "") + std::to_string(face[i] - first_vertex);
  return name + ")";
}

OracleReport check_complex(const TetComplex& complex, Neighbours& neighbours, bool is_part) {
  OracleReport report("complex", "tetrahedra");
  report.checked = complex.tetrahedra.size();
  neighbours.across.assign(4 * complex.tetrahedra.size(), kNone);
  neighbours.compared = 0;
  if (complex.tetrahedra.empty() && !is_part) report.fail("there are no tetrahedra");
  if (complex.tetrahedra.size() >= FaceRecord::kEven / 4) {
    report.fail("there are more tetrahedra than this program can number");
    return report;
  }
  if (!check_corners(complex, report)) return report;
  const std::int64_t vertices = check_used(complex, report);

  std::vector<Face> boundary;
  Counts counts = match_faces(complex, neighbours, boundary, report);
  counts.vertices = vertices;
  const std::int64_t boundary_edges = check_closed(complex, boundary, report);
  check_euler(complex, counts, boundary, boundary_edges, is_part, report);
  report.figures.emplace_back("faces", counts.faces);
  report.figures.emplace_back("boundary faces", boundary.size());
  return report;
}

OracleReport check_orientation(const TetComplex& complex) {
  OracleReport report("orientation", "tetrahedra");
  std::uint64_t inverted = 0, flat = 0;
  for (std::size_t t = 0; t < complex.tetrahedra.size(); ++t) {
    const auto& [a, b, c, d] = complex.tetrahedra[t];
    const int sign = exact::orient3d(*complex.points, a, b, c, d);
    ++report.checked;
    if (sign > 0) continue;
    ++(sign < 0 ? inverted : flat);
    report.fail(complex.tet_name(t) + (sign < 0 ? " is inverted" : " is flat"),
                complex.tet_site(t));
  }
  report.figures.emplace_back("inverted", inverted);
  report.figures.emplace_back("flat", flat);
  return report;
}

}  // namespace tetproof::oracles
