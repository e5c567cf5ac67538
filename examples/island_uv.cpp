// island_uv MESH: a map of a connected mesh in flat islands: how many there are, what an eye minds of it, and its UVs.
#include <holomorph/holomorph.h>

#include <iomanip>
#include <iostream>

int main(int argc, char** argv) try {
  if (argc != 2) throw holomorph::Error("usage: island_uv MESH");
  holomorph::Execution execution;
  const auto whole = holomorph::mesh::make_surface(holomorph::mesh::read(argv[1]), execution);
  const auto part = holomorph::mesh::component(whole, 0, execution).surface;
  holomorph::flat::IslandOptions options;
  options.evenness = holomorph::uv::kUsualEvenness;
  options.up = holomorph::uv::Up::kY;  // as in OBJ files
  const auto made = holomorph::flat::island_map(part, options, execution);
  if (!made) throw holomorph::Error("no piece of the mesh may be closed");
  std::cout << std::setprecision(17) << made->islands << " " << made->cost() << "\n" << made->uv << "\n";
} catch (const holomorph::Error& error) {
  std::cerr << error.what() << "\n";
  return 1;
}
