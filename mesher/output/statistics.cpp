#include "mesher/output/statistics.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "mesher/base/parallel.h"
#include "mesher/output/cosines.h"
#include "mesher/output/shape.h"

namespace delmesher::output {
namespace {

using Tet = std::array<std::uint32_t, 4>;
using Face = std::array<std::uint32_t, 3>;

std::size_t bin(double degrees) {
  return std::min<std::size_t>(11, static_cast<std::size_t>(degrees / 15));
}

// Angles by 15 degrees, from their cosines: no cell of width 1/32 has two of the bounds.
class CosineBins {
 public:
  CosineBins() {
    // cos 15, 30, ... 165 degrees.
    constexpr double kBound[11] = {0.9659258262890683,  0.8660254037844387,
                                   0.7071067811865476,  0.5,
                                   0.2588190451025208,  0,
                                   -0.2588190451025208, -0.5,
                                   -0.7071067811865476, -0.8660254037844387,
                                   -0.9659258262890683};
    for (int cell = 0; cell < kCells; ++cell) {
      const double top = (cell + 1) / 32.0 - 1;
      while (below_[cell] < 11 && kBound[below_[cell]] >= top) ++below_[cell];
      bound_[cell] = below_[cell] < 11 ? kBound[below_[cell]] : -2;
    }
  }
  std::size_t operator()(double cosine) const {
    const auto cell = static_cast<std::size_t>((cosine + 1) * 32);
    return below_[cell] + (cosine <= bound_[cell] ? 1 : 0);
  }

 private:
  static constexpr int kCells = 65;
  std::array<std::uint8_t, kCells> below_{};
  std::array<double, kCells> bound_{};
};

// For each tetrahedron, which of its faces an earlier one has (bit i: face i). Faces are bucketed
// by smallest vertex, so that this takes 16 bytes per tetrahedron and time linear but for sorting
// the small buckets.
std::vector<std::uint8_t> find_repeated_faces(std::span<const Tet> tetrahedra,
                                              std::size_t vertices) {
  const auto face = [&](std::uint32_t id) {
    const Tet& t = tetrahedra[id / 4];
    const auto& f = kFaces[id % 4];
    Face key{t[f[0]], t[f[1]], t[f[2]]};
    if (key[0] > key[1]) std::swap(key[0], key[1]);
    if (key[1] > key[2]) std::swap(key[1], key[2]);
    if (key[0] > key[1]) std::swap(key[0], key[1]);
    return key;
  };
  const auto count = static_cast<std::uint32_t>(4 * tetrahedra.size());
  std::vector<std::uint32_t> end(vertices + 1, 0);
  for (std::uint32_t id = 0; id < count; ++id) ++end[face(id)[0] + 1];
  for (std::size_t v = 0; v < vertices; ++v) end[v + 1] += end[v];
  std::vector<std::uint32_t> order(count);
  for (std::uint32_t id = 0; id < count; ++id) order[end[face(id)[0]]++] = id;

  std::vector<std::uint8_t> repeated(tetrahedra.size(), 0);
  std::vector<std::pair<std::array<std::uint32_t, 2>, std::uint32_t>> bucket;
  std::uint32_t begin = 0;
  for (std::size_t v = 0; v < vertices; ++v) {
    bucket.clear();
    for (std::uint32_t i = begin; i < end[v]; ++i) {
      const Face key = face(order[i]);
      bucket.push_back({{key[1], key[2]}, order[i]});
    }
    begin = end[v];
    std::sort(bucket.begin(), bucket.end());
    for (std::size_t i = 0; i < bucket.size(); ++i) {
      if (i == 0 || bucket[i].first != bucket[i - 1].first) continue;
      repeated[bucket[i].second / 4] |= static_cast<std::uint8_t>(1U << (bucket[i].second % 4));
    }
  }
  return repeated;
}

using Extremes = std::array<double, 2>;  // the smallest and the largest angle

// The 1 % quantile of a sample of known size, linear between the two nearest values. It keeps few
// values besides the lowest ones.
class LowestPercent {
 public:
  explicit LowestPercent(std::size_t size)
      : place_(0.01 * static_cast<double>(size > 0 ? size - 1 : 0)), kept_(below() + 2) {}

  void add(double value) {
    if (value >= bound_) return;
    values_.push_back(value);
    if (values_.size() < 2 * kept_) return;
    std::nth_element(values_.begin(), at(kept_ - 1), values_.end());
    values_.resize(kept_);
    bound_ = values_.back();
  }

  double value() {
    if (values_.empty()) return 0;
    std::sort(values_.begin(), values_.end());
    const double share = place_ - static_cast<double>(below());
    const double above = values_[std::min(below() + 1, values_.size() - 1)];
    return (1 - share) * values_[below()] + share * above;
  }

 private:
  std::size_t below() const { return static_cast<std::size_t>(place_); }
  std::vector<double>::iterator at(std::size_t n) {
    return values_.begin() + static_cast<std::ptrdiff_t>(n);
  }

  double place_, bound_ = INFINITY;
  std::size_t kept_;
  std::vector<double> values_;
};

// The tetrahedron with the smallest angle of a kind: given by cosines, or by degrees.
class Sharpest {
 public:
  void add_cosine(double cosine, std::size_t tetrahedron) {
    if (cosine <= cosine_) return;
    cosine_ = cosine;
    by_cosine_ = tetrahedron;
  }
  void add_degrees(double degrees, std::size_t tetrahedron) {
    if (degrees >= degrees_) return;
    degrees_ = degrees;
    tetrahedron_ = tetrahedron;
  }
  void add(const Sharpest& other) {
    double degrees = other.cosine_;
    if (degrees >= -1) {
      degrees_of_cosines({&degrees, 1});
      add_degrees(degrees, other.by_cosine_);
    }
    add_degrees(other.degrees_, other.tetrahedron_);
  }
  std::size_t tetrahedron() const { return tetrahedron_; }

 private:
  double cosine_ = -2, degrees_ = INFINITY;
  std::size_t by_cosine_ = 0, tetrahedron_ = 0;
};

// The sums over all chunks of tetrahedra, besides the statistics themselves.
struct Collected {
  explicit Collected(std::size_t tetrahedra) : dihedrals(tetrahedra), gammas(tetrahedra) {}

  std::uint64_t faces = 0;
  LowestPercent dihedrals, gammas;
  Sharpest sharpest_face, sharpest_dihedral;
};

// The angles and shapes of consecutive tetrahedra, which need no others.
class Angles {
 public:
  // Measures `count` of all tetrahedra from `first` on, in batches.
  void measure(std::span<const Vec3> coordinates, std::span<const Tet> tetrahedra,
               std::size_t first, std::size_t count, std::span<const std::uint8_t> repeated,
               const CosineBins& bins) {
    CosineBatch batch;
    const std::size_t end = first + count;
    for (std::size_t begin = first; begin < end; begin += CosineBatch::kLanes) {
      const std::size_t lanes = std::min(CosineBatch::kLanes, end - begin);
      batch.measure(coordinates, tetrahedra.subspan(begin, lanes));
      for (std::size_t l = 0; l < lanes; ++l) {
        tetrahedron_ = begin + l;
        if (batch.ordinary[l]) {
          add_cosines(batch, l, repeated[begin + l], bins);
        } else {
          add_robustly(make_shape(coordinates, tetrahedra[begin + l]), repeated[begin + l]);
        }
      }
    }
  }

  // Adds the angles up, one by one, those of the robust formulas first. Chunks do not depend on the
  // number of threads, so neither do the sums. Then empty.
  void move_to(MeshStatistics& s, Collected& all) {
    append_degrees(face_cosines_, face_);
    append_degrees(dihedral_cosines_, dihedral_);
    all.faces += face_.size();
    all.sharpest_face.add(sharpest_face_);
    all.sharpest_dihedral.add(sharpest_dihedral_);
    for (const auto& [low, high] : face_) {
      s.min_face_angle = std::min(s.min_face_angle, low);
      s.max_face_angle = std::max(s.max_face_angle, high);
      s.mean_min_face_angle += low;
      s.mean_max_face_angle += high;
    }
    for (const auto& [low, high] : dihedral_) {
      s.min_dihedral = std::min(s.min_dihedral, low);
      s.max_dihedral = std::max(s.max_dihedral, high);
      s.mean_min_dihedral += low;
      s.mean_max_dihedral += high;
      s.below_5 += low < 5 ? 1 : 0;
      s.below_10 += low < 10 ? 1 : 0;
      all.dihedrals.add(low);
    }
    for (const auto& [gamma, sicn] : quality_) {
      s.min_gamma = std::min(s.min_gamma, gamma);
      s.min_sicn = std::min(s.min_sicn, sicn);
      s.mean_gamma += gamma;
      s.mean_sicn += sicn;
      all.gammas.add(gamma);
    }
    for (std::size_t n = 0; n < face_histogram_.size(); ++n) {
      s.face_angle_histogram[n] += face_histogram_[n];
      s.dihedral_histogram[n] += dihedral_histogram_[n];
    }
    face_.clear();
    dihedral_.clear();
    quality_.clear();
    face_histogram_ = dihedral_histogram_ = {};
    sharpest_face_ = sharpest_dihedral_ = {};
  }

 private:
  void add_face(const std::array<double, 3>& angles) {
    const auto [low, high] = std::minmax({angles[0], angles[1], angles[2]});
    face_.push_back({low, high});
    sharpest_face_.add_degrees(low, tetrahedron_);
    for (const double a : angles) ++face_histogram_[bin(a)];
  }

  void add_cosines(const CosineBatch& batch, std::size_t lane, unsigned repeated,
                   const CosineBins& bins) {
    for (std::size_t f = 0; f < 4; ++f) {
      if ((repeated >> f & 1U) != 0) continue;
      const double a = batch.face[f][0][lane], b = batch.face[f][1][lane],
                   c = batch.face[f][2][lane];
      const double sharpest = std::max(std::max(a, b), c);
      sharpest_face_.add_cosine(sharpest, tetrahedron_);
      face_cosines_.push_back(sharpest);
      face_cosines_.push_back(std::min(std::min(a, b), c));
      for (const double cosine : {a, b, c}) ++face_histogram_[bins(cosine)];
    }
    double low = -1, high = 1;
    for (const auto& dihedral : batch.dihedral) {
      low = std::max(low, dihedral[lane]);
      high = std::min(high, dihedral[lane]);
      ++dihedral_histogram_[bins(dihedral[lane])];
    }
    dihedral_cosines_.push_back(low);
    dihedral_cosines_.push_back(high);
    sharpest_dihedral_.add_cosine(low, tetrahedron_);
    quality_.push_back({batch.gamma[lane], batch.sicn[lane]});
  }

  void add_robustly(const Shape& shape, unsigned repeated) {
    for (int f = 0; f < 4; ++f) {
      if ((repeated >> f & 1U) == 0) add_face(face_angles(shape, f));
    }
    add_dihedrals(dihedral_angles(shape), shape.comparable && volume_term(shape) == 0);
    quality_.push_back(quality(shape));
  }

  // Appends the smallest and the largest angles, which come in turn, and empties `cosines`.
  static void append_degrees(std::vector<double>& cosines, std::vector<Extremes>& angles) {
    degrees_of_cosines(cosines);
    for (std::size_t n = 0; n < cosines.size(); n += 2) {
      angles.push_back({cosines[n], cosines[n + 1]});
    }
    cosines.clear();
  }

  void add_dihedrals(const std::array<double, 6>& angles, bool flat) {
    // A flat tetrahedron with a degenerate face has edges without a dihedral angle.
    const double low = flat ? 0 : *std::min_element(angles.begin(), angles.end());
    const double high = flat ? 180 : *std::max_element(angles.begin(), angles.end());
    dihedral_.push_back({low, high});
    sharpest_dihedral_.add_degrees(low, tetrahedron_);
    for (const double a : angles) ++dihedral_histogram_[bin(a)];
  }

  std::size_t tetrahedron_ = 0;  // the present one
  std::vector<double> face_cosines_, dihedral_cosines_;
  std::vector<Extremes> face_, dihedral_;
  std::vector<Quality> quality_;
  Sharpest sharpest_face_, sharpest_dihedral_;
  std::array<std::uint64_t, 12> face_histogram_{}, dihedral_histogram_{};
};

// The edge with the smallest dihedral angle, and the other two vertices.
Tet sharpest_dihedral(std::span<const Vec3> coordinates, const Tet& tet) {
  const auto angles = dihedral_angles(make_shape(coordinates, tet));
  const auto e = std::min_element(angles.begin(), angles.end()) - angles.begin();
  const auto [a, b] = kEdges[e];
  const auto [c, d] = kEdges[5 - e];
  return {tet[a], tet[b], tet[c], tet[d]};
}

// The corner with the smallest face angle, and the other two vertices of the face.
Face sharpest_face_angle(std::span<const Vec3> coordinates, const Tet& tet) {
  const Shape shape = make_shape(coordinates, tet);
  double smallest = INFINITY;
  Face result{};
  for (int f = 0; f < 4; ++f) {
    const auto angles = face_angles(shape, f);
    for (int i = 0; i < 3; ++i) {
      if (angles[i] >= smallest) continue;
      smallest = angles[i];
      result = {tet[kFaces[f][i]], tet[kFaces[f][(i + 1) % 3]], tet[kFaces[f][(i + 2) % 3]]};
    }
  }
  return result;
}

void finish(MeshStatistics& s, std::span<const Vec3> coordinates, std::span<const Tet> tetrahedra,
            Collected& all) {
  if (all.faces == 0) {
    s.min_face_angle = s.min_dihedral = s.min_gamma = s.min_sicn = 0;
    return;
  }
  s.mean_min_face_angle /= static_cast<double>(all.faces);
  s.mean_max_face_angle /= static_cast<double>(all.faces);
  for (double* mean : {&s.mean_min_dihedral, &s.mean_max_dihedral, &s.mean_gamma, &s.mean_sicn}) {
    *mean /= static_cast<double>(s.tetrahedra);
  }
  s.dihedral_1_percent = all.dihedrals.value();
  s.gamma_1_percent = all.gammas.value();
  s.sharpest_dihedral =
      sharpest_dihedral(coordinates, tetrahedra[all.sharpest_dihedral.tetrahedron()]);
  s.sharpest_face_angle =
      sharpest_face_angle(coordinates, tetrahedra[all.sharpest_face.tetrahedron()]);
}

}  // namespace

MeshStatistics mesh_statistics(std::span<const Vec3> coordinates, std::span<const Tet> tetrahedra,
                               std::span<const std::uint8_t> repeated_faces, std::uint64_t vertices,
                               std::uint64_t interior, Control& control) {
  MeshStatistics statistics;
  statistics.vertices = vertices;
  statistics.tetrahedra = tetrahedra.size();
  statistics.interior_tetrahedra = interior;
  std::vector<std::uint8_t> found;
  if (repeated_faces.size() != tetrahedra.size()) {
    found = find_repeated_faces(tetrahedra, coordinates.size());
    repeated_faces = found;
  }
  // The angles of one batch take a few megabytes.
  constexpr std::size_t kChunk = 1024, kBatch = 32 * kChunk;
  statistics.min_face_angle = statistics.min_dihedral = 180;
  statistics.min_gamma = statistics.min_sicn = 1;
  const CosineBins bins;
  std::vector<Angles> angles(kBatch / kChunk);
  Collected all(tetrahedra.size());
  for (std::size_t begin = 0; begin < tetrahedra.size(); begin += kBatch) {
    const std::size_t count = std::min(kBatch, tetrahedra.size() - begin);
    for_chunks(control, count, kChunk, [&](Worker& worker, const Chunk& chunk) {
      worker.poll();
      angles[chunk.index].measure(coordinates, tetrahedra, begin + chunk.begin,
                                  chunk.end - chunk.begin, repeated_faces, bins);
      return true;
    });
    for (Angles& chunk : angles) chunk.move_to(statistics, all);
  }
  finish(statistics, coordinates, tetrahedra, all);
  return statistics;
}

}  // namespace delmesher::output
