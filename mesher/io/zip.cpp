#include "mesher/io/zip.h"

#include <algorithm>

#include "mesher/io/binary.h"
#include "mesher/io/inflate.h"
#include "mesher/io/reading.h"
#include "mesher/io/text.h"

namespace delmesher::io {
namespace {

constexpr std::string_view kFileMark("PK\x03\x04", 4), kEntryMark("PK\x01\x02", 4),
    kEndMark("PK\x05\x06", 4), kWideEndMark("PK\x06\x06", 4), kLocatorMark("PK\x06\x07", 4);
constexpr std::size_t kEndSize = 22, kLocatorSize = 20, kWideEndSize = 56, kLongestComment = 65535;
constexpr std::size_t kEntrySize = 46, kFileSize = 30;

std::uint32_t number16(std::string_view bytes, std::size_t at) {
  return number_from<std::uint16_t>(bytes.substr(at, 2));
}
std::uint32_t number32(std::string_view bytes, std::size_t at) {
  return number_from<std::uint32_t>(bytes.substr(at, 4));
}
std::uint64_t number64(std::string_view bytes, std::size_t at) {
  return number_from<std::uint64_t>(bytes.substr(at, 8));
}

// The field of extra data with the numbers of 64 bits; empty if there is none.
std::string_view wide_numbers(std::string_view extra) {
  while (extra.size() >= 4) {
    const std::size_t size = std::min<std::size_t>(number16(extra, 2), extra.size() - 4);
    if (number16(extra, 0) == 1) return extra.substr(4, size);
    extra.remove_prefix(4 + size);
  }
  return {};
}

// A number of an entry; if it does not fit 32 bits, the next of the wide ones.
std::uint64_t number_of(std::string_view entry, std::size_t at, std::string_view& wide) {
  const std::uint32_t number = number32(entry, at);
  if (number != 0xffffffffU || wide.size() < 8) return number;
  const std::uint64_t value = number64(wide, 0);
  wide.remove_prefix(8);
  return value;
}

}  // namespace

bool is_zip(std::string_view bytes) {
  return bytes.starts_with(kFileMark);
}

ZipArchive::ZipArchive(std::string_view bytes, Polling& polling)
    : bytes_(bytes), polling_(polling), left_(kMaxFileBytes) {
  read_directory();
}

std::string ZipArchive::key_of(std::string_view name) {
  std::string key(name.substr(name.starts_with('/') ? 1 : 0));
  for (char& c : key) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return key;
}

std::string_view ZipArchive::need(std::uint64_t offset, std::uint64_t size) const {
  if (offset > bytes_.size() || size > bytes_.size() - offset) {
    fail(at_byte(bytes_.size()), "the archive is damaged, or cut");
  }
  return bytes_.substr(offset, size);
}

// Where the end of the directory is, behind which there is a comment of any length, to the end of
// the archive.
std::size_t ZipArchive::find_end() const {
  for (std::size_t left = bytes_.size(); left >= kEndSize;) {
    const std::size_t at = bytes_.rfind(kEndMark, left - kEndSize);
    if (at == std::string_view::npos || bytes_.size() - at > kEndSize + kLongestComment) break;
    if (at + kEndSize + number16(bytes_, at + 20) == bytes_.size()) return at;
    left = at + kEndSize - 1;
  }
  fail(at_byte(bytes_.size()), "the archive is cut: its directory is missing");
}

ZipArchive::Directory ZipArchive::find_directory() const {
  const std::size_t last = find_end();
  const std::string_view end = need(last, kEndSize);
  Directory directory = {number32(end, 16), number16(end, 10)};
  const bool divided =
      number16(end, 4) != number16(end, 6) || number16(end, 8) != number16(end, 10);
  const bool wide =
      last >= kLocatorSize && bytes_.substr(last - kLocatorSize).starts_with(kLocatorMark);
  if (wide) {
    const std::uint64_t at = number64(bytes_, last - kLocatorSize + 8);
    const std::string_view wide_end = need(at, kWideEndSize);
    if (!wide_end.starts_with(kWideEndMark)) fail(at_byte(at), "the archive is damaged");
    directory = {number64(wide_end, 48), number64(wide_end, 32)};
  } else if (divided) {
    fail(at_byte(last), "an archive in several parts");
  }
  return directory;
}

ZipArchive::Entry ZipArchive::entry_at(std::uint64_t& offset, std::string& name) const {
  const std::string_view head = need(offset, kEntrySize);
  if (!head.starts_with(kEntryMark))
    fail(at_byte(offset), "the directory of the archive is damaged");
  const std::uint32_t name_size = number16(head, 28), extra_size = number16(head, 30);
  name = need(offset + kEntrySize, name_size);
  std::string_view wide = wide_numbers(need(offset + kEntrySize + name_size, extra_size));
  Entry entry;
  entry.flags = number16(head, 8);
  entry.method = number16(head, 10);
  entry.crc = number32(head, 16);
  entry.size = number_of(head, 24, wide);
  entry.packed_size = number_of(head, 20, wide);
  entry.header = number_of(head, 42, wide);
  offset += kEntrySize + name_size + extra_size + number16(head, 32);
  return entry;
}

void ZipArchive::read_directory() {
  Directory directory = find_directory();
  for (; directory.entries > 0; --directory.entries) {
    polling_.poll(100);
    const std::uint64_t at = directory.offset;
    std::string name;
    const Entry entry = entry_at(directory.offset, name);
    if (!entries_.try_emplace(key_of(name), entry).second) {
      fail(at_byte(at), "two files of the name " + in_quotes(name));
    }
  }
}

std::string ZipArchive::read(std::string_view name) {
  const Entry& entry = entries_.at(key_of(name));
  if ((entry.flags & 1U) != 0) fail(at_byte(entry.header), in_quotes(name) + " is encrypted");
  if (entry.method != 0 && entry.method != 8) {
    fail(at_byte(entry.header), in_quotes(name) + " is compressed in an unknown manner");
  }
  if (entry.size > left_) fail({}, in_quotes(name) + " is too large when it is unpacked");
  const std::string_view head = need(entry.header, kFileSize);
  if (!head.starts_with(kFileMark)) fail(at_byte(entry.header), "the archive is damaged");
  const std::uint64_t begin = entry.header + kFileSize + number16(head, 26) + number16(head, 28);
  const std::string_view packed = need(begin, entry.packed_size);
  std::string contents;
  if (entry.method == 0) {
    polling_.poll(packed.size());
    contents = packed;
  } else {
    try {
      contents = unpacked(packed, Wrapping::none, entry.size, polling_);
    } catch (const ParseError& error) {
      fail(at_byte(begin + error.position.number), in_quotes(name) + ": " + error.reason);
    }
  }
  if (contents.size() != entry.size || crc32_of(contents) != entry.crc) {
    fail(at_byte(begin), in_quotes(name) + " is damaged: its checksum differs");
  }
  left_ -= contents.size();
  return contents;
}

}  // namespace delmesher::io
