#include "oracles/files/xml_text.h"

#include <expat.h>

#include <algorithm>
#include <cstdint>
#include <exception>
#include <limits>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>

#include "oracles/base/text_reader.h"

namespace tetproof::oracles {
namespace {

class XmlReader {
 public:
  XmlReader(const std::string& name, std::string_view last, std::uint64_t most)
      : name_(name), last_(last), most_(most), parser_(XML_ParserCreate(nullptr)) {
    if (parser_ == nullptr) throw std::bad_alloc();
    XML_SetUserData(parser_.get(), this);
    XML_SetElementHandler(
        parser_.get(),
        [](void* self, const char* element, const char** attributes) {
          of(self).guarded([&](XmlReader& p) { p.begin(element, attributes); });
        },
        [](void* self, const char*) { of(self).finish(); });
    XML_SetCharacterDataHandler(parser_.get(), [](void* self, const char* text, int size) {
      XmlReader& reader = of(self);
      if (reader.open_.empty() || reader.open_.back()->children.empty()) return;
      const std::string_view behind(text, static_cast<std::size_t>(size));
      if (behind.find_first_not_of(" \t\r\n") == std::string_view::npos) return;
      reader.open_.back()->has_text_behind_child = true;
    });
    XML_SetStartDoctypeDeclHandler(
        parser_.get(), [](void* self, const char*, const char*, const char*, int) {
          of(self).guarded([](XmlReader& p) { p.fail("a document type, which is not read"); });
        });
  }

  // Returns where the XML ends.
  std::size_t read(std::string_view text) {
    // Expat has a copy of a piece, whose size is an int; what is cut is read from its start again.
    constexpr std::size_t kPiece = 1U << 26U;
    for (std::size_t at = 0;; at += kPiece) {
      const std::string_view piece = text.substr(at, kPiece);
      const bool is_last = text.size() - at <= kPiece;
      const XML_Status status =
          XML_Parse(parser_.get(), piece.data(), static_cast<int>(piece.size()), is_last ? 1 : 0);
      if (error_ != nullptr) std::rethrow_exception(error_);
      if (end_ != 0) return end_;
      if (status != XML_STATUS_OK) {
        const XML_Error code = XML_GetErrorCode(parser_.get());
        if (code == XML_ERROR_NO_MEMORY) throw std::bad_alloc();
        fail(XML_ErrorString(code));
      }
      if (is_last) return text.size();
    }
  }

  XmlElement take() { return std::move(top_); }

 private:
  static XmlReader& of(void* self) { return *static_cast<XmlReader*>(self); }

  [[noreturn]] void fail(const std::string& reason) const {
    throw ReadError(name_ + ":" + std::to_string(XML_GetCurrentLineNumber(parser_.get())) + ": " +
                    reason);
  }

  // Expat is written in C: no exception may go through it.
  template <class Action>
  void guarded(const Action& action) {
    try {
      if (error_ == nullptr) action(*this);
    } catch (...) {
      error_ = std::current_exception();
      XML_StopParser(parser_.get(), XML_FALSE);
    }
  }

  void begin(const char* name, const char** attributes) {
    if (open_.size() == 64) fail("elements within elements, 64 deep");
    if (++elements_ > most_) fail("more than a million elements");
    XmlElement& element =
        open_.empty() ? top_ : open_.back()->children.emplace_back();  // never moved while open
    element.name = name;
    for (; *attributes != nullptr; attributes += 2) {
      element.attributes.emplace(attributes[0], attributes[1]);
    }
    element.begin = element.end =
        position() + static_cast<std::size_t>(XML_GetCurrentByteCount(parser_.get()));
    if (open_.size() == 1 && !last_.empty() && element.name == last_) {
      end_ = element.begin;
      XML_StopParser(parser_.get(), XML_FALSE);
    }
    open_.push_back(&element);
  }

  void finish() {
    if (error_ != nullptr) return;  // perhaps of an element that was not begun
    open_.back()->end = std::max(open_.back()->begin, position());  // <a/> has one tag
    open_.pop_back();
  }

  // How far Expat has come.
  std::size_t position() const {
    return static_cast<std::size_t>(XML_GetCurrentByteIndex(parser_.get()));
  }

  struct Free {
    void operator()(XML_Parser parser) const { XML_ParserFree(parser); }
  };

  const std::string& name_;
  std::string_view last_;
  std::uint64_t most_, elements_ = 0;
  std::unique_ptr<std::remove_pointer_t<XML_Parser>, Free> parser_;
  XmlElement top_;
  std::vector<XmlElement*> open_;
  std::exception_ptr error_;
  std::size_t end_ = 0;
};

}  // namespace

const std::string* XmlElement::attribute(const std::string& key) const {
  const auto found = attributes.find(key);
  return found == attributes.end() ? nullptr : &found->second;
}

std::string XmlElement::value(const std::string& key) const {
  const std::string* found = attribute(key);
  return found == nullptr ? std::string() : *found;
}

std::vector<const XmlElement*> XmlElement::all(const std::string& wanted) const {
  std::vector<const XmlElement*> found;
  for (const XmlElement& child : children) {
    if (child.name == wanted) found.push_back(&child);
  }
  return found;
}

XmlElement read_xml(const std::string& name, std::string_view text) {
  XmlReader reader(name, {}, std::numeric_limits<std::uint64_t>::max());
  reader.read(text);
  return reader.take();
}

XmlElement read_xml_until(const std::string& name, std::string_view text, std::string_view last,
                          std::size_t& end) {
  XmlReader reader(name, last, 1000000);
  end = reader.read(text);
  return reader.take();
}

}  // namespace tetproof::oracles
