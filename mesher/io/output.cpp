#include "mesher/io/output.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "mesher/io/text.h"

namespace delmesher::io {
namespace {

namespace fs = std::filesystem;

std::string reason(int error) {
  return std::strerror(error);
}

// The file that a path means: the end of a chain of links, which need not exist.
fs::path resolve(const std::string& path) {
  std::error_code error;
  fs::path target = path;
  for (int links = 0; links < 40 && fs::is_symlink(target, error); ++links) {
    const fs::path next = fs::read_symlink(target, error);
    if (error) break;
    target = next.is_absolute() ? next : target.parent_path() / next;
  }
  return target;
}

// A name beside the target that is free now; empty if there is none.
std::string free_name_beside(const fs::path& target, const char* suffix) {
  for (int attempt = 0; attempt < 1000; ++attempt) {
    const std::string leaf =
        "." + target.filename().string().substr(0, 200) + suffix + std::to_string(attempt);
    const fs::path name = target.parent_path() / leaf;
    std::error_code error;
    if (!fs::exists(fs::symlink_status(name, error))) return name.string();
  }
  return {};
}

bool is_special(const fs::path& target) {
  std::error_code error;
  const fs::file_status status = fs::status(target, error);
  return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

// Creates a new file beside the target under a name that no other run uses.
std::FILE* create_beside(const fs::path& target, std::string& name) {
  std::FILE* file = nullptr;
  for (int attempt = 0; attempt < 1000 && file == nullptr; ++attempt) {
    const std::string leaf =
        "." + target.filename().string().substr(0, 200) + ".part" + std::to_string(attempt);
    name = (target.parent_path() / leaf).string();
    errno = 0;
    file = std::fopen(name.c_str(), "wbx");  // fails if it exists
    if (file == nullptr && errno != EEXIST) break;
  }
  return file;
}

// The folder that a file is to be in; "." if the path names none.
fs::path folder_of(const fs::path& target) {
  return target.has_parent_path() ? target.parent_path() : fs::path(".");
}

// Folders of other runs may go at any time, of those that make some and then write nothing.
constexpr int kMakingAttempts = 20;

}  // namespace

void TextSink::number(double value) {
  append_double(buffer_, value);
  flush_if_full();
}

void TextSink::hex(double value) {
  append_hex(buffer_, value);
  flush_if_full();
}

void TextSink::point(const std::array<double, 3>& p) {
  append_double(buffer_, p[0]);
  buffer_ += ' ';
  append_double(buffer_, p[1]);
  buffer_ += ' ';
  append_double(buffer_, p[2]);
  flush_if_full();
}

bool TextSink::flush() {
  if (!failed_ && std::fwrite(buffer_.data(), 1, buffer_.size(), file_) != buffer_.size()) {
    failed_ = true;
    failure_ = errno;
  }
  buffer_.clear();
  return !failed_;
}

OutputSet::~OutputSet() {
  discard();
}

void OutputSet::tell_watcher() {
  if (!watcher_) return;
  std::vector<std::string> names;
  for (const File& file : files_) {
    if (!file.temporary.empty()) names.push_back(file.temporary);
  }
  names.insert(names.end(), made_folders_.rbegin(), made_folders_.rend());
  watcher_(names);
}

void OutputSet::discard() {
  for (File& file : files_) {
    if (file.file != nullptr) std::fclose(file.file);
    if (!file.temporary.empty()) std::remove(file.temporary.c_str());
  }
  files_.clear();
  // A folder in which others have put something meanwhile stays.
  for (; !made_folders_.empty(); made_folders_.pop_back()) ::rmdir(made_folders_.back().c_str());
  tell_watcher();
}

// False with errno if it is neither there nor could be made.
bool OutputSet::make_folder(const std::string& target) {
  std::error_code error;
  std::vector<fs::path> missing;
  for (fs::path folder = folder_of(target); !fs::exists(folder, error);
       folder = folder_of(folder)) {
    missing.push_back(folder);
    if (folder == folder_of(folder)) break;
  }
  for (; !missing.empty(); missing.pop_back()) {
    made_folders_.push_back(missing.back().string());  // known before it is there, as with files
    tell_watcher();
    if (::mkdir(made_folders_.back().c_str(), 0777) == 0) continue;
    const int why = errno;
    made_folders_.pop_back();
    tell_watcher();
    if (why == EEXIST) continue;  // another run was faster
    errno = why;
    return false;
  }
  return true;
}

// Null with errno.
std::FILE* OutputSet::create(const std::string& target, std::string& temporary) {
  if (!makes_folders_) return create_beside(target, temporary);
  std::FILE* file = nullptr;
  for (int attempt = 0; attempt < kMakingAttempts && file == nullptr; ++attempt) {
    const bool there = make_folder(target);
    if (there) file = create_beside(target, temporary);
    if (file == nullptr && errno != ENOENT) break;
  }
  return file;
}

bool is_standard_stream(const std::string& path) {
  return path == "-" || (path.starts_with("-.") && path.find('/') == std::string::npos);
}

TextSink* OutputSet::open(const std::string& path, WriteStatus& status) {
  const fs::path target = resolve(path);
  std::error_code error;
  // Known before it is created, so that it does not stay should memory run out on the way.
  File& file = files_.emplace_back();
  file.path = path;
  file.target = target.string();
  errno = 0;
  if (is_standard_stream(path)) {
    file.file = ::fdopen(::dup(STDOUT_FILENO), "wb");
  } else if (fs::is_directory(target, error)) {
    errno = EISDIR;
  } else if (is_special(target)) {
    file.file = std::fopen(file.target.c_str(), "wb");
  } else {
    file.file = create(file.target, file.temporary);
  }
  if (file.file == nullptr) {
    const int why = errno;
    files_.pop_back();
    status.error = path + ": cannot write: " + reason(why);
    return nullptr;
  }
  tell_watcher();
  file.sink = std::make_unique<TextSink>(file.file);
  return file.sink.get();
}

WriteStatus OutputSet::commit() {
  WriteStatus status;
  for (File& file : files_) {
    errno = 0;
    bool flushed = file.sink->flush();
    // On the disk before it takes its name: a file that has the name after a power cut is complete.
    if (flushed && !file.temporary.empty()) {
      flushed = std::fflush(file.file) == 0 && ::fsync(::fileno(file.file)) == 0;
    }
    const int failure = file.sink->failure() != 0 ? file.sink->failure() : errno;
    const bool closed = std::fclose(file.file) == 0;
    file.file = nullptr;
    if (status.ok() && (!flushed || !closed)) {
      status.error = file.path + ": cannot write: " + reason(flushed ? errno : failure);
    }
  }
  if (status.ok()) status = put_in_place();
  if (status.ok()) made_folders_.clear();
  discard();
  return status;
}

// Renames all or, where one cannot be renamed, none: the former files are kept under other names
// until all are in place.
WriteStatus OutputSet::put_in_place() {
  WriteStatus status;
  try {
    for (File& file : files_) {
      if (file.temporary.empty()) continue;
      std::error_code error;
      if (std::error_code ignored; fs::is_regular_file(file.target, ignored)) {
        std::string former = free_name_beside(file.target, ".old");
        // A second name, so that the target is there all the time, or the only one where the file
        // system has no second names.
        fs::create_hard_link(file.target, former, error);
        if (error) fs::rename(file.target, former, error);
        if (!error) file.former = std::move(former);
      }
      if (!error) fs::rename(file.temporary, file.target, error);
      if (error) {
        status.error = file.path + ": cannot write: " + error.message();
        break;
      }
      file.placed = true;
      file.temporary.clear();
    }
  } catch (...) {  // no memory
    restore_targets();
    throw;
  }
  if (!status.ok()) {
    restore_targets();
    return status;
  }
  for (const File& file : files_) {
    if (!file.former.empty()) std::remove(file.former.c_str());
  }
  return status;
}

void OutputSet::restore_targets() noexcept {
  for (const File& file : files_) {
    if (!file.former.empty()) {
      std::rename(file.former.c_str(), file.target.c_str());
      // Two names of one file are not renamed into each other.
      if (!file.placed) std::remove(file.former.c_str());
    } else if (file.placed) {
      std::remove(file.target.c_str());
    }
  }
}

WriteStatus check_writable(const std::string& path, MissingFolder missing) {
  // Opening a special file could have effects (a pipe blocks); its turn comes when it is written.
  WriteStatus status;
  const fs::path target = resolve(path);
  if (is_special(target)) return status;
  std::error_code error;
  fs::path folder = folder_of(target);
  if (missing == MissingFolder::is_made && !fs::exists(folder, error)) {
    while (folder != folder_of(folder) && !fs::exists(folder, error)) folder = folder_of(folder);
    errno = ENOTDIR;
    if (!fs::is_directory(folder, error) || ::access(folder.c_str(), W_OK | X_OK) != 0) {
      status.error = path + ": cannot make its folder: " + folder.string() + ": " + reason(errno);
    }
    return status;
  }
  OutputSet trial;
  trial.open(path, status);
  return status;
}

}  // namespace delmesher::io
