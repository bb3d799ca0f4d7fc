#include "corpus/models/models.h"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <set>
#include <stdexcept>
#include <utility>

#include "oracles/base/text_reader.h"
#include "reports/sha256.h"

namespace tetproof {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kSmokeModels = 30, kNightlyModels = 300;
constexpr std::uint64_t kSmokeBytes = 200'000, kNightlyBytes = 5'000'000;

bool is_surface_file(const fs::path& path) {
  std::string extension = fs::path(oracles::without_gz(path.string())).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension == ".off" || extension == ".obj" || extension == ".stl" || extension == ".ply";
}

// Follows links to folders, but enters every folder once, whatever leads to it, so that a link to a
// folder above is not a cycle. Folders reached without links come first, so that names do not
// depend on the links.
class Walk {
 public:
  std::vector<fs::path> files_in(const fs::path& folder) {
    enter(folder);
    while (!links_.empty()) {
      const std::set<fs::path> links = std::exchange(links_, {});
      for (const fs::path& link : links) enter(link);
    }
    std::sort(files_.begin(), files_.end());
    return std::exchange(files_, {});
  }

 private:
  void enter(const fs::path& folder) {
    if (!entered_.insert(fs::canonical(folder)).second) return;
    std::set<fs::path> folders;
    for (const auto& entry : fs::directory_iterator(folder)) {
      std::error_code leads_nowhere;  // a link to itself, say
      if (entry.is_directory(leads_nowhere)) {
        (entry.is_symlink() ? links_ : folders).insert(entry.path());
      } else if (entry.is_regular_file(leads_nowhere) && is_surface_file(entry.path())) {
        files_.push_back(entry.path());
      }
    }
    for (const fs::path& below : folders) enter(below);
  }

  std::set<fs::path> entered_, links_;
  std::vector<fs::path> files_;
};

Model make_model(const fs::path& path, const std::string& name) {
  return {fs::absolute(path).lexically_normal(), name, sha256_of_file(path), fs::file_size(path)};
}

// The first `count` hashes of models of at most this size, in the order of the hashes.
std::set<std::string> first_by_hash(const std::vector<Model>& models, std::size_t count,
                                    std::uint64_t bytes) {
  std::set<std::string> hashes;
  for (const Model& model : models) {
    if (model.bytes <= bytes) hashes.insert(model.sha256);
  }
  while (hashes.size() > count) hashes.erase(std::prev(hashes.end()));
  return hashes;
}

}  // namespace

ModelList collect_models(const std::vector<fs::path>& paths) {
  ModelList list;
  std::set<std::string> seen;
  const auto add = [&](Model model) {
    if (seen.insert(model.sha256).second) {
      list.models.push_back(std::move(model));
    } else {
      list.duplicates.push_back(model.path);
    }
  };
  for (const fs::path& path : paths) {
    std::error_code leads_nowhere;
    if (fs::is_directory(path, leads_nowhere)) {
      const std::vector<fs::path> files = Walk().files_in(path);
      if (files.empty()) {
        throw std::runtime_error(path.string() +
                                 ": no .off, .obj, .stl or .ply file in this folder");
      }
      for (const fs::path& file : files) {
        add(make_model(file, file.lexically_relative(path).string()));
      }
    } else if (fs::is_regular_file(path, leads_nowhere)) {
      add(make_model(path, path.filename().string()));
    } else {
      throw std::runtime_error(path.string() + ": no such file or folder");
    }
  }
  return list;
}

std::vector<Model> shard_of(const std::vector<Model>& models, unsigned index, unsigned count) {
  std::vector<Model> part;
  for (const Model& model : models) {
    if (std::stoul(model.sha256.substr(0, 8), nullptr, 16) % count == index - 1) {
      part.push_back(model);
    }
  }
  return part;
}

Tier tier_from_name(const std::string& name) {
  if (name == "smoke") return Tier::smoke;
  if (name == "nightly") return Tier::nightly;
  if (name == "weekly") return Tier::weekly;
  throw std::runtime_error(name + ": smoke, nightly or weekly is expected");
}

std::vector<Model> tier_of(const std::vector<Model>& models, Tier tier) {
  if (tier == Tier::weekly) return models;
  std::set<std::string> chosen = first_by_hash(models, kSmokeModels, kSmokeBytes);
  if (tier == Tier::nightly) chosen.merge(first_by_hash(models, kNightlyModels, kNightlyBytes));
  std::vector<Model> part;
  std::copy_if(models.begin(), models.end(), std::back_inserter(part),
               [&](const Model& model) { return chosen.contains(model.sha256); });
  return part;
}

}  // namespace tetproof
