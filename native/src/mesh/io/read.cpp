#include "mesh/io/read.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "base/errors.h"
#include "mesh/io/read_ply.h"
#include "mesh/io/read_stl.h"
#include "mesh/io/scanner.h"

namespace holomorph::mesh {
namespace {

// Wavefront OBJ: `v x y z` and `f a b c ...` with a = vertex[/texture[/normal]], counted from 1, or from the end if <
// 0.

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

// Reads a file of the format OBJ. @throws InvalidMesh "name: reason"
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

// Object File Format: [ST][C][N]OFF, three counts, a line per vertex that starts with x y z, then n v_1 .. v_n per
// face.

constexpr std::size_t shortest_vertex = 6;  // bytes of "0 0 0\n"
constexpr std::size_t shortest_word = 2;    // bytes of "0\n"

/// The keyword is optional: a file may start with its counts. Prefixes announce values after the position (ST, C, N).
/// @return notes of what the vertices have that is not read
std::vector<std::string> read_off_header(const FileText& file, Scanner& scan) {
  Scanner ahead = scan;
  if (ahead.at_end()) file.fail("the file is empty");
  auto keyword = ahead.word();
  if (keyword.find_first_not_of("+0123456789") == std::string_view::npos) return {};
  const auto whole = keyword;
  for (const std::string_view prefix : {"ST", "C", "N"})
    if (keyword.starts_with(prefix)) keyword.remove_prefix(prefix.size());
  if (keyword == "4OFF" || keyword == "nOFF" || keyword == "4nOFF")
    ahead.fail("the vertices of the file do not have 3 dimensions (" + std::string(whole) + ")");
  const auto counts = keyword.substr(std::min<std::size_t>(keyword.size(), 3));  // OFF8 6 0, of old archives
  if (!keyword.starts_with("OFF") || counts.find_first_not_of("0123456789") != std::string_view::npos)
    ahead.fail("an OFF file starts with OFF, but found " + in_quotes(whole));
  Scanner after = ahead;
  if (after.word() == "BINARY") after.fail("binary OFF files cannot be read; save the mesh as text");
  scan.at_end();  // past what precedes the keyword
  scan.word(whole.size() - counts.size());
  std::vector<std::string> notes;
  if (whole.starts_with("C") || whole.starts_with("STC")) notes.emplace_back(kColours);
  if (whole.starts_with("ST")) notes.emplace_back(kUvs);
  return notes;
}

void read_off_vertices(Scanner& scan, std::int64_t count, GivenPolygons& mesh) {
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

// Reads a file of the format OFF. @throws InvalidMesh "name: reason"
GivenPolygons read_off(const FileText& file) {
  file.check_encoding();
  Scanner scan(file, Comments::after_hash);
  auto notes = read_off_header(file, scan);
  const auto vertices =
      scan.count(scan.word_on_any_line("the number of vertices"), "the number of vertices", shortest_vertex);
  const auto faces = scan.count(scan.word_on_any_line("the number of faces"), "the number of faces", shortest_word);
  scan.next_line();  // past the number of edges, which nobody needs

  GivenPolygons mesh;
  mesh.file.notes = std::move(notes);
  read_off_vertices(scan, vertices, mesh);
  read_faces(scan, faces, mesh);
  if (!scan.at_end())
    scan.fail("the file goes on after the last of the " + std::to_string(faces) + " faces it announced");
  return mesh;
}

struct Format {
  std::string_view extension;
  GivenPolygons (*read)(const FileText&);
};

constexpr std::array<Format, 4> formats{
    {{".obj", read_obj}, {".off", read_off}, {".ply", read_ply}, {".stl", read_stl}}};

std::string utf8(const std::filesystem::path& path) {
  const auto text = path.u8string();
  return {text.begin(), text.end()};
}

/// Whether bytes >= 0x80 come as a lead byte and as many continuation bytes as it announces.
bool is_utf8(std::string_view text) {
  std::size_t expected = 0;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool continuation = byte >= 0x80 && byte < 0xC0;
    if (continuation != (expected > 0) || byte == 0xC0 || byte == 0xC1 || byte > 0xF4) return false;
    expected = continuation ? expected - 1 : byte < 0xC0 ? 0 : byte < 0xE0 ? 1 : byte < 0xF0 ? 2 : 3;
  }
  return expected == 0;
}

/// The path as a message can say it. File systems take any bytes as a name, messages are UTF-8.
std::string printable(const std::filesystem::path& path) {
  auto name = utf8(path);
  if (!is_utf8(name))
    std::replace_if(
        name.begin(), name.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return name;
}

const Format& format_of(const std::filesystem::path& path) {
  auto extension = utf8(path.extension());
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const auto& format : formats)
    if (format.extension == extension) return format;
  throw InvalidMesh(printable(path) + ": the file name must end in .obj, .off, .ply or .stl");
}

FileText load(const std::filesystem::path& path) {
  FileText file{printable(path), {}};
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) file.fail("there is no such file");
  if (std::filesystem::is_directory(status)) file.fail("this is a directory, not a mesh file");
  if (!std::filesystem::is_regular_file(status)) file.fail("this is a pipe or a device, not a mesh file");
  const auto size = std::filesystem::file_size(path, error);
  std::ifstream stream(path, std::ios::binary);
  if (error || !stream) file.fail("the file cannot be opened for reading");
  file.bytes.resize(size);
  if (size > 0 && !stream.read(file.bytes.data(), static_cast<std::streamsize>(size)))
    file.fail("the file cannot be read to its end");
  if (file.bytes.starts_with("version https://git-lfs")) file.fail(kPointer);
  return file;
}

}  // namespace

GivenPolygons read(const std::filesystem::path& path) {
  const auto& format = format_of(path);
  return format.read(load(path));
}

}  // namespace holomorph::mesh
