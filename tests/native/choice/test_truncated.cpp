#include "choice/truncated.h"

#include <gtest/gtest.h>

#include "choice/turned_parts.h"
#include "mesh/components.h"
#include "mesh/make_surface.h"

namespace holomorph::choice {
namespace {

TEST(Truncated, IsTheSameSurface) {
  const PartPointer pyramid = turned_part({{0, 2}, {1, 0}, {0, -0.5}}, 5);
  for (const std::vector<int>& cut : {std::vector<int>{0, 6}, {0}, {0, 1}, {1, 3, 6}}) {  // next to each other, too
    const Truncation made = truncated(pyramid->surface->polygons, cut);
    Execution execution(1);
    const mesh::Surface surface = mesh::make_surface(made.polygons, execution);
    EXPECT_NEAR(mesh::area(surface, execution.workers()), pyramid->area, 1e-12 * pyramid->area);
    EXPECT_EQ(mesh::euler_characteristic(surface), 2);
    EXPECT_EQ(mesh::boundary_count(surface), 0);
    EXPECT_EQ(made.cut.size(), made.covers.size());
    EXPECT_EQ(made.first.size(), pyramid->surface->polygons.corner_vertices.size());
  }
}

}  // namespace
}  // namespace holomorph::choice
