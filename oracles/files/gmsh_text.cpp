#include "oracles/files/gmsh_text.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <set>

#include "oracles/base/box.h"
#include "oracles/base/text_reader.h"

namespace tetproof::oracles {
namespace {

// What is announced at the beginning of the nodes, and of the elements: of 4.1.
struct Announced {
  std::uint64_t blocks = 0, total = 0;
  std::int64_t least = 0, largest = 0;  // tags
};

// What an entity says, and what its elements have.
struct Boxes {
  Box told, found;
};

class GmshReader {
 public:
  GmshReader(const std::string& path, const std::function<void(const GmshElement&)>& take)
      : reader_(TextReader::of_file(path, '\0')), take_(take) {}

  GmshText read() {
    while (!reader_.at_end()) {
      const std::string section(reader_.word());
      if (!section.starts_with('$') || section.starts_with("$End")) {
        reader_.fail("\"" + section.substr(0, 40) + "\" where a section should begin");
      }
      const std::string end = "$End" + section.substr(1);
      if (!read_section(section)) {
        for (std::string word; word != end;) {
          word = reader_.required_word(end.c_str());
          if (section == "$Comments" && word == "PlanarWithin") {
            reader_.positive_once(text_.planar_within);
          }
        }
        continue;
      }
      if (!seen_.insert(section).second) reader_.fail(section + " is there twice");
      reader_.expect(end);
    }
    for (const char* section : {"$MeshFormat", "$Nodes", "$Elements"}) {
      if (!seen_.contains(section)) reader_.fail(std::string("there is no ") + section);
    }
    check_further_groups();
    text_.boxes_differ = std::any_of(boxes_.begin(), boxes_.end(), [](const auto& entity) {
      const Boxes& boxes = entity.second;
      return boxes.found != Box() && boxes.found != boxes.told;
    });
    return std::move(text_);
  }

 private:
  // False for a section that says nothing here.
  bool read_section(const std::string& section) {
    if (section == "$MeshFormat") {
      read_format();
    } else if (section == "$PhysicalNames") {
      read_names();
    } else if (section == "$Entities") {
      read_entities();
    } else if (section == "$Nodes") {
      text_.version < 4 ? read_nodes_2() : read_nodes_4();
    } else if (section == "$Elements") {
      text_.version < 4 ? read_elements_2() : read_elements_4();
    } else {
      return false;
    }
    return true;
  }

  // Names of sides and labels are those of an entity's first group.
  void check_further_groups() const {
    for (const auto& group : further_) {
      const auto found = text_.names.find(group);
      if (found == text_.names.end()) continue;
      const std::string& name = found->second;
      if (name == "inside" || name == "outside" || name.starts_with("label ") ||
          name.starts_with("marker ")) {
        reader_.fail("\"" + name + "\" is the name of a second group of an entity");
      }
    }
  }

  void read_format() {
    text_.version = reader_.number();
    if (text_.version != 4.1 && !(text_.version >= 2 && text_.version < 3)) {
      reader_.fail("neither version 4.1 nor 2.2");
    }
    binary_ = reader_.index(0, 2) == 1;
    if (reader_.integer() != 8) reader_.fail("numbers that have not 8 bytes");
    if (!binary_) return;
    if (text_.version < 4) reader_.fail("binary .msh files are read of version 4.1 alone");
    reader_.begin_bytes();
    if (integer() != 1) reader_.fail("bytes in another order");
  }

  // What has four bytes in a binary file: tags of entities and groups, dimensions, types.
  std::int64_t integer() { return binary_ ? reader_.bytes<std::int32_t>() : reader_.integer(); }
  // What has eight: tags of nodes and elements.
  std::int64_t large() { return binary_ ? reader_.bytes<std::int64_t>() : reader_.integer(); }
  double number() { return binary_ ? reader_.bytes<double>() : reader_.number(); }
  std::uint64_t count() {
    if (!binary_) return reader_.count();
    return reader_.possible(reader_.bytes<std::uint64_t>());
  }
  std::uint32_t index(std::uint32_t end) {
    const std::int64_t value = integer();
    if (value < 0 || value >= end) reader_.fail(std::to_string(value) + " is out of range");
    return static_cast<std::uint32_t>(value);
  }

  void need_format() {
    if (text_.version == 0) reader_.fail("no $MeshFormat before it");
  }

  void read_names() {
    const std::uint64_t count = reader_.count();
    for (std::uint64_t i = 0; i < count; ++i) {
      const int dimension = static_cast<int>(reader_.index(0, 4));
      const std::int64_t tag = reader_.integer();
      std::string name;
      for (auto word = reader_.word_in_line(); !word.empty(); word = reader_.word_in_line()) {
        name += (name.empty() ? "" : " ") + std::string(word);
      }
      if (name.size() < 2 || !name.starts_with('"') || !name.ends_with('"')) {
        reader_.fail("a name without quotation marks");
      }
      if (!text_.names.emplace(std::pair(dimension, tag), name.substr(1, name.size() - 2)).second) {
        reader_.fail("a group has two names");
      }
    }
  }

  // Physical tags; an entity without one stands for itself.
  void read_entities() {
    need_format();
    if (seen_.contains("$Nodes") || seen_.contains("$Elements")) {
      reader_.fail("entities after the nodes or elements that need them");
    }
    if (binary_) reader_.begin_bytes();
    std::uint64_t counts[4];
    for (std::uint64_t& number : counts) number = count();
    for (int dimension = 0; dimension < 4; ++dimension) {
      for (std::uint64_t i = 0; i < counts[dimension]; ++i) {
        const std::int64_t tag = integer();
        std::array<double, 6> box{};
        for (std::size_t k = 0; k < (dimension == 0 ? 3 : 6); ++k) box[k] = number();
        if (dimension >= 2) {
          boxes_[{dimension, tag}].told = {{box[0], box[1], box[2]}, {box[3], box[4], box[5]}};
        }
        std::int64_t group = tag;
        const std::uint64_t tags = count();
        for (std::uint64_t k = 0; k < tags; ++k) {
          const std::int64_t value = integer();
          // Some readers would take the entity's own tag for it, others 0.
          if (value == 0) reader_.fail("a physical tag of 0");
          if (k == 0) group = value;
          if (value != group) further_.emplace(dimension, value);
        }
        if (tags != 1) ungrouped_.emplace(dimension, tag);
        if (!group_.emplace(std::pair(dimension, tag), group).second) {
          reader_.fail("entity " + std::to_string(tag) + " is there twice");
        }
        if (dimension == 0) continue;
        const std::uint64_t bounding = count();
        for (std::uint64_t k = 0; k < bounding; ++k) integer();
      }
    }
  }

  Announced announced() {
    if (binary_) reader_.begin_bytes();
    Announced a;
    a.blocks = count();
    a.total = count();
    a.least = large();
    a.largest = large();
    return a;
  }

  void tag_within(std::int64_t tag, const Announced& a) {
    if (tag < a.least || tag > a.largest) {
      reader_.fail("tag " + std::to_string(tag) + " is not among those announced");
    }
    least_ = std::min(least_, tag);
    largest_ = std::max(largest_, tag);
  }

  // They are the smallest and the largest tag; where there are none, they say nothing.
  void ends_announced(const Announced& a) {
    if (a.total > 0 && (least_ != a.least || largest_ != a.largest)) {
      reader_.fail("the smallest or the largest tag is another one than announced");
    }
    least_ = std::numeric_limits<std::int64_t>::max();
    largest_ = std::numeric_limits<std::int64_t>::min();
  }

  // Some programs list no entities, others (meshio) those of the nodes alone.
  void need_entity(int dimension, std::int64_t tag) const {
    if (!seen_.contains("$Entities") || group_.contains({dimension, tag})) return;
    static constexpr const char* kNames[] = {"point", "curve", "surface", "volume"};
    reader_.fail("nodes of " + std::string(kNames[dimension]) + " " + std::to_string(tag) +
                 ", which is not among the entities");
  }

  void read_nodes_4() {
    const Announced a = announced();
    for (std::uint64_t block = 0; block < a.blocks; ++block) {
      const std::uint32_t dimension = index(4);
      need_entity(static_cast<int>(dimension), integer());
      const bool parametric = index(2) != 0;
      const std::uint64_t nodes = count();
      for (std::uint64_t i = 0; i < nodes; ++i) {
        const std::int64_t tag = large();
        tag_within(tag, a);
        add_node_tag(tag);
      }
      for (std::uint64_t i = 0; i < nodes; ++i) {
        read_position();
        for (std::uint32_t k = 0; parametric && k < dimension; ++k) number();
      }
    }
    if (text_.nodes.size() != a.total) reader_.fail("another number of nodes was announced");
    ends_announced(a);
  }

  void read_nodes_2() {
    need_format();
    const std::uint64_t count = reader_.count();
    for (std::uint64_t i = 0; i < count; ++i) {
      add_node_tag(reader_.integer());
      read_position();
    }
  }

  void read_elements_4() {
    const Announced a = announced();
    GmshElement element;
    for (std::uint64_t block = 0; block < a.blocks; ++block) {
      const int dimension = static_cast<int>(index(4));
      element.entity = integer();
      element.type = type();
      if (dimension != kind(element.type).dimension) {
        reader_.fail("elements of another dimension than their entity");
      }
      const auto boxes = boxes_.find({dimension, element.entity});
      box_ = boxes == boxes_.end() ? nullptr : &boxes->second.found;
      const auto found = group_.find({dimension, element.entity});
      // Some programs list no entities, or not all of them.
      element.group = found == group_.end() ? element.entity : found->second;
      element.in_group = found != group_.end() && !ungrouped_.contains({dimension, element.entity});
      text_.groups_differ = text_.groups_differ || found == group_.end() ||
                            ungrouped_.contains({dimension, element.entity});
      for (std::uint64_t left = count(); left > 0; --left) {
        tags_.push_back(large());
        tag_within(tags_.back(), a);
        take(element);
      }
    }
    if (tags_.size() != a.total) reader_.fail("another number of elements was announced");
    ends_announced(a);
    distinct_tags();
  }

  void read_elements_2() {
    need_format();
    const std::uint64_t count = reader_.count();
    for (std::uint64_t i = 0; i < count; ++i) {
      GmshElement element;
      tags_.push_back(reader_.integer());
      element.type = type();
      const std::uint64_t numbers = reader_.count();
      for (std::uint64_t k = 0; k < numbers; ++k) {
        const std::int64_t value = reader_.integer();
        if (k == 0) element.group = value;
        if (k == 1) element.entity = value;
      }
      if (element.group == 0) {  // not a group
        element.group = element.entity;
        element.in_group = false;
        text_.groups_differ = true;
      }
      take(element);
    }
    distinct_tags();
  }

  void distinct_tags() {
    std::sort(tags_.begin(), tags_.end());
    const auto twice = std::adjacent_find(tags_.begin(), tags_.end());
    if (twice != tags_.end()) {
      reader_.fail("element " + std::to_string(*twice) + " is there twice");
    }
    tags_ = {};
  }

  struct Kind {
    int type, dimension, nodes;
  };
  static constexpr Kind kKinds[] = {{1, 1, 2}, {2, 2, 3},   {4, 3, 4}, {8, 1, 3},
                                    {9, 2, 6}, {11, 3, 10}, {15, 0, 1}};
  static const Kind& kind(std::int64_t type) {
    return *std::find_if(std::begin(kKinds), std::end(kKinds),
                         [&](const Kind& k) { return k.type == type; });
  }

  int type() {
    const std::int64_t type = integer();
    if (&kind(type) == std::end(kKinds)) {
      reader_.fail("an element of type " + std::to_string(type) + ", which is not read");
    }
    return static_cast<int>(type);
  }

  void take(GmshElement& element) {
    const int dimension = kind(element.type).dimension;
    if (element.in_group) {
      const auto [known, is_new] = dimension_of_.try_emplace(element.group, dimension);
      text_.tags_shared = text_.tags_shared || known->second != dimension;
    }
    for (int i = 0; i < kind(element.type).nodes; ++i) {
      const std::int64_t tag = large();
      const auto found = number_.find(tag);
      if (found == number_.end()) reader_.fail("there is no node " + std::to_string(tag));
      element.nodes[static_cast<std::size_t>(i)] = found->second;
      // The corners come first; there is one more than dimensions.
      if (box_ != nullptr && i <= kind(element.type).dimension) {
        box_->add(text_.nodes[found->second]);
      }
    }
    take_(element);
  }

  void add_node_tag(std::int64_t tag) {
    if (!number_.emplace(tag, static_cast<Index>(number_.size())).second) {
      reader_.fail("node " + std::to_string(tag) + " is there twice");
    }
  }

  void read_position() {
    const double x = number(), y = number(), z = number();
    text_.nodes.push_back({x, y, z});
  }

  TextReader reader_;
  const std::function<void(const GmshElement&)>& take_;
  GmshText text_;
  bool binary_ = false;
  std::map<std::pair<int, std::int64_t>, Boxes> boxes_;  // of surfaces and volumes
  Box* box_ = nullptr;                                   // of the elements being read
  // The smallest and the largest tag read, of nodes or of elements.
  std::int64_t least_ = std::numeric_limits<std::int64_t>::max();
  std::int64_t largest_ = std::numeric_limits<std::int64_t>::min();
  std::map<std::int64_t, int> dimension_of_;          // of a group
  std::set<std::pair<int, std::int64_t>> ungrouped_;  // entities of no group, or of several
  std::set<std::string> seen_;
  std::map<std::pair<int, std::int64_t>, std::int64_t> group_;  // of an entity
  std::set<std::pair<int, std::int64_t>> further_;  // groups of entities that have another one
  std::map<std::int64_t, Index> number_;            // of a node
  std::vector<std::int64_t> tags_;                  // of elements
};

}  // namespace

GmshText read_gmsh_text(const std::string& path,
                        const std::function<void(const GmshElement&)>& take) {
  return GmshReader(path, take).read();
}

}  // namespace tetproof::oracles
