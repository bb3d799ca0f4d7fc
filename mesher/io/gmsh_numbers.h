// What the writers of Gmsh's format share: numbers and sections as MSH 4.1 and 2.2 have them (Gmsh
// reference manual, "MSH file format").
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "mesher/io/binary.h"
#include "mesher/io/output.h"

namespace delmesher::io {

// The tags of physical groups, by what they are to tell. Programs such as GetDP and GetFEM number
// the groups of all dimensions together, so no tag is there twice; and tags are positive. A number
// is its own tag if both allow it, and the others get the tags after the largest.
inline std::vector<std::int64_t> group_tags(const std::vector<std::int64_t>& numbers) {
  std::int64_t next = 1;
  for (const std::int64_t n : numbers) next = std::max(next, n + 1);
  std::set<std::int64_t> taken;
  std::vector<std::int64_t> tags;
  for (const std::int64_t n : numbers) {
    tags.push_back(n > 0 && taken.insert(n).second ? n : next++);
  }
  return tags;
}

// Numbers as text with blanks and lines, or as bytes without; 2.2 is written as text alone.
class GmshNumbers {
 public:
  GmshNumbers(TextSink& out, bool ascii, MshVersion version)
      : out_(out), two_(version == MshVersion::v2_2), ascii_(ascii || two_) {}

  // The beginning of the file.
  void format() {
    if (two_) {
      out_.text("$MeshFormat\n2.2 0 8\n");
    } else {
      out_.text(ascii_ ? "$MeshFormat\n4.1 0 8\n" : "$MeshFormat\n4.1 1 8\n");
    }
    if (!ascii_) {
      tag(1);  // shows the byte order
      out_.text("\n");
    }
    out_.text("$EndMeshFormat\n");
  }
  // A section of numbers, which `write` writes.
  template <class Write>
  void in_section(const std::string& name, const Write& write) {
    out_.text("$" + name + "\n");
    write();
    out_.text((ascii_ ? "$End" : "\n$End") + name + "\n");
  }

  // The number of an entity, group, dimension or type: an int of C.
  void tag(std::int64_t value) {
    ascii_ ? text([&] { out_.integer(value); }) : bytes(static_cast<std::int32_t>(value));
  }
  // Counts, nodes and elements: a size_t.
  void size(std::uint64_t value) {
    ascii_ ? text([&] { out_.integer(value); }) : bytes(value);
  }
  void point(const std::array<double, 3>& p) {
    for (const double x : p) ascii_ ? text([&] { out_.number(x); }) : bytes(x);
  }
  void end_line() {
    if (ascii_) out_.text("\n");
    line_is_empty_ = true;
  }

  // All nodes, numbered from 1, without parameters: in one entity.
  template <class Position>
  void nodes(int dimension, std::int64_t entity, std::size_t count, const Position& position) {
    in_section("Nodes", [&] {
      announce(count == 0 ? 0 : 1, count);
      if (!two_) number_nodes(dimension, entity, count);
      for (std::size_t i = 0; i < count; ++i) {
        if (two_) size(i + 1);
        point(position(i));
        end_line();
      }
    });
  }

  // How many blocks of elements follow, of how many elements, which are numbered from 1.
  void announce(std::size_t blocks, std::size_t total) {
    if (!two_) size(blocks);
    size(total);
    if (!two_) {
      size(total == 0 ? 0 : 1);
      size(total);
    }
    end_line();
  }
  // Elements of an entity, and of its group; the type is Gmsh's number.
  void begin_block(int dimension, std::int64_t entity, std::int64_t group, int type,
                   std::size_t count) {
    type_ = type;
    entity_ = entity;
    group_ = group;
    if (two_) return;
    tag(dimension);
    tag(entity);
    tag(type);
    size(count);
    end_line();
  }
  // The next element of the block: places of its nodes, from 0, in Gmsh's order.
  template <class Nodes>
  void element(const Nodes& nodes) {
    size(++elements_);
    if (two_) {
      for (const std::int64_t value : {std::int64_t{type_}, std::int64_t{2}, group_, entity_}) {
        tag(value);
      }
    }
    for (const std::uint32_t v : nodes) size(v + 1ULL);
    end_line();
  }

 private:
  void number_nodes(int dimension, std::int64_t entity, std::size_t count) {
    if (count != 0) {
      tag(dimension);
      tag(entity);
      tag(0);
      size(count);
      end_line();
    }
    for (std::size_t i = 1; i <= count; ++i) {
      size(i);
      end_line();
    }
  }
  template <class Write>
  void text(const Write& write) {
    if (!line_is_empty_) out_.text(" ");
    line_is_empty_ = false;
    write();
  }
  template <class T>
  void bytes(T value) {
    const auto all = bytes_of(value);
    out_.text({all.data(), all.size()});
  }

  TextSink& out_;
  bool two_, ascii_, line_is_empty_ = true;
  int type_ = 0;  // of the block
  std::int64_t entity_ = 0, group_ = 0;
  std::size_t elements_ = 0;
};

}  // namespace delmesher::io
