// What Debian's libraries for WASI lack: files of std::filesystem, numbers from text, and some
// functions of POSIX. There are no links, and the working folder is the root.
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

int dup(int file) {
  return file;  // closing a standard stream does nothing
}

int getrusage(int /*who*/, struct rusage* usage) {
  struct timespec now = {};
  clock_gettime(CLOCK_MONOTONIC, &now);
  *usage = {};
  usage->ru_utime.tv_sec = now.tv_sec;
  usage->ru_utime.tv_usec = static_cast<suseconds_t>(now.tv_nsec / 1000);
  usage->ru_maxrss = static_cast<long>(__builtin_wasm_memory_size(0) * 64);
  return 0;
}

namespace std {

template class basic_filebuf<char>;
template class basic_ifstream<char>;

namespace {

bool is_digit(char c, bool hex) {
  return (c >= '0' && c <= '9') || (hex && ((c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F')));
}

// The end of what may be a number; `first` if there is none.
const char* end_of_number(const char* first, const char* last, bool hex) {
  const char* at = first;
  if (at != last && *at == '-') ++at;
  for (const string_view word : {"infinity"sv, "inf"sv, "nan"sv}) {
    size_t n = 0;
    while (n < word.size() && at + n != last && (at[n] | 0x20) == word[n]) ++n;
    if (n == word.size()) return at + n;
  }
  bool digits = false, point = false;
  for (; at != last && (is_digit(*at, hex) || (*at == '.' && !point)); ++at) {
    (*at == '.' ? point : digits) = true;
  }
  if (!digits) return first;
  if (at != last && (*at | 0x20) == (hex ? 'p' : 'e')) {
    const char* power = at + 1;
    if (power != last && (*power == '+' || *power == '-')) ++power;
    if (power != last && is_digit(*power, false)) {
      for (at = power; at != last && is_digit(*at, false);) ++at;
    }
  }
  return at;
}

// Most numbers are a whole one below 2^53 times or over a power of ten that is exact: one rounding.
// False for others.
bool simple_number(const char* first, const char* last, double& value) {
  static constexpr double kTens[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                     1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                     1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
  const bool negative = *first == '-';
  uint64_t whole = 0;
  int power = 0;
  bool point = false;
  for (first += negative ? 1 : 0; first != last && (*first | 0x20) != 'e'; ++first) {
    if (*first == '.') {
      point = true;
      continue;
    }
    if (!is_digit(*first, false)) return false;
    whole = 10 * whole + static_cast<uint64_t>(*first - '0');
    power -= point ? 1 : 0;
    if (whole >= uint64_t{1} << 53) return false;
  }
  if (first != last) {
    int given = 0;
    if (*++first == '+') ++first;
    if (from_chars(first, last, given).ptr != last || given < -400 || given > 400) return false;
    power += given;
  }
  if (power < -22 || power > 22) return false;
  value = static_cast<double>(whole);
  value = power < 0 ? value / kTens[-power] : value * kTens[power];
  if (negative) value = -value;
  return true;
}

template <class Number, class Convert>
from_chars_result number_from(const char* first, const char* last, Number& value,
                              chars_format format, const Convert& convert) {
  const bool hex = format == chars_format::hex;
  const char* end = end_of_number(first, last, hex);
  if (end == first) return {first, errc::invalid_argument};
  string text(first, end);
  if (hex) text.insert(text[0] == '-' ? 1 : 0, "0x");
  errno = 0;
  const Number read = convert(text.c_str());
  if (errno == ERANGE && (read == 0 || !isfinite(read))) return {end, errc::result_out_of_range};
  value = read;
  return {end, errc()};
}

}  // namespace

from_chars_result from_chars(const char* first, const char* last, double& value,
                             chars_format format) {
  if (format == chars_format::general) {
    const char* end = end_of_number(first, last, false);
    if (end != first && simple_number(first, end, value)) return {end, errc()};
  }
  return number_from(first, last, value, format,
                     [](const char* text) { return strtod(text, nullptr); });
}
from_chars_result from_chars(const char* first, const char* last, float& value,
                             chars_format format) {
  return number_from(first, last, value, format,
                     [](const char* text) { return strtof(text, nullptr); });
}

}  // namespace std

_LIBCPP_BEGIN_NAMESPACE_FILESYSTEM
namespace {

void report(error_code* error, int code) {
  const error_code found(code, generic_category());
  if (error != nullptr) {
    *error = found;
  } else if (code != 0) {
    throw system_error(found);
  }
}

file_status status_of(const path& file, error_code* error) {
  struct stat found = {};
  const int code = ::stat(file.c_str(), &found) == 0 ? 0 : errno;
  if (code == ENOENT || code == ENOTDIR) {
    if (error != nullptr) report(error, code);
    return file_status(file_type::not_found);
  }
  report(error, code);
  if (code != 0) return file_status(file_type::none);
  return file_status(S_ISDIR(found.st_mode)   ? file_type::directory
                     : S_ISREG(found.st_mode) ? file_type::regular
                                              : file_type::character);
}

}  // namespace

file_status __status(const path& file, error_code* error) {
  return status_of(file, error);
}
file_status __symlink_status(const path& file, error_code* error) {
  return status_of(file, error);
}
path __read_symlink(const path& file, error_code* error) {
  report(error, EINVAL);
  return file;
}
uintmax_t __file_size(const path& file, error_code* error) {
  struct stat found = {};
  const bool there = ::stat(file.c_str(), &found) == 0;
  report(error, !there ? errno : S_ISREG(found.st_mode) ? 0 : EINVAL);
  return there ? static_cast<uintmax_t>(found.st_size) : ~uintmax_t{0};
}
void __rename(const path& from, const path& to, error_code* error) {
  report(error, ::rename(from.c_str(), to.c_str()) == 0 ? 0 : errno);
}
void __create_hard_link(const path& /*file*/, const path& /*link*/, error_code* error) {
  report(error, ENOTSUP);
}
path __absolute(const path& file, error_code* error) {
  report(error, 0);
  return file.is_absolute() ? file : path("/") / file;
}
path __weakly_canonical(const path& file, error_code* error) {
  string made;
  const string text = __absolute(file, error).string() + '/';
  for (size_t at = 0, end; (end = text.find('/', at)) != string::npos; at = end + 1) {
    const string part = text.substr(at, end - at);
    if (part == "..") {
      made.resize(made.empty() ? 0 : made.rfind('/'));
    } else if (!part.empty() && part != ".") {
      made += '/' + part;
    }
  }
  return made.empty() ? path("/") : path(made);
}

_LIBCPP_END_NAMESPACE_FILESYSTEM
