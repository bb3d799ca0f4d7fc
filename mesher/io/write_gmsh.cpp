// Gmsh MSH 4.1, binary or ASCII, and 2.2. One surface entity per facet, one volume entity per
// region; physical groups carry the labels.
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

// The tags of labels and of regions.
struct Groups {
  std::map<std::int32_t, std::int64_t> label, region;

  Groups(const Members& triangles, const Members& tetrahedra) {
    std::vector<std::int64_t> numbers;
    for (auto l = triangles.rbegin(); l != triangles.rend(); ++l) numbers.push_back(l->first);
    for (const auto& [number, members] : tetrahedra) numbers.push_back(number);
    const std::vector<std::int64_t> tags = group_tags(numbers);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      (i < triangles.size() ? label : region)[static_cast<std::int32_t>(numbers[i])] = tags[i];
    }
  }

  std::int64_t largest() const {
    std::int64_t tag = 0;
    for (const auto& tags : {label, region}) {
      for (const auto& [number, t] : tags) tag = std::max(tag, t);
    }
    return tag;
  }
};

class GmshWriter {
 public:
  GmshWriter(TextSink& out, const NamedMesh& named)
      : out_(out),
        named_(named),
        mesh_(named.mesh),
        names_(named.names),
        tetrahedra_(tetrahedra_of_regions(mesh_)),
        groups_(triangles_of_labels(mesh_), tetrahedra_),
        numbers_(out, named.ascii || !fits_bytes(), named.msh) {
    order_triangles();
  }

  void write() {
    numbers_.format();
    write_physical_names();
    if (named_.msh == MshVersion::v4_1) {
      numbers_.in_section("Entities", [&] { write_entities(); });
    }
    numbers_.nodes(3, groups_.region.empty() ? 1 : groups_.region.begin()->second, named_.nodes(),
                   [&](std::size_t i) { return named_.node(i); });
    numbers_.in_section("Elements", [&] { write_elements(); });
    if (mesh_.planar_within == 0) return;
    out_.text("$Comments\nPlanarWithin ");
    out_.number(mesh_.planar_within);
    out_.text("\n$EndComments\n");
  }

 private:
  bool fits_bytes() const;
  void order_triangles();
  static bool tells_another(const std::string& name, std::int32_t number,
                            const std::string& unnamed);
  static std::string group_name(bool given, std::int32_t number, std::int64_t tag,
                                const std::string& name, const char* unnamed);
  void write_physical_names();
  void write_entities();
  void write_volume(std::int32_t number, const std::set<std::int64_t>& surfaces);
  std::map<std::int32_t, std::set<std::int64_t>> surfaces_of_regions() const;
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
  void element(CellNodes nodes) {
    if (nodes.count == 10) std::swap(nodes.node[8], nodes.node[9]);  // the edges 23 13
    numbers_.element(nodes);
  }

  TextSink& out_;
  const NamedMesh& named_;
  const TetMesh& mesh_;
  const LabelNames& names_;
  Members tetrahedra_;  // of a region
  Groups groups_;       // the tag of a region is that of its entity, too
  GmshNumbers numbers_;
  std::vector<std::size_t> order_;  // boundary triangles by facet
  std::size_t facets_ = 0;
};

// Tags of entities and groups have four bytes; whatever has larger ones is written as text.
bool GmshWriter::fits_bytes() const {
  const auto fits = [](std::int64_t tag) {
    return tag <= std::numeric_limits<std::int32_t>::max();
  };
  return fits(groups_.largest()) &&
         std::all_of(mesh_.boundary_facets.begin(), mesh_.boundary_facets.end(),
                     [&](std::uint32_t f) { return fits(std::int64_t{f} + 1); });
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

// A number that could not be the tag is told by the name, and so is that of a name which would tell
// one as well. "inside" and "outside" tell theirs.
std::string GmshWriter::group_name(bool given, std::int32_t number, std::int64_t tag,
                                   const std::string& name, const char* unnamed) {
  const bool told = !given || (number == tag && !tells_another(name, number, unnamed));
  std::string group = told ? name : unnamed + std::to_string(number) + " " + name;
  std::replace(group.begin(), group.end(), '"', '\'');
  return group;
}

void GmshWriter::write_physical_names() {
  out_.text("$PhysicalNames\n");
  out_.integer(groups_.label.size() + groups_.region.size());
  out_.text("\n");
  const auto line = [&](const char* dimension, std::int64_t tag, const std::string& name) {
    out_.text(dimension);
    out_.integers(tag);
    out_.text("\"" + name + "\"\n");
  };
  for (const auto& [label, tag] : groups_.label) {
    line("2 ", tag,
         group_name(names_.contains(label), label, tag, label_name(names_, label), "label "));
  }
  for (const auto& [number, tag] : groups_.region) {
    const bool given = !mesh_.regions.empty() && named_.region_names.contains(number);
    line("3 ", tag, group_name(given, number, tag, region_name(named_, number), "region "));
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
  numbers_.tag(groups_.region.at(number));
  box(volume);
  numbers_.size(1);
  numbers_.tag(groups_.region.at(number));
  numbers_.size(surfaces.size());
  for (const std::int64_t tag : surfaces) numbers_.tag(tag);
  numbers_.end_line();
}

void GmshWriter::write_entities() {
  for (const std::size_t count : {std::size_t{0}, std::size_t{0}, facets_, groups_.region.size()}) {
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
    numbers_.tag(groups_.label.at(mesh_.boundary_labels[order_[begin]]));
    numbers_.size(0);
    numbers_.end_line();
  });
  auto surfaces = surfaces_of_regions();
  for (const auto& [number, tag] : groups_.region) write_volume(number, surfaces[number]);
}

void GmshWriter::write_elements() {
  numbers_.announce(facets_ + tetrahedra_.size(), mesh_.boundary.size() + mesh_.tetrahedra.size());
  each_facet([&](std::size_t begin, std::size_t end) {
    numbers_.begin_block(2, static_cast<std::int64_t>(facet_tag(order_[begin])),
                         groups_.label.at(mesh_.boundary_labels[order_[begin]]),
                         named_.second_order() ? 9 : 2, end - begin);
    for (std::size_t i = begin; i < end; ++i) element(named_.triangle(order_[i]));
  });
  for (const auto& [number, tetrahedra] : tetrahedra_) {
    const std::int64_t tag = groups_.region.at(number);
    numbers_.begin_block(3, tag, tag, named_.second_order() ? 11 : 4, tetrahedra.size());
    for (const std::size_t i : tetrahedra) element(named_.tetrahedron(i));
  }
}

}  // namespace

void write_gmsh(TextSink& out, const NamedMesh& named) {
  GmshWriter(out, named).write();
}

}  // namespace delmesher::io
