// Object File Format: [ST][C][N]OFF, three counts, a line per vertex that starts with x y z, then n v_1 .. v_n per
// face.
#include "mesh/io/read_off.h"

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mesh/io/scanner.h"

namespace holomorph::mesh {

namespace {

constexpr std::size_t shortest_vertex = 6;  // bytes of "0 0 0\n"
constexpr std::size_t shortest_word = 2;    // bytes of "0\n"

/// The keyword is optional: a file may start with its counts. Prefixes announce values after the position (ST, C, N).
/// @return notes of what the vertices have that is not read
std::vector<std::string> read_header(const FileText& file, Scanner& scan) {
  Scanner ahead = scan;
  if (ahead.at_end()) file.fail("the file is empty");
  auto keyword = ahead.word();
  if (keyword.find_first_not_of("+0123456789") == std::string_view::npos) return {};
  const auto whole = keyword;
  for (const std::string_view prefix : {"ST", "C", "N"})
    if (keyword.starts_with(prefix)) keyword.remove_prefix(prefix.size());
  if (keyword == "4OFF" || keyword == "nOFF" || keyword == "4nOFF")
    ahead.fail("the vertices of the file do not have 3 dimensions (" + std::string(whole) + ")");
  if (keyword != "OFF") ahead.fail("an OFF file starts with OFF, but found " + quoted(whole));
  Scanner after = ahead;
  if (after.word() == "BINARY") after.fail("binary OFF files cannot be read; save the mesh as text");
  scan = ahead;
  std::vector<std::string> notes;
  if (whole.starts_with("C") || whole.starts_with("STC")) notes.emplace_back(kColours);
  if (whole.starts_with("ST")) notes.emplace_back(kUvs);
  return notes;
}

void read_vertices(Scanner& scan, std::int64_t count, GivenPolygons& mesh) {
  mesh.vertices.resize(static_cast<std::size_t>(count));
  for (std::int64_t i = 0; i < count; ++i) {
    const auto name = [&] { return "vertex " + std::to_string(i) + " of " + std::to_string(count); };
    if (scan.at_end()) scan.fail("the file ends before " + name());
    for (auto& x : mesh.vertices[static_cast<std::size_t>(i)]) {
      const auto word = scan.word();
      if (word.empty()) scan.fail(name() + " has fewer than three coordinates");
      x = scan.real(word, "a coordinate");
    }
    scan.next_line();
  }
}

void read_faces(Scanner& scan, std::int64_t count, GivenPolygons& mesh) {
  mesh.face_offsets.reserve(static_cast<std::size_t>(count) + 1);
  mesh.face_offsets.push_back(0);
  for (std::int64_t f = 0; f < count; ++f) {
    if (scan.at_end()) scan.fail("the file ends before face " + std::to_string(f) + " of " + std::to_string(count));
    const auto corners = scan.count(scan.word(), "the number of corners of a face", shortest_word);
    for (std::int64_t c = 0; c < corners; ++c)
      mesh.corner_vertices.push_back(scan.integer(scan.word_on_any_line("a vertex of a face"), "a vertex of a face"));
    mesh.face_offsets.push_back(static_cast<std::int64_t>(mesh.corner_vertices.size()));
    scan.next_line();  // past the face's colour
  }
}

}  // namespace

GivenPolygons read_off(const FileText& file) {
  file.check_encoding();
  Scanner scan(file, Comments::after_hash);
  auto notes = read_header(file, scan);
  const auto vertices =
      scan.count(scan.word_on_any_line("the number of vertices"), "the number of vertices", shortest_vertex);
  const auto faces = scan.count(scan.word_on_any_line("the number of faces"), "the number of faces", shortest_word);
  scan.next_line();  // past the number of edges, which nobody needs

  GivenPolygons mesh;
  mesh.file.notes = std::move(notes);
  read_vertices(scan, vertices, mesh);
  read_faces(scan, faces, mesh);
  if (!scan.at_end())
    scan.fail("the file goes on after the last of the " + std::to_string(faces) + " faces it announced");
  return mesh;
}

}  // namespace holomorph::mesh
