// PLY: a text header that declares elements and their properties, then the elements as text or binary.
// Positions are `vertex.x y z`; polygons are `face.vertex_indices` (or `vertex_index`), or `tristrips`. The rest is
// skipped.
#include "mesh/io/read_ply.h"

#include <algorithm>
#include <bit>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/io/ply_binary_values.h"
#include "mesh/io/ply_header.h"
#include "mesh/io/ply_text_values.h"

namespace holomorph::mesh {

namespace ply {

namespace {

/// The length of a list, checked against what the rest of the file can hold.
template <class Values>
std::int64_t list_length(Values& values, const Property& list) {
  const auto length = values.integer(list.count_type);
  if (length < 0) values.fail("the list " + quoted(list.name) + " has the negative length " + std::to_string(length));
  if (static_cast<std::uint64_t>(length) > values.bytes_left() / values.least_bytes({{}, list.type, Type::none}) + 1)
    values.fail("the list " + quoted(list.name) + " has length " + std::to_string(length) +
                ", more than the rest of the file can hold");
  return length;
}

template <class Values>
void skip_property(Values& values, const Property& property) {
  values.skip(property.type, property.is_list() ? list_length(values, property) : 1);
}

template <class Values>
void check_count(Values& values, const Element& element) {
  std::size_t row_bytes = 0;
  for (const auto& property : element.properties) row_bytes += values.least_bytes(property);
  if (row_bytes > 0 && static_cast<std::uint64_t>(element.count) > values.bytes_left() / row_bytes + 1)
    values.fail(std::to_string(element.count) + " elements " + quoted(element.name) +
                " are announced, more than the file can hold");
}

std::size_t property_named(const Element& element, std::string_view name, const FileText& file) {
  for (std::size_t p = 0; p < element.properties.size(); ++p)
    if (element.properties[p].name == name && !element.properties[p].is_list()) return p;
  file.fail("the element 'vertex' has no property '" + std::string(name) + "'");
}

bool has_one_of(const Element& element, std::initializer_list<std::string_view> names) {
  return std::any_of(element.properties.begin(), element.properties.end(), [&](const Property& property) {
    return std::find(names.begin(), names.end(), property.name) != names.end();
  });
}

/// Notes colours and UVs, by the names that programs give them.
void note_unread(const Header& header, std::vector<std::string>& notes) {
  bool is_coloured = false, is_mapped = false;
  for (const auto& element : header.elements) {
    const bool is_vertex = element.name == "vertex";
    is_coloured |= is_vertex && has_one_of(element, {"red", "r"});
    is_mapped |= is_vertex ? has_one_of(element, {"s", "u", "texture_u"}) : has_one_of(element, {"texcoord"});
  }
  if (is_coloured) notes.emplace_back(kColours);
  if (is_mapped) notes.emplace_back(kUvs);
}

std::size_t polygon_list(const Element& element, const FileText& file) {
  for (std::size_t p = 0; p < element.properties.size(); ++p) {
    const auto& property = element.properties[p];
    if (property.is_list() && (property.name == "vertex_indices" || property.name == "vertex_index")) return p;
  }
  file.fail("the element " + quoted(element.name) + " has no list 'vertex_indices'");
}

template <class Values>
void read_vertices(Values& values, const Element& element, const FileText& file, GivenPolygons& mesh) {
  if (!mesh.vertices.empty()) values.fail("the element 'vertex' is declared twice");
  constexpr std::size_t skipped = 3;
  std::vector<std::size_t> axis(element.properties.size(), skipped);
  axis[property_named(element, "x", file)] = 0;
  axis[property_named(element, "y", file)] = 1;
  axis[property_named(element, "z", file)] = 2;
  mesh.vertices.resize(static_cast<std::size_t>(element.count));
  for (std::int64_t row = 0; row < element.count; ++row) {
    values.enter_row(row);
    auto& point = mesh.vertices[static_cast<std::size_t>(row)];
    for (std::size_t p = 0; p < axis.size(); ++p) {
      if (axis[p] == skipped)
        skip_property(values, element.properties[p]);
      else
        point[axis[p]] = values.real(element.properties[p].type);
    }
    values.leave_row();
  }
}

/// The triangles of a strip, every other one reversed; -1 starts a new strip. Triangles with a vertex twice only
/// join parts of a strip, and are not faces.
void append_strip(const std::vector<std::int64_t>& strip, GivenPolygons& mesh) {
  constexpr std::int64_t restart = -1;
  std::size_t first = 0;
  for (std::size_t i = 0; i < strip.size(); ++i) {
    if (strip[i] == restart) first = i + 1;
    if (i < first + 2) continue;
    const bool reversed = (i - first) % 2 == 1;
    const auto a = strip[i - (reversed ? 1 : 2)], b = strip[i - (reversed ? 2 : 1)], c = strip[i];
    if (a == b || b == c || c == a) continue;
    mesh.corner_vertices.insert(mesh.corner_vertices.end(), {a, b, c});
    mesh.face_offsets.push_back(static_cast<std::int64_t>(mesh.corner_vertices.size()));
  }
}

template <class Values>
void read_polygons(Values& values, const Element& element, const FileText& file, GivenPolygons& mesh) {
  const auto list = polygon_list(element, file);
  const bool strips = element.name == "tristrips";
  std::vector<std::int64_t> strip;
  auto& corners = strips ? strip : mesh.corner_vertices;
  for (std::int64_t row = 0; row < element.count; ++row) {
    values.enter_row(row);
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      const auto& property = element.properties[p];
      if (p != list) {
        skip_property(values, property);
        continue;
      }
      for (auto left = list_length(values, property); left > 0; --left)
        corners.push_back(values.integer(property.type));
    }
    values.leave_row();
    if (strips) {
      append_strip(strip, mesh);
      strip.clear();
    } else {
      mesh.face_offsets.push_back(static_cast<std::int64_t>(corners.size()));
    }
  }
}

template <class Values>
void skip_element(Values& values, const Element& element) {
  if (element.properties.empty()) return;  // such an element takes no bytes, however many there are
  for (std::int64_t row = 0; row < element.count; ++row) {
    values.enter_row(row);
    for (const auto& property : element.properties) skip_property(values, property);
    values.leave_row();
  }
}

template <class Values>
GivenPolygons read_body(const FileText& file, const Header& header) {
  Values values(file, header);
  GivenPolygons mesh;
  note_unread(header, mesh.file.notes);
  mesh.face_offsets.push_back(0);
  for (const auto& element : header.elements) {
    values.enter(element);
    check_count(values, element);
    if (element.name == "vertex")
      read_vertices(values, element, file, mesh);
    else if (element.name == "face" || element.name == "tristrips")
      read_polygons(values, element, file, mesh);
    else
      skip_element(values, element);
  }
  if (std::string note = values.finish(); !note.empty()) mesh.file.notes.push_back(std::move(note));
  return mesh;
}

}  // namespace

}  // namespace ply

GivenPolygons read_ply(const FileText& file) {
  file.check_encoding();
  const auto header = ply::read_header(file);
  switch (header.encoding) {
    case ply::Encoding::text:
      return ply::read_body<ply::TextValues>(file, header);
    case ply::Encoding::little_endian:
      return ply::read_body<ply::BinaryValues<std::endian::little>>(file, header);
    case ply::Encoding::big_endian:
      return ply::read_body<ply::BinaryValues<std::endian::big>>(file, header);
  }
  file.fail("the PLY format is not known");
}

}  // namespace holomorph::mesh
