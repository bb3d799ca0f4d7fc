// The second kernel's shortcuts: what is in a plane or on a line by its definition, what was
// decided or made before, what boxes and shadows leave out. On a good record a shortcut that loses
// something finds fault; each lie here is one that a shortcut would believe if it asked too little.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "oracles/cgal/second_kernel.h"
#include "property_tests/samples.h"

namespace tetproof::second_kernel_test {
namespace {

using namespace oracles;  // NOLINT
using delmesher::ExactPoint;
using delmesher::ExactRecord;
using Kind = ExactPoint::Kind;

// Coordinates are whole numbers and short fractions, or fractions with denominators of 7: a
// parallelepiped's, whose corners are where planes meet.
enum class Numbers : std::uint8_t { whole, fractions };

Position minus(const Position& a, const Position& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
double dot(const Position& a, const Position& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// A solid of cells of a grid, and a mesh of it, as a record. Its numbers are exact.
class Told {
 public:
  Told(const samples::Sample& sample, Numbers numbers) : numbers_(numbers), input(sample.input) {
    for (const Position& p : input.vertices) record.points.push_back(corner(p));
    std::vector<Index> number;
    for (const Position& p : sample.mesh.vertices) number.push_back(point(p));
    for (std::size_t t = 0; t < sample.mesh.tetrahedra.size(); ++t) {
      const auto& [a, b, c, d] = sample.mesh.tetrahedra[t];
      record.final.push_back(
          {{number[a], number[b], number[c], number[d]}, sample.mesh.regions[t] != 0});
    }
    measure();
    const InputSurface::Members members = surface.members();
    for (Index f = 0; f < surface.facets().size(); ++f) {
      const auto triangles = members.of(f);
      record.facets.push_back({surface.facets()[f].id, 0, 0, {triangles.begin(), triangles.end()}});
    }
    for (const auto& [a, b, c] : sample.mesh.boundary) {
      const std::vector<Position>& p = sample.mesh.vertices;
      Position middle{};
      for (std::size_t k = 0; k < 3; ++k) middle[k] = (p[a][k] + p[b][k] + p[c][k]) / 3;
      const Index facet = surface.facet_of_triangle()[place(middle, 1e-9).triangle];
      record.final_facets.push_back({number[a], number[b], number[c], surface.facets()[facet].id});
    }
  }

  // After each change of the points.
  void measure() {
    ASSERT_EQ(points.assign(record.points, record.planes), "");
    ASSERT_EQ(surface.assign(input, points), "");
  }
  OracleReport report() const {
    return check_second_kernel(input, surface, record, points, "", false, false);
  }
  // The input vertex, or another point of the record, that was there.
  Index at(const Position& p) const { return number_.at(p); }
  Index add(const ExactPoint& p) {
    record.points.push_back(p);
    return static_cast<Index>(record.points.size() - 1);
  }
  // A face with these corners in the grid's coordinates.
  std::array<Index, 4>& face(const Position& a, const Position& b, const Position& c) {
    std::array<Index, 3> wanted = {at(a), at(b), at(c)};
    std::sort(wanted.begin(), wanted.end());
    return *std::ranges::find_if(record.final_facets, [&](const auto& face) {
      std::array<Index, 3> corners = {face[0], face[1], face[2]};
      std::sort(corners.begin(), corners.end());
      return corners == wanted;
    });
  }

 private:
  const Numbers numbers_;
  std::map<Position, Index> number_;
  std::map<std::pair<int, double>, Index> plane_;

 public:
  const Polyhedron input;
  ExactRecord record;
  ExactPoints points;
  InputSurface surface;

 private:
  // Where the sums of coordinates 3x + y, 3y + z and 3z + x are three times the grid's.
  Position moved(const Position& p) const {
    if (numbers_ == Numbers::whole) return p;
    const auto& [x, y, z] = p;
    return {3 * (9 * x - 3 * y + z) / 28, 3 * (x + 9 * y - 3 * z) / 28,
            3 * (-3 * x + y + 9 * z) / 28};
  }
  // The first ones are spanned by points, with normals that point the other way.
  Index plane(int axis, double level) {
    const auto [known, fresh] =
        plane_.try_emplace({axis, level}, static_cast<Index>(record.planes.size()));
    if (!fresh) return known->second;
    ExactRecord::Plane plane;
    plane.through[0][axis] = level;
    if (axis == 0) {
      plane.spanned = true;
      plane.through[1] = {level, 0, 1};
      plane.through[2] = {level - 1, 3, 0};
    } else {
      plane.normal[axis] = 3;
      plane.normal[(axis + 1) % 3] = 1;
    }
    record.planes.push_back(plane);
    return known->second;
  }
  ExactPoint corner(const Position& p) {
    number_[p] = static_cast<Index>(record.points.size());
    if (numbers_ == Numbers::whole) return {Kind::explicit_point, 0, 0, 0, p[0], p[1], p[2]};
    std::array<Index, 3> planes = {plane(0, p[0]), plane(1, p[1]), plane(2, p[2])};
    // Both signs of the common denominator occur.
    if (record.points.size() % 2 == 1) std::swap(planes[1], planes[2]);
    return {Kind::on_planes, planes[0], planes[1], planes[2], 0, 0, 0};
  }

  // Where a point of the surface is: in a right-angled triangle, by its shares of the two corners
  // beside the right angle.
  struct Place {
    Index triangle = kNone, right = 0, a = 0, b = 0;
    double s = 0, t = 0;
  };
  Place place(const Position& p, double slack) const {
    const std::vector<Position>& v = input.vertices;
    for (Index n = 0; n < input.triangles.size(); ++n) {
      for (std::size_t i = 0; i < 3; ++i) {
        const Index r = input.triangles[n][i], a = input.triangles[n][(i + 1) % 3],
                    b = input.triangles[n][(i + 2) % 3];
        const Position u = minus(v[a], v[r]), w = minus(v[b], v[r]), x = minus(p, v[r]);
        if (dot(u, w) != 0) continue;
        const double s = dot(x, u) / dot(u, u), t = dot(x, w) / dot(w, w);
        Position off = x;
        for (std::size_t k = 0; k < 3; ++k) off[k] -= s * u[k] + t * w[k];
        if (s < -slack || t < -slack || s + t > 1 + slack || dot(off, off) > slack) continue;
        return {n, r, a, b, s, t};
      }
    }
    return {};
  }
  Index point(const Position& p) {
    if (const auto known = number_.find(p); known != number_.end()) return known->second;
    const Place at = place(p, 0);
    const Position q = moved(p);
    const Index n = add(
        at.triangle == kNone ? ExactPoint{Kind::explicit_point, 0, 0, 0, q[0], q[1], q[2]}
        : at.s == 0          ? ExactPoint{Kind::on_segment, at.b, at.right, 0, at.t, 0, 0}
        : at.t == 0          ? ExactPoint{Kind::on_segment, at.a, at.right, 0, at.s, 0, 0}
        : at.s + at.t == 1   ? ExactPoint{Kind::on_segment, at.a, at.b, 0, at.s, 0, 0}
                             : ExactPoint{Kind::on_triangle, at.a, at.b, at.right, at.s, at.t, 0});
    number_[p] = n;
    return n;
  }
};

// Two units high and wide, with a notch at (2, 2).
samples::Sample l_shape() {
  samples::Sample sample =
      samples::grid_sample(2, 4, [](int x, int y, int) { return x == 0 || y == 0; });
  for (auto* list : {&sample.input.vertices, &sample.mesh.vertices}) {
    for (Position& p : *list) {
      for (double& x : p) x *= 2;
    }
  }
  return sample;
}

bool says(const OracleReport& report, const std::string& words) {
  return std::ranges::any_of(report.findings, [&](const std::string& finding) {
    return finding.find(words) != std::string::npos;
  });
}

std::string text_of(const OracleReport& report) {
  std::string text = std::to_string(report.violations) + " violations";
  for (const std::string& finding : report.findings) text += "\n" + finding;
  return text;
}

class SecondKernel : public testing::TestWithParam<Numbers> {};

INSTANTIATE_TEST_SUITE_P(Numbers, SecondKernel, testing::Values(Numbers::whole, Numbers::fractions),
                         [](const auto& numbers) {
                           return numbers.param == Numbers::whole ? "whole" : "fractions";
                         });

TEST_P(SecondKernel, PassesWhatIsGood) {
  for (const samples::Sample& sample : {samples::cube(), l_shape(), samples::cube_in_hull()}) {
    const Told told(sample, GetParam());
    const OracleReport report = told.report();
    EXPECT_TRUE(report.passed()) << text_of(report);
    // All points, tetrahedra and faces, and the two sums.
    EXPECT_EQ(report.checked, told.record.points.size() + told.record.final.size() +
                                  told.record.final_facets.size() + 2);
  }
}

// More points than are kept, on more segments and triangles than are kept, in an order in which
// none is asked for again soon.
TEST_P(SecondKernel, MakesEveryPointThatItHasNotKept) {
  Told told(l_shape(), GetParam());
  const auto corners = static_cast<Index>(told.input.vertices.size());
  std::mt19937 random(5);
  for (int n = 0; n < 6000; ++n) {
    std::array<Index, 3> of{};
    for (Index& v : of) v = static_cast<Index>(random() % corners);
    const double u = static_cast<double>(random() % 64) / 128,
                 v = static_cast<double>(random() % 64) / 128;
    told.add(n % 2 == 0 ? ExactPoint{Kind::on_segment, of[0], of[1], 0, u, 0, 0}
                        : ExactPoint{Kind::on_triangle, of[0], of[1], of[2], u, v, 0});
  }
  told.measure();
  const OracleReport report = told.report();
  EXPECT_TRUE(report.passed()) << text_of(report);
}

struct Lie {
  const char* name;
  const char* words;  // of the finding
  std::function<void(Told&)> tell;
};

// On the top of the L, z = 2, whose first triangle has the corners (0, 0, 2) and (1, 1, 2).
const Lie kLies[] = {
    {"a corner on an edge that leaves the facet at a corner", "is off its plane",
     [](Told& t) {
       t.face({0, 0, 2}, {0.25, 0, 2}, {0.25, 0.25, 2})[1] =
           t.add({Kind::on_segment, t.at({0, 0, 2}), t.at({0, 0, 1}), 0, 0.5, 0, 0});
     }},
    {"the same, given the other way round", "is off its plane",
     [](Told& t) {
       t.face({0, 0, 2}, {0.25, 0, 2}, {0.25, 0.25, 2})[1] =
           t.add({Kind::on_segment, t.at({0, 0, 1}), t.at({0, 0, 2}), 0, 0.5, 0, 0});
     }},
    {"a corner in a triangle with two corners of the facet", "is off its plane",
     [](Told& t) {
       t.face({0, 0, 2}, {0.25, 0, 2}, {0.25, 0.25, 2})[1] = t.add(
           {Kind::on_triangle, t.at({0, 0, 2}), t.at({1, 1, 2}), t.at({1, 0, 1}), 0.25, 0.25, 0});
     }},
    {"an input vertex below the facet's first corner, on two of its planes", "is off its plane",
     [](Told& t) {
       t.face({0, 0, 2}, {0.25, 0, 2}, {0.25, 0.25, 2})[1] = t.at({0, 0, 0});
     }},
    {"an input vertex below the facet's other corner", "is off its plane",
     [](Told& t) {
       t.face({0, 0, 2}, {0.25, 0, 2}, {0.25, 0.25, 2})[1] = t.at({1, 1, 1});
     }},
    {"a corner in the plane, across the notch", "has a corner beside it",
     [](Told& t) {
       t.face({0.75, 1.75, 2}, {1, 1.75, 2}, {1, 2, 2})[1] =
           t.add({Kind::on_segment, t.at({1, 2, 2}), t.at({2, 1, 2}), 0, 0.5, 0, 0});
     }},
    {"a corner in the plane, on an edge that leaves the facet in the notch",
     "has a corner beside it",
     [](Told& t) {
       t.face({0.75, 1.75, 2}, {1, 1.75, 2}, {1, 2, 2})[1] =
           t.add({Kind::on_segment, t.at({1, 1, 2}), t.at({0, 0, 2}), 0, 1.0625, 0, 0});
     }},
    {"a corner in the plane, beyond the end of its own segment", "has a corner beside it",
     [](Told& t) {
       t.face({0.75, 1.75, 2}, {1, 1.75, 2}, {1, 2, 2})[1] =
           t.add({Kind::on_segment, t.at({1, 2, 2}), t.at({0, 2, 2}), 0, 1.5, 0, 0});
     }},
    // All of its corners were found on the facets where they are before.
    {"another facet, whose plane the face does not touch", "is off its plane",
     [](Told& t) {
       const auto& bottom = t.face({0.25, 0.25, 0}, {0.5, 0.25, 0}, {0.5, 0.5, 0});
       std::array<Index, 4> moved = t.face({0.25, 0.25, 2}, {0.5, 0.25, 2}, {0.5, 0.5, 2});
       moved[3] = bottom[3];
       t.record.final_facets.push_back(moved);
     }},
    {"another facet, in whose plane the face has an edge", "is off its plane",
     [](Told& t) {
       const auto& side = t.face({0.25, 0, 1.75}, {0.25, 0, 2}, {0, 0, 1.75});
       std::array<Index, 4> moved = t.face({0, 0, 2}, {0.25, 0, 2}, {0.25, 0.25, 2});
       moved[3] = side[3];
       t.record.final_facets.push_back(moved);
     }},
    {"a face turned over", "is not turned outwards",
     [](Told& t) {
       auto& face = t.face({0, 0, 2}, {0.25, 0, 2}, {0.25, 0.25, 2});
       std::swap(face[0], face[1]);
     }},
    {"a face less", "have another area", [](Told& t) { t.record.final_facets.pop_back(); }},
    {"a face less, of the volume", "the faces enclose another volume",
     [](Told& t) {
       // Of a plane that does not contain the first corner, from which volumes are measured.
       auto& face = t.face({0.75, 1.75, 2}, {1, 1.75, 2}, {1, 2, 2});
       std::swap(face, t.record.final_facets.back());
       t.record.final_facets.pop_back();
     }},
    {"a tetrahedron less", "the tetrahedra inside have another volume",
     [](Told& t) { t.record.final.pop_back(); }},
    {"a tetrahedron inside out", "is not positive",
     [](Told& t) {
       auto& tet = t.record.final[7].vertices;
       std::swap(tet[2], tet[3]);
     }},
    {"a tetrahedron inside called outside", "is recorded as outside",
     [](Told& t) { t.record.final[7].inside = false; }},
};

TEST_P(SecondKernel, CatchesWhatAShortcutMightBelieve) {
  for (const Lie& lie : kLies) {
    Told told(l_shape(), GetParam());
    lie.tell(told);
    told.measure();
    const OracleReport report = told.report();
    EXPECT_TRUE(says(report, lie.words)) << lie.name << ": " << text_of(report);
  }
}

TEST_P(SecondKernel, CatchesEveryTetrahedronOnTheWrongSide) {
  const Told good(samples::cube_in_hull(), GetParam());
  for (std::size_t t = 0; t < good.record.final.size(); t += 29) {
    Told told(samples::cube_in_hull(), GetParam());
    told.record.final[t].inside = !told.record.final[t].inside;
    const OracleReport report = told.report();
    EXPECT_TRUE(says(report, "tetrahedron " + std::to_string(t) + " is recorded as"))
        << text_of(report);
  }
}

}  // namespace
}  // namespace tetproof::second_kernel_test
