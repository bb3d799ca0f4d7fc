#include "mesher/cdt/gift_wrapping.h"

#include <algorithm>

#include "mesher/base/face_key.h"
#include "mesher/base/flat_map.h"
#include "mesher/cdt/separation.h"
#include "mesher/surface/tetrahedron_contact.h"

namespace delmesher::cdt {
namespace {

class GiftWrapper {
 public:
  GiftWrapper(Predicates& predicates, Control& control, const std::vector<Triangle>& walls,
              const std::vector<VertexId>& vertices, std::vector<Tetrahedron>& tetrahedra,
              FillCounters& counters)
      : predicates_(predicates),
        control_(control),
        walls_(walls),
        vertices_(vertices),
        tetrahedra_(tetrahedra),
        counters_(counters) {
    std::sort(vertices_.begin(), vertices_.end());
  }

  bool run() {
    // The number of tetrahedra of n vertices is at most quadratic; far fewer in practice.
    const std::size_t limit = tetrahedra_.size() + 64 + vertices_.size() * vertices_.size();
    for (auto wall = walls_.rbegin(); wall != walls_.rend(); ++wall) open(*wall);
    while (!front_.empty()) {
      const Triangle face = front_.back();
      front_.pop_back();
      if (!is_open(face)) continue;
      control_.poll();
      const VertexId v = find_fourth_vertex(face);
      if (v == kNone || tetrahedra_.size() > limit) return false;
      add(face, v);
    }
    return open_count_ == 0;
  }

 private:
  std::uint64_t key(const Triangle& t) const { return directed_face_key(t, vertices_); }
  bool is_open(const Triangle& t) const { return is_open_.get(key(t), 0) == 1; }
  void open(const Triangle& t) {
    is_open_.set(key(t), 1);
    ++open_count_;
    front_.push_back(t);
  }
  void close(const Triangle& t) {
    is_open_.set(key(t), 0);
    --open_count_;
  }

  // The tetrahedron on `face` inside the polyhedron. Its other faces either close an open face or
  // are opened for the tetrahedron beyond.
  void add(const Triangle& face, VertexId v) {
    // face is counter-clockwise seen from outside, v inside: so (face[0], face[2], face[1], v) is
    // positive.
    const Tetrahedron t = {face[0], face[2], face[1], v};
    tetrahedra_.push_back(t);
    ++counters_.wrapped;
    close(face);
    for (int i = 0; i < 3; ++i) {
      const Triangle side = {t[kFace[i][0]], t[kFace[i][1]], t[kFace[i][2]]};
      if (is_open(side)) {
        close(side);
      } else {
        open({side[0], side[2], side[1]});
      }
    }
  }

  // The first vertex that the pencil of spheres through the face touches among those visible from
  // the face: the fourth vertex of its constrained Delaunay tetrahedron. A vertex touched earlier
  // is invisible from all points of the face, so that a wall enters the tetrahedron it would make.
  VertexId find_fourth_vertex(const Triangle& face) {
    candidates_.clear();
    for (const VertexId v : vertices_) {
      if (v == face[0] || v == face[1] || v == face[2]) continue;
      if (predicates_.orient3d(face[0], face[1], face[2], v) < 0) candidates_.push_back(v);
    }
    const auto touched_before = [&](VertexId v, VertexId w) {
      return predicates_.insphere_perturbed(face[0], face[2], face[1], w, v) > 0;
    };
    std::size_t tried = 0;
    while (tried < candidates_.size()) {
      if (tried < kScans) {
        const auto begin = candidates_.begin() + static_cast<std::ptrdiff_t>(tried);
        std::iter_swap(begin, std::min_element(begin, candidates_.end(), touched_before));
      } else if (tried == kScans) {
        const auto begin = candidates_.begin() + static_cast<std::ptrdiff_t>(tried);
        std::sort(begin, candidates_.end(), touched_before);
      }
      const VertexId v = candidates_[tried++];
      if (is_free({face[0], face[2], face[1], v})) return v;
      ++counters_.hidden;
    }
    return kNone;
  }

  bool is_free(const Tetrahedron& t) {
    for (const Triangle& wall : walls_) {
      if (boxes_disjoint(predicates_.points(), t, wall)) continue;
      if (meets_interior(predicates_, t, wall)) return false;
    }
    return true;
  }

  static constexpr std::size_t kScans = 3;  // minima searched before the rest is sorted

  Predicates& predicates_;
  Control& control_;
  const std::vector<Triangle>& walls_;
  std::vector<VertexId> vertices_;
  std::vector<Tetrahedron>& tetrahedra_;
  FillCounters& counters_;
  FlatMap is_open_;
  std::size_t open_count_ = 0;
  std::vector<Triangle> front_;
  std::vector<VertexId> candidates_;
};

}  // namespace

bool gift_wrap(Predicates& predicates, Control& control, const std::vector<Triangle>& faces,
               const std::vector<VertexId>& vertices, std::vector<Tetrahedron>& tetrahedra,
               FillCounters& counters) {
  return GiftWrapper(predicates, control, faces, vertices, tetrahedra, counters).run();
}

}  // namespace delmesher::cdt
