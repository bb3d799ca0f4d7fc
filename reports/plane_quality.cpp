#include "reports/plane_quality.h"

#include <gmpxx.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

namespace tetproof {
namespace {

using Point = std::array<double, 2>;

int exact_sign(const Point& a, const Point& b, const Point& c) {
  const auto difference = [](double x, double y) -> mpq_class {
    return mpq_class(x) - mpq_class(y);
  };
  return sgn(difference(b[0], a[0]) * difference(c[1], a[1]) -
             difference(b[1], a[1]) * difference(c[0], a[0]));
}

class Measuring {
 public:
  explicit Measuring(const oracles::PlaneFile& mesh) : mesh_(mesh) {}

  PlaneQuality run() {
    quality_.min_angle = 180;
    quality_.shortest_edge = std::numeric_limits<double>::infinity();
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      if (mesh_.inside.empty() || mesh_.inside[t] != 0) add(mesh_.triangles[t]);
    }
    if (quality_.triangles == 0) return {};
    quality_.vertices = used_.size();
    quality_.mean_min_angle /= static_cast<double>(quality_.triangles);
    quality_.mean_max_angle /= static_cast<double>(quality_.triangles);
    for (const auto& [edge, count] : edges_) quality_.crowded_edges += count > 2 ? 1 : 0;
    return quality_;
  }

 private:
  void add(const std::array<std::uint32_t, 3>& t) {
    ++quality_.triangles;
    if (*std::ranges::max_element(t) >= mesh_.vertices.size()) {
      throw std::runtime_error("a triangle refers to no vertex");
    }
    double least = 180, most = 0, twice = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t v = t[i], next = t[(i + 1) % 3];
      used_.insert(v);
      ++edges_[std::minmax(v, next)];
      const Point &o = mesh_.vertices[v], &a = mesh_.vertices[next],
                  &b = mesh_.vertices[t[(i + 2) % 3]];
      const double ux = a[0] - o[0], uy = a[1] - o[1], vx = b[0] - o[0], vy = b[1] - o[1];
      twice = ux * vy - uy * vx;
      const double angle = std::atan2(std::fabs(twice), ux * vx + uy * vy) * 57.29577951308232;
      least = std::min(least, angle);
      most = std::max(most, angle);
      quality_.shortest_edge = std::min(quality_.shortest_edge, std::hypot(ux, uy));
    }
    const int sign = exact_sign(mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]]);
    quality_.inverted += sign < 0 ? 1 : 0;
    quality_.flat += sign == 0 ? 1 : 0;
    quality_.area += std::fabs(twice) / 2;
    quality_.min_angle = std::min(quality_.min_angle, least);
    quality_.max_angle = std::max(quality_.max_angle, most);
    quality_.mean_min_angle += least;
    quality_.mean_max_angle += most;
  }

  const oracles::PlaneFile& mesh_;
  PlaneQuality quality_;
  std::set<std::uint32_t> used_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, unsigned> edges_;
};

}  // namespace

PlaneQuality measure_plane(const oracles::PlaneFile& mesh) {
  return Measuring(mesh).run();
}

std::string to_json(const PlaneQuality& q) {
  const nlohmann::ordered_json json = {{"vertices", q.vertices},
                                       {"triangles", q.triangles},
                                       {"min_angle", q.min_angle},
                                       {"max_angle", q.max_angle},
                                       {"mean_min_angle", q.mean_min_angle},
                                       {"mean_max_angle", q.mean_max_angle},
                                       {"shortest_edge", q.shortest_edge},
                                       {"area", q.area},
                                       {"inverted", q.inverted},
                                       {"flat", q.flat},
                                       {"crowded_faces", q.crowded_edges}};
  return json.dump();
}

}  // namespace tetproof
