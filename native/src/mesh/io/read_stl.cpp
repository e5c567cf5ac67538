// STL, text or binary: a list of triangles with coordinates. Corners with equal coordinates are welded to one vertex.
#include "mesh/io/read_stl.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <numeric>
#include <string>

#include "mesh/io/scanner.h"
#include "mesh/triangle_geometry.h"
#include "mesh/welding.h"

namespace holomorph::mesh {
namespace {

/// Gives equal points equal numbers, counted by first appearance. NaN equals nothing, so each such point is a vertex of
/// its own.
class Weld {
 public:
  explicit Weld(std::size_t corners) : slots_(std::bit_ceil(2 * corners + 1), empty) {}

  std::int64_t operator()(Point p) {
    for (auto& x : p) x += 0.0;  // -0 becomes 0, so that equal coordinates have equal bits
    const auto mask = slots_.size() - 1;
    for (auto slot = hash(p) & mask;; slot = (slot + 1) & mask) {  // ends: at least half of the slots are empty
      if (slots_[slot] == empty) {
        slots_[slot] = static_cast<std::int64_t>(points.size());
        points.push_back(p);
        return slots_[slot];
      }
      if (points[static_cast<std::size_t>(slots_[slot])] == p) return slots_[slot];
    }
  }

  std::vector<Point> points;

 private:
  static constexpr std::int64_t empty = -1;

  static std::size_t hash(const Point& p) {
    std::uint64_t h = 0;
    for (const auto x : p) {  // multiply and fold, so that the low bits depend on all bits of all coordinates
      h = (h ^ std::bit_cast<std::uint64_t>(x)) * 0x9E3779B97F4A7C15u;
      h ^= h >> 32;
    }
    return static_cast<std::size_t>(h);
  }

  std::vector<std::int64_t> slots_;
};

using std::to_string;

constexpr std::size_t header_size = 84;    // bytes: 80 of comment, and the count
constexpr std::size_t triangle_size = 50;  // bytes: normal and three corners as float32, two bytes of attribute
constexpr std::size_t normal_size = 12, attribute_size = 2;

// As a triangle of three vertices each, which welding then joins.
GivenPolygons triangles(std::vector<Point> corners) {
  GivenPolygons mesh;
  mesh.corner_vertices.resize(corners.size());
  std::iota(mesh.corner_vertices.begin(), mesh.corner_vertices.end(), std::int64_t{0});
  for (std::size_t c = 0; c <= corners.size(); c += 3) mesh.face_offsets.push_back(static_cast<std::int64_t>(c));
  mesh.vertices = std::move(corners);
  return welded(mesh);
}

bool is_printable(char c) { return (c >= ' ' && c <= '~') || c == '\t' || c == '\r' || c == '\n'; }

std::size_t announced_triangles(const FileText& file) {
  return load_as<std::uint32_t>(file.bytes.data() + header_size - 4, std::endian::little);
}

bool is_as_long_as_announced(const FileText& file) {
  return file.bytes.size() >= header_size &&
         file.bytes.size() == header_size + triangle_size * announced_triangles(file);
}

/// Whether some triangles are followed by as many bytes as their attributes count, and the file ends with the last.
bool has_attributes(const FileText& file) {
  if (is_as_long_as_announced(file)) return false;  // then the numbers are colours
  std::size_t place = header_size;
  for (std::size_t left = announced_triangles(file); left > 0; --left) {
    if (place + triangle_size > file.bytes.size()) return false;
    place += triangle_size;
    place += load_as<std::uint16_t>(file.bytes.data() + place - attribute_size, std::endian::little);
  }
  return place == file.bytes.size();
}

/// The number of triangles: the announced one where the file ends with the last, or with blanks or text after it; else
/// as many as the file has room for.
std::size_t triangle_count(const FileText& file, std::vector<std::string>& notes) {
  const std::size_t announced = announced_triangles(file);
  const std::size_t body = file.bytes.size() - header_size, room = body / triangle_size;
  if (announced > 0 && has_attributes(file))
    file.fail("its triangles have attributes of " + to_string(body - triangle_size * announced) +
              " bytes in all, which are not known: save it without them");
  if (announced <= room) {
    const auto rest = file.bytes.begin() + static_cast<std::ptrdiff_t>(header_size + triangle_size * announced);
    const auto is_padding = [&](char c) { return c == *rest || c == '\0'; };
    if (file.bytes.end() - rest < static_cast<std::ptrdiff_t>(triangle_size) ||
        (announced > 0 &&
         (std::all_of(rest, file.bytes.end(), is_printable) || std::all_of(rest, file.bytes.end(), is_padding))))
      return announced;
  }
  const std::string told = "the file announces " + to_string(announced) + " triangles, but ";
  if (body % triangle_size != 0)
    file.fail(told + (announced > room ? "ends after " + to_string(room)
                                       : "goes on after them with " + to_string(body - triangle_size * announced) +
                                             " bytes that are no triangles"));
  notes.push_back(told + "has " + to_string(room) + ", which were read");
  return room;
}

GivenPolygons read_binary(const FileText& file) {
  std::vector<std::string> notes;
  std::vector<Point> corners(3 * triangle_count(file, notes));
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const char* p = file.bytes.data() + header_size + triangle_size * (i / 3) + normal_size + 12 * (i % 3);
    for (std::size_t k = 0; k < 3; ++k) corners[i][k] = load_as<float>(p + 4 * k, std::endian::little);
  }
  GivenPolygons mesh = triangles(std::move(corners));
  mesh.file.notes = std::move(notes);
  return mesh;
}

/// A text STL keyword by keyword, in any case. `end` and `outer` may be words of their own: `end solid`, `endsolid`.
class TextTriangles {
 public:
  explicit TextTriangles(const FileText& file) : scan_(file, Comments::none) {}

  static bool begins_line(std::string_view word) {
    const std::string found = plain(word);
    return found == "facet" || found == "endsolid" || found == "end" || found == "solid";
  }

  GivenPolygons read() {
    bool inside = false;  // between `solid` and `endsolid`; a file may have several solids
    while (!scan_.at_end()) {
      const auto word = scan_.word();
      const std::string found = keyword(word);
      if (found == "solid") {
        if (inside) note_once("a solid begins before the one before it has ended with 'endsolid'");
        inside = true;
        scan_.next_line();  // its name
      } else if (inside && found == "endsolid") {
        inside = false;
        is_ended_ = true;
        scan_.next_line();
      } else if (inside && found == "facet") {
        read_facet();
      } else if (is_ended_ && !inside && found != "facet") {
        note_once("the text after 'endsolid' was not read");
        scan_.next_line();
      } else {
        fail_expecting(inside ? "'facet' or 'endsolid'" : "'solid'", word);
      }
    }
    if (inside) note_once("the file ends before 'endsolid': it may have been cut off");
    GivenPolygons mesh = triangles(std::move(corners_));
    mesh.file.notes = std::move(notes_);
    return mesh;
  }

 private:
  // In lower case, without the hyphens and underscores between its parts, which may be words of their own.
  std::string keyword(std::string_view word) {
    const std::string found = plain(word);
    return found == "end" || found == "outer" ? plain(std::string(word) + std::string(scan_.word())) : found;
  }
  // A name may follow `solid` and `endsolid` without a blank.
  static std::string plain(std::string_view word) {
    std::string result;
    for (const char c : word) {
      if (c != '_' && c != '-') result += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
    for (const char* const named : {"solid", "endsolid"}) {
      if (result.starts_with(named)) return named;
    }
    return result;
  }

  [[noreturn]] void fail_expecting(const std::string& what, std::string_view word) const {
    scan_.fail(what + " is expected, but found " + in_quotes(word));
  }
  void expect(std::string_view wanted) {
    const auto word = scan_.word_on_any_line(wanted);
    if (keyword(word) != wanted) fail_expecting("'" + std::string(wanted) + "'", word);
  }

  void read_facet() {
    scan_.next_line();  // the normal, which the corners give as well
    expect("outerloop");
    for (int corner = 0; corner < 3; ++corner) {
      expect("vertex");
      for (auto& x : corners_.emplace_back()) x = scan_.real(scan_.word_on_any_line("a coordinate"), "a coordinate");
    }
    expect("endloop");
    expect("endfacet");
  }

  void note_once(const std::string& sentence) {
    if (std::find(notes_.begin(), notes_.end(), sentence) == notes_.end()) notes_.push_back(sentence);
  }

  Scanner scan_;
  std::vector<Point> corners_;
  std::vector<std::string> notes_;
  bool is_ended_ = false;
};

bool is_solid(std::string_view word) {
  constexpr std::string_view solid = "solid";
  return std::equal(word.begin(), word.end(), solid.begin(), solid.end(),
                    [](unsigned char c, char wanted) { return std::tolower(c) == wanted; });
}

/// The word `solid` alone decides nothing, because binary files may start with it. Text has no zero bytes, but in the
/// names of solids, on lines of their own.
bool is_text_file(const FileText& file) {
  if (is_as_long_as_announced(file)) return false;
  file.check_encoding();
  const std::string_view text = file.text();
  if (file.bytes.size() >= header_size && std::all_of(text.begin(), text.end(), is_printable)) return !text.empty();
  Scanner scan(file, Comments::none);
  if (scan.at_end() || !is_solid(scan.word())) return false;
  if (text.find('\0') == std::string_view::npos) return true;
  scan.next_line();
  return !scan.at_end() && TextTriangles::begins_line(scan.word());
}

}  // namespace

GivenPolygons welded(const GivenPolygons& given) {
  const auto exists = [&](std::int64_t v) { return v >= 0 && v < std::ssize(given.vertices); };
  if (!std::all_of(given.corner_vertices.begin(), given.corner_vertices.end(), exists)) return given;
  GivenPolygons mesh = given;
  Weld weld(mesh.corner_vertices.size());
  for (std::int64_t& v : mesh.corner_vertices) v = weld(given.vertices[v]);
  mesh.vertices = std::move(weld.points);
  std::vector<int>&faces = mesh.file.face_index, &corners = mesh.file.corner_index;
  faces.resize(given.face_offsets.size() - 1);
  corners.resize(given.corner_vertices.size());
  std::iota(faces.begin(), faces.end(), 0);
  std::iota(corners.begin(), corners.end(), 0);
  merge_repeated_corners(mesh, faces, corners);
  if (mesh.corner_vertices.size() == given.corner_vertices.size()) faces = corners = {};
  return mesh;
}

GivenPolygons read_stl(const FileText& file) {
  if (is_text_file(file)) return TextTriangles(file).read();
  if (file.bytes.size() < header_size)
    file.fail("the file is neither a text STL ('solid ...') nor as long as the header of a binary one");
  return read_binary(file);
}

}  // namespace holomorph::mesh
