// Reads the text, the numbers and the bytes of a file.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "mesh/surface.h"

namespace holomorph::mesh {

/// What a reader notes of a file whose vertices have colours.
inline constexpr std::string_view kColours = "the colours of its vertices are not read";

/// What a reader of PLY or OFF notes of a file with UVs.
inline constexpr std::string_view kUvs = "its UVs are not read";

/// What is said of a file that another one stands for.
inline constexpr std::string_view kPointer =
    "this is a pointer of Git LFS, not the model: fetch that with 'git lfs pull'";

/// A file in memory and the name that errors call it by.
struct FileText {
  std::string name;
  std::string bytes;

  /// The bytes of a text: without a byte order mark before it, and without zero bytes and Ctrl-Z after it.
  std::string_view text() const;

  /// @throws InvalidMesh where the text is in UTF-16, which has no format's words
  void check_encoding() const;

  /// @throws InvalidMesh "name: reason"
  [[noreturn]] void fail(std::string_view reason) const;
};

/// The number stored at `bytes`, aligned or not.
template <class Number>
Number load_as(const char* bytes, std::endian order) {
  std::array<char, sizeof(Number)> copy;
  std::memcpy(copy.data(), bytes, sizeof(Number));
  if (order != std::endian::native) std::reverse(copy.begin(), copy.end());
  return std::bit_cast<Number>(copy);
}

enum class Comments { none, after_hash };

/// Reads a text from front to back. Words are separated by blanks; a backslash at a line's end continues the line.
/// Lines end with LF, CR LF or CR; a byte order mark at the start is skipped.
/// Numbers are written as in C, whatever the locale, or with the exponents of Fortran (1D5) and what old libraries of
/// Windows write for NaN and infinity (1.#QNAN, 1.#INF). They fill their word, but for commas after it.
class Scanner {
 public:
  Scanner(const FileText& file, Comments comments, std::size_t start = 0, std::int64_t first_line = 1);

  /// The next word on this line, or as many characters of it; empty at the line's end.
  std::string_view word(std::size_t most = std::string_view::npos);
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
std::string in_quotes(std::string_view word);

}  // namespace holomorph::mesh
