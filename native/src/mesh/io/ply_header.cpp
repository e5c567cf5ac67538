#include "mesh/io/ply_header.h"

#include <algorithm>
#include <optional>
#include <string_view>

#include "base/errors.h"
#include "mesh/io/scanner.h"

namespace holomorph::mesh::ply {

bool is_real(Type type) { return type == Type::float32 || type == Type::float64; }

std::size_t size_of(Type type) {
  switch (type) {
    case Type::int8:
    case Type::uint8:
      return 1;
    case Type::int16:
    case Type::uint16:
      return 2;
    case Type::int32:
    case Type::uint32:
    case Type::float32:
      return 4;
    case Type::int64:
    case Type::uint64:
    case Type::float64:
      return 8;
    case Type::none:
      break;
  }
  return 0;
}

namespace {

struct TypeName {
  std::string_view name;
  Type type;
};

constexpr TypeName type_names[] = {
    {"char", Type::int8},       {"uchar", Type::uint8},     {"short", Type::int16},   {"ushort", Type::uint16},
    {"int", Type::int32},       {"uint", Type::uint32},     {"float", Type::float32}, {"double", Type::float64},
    {"int8", Type::int8},       {"uint8", Type::uint8},     {"int16", Type::int16},   {"uint16", Type::uint16},
    {"int32", Type::int32},     {"uint32", Type::uint32},   {"int64", Type::int64},   {"uint64", Type::uint64},
    {"float32", Type::float32}, {"float64", Type::float64},
};

/// The header line by line. It ends with the newline after `end_header`, whatever the next byte is: lines end as the
/// first one does, with LF, CR, CR LF or LF CR.
class HeaderLines {
 public:
  explicit HeaderLines(const FileText& file)
      : file_(file), position_(static_cast<std::size_t>(file.text().data() - file.bytes.data())) {
    const std::string_view text = file.text();
    const auto first = std::min(text.find_first_of("\r\n"), text.size());
    newline_ = text.substr(first, 2);
    if (newline_ != "\r\n" && newline_ != "\n\r") newline_ = newline_.substr(0, 1);
  }

  /// The words of the next line.
  std::vector<std::string_view> next() {
    const std::string_view rest = std::string_view(file_.bytes).substr(position_);
    const auto end = rest.find_first_of("\r\n");
    ++line_;
    if (end == std::string_view::npos) fail("the file ends inside the PLY header");
    const std::string_view newline = rest.substr(end, 2);
    const bool is_pair = newline == newline_ || (newline == "\r\n" && newline_ == "\n");
    position_ += end + (is_pair ? newline.size() : 1);
    return words(rest.substr(0, end));
  }

  [[noreturn]] void fail(const std::string& reason) const {
    throw InvalidMesh(file_.name + ", line " + std::to_string(line_) + ": " + reason);
  }

  std::size_t position() const { return position_; }
  std::int64_t line() const { return line_; }

 private:
  static std::vector<std::string_view> words(std::string_view line) {
    std::vector<std::string_view> found;
    for (auto first = line.find_first_not_of(" \t"); first != std::string_view::npos;
         first = line.find_first_not_of(" \t")) {
      line.remove_prefix(first);
      const auto length = std::min(line.find_first_of(" \t"), line.size());
      found.push_back(line.substr(0, length));
      line.remove_prefix(length);
    }
    return found;
  }

  const FileText& file_;
  std::size_t position_;
  std::string_view newline_;
  std::int64_t line_ = 0;
};

Encoding encoding_named(std::string_view name, const HeaderLines& lines) {
  if (name == "ascii") return Encoding::text;
  if (name == "binary_little_endian") return Encoding::little_endian;
  if (name == "binary_big_endian") return Encoding::big_endian;
  lines.fail("the PLY format " + in_quotes(name) + " is not known");
}

Type type_named(std::string_view name, const HeaderLines& lines) {
  for (const auto& entry : type_names)
    if (entry.name == name) return entry.type;
  lines.fail("the property type " + in_quotes(name) + " is not known");
}

Property property_of(const std::vector<std::string_view>& words, const HeaderLines& lines) {
  const bool list = words.size() == 5 && words[1] == "list";
  if (!list && words.size() != 3)
    lines.fail("a property is declared as 'property TYPE NAME' or 'property list TYPE TYPE NAME'");
  Property property{std::string(words.back()), type_named(words[words.size() - 2], lines)};
  if (list) property.count_type = type_named(words[2], lines);
  if (is_real(property.count_type)) lines.fail("the length of a list must be of an integer type");
  return property;
}

Element element_of(const std::vector<std::string_view>& words, const FileText& file, const HeaderLines& lines) {
  if (words.size() != 3) lines.fail("an element is declared as 'element NAME COUNT'");
  const auto count =
      Scanner(file, Comments::none, file.bytes.size(), lines.line()).integer(words[2], "the number of elements");
  if (count < 0) lines.fail("the number of elements is negative: " + std::to_string(count));
  return {std::string(words[1]), count, {}};
}

// Adds the element that a line declares, or the property of the last element.
void declare(const std::vector<std::string_view>& words, const FileText& file, const HeaderLines& lines,
             std::vector<Element>& elements) {
  if (words[0] == "element") {
    elements.push_back(element_of(words, file, lines));
  } else if (words[0] == "property") {
    if (elements.empty()) lines.fail("a property is declared before any element");
    elements.back().properties.push_back(property_of(words, lines));
  } else {
    lines.fail("a declaration is expected, but found " + in_quotes(words[0]));
  }
}

}  // namespace

Header read_header(const FileText& file) {
  HeaderLines lines(file);
  if (!file.text().starts_with("ply")) file.fail("a PLY file starts with 'ply', but this one does not");
  if (lines.next().size() != 1) lines.fail("a PLY file starts with a line 'ply'");
  Header header;
  std::optional<Encoding> encoding;
  for (auto words = lines.next(); words.empty() || words[0] != "end_header"; words = lines.next()) {
    if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
    if (words[0] == "format" && words.size() >= 2) {
      encoding = encoding_named(words[1], lines);
    } else {
      declare(words, file, lines, header.elements);
    }
  }
  if (!encoding) lines.fail("the header does not declare a format");
  header.encoding = *encoding;
  header.size = lines.position();
  header.lines = lines.line();
  return header;
}

}  // namespace holomorph::mesh::ply
