#include "corpus/generators/twins.h"

#include <utility>

#include "corpus/generators/approach.h"
#include "corpus/generators/certify.h"
#include "corpus/generators/shapes.h"

namespace tetproof {
namespace {

using delmesher::Surface;
using Kind = delmesher::Defect::Kind;
using Maker = std::optional<Surface> (*)(const Surface&, Random&);

std::optional<Surface> intersecting(const Surface& surface, Random& random) {
  for (int attempt = 0; attempt < 8; ++attempt) {
    const auto way = approach(surface, random);
    if (!way || way->defect != Kind::self_intersection) continue;
    Surface twin = surface;
    twin.vertices[way->vertex] = way->invalid;
    return twin;
  }
  // No vertex meets anything, so a part is added that touches a vertex.
  Surface twin = surface;
  const auto tip = surface.vertices[0];
  double size = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (const auto& p : surface.vertices) size = std::max(size, std::abs(p[i] - tip[i]));
  }
  const auto at = [&](double x, double y, double z) {
    return shapes::Point{tip[0] + size * x, tip[1] + size * y, tip[2] + size * z};
  };
  shapes::append(twin, shapes::tetrahedron(tip, at(2, 0.5, 0), at(2, -0.5, 0.5), at(2, 0, -0.5)));
  return twin;
}

std::optional<Surface> open(const Surface& surface, Random& random) {
  Surface twin = surface;
  auto& triangle = twin.triangles[random.below(twin.triangles.size())];
  auto& corner = triangle[random.below(3)];
  auto beside = twin.vertices[corner];
  double& x = beside[random.below(3)];
  x = shapes::ulps_away(x, random.chance(0.5) ? 1 : -1);
  corner = static_cast<std::uint32_t>(twin.vertices.size());
  twin.vertices.push_back(beside);
  return twin;
}

// A triangle of no area between the two sides of an edge. Its third corner is the middle of the
// edge, or an end if the middle is not a double.
std::optional<Surface> degenerate(const Surface& surface, Random& random) {
  Surface twin = surface;
  const auto t = random.below(twin.triangles.size());
  const auto [a, b, c] = twin.triangles[t];
  const auto &p = twin.vertices[a], &q = twin.vertices[b];
  auto middle = shapes::mix(p, q, 0.5);
  for (std::size_t i = 0; i < 3; ++i) {
    const double sum = p[i] + q[i];
    // The middle is exact if no step was rounded.
    if (middle[i] * 2 != sum || sum - p[i] != q[i] || sum - q[i] != p[i]) {
      middle = p;
      break;
    }
  }
  const auto m = static_cast<std::uint32_t>(twin.vertices.size());
  twin.vertices.push_back(middle);
  twin.triangles[t] = {a, m, c};
  twin.triangles.push_back({m, b, c});
  twin.triangles.push_back({a, b, m});
  return twin;
}

std::optional<Surface> turned(const Surface& surface, Random& random) {
  Surface twin = surface;
  auto& triangle = twin.triangles[random.below(twin.triangles.size())];
  std::swap(triangle[1], triangle[2]);
  return twin;
}

}  // namespace

std::vector<Twin> make_twins(const Surface& surface, Random& random) {
  constexpr struct {
    const char* name;
    Maker make;
    Kind reason;
  } kTwins[] = {{"intersecting", intersecting, Kind::self_intersection},
                {"open", open, Kind::open_edge},
                {"degenerate", degenerate, Kind::degenerate_triangle},
                {"turned", turned, Kind::inconsistent_orientation}};
  std::vector<Twin> twins;
  for (const auto& kind : kTwins) {
    for (int attempt = 0; attempt < 5; ++attempt) {
      auto twin = kind.make(surface, random);
      if (!twin || first_defect(*twin) != kind.reason) continue;
      twins.push_back({kind.name, std::move(*twin), kind.reason});
      break;
    }
  }
  return twins;
}

const char* reason_text(Kind reason) {
  switch (reason) {
    case Kind::self_intersection:
      return "self-intersection";
    case Kind::open_edge:
      return "open edge";
    case Kind::degenerate_triangle:
      return "degenerate triangle";
    case Kind::inconsistent_orientation:
      return "inconsistent orientation";
    default:
      return "other";
  }
}

}  // namespace tetproof
