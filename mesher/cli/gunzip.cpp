#include "mesher/cli/gunzip.h"

#ifdef DELMESHER_ZLIB
#include <zlib.h>

#include <algorithm>
#endif

namespace delmesher::cli {

#ifdef DELMESHER_ZLIB
namespace {

constexpr std::size_t kPiece = std::size_t{1} << 20;
constexpr int kOfGzip = 16 + MAX_WBITS;

// Unpacks one file after another, of which a file of gzip may consist.
class Unpacker {
 public:
  explicit Unpacker(std::string_view bytes) : rest_(bytes) {
    ready_ = ::inflateInit2(&stream_, kOfGzip) == Z_OK;
  }
  ~Unpacker() {
    if (ready_) ::inflateEnd(&stream_);
  }
  Unpacker(const Unpacker&) = delete;
  Unpacker& operator=(const Unpacker&) = delete;

  std::optional<std::string> unpack(std::size_t limit, const std::function<bool()>& go_on) {
    std::string out;
    while (ready_ && (!go_on || go_on())) {
      const std::size_t before = out.size();
      out.resize(before + kPiece);
      const int code = next_piece(out, before);
      if (out.size() > limit || (code != Z_OK && code != Z_STREAM_END)) return {};
      if (code == Z_OK && out.size() == before && rest_.empty()) return {};  // cut short
      if (code != Z_STREAM_END) continue;
      if (rest_.empty()) return out;
      if (::inflateReset(&stream_) != Z_OK) return {};
    }
    return {};
  }

 private:
  int next_piece(std::string& out, std::size_t before) {
    const std::size_t given = std::min<std::size_t>(rest_.size(), kPiece);
    // zlib does not write there.
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(rest_.data()));
    stream_.avail_in = static_cast<uInt>(given);
    stream_.next_out = reinterpret_cast<Bytef*>(out.data() + before);
    stream_.avail_out = static_cast<uInt>(kPiece);
    int code = ::inflate(&stream_, Z_NO_FLUSH);
    if (code == Z_BUF_ERROR) code = Z_OK;  // nothing could be done, which the caller sees
    rest_.remove_prefix(given - stream_.avail_in);
    out.resize(out.size() - stream_.avail_out);
    return code;
  }

  std::string_view rest_;
  z_stream stream_{};
  bool ready_ = false;
};

}  // namespace

io::Gunzip gunzip(const std::function<bool()>& go_on) {
  return [go_on](std::string_view bytes, std::size_t limit) {
    return Unpacker(bytes).unpack(limit, go_on);
  };
}
#else
io::Gunzip gunzip(const std::function<bool()>& /*go_on*/) {
  return nullptr;
}
#endif

}  // namespace delmesher::cli
