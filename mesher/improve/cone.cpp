#include "mesher/improve/cone.h"

#include <cmath>
#include <utility>

namespace delmesher::improve {
namespace {

// As instructions: std::min of a list is not taken in lanes.
inline double smaller(double a, double b) {
  return a < b ? a : b;
}
inline double larger(double a, double b) {
  return a > b ? a : b;
}

}  // namespace

void Cone::add(const Vec3& a, const Vec3& b, const Vec3& c, bool counts) {
  const std::size_t l = size_ % kLanes;
  if (l == 0) {
    order_.push_back(static_cast<std::uint32_t>(order_.size()));
    if (order_.size() > blocks_.size()) blocks_.emplace_back();
  }
  Block& block = blocks_[order_.size() - 1];
  ++size_;
  for (std::size_t i = 0; i < 3; ++i) {
    block.a[i][l] = a[i];
    block.b[i][l] = b[i];
    block.c[i][l] = c[i];
  }
  block.counts[l] = counts;
}

void Cone::finish() {
  // Lanes behind the last face repeat it.
  if (const std::size_t used = size_ % kLanes; used != 0) {
    Block& block = blocks_[order_.size() - 1];
    for (std::size_t l = used; l < kLanes; ++l) {
      for (std::size_t i = 0; i < 3; ++i) {
        block.a[i][l] = block.a[i][used - 1];
        block.b[i][l] = block.b[i][used - 1];
        block.c[i][l] = block.c[i][used - 1];
      }
      block.counts[l] = block.counts[used - 1];
    }
  }
  for (std::size_t n = 0; n < order_.size(); ++n) find_normals(blocks_[n]);
}

// All that belongs to the faces alone.
void Cone::find_normals(Block& block) {
  for (std::size_t l = 0; l < kLanes; ++l) {
    const double p0 = block.b[0][l] - block.a[0][l], p1 = block.b[1][l] - block.a[1][l],
                 p2 = block.b[2][l] - block.a[2][l];
    const double q0 = block.c[0][l] - block.b[0][l], q1 = block.c[1][l] - block.b[1][l],
                 q2 = block.c[2][l] - block.b[2][l];
    const double r0 = block.a[0][l] - block.c[0][l], r1 = block.a[1][l] - block.c[1][l],
                 r2 = block.a[2][l] - block.c[2][l];
    const double n0 = p1 * q2 - p2 * q1, n1 = p2 * q0 - p0 * q2, n2 = p0 * q1 - p1 * q0;
    const double n = n0 * n0 + n1 * n1 + n2 * n2;
    const double ab = p0 * p0 + p1 * p1 + p2 * p2, bc = q0 * q0 + q1 * q1 + q2 * q2,
                 ca = r0 * r0 + r1 * r1 + r2 * r2;
    block.normal[0][l] = n0;
    block.normal[1][l] = n1;
    block.normal[2][l] = n2;
    block.inverse_n[l] = 1 / n;
    block.length[l] = std::sqrt(n);
    block.ab[l] = ab;
    block.bc[l] = bc;
    block.ca[l] = ca;
    block.angle[l] = n / larger(ab * bc, larger(bc * ca, ca * ab));
  }
}

Vec3 Cone::average_apex() const {
  Vec3 sum{};
  double count = 0;
  for (std::size_t n = 0; n < size_; ++n) {
    const Block& block = blocks_[n / kLanes];
    const std::size_t l = n % kLanes;
    if (!block.counts[l]) continue;
    const double height = apex_height(block.length[l]);
    for (std::size_t i = 0; i < 3; ++i) {
      sum[i] += (block.a[i][l] + block.b[i][l] + block.c[i][l]) / 3 - height * block.normal[i][l];
    }
    ++count;
  }
  return {sum[0] / count, sum[1] / count, sum[2] / count};
}

double Cone::average_squared_edge() const {
  double sum = 0;
  for (std::size_t n = 0; n < size_; ++n) {
    const Block& block = blocks_[n / kLanes];
    const std::size_t l = n % kLanes;
    sum += block.ab[l] + block.bc[l] + block.ca[l];
  }
  return sum / (3 * static_cast<double>(size_));
}

bool Cone::reaches(const Vec3& x, const Quality& least) {
  for (std::uint32_t& n : order_) {
    if (measure(blocks_[n], x, least)) continue;
    std::swap(n, order_.front());
    return false;
  }
  return true;
}

// As quality(), with what belongs to the face alone taken from the block.
bool Cone::measure(Block& block, const Vec3& x, const Quality& least) {
  Lanes volume, uu, vv, ww, n1, n2, n3, center;
  std::array<float, kLanes> dihedral;
  for (std::size_t l = 0; l < kLanes; ++l) {
    const double u0 = block.a[0][l] - x[0], u1 = block.a[1][l] - x[1], u2 = block.a[2][l] - x[2];
    const double v0 = block.b[0][l] - x[0], v1 = block.b[1][l] - x[1], v2 = block.b[2][l] - x[2];
    const double w0 = block.c[0][l] - x[0], w1 = block.c[1][l] - x[1], w2 = block.c[2][l] - x[2];
    const double uv0 = u1 * v2 - u2 * v1, uv1 = u2 * v0 - u0 * v2, uv2 = u0 * v1 - u1 * v0;
    const double vw0 = v1 * w2 - v2 * w1, vw1 = v2 * w0 - v0 * w2, vw2 = v0 * w1 - v1 * w0;
    const double wu0 = w1 * u2 - w2 * u1, wu1 = w2 * u0 - w0 * u2, wu2 = w0 * u1 - w1 * u0;
    volume[l] = block.normal[0][l] * u0 + block.normal[1][l] * u1 + block.normal[2][l] * u2;
    uu[l] = u0 * u0 + u1 * u1 + u2 * u2;
    vv[l] = v0 * v0 + v1 * v1 + v2 * v2;
    ww[l] = w0 * w0 + w1 * w1 + w2 * w2;
    n1[l] = uv0 * uv0 + uv1 * uv1 + uv2 * uv2;
    n2[l] = vw0 * vw0 + vw1 * vw1 + vw2 * vw2;
    n3[l] = wu0 * wu0 + wu1 * wu1 + wu2 * wu2;
    const double c0 = uu[l] * vw0 + vv[l] * wu0 + ww[l] * uv0;
    const double c1 = uu[l] * vw1 + vv[l] * wu1 + ww[l] * uv1;
    const double c2 = uu[l] * vw2 + vv[l] * wu2 + ww[l] * uv2;
    center[l] = c0 * c0 + c1 * c1 + c2 * c2;
    const double h1 = volume[l] / n1[l], h2 = volume[l] / n2[l], h3 = volume[l] / n3[l];
    const double h = volume[l] * block.inverse_n[l];
    const double s1 = smaller(uu[l] * h1 * h3, vv[l] * h1 * h2);
    const double s2 = smaller(ww[l] * h2 * h3, block.ab[l] * h1 * h);
    const double s3 = smaller(block.bc[l] * h2 * h, block.ca[l] * h3 * h);
    dihedral[l] = static_cast<float>(smaller(s1, smaller(s2, s3)));
  }
  bool ok = true;
  for (std::size_t l = 0; l < kLanes; ++l) {
    ok &= volume[l] > 0 && dihedral[l] > 0 && (dihedral[l] >= least.dihedral || !block.counts[l]);
  }
  if (!ok) return false;
  block.dihedral = dihedral;
  for (std::size_t l = 0; l < kLanes; ++l) {
    const double f1 =
        n1[l] / larger(uu[l] * vv[l], larger(uu[l] * block.ab[l], vv[l] * block.ab[l]));
    const double f2 =
        n2[l] / larger(vv[l] * ww[l], larger(vv[l] * block.bc[l], ww[l] * block.bc[l]));
    const double f3 =
        n3[l] / larger(ww[l] * uu[l], larger(ww[l] * block.ca[l], uu[l] * block.ca[l]));
    block.face[l] = static_cast<float>(smaller(smaller(f1, f2), smaller(f3, block.angle[l])));
  }
  for (std::size_t l = 0; l < kLanes; ++l) ok &= block.face[l] >= least.face || !block.counts[l];
  if (!ok) return false;
  for (std::size_t l = 0; l < kLanes; ++l) {
    const double surface =
        (std::sqrt(n1[l]) + std::sqrt(n2[l])) + (std::sqrt(n3[l]) + block.length[l]);
    const double inverse = volume[l] / surface;
    block.gamma[l] =
        static_cast<float>(36 * inverse * inverse * (volume[l] * volume[l] / center[l]));
  }
  for (std::size_t l = 0; l < kLanes; ++l) ok &= block.gamma[l] >= least.gamma || !block.counts[l];
  return ok;
}

}  // namespace delmesher::improve
