// tetproof-angles SURFACE...: the smallest face angle inside the mesh made with the default
// options, the bound that the facets' corners set, and the causes of angles below delta. A line of
// JSON each, and a summary.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "mesher/io/parse_surface.h"
#include "reports/benchmark/angle_causes.h"

namespace tetproof::benchmark {
namespace {

class Summary {
 public:
  bool add(const char* path) {
    const auto read = delmesher::io::read_surface(path);
    if (!read.ok()) return complain(path, read.error);
    delmesher::Options options;
    options.want_exact = true;
    const delmesher::Result result = delmesher::tetrahedralize(read.surface, options);
    if (!result.status.ok()) return complain(path, result.status.message);
    const AngleCauses causes = find_angle_causes(read.surface, result);
    const double told = result.statistics.final.min_face_angle;
    if (std::fabs(told - causes.smallest) > 1e-6) {
      return complain(path, fmt::format("the mesher's statistics say {}, these faces {}", told,
                                        causes.smallest));
    }
    print(path, causes);
    return true;
  }

  void print_totals() {
    if (smallest_.empty()) return;
    fmt::print("{} models; medians: bound {:.3f}, smallest {:.3f}, ratio {:.3f}\n",
               smallest_.size(), median(bound_), median(smallest_), median(ratio_));
    for (std::size_t c = 0; c < kAngleCauseNames.size(); ++c) {
      fmt::print("  {:12} the smallest angle of {} models; {} faces below delta\n",
                 kAngleCauseNames[c], first_[c], below_[c]);
    }
  }

 private:
  static bool complain(const char* path, const std::string& why) {
    fmt::print(stderr, "tetproof-angles: {}: {}\n", path, why);
    return false;
  }

  static double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
  }

  void print(const char* path, const AngleCauses& causes) {
    const auto cause = static_cast<std::size_t>(causes.cause);
    bound_.push_back(causes.bound);
    smallest_.push_back(causes.smallest);
    ratio_.push_back(causes.smallest / std::min(causes.bound, 14.47));
    ++first_[cause];
    fmt::print("{{\"model\": \"{}\", \"bound\": {:.6f}, \"smallest\": {:.6f}, \"cause\": \"{}\"",
               path, causes.bound, causes.smallest, kAngleCauseNames[cause]);
    for (std::size_t c = 0; c < kAngleCauseNames.size(); ++c) {
      below_[c] += causes.below[c];
      fmt::print(", \"{}\": {}", kAngleCauseNames[c], causes.below[c]);
    }
    fmt::print(", \"faces\": {}}}\n", causes.faces);
    std::fflush(stdout);
  }

  std::vector<double> bound_, smallest_, ratio_;
  std::array<std::uint64_t, 4> first_{}, below_{};
};

}  // namespace
}  // namespace tetproof::benchmark

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fputs("usage: tetproof-angles SURFACE...\n", stderr);
    return 2;
  }
  tetproof::benchmark::Summary summary;
  bool all = true;
  for (int i = 1; i < argc; ++i) all = summary.add(argv[i]) && all;
  summary.print_totals();
  return all ? 0 : 1;
}
