// Tests only: seeded families of points, from ordinary to hostile, each with every kind of point.
#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "mesher/predicates/points.h"

namespace delmesher::predicates::families {

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  std::uint64_t below(std::uint64_t n) { return engine_() % n; }
  double unit() { return std::ldexp(static_cast<double>(engine_() >> 11), -53); }
  double sign() { return (engine_() & 1) != 0 ? 1 : -1; }
  // Any exponent between the limits, any mantissa.
  double exponent_between(int low, int high) {
    const int e = low + static_cast<int>(below(static_cast<std::uint64_t>(high - low)));
    return sign() * std::ldexp(1 + unit(), e);
  }

 private:
  std::mt19937_64 engine_;
};

// Points of one store by kind; explicit ones include nearest doubles of implicit ones.
struct Sample {
  PointStore store;
  std::vector<VertexId> of_kind[4];

  VertexId pick(PointKind kind, Random& random) const {
    const auto& list = of_kind[static_cast<std::size_t>(kind)];
    return list[random.below(list.size())];
  }
};

struct Family {
  std::string name;
  std::function<double(Random&)> coordinate;
  std::function<double(Random&)> parameter;
};

inline std::vector<Family> all() {
  const auto unit = [](Random& r) { return r.unit(); };
  const auto short_unit = [](Random& r) { return static_cast<double>(r.below(9)) / 8; };
  const auto any = [](Random& r) { return (r.unit() - 0.5) * 4; };
  const auto tiny = [](Random& r) { return std::ldexp(r.unit(), -static_cast<int>(r.below(60))); };
  const auto any_exponent = [](Random& r) { return r.exponent_between(-1074, 1); };
  const auto scaled = [](double base, double spread) {
    return [=](Random& r) { return base * (1 + spread * (r.unit() - 0.5)) * r.sign(); };
  };
  const auto limit = [](int bits) {
    return [=](Random& r) {
      const int top = bits + static_cast<int>(r.below(3));
      return r.below(4) == 0 ? 1.0 : r.sign() * (std::ldexp(1.0, top) - std::ldexp(1.0, top - 53));
    };
  };
  return {
      {"random", [](Random& r) { return r.unit() * 10 - 5; }, unit},
      {"short parameters", [](Random& r) { return r.unit() * 10 - 5; }, short_unit},
      {"outside parameters", [](Random& r) { return r.unit() * 10 - 5; }, any},
      {"anchored parameters", [](Random& r) { return r.unit() * 10 - 5; }, tiny},
      {"small integers", [](Random& r) { return static_cast<double>(r.below(4)); }, short_unit},
      {"tenths", [](Random& r) { return static_cast<double>(r.below(4)) * 0.1; }, short_unit},
      // Few absolute values: many points on common spheres about the origin.
      {"cospherical", [](Random& r) { return r.sign() * 1.2345678; }, short_unit},
      {"far from the origin", [](Random& r) { return 1e6 + 1e-6 * r.unit(); }, unit},
      {"flat", [](Random& r) { return 1 + std::ldexp(static_cast<double>(r.below(3)), -52); },
       short_unit},
      // Products of degree 5 and 3 at the edge of the subnormal numbers.
      {"3e-65", scaled(3e-65, 1), unit},
      {"3e-108", scaled(3e-108, 1), unit},
      // As large as integers of one and of two limbs can be, and one bit too large.
      {"one limb", limit(60), short_unit},
      {"two limbs", limit(124), short_unit},
      {"1e-80", scaled(1e-80, 1), unit},
      {"1e-300", scaled(1e-300, 1), unit},
      {"1e300", scaled(1e300, 1), unit},
      {"largest doubles", scaled(1.7e308, 0.05), unit},
      {"denormals", [](Random& r) { return std::ldexp(static_cast<double>(r.below(9)), -1074); },
       unit},
      {"denormals, integers", [](Random& r) { return std::ldexp(double(r.below(5)), -1074); },
       short_unit},
      {"1e-300 with 1e300",
       [](Random& r) { return (r.below(2) != 0 ? 1e300 : 1e-300) * (r.unit() - 0.5); }, unit},
      {"any exponent", [](Random& r) { return r.exponent_between(-1074, 1023); }, any_exponent},
      {"wide", [](Random& r) { return r.exponent_between(-60, 60); }, unit},
      {"wider", [](Random& r) { return r.exponent_between(-200, 100); }, tiny},
  };
}

inline bool finite(const Approximation& a) {
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

// Meeting points of planes through corners, and points of segments and triangles between them.
inline void add_on_planes(Sample& sample, const Family& family, int n, Random& random) {
  PointStore& store = sample.store;
  for (int i = 0; i < n; ++i) {
    std::array<Vec3, 3> normal;
    double determinant = 0;
    while (determinant == 0) {
      // Small numbers now and then, so that denominators are short and points coincide.
      for (Vec3& m : normal) {
        for (double& x : m) x = i % 2 == 0 ? double(random.below(5)) - 2 : random.unit() - 0.5;
      }
      const auto& [a, b, c] = normal;
      determinant = a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                    a[2] * (b[0] * c[1] - b[1] * c[0]);
    }
    const auto plane = [&](std::size_t k) {
      PlaneEquation equation{normal[k], {}};
      for (Vec3& p : equation.through) {
        p = store.nearest(sample.pick(PointKind::explicit_point, random));
      }
      return store.add_plane(equation);
    };
    sample.of_kind[3].push_back(store.add_on_planes(plane(0), plane(1), plane(2)));
  }
  for (int i = 0; i < n / 2; ++i) {
    const auto corner = [&] {
      return sample.pick(i % 3 == 0 ? PointKind::explicit_point : PointKind::on_planes, random);
    };
    const VertexId p = corner(), q = sample.pick(PointKind::on_planes, random), r = corner();
    const double u = family.parameter(random);
    sample.of_kind[1].push_back(store.add_on_segment(p, q, u));
    sample.of_kind[2].push_back(store.add_on_triangle(p, q, r, u / 2, family.parameter(random)));
  }
}

// `n` corners, then `n` implicit points of each kind, then explicit neighbours of implicit ones:
// nearly on the same lines and planes.
inline void fill(Sample& sample, const Family& family, int n, Random& random) {
  PointStore& store = sample.store;
  const auto explicit_point = [&](double x, double y, double z) {
    const VertexId v = store.add_explicit(x, y, z);
    sample.of_kind[0].push_back(v);
  };
  for (int i = 0; i < n; ++i) {
    const double x = family.coordinate(random);
    const double y = family.coordinate(random);
    explicit_point(x, y, family.coordinate(random));
  }
  const auto corner = [&] { return static_cast<VertexId>(random.below(static_cast<unsigned>(n))); };
  for (int i = 0; i < n; ++i) {
    const VertexId p = corner(), q = corner(), r = corner();
    const double u = family.parameter(random);
    const double v = family.parameter(random);
    sample.of_kind[1].push_back(store.add_on_segment(p, q, u));
    // Some on the same triangle, some with the same corner twice.
    sample.of_kind[2].push_back(i % 3 == 0 ? store.add_on_triangle(0, 1, 2, u / 2, v / 2)
                                           : store.add_on_triangle(p, q, r, u / 2, v / 2));
  }
  for (int i = 0; i < n; ++i) {
    const VertexId v =
        sample.pick(i % 2 == 0 ? PointKind::on_segment : PointKind::on_triangle, random);
    const Approximation a = store.approximation(v);
    if (finite(a)) explicit_point(a.x, a.y, a.z);
  }
  add_on_planes(sample, family, n, random);
}

}  // namespace delmesher::predicates::families
