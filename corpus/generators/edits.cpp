#include "corpus/generators/edits.h"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "corpus/generators/approach.h"
#include "corpus/generators/certify.h"
#include "corpus/generators/shapes.h"

namespace tetproof {
namespace {

using delmesher::Surface;
using shapes::Point;

struct Traits : OpenMesh::DefaultTraitsDouble {
  VertexAttributes(OpenMesh::Attributes::Status);
  EdgeAttributes(OpenMesh::Attributes::Status);
  HalfedgeAttributes(OpenMesh::Attributes::Status);
  FaceAttributes(OpenMesh::Attributes::Status);
};
using Mesh = OpenMesh::TriMesh_ArrayKernelT<Traits>;
using Vector = Mesh::Point;

Mesh to_mesh(const Surface& surface) {
  Mesh mesh;
  for (const Point& p : surface.vertices) mesh.add_vertex(Vector(p[0], p[1], p[2]));
  for (const auto& [a, b, c] : surface.triangles) {
    mesh.add_face(Mesh::VertexHandle(static_cast<int>(a)), Mesh::VertexHandle(static_cast<int>(b)),
                  Mesh::VertexHandle(static_cast<int>(c)));
  }
  mesh.delete_isolated_vertices();
  mesh.garbage_collection();
  return mesh;
}

Surface to_surface(Mesh& mesh) {
  mesh.garbage_collection();
  Surface surface;
  for (const auto v : mesh.vertices()) {
    const Vector& p = mesh.point(v);
    surface.vertices.push_back({p[0], p[1], p[2]});
  }
  for (const auto f : mesh.faces()) {
    std::array<std::uint32_t, 3> t{};
    std::size_t i = 0;
    for (const auto v : mesh.fv_range(f)) t[i++ % 3] = static_cast<std::uint32_t>(v.idx());
    surface.triangles.push_back(t);
  }
  return surface;
}

template <class Handle>
Handle random_handle(std::size_t count, Random& random) {
  return Handle(static_cast<int>(random.below(count)));
}

Vector area_normal(const Mesh& mesh, Mesh::FaceHandle f) {
  auto v = mesh.cfv_iter(f);
  const Vector a = mesh.point(*v), b = mesh.point(*++v), c = mesh.point(*++v);
  return (b - a) % (c - a);
}

// Sum of the area normals around a vertex, as long as the longest edge there.
Vector vertex_normal(const Mesh& mesh, Mesh::VertexHandle v) {
  Vector normal(0, 0, 0);
  double longest = 0;
  for (const auto f : mesh.vf_range(v)) normal += area_normal(mesh, f);
  for (const auto w : mesh.vv_range(v))
    longest = std::max(longest, (mesh.point(w) - mesh.point(v)).norm());
  const double length = normal.norm();
  return length > 0 && std::isfinite(length) ? normal * (longest / length) : Vector(0, 0, 0);
}

void flip_edge(Mesh& mesh, Random& random, int) {
  const auto e = random_handle<Mesh::EdgeHandle>(mesh.n_edges(), random);
  if (mesh.is_flip_ok(e)) mesh.flip(e);
}

void split_edge(Mesh& mesh, Random& random, int bits) {
  const auto e = random_handle<Mesh::EdgeHandle>(mesh.n_edges(), random);
  const auto h = mesh.halfedge_handle(e, 0);
  const Vector a = mesh.point(mesh.from_vertex_handle(h)), b = mesh.point(mesh.to_vertex_handle(h));
  const double share = random.chance(0.5) ? 0.5 : random.tiny(bits);
  mesh.split(e, a + (b - a) * share);
}

void collapse_edge(Mesh& mesh, Random& random, int) {
  const auto h = random_handle<Mesh::HalfedgeHandle>(mesh.n_halfedges(), random);
  if (mesh.n_faces() > 4 && mesh.is_collapse_ok(h)) mesh.collapse(h);
}

// A new vertex over (or under) a triangle.
void raise_face(Mesh& mesh, Random& random, int bits) {
  const auto f = random_handle<Mesh::FaceHandle>(mesh.n_faces(), random);
  auto v = mesh.cfv_iter(f);
  const Vector a = mesh.point(*v), b = mesh.point(*++v), c = mesh.point(*++v);
  const Vector normal = (b - a) % (c - a);
  const double length = normal.norm(), size = std::sqrt(length);
  const double s = random.between(0.1, 0.9), t = random.between(0.1, 0.9) * (1 - s);
  Vector p = a + (b - a) * s + (c - a) * t;
  if (length > 0 && random.chance(0.7))
    p += normal * (random.sign() * random.thin(bits) * size / length);
  mesh.split(f, p);
}

// The triangle becomes the end of a post, made by three splits of the face.
void extrude_face(Mesh& mesh, Random& random, int bits) {
  const auto f = random_handle<Mesh::FaceHandle>(mesh.n_faces(), random);
  Surface surface = to_surface(mesh);
  const auto base = surface.triangles[static_cast<std::size_t>(f.idx())];
  const Vector normal = area_normal(mesh, f);
  const double length = normal.norm();
  if (!(length > 0)) return;
  const Vector up = normal * (random.sign() * random.thin(bits) * std::sqrt(length) / length);
  const Vector middle = mesh.calc_face_centroid(f);
  const double shrink = random.chance(0.5) ? 1 : random.between(0.2, 0.9);
  std::array<std::uint32_t, 3> top;
  for (std::size_t i = 0; i < 3; ++i) {
    const Point& q = surface.vertices[base[i]];
    const Vector p = middle + (Vector(q[0], q[1], q[2]) - middle) * shrink + up;
    top[i] = static_cast<std::uint32_t>(surface.vertices.size());
    surface.vertices.push_back({p[0], p[1], p[2]});
  }
  surface.triangles[static_cast<std::size_t>(f.idx())] = top;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    surface.triangles.push_back({base[i], base[j], top[j]});
    surface.triangles.push_back({base[i], top[j], top[i]});
  }
  mesh = to_mesh(surface);
}

// From this many bits on a nudge may be of ulps, below of small steps.
constexpr int kUlps = 36;

void nudge_vertex(Mesh& mesh, Random& random, int bits) {
  const auto v = random_handle<Mesh::VertexHandle>(mesh.n_vertices(), random);
  Vector p = mesh.point(v);
  switch (random.below(3)) {
    case 0:
      p += vertex_normal(mesh, v) * (random.sign() * random.thin(bits));
      break;
    case 1: {
      const auto w = *mesh.cvv_iter(v);
      p += (mesh.point(w) - p) * (random.sign() * random.tiny(bits));
      break;
    }
    default:
      // Zeros stay: no mesher with double coordinates can resolve 5e-324 beside them.
      for (int i = 0; i < 3; ++i) {
        const int steps = random.integer(-3, 3);
        if (bits < kUlps) {
          p[i] += std::ldexp(p[i] * steps, -bits);
        } else if (p[i] != 0) {
          p[i] = shapes::ulps_away(p[i], steps);
        }
      }
      break;
  }
  mesh.set_point(v, p);
}

constexpr void (*kMeshEdits[])(Mesh&, Random&, int) = {
    flip_edge, split_edge, collapse_edge, raise_face, extrude_face, nudge_vertex, nudge_vertex};

double random_value_between(const Surface& surface, std::size_t axis, Random& random) {
  const Point& p = surface.vertices[random.below(surface.vertices.size())];
  const Point& q = surface.vertices[random.below(surface.vertices.size())];
  return p[axis] + (q[axis] - p[axis]) * random.between(0.05, 0.95);
}

bool same(const Surface& s, const Surface& t) {
  return s.vertices == t.vertices && s.triangles == t.triangles;
}

// The closed loops of a set of directed edges, each vertex with one edge out.
std::vector<std::vector<std::uint32_t>> loops_of(std::map<std::uint32_t, std::uint32_t> next) {
  std::vector<std::vector<std::uint32_t>> loops;
  while (!next.empty()) {
    std::vector<std::uint32_t> loop;
    auto at = next.begin();
    while (at != next.end()) {
      loop.push_back(at->first);
      const std::uint32_t to = at->second;
      next.erase(at);
      at = next.find(to);
    }
    loops.push_back(std::move(loop));
  }
  return loops;
}

class Cutter {
 public:
  Cutter(const Surface& surface, int axis, double value)
      : in_(surface), axis_(static_cast<std::size_t>(axis)), value_(value) {}

  Surface result() {
    out_.vertices = in_.vertices;
    for (const auto& t : in_.triangles) cut_triangle(t);
    for (const auto& loop : loops_of(cap_)) close(loop);
    return shapes::welded(out_);
  }

 private:
  bool kept(std::uint32_t v) const { return in_.vertices[v][axis_] < value_; }

  // The point where the edge crosses the plane.
  std::uint32_t crossing(std::uint32_t a, std::uint32_t b) {
    const auto fresh = static_cast<std::uint32_t>(out_.vertices.size());
    const auto [at, added] = crossings_.emplace(std::minmax(a, b), fresh);
    if (added) {
      const Point &p = in_.vertices[std::min(a, b)], &q = in_.vertices[std::max(a, b)];
      Point x = shapes::mix(p, q, (value_ - p[axis_]) / (q[axis_] - p[axis_]));
      x[axis_] = value_;
      out_.vertices.push_back(x);
    }
    return at->second;
  }

  void cut_triangle(std::array<std::uint32_t, 3> t) {
    const int count = kept(t[0]) + kept(t[1]) + kept(t[2]);
    if (count == 3) out_.triangles.push_back(t);
    if (count == 0 || count == 3) return;
    // The corner that is alone on its side comes first.
    while (kept(t[0]) != (count == 1)) std::rotate(t.begin(), t.begin() + 1, t.end());
    const auto [a, b, c] = t;
    const std::uint32_t ab = crossing(a, b), ac = crossing(a, c);
    if (count == 1) {
      out_.triangles.push_back({a, ab, ac});
      cap_[ac] = ab;
    } else {
      out_.triangles.push_back({ab, b, c});
      out_.triangles.push_back({ab, c, ac});
      cap_[ab] = ac;
    }
  }

  void close(const std::vector<std::uint32_t>& loop) {
    if (loop.size() < 3) return;
    shapes::Polygon outline;
    for (const std::uint32_t v : loop) {
      const Point& p = out_.vertices[v];
      outline.push_back({p[(axis_ + 1) % 3], p[(axis_ + 2) % 3]});
    }
    for (const auto& [a, b, c] : shapes::triangulate(outline)) {
      out_.triangles.push_back({loop[a], loop[b], loop[c]});
    }
  }

  const Surface& in_;
  Surface out_;
  std::size_t axis_;
  double value_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> crossings_;
  std::map<std::uint32_t, std::uint32_t> cap_;  // directed as the caps see their edges
};

bool accept(Surface& surface, Surface&& changed) {
  if (same(surface, changed) || !certified_valid(changed)) return false;
  surface = std::move(changed);
  return true;
}

}  // namespace

Surface cut(const Surface& surface, int axis, double value) {
  return Cutter(surface, axis, value).result();
}

bool edit(Surface& surface, Random& random, int bits) {
  constexpr std::size_t kMeshKinds = std::size(kMeshEdits);
  const std::size_t kind = random.below(kMeshKinds + 2);
  if (kind == kMeshKinds) return pull_near(surface, random, bits);
  if (kind == kMeshKinds + 1) {
    const auto axis = static_cast<std::size_t>(random.below(3));
    const double value = random_value_between(surface, axis, random);
    return accept(surface, cut(surface, static_cast<int>(axis), value));
  }
  Mesh mesh = to_mesh(surface);
  kMeshEdits[kind](mesh, random, bits);
  return accept(surface, to_surface(mesh));
}

bool combine(Surface& surface, const Surface& other, Random& random) {
  for (int attempt = 0; attempt < 4; ++attempt) {
    const double scale = random.chance(0.3) ? 1 : random.tiny(10);
    const Point& to = surface.vertices[random.below(surface.vertices.size())];
    const Point& from = other.vertices[random.below(other.vertices.size())];
    Surface part = other;
    shapes::move(part, [&](const Point& p) {
      Point q;
      for (std::size_t i = 0; i < 3; ++i) q[i] = to[i] + (p[i] - from[i]) * scale;
      return q;
    });
    const Point shift = {random.sign() * random.tiny(30), random.sign() * random.tiny(30),
                         random.sign() * random.tiny(30)};
    shapes::move(part, [&](const Point& p) {
      return Point{p[0] + shift[0], p[1] + shift[1], p[2] + shift[2]};
    });
    Surface both = surface;
    shapes::append(both, part);
    if (accept(surface, std::move(both))) return true;
  }
  return false;
}

}  // namespace tetproof
