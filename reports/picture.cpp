#include "reports/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <utility>

#include "oracles/base/vectors.h"

namespace tetproof {
namespace {

using oracles::distance;
using oracles::dot;
using oracles::Index;
using oracles::is_finite;
using oracles::MeshFile;
using oracles::minus;
using oracles::Polyhedron;
using oracles::Position;

constexpr double kSize = 360;            // of the picture, in pixels
constexpr std::size_t kMostEdges = 150;  // of each kind, the nearest ones

std::vector<Index> numbers_in(const std::string& text) {
  static const std::regex number("[0-9]+");
  std::vector<Index> found;
  for (std::sregex_iterator at(text.begin(), text.end(), number), end; at != end; ++at) {
    const auto value = std::strtoull(at->str().c_str(), nullptr, 10);
    if (value <= std::numeric_limits<Index>::max()) found.push_back(static_cast<Index>(value));
  }
  return found;
}

// Calls `visit` with what stands in the parentheses of each match.
template <typename Visit>
void for_each_match(const std::string& text, const char* pattern, const Visit& visit) {
  const std::regex regex(pattern);
  for (std::sregex_iterator at(text.begin(), text.end(), regex), end; at != end; ++at) {
    visit(*at);
  }
}

void append(std::vector<Index>& to, const std::vector<Index>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

// The part of space that is shown, and from where.
struct View {
  Position center{};
  double radius = 0;
  Position right{}, up{};

  std::pair<double, double> at(const Position& p) const {
    const Position d = minus(p, center);
    const double scale = kSize / 2 / radius;
    return {kSize / 2 + scale * dot(d, right), kSize / 2 - scale * dot(d, up)};
  }
};

Position scaled(const Position& p, double by) {
  return {by * p[0], by * p[1], by * p[2]};
}

void look_along(Position direction, View& view) {
  direction = scaled(direction, 1 / std::sqrt(dot(direction, direction)));
  const Position upright = std::fabs(direction[2]) < 0.9 ? Position{0, 0, 1} : Position{0, 1, 0};
  view.right = oracles::cross(direction, upright);
  view.right = scaled(view.right, 1 / std::sqrt(dot(view.right, view.right)));
  view.up = oracles::cross(view.right, direction);
}

// Chooses, among some directions, the one that shows the points widest.
void choose_direction(const std::vector<Position>& points, View& view) {
  double widest = -1;
  View best = view;
  for (const Position& direction : std::vector<Position>{{1, 2, -1.5},
                                                         {1, -2, -1.5},
                                                         {2, 1, -1},
                                                         {-2, 1, -1},
                                                         {1, 0.2, -0.1},
                                                         {0.1, 1, -0.2},
                                                         {0.2, 0.1, -1}}) {
    look_along(direction, view);
    double low[2] = {1e300, 1e300}, high[2] = {-1e300, -1e300};
    for (const Position& p : points) {
      const auto [x, y] = view.at(p);
      low[0] = std::min(low[0], x);
      high[0] = std::max(high[0], x);
      low[1] = std::min(low[1], y);
      high[1] = std::max(high[1], y);
    }
    const double area = (high[0] - low[0] + 1) * (high[1] - low[1] + 1);
    if (area <= widest) continue;
    widest = area;
    best = view;
  }
  view = best;
}

class Picture {
 public:
  Picture(const Polyhedron& input, const MeshFile& mesh, Place place)
      : input_(input), mesh_(mesh), place_(std::move(place)) {}

  std::string draw(const std::string& sentence) {
    keep_what_exists();
    if (!choose_view()) return {};
    std::string svg = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" "
        "height=\"{1}\" font-family=\"sans-serif\" font-size=\"11\">\n<title>{2}</title>\n"
        "<clipPath id=\"c\"><rect width=\"{0}\" height=\"{0}\"/></clipPath>\n"
        "<rect width=\"{0}\" height=\"{1}\" fill=\"#fff\"/>\n<g clip-path=\"url(#c)\" "
        "stroke-linejoin=\"round\">\n",
        kSize, kSize + 20, escaped(sentence));
    for (const Index t : place_.input_triangles) {
      const auto& [a, b, c] = input_.triangles[t];
      svg += polygon({input_.vertices[a], input_.vertices[b], input_.vertices[c]}, "#9cf", "#06c");
    }
    svg += edges(mesh_edges(), mesh_.vertices, "#999", 0.7);
    svg += edges(input_edges(), input_.vertices, "#06c", 1.3);
    for (const auto& cell : place_.cells) svg += cell_of(cell);
    for (const Index v : place_.vertices) {
      svg += mark(mesh_.vertices[v], "#d00", std::to_string(v));
    }
    for (const Index v : place_.input_vertices) {
      svg += mark(input_.vertices[v], "#06c", std::to_string(v));
    }
    for (const Position& p : place_.points) svg += mark(p, "#d00", "");
    return svg + fmt::format(
                     "</g>\n<text x=\"4\" y=\"{}\">around ({:.6g}, {:.6g}, {:.6g}), {:.3g} "
                     "wide</text>\n</svg>\n",
                     kSize + 14, view_.center[0], view_.center[1], view_.center[2],
                     2 * view_.radius);
  }

 private:
  static std::string escaped(const std::string& text) {
    std::string safe;
    for (const char c : text) {
      safe += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
    }
    return safe;
  }

  void keep_what_exists() {
    const auto in_mesh = [&](Index v) {
      return v < mesh_.vertices.size() && is_finite(mesh_.vertices[v]);
    };
    std::erase_if(place_.vertices, [&](Index v) { return !in_mesh(v); });
    std::erase_if(place_.cells, [&](const auto& cell) {
      return !std::all_of(cell.begin(), cell.end(), in_mesh);
    });
    std::erase_if(place_.input_vertices, [&](Index v) { return v >= input_.vertices.size(); });
    std::erase_if(place_.input_triangles, [&](Index t) { return t >= input_.triangles.size(); });
    for (auto* named : {&place_.vertices, &place_.input_vertices, &place_.input_triangles}) {
      std::sort(named->begin(), named->end());
      named->erase(std::unique(named->begin(), named->end()), named->end());
    }
  }

  // Named points; the view is twice as large, or three times the shortest edge at a single one.
  bool choose_view() {
    std::vector<Position> points = place_.points;
    for (const Index v : place_.vertices) points.push_back(mesh_.vertices[v]);
    for (const Index v : place_.input_vertices) points.push_back(input_.vertices[v]);
    // A facet may be large: it gives the place only if nothing else does.
    const bool only_facets = points.empty();
    for (const Index t : place_.input_triangles) {
      if (!only_facets) break;
      for (const Index v : input_.triangles[t]) points.push_back(input_.vertices[v]);
    }
    if (points.empty()) return false;
    Position low = points[0], high = points[0];
    for (const Position& p : points) {
      for (int i = 0; i < 3; ++i) {
        low[i] = std::min(low[i], p[i]);
        high[i] = std::max(high[i], p[i]);
      }
    }
    for (int i = 0; i < 3; ++i) view_.center[i] = low[i] / 2 + high[i] / 2;
    for (const Position& p : points) {
      view_.radius = std::max(view_.radius, 1.7 * distance(p, view_.center));
    }
    if (!(view_.radius > 0)) view_.radius = 3 * shortest_edge_near(points[0]);
    if (!(view_.radius > 0)) view_.radius = 1;
    choose_direction(points, view_);
    return std::isfinite(view_.radius);
  }

  // The shortest edge at the vertex nearest to a point, of the mesh or else of the input.
  double shortest_edge_near(const Position& point) const {
    double nearest = std::numeric_limits<double>::infinity(), length = 0;
    const auto visit = [&](const Position& a, const Position& b) {
      const double away = std::min(distance(a, point), distance(b, point)), edge = distance(a, b);
      if (!(edge > 0) || away > nearest) return;
      length = away < nearest ? edge : std::min(length, edge);
      nearest = away;
    };
    for (const auto& [a, b] : all_mesh_edges()) visit(mesh_.vertices[a], mesh_.vertices[b]);
    for (const auto& t : input_.triangles) {
      for (int i = 0; i < 3; ++i) visit(input_.vertices[t[i]], input_.vertices[t[(i + 1) % 3]]);
    }
    return length;
  }

  using Edges = std::set<std::pair<Index, Index>>;

  Edges all_mesh_edges() const {
    Edges found;
    for (const auto& tet : mesh_.tetrahedra) {
      for (int i = 0; i < 4; ++i) {
        for (int j = i + 1; j < 4; ++j) {
          const auto [low, high] = std::minmax(tet[i], tet[j]);
          if (high >= mesh_.vertices.size() || low == high) continue;
          if (is_finite(mesh_.vertices[low]) && is_finite(mesh_.vertices[high])) {
            found.emplace(low, high);
          }
        }
      }
    }
    return found;
  }

  // The nearest edges whose middle or an end is shown.
  Edges nearest(const Edges& all, const std::vector<Position>& points) const {
    std::vector<std::pair<double, std::pair<Index, Index>>> shown;
    for (const auto& edge : all) {
      const double away = std::min(distance(points[edge.first], view_.center),
                                   distance(points[edge.second], view_.center));
      if (away <= 1.5 * view_.radius) shown.emplace_back(away, edge);
    }
    std::sort(shown.begin(), shown.end());
    if (shown.size() > kMostEdges) shown.resize(kMostEdges);
    Edges found;
    for (const auto& [away, edge] : shown) found.insert(edge);
    return found;
  }

  Edges mesh_edges() const { return nearest(all_mesh_edges(), mesh_.vertices); }

  Edges input_edges() const {
    Edges all;
    for (const auto& t : input_.triangles) {
      for (int i = 0; i < 3; ++i) all.insert(std::minmax(t[i], t[(i + 1) % 3]));
    }
    return nearest(all, input_.vertices);
  }

  std::string edges(const Edges& found, const std::vector<Position>& points, const char* colour,
                    double width) const {
    if (found.empty()) return {};
    std::string path = "<path d=\"";
    for (const auto& [a, b] : found) {
      const auto [x, y] = view_.at(points[a]);
      const auto [u, v] = view_.at(points[b]);
      path += fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}", x, y, u, v);
    }
    return path +
           fmt::format("\" stroke=\"{}\" stroke-width=\"{}\" fill=\"none\"/>\n", colour, width);
  }

  std::string polygon(const std::vector<Position>& corners, const char* fill,
                      const char* stroke) const {
    std::string points;
    for (const Position& p : corners) {
      const auto [x, y] = view_.at(p);
      points += fmt::format("{:.1f},{:.1f} ", x, y);
    }
    return fmt::format(
        "<polygon points=\"{}\" fill=\"{}\" fill-opacity=\"0.35\" stroke=\"{}\" "
        "stroke-width=\"1.6\"/>\n",
        points, fill, stroke);
  }

  // A face, or the faces of a tetrahedron.
  std::string cell_of(const std::vector<Index>& cell) const {
    std::string faces;
    for (std::size_t but = 0; but < (cell.size() == 4 ? 4U : 1U); ++but) {
      std::vector<Position> corners;
      for (std::size_t i = 0; i < cell.size(); ++i) {
        if (cell.size() != 4 || i != but) corners.push_back(mesh_.vertices[cell[i]]);
      }
      faces += polygon(corners, "#f66", "#d00");
    }
    return faces;
  }

  std::string mark(const Position& p, const char* colour, const std::string& label) const {
    const auto [x, y] = view_.at(p);
    return fmt::format(
        "<circle cx=\"{0:.1f}\" cy=\"{1:.1f}\" r=\"3\" fill=\"{2}\"/><text x=\"{3:.1f}\" "
        "y=\"{4:.1f}\" fill=\"{2}\">{5}</text>\n",
        x, y, colour, x + 5, y - 4, label);
  }

  const Polyhedron& input_;
  const MeshFile& mesh_;
  Place place_;
  View view_;
};

}  // namespace

Place place_of(const std::string& sentence) {
  Place place;
  std::string rest = sentence;
  for_each_match(rest, "at \\(([-+.0-9e]+), ([-+.0-9e]+), ([-+.0-9e]+)\\)", [&](const auto& m) {
    place.points.push_back({std::strtod(m[1].str().c_str(), nullptr),
                            std::strtod(m[2].str().c_str(), nullptr),
                            std::strtod(m[3].str().c_str(), nullptr)});
  });
  for_each_match(rest, "(?:tetrahedron [0-9]+|face) \\(([0-9 ]+)\\)", [&](const auto& m) {
    place.cells.push_back(numbers_in(m[1]));
    append(place.vertices, place.cells.back());
  });
  for_each_match(rest, "input edge ([0-9]+-[0-9]+)",
                 [&](const auto& m) { append(place.input_vertices, numbers_in(m[1])); });
  for_each_match(rest, "(input )?vertex ([0-9]+)", [&](const auto& m) {
    append(m[1].matched ? place.input_vertices : place.vertices, numbers_in(m[2]));
  });
  for_each_match(rest, "facet ([0-9]+)",
                 [&](const auto& m) { append(place.input_triangles, numbers_in(m[1])); });
  return place;
}

std::optional<std::string> sentence_with_place(const std::string& verdict_json) {
  try {
    const auto json = nlohmann::json::parse(verdict_json);
    for (const auto& oracle : json.at("oracles")) {
      if (oracle.at("status") != "FAIL") continue;
      for (const auto& finding : oracle.at("findings")) {
        const auto text = finding.get<std::string>();
        if (!place_of(text).empty()) return oracle.at("name").get<std::string>() + ": " + text;
      }
    }
    return std::string();
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;
  }
}

std::string picture_in(const std::string& verdict_json) {
  const auto json = nlohmann::json::parse(verdict_json, nullptr, false);
  return json.is_object() ? json.value("picture", "") : "";
}

std::string picture_of(const Polyhedron& input, const MeshFile& mesh, const std::string& sentence) {
  return Picture(input, mesh, place_of(sentence)).draw(sentence);
}

}  // namespace tetproof
