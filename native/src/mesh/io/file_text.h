// A whole file in memory, as the readers of the formats take it.
#pragma once

#include <string>
#include <string_view>

#include "mesh/polygons.h"

namespace holomorph::mesh {

/// A file in memory and the name that errors call it by.
struct FileText {
  std::string name;
  std::string bytes;

  /// @throws InvalidMesh "name: reason"
  [[noreturn]] void fail(std::string_view reason) const;
};

}  // namespace holomorph::mesh
