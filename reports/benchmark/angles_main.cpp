// tetproof-angles SURFACE...: the smallest face angle and dihedral angle inside the mesh made with
// the default options, the bounds that the facets' corners and the input edges set for them, and
// the causes of face angles below delta. A line of JSON each, and a summary.
//
// tetproof-angles --bounds SURFACE...: only the bounds. A line of JSON each.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include "mesher/io/parse_surface.h"
#include "reports/benchmark/angle_causes.h"

namespace tetproof::benchmark {
namespace {

bool complain(const char* path, const std::string& why) {
  fmt::print(stderr, "tetproof-angles: {}: {}\n", path, why);
  return false;
}

std::string text_of(const AngleBounds& bounds) {
  return fmt::format("\"bound\": {:.6f}, \"dihedral_bound\": {:.6g}", bounds.face, bounds.dihedral);
}

// The facets are in the record of a mesh: the cheapest will do.
bool print_bounds(const char* path) {
  const auto read = delmesher::io::read_surface(path);
  if (!read.ok()) return complain(path, read.error);
  delmesher::Options options;
  options.want_exact = true;
  options.approximate = true;
  options.slivers = false;
  options.delta = 0.01;
  const delmesher::Result result = delmesher::tetrahedralize(read.surface, options);
  if (result.exact.facets.empty()) return complain(path, result.status.message);
  fmt::print("{{\"model\": \"{}\", {}}}\n", path, text_of(find_bounds(read.surface, result.exact)));
  return true;
}

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
    const delmesher::MeshStatistics& told = result.statistics.final;
    if (std::fabs(told.min_face_angle - causes.smallest) > 1e-6 ||
        std::fabs(told.min_dihedral - causes.smallest_dihedral) > 1e-6) {
      return complain(path,
                      fmt::format("the mesher's statistics say {} and {}, this mesh {} and {}",
                                  told.min_face_angle, told.min_dihedral, causes.smallest,
                                  causes.smallest_dihedral));
    }
    print(path, causes);
    return true;
  }

  void print_totals() {
    if (smallest_.empty()) return;
    fmt::print("{} models; medians of face angles: bound {:.3f}, smallest {:.3f}, ratio {:.3f}\n",
               smallest_.size(), median(bound_), median(smallest_), median(ratio_));
    const auto near = std::ranges::count_if(dihedral_ratio_, [](double r) { return r >= 0.8; });
    fmt::print(
        "medians of dihedral angles: bound {:.3f}, smallest {:.3f}; {} of {} models have at least "
        "0.8 of the bound, or of {}\n",
        median(dihedral_bound_), median(smallest_dihedral_), near, smallest_.size(), kEnough);
    for (std::size_t c = 0; c < kAngleCauseNames.size(); ++c) {
      fmt::print("  {:12} the smallest angle of {} models; {} faces below delta\n",
                 kAngleCauseNames[c], first_[c], below_[c]);
    }
  }

 private:
  static double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
  }

  void print(const char* path, const AngleCauses& causes) {
    const auto cause = static_cast<std::size_t>(causes.cause);
    bound_.push_back(causes.bounds.face);
    dihedral_bound_.push_back(causes.bounds.dihedral);
    smallest_dihedral_.push_back(causes.smallest_dihedral);
    dihedral_ratio_.push_back(causes.smallest_dihedral / std::min(causes.bounds.dihedral, kEnough));
    smallest_.push_back(causes.smallest);
    ratio_.push_back(causes.smallest / std::min(causes.bounds.face, 14.47));
    ++first_[cause];
    fmt::print(
        "{{\"model\": \"{}\", {}, \"smallest\": {:.6f}, \"smallest_dihedral\": {:.6g}, "
        "\"cause\": \"{}\"",
        path, text_of(causes.bounds), causes.smallest, causes.smallest_dihedral,
        kAngleCauseNames[cause]);
    for (std::size_t c = 0; c < kAngleCauseNames.size(); ++c) {
      below_[c] += causes.below[c];
      fmt::print(", \"{}\": {}", kAngleCauseNames[c], causes.below[c]);
    }
    fmt::print(", \"faces\": {}}}\n", causes.faces);
    std::fflush(stdout);
  }

  static constexpr double kEnough = 15;  // degrees of a dihedral angle

  std::vector<double> bound_, smallest_, ratio_;
  std::vector<double> dihedral_bound_, smallest_dihedral_, dihedral_ratio_;
  std::array<std::uint64_t, 4> first_{}, below_{};
};

}  // namespace
}  // namespace tetproof::benchmark

int main(int argc, char** argv) {
  const bool bounds = argc > 1 && std::string_view(argv[1]) == "--bounds";
  if (argc < (bounds ? 3 : 2)) {
    std::fputs("usage: tetproof-angles [--bounds] SURFACE...\n", stderr);
    return 2;
  }
  bool all = true;
  if (bounds) {
    for (int i = 2; i < argc; ++i) all = tetproof::benchmark::print_bounds(argv[i]) && all;
    return all ? 0 : 1;
  }
  tetproof::benchmark::Summary summary;
  for (int i = 1; i < argc; ++i) all = summary.add(argv[i]) && all;
  summary.print_totals();
  return all ? 0 : 1;
}
