#include "mesher/refine/subfacet_marks.h"

#include "mesher/base/check.h"

namespace delmesher::refine {

void SubfacetMarks::renumber(std::span<const std::uint32_t> number) {
  for (TetId t = 0; t < dt_.capacity(); ++t) {
    std::uint8_t& faces = note(dt_, t, Note::faces);
    if (faces == 0 || !dt_.alive(t)) continue;
    for (int i = 0; i < 4; ++i) {
      if ((faces >> i & 1) == 0) continue;
      std::uint32_t& mark = number_[t][i];
      mark = number[mark];
      if (mark == kNone) faces &= static_cast<std::uint8_t>(~(1U << i));
    }
  }
}

void SubfacetMarks::validate(std::size_t subfacets) const {
  for (TetId t = 0; t < dt_.capacity(); ++t) {
    if (!dt_.alive(t) || !any_on(t)) continue;
    for (const int i : {0, 1, 2, 3}) {
      const std::uint32_t mark = of(t, i);
      if (mark == kNone) continue;
      DELMESHER_CHECK(mark < subfacets, "a face is marked as a subfacet that does not exist");
      DELMESHER_CHECK(of(dt_.neighbor(t, i), dt_.mirror(t, i)) == mark,
                      "the two sides of a face have different marks");
    }
  }
}

}  // namespace delmesher::refine
