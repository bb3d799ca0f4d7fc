// Is every point of a triangle or segment within a distance of given triangles or segments?
//
// What is within a distance of one simplex is convex. So a convex polygon whose corners are within
// it lies there. A polygon that is near no single simplex is cut along the sides of the nearest
// one, which leaves few pieces however small the distance is; "yes" has a simplex for each piece.
// In doubles: pieces are off by a few roundings of the coordinates, so what is asked for has to be
// less by more than that than what is promised.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "mesher/geometry/box_tree.h"
#include "mesher/geometry/vector.h"

namespace delmesher::remesh {

// A triangle, or a segment, whose third corner is its second.
struct Simplex {
  explicit Simplex(const std::array<Vec3, 3>& triangle, std::int32_t triangle_label = 0);
  Simplex(const Vec3& a, const Vec3& b);

  std::array<Vec3, 3> corner;
  bool is_segment = false;
  std::int32_t label = 0;
  Box box;
  Vec3 normal{};  // of a triangle, twice as long as its area
  // How much of the second and third corner there is in p, less the first: products of these with
  // p, less the first corner. 0 for segments.
  Vec3 of_second{}, of_third{};
};

// The point of the simplex that is nearest to p, to a few roundings of the coordinates.
Vec3 nearest_point(const Vec3& p, const Simplex& simplex);
inline double squared_distance(const Vec3& p, const Simplex& simplex) {
  return squared_norm(subtract(p, nearest_point(p, simplex)));
}

class Coverage {
 public:
  explicit Coverage(double distance);

  // Forgets the candidates. Those of next time are added beforehand; or, where they are many, by
  // `more` alone, which is then asked for each piece.
  void clear(bool many = false);
  // The simplex has to stay where it is. Nothing happens if the number has been added before.
  void add(std::uint32_t id, const Simplex& simplex);

  // Is the simplex within the distance of the candidates? `more(place)` adds those near the place
  // that were not added; it is called where the candidates do not suffice. Each candidate is good
  // for a few pieces: there are no more of them than `most`. used() are those that were needed,
  // each once, unless they were many.
  bool covers(const Simplex& simplex, std::size_t most,
              const std::function<void(const Vec3&)>& more);
  const std::vector<std::uint32_t>& used() const { return used_; }

 private:
  struct Polygon;
  struct Candidate {
    std::uint32_t id;
    const Simplex* simplex;
    bool used = false;
  };

  bool covers(const Polygon& polygon, int depth, const std::function<void(const Vec3&)>& more);
  bool covers_cut(const Polygon& polygon, const Simplex& simplex, int depth,
                  const std::function<void(const Vec3&)>& more);
  bool is_within(const Polygon& polygon, const Simplex& simplex) const;
  std::size_t nearest_to(const Vec3& p) const;

  double distance_, squared_;
  std::vector<Candidate> candidates_;
  std::vector<std::uint32_t> used_;
  bool many_ = false;
  std::size_t pieces_ = 0, most_ = 0;
  // By number: the round in which it was added.
  std::vector<std::uint32_t> added_;
  std::uint32_t round_ = 1;
};

}  // namespace delmesher::remesh
