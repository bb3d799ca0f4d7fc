// Gmsh MSH 4.1, binary or ASCII, and 2.2, ASCII (Gmsh reference manual, "MSH file format").
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "mesher/io/mesh_reading.h"
#include "mesher/io/write_formats.h"

namespace delmesher::io {
namespace {

constexpr int kSurface = 2, kVolume = 3;  // dimensions of entities

// Number of nodes of an element of first or second order; 0 for elements of other kinds.
std::size_t nodes_of_type(int type) {
  switch (type) {
    case 1:  // line
      return 2;
    case 2:  // triangle
    case 8:  // line of second order
      return 3;
    case 4:  // tetrahedron
      return 4;
    case 9:  // triangle of second order
      return 6;
    case 11:  // tetrahedron of second order
      return 10;
    case 15:  // point
      return 1;
    default:
      return 0;
  }
}

bool is_tetrahedron(int type) {
  return type == 4 || type == 11;
}
bool is_triangle(int type) {
  return type == 2 || type == 9;
}

class GmshReader {
 public:
  GmshReader(std::string_view text, const std::string& path, Polling& polling, MeshBuilder& builder)
      : in_(text, path, Comments::none, polling), builder_(builder) {}

  void read() {
    for (auto section = in_.word(); !section.empty(); section = in_.word()) {
      if (section[0] != '$') in_.fail("a section is expected, not " + in_quotes(section));
      const std::string end = "$End" + std::string(section.substr(1));
      read_section(section, end);
    }
    if (version_ == Version::none) in_.fail("no $MeshFormat: not a file of Gmsh");
  }

 private:
  enum class Version : std::uint8_t { none, two, four };

  void read_section(std::string_view section, const std::string& end) {
    if (version_ == Version::none && section != "$MeshFormat" && section != "$Comments") {
      in_.fail("$MeshFormat is expected, not " + in_quotes(section));
    }
    if (section == "$MeshFormat") {
      read_format();
    } else if (section == "$PhysicalNames") {
      read_names();
    } else if (section == "$Entities" && version_ == Version::four) {
      read_entities();
    } else if (section == "$Nodes") {
      if (!tags_.empty()) in_.fail("a second list of nodes");
      version_ == Version::four ? read_nodes_4() : read_nodes_2();
      index_nodes();
    } else if (section == "$Elements") {
      version_ == Version::four ? read_elements_4() : read_elements_2();
    } else {
      while (in_.need(end.c_str()) != end) {
      }
      return;
    }
    const std::string_view token = in_.need(end.c_str());
    if (token != end) in_.fail(end + " expected, not " + in_quotes(token));
  }

  void read_format() {
    const std::string_view version = in_.need("the version");
    if (version == "4.1") {
      version_ = Version::four;
    } else if (version == "2.2" || version == "2.1" || version == "2") {
      version_ = Version::two;
    } else {
      in_.fail("version " + in_quotes(version) + " is not read, only 4.1 and 2.2");
    }
    const auto type = in_.integer<std::int64_t>("file type");
    const auto size = in_.integer<std::int64_t>("data size");
    binary_ = type != 0;
    if (!binary_) return;
    if (version_ == Version::two) {
      in_.fail("binary .msh files are read of version 4.1 alone: save as text (gmsh -bin 0)");
    }
    if (size != 8) in_.fail("counts of " + std::to_string(size) + " bytes, not 8");
    if (in_.binary<std::int32_t>("the order of bytes") != 1) {
      in_.fail("bytes in big-endian order are not read: save as text (gmsh -bin 0)");
    }
  }

  // Numbers of version 4.1: an int, a size_t, doubles; or text.
  std::int64_t tag(const char* what) {
    return binary_ ? in_.binary<std::int32_t>(what) : in_.integer<std::int64_t>(what);
  }
  std::uint64_t size(const char* what) {
    return binary_ ? in_.binary<std::uint64_t>(what) : in_.integer<std::uint64_t>(what);
  }
  // A size_t that says how many things follow, of at least `bytes` bytes each.
  std::uint64_t count(const char* what, std::uint64_t most, std::uint64_t bytes) {
    return in_.count(size(what), what, most, bytes);
  }
  std::array<double, 3> point() {
    if (!binary_) return in_.point();
    std::array<double, 3> p;
    for (double& x : p) {
      x = in_.binary<double>("a coordinate");
      if (!std::isfinite(x)) in_.fail("non-finite coordinate");
    }
    return p;
  }
  // Passes over numbers, of so many bytes each in a binary file.
  void skip(std::uint64_t numbers, std::size_t bytes) {
    binary_ ? void(in_.bytes(numbers * bytes, "a number")) : in_.skip(numbers);
  }

  // "label L" and "region R" are delmesher's own names of groups whose number need not be theirs.
  // Nor need the numbers of the two sides be, where volumes are nothing else.
  void read_names() {
    std::map<std::int64_t, std::string> volumes;
    for (auto n = in_.count("number of names", kMostCells, 6); n > 0; --n) {
      const int dimension = in_.integer<int>("dimension");
      const std::int64_t tag = tag_from(in_.integer<std::int64_t>("physical tag"));
      std::string_view name = in_.take_rest_of_line();
      if (name.size() < 2 || name.front() != '"' || name.back() != '"') {
        in_.fail("a name in quotation marks is expected");
      }
      name = name.substr(1, name.size() - 2);
      const std::string_view prefix = dimension == kSurface ? "label " : "region ";
      Group group;
      const std::string_view own = name.starts_with(prefix) ? name.substr(prefix.size()) : "";
      const std::string_view number = own.substr(0, own.find(' '));
      if (parse_integer(number, group.number)) {
        name = own.substr(std::min(number.size() + 1, own.size()));
      } else {
        group.number = in_.parsed<std::int32_t>(std::to_string(tag), "physical tag");
        group.inside = dimension != kVolume || name != "outside";
      }
      groups_[{dimension, tag}] = group;
      if (dimension == kSurface) builder_.name_label(group.number, name);
      if (dimension == kVolume) volumes[tag] = name;
    }
    const bool sides = std::ranges::all_of(volumes, [](const auto& volume) {
      return volume.second == "inside" || volume.second == "outside";
    });
    for (const auto& [tag, name] : volumes) {
      Group& group = groups_[{kVolume, tag}];
      if (sides) group.number = group.inside ? kRegionInside : kRegionOutside;
      builder_.name_region(group.number, name);
    }
  }

  static std::int64_t tag_from(std::int64_t tag) {
    return tag < 0 && tag != INT64_MIN ? -tag : tag;
  }

  void read_entities() {
    const std::array<const char*, 4> names = {"number of points", "number of curves",
                                              "number of surfaces", "number of volumes"};
    std::array<std::uint64_t, 4> counts;
    for (std::size_t d = 0; d < 4; ++d) counts[d] = count(names[d], kMostCells, 2);
    for (int d = 0; d < 4; ++d) {
      for (std::uint64_t n = 0; n < counts[static_cast<std::size_t>(d)]; ++n) {
        const std::int64_t entity = tag("entity tag");
        skip(d == 0 ? 3 : 6, sizeof(double));  // the box
        const auto groups = count("number of physical groups", kMostCells, 2);
        for (std::uint64_t k = 0; k < groups; ++k) {
          const std::int64_t group = tag("physical tag");
          if (k == 0) physical_[{d, entity}] = tag_from(group);
        }
        if (d > 0) skip(count("number of boundary entities", kMostCells, 2), sizeof(std::int32_t));
      }
    }
  }

  void read_nodes_4() {
    const auto blocks = count("number of blocks", kMostCells, 2);
    const auto nodes = count("number of nodes", kMostVertices, 8);
    skip(2, sizeof(std::uint64_t));
    for (std::uint64_t b = 0; b < blocks; ++b) {
      const std::int64_t dimension = tag("dimension");
      tag("entity tag");
      const std::int64_t parametric = tag("flag");
      const auto n = count("number of nodes", nodes - tags_.size(), 8);
      for (std::uint64_t i = 0; i < n; ++i) tags_.push_back(size("node tag"));
      for (std::uint64_t i = 0; i < n; ++i) {
        builder_.add_vertex(point());
        if (parametric == 0) continue;
        skip(static_cast<std::uint64_t>(std::clamp<std::int64_t>(dimension, 0, 3)), sizeof(double));
      }
    }
  }

  void read_nodes_2() {
    for (auto n = in_.count("number of nodes", kMostVertices, 8); n > 0; --n) {
      tags_.push_back(in_.integer<std::uint64_t>("node tag"));
      builder_.add_vertex(in_.point());
    }
  }

  // Tags are any numbers, in any order.
  void index_nodes() {
    in_order_ = true;
    for (std::size_t v = 0; v < tags_.size(); ++v) in_order_ = in_order_ && tags_[v] == v + 1;
    if (in_order_) return;
    for (std::uint32_t v = 0; v < tags_.size(); ++v) by_tag_.emplace_back(tags_[v], v);
    std::sort(by_tag_.begin(), by_tag_.end());
    for (std::size_t i = 1; i < by_tag_.size(); ++i) {
      if (by_tag_[i].first == by_tag_[i - 1].first) {
        in_.fail("two nodes have the tag " + std::to_string(by_tag_[i].first));
      }
    }
  }

  std::uint32_t vertex() {
    const std::uint64_t tag = size("node tag");
    if (in_order_) {
      if (tag >= 1 && tag <= tags_.size()) return static_cast<std::uint32_t>(tag - 1);
    } else {
      const auto found = std::lower_bound(by_tag_.begin(), by_tag_.end(), std::pair(tag, 0U));
      if (found != by_tag_.end() && found->first == tag) return found->second;
    }
    in_.fail("there is no node with the tag " + std::to_string(tag));
  }

  struct Group {
    std::int32_t number = 0;
    bool inside = true;
  };
  // The group of an entity's elements: its physical group if it has one, else the entity itself.
  Group group_of(int dimension, std::int64_t entity, std::int64_t physical) const {
    const std::int64_t tag = physical != 0 ? physical : entity;
    if (physical != 0) {
      const auto found = groups_.find({dimension, physical});
      if (found != groups_.end()) return found->second;
    }
    return {in_.parsed<std::int32_t>(std::to_string(tag), "tag"), true};
  }

  void read_element(int type, std::int64_t entity, const Group& group) {
    const std::size_t size = nodes_of_type(type);
    if (!is_tetrahedron(type) && !is_triangle(type)) return skip(size, sizeof(std::uint64_t));
    std::array<std::uint32_t, 10> node{};
    const std::span nodes = std::span(node).first(size);
    for (std::uint32_t& v : nodes) v = vertex();
    const std::size_t corners = is_triangle(type) ? 3 : 4;
    if (is_tetrahedron(type)) {
      builder_.add_tetrahedron({node[0], node[1], node[2], node[3]}, group.number, group.inside);
    } else {
      const bool is_facet = entity >= 1 && entity <= 0xffffffffLL;
      builder_.add_triangle(
          {node[0], node[1], node[2]}, group.number,
          is_facet ? std::optional(static_cast<std::uint32_t>(entity - 1)) : std::nullopt);
    }
    builder_.add_edge_nodes(nodes.first(corners), nodes.subspan(corners));
  }

  int need_type() {
    const std::int64_t type = tag("element type");
    if (type != static_cast<int>(type) || nodes_of_type(static_cast<int>(type)) == 0) {
      in_.fail("elements of type " + std::to_string(type) +
               ": a mesh of tetrahedra of first or second order is expected");
    }
    return static_cast<int>(type);
  }

  Group group_of_type(int type, std::int64_t entity, std::int64_t physical) const {
    if (is_triangle(type)) return group_of(kSurface, entity, physical);
    return is_tetrahedron(type) ? group_of(kVolume, entity, physical) : Group();
  }

  void read_elements_4() {
    const auto blocks = count("number of blocks", kMostCells, 2);
    const auto elements = count("number of elements", kMostCells, 4);
    skip(2, sizeof(std::uint64_t));
    std::uint64_t left = elements;
    for (std::uint64_t b = 0; b < blocks; ++b) {
      const std::int64_t dimension = tag("dimension");
      const std::int64_t entity = tag("entity tag");
      const int type = need_type();
      const auto n = count("number of elements", left, 4);
      left -= n;
      const auto found = physical_.find({static_cast<int>(dimension), entity});
      const Group group = group_of_type(type, entity, found == physical_.end() ? 0 : found->second);
      for (std::uint64_t i = 0; i < n; ++i) {
        size("element tag");
        read_element(type, entity, group);
      }
    }
  }

  void read_elements_2() {
    for (auto n = in_.count("number of elements", kMostCells, 8); n > 0; --n) {
      in_.integer<std::uint64_t>("element tag");
      const int type = need_type();
      const auto tags = in_.count("number of tags", kMostCells, 2);
      std::int64_t physical = 0, entity = 0;
      for (std::uint64_t k = 0; k < tags; ++k) {
        const auto tag = in_.integer<std::int64_t>("tag");
        if (k == 0) physical = tag_from(tag);
        if (k == 1) entity = tag_from(tag);
      }
      read_element(type, entity, group_of_type(type, entity, physical));
    }
  }

  MeshText in_;
  MeshBuilder& builder_;
  Version version_ = Version::none;
  bool binary_ = false;
  std::map<std::pair<int, std::int64_t>, Group> groups_;           // by dimension and tag
  std::map<std::pair<int, std::int64_t>, std::int64_t> physical_;  // of an entity, its first
  std::vector<std::uint64_t> tags_;                                // of the nodes
  bool in_order_ = true;                                           // the tags are 1, 2, ...
  std::vector<std::pair<std::uint64_t, std::uint32_t>> by_tag_;    // else
};

}  // namespace

void read_gmsh(std::string_view text, const std::string& path, Polling& polling,
               MeshBuilder& builder) {
  GmshReader(text, path, polling, builder).read();
}

}  // namespace delmesher::io
