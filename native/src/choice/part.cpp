#include "choice/part.h"

#include <utility>

namespace holomorph::choice {

PartPointer part_of(std::shared_ptr<const mesh::Surface> surface, uv::Up up, std::vector<int> labels,
                    Execution& execution) {
  const mesh::TopologicalType type = mesh::topological_type(*surface);
  const double area = mesh::area(*surface, execution.workers());
  return std::make_shared<const Part>(Part{std::move(surface), up, std::move(labels), type, area});
}

}  // namespace holomorph::choice
