#include "corpus/peers/peers.h"

#include <algorithm>
#include <string_view>

namespace tetproof {
namespace {

// Gmsh writes 16 digits, which are not always the double it had.
constexpr double kGmsh = 1e-14;

constexpr Peer gmsh(const char* name, const char* switches, const char* feature = nullptr) {
  return {.name = name,
          .adapter = "adapters/gmsh",
          .switches = switches,
          .extension = ".msh",
          .region = "interior",
          .deviation = kGmsh,
          .envelope = 0,
          .licence = "GPL-2.0",
          .from = "package gmsh",
          .program = "gmsh",
          .variable = "GMSH_PROGRAM",
          .version_option = "--version",
          .feature = feature};
}

// What a Python package promises. Arrays go in and come out, so no digit is lost on the way.
struct Promise {
  const char* region;
  double deviation = 0, envelope = 0;
};

constexpr Peer wheel(const char* name, const char* package, const char* script,
                     const char* switches, Promise promise, const char* licence) {
  return {.name = name,
          .adapter = script,
          .switches = switches,
          .extension = ".vtu",
          .region = promise.region,
          .deviation = promise.deviation,
          .envelope = promise.envelope,
          .licence = licence,
          .from = "ci/campaigns/peers",
          .program = "python3",
          .variable = "PEERS_PYTHON",
          .version_option = "--version",
          .package = package};
}

constexpr Promise kExact = {.region = "interior"};
constexpr Promise kHull = {.region = "hull"};
constexpr Promise kTetWild = {.region = "interior", .envelope = 1e-3};
// TetGen may move the surface by its default tolerance unless it is told to keep the triangles.
constexpr Promise kTetGen = {.region = "interior", .deviation = 1e-8};
// Mmg computes in the unit box, and rounds on the way there and back.
constexpr Promise kRoundTrip = {.region = "interior", .deviation = 1e-14};

// Mesh_3 bounds the distance of facets from the surface at the centres of their balls alone, and
// does not see edges below its angle, so ten times that bound is allowed everywhere.
constexpr double kMesh3 = 5e-3;
constexpr const char* kMesh3From =
    "package libcgal-dev; cmake --build BUILD --target tetproof-cgal-mesh3";

constexpr const char* kCcdtFrom =
    "CGAL 6.1 or later, by -D TETPROOF_CGAL6_INCLUDE_DIR=FOLDER where it is not the system's; "
    "cmake --build BUILD --target tetproof-cgal-ccdt";

// Without T0 TetGen may move the surface by its default tolerance. Envelopes are the defaults of
// the programs.
constexpr Peer kPeers[] = {
    {"tetgen", "tetproof-tetgen", "zpcq", ".mesh", "hull", 1e-8, 0, "AGPL-3.0",
     "package libtet1.5-dev"},
    {"tetgen-T0", "tetproof-tetgen", "zpcqT0", ".mesh", "hull", 0, 0, "AGPL-3.0",
     "package libtet1.5-dev"},
    {"netgen", "tetproof-netgen", "-", ".mesh", "interior", 0, 0, "LGPL-2.1",
     "package libnglib-dev"},
    {"netgen-raw", "tetproof-netgen", "raw", ".mesh", "interior", 0, 0, "LGPL-2.1",
     "package libnglib-dev"},
    gmsh("gmsh-delaunay", "-algo del3d"),
    gmsh("gmsh-delaunay-raw", "-algo del3d -setnumber Mesh.Optimize 0"),
    gmsh("gmsh-frontal", "-algo front3d", "Netgen"),
    gmsh("gmsh-frontal-raw", "-algo front3d -setnumber Mesh.Optimize 0", "Netgen"),
    gmsh("gmsh-hxt", "-algo hxt"),
    gmsh("gmsh-hxt-raw", "-algo hxt -setnumber Mesh.Optimize 0"),
    {"cgal-mesh3", "tetproof-cgal-mesh3", "-", ".mesh", "interior", 0, kMesh3, "GPL-3.0",
     kMesh3From},
    {"cgal-mesh3-raw", "tetproof-cgal-mesh3", "raw", ".mesh", "interior", 0, kMesh3, "GPL-3.0",
     kMesh3From},
    {"cgal-ccdt", "tetproof-cgal-ccdt", "-", ".mesh", "hull", 0, 0, "GPL-3.0", kCcdtFrom},
    wheel("tetgen-1.6", "tetgen", "adapters/wheels/tetgen_wheel.py", "pqQ", kTetGen, "AGPL-3.0"),
    wheel("tetgen-1.6-T0", "tetgen", "adapters/wheels/tetgen_wheel.py", "pcqT0Q", kExact,
          "AGPL-3.0"),
    wheel("tetgen-1.6-Y", "tetgen", "adapters/wheels/tetgen_wheel.py", "pYqQ", kExact, "AGPL-3.0"),
    wheel("gmsh-4.15-delaunay", "gmsh", "adapters/wheels/gmsh_wheel.py", "Mesh.Algorithm3D=1",
          kExact, "GPL-2.0"),
    wheel("gmsh-4.15-hxt", "gmsh", "adapters/wheels/gmsh_wheel.py", "Mesh.Algorithm3D=10", kExact,
          "GPL-2.0"),
    wheel("netgen-6.2.26", "netgen-mesher", "adapters/wheels/netgen_wheel.py", "-", kExact,
          "LGPL-2.1"),
    wheel("ftetwild", "pytetwild", "adapters/wheels/ftetwild_wheel.py",
          "epsilon=1e-3 num_threads=1", kTetWild, "MPL-2.0"),
    wheel("wildmeshing", "wildmeshing", "adapters/wheels/wildmeshing_wheel.py",
          "epsilon=1e-3 max_threads=1", kTetWild, "MPL-2.0"),
    // The paper's two experiments, and the default, which has no filter and may take very long.
    wheel("published-e4", "delmesher", "adapters/wheels/published_wheel.py",
          "lfs_exponent=4 sliver_removal=True", kHull, "LGPL-3.0"),
    wheel("published-safe-e4", "delmesher", "adapters/wheels/published_wheel.py", "lfs_exponent=4",
          kHull, "LGPL-3.0"),
    wheel("published", "delmesher", "adapters/wheels/published_wheel.py", "-", kHull, "LGPL-3.0"),
    wheel("mmg3d", "mmgpy", "adapters/wheels/mmg_wheel.py", "hausd=1e-3", kTetWild, "LGPL-3.0"),
    wheel("mmg3d-nosurf", "mmgpy", "adapters/wheels/mmg_wheel.py", "nosurf=1 optim=1", kRoundTrip,
          "LGPL-3.0"),
    {"tetwild", "adapters/tetwild", "", ".msh", "interior", 0, 1e-3, "MPL-2.0",
     "github.com/Yixin-Hu/TetWild", "TetWild", "TETWILD_PROGRAM", ""},
    {"cgal-mesh2", "tetproof-cgal-mesh2", "-", ".off", "plane", 0, 0, "GPL-3.0",
     "package libcgal-dev"},
    {"triangle", "adapters/triangle", "-pq20.7Q", ".node", "plane", 0, 0, "not free",
     "package triangle-bin", "triangle", "TRIANGLE_PROGRAM", ""},
};

}  // namespace

std::span<const Peer> peers() {
  return kPeers;
}

const Peer* peer_of(const char* name) {
  const auto found = std::find_if(std::begin(kPeers), std::end(kPeers), [&](const Peer& peer) {
    return std::string_view(peer.name) == name;
  });
  return found == std::end(kPeers) ? nullptr : found;
}

}  // namespace tetproof
