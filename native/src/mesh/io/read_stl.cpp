// STL, text or binary: a list of triangles with coordinates. Corners with equal coordinates are welded to one vertex.
#include "mesh/io/read_stl.h"

#include <cstring>
#include <numeric>
#include <string>

#include "mesh/io/byte_order.h"
#include "mesh/io/scanner.h"
#include "mesh/io/weld.h"

namespace holomorph::mesh {

namespace {

using Point = std::array<double, 3>;

constexpr std::size_t header_size = 80;    // bytes of comment before the count
constexpr std::size_t triangle_size = 50;  // bytes: normal and three corners as float32, two bytes of attribute
constexpr std::size_t normal_size = 12;

// As a triangle of three vertices each, which welding then joins.
GivenPolygons triangles(std::vector<Point> corners) {
  GivenPolygons mesh;
  mesh.corner_vertices.resize(corners.size());
  std::iota(mesh.corner_vertices.begin(), mesh.corner_vertices.end(), std::int64_t{0});
  for (std::size_t c = 0; c <= corners.size(); c += 3) mesh.face_offsets.push_back(static_cast<std::int64_t>(c));
  mesh.vertices = std::move(corners);
  return welded(mesh);
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
  if (is_text(file)) return triangles(text_corners(file));
  if (file.bytes.size() < header_size + 4)
    file.fail("the file is neither a text STL ('solid ...') nor as long as the header of a binary one");
  return triangles(binary_corners(file));
}

}  // namespace holomorph::mesh
