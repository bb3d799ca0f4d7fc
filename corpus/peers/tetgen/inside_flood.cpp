#include "corpus/peers/tetgen/inside_flood.h"

#include <algorithm>

namespace tetproof {
namespace {

using Face = std::array<std::uint32_t, 3>;

struct Side {
  Face face;  // sorted
  std::uint32_t tet;
  bool operator<(const Side& other) const { return face < other.face; }
};

Face sorted(Face face) {
  std::sort(face.begin(), face.end());
  return face;
}

std::vector<Side> all_sides(const std::vector<std::array<std::uint32_t, 4>>& tetrahedra) {
  std::vector<Side> sides;
  sides.reserve(4 * tetrahedra.size());
  for (std::uint32_t t = 0; t < tetrahedra.size(); ++t) {
    const auto& v = tetrahedra[t];
    for (const Face& f : {Face{v[1], v[2], v[3]}, Face{v[0], v[2], v[3]}, Face{v[0], v[1], v[3]},
                          Face{v[0], v[1], v[2]}}) {
      sides.push_back({sorted(f), t});
    }
  }
  std::sort(sides.begin(), sides.end());
  return sides;
}

struct Step {
  std::uint32_t to;
  bool wall;
};

constexpr std::uint8_t kUnknown = 2;

class Flood {
 public:
  Flood(const std::vector<std::array<std::uint32_t, 4>>& tetrahedra, const std::vector<Face>& walls)
      : inside_(tetrahedra.size(), kUnknown), steps_(tetrahedra.size()) {
    for (const Face& wall : walls) walls_.push_back(sorted(wall));
    std::sort(walls_.begin(), walls_.end());
    const std::vector<Side> sides = all_sides(tetrahedra);
    for (std::size_t i = 0; i < sides.size();) {
      const bool wall = std::binary_search(walls_.begin(), walls_.end(), sides[i].face);
      if (i + 1 < sides.size() && sides[i + 1].face == sides[i].face) {
        steps_[sides[i].tet].push_back({sides[i + 1].tet, wall});
        steps_[sides[i + 1].tet].push_back({sides[i].tet, wall});
        i += 2;
      } else {
        assign(sides[i].tet, wall);
        ++i;
      }
    }
  }

  std::vector<std::uint8_t> run() {
    while (consistent_ && !stack_.empty()) {
      const std::uint32_t tet = stack_.back();
      stack_.pop_back();
      for (const Step& step : steps_[tet]) assign(step.to, (inside_[tet] != 0) != step.wall);
    }
    return consistent_ ? std::move(inside_) : std::vector<std::uint8_t>();
  }

 private:
  void assign(std::uint32_t tet, bool inside) {
    if (inside_[tet] == kUnknown) {
      inside_[tet] = inside;
      stack_.push_back(tet);
    } else if ((inside_[tet] != 0) != inside) {
      consistent_ = false;
    }
  }

  std::vector<Face> walls_;
  std::vector<std::uint8_t> inside_;
  std::vector<std::vector<Step>> steps_;
  std::vector<std::uint32_t> stack_;
  bool consistent_ = true;
};

}  // namespace

std::vector<std::uint8_t> flood_inside(const std::vector<std::array<std::uint32_t, 4>>& tetrahedra,
                                       const std::vector<std::array<std::uint32_t, 3>>& walls) {
  return Flood(tetrahedra, walls).run();
}

}  // namespace tetproof
