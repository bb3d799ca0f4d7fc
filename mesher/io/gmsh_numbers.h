// What the writers of Gmsh's format share: numbers and sections as MSH 4.1 has them (Gmsh reference
// manual, "MSH file format").
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "mesher/io/binary.h"
#include "mesher/io/output.h"

namespace delmesher::io {

// Numbers as text with blanks and lines, or as bytes without.
class GmshNumbers {
 public:
  GmshNumbers(TextSink& out, bool ascii) : out_(out), ascii_(ascii) {}

  // The beginning of the file.
  void format() {
    out_.text(ascii_ ? "$MeshFormat\n4.1 0 8\n" : "$MeshFormat\n4.1 1 8\n");
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

  // How many blocks follow, of how many things, which are numbered from 1.
  void announce(std::size_t blocks, std::size_t total) {
    size(blocks);
    size(total);
    size(total == 0 ? 0 : 1);
    size(total);
    end_line();
  }
  // The beginning of a section of nodes: all of them in one entity, without parameters, and their
  // numbers. Their points follow.
  void number_nodes(int dimension, std::int64_t entity, std::size_t count) {
    announce(count == 0 ? 0 : 1, count);
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
  // Elements of an entity; the type is Gmsh's number.
  void begin_block(int dimension, std::int64_t entity, int type, std::size_t count) {
    tag(dimension);
    tag(entity);
    tag(type);
    size(count);
    end_line();
  }

 private:
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
  bool ascii_, line_is_empty_ = true;
};

}  // namespace delmesher::io
