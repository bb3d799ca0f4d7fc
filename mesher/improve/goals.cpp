#include "mesher/improve/goals.h"

namespace delmesher::improve {
namespace {

// Tetrahedra as good as this are left alone. (Lower targets were tried: they take a quarter less
// time, but nearly as many tetrahedra; then the worst of them are worse.)
constexpr double kDihedral = 22, kFaceAngle = 20;  // degrees
constexpr float kGamma = 0.4F;

float squared_sine(double degrees) {
  return static_cast<float>(1 - cosine_squared(degrees));
}

}  // namespace

Goals goals_of(const ImproveOptions& options) {
  return {.target = {squared_sine(kDihedral), squared_sine(kFaceAngle), kGamma * kGamma},
          .promised = squared_sine(options.delta),
          .floor = squared_sine(kFlattestDihedral),
          .max_edge = options.max_edge,
          .sizes = options.sizes != nullptr && !options.sizes->empty() ? options.sizes : nullptr,
          .region_edges = options.region_edges,
          .as_given = options.as_given,
          .everywhere = options.region == Region::hull,
          .nearly_good = options.keep_surface ? 0.8F : 0.6F};
}

}  // namespace delmesher::improve
