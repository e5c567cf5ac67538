// The elements of a text PLY file, value by value.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "mesh/io/ply_header.h"
#include "mesh/io/scanner.h"

namespace holomorph::mesh::ply {

/// Values as words, one line per element.
class TextValues {
 public:
  TextValues(const FileText& file, const Header& header) : scan_(file, Comments::none, header.size, header.lines + 1) {}

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

}  // namespace holomorph::mesh::ply
