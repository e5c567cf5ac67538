// turned_uv MESH: a seamless tiling of a connected mesh whose sides of a cut may also turn by quarters: its cones, how
// far squares are sheared, what an eye minds of it, and its UVs.
#include <holomorph/holomorph.h>

#include <iomanip>
#include <iostream>

int main(int argc, char** argv) try {
  if (argc != 2) throw holomorph::Error("usage: turned_uv MESH");
  holomorph::Execution execution;
  const auto whole = holomorph::mesh::make_surface(holomorph::mesh::read(argv[1]), execution);
  const auto part = std::make_shared<holomorph::mesh::Surface>(holomorph::mesh::component(whole, 0, execution).surface);
  holomorph::tiling::TilerOptions options;
  options.along = {{0, 1, 0}, false};  // rows run level
  options.up = holomorph::uv::Up::kY;  // as in OBJ files
  options.rows = holomorph::tiling::Rows::kWhole;
  holomorph::tiling::TurnedTiler tiler(part, options, execution);
  const auto made = tiler.tile(tiler.usual_tiles(), holomorph::uv::kUsualEvenness, execution);
  const holomorph::uv::Marks marks{.cones = static_cast<int>(made.map.cones.size())};
  std::cout << std::setprecision(17) << marks.cones << " " << made.quality.mean_angle << " "
            << holomorph::uv::cost(made.quality, marks) << "\n"
            << made.map.uv << "\n";
} catch (const holomorph::Error& error) {
  std::cerr << error.what() << "\n";
  return 1;
}
