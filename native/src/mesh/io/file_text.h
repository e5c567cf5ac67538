// A whole file in memory, as the readers of the formats take it.
#pragma once

#include <string>
#include <string_view>

#include "mesh/polygons.h"

namespace holomorph::mesh {

/// What a reader notes of a file whose vertices have colours.
inline constexpr std::string_view kColours = "the colours of its vertices are not read";

/// What a reader of PLY or OFF notes of a file with UVs.
inline constexpr std::string_view kUvs = "its UVs are not read";

/// A file in memory and the name that errors call it by.
struct FileText {
  std::string name;
  std::string bytes;

  /// The bytes of a text: without a byte order mark before it, and without zero bytes and Ctrl-Z after it.
  std::string_view text() const;

  /// @throws InvalidMesh where the text is in UTF-16, which has no format's words
  void check_encoding() const;

  /// @throws InvalidMesh "name: reason"
  [[noreturn]] void fail(std::string_view reason) const;
};

}  // namespace holomorph::mesh
