// Arrays of NumPy as the library has them, for both modules of the package.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tetproof_python {

namespace py = pybind11;

// An older pybind11 misreads arrays of NumPy 2 and says nothing: labels were lost.
inline void refuse_unknown_numpy() {
#if PYBIND11_VERSION_HEX < 0x020C0000
  const auto version = py::cast<std::string>(py::module_::import("numpy").attr("__version__"));
  if (version.rfind("1.", 0) != 0) {
    throw py::import_error("NumPy " + version +
                           " is too new for the pybind11 that tetproof was built with: build it "
                           "with pybind11 2.12 or newer");
  }
#endif
}

template <class T>
using Array = py::array_t<T, py::array::c_style>;

// An array that owns what the vector owned.
template <class T>
py::array taken(std::vector<T>&& values) {
  auto* owner = new std::vector<T>(std::move(values));
  const py::capsule free(owner, [](void* p) { delete static_cast<std::vector<T>*>(p); });
  return Array<T>({static_cast<py::ssize_t>(owner->size())}, owner->data(), free);
}

template <class T, std::size_t N>
py::array taken(std::vector<std::array<T, N>>&& rows) {
  auto* owner = new std::vector<std::array<T, N>>(std::move(rows));
  const py::capsule free(owner,
                         [](void* p) { delete static_cast<std::vector<std::array<T, N>>*>(p); });
  return Array<T>({static_cast<py::ssize_t>(owner->size()), static_cast<py::ssize_t>(N)},
                  owner->empty() ? nullptr : owner->front().data(), free);
}

template <class T, std::size_t N>
std::vector<std::array<T, N>> rows_of(const Array<T>& array, const char* name) {
  if (array.ndim() != 2 || array.shape(1) != static_cast<py::ssize_t>(N)) {
    throw py::value_error(std::string(name) + " must have shape (n, " + std::to_string(N) + ")");
  }
  std::vector<std::array<T, N>> rows(static_cast<std::size_t>(array.shape(0)));
  if (!rows.empty()) std::memcpy(rows.data(), array.data(), rows.size() * sizeof rows[0]);
  return rows;
}

template <class T>
std::vector<T> values_of(const Array<T>& array, const char* name) {
  if (array.ndim() != 1) throw py::value_error(std::string(name) + " must have one dimension");
  return {array.data(), array.data() + array.size()};
}

// A number for each cell, if there are any.
template <class T>
using PerCell = std::optional<Array<T>>;
using Labels = PerCell<std::int32_t>;

template <class T>
std::vector<T> numbers_of(const PerCell<T>& numbers, const char* name, std::size_t cells,
                          const char* cell_name) {
  if (!numbers) return {};
  std::vector<T> values = values_of(*numbers, name);
  if (values.size() != cells) {
    throw py::value_error(std::to_string(values.size()) + " " + name + " for " +
                          std::to_string(cells) + " " + cell_name);
  }
  return values;
}

}  // namespace tetproof_python
