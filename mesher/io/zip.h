// Archives of zip, as packages of documents are: their files by name.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "mesher/base/polling.h"

namespace delmesher::io {

bool is_zip(std::string_view bytes);

// Reads archives in one part, without passwords, whose files are stored or compressed with DEFLATE.
class ZipArchive {
 public:
  // The bytes must outlive this. Throws ParseError if they are not such an archive.
  ZipArchive(std::string_view bytes, Polling& polling);

  // Names differ by more than case, and may begin with '/', as in Open Packaging Conventions.
  bool contains(std::string_view name) const { return entries_.contains(key_of(name)); }
  // The contents of a file that is there. Throws ParseError if they are damaged, or if with what
  // was read before they are larger than files may be.
  std::string read(std::string_view name);

 private:
  struct Entry {
    std::uint32_t flags = 0, method = 0, crc = 0;
    std::uint64_t packed_size = 0, size = 0, header = 0;
  };

  static std::string key_of(std::string_view name);
  std::string_view need(std::uint64_t offset, std::uint64_t size) const;
  void read_directory();
  // Where the directory begins, and how many files it has.
  struct Directory {
    std::uint64_t offset = 0, entries = 0;
  };
  std::size_t find_end() const;
  Directory find_directory() const;
  Entry entry_at(std::uint64_t& offset, std::string& name) const;

  std::string_view bytes_;
  Polling& polling_;
  std::map<std::string, Entry> entries_;
  std::uint64_t left_;  // of bytes that may be unpacked
};

}  // namespace delmesher::io
