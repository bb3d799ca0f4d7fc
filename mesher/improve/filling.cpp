#include "mesher/improve/filling.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "mesher/base/epoch.h"
#include "mesher/predicates/signs_of_doubles.h"

namespace delmesher::improve {
namespace {

// How much larger a size may be per distance.
constexpr double kGrowth = 0.6;
// In sizes. The circumradius of a regular tetrahedron is 0.61 of its edges.
constexpr double kClearance = 0.6, kFacetClearance = 0.3;
// Tetrahedra with circumradii of 0.6 have few edges longer than 1.
constexpr double kOfLongest = 0.6;
// A cube whose edges are the size takes about 1.5 points.
constexpr double kMostPoints = 16;

}  // namespace

Filling::Filling(State& state, const Goals& goals, Control& control)
    : state_(state),
      goals_(goals),
      control_(control),
      version_(state.mesh.slots(), 0),
      operation_(state.mesh) {
  find_sizes();
  bound_points();
}

void Filling::find_sizes() {
  const MeshTopology& mesh = state_.mesh;
  size_.assign(mesh.vertices(), 0);
  std::vector<std::uint32_t> edges(mesh.vertices(), 0);
  for (TetId t = 0; t < mesh.slots(); ++t) {
    if (!mesh.alive(t) || !state_.counts(t)) continue;
    for (int i = 0; i < 4; ++i) {
      if (mesh.facet(t, i) == kNone) continue;
      for (int k = 0; k < 3; ++k) {
        const VertexId a = mesh.tet(t)[kFace[i][k]], b = mesh.tet(t)[kFace[i][(k + 1) % 3]];
        const double length = distance(state_.position(a), state_.position(b));
        for (const VertexId v : {a, b}) {
          size_[v] += length;
          ++edges[v];
        }
      }
    }
  }
  std::priority_queue<std::pair<double, VertexId>> from;  // the smallest size first
  for (VertexId v = 0; v < size_.size(); ++v) {
    const double mean = edges[v] > 0 ? size_[v] / edges[v] : HUGE_VAL;
    const bool inside = edges[v] == 0 && mesh.incident(v) != kNone;
    const RegionId region = inside ? mesh.region(mesh.incident(v)) : kOutside;
    size_[v] = std::min(mean, allowed_at(state_.position(v), region));
    if (edges[v] > 0) from.emplace(-size_[v], v);
  }
  // Vertices inside that are there already: as for new ones.
  while (!from.empty()) {
    const auto [size, v] = from.top();
    from.pop();
    if (-size != size_[v]) continue;
    mesh.star(v, work_);
    for (const TetId t : work_) {
      for (const VertexId w : mesh.tet(t)) {
        const double grown = size_[v] + kGrowth * distance(state_.position(v), state_.position(w));
        if (edges[w] > 0 || grown >= size_[w]) continue;
        size_[w] = grown;
        from.emplace(-grown, w);
      }
    }
  }
}

double Filling::allowed_in(RegionId region) const {
  const double longest = goals_.max_edge_in(region);
  return longest > 0 ? kOfLongest * longest : HUGE_VAL;
}

double Filling::allowed_at(const Vec3& x, RegionId region) const {
  const double allowed = allowed_in(region);
  return goals_.sizes != nullptr ? std::min(allowed, kOfLongest * goals_.sizes->at(x)) : allowed;
}

void Filling::bound_points() {
  const MeshTopology& mesh = state_.mesh;
  double sizes = 0;
  for (TetId t = 0; t < mesh.slots(); ++t) {
    if (!mesh.alive(t) || !state_.counts(t)) continue;
    const Tet& v = mesh.tet(t);
    double least = allowed_in(mesh.region(t));
    for (const VertexId w : v) least = std::min(least, size_[w]);
    const Vec3& a = state_.position(v[0]);
    const double volume =
        dot(cross(subtract(state_.position(v[1]), a), subtract(state_.position(v[2]), a)),
            subtract(state_.position(v[3]), a)) /
        6;
    sizes += 1 + std::fabs(volume) / (least * least * least);
  }
  most_points_ = kMostPoints * sizes;
}

double Filling::mean_size(TetId t) const {
  double sum = 0;
  for (const VertexId v : state_.mesh.tet(t)) sum += size_[v];
  return std::min(sum / 4, allowed_in(state_.mesh.region(t)));
}

Filling::Circumcentre Filling::circumcentre(TetId t) const {
  const Tet& v = state_.mesh.tet(t);
  const Vec3& a = state_.position(v[0]);
  const Vec3 b = subtract(state_.position(v[1]), a), c = subtract(state_.position(v[2]), a),
             d = subtract(state_.position(v[3]), a);
  const Vec3 cd = cross(c, d), db = cross(d, b), bc = cross(b, c);
  const double volume = dot(b, cd);
  if (!(volume > 0)) return {};
  const double bb = dot(b, b), cc = dot(c, c), dd = dot(d, d);
  Circumcentre result;
  for (int k = 0; k < 3; ++k) {
    result.from_first[k] = (bb * cd[k] + cc * db[k] + dd * bc[k]) / (2 * volume);
  }
  result.squared_radius = dot(result.from_first, result.from_first);
  return result;
}

// Queues t if it is too large. Cavities ask for balls again and again.
void Filling::note(TetId t) {
  version_.resize(state_.mesh.slots(), 0);
  ball_.resize(state_.mesh.slots());
  ++version_[t];
  ball_[t] = circumcentre(t);
  if (!state_.counts(t)) return;
  const double size = mean_size(t);
  const double ratio = ball_[t].squared_radius / (size * size);
  if (ratio > 1 && std::isfinite(ratio)) queue_.push({ratio, t, version_[t]});
}

// The tetrahedron that x is in, by a walk from t; kNone if it meets the surface.
TetId Filling::locate(TetId t, const Vec3& x) const {
  constexpr int kMostSteps = 1000;
  const MeshTopology& mesh = state_.mesh;
  TetId from = kNone;
  for (int step = 0; step < kMostSteps; ++step) {
    int out = 0;
    while (out < 4 && ((from != kNone && mesh.neighbor(t, out) == from) || sees(t, out, x))) ++out;
    if (out == 4) return t;
    if (mesh.facet(t, out) != kNone) return kNone;
    from = t;
    t = mesh.neighbor(t, out);
    if (t == kNone) return kNone;
  }
  return kNone;
}

// Is x on the inner side of face i of t, or in its plane?
bool Filling::sees(TetId t, int i, const Vec3& x) const {
  const Tet& v = state_.mesh.tet(t);
  const auto at = [&](int k) -> const Vec3& { return k == i ? x : state_.position(v[k]); };
  return orient3d_sign(at(0), at(1), at(2), at(3)) >= 0;
}

bool Filling::is_in_ball(TetId t, const Vec3& x) const {
  const Circumcentre& c = ball_[t];
  const Vec3 y = subtract(x, state_.position(state_.mesh.tet(t)[0]));
  return c.squared_radius == 0 || dot(y, y) < 2 * dot(c.from_first, y);
}

// The cavity becomes what hangs together with `start`, with no facet between, of the tetrahedra
// that belong to it. Each is asked once.
template <class Belongs>
void Filling::collect(TetId start, const Belongs& belongs) {
  const MeshTopology& mesh = state_.mesh;
  asked_.resize(mesh.slots(), 0);
  next_epoch(asked_epoch_, asked_);
  cavity_.assign(1, start);
  asked_[start] = asked_epoch_;
  for (std::size_t n = 0; n < cavity_.size(); ++n) {
    const TetId t = cavity_[n];
    for (int i = 0; i < 4; ++i) {
      const TetId u = mesh.neighbor(t, i);
      if (u == kNone || asked_[u] == asked_epoch_ || mesh.facet(t, i) != kNone) continue;
      asked_[u] = asked_epoch_;
      if (belongs(u)) cavity_.push_back(u);
    }
  }
}

// The tetrahedra with x in their circumsphere.
void Filling::grow(TetId start, const Vec3& x) {
  collect(start, [&](TetId u) { return is_in_ball(u, x); });
}

// Takes tetrahedra out of the cavity until x sees all of its skin from inside. False if `start`
// would have to go.
bool Filling::cut_back(TetId start, const Vec3& x) {
  const MeshTopology& mesh = state_.mesh;
  mark_.resize(mesh.slots(), 0);
  next_epoch(epoch_, mark_);
  work_ = cavity_;
  for (const TetId t : work_) mark_[t] = epoch_;
  const auto is_left = [&](TetId u) { return mark_[u] == epoch_; };
  bool any = false;
  for (std::size_t n = 0; n < work_.size(); ++n) {
    const TetId t = work_[n];
    if (!is_left(t)) continue;
    const auto is_open = [&](int i) {
      const TetId u = mesh.neighbor(t, i);
      return u != kNone && is_left(u) && mesh.facet(t, i) == kNone;
    };
    const auto is_hidden = [&](int i) { return !is_open(i) && !sees(t, i, x); };
    if (!is_hidden(0) && !is_hidden(1) && !is_hidden(2) && !is_hidden(3)) continue;
    if (t == start) return false;
    mark_[t] = 0;
    any = true;
    for (int i = 0; i < 4; ++i) {
      if (is_open(i)) work_.push_back(mesh.neighbor(t, i));
    }
  }
  // What hangs together with `start` is star-shaped as well: a face on its skin is on the skin of
  // the whole.
  if (any) collect(start, is_left);
  return true;
}

double Filling::size_at(std::span<const TetId> cavity, const Vec3& x) const {
  double size = allowed_at(x, state_.mesh.region(cavity.front()));
  for (const TetId t : cavity) {
    for (const VertexId v : state_.mesh.tet(t)) {
      if (size_[v] >= size) continue;  // most, and the root takes long
      size = std::min(size, size_[v] + kGrowth * distance(x, state_.position(v)));
    }
  }
  return size;
}

bool Filling::has_room(std::span<const TetId> cavity, const Vec3& x, double size) const {
  const MeshTopology& mesh = state_.mesh;
  const double least = kClearance * size;
  for (const TetId t : cavity) {
    for (const VertexId v : mesh.tet(t)) {
      if (squared_norm(subtract(x, state_.position(v))) < least * least) return false;
    }
    for (int i = 0; i < 4; ++i) {
      if (mesh.facet(t, i) == kNone) continue;
      const Vec3 normal = state_.face_normal(t, i);
      const Vec3 from = subtract(x, state_.position(mesh.tet(t)[kFace[i][0]]));
      if (std::fabs(dot(normal, from)) < norm(normal) * kFacetClearance * size) return false;
    }
  }
  return true;
}

bool Filling::insert(TetId start, const Vec3& x) {
  // Most points are much too near: that is seen here, before there is a cavity.
  constexpr double kMuch = 0.5;
  if (!has_room({&start, 1}, x, kMuch * size_at({&start, 1}, x))) return false;
  grow(start, x);
  const double size = size_at(cavity_, x);
  if (!has_room(cavity_, x, size) || !cut_back(start, x)) return false;
  operation_.begin({kNone, kNone}, {kNone, kNone});
  for (const TetId t : cavity_) operation_.add(t, Judge());
  // All vertices stay.
  if (!operation_.find_change([](VertexId) { return false; })) return false;
  const Place place = state_.new_place(x, size * State::kGrid);
  const auto is_positive = [&](const auto& face) {
    return state_.is_positive_with(state_.mesh.tet(face.tet), face.face, place);
  };
  if (!std::ranges::all_of(operation_.skin(), is_positive)) {
    state_.forget(place);
    return false;
  }
  size_.push_back(size);
  state_.insert(place, cavity_, operation_.created());
  for (const TetId t : state_.mesh.created()) note(t);
  return true;
}

void Filling::run() {
  const auto slots = static_cast<TetId>(state_.mesh.slots());
  for (TetId t = 0; t < slots; ++t) {
    if (state_.mesh.alive(t)) note(t);
  }
  for (double points = 0; !queue_.empty() && points < most_points_;) {
    const Candidate next = queue_.top();
    queue_.pop();
    if (!state_.mesh.alive(next.tet) || version_[next.tet] != next.version) continue;
    control_.poll(state_.mesh.vertices(), 0);
    const Vec3 x = add(state_.position(state_.mesh.tet(next.tet)[0]), ball_[next.tet].from_first);
    const TetId start = locate(next.tet, x);
    if (start != kNone && insert(start, x)) ++points;
  }
}

}  // namespace delmesher::improve
