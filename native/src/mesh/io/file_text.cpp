#include "mesh/io/file_text.h"

#include "base/errors.h"

namespace holomorph::mesh {

void FileText::fail(std::string_view reason) const { throw InvalidMesh(name + ": " + std::string(reason)); }

}  // namespace holomorph::mesh
