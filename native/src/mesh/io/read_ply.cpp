// PLY: a text header that declares elements and their properties, then the elements as text or binary.
// Positions are `vertex.x y z`; polygons are `face.vertex_indices` (or `vertex_index`), or `tristrips`. The rest is
// skipped.
#include "mesh/io/read_ply.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "base/errors.h"
#include "mesh/io/ply_header.h"
#include "mesh/io/scanner.h"

namespace holomorph::mesh {
namespace ply {
namespace {

// Values as words, one line per element.
class TextValues {
 public:
  TextValues(const FileText& file, const Header& header) : scan_(file, Comments::none, header.size, header.lines + 1) {}

  static std::size_t least_bytes(const Property&) { return 2; }  // a digit and a separator
  std::size_t bytes_left() const { return scan_.bytes_left(); }

  void enter(const Element& element) { what_ = "a value of element " + in_quotes(element.name); }
  void enter_row(std::int64_t row) {
    if (scan_.at_end()) scan_.fail("the file ends where " + what_ + " is expected, in row " + std::to_string(row));
  }
  void leave_row() {
    if (!scan_.at_line_end()) scan_.fail("the line has more values than the header declares");
    scan_.next_line();
  }

  double real(Type) { return scan_.real(word(), what_); }
  std::int64_t integer(Type type) {
    const auto value = word();
    return is_real(type) ? whole_number(scan_.real(value, what_), *this) : scan_.integer(value, what_);
  }
  void skip(Type, std::int64_t values) {
    for (std::int64_t i = 0; i < values; ++i) word();
  }
  std::string finish() {
    if (!scan_.at_end()) scan_.fail("the file goes on after the last element that its header announces");
    return {};
  }
  [[noreturn]] void fail(const std::string& reason) const { scan_.fail(reason); }

 private:
  std::string_view word() {
    const auto next = scan_.word();
    if (next.empty()) scan_.fail("the line ends where " + what_ + " is expected");
    return next;
  }

  Scanner scan_;
  std::string what_;
};

// Values as bytes.
template <std::endian order>
class BinaryValues {
 public:
  BinaryValues(const FileText& file, const Header& header) : file_(file), position_(header.size) {}

  static std::size_t least_bytes(const Property& p) { return size_of(p.is_list() ? p.count_type : p.type); }
  std::size_t bytes_left() const { return file_.bytes.size() - position_; }

  void enter(const Element& element) {
    element_ = &element;
    row_ = 0;
  }
  void enter_row(std::int64_t row) { row_ = row; }
  void leave_row() {}

  double real(Type type) {
    switch (type) {
      case Type::float32:
        return take<float>();
      case Type::float64:
        return take<double>();
      case Type::uint64:
        return static_cast<double>(take<std::uint64_t>());
      default:
        return static_cast<double>(integer(type));
    }
  }
  std::int64_t integer(Type type) {
    switch (type) {
      case Type::int8:
        return take<std::int8_t>();
      case Type::uint8:
        return take<std::uint8_t>();
      case Type::int16:
        return take<std::int16_t>();
      case Type::uint16:
        return take<std::uint16_t>();
      case Type::int32:
        return take<std::int32_t>();
      case Type::uint32:
        return take<std::uint32_t>();
      case Type::int64:
        return take<std::int64_t>();
      default:
        return whole_number(real(type), *this);
    }
  }
  void skip(Type type, std::int64_t values) { advance(size_of(type) * static_cast<std::size_t>(values)); }
  // What follows the last element is not read: some writers pad. @return a sentence about anything else
  std::string finish() const {
    const auto rest = file_.bytes.begin() + static_cast<std::ptrdiff_t>(position_);
    const auto is_padding = [](char c) { return c == '\0' || c == '\n' || c == '\r' || c == ' ' || c == '\x1A'; };
    if (std::all_of(rest, file_.bytes.end(), is_padding)) return {};
    return "the file has " + std::to_string(bytes_left()) + " bytes after the last element that its header announces";
  }
  [[noreturn]] void fail(const std::string& reason) const {
    throw InvalidMesh(file_.name + ", byte " + std::to_string(position_) + ", element " + in_quotes(element_->name) +
                      " " + std::to_string(row_) + ": " + reason);
  }

 private:
  const char* advance(std::size_t bytes) {
    if (bytes > bytes_left()) fail("the file ends inside this element");
    const char* const here = file_.bytes.data() + position_;
    position_ += bytes;
    return here;
  }
  template <class Number>
  Number take() {
    return load_as<Number>(advance(sizeof(Number)), order);
  }

  const FileText& file_;
  std::size_t position_;
  const Element* element_ = nullptr;
  std::int64_t row_ = 0;
};

/// The length of a list, checked against what the rest of the file can hold.
template <class Values>
std::int64_t list_length(Values& values, const Property& list) {
  const auto length = values.integer(list.count_type);
  if (length < 0)
    values.fail("the list " + in_quotes(list.name) + " has the negative length " + std::to_string(length));
  if (static_cast<std::uint64_t>(length) > values.bytes_left() / values.least_bytes({{}, list.type, Type::none}) + 1)
    values.fail("the list " + in_quotes(list.name) + " has length " + std::to_string(length) +
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
    values.fail(std::to_string(element.count) + " elements " + in_quotes(element.name) +
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
  file.fail("the element " + in_quotes(element.name) + " has no list 'vertex_indices'");
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
