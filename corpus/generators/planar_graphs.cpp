#include "corpus/generators/planar_graphs.h"

#include <charconv>
#include <fstream>
#include <functional>
#include <map>
#include <stdexcept>
#include <string_view>

#include "oracles/plane/shapes.h"

namespace tetproof {
namespace {

using delmesher::PlanarGraph;

constexpr std::string_view kTiny = "tiny-angles", kFigure = "figure";

const std::map<std::string, std::function<PlanarGraph(int)>, std::less<>>& grown() {
  static const std::map<std::string, std::function<PlanarGraph(int)>, std::less<>> families = {
      {"koch", shapes::koch},
      {"star", [](int n) { return shapes::star(n, 0.3); }},
      {"comb", [](int n) { return shapes::comb(n, 0.5 / n); }},
      {"fan", [](int n) { return shapes::fan(n, 1.0 / n); }},
      {"rough", [](int n) { return shapes::rough_circle(n, 0.2, 1); }},
      {"nested", shapes::nested_squares},
      {"archipelago", [](int n) { return shapes::archipelago(n / 2, n / 18, 1); }}};
  return families;
}

// 0: it says none.
int size_in(std::string_view name) {
  const auto colon = name.find(':');
  int size = 0;
  if (colon == name.npos) return 0;
  const auto [end, error] =
      std::from_chars(name.data() + colon + 1, name.data() + name.size(), size);
  return error == std::errc() && end == name.data() + name.size() ? size : 0;
}

void write(const std::filesystem::path& stem, const PlanarGraph& graph) {
  const bool rings = graph.insideness == delmesher::Insideness::nested;
  const std::string path = stem.string() + (rings ? ".txt" : ".poly");
  std::ofstream out(path);
  out.precision(17);
  const auto point = [&](const std::array<double, 2>& p) { out << p[0] << ' ' << p[1] << '\n'; };
  if (rings) {
    for (std::size_t i = 0; i < graph.segments.size(); ++i) {
      // One that only divides is there twice.
      const bool divides = !graph.partitions.empty() && graph.partitions[i] != 0;
      for (int times = divides ? 2 : 1; times > 0; --times) {
        for (const std::uint32_t v : graph.segments[i]) point(graph.vertices[v]);
        out << '\n';
      }
    }
  } else {
    out << graph.vertices.size() << " 2 0 0\n";
    for (std::size_t v = 0; v < graph.vertices.size(); ++v) {
      out << v << ' ';
      point(graph.vertices[v]);
    }
    out << graph.segments.size() << " 0\n";
    for (std::size_t i = 0; i < graph.segments.size(); ++i) {
      out << i << ' ' << graph.segments[i][0] << ' ' << graph.segments[i][1] << '\n';
    }
    out << graph.holes.size() << '\n';
    for (std::size_t i = 0; i < graph.holes.size(); ++i) {
      out << i << ' ';
      point(graph.holes[i]);
    }
  }
  out.close();
  if (!out) throw std::runtime_error(path + ": cannot be written");
}

}  // namespace

bool is_planar_family(const std::string& name) {
  return name == kTiny || name == kFigure ||
         (grown().contains(name.substr(0, name.find(':'))) && size_in(name) > 0);
}

std::size_t write_planar_graphs(const std::string& name, std::uint64_t first, std::uint64_t count,
                                const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  if (name == kTiny) {
    for (std::uint64_t seed = first; seed < first + count; ++seed) {
      write(folder / (name + "-" + std::to_string(seed)), shapes::tiny_angles(seed).graph);
    }
    return count;
  }
  std::string stem = name;
  if (name == kFigure) {
    write(folder / stem, shapes::figure());
  } else {
    const std::string family = name.substr(0, name.find(':'));
    stem = family + "-" + std::to_string(size_in(name));
    write(folder / stem, grown().at(family)(size_in(name)));
  }
  return 1;
}

}  // namespace tetproof
