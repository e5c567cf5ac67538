// PLY: a text header that declares elements and their properties, then the elements as text or binary.
// Positions are `vertex.x y z`; polygons are `face.vertex_indices` (or `vertex_index`), or `tristrips`. The rest is
// skipped.
#include "mesh/io/read_ply.h"

#include <bit>
#include <cmath>
#include <string>

#include "base/errors.h"
#include "mesh/io/byte_order.h"
#include "mesh/io/ply_header.h"
#include "mesh/io/scanner.h"

namespace holomorph::mesh {

namespace ply {

namespace {

/// An index or a length that a file stores as a real.
template <class Body>
std::int64_t whole_number(const Body& body, double value) {
  constexpr double largest = 9007199254740992.0;  // 2^53: beyond it, doubles skip integers
  if (!(std::abs(value) <= largest) || value != std::floor(value))
    body.fail("an integer is expected, but found " + std::to_string(value));
  return static_cast<std::int64_t>(value);
}

// The values: the same questions to a text and to a binary body.

/// Values as words, one line per element.
class TextBody {
 public:
  TextBody(const FileText& file, const Header& header) : scan_(file, Comments::none, header.size, header.lines + 1) {}

  static std::size_t least_bytes(const Property&) { return 2; }  // a digit and a separator
  std::size_t bytes_left() const { return scan_.bytes_left(); }

  void enter(const Element& element) { what_ = "a value of element " + quoted(element.name); }
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
    return is_real(type) ? whole_number(*this, scan_.real(value, what_)) : scan_.integer(value, what_);
  }
  void skip(Type, std::int64_t values) {
    for (std::int64_t i = 0; i < values; ++i) word();
  }
  void finish() {
    if (!scan_.at_end()) scan_.fail("the file goes on after the last element that its header announces");
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

/// Values as bytes. Bytes after the last element are ignored: some writers pad.
template <std::endian order>
class BinaryBody {
 public:
  BinaryBody(const FileText& file, const Header& header) : file_(file), position_(header.size) {}

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
        return whole_number(*this, real(type));
    }
  }
  void skip(Type type, std::int64_t values) { advance(size_of(type) * static_cast<std::size_t>(values)); }
  void finish() {}
  [[noreturn]] void fail(const std::string& reason) const {
    throw InvalidMesh(file_.name + ", byte " + std::to_string(position_) + ", element " + quoted(element_->name) + " " +
                      std::to_string(row_) + ": " + reason);
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
template <class Body>
std::int64_t list_length(Body& body, const Property& list) {
  const auto length = body.integer(list.count_type);
  if (length < 0) body.fail("the list " + quoted(list.name) + " has the negative length " + std::to_string(length));
  if (static_cast<std::uint64_t>(length) > body.bytes_left() / body.least_bytes({{}, list.type, Type::none}) + 1)
    body.fail("the list " + quoted(list.name) + " has length " + std::to_string(length) +
              ", more than the rest of the file can hold");
  return length;
}

template <class Body>
void skip_property(Body& body, const Property& property) {
  body.skip(property.type, property.is_list() ? list_length(body, property) : 1);
}

template <class Body>
void check_count(Body& body, const Element& element) {
  std::size_t row_bytes = 0;
  for (const auto& property : element.properties) row_bytes += body.least_bytes(property);
  if (row_bytes > 0 && static_cast<std::uint64_t>(element.count) > body.bytes_left() / row_bytes + 1)
    body.fail(std::to_string(element.count) + " elements " + quoted(element.name) +
              " are announced, more than the file can hold");
}

std::size_t property_named(const Element& element, std::string_view name, const FileText& file) {
  for (std::size_t p = 0; p < element.properties.size(); ++p)
    if (element.properties[p].name == name && !element.properties[p].is_list()) return p;
  file.fail("the element 'vertex' has no property '" + std::string(name) + "'");
}

std::size_t polygon_list(const Element& element, const FileText& file) {
  for (std::size_t p = 0; p < element.properties.size(); ++p) {
    const auto& property = element.properties[p];
    if (property.is_list() && (property.name == "vertex_indices" || property.name == "vertex_index")) return p;
  }
  file.fail("the element " + quoted(element.name) + " has no list 'vertex_indices'");
}

template <class Body>
void read_vertices(Body& body, const Element& element, const FileText& file, GivenPolygons& mesh) {
  if (!mesh.vertices.empty()) body.fail("the element 'vertex' is declared twice");
  constexpr std::size_t skipped = 3;
  std::vector<std::size_t> axis(element.properties.size(), skipped);
  axis[property_named(element, "x", file)] = 0;
  axis[property_named(element, "y", file)] = 1;
  axis[property_named(element, "z", file)] = 2;
  mesh.vertices.resize(static_cast<std::size_t>(element.count));
  for (std::int64_t row = 0; row < element.count; ++row) {
    body.enter_row(row);
    auto& point = mesh.vertices[static_cast<std::size_t>(row)];
    for (std::size_t p = 0; p < axis.size(); ++p) {
      if (axis[p] == skipped)
        skip_property(body, element.properties[p]);
      else
        point[axis[p]] = body.real(element.properties[p].type);
    }
    body.leave_row();
  }
}

/// The triangles of a strip, every other one turned round; -1 starts a new strip. Triangles with a vertex twice only
/// join parts of a strip, and are no faces.
void append_strip(const std::vector<std::int64_t>& strip, GivenPolygons& mesh) {
  constexpr std::int64_t restart = -1;
  std::size_t first = 0;
  for (std::size_t i = 0; i < strip.size(); ++i) {
    if (strip[i] == restart) first = i + 1;
    if (i < first + 2) continue;
    const bool turned = (i - first) % 2 == 1;
    const auto a = strip[i - (turned ? 1 : 2)], b = strip[i - (turned ? 2 : 1)], c = strip[i];
    if (a == b || b == c || c == a) continue;
    mesh.corner_vertices.insert(mesh.corner_vertices.end(), {a, b, c});
    mesh.face_offsets.push_back(static_cast<std::int64_t>(mesh.corner_vertices.size()));
  }
}

template <class Body>
void read_polygons(Body& body, const Element& element, const FileText& file, GivenPolygons& mesh) {
  const auto list = polygon_list(element, file);
  const bool strips = element.name == "tristrips";
  std::vector<std::int64_t> strip;
  auto& corners = strips ? strip : mesh.corner_vertices;
  for (std::int64_t row = 0; row < element.count; ++row) {
    body.enter_row(row);
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      const auto& property = element.properties[p];
      if (p != list) {
        skip_property(body, property);
        continue;
      }
      for (auto left = list_length(body, property); left > 0; --left) corners.push_back(body.integer(property.type));
    }
    body.leave_row();
    if (strips) {
      append_strip(strip, mesh);
      strip.clear();
    } else {
      mesh.face_offsets.push_back(static_cast<std::int64_t>(corners.size()));
    }
  }
}

template <class Body>
void skip_element(Body& body, const Element& element) {
  if (element.properties.empty()) return;  // such an element takes no bytes, however many there are
  for (std::int64_t row = 0; row < element.count; ++row) {
    body.enter_row(row);
    for (const auto& property : element.properties) skip_property(body, property);
    body.leave_row();
  }
}

template <class Body>
GivenPolygons read_body(const FileText& file, const Header& header) {
  Body body(file, header);
  GivenPolygons mesh;
  mesh.face_offsets.push_back(0);
  for (const auto& element : header.elements) {
    body.enter(element);
    check_count(body, element);
    if (element.name == "vertex")
      read_vertices(body, element, file, mesh);
    else if (element.name == "face" || element.name == "tristrips")
      read_polygons(body, element, file, mesh);
    else
      skip_element(body, element);
  }
  body.finish();
  return mesh;
}

}  // namespace

}  // namespace ply

GivenPolygons read_ply(const FileText& file) {
  const auto header = ply::read_header(file);
  switch (header.encoding) {
    case ply::Encoding::text:
      return ply::read_body<ply::TextBody>(file, header);
    case ply::Encoding::little_endian:
      return ply::read_body<ply::BinaryBody<std::endian::little>>(file, header);
    case ply::Encoding::big_endian:
      return ply::read_body<ply::BinaryBody<std::endian::big>>(file, header);
  }
  file.fail("the PLY format is not known");
}

}  // namespace holomorph::mesh
