#include "mesher/predicates/signs_of_doubles.h"

#include "mesher/predicates/filter.h"
#include "mesher/predicates/stages.h"

namespace delmesher::predicates {
namespace {

Approximation known(const Vec3& p) {
  return {p[0], p[1], p[2], 0};
}

}  // namespace

int orient2d_sign(const std::array<double, 2>& a, const std::array<double, 2>& b,
                  const std::array<double, 2>& c) {
  const std::array<Vec3, 3> p = {Vec3{a[0], a[1], 0}, Vec3{b[0], b[1], 0}, Vec3{c[0], c[1], 0}};
  const int sign = filters::orient2d(known(p[0]), known(p[1]), known(p[2]));
  return sign != 0 ? sign : stages::exact(stages::ExactArguments(p), polynomials::Orient2d{2});
}

int orient3d_sign(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const int sign = filters::orient3d(known(a), known(b), known(c), known(d));
  if (sign != 0) return sign;
  return stages::exact(stages::ExactArguments(std::array{a, b, c, d}), polynomials::Orient3d{});
}

}  // namespace delmesher::predicates
