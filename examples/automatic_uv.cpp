// automatic_uv MESH: the map that the button of the add-on makes of a connected mesh: of which kind it is, what an eye
// minds of it, and its UVs.
#include <holomorph/holomorph.h>

#include <iomanip>
#include <iostream>

int main(int argc, char** argv) try {
  if (argc != 2) throw holomorph::Error("usage: automatic_uv MESH");
  holomorph::Execution execution;
  const auto whole = holomorph::mesh::make_surface(holomorph::mesh::read(argv[1]), execution);
  const auto surface =
      std::make_shared<holomorph::mesh::Surface>(holomorph::mesh::component(whole, 0, execution).surface);
  const auto up = holomorph::uv::Up::kY;  // as in OBJ files
  const holomorph::choice::Request request{.part = holomorph::choice::part_of(surface, up, {}, execution)};
  const auto size = holomorph::choice::SizePolicy::of_tiles({request.part}, 0);  // as many tiles as suit it
  const auto map = holomorph::choice::automatic_map(request, size, execution);
  std::cout << std::setprecision(17) << map->why() << "; cost " << map->cost() << "\n" << map->uv() << "\n";
} catch (const holomorph::Error& error) {
  std::cerr << error.what() << "\n";
  return 1;
}
