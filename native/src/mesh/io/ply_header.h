// The header of a PLY file: which elements follow, and which properties each of them has.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "mesh/io/scanner.h"

namespace holomorph::mesh::ply {

enum class Type { none, int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };

struct Property {
  std::string name;
  Type type = Type::none;
  Type count_type = Type::none;  ///< type of a list's length; none for a property that is not a list
  bool is_list() const { return count_type != Type::none; }
};

struct Element {
  std::string name;
  std::int64_t count = 0;
  std::vector<Property> properties;
};

enum class Encoding { text, little_endian, big_endian };

struct Header {
  Encoding encoding = Encoding::text;
  std::vector<Element> elements;
  std::size_t size = 0;    ///< bytes before the first element
  std::int64_t lines = 0;  ///< lines before the first element
};

bool is_real(Type type);

/// Bytes of a value in a binary file.
std::size_t size_of(Type type);

/// An index or a length that a file stores as a real. `values` reports the place of what is not an integer.
template <class Values>
std::int64_t whole_number(double value, const Values& values) {
  constexpr double largest = 9007199254740992.0;  // 2^53: beyond it, doubles skip integers
  if (!(std::abs(value) <= largest) || value != std::floor(value))
    values.fail("an integer is expected, but found " + std::to_string(value));
  return static_cast<std::int64_t>(value);
}

/// @throws InvalidMesh naming the line that is not a declaration.
Header read_header(const FileText& file);

}  // namespace holomorph::mesh::ply
