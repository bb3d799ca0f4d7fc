#include <algorithm>
#include <cmath>

#include "oracles/tet_complex.h"

namespace tetproof::oracles {
namespace {

// Sixteen bytes, because there are four for every tetrahedron.
struct FaceRecord {
  Face sorted;
  Index packed;
  Index tet_face() const { return packed & ~kEven; }
  bool even() const { return (packed & kEven) != 0; }
  // Set if `sorted` is an even permutation of the face seen from outside.
  static constexpr Index kEven = 0x80000000U;
  bool operator<(const FaceRecord& other) const { return sorted < other.sorted; }
};

FaceRecord face_record(const Tet& tet, Index t, int i) {
  Face face = face_of(tet, i);
  bool even = true;
  const auto order = [&](int a, int b) {
    if (face[a] > face[b]) {
      std::swap(face[a], face[b]);
      even = !even;
    }
  };
  order(0, 1);
  order(1, 2);
  order(0, 1);
  return {face, (4 * t + static_cast<Index>(i)) | (even ? FaceRecord::kEven : 0)};
}

// Indices in range, four different corners, no two tetrahedra on the same corners. False if faces
// make no sense.
bool check_corners(const TetComplex& complex, OracleReport& report) {
  bool usable = true;
  std::vector<std::pair<Tet, Index>> sorted;
  sorted.reserve(complex.tetrahedra.size());
  for (Index t = 0; t < complex.tetrahedra.size(); ++t) {
    Tet corners = complex.tetrahedra[t];
    std::sort(corners.begin(), corners.end());
    if (corners[3] >= complex.points->size() || corners[0] < complex.first_vertex) {
      report.fail(complex.tet_name(t) + " has a corner out of range");
      usable = false;
    } else if (std::adjacent_find(corners.begin(), corners.end()) != corners.end()) {
      report.fail(complex.tet_name(t) + " repeats a corner");
      usable = false;
    }
    sorted.emplace_back(corners, t);
  }
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    if (sorted[i].first == sorted[i - 1].first) {
      report.fail(complex.tet_name(sorted[i].second) + " duplicates " +
                  complex.tet_name(sorted[i - 1].second));
    }
  }
  return usable;
}

void check_used(const TetComplex& complex, OracleReport& report) {
  std::vector<std::uint8_t> used(complex.points->size(), 0);
  for (const Tet& tet : complex.tetrahedra) {
    for (const Index v : tet) used[v] = 1;
  }
  for (Index v = complex.first_vertex; v < complex.last_vertex; ++v) {
    if (!used[v]) report.fail(complex.vertex_name(v) + " belongs to no tetrahedron");
  }
}

std::int64_t count_used(const TetComplex& complex, const auto& cells) {
  std::vector<std::uint8_t> used(complex.points->size(), 0);
  std::int64_t count = 0;
  for (const auto& cell : cells) {
    for (const Index v : cell) {
      count += used[v] == 0;
      used[v] = 1;
    }
  }
  return count;
}

// Every edge of the boundary faces is traversed as often in one direction as in the other. The
// number of edges.
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
                  complex.vertex_name(edges[i][1]));
    }
    i = j;
  }
  return distinct;
}

void check_euler(const TetComplex& complex, std::uint64_t faces, const std::vector<Face>& boundary,
                 std::int64_t boundary_edges, bool is_part, OracleReport& report) {
  const std::int64_t euler = count_used(complex, complex.tetrahedra) -
                             static_cast<std::int64_t>(mesh_edges(complex).size()) +
                             static_cast<std::int64_t>(faces) -
                             static_cast<std::int64_t>(complex.tetrahedra.size());
  const std::int64_t of_boundary =
      count_used(complex, boundary) - boundary_edges + static_cast<std::int64_t>(boundary.size());
  report.figures.emplace_back("Euler characteristic", euler);
  if (2 * euler != of_boundary && !is_part) {
    report.fail("the Euler characteristic is " + std::to_string(euler) + ", that of the boundary " +
                std::to_string(of_boundary) + " and not twice as much");
  }
}

}  // namespace

std::vector<std::uint64_t> mesh_edges(const TetComplex& complex) {
  std::vector<std::uint64_t> edges;
  edges.reserve(6 * complex.tetrahedra.size());
  for (const Tet& t : complex.tetrahedra) {
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < i; ++j) {
        edges.push_back(static_cast<std::uint64_t>(std::min(t[i], t[j])) << 32 |
                        std::max(t[i], t[j]));
      }
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

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

Face face_of(const Tet& tet, int i) {
  static constexpr int kFaces[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
  return {tet[kFaces[i][0]], tet[kFaces[i][1]], tet[kFaces[i][2]]};
}

OracleReport check_complex(const TetComplex& complex, Neighbours& neighbours, bool is_part) {
  OracleReport report("complex", "tetrahedra");
  report.checked = complex.tetrahedra.size();
  neighbours.across.assign(4 * complex.tetrahedra.size(), kNone);
  if (complex.tetrahedra.empty() && !is_part) report.fail("there are no tetrahedra");
  if (complex.tetrahedra.size() >= FaceRecord::kEven / 4) {
    report.fail("there are more tetrahedra than this program can number");
    return report;
  }
  if (!check_corners(complex, report)) return report;
  check_used(complex, report);

  std::vector<FaceRecord> faces;
  faces.reserve(4 * complex.tetrahedra.size());
  for (Index t = 0; t < complex.tetrahedra.size(); ++t) {
    for (int i = 0; i < 4; ++i) faces.push_back(face_record(complex.tetrahedra[t], t, i));
  }
  std::sort(faces.begin(), faces.end());
  std::vector<Face> boundary;
  std::uint64_t distinct = 0;
  for (std::size_t i = 0; i < faces.size(); ++distinct) {
    std::size_t j = i + 1;
    while (j < faces.size() && faces[j].sorted == faces[i].sorted) ++j;
    const Index first = faces[i].tet_face();
    if (j - i > 2) {
      report.fail(complex.face_name(faces[i].sorted) + " belongs to " + std::to_string(j - i) +
                  " tetrahedra");
    } else if (j - i == 2) {
      const Index second = faces[i + 1].tet_face();
      if (faces[i].even() == faces[i + 1].even()) {
        report.fail(complex.face_name(faces[i].sorted) + " has both its tetrahedra, " +
                    std::to_string(first / 4) + " and " + std::to_string(second / 4) +
                    ", on the same side");
      }
      neighbours.across[first] = second;
      neighbours.across[second] = first;
    } else {
      boundary.push_back(face_of(complex.tetrahedra[first / 4], static_cast<int>(first % 4)));
    }
    i = j;
  }
  faces = {};
  const std::int64_t boundary_edges = check_closed(complex, boundary, report);
  check_euler(complex, distinct, boundary, boundary_edges, is_part, report);
  report.figures.emplace_back("faces", distinct);
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
    report.fail(complex.tet_name(t) + (sign < 0 ? " is inverted" : " is flat"));
  }
  report.figures.emplace_back("inverted", inverted);
  report.figures.emplace_back("flat", flat);
  return report;
}

}  // namespace tetproof::oracles
