// STL, text or binary: a list of triangles with coordinates. Corners with equal coordinates are welded to one vertex.
#include "mesh/io/read_stl.h"

#include <bit>
#include <cstring>
#include <string>

#include "mesh/io/byte_order.h"
#include "mesh/io/scanner.h"

namespace holomorph::mesh {

namespace {

using Point = std::array<double, 3>;

constexpr std::size_t header_size = 80;    // bytes of comment before the count
constexpr std::size_t triangle_size = 50;  // bytes: normal and three corners as float32, two bytes of attribute
constexpr std::size_t normal_size = 12;

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

GivenPolygons welded(const std::vector<Point>& corners) {
  GivenPolygons mesh;
  Weld weld(corners.size());
  mesh.corner_vertices.reserve(corners.size());
  for (const auto& p : corners) mesh.corner_vertices.push_back(weld(p));
  mesh.vertices = std::move(weld.points);
  mesh.face_offsets.reserve(corners.size() / 3 + 1);
  for (std::size_t c = 0; c <= corners.size(); c += 3) mesh.face_offsets.push_back(static_cast<std::int64_t>(c));
  return mesh;
}

std::vector<Point> binary_corners(const FileText& file) {
  const auto& bytes = file.bytes;
  const std::size_t triangles = load_as<std::uint32_t>(bytes.data() + header_size, std::endian::little);
  const auto body = bytes.data() + header_size + 4;
  const auto capacity = (bytes.size() - header_size - 4) / triangle_size;
  if (triangles > capacity)
    file.fail("the file announces " + std::to_string(triangles) + " triangles, but ends after " +
              std::to_string(capacity));
  std::vector<Point> corners(3 * triangles);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const char* p = body + triangle_size * (i / 3) + normal_size + 12 * (i % 3);
    for (std::size_t k = 0; k < 3; ++k) corners[i][k] = load_as<float>(p + 4 * k, std::endian::little);
  }
  return corners;
}

bool is_keyword(std::string_view word, std::string_view lower_case) {
  if (word.size() != lower_case.size()) return false;
  for (std::size_t i = 0; i < word.size(); ++i)
    if ((word[i] | ' ') != lower_case[i]) return false;
  return true;
}

void expect(Scanner& scan, std::string_view keyword) {
  const auto word = scan.word_on_any_line(keyword);
  if (!is_keyword(word, keyword)) scan.fail("'" + std::string(keyword) + "' is expected, but found " + quoted(word));
}

Point expect_point(Scanner& scan) {
  Point p{};
  for (auto& x : p) x = scan.real(scan.word_on_any_line("a coordinate"), "a coordinate");
  return p;
}

std::vector<Point> text_corners(const FileText& file) {
  std::vector<Point> corners;
  bool inside = false;  // between `solid` and `endsolid`; a file may have several solids
  for (Scanner scan(file, Comments::none);;) {
    if (scan.at_end()) {
      if (inside) scan.fail("the file ends before 'endsolid'");
      return corners;
    }
    const auto word = scan.word();
    if (is_keyword(word, inside ? "endsolid" : "solid")) {
      inside = !inside;
      scan.next_line();  // the solid's name
    } else if (inside && is_keyword(word, "facet")) {
      scan.next_line();  // the normal, which the corners give as well
      expect(scan, "outer");
      expect(scan, "loop");
      for (int corner = 0; corner < 3; ++corner) {
        expect(scan, "vertex");
        corners.push_back(expect_point(scan));
      }
      expect(scan, "endloop");
      expect(scan, "endfacet");
    } else {
      scan.fail(std::string(inside ? "'facet' or 'endsolid'" : "'solid'") + " is expected, but found " + quoted(word));
    }
  }
}

/// The word `solid` alone decides nothing, because binary files may start with it: text has no zero bytes.
bool is_text(const FileText& file) {
  const auto& bytes = file.bytes;
  const auto first = bytes.find_first_not_of(" \t\r\n");
  if (first == std::string::npos || !is_keyword(std::string_view(bytes).substr(first, 5), "solid")) return false;
  if (bytes.size() >= header_size + 4) {
    const std::size_t triangles = load_as<std::uint32_t>(bytes.data() + header_size, std::endian::little);
    if (bytes.size() == header_size + 4 + triangle_size * triangles) return false;
  }
  return bytes.find('\0') == std::string::npos;
}

}  // namespace

GivenPolygons read_stl(const FileText& file) {
  if (is_text(file)) return welded(text_corners(file));
  if (file.bytes.size() < header_size + 4)
    file.fail("the file is neither a text STL ('solid ...') nor as long as the header of a binary one");
  return welded(binary_corners(file));
}

}  // namespace holomorph::mesh
