// Gmsh MSH 4.1, binary or ASCII. One surface entity per
// facet, one volume entity per region; physical groups carry the labels.
#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

#include "mesher/io/gmsh_numbers.h"
#include "mesher/io/text.h"
#include "mesher/io/write_formats.h"

namespace delmesher::io {
namespace {

struct Box {
  std::array<double, 3> low, high;
  Box() {
    low.fill(std::numeric_limits<double>::infinity());
    high.fill(-std::numeric_limits<double>::infinity());
  }
  void add(const std::array<double, 3>& p) {
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], p[k]);
      high[k] = std::max(high[k], p[k]);
    }
  }
};

class GmshWriter {
 public:
  GmshWriter(TextSink& out, const NamedMesh& named)
      : out_(out),
        named_(named),
        mesh_(named.mesh),
        names_(named.names),
        numbers_(out, named.ascii || !fits_bytes(named)) {
    physical_ = tags_of({mesh_.boundary_labels.begin(), mesh_.boundary_labels.end()});
    number_regions();
    order_triangles();
  }

  void write() {
    numbers_.format();
    write_physical_names();
    numbers_.in_section("Entities", [&] { write_entities(); });
    numbers_.in_section("Nodes", [&] { write_nodes(); });
    numbers_.in_section("Elements", [&] { write_elements(); });
  }

 private:
  static std::map<std::int32_t, std::int64_t> tags_of(const std::set<std::int32_t>& numbers);
  static bool fits_bytes(const NamedMesh& named);
  void number_regions();
  void order_triangles();
  static bool tells_another(const std::string& name, std::int32_t number,
                            const std::string& unnamed);
  static std::string group_name(const LabelNames& names, std::int32_t number,
                                const std::string& name, const char* unnamed);
  void write_physical_names();
  void write_entities();
  void write_volume(std::int32_t number, const std::set<std::int64_t>& surfaces);
  std::map<std::int32_t, std::set<std::int64_t>> surfaces_of_regions() const;
  void write_nodes();
  void write_elements();
  void box(const Box& b) {
    numbers_.point(b.low);
    numbers_.point(b.high);
  }
  std::uint64_t facet_tag(std::size_t triangle) const {
    return std::uint64_t{mesh_.boundary_facets[triangle]} + 1;  // tags begin at 1
  }
  // Calls action(begin, end) for every run of one facet in order_.
  template <typename Action>
  void each_facet(Action action) const {
    for (std::size_t begin = 0, end = 0; begin < order_.size(); begin = end) {
      while (end < order_.size() && facet_tag(order_[end]) == facet_tag(order_[begin])) ++end;
      action(begin, end);
    }
  }

  // An element, with its nodes in Gmsh's order.
  void element(std::size_t tag, CellNodes nodes) {
    if (nodes.count == 10) std::swap(nodes.node[8], nodes.node[9]);  // the edges 23 13
    numbers_.size(tag);
    for (const std::uint32_t v : nodes) numbers_.size(v + 1ULL);
    numbers_.end_line();
  }

  TextSink& out_;
  const NamedMesh& named_;
  const TetMesh& mesh_;
  const LabelNames& names_;
  GmshNumbers numbers_;
  std::map<std::int32_t, std::int64_t> physical_;  // of a label
  std::map<std::int32_t, std::int64_t> volume_;    // of a region, entity and group
  Members tetrahedra_;                             // of a region
  std::vector<std::size_t> order_;                 // boundary triangles by facet
  std::size_t facets_ = 0;
};

// A tag must be positive: positive labels and regions are their own tag, the others (0, the
// default, among them) get the tags after the largest. The names tell the numbers in every case.
std::map<std::int32_t, std::int64_t> GmshWriter::tags_of(const std::set<std::int32_t>& numbers) {
  std::map<std::int32_t, std::int64_t> tags;
  std::int64_t next = numbers.empty() ? 1 : std::max(*numbers.rbegin(), 0) + 1LL;
  for (auto n = numbers.rbegin(); n != numbers.rend(); ++n) tags[*n] = *n > 0 ? *n : next++;
  return tags;
}

// Tags of entities and groups have four bytes; whatever has larger ones is written as text.
bool GmshWriter::fits_bytes(const NamedMesh& named) {
  const auto below = [](const auto& numbers, std::int64_t bound) {
    return std::all_of(numbers.begin(), numbers.end(), [&](auto n) { return n < bound; });
  };
  // The tags of labels and regions that are not positive follow the largest.
  constexpr std::int64_t kInts = std::numeric_limits<std::int32_t>::max();
  const auto most = static_cast<std::int64_t>(named.mesh.boundary.size());
  const auto all = static_cast<std::int64_t>(named.mesh.tetrahedra.size());
  return below(named.mesh.boundary_facets, kInts) &&
         below(named.mesh.boundary_labels, kInts - most) && below(named.mesh.regions, kInts - all);
}

void GmshWriter::number_regions() {
  tetrahedra_ = tetrahedra_of_regions(mesh_);
  std::set<std::int32_t> regions;
  for (const auto& [number, tetrahedra] : tetrahedra_) regions.insert(number);
  volume_ = tags_of(regions);
}

void GmshWriter::order_triangles() {
  order_.resize(mesh_.boundary.size());
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  std::stable_sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) {
    return mesh_.boundary_facets[a] < mesh_.boundary_facets[b];
  });
  each_facet([&](std::size_t, std::size_t) { ++facets_; });
}

// Does the name contain a number, other than just this one?
bool GmshWriter::tells_another(const std::string& name, std::int32_t number,
                               const std::string& unnamed) {
  if (!name.starts_with(unnamed) || name == unnamed + std::to_string(number)) return false;
  const std::string_view rest = std::string_view(name).substr(unnamed.size());
  std::int32_t told = 0;
  return parse_integer(rest.substr(0, rest.find(' ')), told);
}

// A number that is not positive cannot be the tag, so its name contains it; that of a name which
// would tell one as well, too.
std::string GmshWriter::group_name(const LabelNames& names, std::int32_t number,
                                   const std::string& name, const char* unnamed) {
  const bool told =
      !names.contains(number) || (number > 0 && !tells_another(name, number, unnamed));
  std::string group = told ? name : unnamed + std::to_string(number) + " " + name;
  std::replace(group.begin(), group.end(), '"', '\'');
  return group;
}

void GmshWriter::write_physical_names() {
  out_.text("$PhysicalNames\n");
  out_.integer(physical_.size() + volume_.size());
  out_.text("\n");
  for (const auto& [label, tag] : physical_) {
    out_.text("2 ");
    out_.integers(tag);
    out_.text("\"" + group_name(names_, label, label_name(names_, label), "label ") + "\"\n");
  }
  for (const auto& [number, tag] : volume_) {
    out_.text("3 ");
    out_.integers(tag);
    out_.text("\"" +
              group_name(named_.region_names, number, region_name(named_, number), "region ") +
              "\"\n");
  }
  out_.text("$EndPhysicalNames\n");
}

// The surfaces where each region ends: positive where the triangles look out of it, negative where
// they look into it.
std::map<std::int32_t, std::set<std::int64_t>> GmshWriter::surfaces_of_regions() const {
  std::map<std::int32_t, std::set<std::int64_t>> surfaces;
  const std::vector<TriangleSides> sides = sides_of_boundary(mesh_);
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const auto tag = static_cast<std::int64_t>(facet_tag(i));
    for (const bool behind : {true, false}) {
      const TriangleSides::Side& side = sides[i].sides[behind ? 0 : 1];
      if (side.apex == TriangleSides::kNone) continue;
      std::set<std::int64_t>& bounding = surfaces[region(mesh_, side.tetrahedron)];
      if (!bounding.contains(behind ? -tag : tag)) bounding.insert(behind ? tag : -tag);
    }
  }
  return surfaces;
}

void GmshWriter::write_volume(std::int32_t number, const std::set<std::int64_t>& surfaces) {
  Box volume;
  for (const std::size_t t : tetrahedra_.at(number)) {
    for (const std::uint32_t v : mesh_.tetrahedra[t]) volume.add(mesh_.vertices[v]);
  }
  numbers_.tag(volume_.at(number));
  box(volume);
  numbers_.size(1);
  numbers_.tag(volume_.at(number));
  numbers_.size(surfaces.size());
  for (const std::int64_t tag : surfaces) numbers_.tag(tag);
  numbers_.end_line();
}

void GmshWriter::write_entities() {
  for (const std::size_t count : {std::size_t{0}, std::size_t{0}, facets_, volume_.size()}) {
    numbers_.size(count);
  }
  numbers_.end_line();
  each_facet([&](std::size_t begin, std::size_t end) {
    Box facet;
    for (std::size_t i = begin; i < end; ++i) {
      for (std::uint32_t v : mesh_.boundary[order_[i]]) facet.add(mesh_.vertices[v]);
    }
    numbers_.tag(static_cast<std::int64_t>(facet_tag(order_[begin])));
    box(facet);
    numbers_.size(1);
    numbers_.tag(physical_.at(mesh_.boundary_labels[order_[begin]]));
    numbers_.size(0);
    numbers_.end_line();
  });
  auto surfaces = surfaces_of_regions();
  for (const auto& [number, tag] : volume_) write_volume(number, surfaces[number]);
}

void GmshWriter::write_nodes() {
  const std::size_t n = named_.nodes();
  numbers_.number_nodes(3, volume_.empty() ? 1 : volume_.begin()->second, n);  // the first volume
  for (std::size_t i = 0; i < n; ++i) {
    numbers_.point(named_.node(i));
    numbers_.end_line();
  }
}

void GmshWriter::write_elements() {
  const std::size_t total = mesh_.boundary.size() + mesh_.tetrahedra.size();
  numbers_.announce(facets_ + tetrahedra_.size(), total);
  std::size_t tag = 1;
  each_facet([&](std::size_t begin, std::size_t end) {
    numbers_.begin_block(2, static_cast<std::int64_t>(facet_tag(order_[begin])),
                         named_.second_order() ? 9 : 2, end - begin);
    for (std::size_t i = begin; i < end; ++i) element(tag++, named_.triangle(order_[i]));
  });
  for (const auto& [number, tetrahedra] : tetrahedra_) {
    numbers_.begin_block(3, volume_.at(number), named_.second_order() ? 11 : 4, tetrahedra.size());
    for (const std::size_t i : tetrahedra) element(tag++, named_.tetrahedron(i));
  }
}

}  // namespace

void write_gmsh(TextSink& out, const NamedMesh& named) {
  GmshWriter(out, named).write();
}

}  // namespace delmesher::io
