// tiled_uv MESH: a seamless tiling of a connected mesh: its poles, how far squares are sheared, how their sizes differ.
#include <holomorph/holomorph.h>

#include <cmath>
#include <iomanip>
#include <iostream>

int main(int argc, char** argv) try {
  if (argc != 2) throw holomorph::Error("usage: tiled_uv MESH");
  holomorph::Execution execution;
  const auto whole = holomorph::mesh::make_surface(holomorph::mesh::read(argv[1]), execution);
  const auto part = std::make_shared<holomorph::mesh::Surface>(holomorph::mesh::component(whole, 0, execution).surface);
  holomorph::tiling::PoleOptions poles;
  poles.evened = true;
  holomorph::tiling::TilingOptions options;
  options.tiles = 64;
  options.evenness = holomorph::uv::kUsualEvenness;
  const auto made = tile(place(part, poles, execution), options, execution);  // made.uv: #corners x 2
  const auto found = quality(made, {}, execution);
  std::cout << std::setprecision(17) << made.conformal->poles.size() << " poles, angle distortion " << found.mean_angle
            << ", size range " << std::sqrt(found.density_ratio) << ", cost " << holomorph::uv::cost(found) << "\n";
} catch (const holomorph::Error& error) {
  std::cerr << error.what() << "\n";
  return 1;
}
