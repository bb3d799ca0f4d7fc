// Gmsh MSH 4.1, binary or ASCII, and 2.2, of the plane.
#include <algorithm>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "mesher/io/gmsh_numbers.h"
#include "mesher/io/text.h"
#include "mesher/io/write_plane_formats.h"

namespace delmesher::io {
namespace {

// A curve per marker, a surface per side and attribute; each is an entity and a group of one tag.
struct Part {
  std::int64_t tag = 0;
  std::string name;
  std::vector<std::size_t> members;
};
struct Parts {
  std::vector<Part> curves, surfaces;

  explicit Parts(const PlaneMesh& mesh) {
    std::map<std::int32_t, std::vector<std::size_t>> edges;
    for (std::size_t e = 0; e < mesh.edges.size(); ++e) edges[mesh.edge_markers[e]].push_back(e);
    std::map<std::pair<int, double>, std::vector<std::size_t>> triangles;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      triangles[{region(mesh, t), mesh.attributes.empty() ? 0 : mesh.attributes[t]}].push_back(t);
    }
    std::vector<std::int64_t> numbers;
    for (auto& [marker, members] : edges) {
      numbers.push_back(marker);
      curves.push_back({0, "marker " + std::to_string(marker), std::move(members)});
    }
    for (auto& [which, members] : triangles) {
      const auto& [side, attribute] = which;
      numbers.push_back(mesh.attributes.empty() ? side : side_number(side, attribute));
      surfaces.push_back({0, name(mesh, side, attribute), std::move(members)});
    }
    const std::vector<std::int64_t> tags = group_tags(numbers);
    for (std::size_t i = 0; i < tags.size(); ++i) {
      (i < curves.size() ? curves[i] : surfaces[i - curves.size()]).tag = tags[i];
    }
  }

  bool fit_bytes() const {
    const auto fit = [](const std::vector<Part>& parts) {
      return std::ranges::all_of(parts, [](const Part& part) {
        return part.tag <= std::numeric_limits<std::int32_t>::max();
      });
    };
    return fit(curves) && fit(surfaces);
  }

 private:
  // The attribute, where it could be a tag.
  static std::int64_t side_number(int side, double attribute) {
    if (side != kRegionInside || !(attribute > 0 && attribute < 0x1p31)) return 0;
    const auto whole = static_cast<std::int64_t>(attribute);
    return static_cast<double>(whole) == attribute ? whole : 0;
  }
  static std::string name(const PlaneMesh& mesh, int side, double attribute) {
    if (mesh.attributes.empty()) return side == kRegionInside ? "inside" : "outside";
    std::string name = side == kRegionInside ? "region " : "outside ";
    append_double(name, attribute);
    return name;
  }
};

class PlaneGmshWriter {
 public:
  PlaneGmshWriter(TextSink& out, const PlaneMesh& mesh, bool ascii, MshVersion version)
      : out_(out),
        mesh_(mesh),
        parts_(mesh),
        numbers_(out, ascii || !parts_.fit_bytes(), version),
        version_(version) {}

  void write() {
    numbers_.format();
    write_names();
    if (version_ == MshVersion::v4_1) {
      numbers_.in_section("Entities", [&] { write_entities(); });
    }
    const auto& surfaces = parts_.surfaces;
    numbers_.nodes(2, surfaces.empty() ? 1 : surfaces[0].tag, mesh_.vertices.size(),
                   [&](std::size_t i) {
                     const auto& [x, y] = mesh_.vertices[i];
                     return std::array<double, 3>{x, y, 0};
                   });
    numbers_.in_section("Elements", [&] { write_elements(); });
  }

 private:
  void write_names() {
    out_.text("$PhysicalNames\n");
    out_.integer(parts_.curves.size() + parts_.surfaces.size());
    line(out_);
    for (const int dimension : {1, 2}) {
      for (const Part& part : dimension == 1 ? parts_.curves : parts_.surfaces) {
        out_.integers(dimension, part.tag);
        out_.text("\"" + part.name + "\"\n");
      }
    }
    out_.text("$EndPhysicalNames\n");
  }

  void write_entity(std::int64_t tag) {
    numbers_.tag(tag);
    for (const auto& [x, y] : {low_, high_}) numbers_.point({x, y, 0});
    numbers_.size(1);
    numbers_.tag(tag);
    numbers_.size(0);
    numbers_.end_line();
  }

  void write_entities() {
    if (!mesh_.vertices.empty()) low_ = high_ = mesh_.vertices[0];
    for (const Point2& p : mesh_.vertices) {
      for (std::size_t k = 0; k < 2; ++k) {
        low_[k] = std::min(low_[k], p[k]);
        high_[k] = std::max(high_[k], p[k]);
      }
    }
    for (const std::size_t count :
         {std::size_t{0}, parts_.curves.size(), parts_.surfaces.size(), std::size_t{0}}) {
      numbers_.size(count);
    }
    numbers_.end_line();
    for (const auto& parts : {parts_.curves, parts_.surfaces}) {
      for (const Part& part : parts) write_entity(part.tag);
    }
  }

  template <class Cells>
  void write_blocks(int dimension, const std::vector<Part>& parts, const Cells& cells) {
    for (const Part& part : parts) {
      numbers_.begin_block(dimension, part.tag, part.tag, dimension, part.members.size());
      for (const std::size_t i : part.members) numbers_.element(cells[i]);
    }
  }

  void write_elements() {
    numbers_.announce(parts_.curves.size() + parts_.surfaces.size(),
                      mesh_.edges.size() + mesh_.triangles.size());
    write_blocks(1, parts_.curves, mesh_.edges);
    write_blocks(2, parts_.surfaces, mesh_.triangles);
  }

  TextSink& out_;
  const PlaneMesh& mesh_;
  Parts parts_;
  GmshNumbers numbers_;
  MshVersion version_;
  Point2 low_ = {0, 0}, high_ = {0, 0};
};

}  // namespace

void write_plane_gmsh(TextSink& out, const PlaneMesh& mesh, bool ascii, MshVersion version) {
  PlaneGmshWriter(out, mesh, ascii, version).write();
}

}  // namespace delmesher::io
