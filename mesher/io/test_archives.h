// Archives of zip, and models in them, for tests; zlib compresses them.
#pragma once

#include <zlib.h>

#include <cstdint>
#include <string>

#include "mesher/io/binary.h"
#include "mesher/io/test_zlib.h"

namespace delmesher::io {

// As APPNOTE has it; `wide`: with the fields of 64 bits.
class Zip {
 public:
  explicit Zip(bool wide = false) : wide_(wide) {}

  Zip& add(const std::string& name, const std::string& text, bool compress = true,
           std::uint16_t flags = 0) {
    const std::string packed = compress ? packed_by_zlib(text, Wrapping::none) : text;
    const auto sum = static_cast<std::uint32_t>(
        crc32(0, reinterpret_cast<const Bytef*>(text.data()), static_cast<uInt>(text.size())));
    const std::uint64_t at = bytes_.size();
    const std::string head = of<std::uint16_t>(45) + of(flags) +
                             of<std::uint16_t>(compress ? 8 : 0) + of<std::uint32_t>(0) + of(sum) +
                             size(packed.size()) + size(text.size()) +
                             of(static_cast<std::uint16_t>(name.size()));
    bytes_ += "PK\x03\x04" + head + of<std::uint16_t>(0) + name + packed;
    std::string extra;
    if (wide_) {
      extra = of<std::uint16_t>(77) + of<std::uint16_t>(1) + "x" + of<std::uint16_t>(1) +
              of<std::uint16_t>(24) + of<std::uint64_t>(text.size()) +
              of<std::uint64_t>(packed.size()) + of(at);
    }
    directory_ += "PK\x01\x02" + of<std::uint16_t>(45) + head +
                  of(static_cast<std::uint16_t>(extra.size())) + of<std::uint16_t>(7) +
                  of<std::uint16_t>(0) + of<std::uint16_t>(0) + of<std::uint32_t>(0) + size(at) +
                  name + extra + "comment";
    ++count_;
    return *this;
  }

  std::string finish() const {
    const std::uint64_t at = bytes_.size();
    std::string all = bytes_ + directory_;
    if (wide_) {
      const std::uint64_t end = all.size();
      all += "PK\x06\x06" + of<std::uint64_t>(44) + of<std::uint32_t>(45) + of<std::uint64_t>(0) +
             of<std::uint64_t>(count_) + of<std::uint64_t>(count_) +
             of<std::uint64_t>(directory_.size()) + of(at);
      all += "PK\x06\x07" + of<std::uint32_t>(0) + of(end) + of<std::uint32_t>(1);
    }
    const auto count = static_cast<std::uint16_t>(wide_ ? 0xffff : count_);
    return all + "PK\x05\x06" + of<std::uint32_t>(0) + of(count) + of(count) +
           size(directory_.size()) + size(at) + of<std::uint16_t>(4) + "PK\x05\x06";
  }

 private:
  template <class T>
  static std::string of(T value) {
    const auto bytes = bytes_of(value);
    return {bytes.begin(), bytes.end()};
  }
  std::string size(std::uint64_t n) const {
    return of(wide_ ? 0xffffffffU : static_cast<std::uint32_t>(n));
  }

  bool wide_;
  std::string bytes_, directory_;
  std::uint16_t count_ = 0;
};

inline constexpr const char* kTypes = "<?xml version=\"1.0\"?><Types/>";
inline constexpr const char* kRelations =
    "<Relationships><Relationship Type='http://schemas.openxmlformats.org/thumbnail' "
    "Target='/x.png'/><Relationship Target=\"/3D/My.model\" Id=\"r\" "
    "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>";

inline std::string package(const std::string& model) {
  return Zip()
      .add("[Content_Types].xml", kTypes)
      .add("_rels/.rels", kRelations)
      .add("3D/My.model", model)
      .finish();
}

inline std::string mesh_in_xml(const std::string& points) {
  return "<mesh><vertices>" + points +
         "</vertices><triangles><triangle v1='0' v2='2' v3='1'/><triangle v1=\"0\" v2=\"1\" "
         "v3=\"3\" pid='1'/>\n<triangle v1='1' v2='2' v3='3'/><triangle v1='2' v2='0' v3='3'/>"
         "</triangles></mesh>";
}
inline const std::string kTet = mesh_in_xml(
    "<vertex x='0' y='0' z='0'/><vertex x='1' y='0' z='0'/><vertex x='0' y='1' z='0'/>"
    "<vertex x='0' y='0' z='0.1'/>");

inline std::string model(const std::string& resources, const std::string& build,
                         const std::string& attributes = "") {
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<!-- <vertex> -->\n"
         "<model unit=\"inch\" xml:lang=\"en-US\" " +
         attributes +
         " xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">\n<resources>\n" +
         resources + "</resources>\n<build>" + build + "</build>\n</model>\n";
}

}  // namespace delmesher::io
