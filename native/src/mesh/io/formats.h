// The four file formats, each from a whole file in memory; `read.h` chooses among them.
#pragma once

#include <string>
#include <string_view>

#include "mesh/polygons.h"

namespace holomorph::mesh {

/// A file in memory and the name that errors call it by.
struct FileText {
  std::string name;
  std::string bytes;

  /// \throw InvalidMesh "name: reason"
  [[noreturn]] void fail(std::string_view reason) const;
};

GivenPolygons read_obj(const FileText& file);
GivenPolygons read_off(const FileText& file);
GivenPolygons read_ply(const FileText& file);
GivenPolygons read_stl(const FileText& file);

}  // namespace holomorph::mesh
