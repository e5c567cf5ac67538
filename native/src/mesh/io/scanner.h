// Words and numbers of a text file, line by line, for all text formats.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "mesh/io/file_text.h"

namespace holomorph::mesh {

enum class Comments { none, after_hash };

/// Reads a text from front to back. Words are separated by blanks; a backslash at a line's end continues the line.
/// Lines end with LF, CR LF or CR; a byte order mark at the start is skipped.
/// Numbers are written as in C, whatever the locale, and fill their word.
class Scanner {
 public:
  Scanner(const FileText& file, Comments comments, std::size_t start = 0, std::int64_t first_line = 1);

  /// The next word on this line, empty at the line's end.
  std::string_view word();
  /// The next word, on this line or a later one. @throws InvalidMesh naming `what` if the text ends before it.
  std::string_view word_on_any_line(std::string_view what);
  /// Moves to the start of the next line, past whatever is left of this one.
  void next_line();
  /// No word is left on this line.
  bool at_line_end();
  std::size_t bytes_left() const { return static_cast<std::size_t>(end_ - next_); }
  /// No word is left in the text.
  bool at_end();

  /// The word as a number; `what` is the noun of the error message. NaN and infinity are numbers here.
  double real(std::string_view word, std::string_view what) const;
  std::int64_t integer(std::string_view word, std::string_view what) const;
  /// An integer >= 0 that is no larger than what the rest of the text can hold at `bytes_each`: check before reserving.
  std::int64_t count(std::string_view word, std::string_view what, std::size_t bytes_each) const;

  /// @throws InvalidMesh "name, line n: reason"
  [[noreturn]] void fail(std::string_view reason) const;

 private:
  void skip_blanks();

  const FileText* file_;
  const char* next_;
  const char* end_;
  Comments comments_;
  std::int64_t line_;
};

/// The word in quotation marks for a message, cut to a readable length, unprintable bytes as question marks.
std::string quoted(std::string_view word);

}  // namespace holomorph::mesh
