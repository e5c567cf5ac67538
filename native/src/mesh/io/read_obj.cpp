// Wavefront OBJ: `v x y z` and `f a b c ...` with a = vertex[/texture[/normal]], counted from 1, or from the end if <
// 0.
#include "mesh/io/read_obj.h"

#include <array>
#include <string>

#include "mesh/io/scanner.h"

namespace holomorph::mesh {

namespace {

struct Position {
  std::array<double, 3> point{};
  bool is_coloured = false;
};

Position position(Scanner& scan) {
  Position found;
  for (auto& x : found.point) {
    const auto word = scan.word();
    if (word.empty()) scan.fail("a vertex needs three coordinates");
    x = scan.real(word, "a coordinate");
  }
  int more = 0;  // a weight or a colour may follow, and is not a position
  while (!scan.word().empty()) ++more;
  found.is_coloured = more >= 3;
  return found;
}

std::int64_t vertex_index(const Scanner& scan, std::string_view corner, std::int64_t vertices_so_far) {
  const auto index = scan.integer(corner.substr(0, corner.find('/')), "a vertex number of the face");
  if (index > 0) return index - 1;
  if (index == 0) scan.fail("the face names vertex 0, but OBJ counts vertices from 1");
  if (index < -vertices_so_far)
    scan.fail("the face names vertex " + std::to_string(index) + ", but only " + std::to_string(vertices_so_far) +
              " vertices precede it");
  return vertices_so_far + index;
}

}  // namespace

GivenPolygons read_obj(const FileText& file) {
  file.check_encoding();
  if (file.text().find('\0') != std::string_view::npos) file.fail("an OBJ file is text, but this one has zero bytes");
  GivenPolygons mesh;
  mesh.file.first_number = 1;
  bool is_coloured = false;
  mesh.face_offsets.push_back(0);
  for (Scanner scan(file, Comments::after_hash); !scan.at_end(); scan.next_line()) {
    const auto keyword = scan.word();
    if (keyword == "v") {
      const Position found = position(scan);
      mesh.vertices.push_back(found.point);
      is_coloured |= found.is_coloured;
    } else if (keyword == "f" || keyword == "fo") {  // `fo` is what early files called a face
      const auto vertices_so_far = static_cast<std::int64_t>(mesh.vertices.size());
      for (auto corner = scan.word(); !corner.empty(); corner = scan.word())
        mesh.corner_vertices.push_back(vertex_index(scan, corner, vertices_so_far));
      mesh.face_offsets.push_back(static_cast<std::int64_t>(mesh.corner_vertices.size()));
    }
  }
  if (is_coloured) mesh.file.notes.emplace_back(kColours);
  return mesh;
}

}  // namespace holomorph::mesh
