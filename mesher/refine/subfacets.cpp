#include "mesher/refine/subfacets.h"

#include "mesher/base/check.h"

namespace delmesher::refine {

void Subfacets::build(Control& control) {
  planar_.build(control);
  marks_.make_room();
}

// For a present face only the two opposite vertices matter.
void Subfacets::settle(std::uint32_t s, FaceHandle face) {
  if (!face.exists()) {
    queue(s);
    return;
  }
  for (const FaceHandle side : {face, dt_.across(face)}) {
    marks_.set(side, s);
    const VertexId v = dt_.opposite(side);
    if (!gabriel_ || v == kInfinite) continue;
    if (encroached_by(s, v)) queue(s);
  }
}

void Subfacets::settle_created() {
  for (const std::uint32_t s : planar_.created()) {
    // Every new subfacet has the new vertex first, which all created tetrahedra have too.
    const auto& [v, x, y] = planar_[s].v;
    FaceHandle face;
    for (const TetId t : dt_.created()) {
      const int i = dt_.index_of(t, x);
      if (i < 0) continue;
      const int j = dt_.index_of(t, y);
      if (j < 0) continue;
      face = {t, 6 - i - j - dt_.index_of(t, v)};
      break;
    }
    settle(s, face);
  }
}

std::uint32_t Subfacets::take_queued() {
  std::uint32_t s = queue_.take();
  while (s != kNone && !planar_[s].alive) s = queue_.take();
  return s;
}

void Subfacets::renumber() {
  const std::vector<std::uint32_t> number = planar_.renumber();
  marks_.renumber(number);
  queue_.renumber(number);
}

void Subfacets::validate(Control& control) {
  planar_.validate(control);
  queue_.validate(size());
  for (std::uint32_t s = 0; s < size(); ++s) {
    control.poll();
    if (planar_[s].alive && !queue_.waits(s)) validate_in_mesh(s);
  }
  marks_.validate(size());
}

void Subfacets::validate_in_mesh(std::uint32_t s) {
  const auto& c = planar_[s].v;
  const FaceHandle face = dt_.find_face(c[0], c[1], c[2]);
  DELMESHER_CHECK(face.exists(), "a subfacet is not a face");
  for (const FaceHandle side : {face, dt_.across(face)}) {
    DELMESHER_CHECK(on_face(side.tet(), side.face()) == s,
                    "a tetrahedron does not know of its subfacet");
    const VertexId v = dt_.opposite(side);
    if (!gabriel_ || v == kInfinite) continue;
    DELMESHER_CHECK(!encroached_by(s, v), "a subfacet is encroached");
  }
}

}  // namespace delmesher::refine
