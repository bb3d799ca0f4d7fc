// What takes most of the memory of a verification, and is given up when the last step that needs it
// is done.
#pragma once

#include <array>
#include <atomic>
#include <functional>

#include "mesher/delmesher.h"
#include "oracles/files/mesh_file.h"

namespace tetproof::oracles {

// Sets of these are sums.
enum Bulk : unsigned {
  kFile = 1U << 0,                  // all of the file
  kFileTetrahedra = 1U << 1,        // of the file
  kRefinedTetrahedra = 1U << 2,     // of the record
  kRefinedElements = 1U << 3,       // what else the record has of the refined mesh
  kFinalTetrahedra = 1U << 4,       // of the record
  kUnrepairedTetrahedra = 1U << 5,  // of the record, before local operations
  kFinalMeshes = 1U << 6,           // the last two with their faces
  kRefinedComplex = 1U << 7         // made of the refined tetrahedra
};

// A file and a record that may be emptied, because the caller does not need them any more; or none.
struct Expendable {
  MeshFile* mesh = nullptr;
  delmesher::ExactRecord* record = nullptr;
};

// Laws:
//  - what is given up, nobody asks for again: each need is announced before the first step begins,
//    and told to be over once.
class Memory {
 public:
  // `forget_refined` gives up the complex of the refined mesh.
  Memory(const Expendable& expendable, std::function<void()> forget_refined)
      : expendable_(expendable), forget_refined_(std::move(forget_refined)) {}

  void need(unsigned bulks);
  void done_with(unsigned bulks);

 private:
  void give_up(Bulk bulk);

  const Expendable expendable_;
  const std::function<void()> forget_refined_;
  std::array<std::atomic<unsigned>, 8> needs_{};  // by the bits of Bulk
};

}  // namespace tetproof::oracles
