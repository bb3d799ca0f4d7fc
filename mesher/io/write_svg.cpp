// A picture of a mesh in the plane.
#include <algorithm>
#include <cmath>
#include <vector>

#include "mesher/io/write_plane_formats.h"

namespace delmesher::io {
namespace {

double smallest_angle(const PlaneMesh& mesh, std::size_t t) {
  double least = 180;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& v = mesh.triangles[t];
    const Point2 &o = mesh.vertices[v[i]], &a = mesh.vertices[v[(i + 1) % 3]],
                 &b = mesh.vertices[v[(i + 2) % 3]];
    const double ux = a[0] - o[0], uy = a[1] - o[1], vx = b[0] - o[0], vy = b[1] - o[1];
    least = std::min(least, std::atan2(std::fabs(ux * vy - uy * vx), ux * vx + uy * vy) * 57.29578);
  }
  return least;
}

}  // namespace

// From red (0 degrees) over yellow to green (60): one path per colour.
void write_svg(TextSink& out, const PlaneMesh& mesh) {
  constexpr int kColours = 12;
  constexpr double kWidth = 1000;
  Point2 low = {0, 0}, high = {1, 1};
  if (!mesh.vertices.empty()) low = high = mesh.vertices[0];
  for (const Point2& p : mesh.vertices) {
    for (std::size_t k = 0; k < 2; ++k) {
      low[k] = std::min(low[k], p[k]);
      high[k] = std::max(high[k], p[k]);
    }
  }
  const double extent = std::max(high[0] / 2 - low[0] / 2, high[1] / 2 - low[1] / 2);
  const auto fraction = [&](double x, double from) {
    return extent > 0 ? (x / 2 - from / 2) / extent * kWidth : 0;
  };
  const auto decimal = [&](double x) {  // to a thousandth
    out.number(std::round(x * 1000) / 1000);
  };
  const auto place = [&](const Point2& p) {
    decimal(fraction(p[0], low[0]));
    out.text(" ");
    decimal(fraction(high[1], low[1]) - fraction(p[1], low[1]));  // y grows downwards
  };
  out.text("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"-5 -5 ");
  decimal(fraction(high[0], low[0]) + 10);
  out.text(" ");
  decimal(fraction(high[1], low[1]) + 10);
  out.text(
      "\">\n<style>path{stroke:#333;stroke-width:.3;stroke-linejoin:round;stroke-linecap:round}"
      "</style>\n");
  std::vector<std::vector<std::size_t>> of_colour(kColours + 1);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto k =
        std::min(kColours - 1, static_cast<int>(smallest_angle(mesh, t) / 60 * kColours));
    of_colour[static_cast<std::size_t>(mesh.inside[t] != 0 ? k : kColours)].push_back(t);
  }
  for (std::size_t k = 0; k <= kColours; ++k) {
    if (of_colour[k].empty()) continue;
    out.text("<path fill=\"");
    if (k == kColours) {
      out.text("#eee");
    } else {
      out.text("hsl(");
      out.integer(120 * k / (kColours - 1));
      out.text(",75%,65%)");
    }
    out.text("\" d=\"");
    for (const std::size_t t : of_colour[k]) {
      const auto& [a, b, c] = mesh.triangles[t];
      out.text("M");
      place(mesh.vertices[a]);
      out.text("L");
      place(mesh.vertices[b]);
      out.text("L");
      place(mesh.vertices[c]);
      out.text("Z");
    }
    out.text("\"/>\n");
  }
  out.text("<path style=\"stroke:#000;stroke-width:1.5\" fill=\"none\" d=\"");
  for (const auto& [a, b] : mesh.edges) {
    out.text("M");
    place(mesh.vertices[a]);
    out.text("L");
    place(mesh.vertices[b]);
  }
  out.text("\"/>\n</svg>\n");
}

}  // namespace delmesher::io
