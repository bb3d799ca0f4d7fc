// Copies of a model that bound the same solid to the last bit, except for an exact motion or scale:
// NAME@t1.off is a copy of NAME.off. A mesher may make another mesh of one, but not another
// disposition.
#pragma once

#include <array>
#include <cstdint>

namespace tetproof {

enum class Relation : std::uint8_t {
  turned,      // by a matrix of zeros and ones
  scaled,      // by a power of two
  renumbered,  // vertices and triangles in another order, triangles with another first corner
  split        // the midpoint of one edge, which doubles have exactly, became a vertex
};

struct RelationName {
  Relation relation;
  char letter;       // after the @ in the names of copies; a number follows
  const char* text;  // in tables
};
inline constexpr std::array<RelationName, 4> kRelations = {
    {{Relation::turned, 't', "turned by an exact matrix"},
     {Relation::scaled, 's', "scaled by a power of two"},
     {Relation::renumbered, 'n', "numbered otherwise"},
     {Relation::split, 'e', "one edge split at its midpoint"}}};

}  // namespace tetproof
