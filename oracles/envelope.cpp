#include "oracles/envelope.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iomanip>
#include <map>
#include <sstream>
#include <utility>
#include <vector>

#include "oracles/base/box.h"
#include "oracles/base/box_tree.h"
#include "oracles/base/triangle_distance.h"
#include "oracles/base/vectors.h"
#include "oracles/mesh/loose_points.h"
#include "oracles/shared_data.h"
#include "oracles/surface/input_surface.h"
#include "oracles/tolerance.h"

namespace tetproof::oracles {
namespace {

Corners corners_of(const Polyhedron& surface, std::size_t t) {
  const auto& [a, b, c] = surface.triangles[t];
  return {surface.vertices[a], surface.vertices[b], surface.vertices[c]};
}

std::vector<BoxTree::Box> boxes_of(const Polyhedron& surface) {
  std::vector<BoxTree::Box> boxes;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    boxes.push_back(box_of(corners_of(surface, t)));
  }
  return boxes;
}

// The largest distance of a surface from another, by branch and bound: a distance from one triangle
// is convex, so over a piece it is largest at a corner; and distances change by no more than the
// way.
class Farthest {
 public:
  Farthest(const Polyhedron& to, double precision, double enough)
      : to_(to), tree_(boxes_of(to)), precision_(precision), least_(enough / 10) {}

  void look_at(const Corners& whole) {
    std::vector<Corners> pieces = {whole};
    while (!pieces.empty()) {
      const Corners piece = pieces.back();
      pieces.pop_back();
      const auto [most, near] = upper_bound(piece);
      if (most > bound()) split(piece, near, pieces);
    }
  }
  double bound() const { return std::max(lower_, least_) + precision_; }
  // The point seen that is farthest away.
  const Position& place() const { return place_; }

 private:
  // The longest side, where it leaves what is near the triangle `near`, if it does: one part may be
  // done then. Else in the middle.
  void split(const Corners& piece, Index near, std::vector<Corners>& pieces) const {
    if (cut(piece, near, pieces)) return;
    constexpr double kLeast = 0.02;  // of the side: else pieces might become no smaller
    std::size_t longest = 0;
    for (std::size_t i = 1; i < 3; ++i) {
      if (quick_distance(piece[i], piece[(i + 1) % 3]) >
          quick_distance(piece[longest], piece[(longest + 1) % 3])) {
        longest = i;
      }
    }
    const Position& a = piece[longest];
    const Position& b = piece[(longest + 1) % 3];
    const Position& c = piece[(longest + 2) % 3];
    const Corners triangle = corners_of(to_, near);
    const double reach = bound() / 2;  // roundings of the cut are nothing to the rest
    const bool from_a = distance_to_triangle(a, triangle) <= reach,
               from_b = distance_to_triangle(b, triangle) <= reach;
    double at = 0.5;
    if (from_a != from_b) {
      const double share =
          from_a ? share_near(a, b, triangle, reach) : 1 - share_near(b, a, triangle, reach);
      if (share >= kLeast && share <= 1 - kLeast) at = share;
    }
    const Position cut = between(a, b, at);
    pieces.push_back({a, cut, c == b ? cut : c});  // a segment ends in a corner that it has twice
    pieces.push_back({cut, b, c});
  }

  // A piece near the plane of the triangle is cut along the line of a side that it crosses. So
  // where two surfaces are in one place, or nearly, there are few pieces, however small the
  // precision is.
  bool cut(const Corners& piece, Index near, std::vector<Corners>& pieces) const {
    constexpr double kNearPlane = 8;
    const Corners triangle = corners_of(to_, near);
    const Position normal = cross(minus(triangle[1], triangle[0]), minus(triangle[2], triangle[0]));
    const double reach = bound() / 2;
    const auto heights = [&](const Position& direction, const Position& from) {
      std::array<double, 3> height{};
      for (std::size_t i = 0; i < 3; ++i) {
        height[i] = dot(direction, minus(piece[i], from)) / length(direction);
      }
      return height;
    };
    for (const double height : heights(normal, triangle[0])) {
      if (!(std::fabs(height) <= kNearPlane * reach)) return false;
    }
    for (std::size_t side = 0; side < 3; ++side) {
      const Position& from = triangle[side];
      const std::array<double, 3> in =
          heights(cross(normal, minus(triangle[(side + 1) % 3], from)), from);
      if (!(std::ranges::min(in) < -reach && std::ranges::max(in) > reach)) continue;
      std::size_t lone = 0;  // the corner that is alone on its side of the line
      while ((in[lone] < 0) == (in[(lone + 1) % 3] < 0) ||
             (in[lone] < 0) == (in[(lone + 2) % 3] < 0)) {
        ++lone;
      }
      const std::size_t next = (lone + 1) % 3, last = (lone + 2) % 3;
      const Position p = between(piece[lone], piece[next], in[lone] / (in[lone] - in[next])),
                     q = between(piece[lone], piece[last], in[lone] / (in[lone] - in[last]));
      pieces.push_back({piece[lone], p, q});
      pieces.push_back({p, piece[next], piece[last]});
      if (piece[next] != piece[last]) pieces.push_back({p, piece[last], q});
      return true;
    }
    return false;
  }

  // A bound of the piece's distance from the surface, with the triangle nearest to its centre.
  // Raises the lower bound of all as well.
  std::pair<double, Index> upper_bound(const Corners& piece) {
    Position centre;
    for (std::size_t i = 0; i < 3; ++i) centre[i] = (piece[0][i] + piece[1][i] + piece[2][i]) / 3;
    const auto [at_centre, near_centre] = nearest(centre);
    double radius = 0;
    for (const Position& p : piece) radius = std::max(radius, quick_distance(p, centre));
    double bound = std::min(at_centre + radius, from_triangle(piece, near_centre));
    see(centre, at_centre);
    for (const Position& p : piece) {
      const auto [d, t] = nearest(p);
      see(p, d);
      if (t != near_centre) bound = std::min(bound, from_triangle(piece, t));
    }
    return {bound, near_centre};
  }

  void see(const Position& p, double distance) {
    if (distance <= lower_) return;
    lower_ = distance;
    place_ = p;
  }

  double from_triangle(const Corners& piece, Index t) const {
    const Corners c = corners_of(to_, t);
    double most = 0;
    for (const Position& p : piece) most = std::max(most, distance_to_triangle(p, c));
    return most;
  }

  // By boxes that grow until one holds something that is nearer than its sides.
  std::pair<double, Index> nearest(const Position& p) {
    for (double reach = std::max(std::max(lower_, least_), precision_);; reach *= 4) {
      found_.clear();
      tree_.query(box_around(p, reach), found_);
      std::pair<double, Index> best{HUGE_VAL, kNone};
      for (const Index t : found_) {
        best = std::min(best, {distance_to_triangle(p, corners_of(to_, t)), t});
      }
      if (best.first <= reach) return best;
    }
  }

  const Polyhedron& to_;
  const BoxTree tree_;
  double precision_, least_;
  double lower_ = 0;  // of the largest distance
  Position place_{};
  std::vector<Index> found_;
};

struct Extent {
  double volume = 0, area = 0;
};

Extent extent_of(const Polyhedron& surface) {
  Extent extent;
  const Position origin = surface.vertices.at(0);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const Corners c = corners_of(surface, t);
    const Position normal = cross(minus(c[1], c[0]), minus(c[2], c[0]));
    extent.area += std::sqrt(dot(normal, normal)) / 2;
    extent.volume += dot(normal, minus(c[0], origin)) / 6;
  }
  return extent;
}

OracleReport check_distances(const Polyhedron& input, const Polyhedron& own, double allowed,
                             int exponent, double& deviation) {
  OracleReport report("envelope", "triangles");
  report.checked = input.triangles.size() + own.triangles.size();
  Position worst_there, worst_back;
  const double there = farthest(own, input, allowed / 100, allowed, &worst_there);
  const double back = farthest(input, own, allowed / 100, allowed, &worst_back);
  deviation = std::max(there, back);
  report.figures.emplace_back("of the mesh from the input, at most", there);
  report.figures.emplace_back("of the input from the mesh, at most", back);
  // What the bounds are uncertain by is nobody's fault.
  const double most = allowed * 1.01;
  if (there > most) {
    const Position at = in_units(worst_there, exponent);
    report.fail_at(at, "the mesh's surface is as far from the input as " +
                           std::to_string(there / allowed) + " envelopes" + place_name(at));
  }
  if (back > most) {
    const Position at = in_units(worst_back, exponent);
    report.fail_at(at, "the input is as far from the mesh's surface as " +
                           std::to_string(back / allowed) + " envelopes" + place_name(at));
  }
  return report;
}

// Is a point inside, by the parity of a ray? Decided in doubles, where they certainly do.
class Parity {
 public:
  explicit Parity(const Polyhedron& surface) : surface_(surface), tree_(boxes_of(surface)) {
    for (const Position& p : surface.vertices) {
      for (const double x : p) largest_ = std::max(largest_, std::fabs(x));
    }
  }

  const Polyhedron& surface() const { return surface_; }

  // Is some triangle so near?
  bool is_near(const Position& p, double distance) {
    found_.clear();
    tree_.query(box_around(p, distance), found_);
    return std::ranges::any_of(found_, [&](Index t) {
      return distance_to_triangle(p, corners_of(surface_, t)) <= distance;
    });
  }

  // -1 where roundings decide.
  int of(const Position& p) {
    found_.clear();
    tree_.query({p, {HUGE_VAL, p[1], p[2]}}, found_);
    int crossings = 0;
    for (const Index t : found_) {
      const int crossed = crosses(p, corners_of(surface_, t));
      if (crossed < 0) return -1;
      crossings += crossed;
    }
    return crossings % 2;
  }

 private:
  // Does the ray along the first axis cross the triangle? -1: roundings decide.
  int crosses(const Position& p, const Corners& c) const {
    const double least = 64 * 0x1p-52 * largest_ * largest_;
    double area[3];
    for (std::size_t i = 0; i < 3; ++i) {
      const Position &a = c[i], &b = c[(i + 1) % 3];
      area[i] = (a[1] - p[1]) * (b[2] - p[2]) - (a[2] - p[2]) * (b[1] - p[1]);
    }
    const bool above = area[0] > least && area[1] > least && area[2] > least,
               below = area[0] < -least && area[1] < -least && area[2] < -least;
    const bool aside = std::ranges::any_of(area, [&](double x) { return x > least; }) &&
                       std::ranges::any_of(area, [&](double x) { return x < -least; });
    if (aside) return 0;
    if (!above && !below) return -1;
    const double all = area[0] + area[1] + area[2];
    const double x = (area[1] * c[0][0] + area[2] * c[1][0] + area[0] * c[2][0]) / all;
    return x > p[0] ? 1 : 0;  // p is far from the triangle
  }

  const Polyhedron& surface_;
  const BoxTree tree_;
  double largest_ = 0;
  std::vector<Index> found_;
};

// What is farther than the envelope from both surfaces is on the same side of both, part by part:
// asked in cells of space, of which those near a surface are divided.
class Sides {
 public:
  Sides(const Polyhedron& input, const Polyhedron& own, double allowed)
      : input_(input), own_(own), allowed_(allowed) {
    Box box = box_of(input.vertices);
    for (const Position& p : own.vertices) box.add(p);
    half_ = box.diagonal() / 2;
    for (std::size_t i = 0; i < 3; ++i) centre_[i] = box.low[i] / 2 + box.high[i] / 2;
  }

  OracleReport run(int exponent, std::vector<std::string>& unproven) {
    for (const Polyhedron* surface : {&input_.surface(), &own_.surface()}) {
      look_beside(*surface, exponent);
    }
    std::vector<Position> cells = {centre_}, near;
    for (;;) {
      near.clear();
      for (const Position& cell : cells) {
        const double reach = allowed_ * 1.01 + std::sqrt(3.0) * half_;
        if (input_.is_near(cell, reach) || own_.is_near(cell, reach)) {
          near.push_back(cell);
        } else {
          compare(cell, half_, exponent);
        }
      }
      if (near.empty() || 8 * near.size() > kMostCells || half_ < allowed_ / 8) break;
      half_ /= 2;
      cells.clear();
      for (const Position& cell : near) {
        for (unsigned corner = 0; corner < 8; ++corner) {
          Position part = cell;
          for (std::size_t i = 0; i < 3; ++i) part[i] += (corner >> i & 1U) != 0 ? half_ : -half_;
          cells.push_back(part);
        }
      }
    }
    if (report_.checked == 0) {
      report_.checked = 1;
      report_.notes.emplace_back(
          "no part of space is farther than the envelope from both surfaces");
    }
    const double thinner = 2 * (allowed_ + 2 * std::sqrt(3.0) * half_);
    report_.figures.emplace_back("thinner parts are not told apart", thinner);
    if (half_ >= allowed_ / 8) {
      char text[100];
      std::snprintf(text, sizeof text, "parts thinner than %.3g", std::ldexp(thinner, exponent));
      unproven.emplace_back(text);
    }
    return std::move(report_);
  }

 private:
  // Parts that are thinner than cells are looked at from their sides: a little farther from the
  // middle of a triangle than the envelope reaches, and twice as far.
  void look_beside(const Polyhedron& surface, int exponent) {
    const std::size_t step = 1 + surface.triangles.size() / kMostCells;
    for (std::size_t t = 0; t < surface.triangles.size(); t += step) {
      const auto [a, b, c] = corners_of(surface, t);
      const Position normal = cross(minus(b, a), minus(c, a));
      if (!(length(normal) > 0)) continue;
      for (const double times : {-2.1, -1.05, 1.05, 2.1}) {
        Position p;
        for (std::size_t i = 0; i < 3; ++i) {
          p[i] = (a[i] + b[i] + c[i]) / 3 + times * allowed_ * (normal[i] / length(normal));
        }
        const double reach = 1.01 * allowed_;
        if (!input_.is_near(p, reach) && !own_.is_near(p, reach)) {
          compare(p, 0.01 * allowed_, exponent);
        }
      }
    }
  }

  // Any point of a cell, half as large as said, will do: the surfaces are far.
  void compare(const Position& cell, double half, int exponent) {
    for (int attempt = 0; attempt < 8; ++attempt) {
      Position p = cell;
      for (std::size_t i = 0; i < 3; ++i) {
        p[i] += half * (0.37 * attempt / 8 - 0.11 * static_cast<double>(i) * attempt / 8);
      }
      const int given = input_.of(p), made = own_.of(p);
      if (given < 0 || made < 0) continue;
      ++report_.checked;
      if (given == made) return;
      const Position at = in_units(p, exponent);
      report_.fail_at(at, (given == 1 ? "the input has volume that the mesh has not"
                                      : "the mesh has volume that the input has not") +
                              place_name(at));
      return;
    }
  }

  static constexpr std::size_t kMostCells = 200'000;
  Parity input_, own_;
  double allowed_, half_ = 0;
  Position centre_{};
  OracleReport report_{"envelope-sides", "cells of space"};
};

// Of surfaces that are oriented outwards.
OracleReport check_volumes(const Polyhedron& input, const Polyhedron& own, double allowed) {
  OracleReport report("envelope-volume", "volumes");
  report.checked = 2;
  const Extent given = extent_of(input), made = extent_of(own);
  report.figures.emplace_back("of the mesh", made.volume);
  report.figures.emplace_back("of the input", given.volume);
  if (std::fabs(made.volume - given.volume) > 2 * allowed * std::max(given.area, made.area)) {
    report.fail("the mesh has the volume " + std::to_string(made.volume) + " and the input " +
                std::to_string(given.volume));
  }
  return report;
}

bool names_places(const MeshFile& mesh) {
  const bool finite =
      std::all_of(mesh.vertices.begin(), mesh.vertices.end(), [](const Position& p) {
        return std::all_of(p.begin(), p.end(), [](double x) { return std::isfinite(x); });
      });
  return finite && std::all_of(mesh.tetrahedra.begin(), mesh.tetrahedra.end(), [&](const Tet& tet) {
           return std::all_of(tet.begin(), tet.end(),
                              [&](Index v) { return v < mesh.vertices.size(); });
         });
}

// Puts extreme models into units of about their size, 2^exponent: squares and volumes of lengths
// fit into doubles then. Otherwise they would all be 0 or infinite, so that nothing would differ.
// What is lost of the digits is nothing to any envelope.
int ordinary_exponent(Polyhedron& input, Polyhedron& own) {
  double largest = 0;
  for (const Polyhedron* surface : {&input, &own}) {
    for (const Position& p : surface->vertices) {
      for (const double x : p) largest = std::max(largest, std::fabs(x));
    }
  }
  if (!(largest > 0) || (largest > 0x1p-200 && largest < 0x1p200)) return 0;
  const int exponent = std::ilogb(largest);
  for (Polyhedron* surface : {&input, &own}) {
    for (Position& p : surface->vertices) {
      for (double& x : p) x = std::ldexp(x, -exponent);
    }
  }
  return exponent;
}

// Without the tetrahedra that the file calls outside, whose regions are not 1.
MeshFile solid_of(MeshFile mesh) {
  std::size_t kept = 0;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const bool inside = mesh.regions.size() != mesh.tetrahedra.size() || mesh.regions[t] == 1;
    if (inside) mesh.tetrahedra[kept++] = mesh.tetrahedra[t];
  }
  mesh.tetrahedra.resize(kept);
  return mesh;
}

void broken(VerifyReport& report, const std::string& oracle, const std::string& finding) {
  OracleReport said(oracle);
  said.checked = 1;
  said.fail(finding);
  report.oracles.push_back(std::move(said));
  report.verdict = Verdict::broken;
}

}  // namespace

Position in_units(const Position& p, int exponent) {
  return {std::ldexp(p[0], exponent), std::ldexp(p[1], exponent), std::ldexp(p[2], exponent)};
}

std::string place_name(const Position& given) {
  std::ostringstream text;
  text << std::setprecision(12) << " at (" << given[0] << ", " << given[1] << ", " << given[2]
       << ")";
  return text.str();
}

std::string turn_outwards(Polyhedron& surface) {
  ExactPoints points;
  InputSurface turned;
  std::string why = points.assign(surface.vertices);
  if (why.empty()) why = turned.assign(surface, points);
  if (why.empty()) surface.triangles = turned.triangles();
  return why;
}

double farthest(const Polyhedron& from, const Polyhedron& to, double precision, double enough,
                Position* place) {
  Farthest search(to, precision, enough);
  for (std::size_t t = 0; t < from.triangles.size(); ++t) search.look_at(corners_of(from, t));
  if (place != nullptr) *place = search.place();
  return search.bound();
}

bool only_surface_differs(const VerifyReport& report) {
  if (report.verdict != Verdict::broken) return false;
  bool elsewhere = false;
  for (const OracleReport& oracle : report.oracles) {
    if (oracle.passed()) continue;
    const bool of_surface = oracle.name == "conformity" || oracle.name == "volume";
    if (!of_surface && oracle.name != "boundary-list" && oracle.name != "hull") return false;
    elsewhere = elsewhere || of_surface;
  }
  return elsewhere;
}

std::optional<NearSurface> nearness(const Polyhedron& input, const MeshFile& mesh) {
  const Polyhedron own = boundary_of(mesh);
  if (own.triangles.empty()) return std::nullopt;
  // Where two surfaces are in one place, the time grows as the precision does.
  const double diagonal = box_of(input.vertices).diagonal(), precision = 1e-3 * diagonal;
  NearSurface near;
  near.farthest = std::max(farthest(input, own, precision, 0), farthest(own, input, precision, 0));
  // What the envelope's own bounds add is less than a tenth.
  std::snprintf(near.envelope, sizeof near.envelope, "%.0e",
                1.6 * std::max(near.farthest / diagonal, kLeastEnvelope));
  return std::strtod(near.envelope, nullptr) > 1 ? std::nullopt : std::optional(near);
}

Polyhedron boundary_of(const MeshFile& mesh) {
  std::map<std::array<Index, 3>, std::pair<int, std::array<Index, 3>>> faces;
  // Faces of a positive tetrahedron, seen from outside.
  static constexpr std::size_t kFaces[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  for (const Tet& tet : mesh.tetrahedra) {
    for (const auto& [i, j, k] : kFaces) {
      const std::array<Index, 3> face = {tet[i], tet[j], tet[k]};
      std::array<Index, 3> key = face;
      std::sort(key.begin(), key.end());
      const auto at = faces.try_emplace(key, 0, face).first;
      ++at->second.first;
    }
  }
  std::map<Face, std::int32_t> listed;
  if (mesh.labels.size() == mesh.boundary.size()) {
    for (std::size_t i = 0; i < mesh.boundary.size(); ++i) {
      Face key = mesh.boundary[i];
      sort_face(key);
      listed.emplace(key, mesh.labels[i]);
    }
  }
  Polyhedron surface;
  std::map<Index, Index> number;
  for (const auto& [key, seen] : faces) {
    if (seen.first != 1) continue;
    if (const auto at = listed.find(key); at != listed.end()) surface.labels.push_back(at->second);
    std::array<Index, 3> triangle;
    for (std::size_t c = 0; c < 3; ++c) {
      const Index v = seen.second[c];
      const auto [at, fresh] = number.try_emplace(v, static_cast<Index>(surface.vertices.size()));
      if (fresh) surface.vertices.push_back(mesh.vertices[v]);
      triangle[c] = at->second;
    }
    surface.triangles.push_back(triangle);
  }
  if (surface.labels.size() != surface.triangles.size()) surface.labels.clear();
  return surface;
}

std::string verify_envelope(const Polyhedron& input, const MeshFile& mesh, double share,
                            const VerifyOptions& options, VerifyReport& report) {
  report = {};
  if (input.triangles.empty()) return "the surface has no triangles";
  if (!names_places(mesh)) {
    broken(report, "complex", "a tetrahedron names no vertex, or a vertex no place");
    return {};
  }
  const double tolerance = options.promised.tolerance;
  if (tolerance != 0 && !(share >= kLeastEnvelope)) {
    broken(report, "promise", "a tolerance is at least 1e-7 of the diagonal");
    return {};
  }
  MeshFile bare;
  bare.vertices = mesh.vertices;
  bare.tetrahedra = mesh.tetrahedra;
  bare.lists_boundary = false;
  bare.either_orientation = mesh.either_orientation;
  if (tolerance != 0) {
    bare.edge_nodes = mesh.edge_nodes;
    bare.has_second_order = mesh.has_second_order;
  }
  const bool hull = tolerance != 0 && options.promised.region == delmesher::Region::hull;
  if (hull) {
    bare.regions = mesh.regions;
    bare.inside = mesh.inside;
    bare.names_sides = mesh.names_sides;
  }
  Polyhedron own = boundary_of(hull ? solid_of(mesh) : mesh);
  const std::vector<std::int32_t> labels = std::exchange(own.labels, {});
  if (own.triangles.empty()) {
    broken(report, "own-surface", "the tetrahedra have no boundary");
    return {};
  }
  if (tolerance != 0) {
    for (const Index v : loose_points(input)) own.vertices.push_back(input.vertices[v]);
  }
  VerifyOptions as_given = options;
  Promise& promise = as_given.promised;
  std::vector<std::string> unproven;
  const bool differ =
      std::ranges::adjacent_find(input.labels, std::ranges::not_equal_to()) != input.labels.end();
  if (promise.keep) unproven.emplace_back("--surface keep");
  if (promise.keep) promise.task = Task::mesh;
  const bool labels_compared = tolerance != 0 && mesh.lists_boundary && !mesh.labels.empty();
  if ((promise.label_by_angle > 0 || differ) && !labels_compared) unproven.emplace_back("labels");
  promise.keep = false;
  promise.tolerance = 0;
  promise.label_by_angle = promise.planar = 0;
  as_given.declared_deviation = 0;
  if (const std::string why = verify(own, bare, nullptr, as_given, report); !why.empty()) {
    broken(report, "own-surface", "the boundary of the tetrahedra bounds no solid: " + why);
    return {};
  }
  // Numbers of its own surface are not those of the input.
  for (OracleReport& oracle : report.oracles) oracle.forget_sites(Site::Kind::input_vertex);
  Polyhedron given = input;
  const int exponent = ordinary_exponent(given, own);
  if (std::string why = turn_outwards(given); !why.empty()) return why;
  if (mesh.either_orientation && extent_of(own).volume < 0) {
    for (Face& triangle : own.triangles) std::swap(triangle[1], triangle[2]);
  }
  const double diagonal = diagonal_of(given), allowed = share * diagonal;
  std::vector<OracleReport> oracles = {
      check_distances(given, own, allowed, exponent, report.deviation),
      check_volumes(given, own, allowed), Sides(given, own, allowed).run(exponent, unproven)};
  if (tolerance != 0) {
    // What is of no size as written bends by chance.
    const double slab = options.promised.planar == 0 ? 0
                        : mesh.planar_within > 0     ? mesh.planar_within
                                                     : Promise::kAutomatic;
    own.labels = labels;
    std::ranges::move(check_tolerance({given, own, allowed, options.promised.feature,
                                       slab * diagonal, exponent, labels_compared}),
                      std::back_inserter(oracles));
  }
  for (OracleReport& oracle : oracles) {
    if (exponent != 0) {
      oracle.notes.push_back("lengths are in units of 2^" + std::to_string(exponent));
    }
    report.oracles.push_back(std::move(oracle));
  }
  report.deviation_share = report.deviation / diagonal;
  report.deviation = std::ldexp(report.deviation, exponent);
  report.verdict = report.any_failed()    ? Verdict::broken
                   : !report.all_passed() ? Verdict::undecided
                                          : Verdict::deviating;
  std::ranges::move(unproven, std::back_inserter(report.unproven));
  return {};
}

}  // namespace tetproof::oracles
