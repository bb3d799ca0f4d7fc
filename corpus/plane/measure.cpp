#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <stdexcept>

#include "corpus/campaigns/supervise/supervisor.h"
#include "corpus/plane/bench.h"

namespace tetproof::plane_bench {
namespace {

void explain(Measurement& m, const std::string& reason) {
  std::snprintf(m.reason, sizeof m.reason, "%s", reason.c_str());
}

Measurement run_once(const Mesher& mesher, const PlanarGraph& graph) {
  Measurement m;
  mesher.run(graph, m);
  m.ok = true;
  return m;
}

Measurement run_here(const Mesher& mesher, const PlanarGraph& graph) {
  Measurement m;
  try {
    // Small inputs run several times. The result is the mean of the runs without the first one,
    // which pays for memory and caches.
    constexpr double kEnough = 0.1;
    m = run_once(mesher, graph);
    if (m.seconds < kEnough) {
      double sum = 0;
      int runs = 0;
      for (; runs < 50 && sum < kEnough; ++runs) sum += run_once(mesher, graph).seconds;
      m.seconds = sum / runs;
    }
    struct rusage usage = {};
    getrusage(RUSAGE_SELF, &usage);
    m.peak_megabytes = static_cast<double>(usage.ru_maxrss) / 1024;
    if (mesher.verify) mesher.verify(graph, m);
  } catch (const std::exception& error) {
    m.ok = false;
    explain(m, error.what());
  }
  return m;
}

}  // namespace

void count_angles(const std::vector<std::array<double, 2>>& vertices,
                  const std::vector<std::array<std::uint32_t, 3>>& triangles, Measurement& m) {
  double least = 180, sum = 0;
  for (const auto& t : triangles) {
    double own = 180;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto &o = vertices[t[i]], &a = vertices[t[(i + 1) % 3]], &b = vertices[t[(i + 2) % 3]];
      const double ux = a[0] - o[0], uy = a[1] - o[1], vx = b[0] - o[0], vy = b[1] - o[1];
      own = std::min(own, std::atan2(ux * vy - uy * vx, ux * vx + uy * vy) * 57.29577951308232);
    }
    least = std::min(least, own);
    sum += own;
  }
  m.triangles = triangles.size();
  m.final_angle = least;
  m.mean_angle = triangles.empty() ? 0 : sum / static_cast<double>(triangles.size());
}

Measurement measure(const Mesher& mesher, const PlanarGraph& graph, const Limits& limits) {
  Measurement m;
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("no pipe");
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("no child process");
  if (child == 0) {
    close(ends[0]);
    const auto limit = static_cast<rlim_t>(std::ceil(limits.seconds));
    const struct rlimit cpu = {limit, limit + 1};
    setrlimit(RLIMIT_CPU, &cpu);
    const auto bytes = static_cast<rlim_t>(limits.megabytes * 1048576);
    const struct rlimit memory = {bytes, bytes};
    if (kMemoryBackstop) setrlimit(RLIMIT_AS, &memory);
    const struct rlimit core = {0, 0};
    setrlimit(RLIMIT_CORE, &core);
    const Measurement result = run_here(mesher, graph);
    const bool written = ::write(ends[1], &result, sizeof result) == sizeof result;
    _exit(written ? 0 : 1);
  }
  close(ends[1]);
  const bool complete = read(ends[0], &m, sizeof m) == sizeof m;
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (!complete) {
    m = {};
    const bool late = WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU;
    explain(m, late                  ? "timeout"
               : WIFSIGNALED(status) ? std::string("signal ") + strsignal(WTERMSIG(status))
                                     : "ended without a result");
  }
  return m;
}

}  // namespace tetproof::plane_bench
