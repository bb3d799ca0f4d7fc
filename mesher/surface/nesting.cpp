#include "mesher/surface/nesting.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesher/arithmetic/dyadic.h"
#include "mesher/base/check.h"
#include "mesher/predicates/polynomials.h"
#include "mesher/surface/triangle_contact.h"

namespace delmesher::surface {
namespace {

// Six times the volume of one component, first in doubles with a bound on the error.
class VolumeSum {
 public:
  VolumeSum(const PointStore& points, const Triangles& triangles,
            const std::vector<std::uint32_t>& members)
      : points_(points), triangles_(triangles), members_(members) {
    origin_ = points.nearest(triangles[members[0]][0]);
    double extent = 0;
    for (const std::uint32_t t : members) {
      for (const VertexId v : triangles[t]) {
        for (const double x : half_difference(v)) extent = std::max(extent, std::fabs(x));
      }
    }
    std::frexp(extent, &exponent_);
    sum();
  }

  ComponentNesting result() const {
    ComponentNesting nesting;
    // 32 covers the rounding of differences and products, the number of terms that of the sum;
    // the last term covers underflow, coordinates being scaled to at most 1.
    const double error =
        permanent_ * (static_cast<double>(members_.size()) + 32) * 0x1p-52 + 0x1p-1000;
    nesting.volume_sign = std::fabs(sum_) > error ? (sum_ > 0 ? 1 : -1) : exact_sign();
    // Scaled back in steps: the halving of the differences (2^3) and the scaling.
    nesting.volume = std::ldexp(std::fabs(sum_) / 6 * 8, 3 * exponent_);
    return nesting;
  }

 private:
  // Halved, because the difference of huge coordinates may overflow.
  Vec3 half_difference(VertexId v) const {
    const Vec3 p = points_.nearest(v);
    return {p[0] * 0.5 - origin_[0] * 0.5, p[1] * 0.5 - origin_[1] * 0.5,
            p[2] * 0.5 - origin_[2] * 0.5};
  }

  void sum() {
    for (const std::uint32_t t : members_) {
      std::array<Vec3, 3> p;
      for (std::size_t k = 0; k < 3; ++k) {
        p[k] = half_difference(triangles_[t][k]);
        for (double& x : p[k]) x = std::ldexp(x, -exponent_);
      }
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
        const double left = p[1][j] * p[2][k], right = p[1][k] * p[2][j];
        sum_ += p[0][i] * (left - right);
        permanent_ += std::fabs(p[0][i]) * (std::fabs(left) + std::fabs(right));
      }
    }
  }

  // Exact: the sum of det(a, b, c).
  int exact_sign() const {
    using Exact = polynomials::Triple<Dyadic>;
    Dyadic total;
    for (const std::uint32_t t : members_) {
      std::array<Exact, 3> p;
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 x = points_.nearest(triangles_[t][k]);
        p[k] = {Dyadic::from_double(x[0]), Dyadic::from_double(x[1]), Dyadic::from_double(x[2])};
      }
      total = total + dot(p[0], cross(p[1], p[2]));
    }
    return total.sign();
  }

  const PointStore& points_;
  const Triangles& triangles_;
  const std::vector<std::uint32_t>& members_;
  Vec3 origin_;
  int exponent_ = 0;
  double sum_ = 0, permanent_ = 0;
};

// Number of other components around the component of triangle t: the parity of the crossings of a
// ray with each of them.
std::uint32_t nesting_depth(const Triangles& triangles,
                            const std::vector<std::uint32_t>& component_of, std::uint32_t t,
                            Predicates& predicates, const BoxTree& tree,
                            std::vector<std::uint32_t>& crossed) {
  const VertexId v = triangles[t][0];
  const Vec3 p = predicates.points().nearest(v);
  Box ray{p, p};
  ray.hi[0] = std::numeric_limits<double>::infinity();
  crossed.clear();
  tree.query(ray, [&](std::uint32_t u) {
    if (component_of[u] != component_of[t] && ray_crosses(predicates, v, 0, 1, triangles[u])) {
      crossed.push_back(component_of[u]);
    }
    return true;
  });
  std::sort(crossed.begin(), crossed.end());
  std::uint32_t depth = 0;
  for (std::size_t i = 0; i < crossed.size();) {
    std::size_t j = i;
    while (j < crossed.size() && crossed[j] == crossed[i]) ++j;
    depth += (j - i) % 2;
    i = j;
  }
  return depth;
}

}  // namespace

std::vector<ComponentNesting> analyze_nesting(const Triangles& triangles,
                                              const std::vector<std::uint32_t>& component_of,
                                              std::size_t components, Predicates& predicates,
                                              const BoxTree& tree, Control& control) {
  std::vector<std::vector<std::uint32_t>> members(components);
  for (std::uint32_t t = 0; t < triangles.size(); ++t) members[component_of[t]].push_back(t);
  std::vector<ComponentNesting> result;
  std::vector<std::uint32_t> crossed;
  for (const auto& component : members) {
    control.poll();
    result.push_back(VolumeSum(predicates.points(), triangles, component).result());
    DELMESHER_CHECK(result.back().volume_sign != 0, "a component of a valid surface has no volume");
    if (components > 1) {
      result.back().depth =
          nesting_depth(triangles, component_of, component[0], predicates, tree, crossed);
    }
  }
  return result;
}

}  // namespace delmesher::surface
