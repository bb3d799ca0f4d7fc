// Included in every mutated file of the tree of ci/planted/mutants: the switch between the mutants
// that one build contains.
//
// MUTANT=N in the environment turns one on. MUTANTS_REACHED=FILE names a file that is mapped, so
// that the programs that a test starts note in it, too, which mutants they come to.
#pragma once

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>

namespace mutants {

inline constexpr int kMost = 1 << 16;
inline bool no_file[kMost];
inline bool* reached = no_file;  // bool, because stores of characters might alias everything
inline int active = -1;

inline bool start() {
  if (const char* number = std::getenv("MUTANT")) active = std::atoi(number);
  if (const char* name = std::getenv("MUTANTS_REACHED")) {
    const int file = open(name, O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    if (file < 0 || ftruncate(file, kMost) != 0) std::abort();
    void* map = mmap(nullptr, kMost, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    if (map == MAP_FAILED) std::abort();
    close(file);
    reached = static_cast<bool*>(map);
  }
  return true;
}
inline const bool started = start();

// What has to be known when compiling cannot be switched: it does not compile, and the mutant is
// left out. (A template, because a constexpr function that is none must not name variables.)
template <int Id>
constexpr bool on() {
  if (__builtin_is_constant_evaluated()) throw Id;
  if (!reached[Id]) reached[Id] = true;
  return Id == active;
}

}  // namespace mutants
