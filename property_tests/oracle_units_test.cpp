// The pieces of the oracles, one by one: intervals, readers, exact signs and measures.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstring>
#include <fstream>
#include <limits>
#include <map>
#include <mutex>
#include <numeric>
#include <random>

#include "oracles/angles.h"
#include "oracles/ball_side.h"
#include "oracles/chamfer_features.h"
#include "oracles/corners.h"
#include "oracles/delaunay.h"
#include "oracles/enrichment.h"
#include "oracles/hull.h"
#include "oracles/input_surface.h"
#include "oracles/interval.h"
#include "oracles/measures.h"
#include "oracles/parallel.h"
#include "oracles/plane_file.h"
#include "oracles/plane_graph.h"
#include "oracles/plane_grid.h"
#include "oracles/plane_points.h"
#include "oracles/promise.h"
#include "oracles/refinement.h"
#include "oracles/regions.h"
#include "oracles/same_mesh.h"
#include "oracles/sample.h"
#include "oracles/sidecar.h"
#include "oracles/surface_file.h"
#include "oracles/text_reader.h"
#include "oracles/verify.h"
#include "property_tests/samples.h"

namespace tetproof {
namespace {

using namespace oracles;  // NOLINT
using delmesher::ExactPoint;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// ------------------------------------------------------------------------------- the file alone

// A tetrahedron with a needle P A B of width w, cut by s1 in the middle of PA and s2 at a quarter
// of PB, without an edge from s1 to B. s1 is off PA by a share of w, away from PB: beyond 0.25 the
// chain of boundary edges that begins nearest to PA is that over s2, and PB is left without one.
Verdict verdict_on_needle(double w, double share, bool whole = true) {
  const Position p = {0, 0, 0}, a = {1, 0, 0}, b = {1, w, 0}, c = {0, 0, 1};
  const Polyhedron input = {
      {p, a, b, c}, {{{0, 2, 1}}, {{0, 1, 3}}, {{1, 2, 3}}, {{2, 0, 3}}}, {}, {}};
  MeshFile mesh;
  mesh.vertices = {p, a, b, c, {0.5, -share * w, 0}, {0.25, 0.25 * w, 0}};
  mesh.tetrahedra = {{0, 4, 5, 3}, {4, 1, 5, 3}};
  if (whole) mesh.tetrahedra.push_back({1, 2, 5, 3});
  mesh.either_orientation = true;
  VerifyReport report;
  EXPECT_EQ(verify(input, mesh, nullptr, {.promised = {.planar = 0}}, report), "");
  return report.verdict;
}

TEST(FileAlone, IsNotJudgedWhereDoublesDoNotTellEdgesApart) {
  EXPECT_EQ(verdict_on_needle(0x1p-52, 0), Verdict::exact);
  EXPECT_EQ(verdict_on_needle(0x1p-20, 0), Verdict::exact);
  EXPECT_EQ(verdict_on_needle(0x1p-52, 0.35), Verdict::undecided);
  // At that distance doubles tell; and an error of another kind is an error there too.
  EXPECT_EQ(verdict_on_needle(0x1p-20, 0.35), Verdict::broken);
  EXPECT_EQ(verdict_on_needle(0x1p-52, 0.35, false), Verdict::broken);
}

// A square pyramid upside down. Its base has a facet as thin as a needle P A B. A vertex on PA and
// one on PB make its edges indistinguishable. Two vertices of the base are pushed in and out by as
// much, which changes no volume.
Verdict verdict_on_dented_base(double dent) {
  constexpr double kThin = 0x1p-52;
  const Polyhedron input = {{{0, 0, 0},
                             {1, 0, 0},
                             {1, kThin, 0},
                             {-1, -2, 0},
                             {2, -2, 0},
                             {2, 2, 0},
                             {-1, 2, 0},
                             {0.5, 0, -3}},
                            {{{0, 1, 2}},
                             {{0, 3, 1}},
                             {{3, 4, 1}},
                             {{4, 2, 1}},
                             {{4, 5, 2}},
                             {{5, 6, 2}},
                             {{6, 0, 2}},
                             {{6, 3, 0}},
                             {{3, 6, 7}},
                             {{4, 3, 7}},
                             {{5, 4, 7}},
                             {{6, 5, 7}}},
                            {1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0},
                            {}};
  MeshFile mesh;
  mesh.vertices = input.vertices;
  mesh.vertices.push_back({0.5, -0.35 * kThin, 0});
  mesh.vertices.push_back({0.25, 0.25 * kThin, 0});
  // In the triangles 3 4 1 and 5 6 2, of equal size.
  mesh.vertices.push_back({0.5, -1, dent});
  mesh.vertices.push_back({0.5, 1, -dent});
  // Seen from above: the needle without an edge from vertex 8 to B, and its surroundings.
  const std::vector<Face> base = {
      {0, 8, 9}, {8, 1, 9}, {1, 2, 9},  {0, 3, 8},  {3, 1, 8},  {3, 4, 10}, {4, 1, 10}, {1, 3, 10},
      {4, 2, 1}, {4, 5, 2}, {5, 6, 11}, {6, 2, 11}, {2, 5, 11}, {6, 0, 9},  {6, 9, 2},  {6, 3, 0}};
  for (const auto& [a, b, c] : base) mesh.tetrahedra.push_back({a, b, c, 7});
  mesh.either_orientation = true;
  VerifyReport report;
  EXPECT_EQ(verify(input, mesh, nullptr, {}, report), "");
  return report.verdict;
}

TEST(FileAlone, MayBeTurnedOverWhereTheFormatHasNoConvention) {
  const samples::Sample honest = samples::l_shape();
  for (const bool either : {true, false}) {
    MeshFile turned = honest.mesh;
    turned.either_orientation = either;
    for (Tet& tet : turned.tetrahedra) std::swap(tet[0], tet[1]);
    VerifyReport report;
    EXPECT_EQ(verify(honest.input, turned, nullptr, {}, report), "");
    EXPECT_EQ(report.verdict, either ? Verdict::exact : Verdict::broken) << to_text(report);
  }
}

TEST(FileAlone, IsNoExcuseForWhatIsFarFromTheSurface) {
  EXPECT_EQ(verdict_on_dented_base(0), Verdict::undecided);
  EXPECT_EQ(verdict_on_dented_base(0x1p-10), Verdict::broken);
  EXPECT_EQ(verdict_on_dented_base(0x1p-30), Verdict::broken);
}

// A cube has six faces, twelve edges and eight corners, however it is triangulated.
TEST(FileAlone, IsComparedWithTheWholeSurface) {
  const samples::Sample cube = samples::cube();
  VerifyReport report;
  EXPECT_EQ(verify(cube.input, cube.mesh, nullptr, {}, report), "");
  const OracleReport* conformity = report.find("conformity");
  ASSERT_NE(conformity, nullptr);
  const std::map<std::string, double> figures(conformity->figures.begin(),
                                              conformity->figures.end());
  EXPECT_EQ(figures.at("facets"), 6);
  EXPECT_EQ(figures.at("edges"), 12);
  EXPECT_EQ(figures.at("input vertices"), 8);
}

// The inside of a refined mesh may be empty; a mesh may not.
TEST(Complex, OnlyAPartMayBeEmpty) {
  TetComplex complex;
  const ExactPoints none;
  complex.points = &none;
  Neighbours neighbours;
  EXPECT_EQ(check_complex(complex, neighbours, true).violations, 0U);
  const OracleReport report = check_complex(complex, neighbours);
  EXPECT_EQ(report.violations, 1U);
  EXPECT_EQ(report.findings, std::vector<std::string>{"there are no tetrahedra"});
}

// ------------------------------------------------------------------------------------- intervals

TEST(Intervals, HaveTheSignOfAllTheyHold) {
  EXPECT_EQ(Interval(1, 2).sign(), 1);
  EXPECT_EQ(Interval(-2, -1).sign(), -1);
  EXPECT_EQ(Interval(0).sign(), 0);
  EXPECT_EQ(Interval(0, 1).sign(), 2);
  EXPECT_EQ(Interval(-1, 0).sign(), 2);
  EXPECT_EQ(Interval(-1, 1).sign(), 2);
  EXPECT_EQ((Interval(1e308) * Interval(10)).sign(), 2);  // overflow certifies nothing
  EXPECT_EQ((Interval(kInfinity) - Interval(kInfinity)).sign(), 2);
}

// Against rational arithmetic at the ends: no number of the operands may be lost, and at most a few
// roundings are added.
TEST(Intervals, EncloseAndAreTight) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto interval = [&] {
    const double a = unit(random), b = a + std::ldexp(unit(random), -int(random() % 60));
    return Interval(std::min(a, b), std::max(a, b));
  };
  const auto expect = [](const Interval& found, const mpq_class& low, const mpq_class& high) {
    const mpq_class scale = std::max(abs(low), abs(high));
    EXPECT_LE(mpq_class(found.low), low);
    EXPECT_GE(mpq_class(found.high), high);
    EXPECT_LE(low - mpq_class(found.low), scale * mpq_class(0x1p-49));
    EXPECT_LE(mpq_class(found.high) - high, scale * mpq_class(0x1p-49));
  };
  for (int round = 0; round < 500; ++round) {
    const Interval a = interval(), b = interval();
    const mpq_class al = a.low, ah = a.high, bl = b.low, bh = b.high;
    expect(a + b, al + bl, ah + bh);
    expect(a - b, al - bh, ah - bl);
    expect(-a, -ah, -al);
    const std::array<mpq_class, 4> products = {al * bl, al * bh, ah * bl, ah * bh};
    expect(a * b, *std::min_element(products.begin(), products.end()),
           *std::max_element(products.begin(), products.end()));
  }
  const Interval tiny = Interval(0x1p-1070) * Interval(0x1p-10);  // underflows to zero
  EXPECT_GT(tiny.high, 0);
  EXPECT_EQ(tiny.sign(), 2);
  EXPECT_LE(tiny.high, 16 * std::numeric_limits<double>::denorm_min());
}

// -------------------------------------------------------------------------------------- the reader

TEST(TextReader, ReadsWordsAndCountsLines) {
  TextReader reader("file", "one two # three\n\n\t four\r\nfive");
  EXPECT_EQ(reader.word(), "one");
  EXPECT_EQ(reader.line(), 1U);
  EXPECT_EQ(reader.word_in_line(), "two");
  EXPECT_EQ(reader.word_in_line(), "");
  EXPECT_EQ(reader.word(), "four");
  EXPECT_EQ(reader.line(), 3U);
  EXPECT_FALSE(reader.at_end());
  EXPECT_EQ(reader.required_word("a word"), "five");
  EXPECT_EQ(reader.line(), 4U);
  EXPECT_TRUE(reader.at_end());
  EXPECT_EQ(reader.word(), "");
  EXPECT_THROW(reader.required_word("a word"), ReadError);
}

TEST(TextReader, ReadsAFilePieceByPieceAsItReadsTheWhole) {
  std::mt19937 random(7);
  std::string text;
  while (text.size() < 1500000) {
    // Words and comments of many lengths, now and then one that is longer than a piece.
    const std::size_t length = random() % 20000 == 0 ? 300000 : 1 + random() % 40;
    if (random() % 50 == 0) text += '#';
    text.append(length, static_cast<char>('a' + random() % 26));
    text += " \t\r\n\n "[random() % 6];
  }
  const std::string path = testing::TempDir() + "pieces.txt";
  std::ofstream(path, std::ios::binary) << text;
  for (const char comment : {'#', '\0'}) {
    TextReader whole(path, text, comment), pieces = TextReader::of_file(path, comment);
    for (std::size_t i = 0;; ++i) {
      if (i % 7 == 3) {
        whole.skip_line();
        pieces.skip_line();
      }
      const std::string_view wanted = i % 3 == 0 ? whole.word_in_line() : whole.word();
      ASSERT_EQ(i % 3 == 0 ? pieces.word_in_line() : pieces.word(), wanted) << "word " << i;
      ASSERT_EQ(pieces.line(), whole.line());
      if (i % 3 != 0 && wanted.empty()) break;
    }
    EXPECT_TRUE(pieces.at_end());
    EXPECT_GT(whole.line(), 1000U);
  }
  // A count is judged by the whole file, not by the piece.
  std::ofstream(path, std::ios::binary) << "500000 " << std::string(1000000, 'x');
  EXPECT_EQ(TextReader::of_file(path).count(), 500000U);
  std::ofstream(path, std::ios::binary) << "500006 " << std::string(1000000, 'x');
  EXPECT_THROW(TextReader::of_file(path).count(), ReadError);
  EXPECT_THROW(TextReader::of_file(testing::TempDir()), ReadError);
  EXPECT_THROW(TextReader::of_file(path + ".none"), ReadError);
  std::ofstream(path, std::ios::binary | std::ios::trunc).flush();
  EXPECT_THROW(TextReader::of_file(path), ReadError);
}

TEST(TextReader, ACommentMayEndTheText) {
  TextReader reader("file", "1 # 2");
  EXPECT_EQ(reader.integer(), 1);
  EXPECT_TRUE(reader.at_end());
  TextReader none("file", "a#b", '\0');
  EXPECT_EQ(none.word(), "a#b");
  TextReader skipped("file", "a b c\nd");
  EXPECT_EQ(skipped.word(), "a");
  skipped.skip_line();
  EXPECT_EQ(skipped.word(), "d");
  EXPECT_EQ(skipped.line(), 2U);
}

TEST(TextReader, ReadsNumbersExactlyOrRefuses) {
  const auto number = [](const char* text) { return TextReader("file", text).number(); };
  EXPECT_EQ(number("0.1"), 0.1);
  EXPECT_EQ(number("-2.5e3"), -2500);
  EXPECT_EQ(number("+3"), 3);
  EXPECT_EQ(number("0x1.8p3"), 12);
  EXPECT_EQ(number("-0X1p-2"), -0.25);
  EXPECT_EQ(number("1e-400"), 0);
  for (const char* text : {"", "1e400", "--1", "+-1", "1.5x", "x", "-", "1,5", "0x"}) {
    EXPECT_THROW(number(text), ReadError) << text;
  }
  const auto integer = [](const char* text) { return TextReader("file", text).integer(); };
  EXPECT_EQ(integer("-7"), -7);
  EXPECT_EQ(integer("+7"), 7);
  for (const char* text : {"", "1.0", "7x", "99999999999999999999", "+"}) {
    EXPECT_THROW(integer(text), ReadError) << text;
  }
}

TEST(TextReader, IndicesAndCountsHaveBounds) {
  const auto index = [](const char* text) { return TextReader("file", text).index(1, 5); };
  EXPECT_EQ(index("1"), 0U);
  EXPECT_EQ(index("5"), 4U);
  EXPECT_THROW(index("0"), ReadError);
  EXPECT_THROW(index("6"), ReadError);
  EXPECT_EQ(TextReader("file", "0").count(), 0U);
  EXPECT_EQ(TextReader("file", "4 a b c").count(), 4U);  // 7 characters: at most 4 things
  EXPECT_THROW(TextReader("file", "5 a b c").count(), ReadError);
  EXPECT_THROW(TextReader("file", "-1").count(), ReadError);
}

TEST(TextReader, ErrorsNameFileAndLine) {
  TextReader reader("name", "1\n2\nx");
  reader.integer();
  reader.integer();
  try {
    reader.integer();
    FAIL();
  } catch (const ReadError& error) {
    EXPECT_EQ(std::string(error.what()), "name:3: \"x\" is no integer");
  }
}

// ------------------------------------------------------------------------------------ exact points

ExactPoints points_of(const std::vector<Position>& positions) {
  ExactPoints points;
  EXPECT_EQ(points.assign(positions), "");
  return points;
}

mpq_class coordinate(const ExactPoints& points, Index v, int axis) {
  mpq_class value = points.exact(v)[axis].rational();
  if (points.exponent() >= 0) return value << static_cast<unsigned long>(points.exponent());
  return value >> static_cast<unsigned long>(-points.exponent());
}

TEST(ExactPoints, AreTheirDefinitions) {
  std::vector<ExactPoint> given =
      explicit_points(std::vector<Position>{{0.1, -3, 7e5}, {1e-7, 0, -2}, {5, 0.3, 0x1p-60}});
  ExactPoint on_segment;
  on_segment.kind = ExactPoint::Kind::on_segment;
  on_segment.i = 0;
  on_segment.j = 2;
  on_segment.x = 0.3;
  given.push_back(on_segment);
  ExactPoint on_triangle;
  on_triangle.kind = ExactPoint::Kind::on_triangle;
  on_triangle.i = 2;
  on_triangle.j = 0;
  on_triangle.k = 1;
  on_triangle.x = 0.7;
  on_triangle.y = 0x1.8p-3;
  given.push_back(on_triangle);
  on_segment.x = 3;  // beyond an end
  given.push_back(on_segment);
  ExactPoints points;
  ASSERT_EQ(points.assign(given), "");
  ASSERT_EQ(points.size(), given.size());
  double largest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    std::array<mpq_class, 3> c;
    for (int v = 0; v < 3; ++v) {
      const ExactPoint& p = given[v];
      c[v] = axis == 0 ? p.x : axis == 1 ? p.y : p.z;
      EXPECT_EQ(coordinate(points, v, axis), c[v]);
      EXPECT_EQ(points.nearest(v)[axis], c[v].get_d());
      EXPECT_EQ(points.enclosure(v)[axis].low, points.enclosure(v)[axis].high);
    }
    const mpq_class t = 0.3, u = 0.7, w = 0x1.8p-3;
    const std::array<mpq_class, 3> made = {
        t * c[0] + (1 - t) * c[2], u * c[2] + w * c[0] + (1 - u - w) * c[1], 3 * c[0] - 2 * c[2]};
    for (Index i = 0; i < 3; ++i) {
      EXPECT_EQ(coordinate(points, 3 + i, axis), made[i]);
      const Interval around = points.enclosure(3 + i)[axis];
      EXPECT_LE(mpq_class(around.low), made[i]);
      EXPECT_GE(mpq_class(around.high), made[i]);
      EXPECT_LE(around.high - around.low, 0x1p-48 * std::fabs(made[i].get_d()));
      EXPECT_NEAR(points.nearest(3 + i)[axis], made[i].get_d(),
                  0x1p-51 * std::fabs(made[i].get_d()));
    }
    for (Index v = 0; v < points.size(); ++v) {
      for (Index to = 0; to < points.size(); ++to) {
        const mpq_class exact = coordinate(points, to, axis) - coordinate(points, v, axis);
        const Interval rough = points.rough_difference(v, to)[axis];
        EXPECT_LE(mpq_class(rough.low), exact);
        EXPECT_GE(mpq_class(rough.high), exact);
        // A second double per coordinate leaves an error of 2^-105 of it, taken 2^5 times for
        // safety. Rounding outward at zero goes to the next subnormal number, a few times over.
        constexpr double kSubnormals = 16 * std::numeric_limits<double>::denorm_min();
        const double coordinates =
            std::fabs(points.nearest(v)[axis]) + std::fabs(points.nearest(to)[axis]);
        EXPECT_LE(rough.high - rough.low,
                  0x1p-48 * std::fabs(exact.get_d()) + 0x1p-99 * coordinates + kSubnormals);
      }
      largest = std::max(largest, std::fabs(points.nearest(v)[axis]));
    }
  }
  EXPECT_EQ(points.largest_coordinate(), largest);
  EXPECT_GE(points.difference_error(), 0x1p-52 * largest);
  EXPECT_LE(points.difference_error(), 0x1p-48 * largest);
  EXPECT_EQ(points_of({{1, 2, -3}}).difference_error(), 0);  // doubles are exact
  EXPECT_EQ(points_of({{1, 2, -3}}).largest_coordinate(), 3);
  EXPECT_EQ(points_of({{0, 0, 0}}).size(), 1U);
}

TEST(ExactPoints, RefuseWhatIsNoPoint) {
  ExactPoints points;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double bad : {kInfinity, std::nan("")}) {
      Position position = {1, 2, 3};
      position[axis] = bad;
      EXPECT_NE(points.assign(std::vector<Position>{{0, 0, 0}, position}).find("point 1"),
                std::string::npos);
      EXPECT_EQ(points.size(), 0U);
    }
  }
  const std::vector<ExactPoint> three =
      explicit_points(std::vector<Position>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  for (const auto kind : {ExactPoint::Kind::on_segment, ExactPoint::Kind::on_triangle}) {
    const int corners = kind == ExactPoint::Kind::on_segment ? 2 : 3;
    for (int corner = -1; corner < corners; ++corner) {
      for (const Index wrong : {4U, 3U, 5U, 1000U}) {  // itself, another such point, nothing
        std::vector<ExactPoint> given = three;
        ExactPoint p;
        p.kind = kind;
        p.i = 0;
        p.j = 1;
        p.k = corners == 3 ? 2 : 1000;  // not looked at on segments
        given.push_back(p);
        if (corner == 0) p.i = wrong;
        if (corner == 1) p.j = wrong;
        if (corner == 2) p.k = wrong;
        given.push_back(p);
        EXPECT_EQ(points.assign(given).empty(), corner < 0) << corner << " " << wrong;
      }
    }
  }
}

TEST(ExactSigns, OfACornerAndItsMirrorImage) {
  // Unit vectors from a point away from the origin, and points inside and outside.
  const double s = 17;
  const ExactPoints p = points_of({{s, s, s},
                                   {s + 1, s, s},
                                   {s, s + 1, s},
                                   {s, s, s + 1},
                                   {s + 0.5, s + 0.5, s + 0.25},  // in the sphere, not its centre
                                   {s + 1, s + 1, s + 1},         // on it
                                   {s + 2, s + 2, s + 2},
                                   {s + 2, s, s}});
  EXPECT_EQ(exact::orient3d(p, 0, 1, 2, 3), 1);
  EXPECT_EQ(exact::orient3d(p, 0, 2, 1, 3), -1);
  EXPECT_EQ(exact::orient3d(p, 0, 1, 2, 7), 0);
  EXPECT_EQ(to_double(exact::volume6(p, 0, 1, 2, 3), 3 * p.exponent()), 1);
  EXPECT_EQ(to_double(exact::volume6(p, 0, 1, 2, 6), 3 * p.exponent()), 2);
  EXPECT_EQ(exact::insphere(p, 0, 1, 2, 3, 4), 1);
  EXPECT_EQ(exact::insphere(p, 0, 1, 2, 3, 5), 0);
  EXPECT_EQ(exact::insphere(p, 0, 1, 2, 3, 6), -1);
  EXPECT_EQ(exact::insphere(p, 0, 2, 1, 3, 4), -1);  // the other orientation
  EXPECT_EQ(exact::dot_sign(p, 0, 1, 2), 0);
  EXPECT_EQ(exact::dot_sign(p, 0, 1, 5), 1);
  EXPECT_EQ(exact::dot_sign(p, 0, 1, 7), 1);
  EXPECT_EQ(exact::dot_sign(p, 1, 0, 7), -1);
  EXPECT_TRUE(exact::in_diametral_ball(p, 1, 2, 3, 4));
  EXPECT_FALSE(exact::in_diametral_ball(p, 1, 2, 3, 1));
  EXPECT_FALSE(exact::in_diametral_ball(p, 1, 2, 3, 6));
  EXPECT_TRUE(exact::collinear(p, 0, 1, 7));
  EXPECT_TRUE(exact::collinear(p, 0, 5, 6));
  EXPECT_TRUE(exact::collinear(p, 0, 0, 6));
  for (const auto& [a, b] : {std::array<Index, 2>{1, 2}, {2, 3}, {3, 1}}) {
    EXPECT_FALSE(exact::collinear(p, 0, a, b));
  }
  EXPECT_TRUE(exact::equal(p, 3, 3));
  EXPECT_FALSE(exact::equal(p, 1, 7));
  EXPECT_NEAR(exact::distance(p, 0, 6), std::sqrt(12.0), 1e-15);
  EXPECT_NEAR(exact::distance(p, 7, 3), std::sqrt(5.0), 1e-15);
  EXPECT_EQ(length(exact::area2(p, 0, 1, 2), 2 * p.exponent()), 1);
}

// The same signs where intervals cannot tell: on a lattice, against integers of the machine.
TEST(ExactSigns, AgreeWithMachineIntegersOnALattice) {
  std::mt19937_64 random(5);
  std::array<std::array<int, 3>, 4> counts{};  // by predicate and sign
  for (int round = 0; round < 4000; ++round) {
    std::array<std::array<std::int64_t, 3>, 5> x;
    std::vector<Position> positions(5);
    for (int i = 0; i < 5; ++i) {
      for (int k = 0; k < 3; ++k) {
        x[i][k] = static_cast<std::int64_t>(random() % 3);
        // Offset and steps that doubles hold, but not the products of their differences.
        positions[i][k] = 0x1p40 + static_cast<double>(x[i][k]) * 0x1.00001p10;
      }
    }
    const auto minus = [&](int a, int b) {
      return std::array<std::int64_t, 3>{x[a][0] - x[b][0], x[a][1] - x[b][1], x[a][2] - x[b][2]};
    };
    const auto cross = [](const auto& u, const auto& v) {
      return std::array<std::int64_t, 3>{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                                         u[0] * v[1] - u[1] * v[0]};
    };
    const auto dot = [](const auto& u, const auto& v) {
      return u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
    };
    const auto sign = [](std::int64_t value) { return value > 0 ? 1 : value < 0 ? -1 : 0; };
    const ExactPoints p = points_of(positions);
    const auto u = minus(1, 0), v = minus(2, 0), w = minus(3, 0);
    const auto n = cross(u, v);
    const std::int64_t volume = dot(n, w);
    const int orientation = sign(volume);
    ASSERT_EQ(exact::orient3d(p, 0, 1, 2, 3), orientation);
    const mpq_class step = std::ldexp(0x1.00001p10, static_cast<int>(-p.exponent()));
    const mpq_class expected = step * step * step * static_cast<long>(volume);
    ASSERT_EQ(exact::volume6(p, 0, 1, 2, 3).rational(), expected);
    ++counts[0][orientation + 1];
    const int angle = sign(dot(u, v));
    ASSERT_EQ(exact::dot_sign(p, 0, 1, 2), angle);
    ++counts[1][angle + 1];
    ASSERT_EQ(exact::collinear(p, 0, 1, 2), n == (std::array<std::int64_t, 3>{0, 0, 0}));
    // Lifted to the paraboloid: e is inside the sphere of abcd.
    const auto a = minus(0, 4), b = minus(1, 4), c = minus(2, 4), d = minus(3, 4);
    const std::int64_t lifted = dot(a, a) * dot(b, cross(c, d)) - dot(b, b) * dot(a, cross(c, d)) +
                                dot(c, c) * dot(a, cross(b, d)) - dot(d, d) * dot(a, cross(b, c));
    ASSERT_EQ(exact::insphere(p, 0, 1, 2, 3, 4), sign(lifted));
    ++counts[2][sign(lifted) + 1];
    if (dot(n, n) == 0) continue;
    // |w|^2 < 2 w . (centre - a), the centre as in circumcentre formulas.
    const auto vn = cross(v, n), nu = cross(n, u);
    const std::int64_t power =
        dot(w, w) * dot(n, n) - dot(u, u) * dot(w, vn) - dot(v, v) * dot(w, nu);
    ASSERT_EQ(exact::in_diametral_ball(p, 0, 1, 2, 3), power < 0);
    ++counts[3][sign(power) + 1];
  }
  for (const auto& of_predicate : counts) {
    for (const int count : of_predicate) EXPECT_GT(count, 100);
  }
}

// The part of a polygon on the inner side of the plane through three points.
std::vector<std::array<mpq_class, 3>> clipped(const std::vector<std::array<mpq_class, 3>>& polygon,
                                              const std::array<std::array<int, 3>, 4>& tet,
                                              int face, bool& touches_inside) {
  const auto height = [&](const std::array<mpq_class, 3>& x) {
    const auto &a = tet[(face + 1) % 4], &b = tet[(face + 2) % 4], &c = tet[(face + 3) % 4];
    const auto at = [&](const auto& p) {
      mpq_class sum = 0;
      for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        const int n = (b[j] - a[j]) * (c[k] - a[k]) - (b[k] - a[k]) * (c[j] - a[j]);
        sum += n * (mpq_class(p[i]) - a[i]);
      }
      return sum;
    };
    return mpq_class(at(x) * sgn(at(tet[face])));
  };
  std::vector<std::array<mpq_class, 3>> result;
  touches_inside = false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const auto &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const mpq_class s = height(p), t = height(q);
    touches_inside = touches_inside || s > 0;
    if (s >= 0) result.push_back(p);
    if (sgn(s) * sgn(t) >= 0) continue;
    std::array<mpq_class, 3> cut;
    for (int k = 0; k < 3; ++k) cut[k] = (s * q[k] - t * p[k]) / (s - t);
    result.push_back(cut);
  }
  return result;
}

// Triangles that are larger than tetrahedra, and pass by them at all distances, 0 among them;
// against clipping in rational coordinates.
TEST(InputSurface, EntersWhatRationalClippingSaysItEnters) {
  std::mt19937_64 random(11);
  std::array<int, 2> counts{};
  for (int round = 0; round < 3000; ++round) {
    std::array<std::array<int, 3>, 4> solid, tet;
    for (auto& x : solid) {
      for (int& c : x) c = static_cast<int>(random() % 19) - 9;
    }
    for (auto& x : tet) {
      for (int& c : x) c = static_cast<int>(random() % 4);
    }
    if (round % 3 == 0) tet[0] = solid[0];
    std::vector<Position> positions;
    for (const auto& x : {solid, tet}) {
      for (const auto& c : x) {
        positions.push_back({1.0 * c[0], 1.0 * c[1], 1.0 * c[2]});
      }
    }
    const ExactPoints points = points_of(positions);
    if (exact::orient3d(points, 0, 1, 2, 3) == 0) continue;
    std::array<Index, 4> corners = {4, 5, 6, 7};
    const int orientation = exact::orient3d(points, 4, 5, 6, 7);
    if (orientation == 0) continue;
    if (orientation < 0) std::swap(corners[2], corners[3]);
    const Polyhedron polyhedron = {{positions.begin(), positions.begin() + 4},
                                   {{{0, 2, 1}}, {{0, 1, 3}}, {{1, 2, 3}}, {{2, 0, 3}}},
                                   {},
                                   {}};
    InputSurface surface;
    ASSERT_EQ(surface.assign(polyhedron, points), "");
    bool entered = false;
    for (int without = 0; without < 4; ++without) {
      std::vector<std::array<mpq_class, 3>> polygon;
      for (int v = 0; v < 4; ++v) {
        if (v != without) polygon.push_back({solid[v][0], solid[v][1], solid[v][2]});
      }
      bool inside = true;
      for (int face = 0; face < 4; ++face) {
        bool ignored = false;
        polygon = clipped(polygon, tet, face, ignored);
      }
      for (int face = 0; face < 4; ++face) {
        bool touches = false;
        clipped(polygon, tet, face, touches);
        inside = inside && touches;
      }
      entered = entered || inside;
    }
    InputSurface::PlaneSides known;
    ASSERT_EQ(surface.meets_interior(points, corners, known), entered) << "round " << round;
    ++counts[entered];
  }
  EXPECT_GT(counts[0], 300);
  EXPECT_GT(counts[1], 300);
}

Position position(const std::array<long, 3>& x) {
  return {static_cast<double>(x[0]), static_cast<double>(x[1]), static_cast<double>(x[2])};
}

TEST(BoxTree, FindsWhatMeetsTheQueryAndNothingFarInAHalfSpace) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> real(-1, 1);
  std::vector<BoxTree::Box> boxes(500);
  for (BoxTree::Box& box : boxes) {
    for (int axis = 0; axis < 3; ++axis) {
      box.low[axis] = real(random);
      box.high[axis] = box.low[axis] + 0.1 * std::fabs(real(random));
    }
  }
  const BoxTree tree(boxes);
  std::size_t left_out = 0, kept = 0;
  for (int round = 0; round < 200; ++round) {
    BoxTree::Box query;
    for (int axis = 0; axis < 3; ++axis) {
      query.low[axis] = real(random);
      query.high[axis] = query.low[axis] + std::fabs(real(random));
    }
    const std::array<BoxTree::HalfSpace, 2> but_in = {
        {{{real(random), real(random), real(random)}, 0.5 * real(random)},
         {{real(random), real(random), real(random)}, 0.5 * real(random)}}};
    std::vector<Index> found;
    tree.query(query, found, but_in);
    std::sort(found.begin(), found.end());
    for (Index i = 0; i < boxes.size(); ++i) {
      bool meets = true;
      for (int axis = 0; axis < 3; ++axis) {
        meets = meets && boxes[i].low[axis] <= query.high[axis] &&
                query.low[axis] <= boxes[i].high[axis];
      }
      double depth = -kInfinity;  // of the box in one of them
      for (const BoxTree::HalfSpace& half : but_in) {
        double height = 0;
        for (int axis = 0; axis < 3; ++axis) {
          height += std::min(half.normal[axis] * boxes[i].low[axis],
                             half.normal[axis] * boxes[i].high[axis]);
        }
        depth = std::max(depth, height - half.offset);
      }
      const bool is_found = std::binary_search(found.begin(), found.end(), i);
      if (!meets) {
        ASSERT_FALSE(is_found);
      } else if (depth <= 0) {
        ASSERT_TRUE(is_found);
        ++kept;
      } else if (depth > 1e-12) {
        ASSERT_FALSE(is_found);
        ++left_out;
      }
    }
  }
  EXPECT_GT(kept, 200U);
  EXPECT_GT(left_out, 500U);
}

TEST(Measures, VolumesAddUpWhateverTheNeighbours) {
  std::mt19937 random(13);
  std::vector<Position> positions(12);
  for (Position& p : positions) {
    for (double& x : p) x = static_cast<int>(random() % 21) - 10;
  }
  const ExactPoints points = points_of(positions);
  for (int round = 0; round < 300; ++round) {
    // Random tetrahedra of any orientation, which share faces or not; and the neighbours claimed
    // for them may be right or wrong.
    TetComplex complex;
    complex.points = &points;
    Neighbours neighbours;
    std::vector<std::uint8_t> selected;
    ExactSum sum;
    for (std::size_t t = 0; t < 30; ++t) {
      std::array<Index, 12> order;
      std::iota(order.begin(), order.end(), 0U);
      std::shuffle(order.begin(), order.begin() + 6, random);
      complex.tetrahedra.push_back({order[0], order[1], order[2], order[3]});
      complex.inside.push_back(1);
      selected.push_back(random() % 3 != 0);
      if (selected.back() != 0)
        sum += exact::volume6(points, order[0], order[1], order[2], order[3]);
    }
    neighbours.across.assign(4 * complex.tetrahedra.size(), kNone);
    for (Index i = 0; i < neighbours.across.size(); ++i) {
      for (Index j = 0; j < i; ++j) {
        Face f = face_of(complex.tetrahedra[i / 4], static_cast<int>(i % 4)),
             g = face_of(complex.tetrahedra[j / 4], static_cast<int>(j % 4));
        std::sort(f.begin(), f.end());
        std::sort(g.begin(), g.end());
        if (f != g && random() % 200 != 0) continue;
        neighbours.across[i] = j;
        neighbours.across[j] = i;
      }
    }
    ASSERT_EQ(sum_of_volumes6(complex, neighbours, selected), sum);
  }
}

TEST(Angles, BelowTheBoundAreFoundAmongMachineIntegers) {
  std::mt19937 random(17);
  std::size_t counts[2] = {};
  for (int round = 0; round < 3000; ++round) {
    const long size = round % 2 == 0 ? 4 : 1000;
    std::array<std::array<long, 3>, 4> p;
    std::vector<Position> positions;
    for (auto& x : p) {
      for (long& c : x) c = static_cast<long>(random() % static_cast<unsigned long>(size));
      positions.push_back(position(x));
    }
    const ExactPoints points = points_of(positions);
    const int orientation = exact::orient3d(points, 0, 1, 2, 3);
    if (orientation == 0) continue;
    TetComplex complex;
    complex.points = &points;
    complex.tetrahedra = {orientation > 0 ? Tet{0, 1, 2, 3} : Tet{0, 1, 3, 2}};
    complex.inside = {1};
    Neighbours neighbours;
    neighbours.across.assign(4, kNone);
    const Polyhedron polyhedron = {
        positions, {{{0, 2, 1}}, {{0, 1, 3}}, {{1, 2, 3}}, {{2, 0, 3}}}, {}, {}};
    InputSurface surface;
    ASSERT_EQ(surface.assign(polyhedron, points), "");
    for (const double delta : {20.0, 45.0, 45.001}) {
      bool below = false, close = false;
      for (int a = 0; a < 4; ++a) {
        for (int b = 0; b < 4; ++b) {
          for (int c = 0; c < b; ++c) {
            if (a == b || a == c) continue;
            long uv = 0, uu = 0, vv = 0;
            for (int axis = 0; axis < 3; ++axis) {
              const long u = p[b][axis] - p[a][axis], v = p[c][axis] - p[a][axis];
              uv += u * v;
              uu += u * u;
              vv += v * v;
            }
            const long double cosine2 = static_cast<long double>(uv) * uv / uu / vv;
            const long double bound = std::pow(std::cos(delta * std::acos(-1.0L) / 180), 2);
            // An angle of exactly 45 degrees is not below 45.
            const bool equal = delta == 45 && 2 * uv * uv == uu * vv;
            below = below || (uv > 0 && !equal && cosine2 > bound);
            close = close || (uv > 0 && !equal && std::fabs(cosine2 - bound) < 1e-7L);
          }
        }
      }
      if (close) continue;
      const OracleReport report =
          check_angles(complex, neighbours, surface, delta, AngleScope::all);
      ASSERT_EQ(report.violations > 0, below) << "round " << round << ", " << delta;
      ++counts[below];
    }
  }
  EXPECT_GT(counts[0], 300U);
  EXPECT_GT(counts[1], 300U);
}

TEST(AngleBound, IntervalsNeverContradictIntegers) {
  std::mt19937 random(19);
  std::size_t decided = 0, not_above = 0;
  for (const double degrees : {25.0, 60.0, 90.0}) {
    for (const Doubt doubt : {Doubt::acute, Doubt::not_acute}) {
      const AngleBound bound(degrees, doubt);
      for (int round = 0; round < 2000; ++round) {
        std::array<std::array<long, 3>, 2> u;
        for (auto& x : u) {
          for (long& c : x) c = static_cast<long>(random() % 9) - 4;
        }
        const auto dot = [&](int i, int j) {
          return u[i][0] * u[j][0] + u[i][1] * u[j][1] + u[i][2] * u[j][2];
        };
        const long cosine = dot(0, 1), norms = dot(0, 0) * dot(1, 1);
        const bool surely = bound.surely_not_above(Interval(static_cast<double>(cosine)),
                                                   Interval(static_cast<double>(norms)));
        const bool above = bound.above(cosine, norms);
        ASSERT_FALSE(surely && above) << degrees << ": " << cosine << " of " << norms;
        decided += surely ? 1 : 0;
        not_above += above ? 0 : 1;
      }
    }
  }
  EXPECT_GT(decided, not_above / 2);  // most are far from the bound
}

TEST(AngleBound, TurnsOnAFacetAreThoseOfTheirProjections) {
  std::mt19937 random(23);
  std::size_t counts[3] = {};
  for (int round = 0; round < 2000; ++round) {
    // A facet in the plane z = 0, seen from above, and points over and under it.
    std::vector<Position> positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    std::array<std::array<long, 3>, 3> p;
    for (auto& x : p) {
      for (long& c : x) c = static_cast<long>(random() % 7) - 3;
      positions.push_back(position(x));
    }
    const ExactPoints points = points_of(positions);
    InputSurface::Facet facet;
    facet.normal = exact::area2(points, 0, 1, 2);
    facet.rough_normal = exact::rough_area2(points, 0, 1, 2);
    const long turn =
        (p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[1][1] - p[0][1]) * (p[2][0] - p[0][0]);
    const int wanted = turn > 0 ? 1 : turn < 0 ? -1 : 0;
    ASSERT_EQ(left_turn(points, facet, 3, 4, 5), wanted);
    ++counts[wanted + 1];
  }
  for (const std::size_t count : counts) EXPECT_GT(count, 100U);
}

TEST(ExactSigns, LengthsAndDoubles) {
  EXPECT_EQ(to_double(mpz_class(-5), 3), -40);
  EXPECT_EQ(to_double(mpz_class(3), -2), 0.75);
  EXPECT_EQ(to_double(mpz_class(0), 100), 0);
  EXPECT_EQ(to_double(mpz_class(1), 100000), kInfinity);
  EXPECT_EQ(to_double(mpz_class(1), -100000), 0);
  EXPECT_EQ(to_double(mpz_class(mpz_class(1) << 2000), -2000), 1);
  EXPECT_EQ(length({3, 4, 12}, 1), 26);
}

// -------------------------------------------------------------------------------------- measures

TEST(Measures, SmallestAltitude) {
  // Over the triangle (0,0) (3,0) (0,4), whose legs are 3 and 4; the other faces are smaller.
  const ExactPoints p = points_of({{0, 0, 0}, {3, 0, 0}, {0, 4, 0}, {0, 0, 0.25}, {1, 1, 0}});
  const double sides[4] = {6, 1.5 * 0.25, 2 * 0.25, 0};
  const double oblique = std::sqrt(36 + sides[1] * sides[1] + sides[2] * sides[2]);  // de Gua
  const double volume = 6 * 0.25 / 3;
  EXPECT_NEAR(smallest_altitude(p, {0, 1, 2, 3}), 3 * volume / oblique, 1e-15);
  EXPECT_NEAR(smallest_altitude(p, {0, 2, 1, 3}), 3 * volume / oblique, 1e-15);
  EXPECT_EQ(smallest_altitude(p, {0, 1, 2, 4}), 0);
}

// Spheres of radius 1 around the origin: through the corners of a tetrahedron, of a triangle and
// the ends of an edge, diametral ones of the latter two.
TEST(BallSide, TellsInsideFromOutside) {
  const ExactPoints p = points_of({{1, 0, 0},
                                   {0, 1, 0},
                                   {0, 0, 1},
                                   {-1, 0, 0},
                                   {0, -1, 0},
                                   {0.5, 0.5, 0.5},
                                   {-0.5, 0.25, -0.75},
                                   {0.75, -0.75, 0.75},
                                   {0, 0, -2},
                                   {0, 0, -1}});
  // Positively oriented, as all tetrahedra of a mesh are.
  const bool positive = exact::orient3d(p, 0, 1, 2, 3) > 0;
  const std::array<Index, 4> tet =
      positive ? std::array<Index, 4>{0, 1, 2, 3} : std::array<Index, 4>{1, 0, 2, 3};
  for (const BallSide& ball :
       {BallSide::circumscribed(p, tet), BallSide::diametral(p, std::array<Index, 3>{0, 1, 3}),
        BallSide::diametral(p, 0, 3)}) {
    EXPECT_EQ(ball.side(5), -1);
    EXPECT_EQ(ball.side(6), -1);
    EXPECT_EQ(ball.side(7), 1);
    EXPECT_EQ(ball.side(8), 1);
    EXPECT_EQ(ball.side(4), 0);  // on the sphere, which rounded numbers cannot tell
    EXPECT_EQ(ball.side(9), 0);
  }
}

// Far from the origin as well as near it, a small query in a grid of 50 x 50 unit boxes visits the
// boxes that it meets and few others.
TEST(PlaneGrid, VisitsWhatIsNear) {
  for (const double offset : {-1000.0, -25.0, 0.0, 1000.0}) {
    std::vector<PlaneGrid::Box> items;
    for (int i = 0; i < 2500; ++i) {
      const PlaneGrid::Corner low = {offset + i % 50, offset + i / 50};  // NOLINT: rows of 50
      items.push_back({low, {low[0] + 1, low[1] + 1}});
    }
    PlaneGrid grid(items);
    for (const double place : {0.5, 20.5, 49.5}) {
      const PlaneGrid::Corner at = {offset + place, offset + place};
      std::vector<std::uint32_t> found;
      grid.visit({at, at}, [&](std::uint32_t item) { found.push_back(item); });
      const auto here = static_cast<std::uint32_t>(51 * static_cast<int>(place));
      EXPECT_EQ(std::count(found.begin(), found.end(), here), 1);
      EXPECT_LE(found.size(), 25U) << offset;
    }
  }
}

// A quadrilateral face is one facet if it is flat, however steep. A saddle is two, though the sum
// of its triangles' normals is upright.
TEST(InputSurfaces, PolygonsAreFacetsWhereTheyAreFlat) {
  const auto facets = [](const Polyhedron& polyhedron) {
    const ExactPoints points = points_of(polyhedron.vertices);
    InputSurface surface;
    EXPECT_EQ(surface.assign(polyhedron, points), "");
    return surface.facets().size();
  };
  const auto box = [](double top, double lift) {
    Polyhedron p;
    const std::array<std::array<double, 2>, 4> corner = {{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
    for (const auto& [x, y] : corner) p.vertices.push_back({2 * x, 2 * y, 0});
    for (std::size_t i = 0; i < 4; ++i) {
      const double z = 4 + (i % 2 == 0 ? lift : -lift);
      p.vertices.push_back({top * corner[i][0], top * corner[i][1], z});
    }
    for (const auto& [a, b, c, d] : {std::array<Index, 4>{0, 3, 2, 1},
                                     {4, 5, 6, 7},
                                     {0, 1, 5, 4},
                                     {1, 2, 6, 5},
                                     {2, 3, 7, 6},
                                     {3, 0, 4, 7}}) {
      p.triangles.push_back({a, b, c});
      p.triangles.push_back({a, c, d});
      p.polygons.insert(p.polygons.end(), 2, static_cast<Index>(p.polygons.size() / 2));
    }
    return p;
  };
  EXPECT_EQ(facets(box(1, 0)), 6U);
  EXPECT_EQ(facets(box(2, 0)), 6U);
  EXPECT_EQ(facets(box(2, 0.5)), 7U);  // upright sides stay flat
}

// A prism over a triangle whose corner at vertex 0 has the half angle a, tan a = 1 / 4, and whose
// opposite side is 12 away, so that the chamfer distance is 4 at most. Smallest is the side of the
// bridge in that corner, sin a / (cos a + 1 / 2) of the chamfer distance (Figure 4).
TEST(ChamferFeatures, OfASharpPrism) {
  Polyhedron prism;
  for (const double z : {0.0, 100.0}) {
    for (const auto& [x, y] : {std::pair(0.0, 0.0), {12.0, -3.0}, {12.0, 3.0}}) {
      prism.vertices.push_back({x, y, z});
    }
  }
  prism.triangles = {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3},
                     {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}};
  const ExactPoints points = points_of(prism.vertices);
  InputSurface surface;
  ASSERT_EQ(surface.assign(prism, points), "");
  const AcuteCorners corners(points, surface);
  const auto sixty = [](Index) { return 60.0; };
  const CornerThresholds thresholds = {sixty, sixty};
  const auto all = [](Index) { return true; };
  const double side = 1 / (4 + std::sqrt(17.0) / 2);
  for (const Index v : {0U, 3U}) {
    EXPECT_NEAR(ChamferFeatures(points, surface, corners, thresholds, 0).smallest(v, all), 4 * side,
                1e-12);
    EXPECT_NEAR(ChamferFeatures(points, surface, corners, thresholds, 1).smallest(v, all), side,
                1e-12);
  }
  for (const Index v : {1U, 2U, 4U, 5U}) {  // no angle below 60 degrees
    EXPECT_EQ(ChamferFeatures(points, surface, corners, thresholds, 0).smallest(v, all), kInfinity);
  }
}

// The boundary that delmesher lists tiles the surface; faces of the hull do not belong to it.
TEST(SameMesh, FacesOfTheHullAreNoBoundary) {
  delmesher::ExactRecord record;
  record.points =
      explicit_points(std::vector<Position>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
  record.mesh_vertices = {0, 1, 2, 3};
  record.final = {{{0, 1, 2, 3}, true}};
  record.final_facets = {{1, 2, 3, 7}};
  MeshFile mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.tetrahedra = {{0, 1, 2, 3}};
  mesh.regions = {1};
  const auto violations = [&](const std::vector<Face>& boundary, Index facet = 7) {
    mesh.boundary = boundary;
    mesh.facets.assign(boundary.size(), facet);
    Promise promise;
    promise.region = delmesher::Region::hull;
    return check_same_mesh(mesh, record, promise, false).violations;
  };
  EXPECT_EQ(violations({{1, 2, 3}}), 0U);
  EXPECT_EQ(violations({{3, 1, 2}}), 0U);
  EXPECT_EQ(violations({{2, 1, 3}}), 1U);
  EXPECT_EQ(violations({{1, 2, 3}}, 0), 1U);
  EXPECT_EQ(violations({}), 1U);
  for (const Face& face : {Face{0, 3, 2}, {0, 1, 3}, {0, 2, 1}}) {
    EXPECT_EQ(violations({{1, 2, 3}, face}), 1U);
  }
}

// Formats without a region 0 have 2 for the outside; no other number is one, nor are both at once.
TEST(SameMesh, TheOutsideIsOneOfTwoRegions) {
  delmesher::ExactRecord record;
  record.points = explicit_points(
      std::vector<Position>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}, {0, 0, -1}});
  record.mesh_vertices = {0, 1, 2, 3, 4, 5};
  record.final = {{{0, 1, 2, 3}, true}, {{1, 2, 3, 4}, false}, {{0, 2, 1, 5}, false}};
  MeshFile mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}, {0, 0, -1}};
  for (const auto& tet : record.final) mesh.tetrahedra.push_back(tet.vertices);
  Promise promise;
  promise.region = delmesher::Region::hull;
  const auto violations = [&](std::vector<std::int64_t> regions) {
    mesh.regions.assign(regions.begin(), regions.end());
    return check_same_mesh(mesh, record, promise, false).violations;
  };
  EXPECT_EQ(violations({1, 0, 0}), 0U);
  EXPECT_EQ(violations({1, 2, 2}), 0U);
  EXPECT_EQ(violations({1, 0, 2}), 1U);
  EXPECT_EQ(violations({1, 3, 3}), 2U);
  EXPECT_EQ(violations({1, -1, -1}), 2U);
  EXPECT_EQ(violations({2, 2, 2}), 1U);
}

// ------------------------------------------------------------------------------- encroachment

// One edge after another of 16 is encroached by a corner of its own tetrahedron. With that many
// vertices only a few edges can be tried against all of them, yet each has to be found.
TEST(Encroachment, ByANeighbourIsFoundWhateverIsSampled) {
  constexpr std::size_t kVertices = 1U << 16U, kEdges = 16;
  std::vector<Position> positions;
  TetComplex complex;
  delmesher::ExactRecord record;
  record.parameters.gabriel = true;
  while (positions.size() < kVertices) {
    const auto first = static_cast<Index>(positions.size());
    const double x = 10.0 * first;
    for (const Position& p : {Position{0, 0, 0}, {2, 0, 0}, {1, 0.5, 0}, {1, 3, 3}}) {
      positions.push_back({x + p[0], p[1], p[2]});
    }
    complex.tetrahedra.push_back({first, first + 1, first + 2, first + 3});
    if (record.segments.size() < kEdges) {
      record.segments.push_back({false, kNone, {first, first + 1}});
    }
  }
  const ExactPoints points = points_of(positions);
  complex.points = &points;
  RefinedMesh mesh;
  mesh.record = &record;
  mesh.points = &points;
  mesh.complex = &complex;
  const OracleReport report = check_encroachment(mesh);
  EXPECT_EQ(report.checked, kEdges);
  EXPECT_GE(report.violations, kEdges);
}

// The vertex is of another tetrahedron, and doubles do not tell on which side of the ball around
// the edge or the face it is: centre (1, 0, 0), radius 1.
TEST(Encroachment, ByAnotherTetrahedronIsDecidedExactly) {
  const auto violations = [](const Position& v) {
    std::array<std::uint64_t, 2> result{};  // of the edge, of the face
    for (const bool face : {false, true}) {
      const ExactPoints points = points_of(
          {{0, 0, 0}, {2, 0, 0}, {1, -1, 0}, {1, 0, 5}, v, {50, 0, 0}, {50, 1, 0}, {50, 0, 1}});
      TetComplex complex;
      complex.points = &points;
      complex.tetrahedra = {{0, 1, 2, 3}, {4, 5, 6, 7}};
      delmesher::ExactRecord record;
      record.parameters.gabriel = true;
      if (face) {
        record.refined_facets.push_back({0, 1, 2, 0});
      } else {
        record.segments.push_back({false, kNone, {0, 1}});
      }
      RefinedMesh mesh;
      mesh.record = &record;
      mesh.points = &points;
      mesh.complex = &complex;
      result[face ? 1 : 0] = check_encroachment(mesh).violations;
    }
    return result;
  };
  using Two = std::array<std::uint64_t, 2>;
  EXPECT_EQ(violations({1, 0, 0.5}), (Two{1, 1}));
  EXPECT_EQ(violations({1, 0, 1 - 0x1p-53}), (Two{1, 1}));
  EXPECT_EQ(violations({1, 0, 1}), (Two{0, 0}));
  EXPECT_EQ(violations({1, 0, 1 + 0x1p-52}), (Two{0, 0}));
}

TEST(Measures, TasksRunOnceEachAndTheFirstErrorIsThrown) {
  for (const unsigned threads : {0U, 1U, 3U}) {
    std::array<std::atomic<int>, 20> runs{};
    run_tasks(threads, runs.size(), [&](std::size_t i) { ++runs[i]; });
    for (const auto& count : runs) EXPECT_EQ(count, 1);
    run_tasks(threads, 0, [](std::size_t) { FAIL(); });
    EXPECT_THROW(run_tasks(threads, 5,
                           [](std::size_t i) {
                             if (i >= 2) throw std::runtime_error(std::to_string(i));
                           }),
                 std::runtime_error);
  }
}

// Three tasks that wait for each other would not end with fewer than three threads.
TEST(Measures, AsManyTasksRunAtOnceAsThereAreThreads) {
  std::mutex mutex;
  std::condition_variable all_here;
  int here = 0, met = 0;
  run_tasks(3, 3, [&](std::size_t) {
    std::unique_lock lock(mutex);
    ++here;
    all_here.notify_all();
    met += all_here.wait_for(lock, std::chrono::seconds(20), [&] { return here == 3; }) ? 1 : 0;
  });
  EXPECT_EQ(met, 3);
}

// ------------------------------------------------------------------------------------- STL files

std::string written(const std::string& name, const std::string& text) {
  const std::string path = testing::TempDir() + name;
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

// Each solid of a text file is a label of its own, from 0; equal corners are one vertex.
TEST(Stl, SolidsAreLabelsAndCornersAreWelded) {
  const std::string first =
      "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
      "0\nendloop\nendfacet\n";
  const std::string second =
      "facet normal 0 0 1\nouter loop\nvertex 1 0 -0\nvertex 1 1 0.5\nvertex 0 1 "
      "0\nendloop\nendfacet\n";
  const Polyhedron surface = read_surface(written(
      "two_solids.stl", "solid a\n" + first + "endsolid a\nsolid b\n" + second + "endsolid b\n"));
  EXPECT_EQ(surface.labels, (std::vector<std::int32_t>{0, 1}));
  EXPECT_EQ(surface.triangles, (std::vector<std::array<Index, 3>>{{0, 1, 2}, {1, 3, 2}}));
  ASSERT_EQ(surface.vertices.size(), 4U);
  EXPECT_EQ(surface.vertices[3], (Position{1, 1, 0.5}));
  for (const char* wrong : {"vertex 0 0\n", "vertex 0 0 0\nvertex 0 0 0\n"}) {
    std::string text = "solid a\n" + first;
    text.replace(text.find("vertex 0 0 0\n"), 13, wrong);  // a number less, a corner more
    EXPECT_THROW(read_surface(written("wrong.stl", text)), ReadError);
  }
  std::string two_corners = "solid a\n" + first;
  two_corners.erase(two_corners.find("vertex 0 0 0\n"), 13);
  EXPECT_THROW(read_surface(written("wrong.stl", two_corners)), ReadError);
}

// The same as 84 bytes and 50 for each triangle, the corners from byte 12 of these.
TEST(Stl, BinaryFilesHaveTheirCornersWhereTheFormatSays) {
  const float corners[2][9] = {{0, 0, 0, 1, 0, 0, 0, 1, 0}, {1, 0, 0, 1, 1, 0.5, 0, 1, 0}};
  std::string bytes(84 + 2 * 50, '\0');
  bytes[80] = 2;
  for (std::size_t t = 0; t < 2; ++t) {
    std::memcpy(&bytes[84 + 50 * t + 12], corners[t], sizeof corners[t]);
  }
  const Polyhedron surface = read_surface(written("binary.stl", bytes));
  EXPECT_EQ(surface.triangles, (std::vector<std::array<Index, 3>>{{0, 1, 2}, {1, 3, 2}}));
  ASSERT_EQ(surface.vertices.size(), 4U);
  EXPECT_EQ(surface.vertices[1], (Position{1, 0, 0}));
  EXPECT_EQ(surface.vertices[3], (Position{1, 1, 0.5}));
}

// ------------------------------------------------------------------------------------- PLY files

template <class Value>
void append(std::string& bytes, Value value, bool big) {
  char of_value[sizeof value];
  std::memcpy(of_value, &value, sizeof value);
  if (big) std::reverse(of_value, of_value + sizeof value);
  bytes.append(of_value, sizeof value);
}

// A triangle with one coordinate and one index of this type, in both orders of bytes. (That of this
// machine is little-endian.)
template <class Value>
void expect_binary_ply(const char* type, Value value) {
  for (const bool big : {false, true}) {
    std::string bytes = std::string("ply\nformat binary_") + (big ? "big" : "little") +
                        "_endian 1.0\ncomment no end_header yet\nelement vertex 3\n"
                        "property double x\nproperty " +
                        type + " y\nproperty float z\nelement face 1\nproperty list uchar " + type +
                        " vertex_indices\nproperty int label\nend_header\n";
    for (int v = 0; v < 3; ++v) {
      append(bytes, 0.1 * v, big);
      append(bytes, v == 0 ? value : static_cast<Value>(v), big);
      append(bytes, 0.5F, big);
    }
    append(bytes, std::uint8_t{3}, big);
    for (const int v : {2, 0, 1}) append(bytes, static_cast<Value>(v), big);
    append(bytes, std::int32_t{-7}, big);
    const Polyhedron surface = read_surface(written("binary.ply", bytes));
    EXPECT_EQ(surface.vertices,
              (std::vector<Position>{
                  {0, static_cast<double>(value), 0.5}, {0.1, 1, 0.5}, {0.1 * 2, 2, 0.5}}))
        << type;
    EXPECT_EQ(surface.triangles, (std::vector<std::array<Index, 3>>{{2, 0, 1}})) << type;
    EXPECT_EQ(surface.labels, std::vector<std::int32_t>{-7}) << type;
    EXPECT_THROW(read_surface(written("cut.ply", bytes.substr(0, bytes.size() - 1))), ReadError);
  }
}

TEST(Ply, BinaryFilesHaveEightTypesOfNumbers) {
  for (const char* type : {"double", "float64"}) expect_binary_ply<double>(type, 0.3);
  for (const char* type : {"float", "float32"}) expect_binary_ply<float>(type, 0.3F);
  for (const char* type : {"int", "int32"}) expect_binary_ply<std::int32_t>(type, -2000000000);
  for (const char* type : {"uint", "uint32"}) expect_binary_ply<std::uint32_t>(type, 4000000000U);
  for (const char* type : {"short", "int16"}) expect_binary_ply<std::int16_t>(type, -30000);
  for (const char* type : {"ushort", "uint16"}) expect_binary_ply<std::uint16_t>(type, 60000);
  for (const char* type : {"char", "int8"}) expect_binary_ply<std::int8_t>(type, -100);
  for (const char* type : {"uchar", "uint8"}) expect_binary_ply<std::uint8_t>(type, 200);
}

// ---------------------------------------------------------------------------------------- reports

// All that an oracle says stands in both forms of the report.
TEST(Reports, LeaveNothingOut) {
  VerifyReport report;
  report.verdict = Verdict::deviating;
  report.deviation = 0.21875;
  report.deviation_ulps = 4711;
  report.deviation_share = 0.0078125;
  report.inverted = 1201;
  report.flat = 1202;
  OracleReport good("good-one", "things"), bad("bad-one", "other things");
  good.checked = 1203;
  good.notes = {"a note"};
  good.figures = {{"height", 0.4375}};
  good.histograms = {
      {"slopes", {2001, 2002, 2003, 2004, 2005, 2006, 2007, 2008, 2009, 2010, 2011, 2012}}};
  bad.checked = 1204;
  for (int i = 0; i < 7; ++i) bad.fail("finding " + std::to_string(i));
  report.oracles = {good, bad};
  EXPECT_EQ(bad.violations, 7U);
  EXPECT_EQ(bad.findings.size(), 5U);
  EXPECT_EQ(report.find("bad-one"), &report.oracles[1]);
  EXPECT_EQ(report.find("no-one"), nullptr);
  EXPECT_FALSE(report.all_passed());
  for (const std::string& text : {to_json(report), to_text(report)}) {
    for (const char* part : {"deviating", "0.21875", "4711", "0.0078125", "1201", "1202",
                             "good-one", "things", "1203", "a note", "height", "0.4375", "slopes",
                             "bad-one", "1204", "7", "finding 0", "finding 4"}) {
      EXPECT_NE(text.find(part), std::string::npos) << part << " in " << text;
    }
    for (int count = 2001; count <= 2012; ++count) {
      EXPECT_NE(text.find(std::to_string(count)), std::string::npos) << count;
    }
    EXPECT_EQ(text.find("finding 5"), std::string::npos);
  }
  EXPECT_NE(to_text(report).find("7 violations"), std::string::npos);
  EXPECT_EQ(to_text(report).find("0 violations"), std::string::npos);
  report.oracles = {good};
  EXPECT_TRUE(report.all_passed());
  report.oracles[0].checked = 0;
  EXPECT_FALSE(report.all_passed());
  report.oracles.clear();
  EXPECT_FALSE(report.all_passed());
}

TEST(Reports, NameVerdicts) {
  EXPECT_STREQ(verdict_name(Verdict::exact), "exact");
  EXPECT_STREQ(verdict_name(Verdict::rounded), "rounded");
  EXPECT_STREQ(verdict_name(Verdict::deviating), "deviating");
  EXPECT_STREQ(verdict_name(Verdict::broken), "broken");
}

// For all lengths of texts, wherever a line has to be broken.
TEST(Reports, NoLineOfTextIsLongerThan120Characters) {
  for (std::size_t length = 1; length <= 100; ++length) {
    VerifyReport report;
    OracleReport oracle("an-oracle", "things");
    oracle.checked = 1;
    oracle.figures = {{std::string(length, 'x'), 1}, {"y", 2}, {std::string(100, 'z'), 3}};
    oracle.notes = {std::string(length, 'n') + " goes on " + std::string(100, 'm')};
    report.oracles = {oracle};
    const std::string text = to_text(report);
    for (std::size_t at = 0; at < text.size(); at = text.find('\n', at) + 1) {
      ASSERT_LE(text.find('\n', at) - at, 120U) << text.substr(at, 200);
    }
  }
}

// --------------------------------------------------------------------------------------- promises

// The defaults are those of README's table of options.
TEST(Promises, AreReadFromCommandLines) {
  Promise p;
  EXPECT_EQ(parse_promise("", p), "");
  EXPECT_EQ(p.delta, 14.47);
  EXPECT_EQ(parse_promise("plane", p), "");
  EXPECT_EQ(p.delta, 20.7);
  for (const char* text : {"mesh --delta=3 --tau 0.5", "--delta 3 --tau=0.5"}) {
    EXPECT_EQ(parse_promise(text, p), "") << text;
    EXPECT_EQ(p.delta, 3) << text;
    EXPECT_EQ(p.tau, 0.5) << text;
    EXPECT_EQ(p.acute, 60) << text;
  }
  for (const char* text : {"--preset=paper --delta=3", "--delta 3 --preset paper"}) {
    EXPECT_EQ(parse_promise(text, p), "") << text;
    EXPECT_EQ(p.delta, 3) << text;
    EXPECT_EQ(p.acute, 90) << text;
    EXPECT_TRUE(p.gabriel) << text;
  }
  for (const char* text : {"paper", "--preset", "mesh --preset", "--preset=", "--preset paperback",
                           "--delta", "--delta=", "--delta=3x", "--nothing=3"}) {
    EXPECT_NE(parse_promise(text, p), "") << text;
  }
}

// --------------------------------------------------------------------------- the record and the
// file

TEST(Sidecars, OfNoVersionAreRefusedForThat) {
  for (const char* version : {"0", "99"}) {
    std::string said = "nothing";
    try {
      read_sidecar(written("version.exact", std::string("delmesher-exact ") + version + "\n"));
    } catch (const ReadError& error) {
      said = error.what();
    }
    EXPECT_NE(said.find(version == std::string("0") ? "unknown version 0" : "99"),
              std::string::npos)
        << said;
  }
}

// The distance of a written vertex from its place is measured, not only compared.
TEST(Rounding, TheLargestDistanceIsSaid) {
  const samples::ExactSample sample = samples::exact_sample();
  const ExactPoints points = [&] {
    ExactPoints result;
    EXPECT_EQ(result.assign(sample.exact.points), "");
    return result;
  }();
  MeshFile mesh = sample.sample.mesh;
  const auto largest = [&] {
    const OracleReport report =
        check_rounding(mesh, sample.exact, points, {.ulp = 0x1p-52, .allowed = 0.5});
    EXPECT_EQ(report.violations, 0U);
    EXPECT_EQ(report.checked, mesh.vertices.size());
    EXPECT_EQ(report.figures.at(0).first, "largest distance");
    return report.figures.at(0).second;
  };
  EXPECT_EQ(largest(), 0);
  for (int axis = 0; axis < 3; ++axis) {
    const double was = mesh.vertices[1][axis];
    mesh.vertices[1][axis] += 0.25;
    EXPECT_NEAR(largest(), 0.25, 1e-15) << axis;
    mesh.vertices[1][axis] = was;
  }
}

// Every vertex of the last mesh and every tetrahedron of that before repairs is looked at.
TEST(Repairs, AllIsCounted) {
  samples::ExactSample sample = samples::exact_sample();
  sample.exact.unrepaired = sample.exact.final;
  ExactPoints points;
  ASSERT_EQ(points.assign(sample.exact.points), "");
  const auto run = [&] { return check_repairs(sample.exact, points, Promise()); };
  const auto figure = [](const OracleReport& report, const std::string& name) {
    for (const auto& [key, value] : report.figures) {
      if (key == name) return value;
    }
    return -1.0;
  };
  OracleReport report = run();
  EXPECT_EQ(report.checked, 6U + 4U);
  EXPECT_EQ(report.violations, 0U);
  EXPECT_EQ(figure(report, "tetrahedra changed"), 0);
  EXPECT_EQ(figure(report, "not positive on doubles"), 0);
  // An inverted tetrahedron is not positive; the last mesh lacks it.
  std::swap(sample.exact.unrepaired[1].vertices[0], sample.exact.unrepaired[1].vertices[1]);
  sample.exact.final.erase(sample.exact.final.begin() + 1);
  report = run();
  EXPECT_EQ(report.checked, 6U + 4U);
  EXPECT_EQ(report.violations, 0U);
  EXPECT_EQ(figure(report, "tetrahedra changed"), 1);
  EXPECT_EQ(figure(report, "not positive on doubles"), 1);
  EXPECT_EQ(figure(report, "edges from there"), 0);
  // A point that no tetrahedron had came with the repairs.
  sample.exact.final = sample.exact.unrepaired;
  sample.exact.unrepaired = {sample.exact.final[0]};
  EXPECT_GT(run().violations, 0U);
}

// ------------------------------------------------------------------------------------- the plane

PlanePoints plane_points(const std::vector<std::array<double, 2>>& given) {
  PlanePoints points;
  for (const auto& [x, y] : given) points.add({x, y, x, y});
  return points;
}

TEST(PlaneSigns, OfASquareAndBeside) {
  PlanePoints p = plane_points({{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0.5, 0.5}, {2, 0}, {3, 3}});
  EXPECT_EQ(p.orient(0U, 1U, 2U), 1);
  EXPECT_EQ(p.orient(0U, 2U, 1U), -1);
  EXPECT_EQ(p.orient(0U, 1U, 5U), 0);
  EXPECT_EQ(p.in_circle(0, 1, 2, 4), 1);
  EXPECT_EQ(p.in_circle(0, 1, 2, 3), 0);
  EXPECT_EQ(p.in_circle(0, 1, 2, 5), -1);
  EXPECT_EQ(p.in_circle(0, 2, 1, 5), 1);
  EXPECT_TRUE(p.encroaches(0, 4, 5));
  EXPECT_FALSE(p.encroaches(0, 4, 1));  // on the circle
  EXPECT_TRUE(p.encroaches(0, 1, 5));
  EXPECT_FALSE(p.encroaches(0, 1, 2));  // a right angle
  EXPECT_FALSE(p.encroaches(0, 6, 1));
  EXPECT_EQ(p.checks, 12U);
  EXPECT_EQ(p.parameter(4, 0, 2), mpq_class(0.5));
  EXPECT_EQ(p.parameter(6, 0, 2), 3);
  EXPECT_EQ(p.parameter(3, 0, 3), 1);  // upright
  EXPECT_NEAR(p.distance(0, 6), std::sqrt(18.0), 1e-15);
  EXPECT_NEAR(p.distance(5, 3), std::sqrt(5.0), 1e-15);
  EXPECT_EQ(p.distance_to_segment(3, 0, 1), 1);
  EXPECT_DOUBLE_EQ(p.distance_to_segment(3, 1, 5), std::sqrt(2.0));   // beyond the first end
  EXPECT_DOUBLE_EQ(p.distance_to_segment(6, 0, 1), std::sqrt(13.0));  // beyond the second
  EXPECT_NEAR(p.distance_to_segment(1, 0, 2), std::sqrt(0.5), 1e-15);
  EXPECT_EQ(p.distance_to_segment(4, 0, 2), 0);
}

// Where doubles tell, rationals are not asked. Here these are all zero and would answer 0, so the
// answer comes from the doubles, and it has to be right.
TEST(PlaneSigns, DoublesTellWhatIsObvious) {
  std::mt19937_64 random(11);
  for (int round = 0; round < 2000; ++round) {
    std::array<std::array<std::int64_t, 2>, 4> x;
    PlanePoints p;
    for (auto& point : x) {
      for (std::int64_t& c : point) c = static_cast<std::int64_t>(random() % 2001) - 1000;
      p.add({0, 0, static_cast<double>(point[0]), static_cast<double>(point[1])});
    }
    const auto sign = [](std::int64_t value) { return value > 0 ? 1 : value < 0 ? -1 : 0; };
    const auto area = [&](int a, int b, int c) {
      return (x[b][0] - x[a][0]) * (x[c][1] - x[a][1]) - (x[b][1] - x[a][1]) * (x[c][0] - x[a][0]);
    };
    EXPECT_EQ(p.orient(0U, 1U, 2U), sign(area(0, 1, 2)));
    std::int64_t lifted = 0;
    for (int i = 0; i < 3; ++i) {
      const std::int64_t u = x[i][0] - x[3][0], v = x[i][1] - x[3][1];
      lifted += (u * u + v * v) * area(3, (i + 1) % 3, (i + 2) % 3);
    }
    EXPECT_EQ(p.in_circle(0, 1, 2, 3), sign(lifted));
  }
}

TEST(PlaneSigns, AgreeWithMachineIntegersOnALattice) {
  std::mt19937_64 random(7);
  std::array<std::array<int, 3>, 2> counts{};
  for (int round = 0; round < 4000; ++round) {
    std::vector<std::array<double, 2>> given(4);
    std::array<std::array<std::int64_t, 2>, 4> x;
    for (int i = 0; i < 4; ++i) {
      for (int k = 0; k < 2; ++k) {
        x[i][k] = static_cast<std::int64_t>(random() % 4);
        given[i][k] = 0x1p40 + static_cast<double>(x[i][k]) * 0x1.0000001p10;
      }
    }
    PlanePoints p = plane_points(given);
    const auto sign = [](std::int64_t value) { return value > 0 ? 1 : value < 0 ? -1 : 0; };
    const auto area = [&](int a, int b, int c) {
      return (x[b][0] - x[a][0]) * (x[c][1] - x[a][1]) - (x[b][1] - x[a][1]) * (x[c][0] - x[a][0]);
    };
    ASSERT_EQ(p.orient(0U, 1U, 2U), sign(area(0, 1, 2)));
    ++counts[0][sign(area(0, 1, 2)) + 1];
    std::int64_t lifted = 0;
    for (int i = 0; i < 3; ++i) {
      const std::int64_t u = x[i][0] - x[3][0], v = x[i][1] - x[3][1];
      lifted += (u * u + v * v) * area(3, (i + 1) % 3, (i + 2) % 3);
    }
    ASSERT_EQ(p.in_circle(0, 1, 2, 3), sign(lifted));
    ++counts[1][sign(lifted) + 1];
  }
  for (const auto& of_predicate : counts) {
    for (const int count : of_predicate) EXPECT_GT(count, 100);
  }
}

// A vertex on a segment cuts it, whichever vertex it is. A vertex beside it, beyond its end or at
// its end does not.
TEST(PlaneGraph, SegmentsAreCutWhereVerticesLieOnThem) {
  delmesher::PlanarGraph graph;
  graph.vertices = {{1, 0}, {0, 0}, {4, 0}, {2, 0x1p-40}, {3, 0}, {5, 0}};
  graph.segments = {{1, 2}, {2, 1}};
  PlaneGraph cut(graph);
  ASSERT_EQ(cut.pieces().size(), 3U);
  const std::array<Index, 4> along = {1, 0, 4, 2};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(cut.pieces()[i].a, along[i]);
    EXPECT_EQ(cut.pieces()[i].b, along[i + 1]);
    EXPECT_EQ(cut.pieces()[i].segment, 0U);
  }
}

TEST(PlaneGraph, KnowsTheAreaOfASingleRing) {
  delmesher::PlanarGraph graph;
  graph.vertices = {{0, 0}, {4, 0}, {4, 3}, {10, 0}, {11, 0}, {11, 1}};
  const auto twice_area = [&](const std::vector<std::array<Index, 2>>& segments) {
    graph.segments.assign(segments.begin(), segments.end());
    return PlaneGraph(graph).area_of_ring();
  };
  EXPECT_EQ(twice_area({{0, 1}, {1, 2}, {2, 0}}), 12);
  EXPECT_EQ(twice_area({{2, 1}, {0, 2}, {0, 1}}), 12);  // clockwise, as they come
  EXPECT_LT(twice_area({{0, 1}, {1, 2}}), 0);
  EXPECT_LT(twice_area({{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}}), 0);
  graph.segments = {{0, 1}, {1, 2}, {2, 0}};
  EXPECT_TRUE(PlaneGraph(graph).closed_rings());
  graph.segments.pop_back();
  EXPECT_FALSE(PlaneGraph(graph).closed_rings());
}

// The last line is a line, with or without its end.
TEST(PlaneFiles, AreReadToTheirLastCharacter) {
  const std::string ring = "0 0\n4 0\n0 4";
  for (const char* end : {"", "\n", "\n\n", "\r\n", "\n>"}) {
    EXPECT_EQ(read_plane_graph(written("ring.txt", ring + end)).vertices.size(), 3U);
  }
  EXPECT_THROW(read_plane_graph(written("ring.txt", ring + "\n7")), ReadError);
  EXPECT_THROW(read_plane_graph(written("ring.txt", ring + "\nx")), ReadError);
}

TEST(PlaneFiles, ListedEdgesHaveMarkers) {
  const std::string path = written("triangle.node", "3 2 0 0\n1 0 0\n2 4 0\n3 0 4\n");
  written("triangle.ele", "1 3 0\n1 1 2 3\n");
  written("triangle.poly", "0 2 0 0\n3 1\n1 1 2 7\n2 2 3 8\n3 3 1 9\n0\n");
  PlaneFile file = read_plane_file(path);
  EXPECT_TRUE(file.lists_edges);
  EXPECT_EQ(file.edges, (std::vector<std::array<Index, 2>>{{0, 1}, {1, 2}, {2, 0}}));
  EXPECT_EQ(file.markers, (std::vector<std::int32_t>{7, 8, 9}));
  written("triangle.poly", "0 2 0 0\n3 0\n1 1 2\n2 2 3\n3 3 1\n0\n");
  file = read_plane_file(path);
  EXPECT_EQ(file.markers, (std::vector<std::int32_t>{0, 0, 0}));
}

// ------------------------------------------------------------------------------ meshes of no
// record

// The sphere through the first tetrahedron contains the apex of the second, and the other way
// round: reported once for the face between them, once for each of the two.
TEST(Delaunay, AFaceBetweenTwoSpheresIsNamed) {
  ExactPoints points;
  ASSERT_EQ(
      points.assign(std::vector<Position>{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, 1}, {1, 1, -1}}),
      "");
  TetComplex complex{&points, {{0, 1, 2, 3}, {0, 2, 1, 4}}, {}, 0, 5};
  Neighbours neighbours;
  ASSERT_TRUE(check_complex(complex, neighbours).passed());
  const OracleReport report = check_delaunay(complex, neighbours);
  EXPECT_EQ(report.violations, 3U) << report.findings.front();
  EXPECT_NE(report.findings.front().find("face"), std::string::npos) << report.findings.front();
}

}  // namespace
}  // namespace tetproof
