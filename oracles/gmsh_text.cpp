#include "oracles/gmsh_text.h"

#include <algorithm>
#include <iterator>
#include <set>

#include "oracles/text_reader.h"

namespace tetproof::oracles {
namespace {

// What is announced at the beginning of the nodes, and of the elements: of 4.1.
struct Announced {
  std::uint64_t blocks = 0, total = 0;
  std::int64_t least = 0, largest = 0;  // tags
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
        while (reader_.required_word(end.c_str()) != end) continue;
        continue;
      }
      if (!seen_.insert(section).second) reader_.fail(section + " is there twice");
      reader_.expect(end);
    }
    for (const char* section : {"$MeshFormat", "$Nodes", "$Elements"}) {
      if (!seen_.contains(section)) reader_.fail(std::string("there is no ") + section);
    }
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

  void read_format() {
    text_.version = reader_.number();
    if (text_.version != 4.1 && !(text_.version >= 2 && text_.version < 3)) {
      reader_.fail("neither version 4.1 nor 2.2");
    }
    if (reader_.integer() != 0) reader_.fail("binary .msh files are not read");
    reader_.integer();
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
    if (seen_.contains("$Elements")) reader_.fail("entities after the elements that need them");
    std::uint64_t counts[4];
    for (std::uint64_t& count : counts) count = reader_.count();
    for (int dimension = 0; dimension < 4; ++dimension) {
      for (std::uint64_t i = 0; i < counts[dimension]; ++i) {
        const std::int64_t tag = reader_.integer();
        for (int k = 0; k < (dimension == 0 ? 3 : 6); ++k) reader_.number();
        std::int64_t group = tag;
        const std::uint64_t tags = reader_.count();
        for (std::uint64_t k = 0; k < tags; ++k) {
          const std::int64_t value = reader_.integer();
          if (k == 0) group = value;
        }
        if (!group_.emplace(std::pair(dimension, tag), group).second) {
          reader_.fail("entity " + std::to_string(tag) + " is there twice");
        }
        if (dimension == 0) continue;
        const std::uint64_t bounding = reader_.count();
        for (std::uint64_t k = 0; k < bounding; ++k) reader_.integer();
      }
    }
  }

  Announced announced() {
    Announced a;
    a.blocks = reader_.count();
    a.total = reader_.count();
    a.least = reader_.integer();
    a.largest = reader_.integer();
    return a;
  }

  void tag_within(std::int64_t tag, const Announced& a) {
    if (tag < a.least || tag > a.largest) {
      reader_.fail("tag " + std::to_string(tag) + " is not among those announced");
    }
  }

  void read_nodes_4() {
    const Announced a = announced();
    for (std::uint64_t block = 0; block < a.blocks; ++block) {
      const std::uint32_t dimension = reader_.index(0, 4);
      reader_.integer();
      const bool parametric = reader_.index(0, 2) != 0;
      const std::uint64_t count = reader_.count();
      for (std::uint64_t i = 0; i < count; ++i) {
        const std::int64_t tag = reader_.integer();
        tag_within(tag, a);
        add_node_tag(tag);
      }
      for (std::uint64_t i = 0; i < count; ++i) {
        read_position();
        for (std::uint32_t k = 0; parametric && k < dimension; ++k) reader_.number();
      }
    }
    if (text_.nodes.size() != a.total) reader_.fail("another number of nodes was announced");
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
      const int dimension = static_cast<int>(reader_.index(0, 4));
      element.entity = reader_.integer();
      element.type = type();
      if (dimension != kind(element.type).dimension) {
        reader_.fail("elements of another dimension than their entity");
      }
      const auto found = group_.find({dimension, element.entity});
      // Some programs list no entities, or not all of them.
      element.group = found == group_.end() ? element.entity : found->second;
      for (std::uint64_t left = reader_.count(); left > 0; --left) {
        tags_.push_back(reader_.integer());
        tag_within(tags_.back(), a);
        take(element);
      }
    }
    if (tags_.size() != a.total) reader_.fail("another number of elements was announced");
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
    const std::int64_t type = reader_.integer();
    if (&kind(type) == std::end(kKinds)) {
      reader_.fail("an element of type " + std::to_string(type) + ", which is not read");
    }
    return static_cast<int>(type);
  }

  void take(GmshElement& element) {
    for (int i = 0; i < kind(element.type).nodes; ++i) {
      const std::int64_t tag = reader_.integer();
      const auto found = number_.find(tag);
      if (found == number_.end()) reader_.fail("there is no node " + std::to_string(tag));
      element.nodes[static_cast<std::size_t>(i)] = found->second;
    }
    take_(element);
  }

  void add_node_tag(std::int64_t tag) {
    if (!number_.emplace(tag, static_cast<Index>(number_.size())).second) {
      reader_.fail("node " + std::to_string(tag) + " is there twice");
    }
  }

  void read_position() {
    const double x = reader_.number(), y = reader_.number(), z = reader_.number();
    text_.nodes.push_back({x, y, z});
  }

  TextReader reader_;
  const std::function<void(const GmshElement&)>& take_;
  GmshText text_;
  std::set<std::string> seen_;
  std::map<std::pair<int, std::int64_t>, std::int64_t> group_;  // of an entity
  std::map<std::int64_t, Index> number_;                        // of a node
  std::vector<std::int64_t> tags_;                              // of elements
};

}  // namespace

GmshText read_gmsh_text(const std::string& path,
                        const std::function<void(const GmshElement&)>& take) {
  return GmshReader(path, take).read();
}

}  // namespace tetproof::oracles
