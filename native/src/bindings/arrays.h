// NumPy arrays in and out.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <Eigen/Core>
#include <array>
#include <cstring>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/errors.h"
#include "uv/quality.h"

namespace holomorph::bindings {

namespace py = pybind11;

template <class T>
using Contiguous = py::array_t<T, py::array::c_style | py::array::forcecast>;

/// UVs of corners, as the native core takes them.
inline Eigen::Map<const uv::UvArray> corners(const Contiguous<double>& uv) { return {uv.data(), uv.shape(0), 2}; }

inline py::array read_only(py::array array) {
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

/// A read-only view of memory that `owner` keeps alive.
template <class T, class Allocator>
py::array view(const std::vector<T, Allocator>& values, py::handle owner) {
  return read_only(py::array_t<T>(static_cast<py::ssize_t>(values.size()), values.data(), owner));
}

template <class T, std::size_t N, class Allocator>
py::array view(const std::vector<std::array<T, N>, Allocator>& rows, py::handle owner) {
  const auto* data = rows.empty() ? nullptr : rows.front().data();
  return read_only(py::array_t<T>({static_cast<py::ssize_t>(rows.size()), static_cast<py::ssize_t>(N)}, data, owner));
}

/// A read-only copy of a dense matrix, C-contiguous.
template <class Derived>
py::array copy(const Eigen::MatrixBase<Derived>& matrix) {
  using T = typename Derived::Scalar;
  py::array_t<T> array({matrix.rows(), matrix.cols()});
  Eigen::Map<Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(array.mutable_data(), matrix.rows(),
                                                                                matrix.cols()) = matrix;
  return read_only(std::move(array));
}

template <class T, class Allocator>
py::array copy(const std::vector<T, Allocator>& values) {
  return read_only(py::array_t<T>(static_cast<py::ssize_t>(values.size()), values.data()));
}

/// The same for rows of N values.
template <class T, std::size_t N, class Allocator>
py::array copy_rows(const std::vector<std::array<T, N>, Allocator>& rows) {
  py::array_t<T> array({static_cast<py::ssize_t>(rows.size()), static_cast<py::ssize_t>(N)});
  if (!rows.empty()) std::memcpy(array.mutable_data(), rows.data(), rows.size() * sizeof(rows[0]));
  return read_only(std::move(array));
}

/// A read-only array of the values that a vector or matrix holds, without copying them.
template <class Container>
py::array give(Container&& values, std::vector<py::ssize_t> shape) {
  using Values = std::remove_reference_t<Container>;
  using T = std::remove_const_t<std::remove_reference_t<decltype(*values.data())>>;
  auto kept = std::make_unique<Values>(std::forward<Container>(values));
  const T* data = kept->data();
  const py::capsule owner(kept.release(), [](void* held) { delete static_cast<Values*>(held); });
  return read_only(py::array_t<T>(std::move(shape), data, owner));
}

template <class T, class Allocator>
py::array give(std::vector<T, Allocator>&& values) {
  const auto size = static_cast<py::ssize_t>(values.size());
  return give(std::move(values), {size});
}

/// The same for a matrix, its shape as it is.
template <class Matrix>
py::array give_matrix(Matrix&& matrix) {
  const py::ssize_t rows = matrix.rows(), columns = matrix.cols();
  return give(std::forward<Matrix>(matrix), {rows, columns});
}

/// Rows of N values; the facade has checked the shape.
template <class T, std::size_t N>
std::vector<std::array<T, N>> rows(const Contiguous<T>& array) {
  std::vector<std::array<T, N>> result(static_cast<std::size_t>(array.size()) / N);
  if (!result.empty()) std::memcpy(result.data(), array.data(), result.size() * sizeof(std::array<T, N>));
  return result;
}

template <class T>
std::vector<T> values(const Contiguous<T>& array) {
  return std::vector<T>(array.data(), array.data() + array.size());
}

}  // namespace holomorph::bindings
