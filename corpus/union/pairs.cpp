#include "corpus/union/pairs.h"

#include <CGAL/Box_intersection_d/Box_with_handle_d.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <tuple>
#include <utility>

namespace tetproof::unite {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Box = CGAL::Box_intersection_d::Box_with_handle_d<double, 3, const Triangle*>;

class Contacts {
 public:
  explicit Contacts(const Soup& soup) : soup_(soup) {}

  bool meet(const Triangle& s, const Triangle& t) const;
  bool coplanar(const Triangle& s, const Triangle& t) const {
    return std::all_of(t.begin(), t.end(), [&](Index v) {
      return CGAL::coplanar(point(s[0]), point(s[1]), point(s[2]), point(v));
    });
  }
  CGAL::Bbox_3 box(const Triangle& t) const {
    return point(t[0]).bbox() + point(t[1]).bbox() + point(t[2]).bbox();
  }

 private:
  Kernel::Point_3 point(Index v) const {
    const Position& p = soup_.vertices[v];
    return {p[0], p[1], p[2]};
  }
  Kernel::Triangle_3 triangle(const Triangle& t) const {
    return {point(t[0]), point(t[1]), point(t[2])};
  }
  bool side_meets(Index p, Index q, const Triangle& t) const {
    return CGAL::do_intersect(Kernel::Segment_3(point(p), point(q)), triangle(t));
  }

  const Soup& soup_;
};

// Moves the corners that both have to the front of either, in the same order; how many there are.
std::size_t sort_common(Triangle& s, Triangle& t) {
  std::size_t common = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto found = std::find(t.begin(), t.end(), s[k]);
    if (found == t.end()) continue;
    std::swap(*found, t[common]);
    std::swap(s[k], s[common++]);
  }
  return common;
}

bool Contacts::meet(const Triangle& s, const Triangle& t) const {
  Triangle a = s, b = t;
  switch (sort_common(a, b)) {
    case 0:
      return CGAL::do_intersect(triangle(a), triangle(b));
    case 1:  // then a side that does not end at the common corner reaches the other triangle
      return side_meets(a[1], a[2], b) || side_meets(b[1], b[2], a);
    case 2: {  // only if they lie on each other
      const auto p = point(a[0]), q = point(a[1]), u = point(a[2]), v = point(b[2]);
      return CGAL::coplanar(p, q, u, v) && CGAL::coplanar_orientation(p, q, u, v) == CGAL::POSITIVE;
    }
    default:
      return true;
  }
}

}  // namespace

std::vector<MeetingPair> meeting_pairs(const Soup& soup, Poll& poll) {
  const Contacts contacts(soup);
  std::vector<Box> boxes;
  boxes.reserve(soup.triangles.size());
  for (const Triangle& t : soup.triangles) boxes.emplace_back(contacts.box(t), &t);
  const auto number = [&](const Box& box) {
    return static_cast<Index>(box.handle() - soup.triangles.data());
  };
  std::vector<MeetingPair> pairs;
  CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const Box& x, const Box& y) {
    poll();
    const Index a = std::min(number(x), number(y)), b = std::max(number(x), number(y));
    const Triangle &s = soup.triangles[a], &t = soup.triangles[b];
    if (contacts.meet(s, t)) pairs.push_back({a, b, contacts.coplanar(s, t)});
  });
  std::sort(pairs.begin(), pairs.end(), [](const MeetingPair& x, const MeetingPair& y) {
    return std::tie(x.a, x.b) < std::tie(y.a, y.b);
  });
  return pairs;
}

}  // namespace tetproof::unite
