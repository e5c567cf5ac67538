// The elements of a binary PLY file of either byte order, value by value.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <string>

#include "base/errors.h"
#include "mesh/io/ply_header.h"
#include "mesh/io/scanner.h"

namespace holomorph::mesh::ply {

/// Values as bytes.
template <std::endian order>
class BinaryValues {
 public:
  BinaryValues(const FileText& file, const Header& header) : file_(file), position_(header.size) {}

  static std::size_t least_bytes(const Property& p) { return size_of(p.is_list() ? p.count_type : p.type); }
  std::size_t bytes_left() const { return file_.bytes.size() - position_; }

  void enter(const Element& element) {
    element_ = &element;
    row_ = 0;
  }
  void enter_row(std::int64_t row) { row_ = row; }
  void leave_row() {}

  double real(Type type) {
    switch (type) {
      case Type::float32:
        return take<float>();
      case Type::float64:
        return take<double>();
      case Type::uint64:
        return static_cast<double>(take<std::uint64_t>());
      default:
        return static_cast<double>(integer(type));
    }
  }
  std::int64_t integer(Type type) {
    switch (type) {
      case Type::int8:
        return take<std::int8_t>();
      case Type::uint8:
        return take<std::uint8_t>();
      case Type::int16:
        return take<std::int16_t>();
      case Type::uint16:
        return take<std::uint16_t>();
      case Type::int32:
        return take<std::int32_t>();
      case Type::uint32:
        return take<std::uint32_t>();
      case Type::int64:
        return take<std::int64_t>();
      default:
        return whole_number(real(type), *this);
    }
  }
  void skip(Type type, std::int64_t values) { advance(size_of(type) * static_cast<std::size_t>(values)); }
  /// What follows the last element is not read: some writers pad. @return a sentence about anything else
  std::string finish() const {
    const auto rest = file_.bytes.begin() + static_cast<std::ptrdiff_t>(position_);
    const auto is_padding = [](char c) { return c == '\0' || c == '\n' || c == '\r' || c == ' ' || c == '\x1A'; };
    if (std::all_of(rest, file_.bytes.end(), is_padding)) return {};
    return "the file has " + std::to_string(bytes_left()) + " bytes after the last element that its header announces";
  }
  [[noreturn]] void fail(const std::string& reason) const {
    throw InvalidMesh(file_.name + ", byte " + std::to_string(position_) + ", element " + quoted(element_->name) + " " +
                      std::to_string(row_) + ": " + reason);
  }

 private:
  const char* advance(std::size_t bytes) {
    if (bytes > bytes_left()) fail("the file ends inside this element");
    const char* const here = file_.bytes.data() + position_;
    position_ += bytes;
    return here;
  }
  template <class Number>
  Number take() {
    return load_as<Number>(advance(sizeof(Number)), order);
  }

  const FileText& file_;
  std::size_t position_;
  const Element* element_ = nullptr;
  std::int64_t row_ = 0;
};

}  // namespace holomorph::mesh::ply
