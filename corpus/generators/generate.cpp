#include "corpus/generators/generate.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <stdexcept>

#include "corpus/generators/certify.h"
#include "corpus/generators/shapes.h"
#include "corpus/generators/twins.h"

namespace tetproof {
namespace {

using delmesher::Surface;

std::uint64_t seed_of(const Family& family, std::uint64_t seed, std::uint64_t index) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char* c = family.name; *c != '\0'; ++c) {
    hash = (hash ^ static_cast<unsigned char>(*c)) * 0x100000001b3ULL;
  }
  return Random(hash ^ Random(seed).bits() ^ Random(index + 1).bits() * 3).bits();
}

void append_number(std::string& out, double value) {
  char buffer[40];
  out.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
}

void append_hex(std::string& out, double value) {
  char buffer[60];
  out += std::signbit(value) ? "-0x" : "0x";
  out.append(
      buffer,
      std::to_chars(buffer, buffer + sizeof buffer, std::fabs(value), std::chars_format::hex).ptr);
}

void write(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) throw std::runtime_error(path.string() + ": cannot be written");
}

// One folder of files and the list of them.
class Writer {
 public:
  explicit Writer(const GenerateRequest& request) : request_(request) {
    std::filesystem::create_directories(request.folder);
    if (request.twins) std::filesystem::create_directories(request.folder / "twins");
  }

  void add(const Family& family, std::uint64_t index) {
    const std::string name = std::string(family.name) + "-" + std::to_string(request_.seed) + "-" +
                             std::to_string(index);
    const auto surface = generate(family, request_.seed, index, request_.models);
    if (!surface) {
      summary_.missing.push_back(name);
      return;
    }
    record(name + ".off", family, index, *surface, 0, "");
    ++summary_.valid;
    if (!request_.twins) return;
    Random random(seed_of(family, request_.seed, index) ^ 0x7477696eULL);
    const std::vector<Twin> twins = make_twins(*surface, random);
    for (const Twin& twin : twins) {
      record("twins/" + name + "-" + twin.name + ".off", family, index, twin.surface, 4,
             reason_text(twin.reason));
      ++summary_.twins;
    }
    if (twins.size() < 4) summary_.missing.push_back(name + ": a twin");
  }

  GenerateSummary finish() {
    write(request_.folder / "manifest.csv", manifest_);
    return summary_;
  }

 private:
  void record(const std::string& file, const Family& family, std::uint64_t index,
              const Surface& surface, int exit_code, const std::string& reason) {
    std::string comment = std::string(family.name) + ", seed " + std::to_string(request_.seed) +
                          ", member " + std::to_string(index);
    if (!reason.empty()) comment += "; invalid: " + reason;
    write(request_.folder / file, to_off(surface, comment));
    manifest_ += file + "," + family.name + "," + std::to_string(request_.seed) + "," +
                 std::to_string(index) + "," + std::to_string(surface.vertices.size()) + "," +
                 std::to_string(surface.triangles.size()) + "," + std::to_string(exit_code) + "," +
                 reason + "\n";
  }

  const GenerateRequest& request_;
  GenerateSummary summary_;
  std::string manifest_ = "file,family,seed,member,vertices,triangles,expected_exit,reason\n";
};

}  // namespace

std::optional<Surface> generate(const Family& family, std::uint64_t seed, std::uint64_t index,
                                const std::vector<Surface>& models) {
  constexpr int kAttempts = 60;
  Random seeds(seed_of(family, seed, index));
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    FamilyMember member{Random(seeds.bits()), std::max(3, 50 - attempt), &models};
    Surface surface = family.make(member);
    if (surface.triangles.empty()) continue;
    if (member.random.chance(0.5)) shapes::turn(surface, member.random);
    if (certified_valid(surface)) return surface;
  }
  return {};
}

std::string to_off(const Surface& surface, const std::string& comment, bool hex) {
  std::string out = "OFF\n";
  if (!comment.empty()) out += "# " + comment + "\n";
  out += std::to_string(surface.vertices.size()) + " " + std::to_string(surface.triangles.size()) +
         " 0\n";
  for (const auto& p : surface.vertices) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (i > 0) out += ' ';
      append_number(out, p[i]);
    }
    for (std::size_t i = 0; hex && i < 3; ++i) {
      out += i == 0 ? "  # " : " ";
      append_hex(out, p[i]);
    }
    out += '\n';
  }
  for (const auto& [a, b, c] : surface.triangles) {
    out += "3 " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(c) + "\n";
  }
  return out;
}

GenerateSummary generate_files(const GenerateRequest& request) {
  Writer writer(request);
  for (const Family* family : request.families) {
    for (std::uint64_t i = 0; i < request.count; ++i) writer.add(*family, request.first + i);
  }
  return writer.finish();
}

void write_off(const std::filesystem::path& path, const Surface& surface,
               const std::string& comment, bool hex) {
  if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path());
  write(path, to_off(surface, comment, hex));
}

}  // namespace tetproof
