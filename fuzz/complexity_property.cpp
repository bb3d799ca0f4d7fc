#include <time.h>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "fuzz/properties.h"
#include "property_tests/leniency.h"

namespace tetproof::fuzz {
Finding complexity_holds(const delmesher::Surface& surface) {
  delmesher::Options options;
  options.max_vertices = 20000;
  std::uint64_t polls = 0;
  options.progress = [&](const delmesher::Progress&) { ++polls; return true; };
  timespec t0, t1;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t0);
  const delmesher::Result r = delmesher::tetrahedralize(surface, options);
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t1);
  const auto& s = r.statistics;
  const double sec = double(t1.tv_sec - t0.tv_sec) + 1e-9 * double(t1.tv_nsec - t0.tv_nsec);
  std::FILE* f = std::fopen("/tmp/complexity.csv", "a");
  std::fprintf(f, "%d %zu %zu %llu %llu %llu %llu %llu %llu %llu %llu %.6f\n", int(r.status.code), surface.triangles.size(), r.mesh.tetrahedra.size(), (unsigned long long)s.refined.tetrahedra, (unsigned long long)s.final.tetrahedra, (unsigned long long)polls, (unsigned long long)s.predicate_filter, (unsigned long long)s.predicate_by_support, (unsigned long long)s.predicate_extended, (unsigned long long)s.predicate_exact, (unsigned long long)s.predicate_symbolic, sec);
  std::fclose(f);
  return {};
}
}
