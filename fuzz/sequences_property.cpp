// A sequence of calls: surfaces of the generated families are meshed, checked, improved, written
// and read, with runs among them that are cancelled, end at a limit, or stand side by side in two
// threads. The library has no state, so the same call has the same answer wherever it stands.
#include <algorithm>
#include <compare>
#include <map>
#include <thread>
#include <tuple>

#include "corpus/generators/generate.h"
#include "fuzz/properties.h"
#include "fuzz/scratch.h"
#include "mesher/delmesher/option_table.h"
#include "mesher/delmesher_files.h"
#include "property_tests/leniency.h"

namespace tetproof::fuzz {
namespace {

using delmesher::Options;
using delmesher::Result;
using delmesher::StatusCode;
using delmesher::Surface;
using delmesher::TetMesh;

Leniency no_surface("family-without-small-member", 0.3);
Leniency nothing_made("sequence-without-a-mesh", 0.5);

constexpr std::uint64_t kMostVertices = 1000;
constexpr unsigned kMostCalls = 12;

// One call of the library: its arguments except the limits. Equal ones have equal answers.
struct Call {
  enum class Kind : std::uint8_t { mesh, cdt, improve };
  Kind kind;
  std::uint32_t subject;  // a surface, or a mesh that was made before
  std::uint32_t variant;  // of the options
  auto operator<=>(const Call&) const = default;
};

struct Answer {
  Result result;
  std::uint64_t asked = 0;  // how often the progress callback was called
};

constexpr std::uint32_t kVariants = 8;
Options options_of(std::uint32_t variant) {
  Options options = variant == 1 ? delmesher::paper_options() : Options{};
  options.gabriel = options.gabriel || variant == 2;
  if (variant == 3) options.planar = 0;
  if (variant == 4) options.region = delmesher::Region::hull;
  options.approximate = variant == 5;
  if (variant == 6) options.improve = false;
  options.want_exact = options.want_chamfered = variant == 7;
  options.max_vertices = kMostVertices;
  return options;
}

delmesher::CdtOptions cdt_options(const Options& options) {
  auto cdt = delmesher::options::taken_from<delmesher::CdtOptions>(options);
  cdt.want_exact = options.want_exact;
  return cdt;
}

bool same(const TetMesh& m, const TetMesh& n) {
  const auto parts = [](const TetMesh& mesh) {
    return std::tie(mesh.vertices, mesh.tetrahedra, mesh.inside, mesh.regions, mesh.boundary,
                    mesh.boundary_labels, mesh.boundary_facets);
  };
  return parts(m) == parts(n);
}

bool same(const Surface& s, const Surface& t) {
  return std::tie(s.vertices, s.triangles, s.labels) == std::tie(t.vertices, t.triangles, t.labels);
}

// What of the statistics no clock decides. Predicates are counted one by one, so another way to the
// same mesh shows.
auto counters(const delmesher::Statistics& s) {
  return std::tie(s.final.tetrahedra, s.final.min_dihedral, s.final.mean_gamma, s.refined.vertices,
                  s.steiner_on_segments, s.steiner_on_facets, s.steiner_in_volume,
                  s.predicate_filter, s.predicate_extended, s.predicate_fixed, s.predicate_exact,
                  s.predicate_symbolic, s.predicate_by_support, s.predicted_tetrahedra,
                  s.ladder.times, s.cdt_restarts);
}

// What differs between two answers to one call; empty if nothing does.
Finding difference(const Result& first, const Result& second) {
  if (first.status.code != second.status.code || first.status.message != second.status.message) {
    return "status: \"" + first.status.message + "\", then \"" + second.status.message + "\"";
  }
  if (!same(first.mesh, second.mesh)) return "mesh: another one for the same call";
  if (!same(first.chamfered, second.chamfered)) return "chamfered surface: another one";
  if (first.warnings != second.warnings) return "warnings: others for the same call";
  // Where several threads are stopped, each had got somewhere.
  if (first.status.ok() && counters(first.statistics) != counters(second.statistics)) {
    return "statistics: others for the same call";
  }
  return first.exact.points.size() == second.exact.points.size() ? "" : "record: another one";
}

// An approximate mesh has nothing inside if the filter has dropped all facets. A run that does not
// end well delivers nothing and says why in one line.
Finding judged(const Result& result, bool approximate) {
  const delmesher::Status& status = result.status;
  if (status.code == StatusCode::internal_error || status.code == StatusCode::invalid_surface ||
      status.code == StatusCode::invalid_options || status.code == StatusCode::invalid_mesh) {
    return "status: " + status.message;
  }
  if (status.ok()) {
    return result.mesh.tetrahedra.empty() && !approximate ? "mesh: empty, and ok" : "";
  }
  if (status.message.empty() || status.message.find('\n') != std::string::npos) {
    return "message: not one line";
  }
  return same(result.mesh, TetMesh{}) ? "" : "mesh: something of it, though the run was stopped";
}

constexpr const char* kSteps[] = {"interrupted by no", "interrupted by an exception",
                                  "limited",           "in two threads",
                                  "through a file",    "checked",
                                  "repeated",          "repeated with threads"};

auto sorted(const TetMesh& mesh) {
  auto tetrahedra = mesh.tetrahedra;
  std::sort(tetrahedra.begin(), tetrahedra.end());
  return tetrahedra;
}

class Sequence {
 public:
  explicit Sequence(Bytes bytes) : bytes_(bytes) {}

  Finding run() {
    if (!choose_surfaces()) {
      no_surface.take();
      return {};
    }
    for (unsigned calls = 1 + bytes_.below(kMostCalls); calls > 0; --calls) {
      if (Finding finding = step(); !finding.empty()) return finding + " [" + last_ + "]";
    }
    if (meshes_.empty()) nothing_made.take();
    return {};
  }

 private:
  bool choose_surfaces() {
    for (int s = 0; s < 2; ++s) {
      const Family& family = families()[bytes_.below(256) % families().size()];
      const std::uint32_t index = bytes_.below(256);
      auto surface = generate(family, 1, index);
      if (surface && surface->triangles.size() <= kLargestSurface) {
        surfaces_.push_back(*std::move(surface));
      }
    }
    return !surfaces_.empty();
  }

  Finding step() {
    const std::uint32_t what = bytes_.below(8);
    last_ = kSteps[what];
    switch (what) {
      case 0:
        return interrupted(next_call(), false);
      case 1:
        return interrupted(next_call(), true);
      case 2:
        return limited(next_call());
      case 3:
        return in_two_threads(next_call());
      case 4:
        return through_a_file();
      case 5:
        return checked();
      default:
        return repeated(next_call(), what == 6 ? 1 : 2 + bytes_.below(3));
    }
  }

  Call next_call() {
    const std::uint32_t kind = bytes_.below(6), variant = bytes_.below(kVariants);
    if (kind == 0 && !meshes_.empty()) {
      return {Call::Kind::improve, bytes_.below(static_cast<std::uint32_t>(meshes_.size())), 0};
    }
    const std::uint32_t surface = bytes_.below(static_cast<std::uint32_t>(surfaces_.size()));
    return {kind == 1 ? Call::Kind::cdt : Call::Kind::mesh, surface, variant};
  }

  Result answer(const Call& call, const Options& options) const {
    switch (call.kind) {
      case Call::Kind::cdt:
        return delmesher::constrained_delaunay(surfaces_[call.subject], cdt_options(options));
      case Call::Kind::improve:
        return delmesher::improve_mesh(
            meshes_[call.subject],
            delmesher::options::taken_from<delmesher::ImproveOptions>(options));
      default:
        return delmesher::tetrahedralize(surfaces_[call.subject], options);
    }
  }

  // The answer to a call without interruption.
  Answer whole_answer(const Call& call, unsigned threads) const {
    Answer whole;
    Options options = options_of(call.variant);
    options.threads = threads;
    options.progress = [&](const delmesher::Progress&) { return ++whole.asked > 0; };
    whole.result = answer(call, options);
    return whole;
  }

  // The same, as it was when the call came first.
  const Answer& known(const Call& call) {
    const auto [at, fresh] = answers_.try_emplace(call);
    if (!fresh) return at->second;
    at->second = whole_answer(call, 1);
    const TetMesh& mesh = at->second.result.mesh;
    if (!mesh.tetrahedra.empty()) meshes_.push_back(mesh);
    return at->second;
  }

  Finding repeated(const Call& call, unsigned threads) {
    const Answer& first = known(call);
    if (Finding f = judged(first.result, options_of(call.variant).approximate); !f.empty()) {
      return f;
    }
    const Answer again = whole_answer(call, threads);
    if (Finding f = difference(first.result, again.result); !f.empty()) return f;
    return threads > 1 || again.asked == first.asked ? "" : "progress: called another time";
  }

  // Ends the run when the callback has been called so often, by the answer no or by an exception.
  Finding interrupted(const Call& call, bool by_exception) {
    const Answer& whole = known(call);
    if (whole.asked == 0) return "progress: the callback was never called";
    const std::uint64_t last = 1 + bytes_.word() % (whole.asked + whole.asked / 8 + 1);
    std::uint64_t asked = 0;
    Options options = options_of(call.variant);
    options.progress = [&](const delmesher::Progress&) {
      if (++asked < last) return true;
      if (by_exception) throw 1;
      return false;
    };
    const Result result = answer(call, options);
    if (last > whole.asked) return difference(whole.result, result);
    if (result.status.code != StatusCode::interrupted) return "interruption: has no effect";
    if (asked != last) return "interruption: the callback is called again";
    return judged(result, options.approximate);
  }

  Finding limited(const Call& call) {
    const Result& whole = known(call).result;
    Options options = options_of(call.variant);
    options.max_vertices = 1 + bytes_.below(256);
    const Result result = answer(call, options);
    if (result.status.ok()) {
      // Where the limit ended a second run, with facets less planar, the first one's mesh stands.
      const bool second_thoughts = result.statistics.planar_limit != delmesher::Limit::none;
      return second_thoughts ? judged(result, options.approximate) : difference(whole, result);
    }
    if (result.status.code != StatusCode::limit_reached) return "limit: " + result.status.message;
    return judged(result, options.approximate);
  }

  Finding in_two_threads(const Call& one) {
    const Call other = next_call();
    const Result &first = known(one).result, &second = known(other).result;
    Result again;
    std::thread thread([&] { again = answer(one, options_of(one.variant)); });
    const Result beside = answer(other, options_of(other.variant));
    thread.join();
    if (Finding f = difference(first, again); !f.empty()) return "in a thread, " + f;
    if (Finding f = difference(second, beside); !f.empty()) return "beside a thread, " + f;
    return {};
  }

  // What is read is the mesh that was written; it takes its place among the meshes.
  Finding through_a_file() {
    constexpr const char* kNames[] = {"sequence.mesh", "sequence.msh", "sequence.vtu",
                                      "sequence.node"};
    const std::string path = (scratch() / kNames[bytes_.below(4)]).string();
    if (meshes_.empty()) return {};
    const TetMesh& mesh = meshes_[bytes_.below(static_cast<std::uint32_t>(meshes_.size()))];
    if (const auto status = delmesher::io::write_mesh(path, mesh); !status.ok()) {
      return "writer: " + status.error;
    }
    auto read = delmesher::io::read_mesh(path);
    if (!read.ok()) return "reader: " + read.error;
    // Some formats put what is inside first.
    if (read.mesh.vertices != mesh.vertices || sorted(read.mesh) != sorted(mesh)) {
      return "reader: another mesh than was written";
    }
    if (meshes_.size() < 256) meshes_.push_back(std::move(read.mesh));
    return {};
  }

  Finding checked() {
    const std::uint32_t s = bytes_.below(static_cast<std::uint32_t>(surfaces_.size()));
    const delmesher::SurfaceReport report = delmesher::check_surface(surfaces_[s]);
    if (!report.status.ok()) return "check: " + report.status.message;
    const auto numbers = std::tuple(report.facets, report.acute_edges, report.planar_facets,
                                    report.smallest_local_feature_size, report.volume);
    const auto [at, fresh] = reports_.try_emplace(s, numbers);
    return fresh || at->second == numbers ? "" : "check: another report for the same surface";
  }

  Bytes bytes_;
  std::string last_;
  std::vector<Surface> surfaces_;
  std::vector<TetMesh> meshes_;
  std::map<Call, Answer> answers_;
  std::map<std::uint32_t, std::tuple<std::uint64_t, std::uint64_t, std::uint64_t, double, double>>
      reports_;
};

}  // namespace

Finding sequences_hold(Bytes bytes) {
  judging({&no_surface, &nothing_made});
  return Sequence(bytes).run();
}

}  // namespace tetproof::fuzz
