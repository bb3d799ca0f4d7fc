#include "reports/views.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>
#include <tuple>

#include "oracles/base/vectors.h"
#include "oracles/files/mesh_file.h"
#include "oracles/files/surface_file.h"
#include "reports/measures.h"

namespace tetproof {
namespace {

using Point = oracles::Position;

namespace fs = std::filesystem;

static_assert(std::endian::native == std::endian::little);  // the page reads arrays as they are

// Is the mesh a quality mesh of our program? Its cdt has no quality to show.
bool is_ours(const RunRow& row) {
  return row.key.version.starts_with("delmesher ") && row.key.flags.starts_with("mesh");
}

// The order of the meshes of a model: our default run, our others, then those of other programs.
int rank_of(const RunRow& row) {
  if (is_ours(row)) return row.key.mesher == "delmesher" ? 0 : 1;
  return 2;
}

// Moves a model's box to the middle of [-1, 1]^3. Computed in double, shown in float.
struct Frame {
  std::array<double, 3> middle{};
  double scale = 1;

  explicit Frame(const std::vector<Point>& points) {
    Point low = points.at(0), high = low;
    for (const Point& p : points) {
      for (int k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], p[k]);
        high[k] = std::max(high[k], p[k]);
      }
    }
    double size = 0;
    for (int k = 0; k < 3; ++k) {
      middle[k] = low[k] + (high[k] - low[k]) / 2;
      size = std::max(size, (high[k] - low[k]) / 2);
    }
    scale = size > 0 ? 1 / size : 1;
  }

  void append(const Point& p, std::vector<float>& out) const {
    for (int k = 0; k < 3; ++k) {
      out.push_back(static_cast<float>((p[k] - middle[k]) * scale));
    }
  }
};

ViewPart surface_part(const oracles::Polyhedron& surface, const Frame& frame) {
  ViewPart part;
  for (const Point& p : surface.vertices) frame.append(p, part.vertices);
  for (const auto& t : surface.triangles) part.cells.insert(part.cells.end(), t.begin(), t.end());
  return part;
}

// Four times the smallest face angle in degrees, for a colour.
std::uint8_t quality_of(const std::array<Point, 4>& c) {
  double smallest = 60;
  for (std::size_t apex = 0; apex < 4; ++apex) {
    for (std::size_t i = 1; i < 4; ++i) {
      const Point u = oracles::minus(c[(apex + i) % 4], c[apex]);
      const Point v = oracles::minus(c[(apex + i % 3 + 1) % 4], c[apex]);
      const double sine = oracles::length(oracles::cross(u, v)), cosine = oracles::dot(u, v);
      smallest = std::min(smallest, std::atan2(sine, cosine) * 180 / std::numbers::pi);
    }
  }
  return static_cast<std::uint8_t>(std::floor(4 * smallest));
}

ViewPart mesh_part(const oracles::MeshFile& mesh, const Frame& frame) {
  ViewPart part;
  part.mesh = true;
  for (const Point& p : mesh.vertices) frame.append(p, part.vertices);
  for (const auto& t : mesh.tetrahedra) {
    part.cells.insert(part.cells.end(), t.begin(), t.end());
    part.quality.push_back(quality_of({mesh.vertices.at(t[0]), mesh.vertices.at(t[1]),
                                       mesh.vertices.at(t[2]), mesh.vertices.at(t[3])}));
  }
  if (mesh.regions.size() == mesh.tetrahedra.size()) {
    for (const auto region : mesh.regions) part.inside.push_back(region == 1);
    part.hull = std::find(part.inside.begin(), part.inside.end(), 0) != part.inside.end();
  }
  return part;
}

fs::path chamfered_beside(const RunRow& row) {
  return fs::path(row.mesh_path).replace_extension().string() + ".chamfered.off";
}

bool can_be_shown(const RunRow* row, const ViewOptions& options) {
  return row != nullptr && row->mesh && row->mesh->tetrahedra > 0 &&
         row->mesh->tetrahedra <= options.tetrahedra && !row->mesh_path.empty() &&
         fs::exists(row->mesh_path);
}

// The models asked for by name, then models spread evenly by size, so that the gallery shows all
// sizes.
std::vector<std::size_t> chosen_models(const Selection& selection, const ViewOptions& options) {
  std::vector<std::pair<std::uint64_t, std::size_t>> with_ours, others;
  std::vector<std::size_t> chosen;
  for (std::size_t m = 0; m < selection.models.size(); ++m) {
    const std::string& model = selection.models[m];
    std::uint64_t size = 0;
    bool ours = false;
    for (const std::string& mesher : selection.meshers) {
      const RunRow* row = selection.run(mesher, model);
      if (!can_be_shown(row, options)) continue;
      size = std::max(size, row->mesh->tetrahedra);
      ours = ours || is_ours(*row);
    }
    if (size == 0) continue;
    const std::string name = short_name(selection.model_names.at(model));
    if (std::find(options.wanted.begin(), options.wanted.end(), name) != options.wanted.end()) {
      chosen.push_back(m);
    } else {
      (ours ? with_ours : others).emplace_back(size, m);
    }
  }
  for (auto* candidates : {&with_ours, &others}) {
    std::sort(candidates->begin(), candidates->end());
    const std::size_t free = options.models - std::min(options.models, chosen.size());
    const std::size_t count = std::min(free, candidates->size());
    for (std::size_t i = 0; i < count; ++i) {
      chosen.push_back((*candidates)[(2 * i + 1) * candidates->size() / (2 * count)].second);
    }
  }
  return chosen;
}

class Collector {
 public:
  Collector(const Selection& selection, const ViewOptions& options, std::vector<std::string>& notes)
      : selection_(selection), options_(options), notes_(notes) {}

  std::vector<ViewPart> collect() {
    const auto models = chosen_models(selection_, options_);
    for (const bool first : {true, false}) {
      for (const std::size_t model : models) add_model(model, first);
    }
    // The page opens on the first part: of the model that has the most to look at, which is a mesh
    // of ours, then many meshes beside each other, then one of many tetrahedra.
    std::map<std::size_t, std::array<std::size_t, 3>> interest;
    for (const ViewPart& part : parts_) {
      auto& [ours, meshes, tetrahedra] = interest[part.model];
      if (!part.mesh) continue;
      ours = std::max(ours, std::size_t{part.ours});
      ++meshes;
      tetrahedra = std::max(tetrahedra, part.cells.size() / 4);
    }
    const auto first =
        std::max_element(interest.begin(), interest.end(),
                         [](const auto& a, const auto& b) { return a.second < b.second; });
    std::stable_sort(parts_.begin(), parts_.end(), [&](const ViewPart& a, const ViewPart& b) {
      const auto place = [&](std::size_t model) {
        return std::tuple(model != first->first, interest[model][0] == 0,
                          std::find(models.begin(), models.end(), model));
      };
      return place(a.model) < place(b.model);
    });
    return std::move(parts_);
  }

 private:
  // The input and the first mesh, or all others.
  void add_model(std::size_t m, bool first) {
    const std::string& model = selection_.models[m];
    std::vector<const RunRow*> rows;
    for (const std::string& mesher : selection_.meshers) {
      const RunRow* row = selection_.run(mesher, model);
      if (can_be_shown(row, options_)) rows.push_back(row);
    }
    std::stable_sort(rows.begin(), rows.end(),
                     [](const RunRow* a, const RunRow* b) { return rank_of(*a) < rank_of(*b); });
    const auto read = [&](const auto& use) {
      const auto input = oracles::read_surface(rows.front()->model_path);
      use(input, Frame(input.vertices));
    };
    if (first) {
      guarded(rows.front()->model_path, [&] {
        read([&](const oracles::Polyhedron& input, const Frame& frame) {
          add(surface_part(input, frame), m, "input");
          add_run(*rows.front(), m, frame);
        });
        readable_.insert(m);
      });
    } else if (readable_.contains(m)) {
      guarded(rows.front()->model_path, [&] {
        read([&](const oracles::Polyhedron&, const Frame& frame) {
          for (std::size_t i = 1; i < rows.size(); ++i) add_run(*rows[i], m, frame);
        });
      });
    }
  }

  void add_run(const RunRow& row, std::size_t m, const Frame& frame) {
    guarded(row.mesh_path, [&] {
      if (fs::exists(chamfered_beside(row))) {
        add(surface_part(oracles::read_surface(chamfered_beside(row)), frame), m,
            "chamfered, " + row.key.mesher);
      }
      ViewPart part = mesh_part(oracles::read_mesh(row.mesh_path), frame);
      part.ours = is_ours(row);
      add(std::move(part), m, row.key.mesher);
    });
  }

  template <typename Action>
  void guarded(const std::string& file, const Action& action) {
    try {
      action();
    } catch (const std::exception& error) {
      notes_.push_back("not shown: " + file + ": " + error.what());
    }
  }

  void add(ViewPart part, std::size_t model, const std::string& label) {
    const std::uint64_t bytes = 4 * part.vertices.size() +
                                (part.vertices.size() / 3 < 65536 ? 2 : 4) * part.cells.size() +
                                part.quality.size() + part.inside.size();
    const std::uint64_t text = bytes + bytes / 3;
    if (used_ + text > options_.bytes) {
      notes_.push_back(fmt::format("{}, {}: not shown, the page would be too large",
                                   selection_.model_names.at(selection_.models[model]), label));
      return;
    }
    used_ += text;
    part.model = model;
    part.label = label;
    parts_.push_back(std::move(part));
  }

  const Selection& selection_;
  const ViewOptions& options_;
  std::vector<std::string>& notes_;
  std::uint64_t used_ = 0;
  std::set<std::size_t> readable_;  // models
  std::vector<ViewPart> parts_;
};

}  // namespace

std::vector<ViewPart> collect_views(const Selection& selection, const ViewOptions& options,
                                    std::vector<std::string>& notes) {
  return Collector(selection, options, notes).collect();
}

std::string base64(const void* data, std::size_t size) {
  static constexpr char kDigits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const auto* bytes = static_cast<const unsigned char*>(data);
  std::string text;
  text.reserve((size + 2) / 3 * 4);
  for (std::size_t i = 0; i < size; i += 3) {
    const unsigned present = static_cast<unsigned>(std::min<std::size_t>(3, size - i));
    unsigned word = 0;
    for (unsigned k = 0; k < 3; ++k) word = word << 8 | (k < present ? bytes[i + k] : 0u);
    for (unsigned k = 0; k < 4; ++k) {
      text += k <= present ? kDigits[word >> (18 - 6 * k) & 63] : '=';
    }
  }
  return text;
}

std::string to_json(const ViewPart& part) {
  nlohmann::ordered_json json = {{"model", part.model},
                                 {"label", part.label},
                                 {"kind", part.mesh ? "mesh" : "surface"},
                                 {"hull", part.hull},
                                 {"ours", part.ours}};
  json["v"] = base64(part.vertices.data(), part.vertices.size() * sizeof(float));
  const bool wide = part.vertices.size() / 3 >= 65536;
  json["wide"] = wide;
  if (wide) {
    json["c"] = base64(part.cells.data(), part.cells.size() * sizeof(std::uint32_t));
  } else {
    const std::vector<std::uint16_t> narrow(part.cells.begin(), part.cells.end());
    json["c"] = base64(narrow.data(), narrow.size() * sizeof(std::uint16_t));
  }
  if (!part.quality.empty()) json["q"] = base64(part.quality.data(), part.quality.size());
  if (!part.inside.empty()) json["i"] = base64(part.inside.data(), part.inside.size());
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace tetproof
