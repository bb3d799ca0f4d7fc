// One small solid in every input format.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace delmesher::io {

inline void put_little(std::string& out, std::uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) out += static_cast<char>(value >> (8 * i) & 0xff);
}
inline void put_big(std::string& out, std::uint64_t value, int bytes) {
  for (int i = bytes; i-- > 0;) out += static_cast<char>(value >> (8 * i) & 0xff);
}

// The tetrahedron (0,0,0) (1,0,0) (0,1,0) (0,0,1).
inline constexpr std::array<std::array<int, 3>, 4> kTetPoints = {
    {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
inline constexpr std::array<std::array<int, 3>, 4> kTetFaces = {
    {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};

inline std::string tet_binary_stl(const std::string& header = "sample") {
  std::string out = header;
  out.resize(80, ' ');
  put_little(out, 4, 4);
  for (const auto& face : kTetFaces) {
    out.append(12, '\0');
    for (int v : face) {
      for (int x : kTetPoints[static_cast<std::size_t>(v)]) {
        put_little(out, std::bit_cast<std::uint32_t>(static_cast<float>(x)), 4);
      }
    }
    put_little(out, 0x1234, 2);
  }
  return out;
}

inline std::string tet_ascii_stl(int solids = 1) {
  std::string out;
  for (int s = 0; s < solids; ++s) {
    out += "solid part " + std::to_string(s) + "\n";
    for (std::size_t f = 0; f < 4; ++f) {
      if (solids > 1 && static_cast<int>(f) % solids != s) continue;
      out += "  facet normal 0 0 nan\n    outer loop\n";
      for (int v : kTetFaces[f]) {
        out += "      vertex";
        for (int x : kTetPoints[static_cast<std::size_t>(v)]) out += " " + std::to_string(x) + "e0";
        out += "\n";
      }
      out += "    endloop\n  endfacet\n";
    }
    out += "endsolid part " + std::to_string(s) + "\n";
  }
  return out;
}

inline std::string tet_off() {
  std::string out = "OFF\n# a comment\n4 4 6\n";
  for (const auto& [x, y, z] : kTetPoints) {
    out += std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) + "\n";
  }
  for (const auto& [a, b, c] : kTetFaces) {
    out += "3 " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(c) + "\n";
  }
  return out;
}

inline std::string tet_obj() {
  std::string out = "# a comment\nmtllib x.mtl\n";
  for (const auto& [x, y, z] : kTetPoints) {
    out += "v " + std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) + "\n";
  }
  out += "vn 0 0 1\nvt 0 0\nusemtl red\nf 1/1/1 3//1 2/1\nf -4 -3 -1\nusemtl blue\n";
  return out + "f 2 3 4\nf 1 \\\n 4 3\n";
}

inline std::string tet_ply(const std::string& format) {
  const bool ascii = format == "ascii", big = format == "binary_big_endian";
  std::string out = "ply\nformat " + format +
                    " 1.0\ncomment sample\nelement material 1\nproperty uchar red\n"
                    "property list uchar short names\nelement vertex 4\nproperty float x\n"
                    "property double y\nproperty int z\nproperty uchar quality\nelement face 4\n"
                    "property list uchar uint vertex_indices\nproperty short label\nend_header\n";
  const auto put = [&](std::uint64_t bits, int bytes, int plain) {
    if (ascii) {
      out += std::to_string(plain) + " ";
    } else if (big) {
      put_big(out, bits, bytes);
    } else {
      put_little(out, bits, bytes);
    }
  };
  const auto integer = [&](int value, int bytes) {
    put(static_cast<std::uint64_t>(static_cast<std::int64_t>(value)), bytes, value);
  };
  const auto line = [&] {
    if (ascii) out += "\n";
  };
  integer(7, 1);
  integer(2, 1);
  integer(-5, 2);
  integer(6, 2);
  line();
  for (const auto& [x, y, z] : kTetPoints) {
    put(std::bit_cast<std::uint32_t>(static_cast<float>(x)), 4, x);
    put(std::bit_cast<std::uint64_t>(static_cast<double>(y)), 8, y);
    integer(z, 4);
    integer(200, 1);
    line();
  }
  int label = -1;
  for (const auto& face : kTetFaces) {
    integer(3, 1);
    for (int v : face) integer(v, 4);
    integer(label++, 2);
    line();
  }
  return out;
}

inline std::string tet_smesh() {
  return "# points\n4 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n# facets\n4 1\n"
         "3 1 3 2 -7\n3 1 2 4 5\n3 2 3\n 4 5\n3 1 4 3\n0\n1\n1 .1 .1 .1 3 -1\n";
}

inline std::string tet_poly() {
  return "4 3 0 1\n0 0 0 0 9\n1 1 0 0 9\n2 0 1 0 9\n3 0 0 1 9\n4 1\n"
         "1 0 -7\n3 0 2 1\n1 0 5 # comment\n3 0 1 3\n1 0 5\n3 1 2 3\n1\n3 0 3 2\n"
         "1\n1 2 2 2\n0\n";
}

// Every format with a file name that it is known by.
inline std::vector<std::pair<std::string, std::string>> tet_samples() {
  return {{"a.off", tet_off()},
          {"a.obj", tet_obj()},
          {"ascii.stl", tet_ascii_stl()},
          {"solids.stl", tet_ascii_stl(2)},
          {"binary.stl", tet_binary_stl()},
          {"solid_binary.stl", tet_binary_stl("solid but binary")},
          {"ascii.ply", tet_ply("ascii")},
          {"little.ply", tet_ply("binary_little_endian")},
          {"big.ply", tet_ply("binary_big_endian")},
          {"a.smesh", tet_smesh()},
          {"a.poly", tet_poly()}};
}

}  // namespace delmesher::io
