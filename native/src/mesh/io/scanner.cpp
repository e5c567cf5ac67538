#include "mesh/io/scanner.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "base/constants.h"
#include "base/errors.h"

namespace holomorph::mesh {
namespace {

constexpr std::size_t longest_quotation = 40;  // characters of a wrong word that a message repeats

/// CR LF counts once, by its LF.
bool is_newline(const char* p, const char* end) { return *p == '\n' || (*p == '\r' && (end - p < 2 || p[1] != '\n')); }

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

/// Length of a continuation (backslash, blanks, newline or the text's end) at `p`, 0 if there is none.
std::ptrdiff_t continuation(const char* p, const char* end) {
  if (*p != '\\') return 0;
  const char* next = p + 1;
  while (next != end && is_blank(*next) && !is_newline(next, end)) ++next;
  if (next == end) return next - p;
  return is_newline(next, end) ? next + 1 - p : 0;
}

std::string_view without_plus(std::string_view word) {
  while (word.size() > 1 && word.ends_with(',')) word.remove_suffix(1);
  const bool plus = word.size() > 1 && word[0] == '+' && word[1] != '-' && word[1] != '+';
  return plus ? word.substr(1) : word;
}

/// Whether a number goes on at `p`, between `first` and `end`, as in 1.#QNAN.
bool is_inside_number(const char* p, const char* first, const char* end) {
  return *p == '#' && p != first && p[-1] == '.' && end - p > 1 && (p[1] == 'I' || p[1] == 'Q' || p[1] == 'S');
}

/// A number too small or too large for a double, which from_chars leaves unconverted: its sign times 0 or infinity.
double beyond_range(std::string_view word) {
  const auto exponent = word.find_first_of("eE");
  const bool tiny = exponent != std::string_view::npos ? word.substr(exponent + 1).starts_with('-')
                                                       : word.find_first_of("123456789") > word.find('.');
  const double magnitude = tiny ? 0.0 : kInfinity;
  return word.starts_with('-') ? -magnitude : magnitude;
}

}  // namespace

std::string_view FileText::text() const {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF", padding("\0\x1A", 2), blanks(" \t\r\n\0\x1A", 6);
  std::string_view found = bytes;
  if (found.starts_with(byte_order_mark)) found.remove_prefix(byte_order_mark.size());
  const auto after = found.find_last_not_of(blanks) + 1;  // 0 where there is nothing else
  return found.substr(0, std::min(found.find_first_of(padding, after), found.size()));
}

void FileText::check_encoding() const {
  if (bytes.starts_with("\xFF\xFE") || bytes.starts_with("\xFE\xFF"))
    fail("this is text in UTF-16: save it in UTF-8 or ASCII");
}

void FileText::fail(std::string_view reason) const { throw InvalidMesh(name + ": " + std::string(reason)); }

std::string in_quotes(std::string_view word) {
  std::string text = "'";
  for (const char c : word.substr(0, longest_quotation)) text += (c >= ' ' && c <= '~') ? c : '?';
  if (word.size() > longest_quotation) text += "...";
  return text + "'";
}

Scanner::Scanner(const FileText& file, Comments comments, std::size_t start, std::int64_t first_line)
    : file_(&file), comments_(comments), line_(first_line) {
  const std::string_view text = file.text();
  end_ = text.data() + text.size();
  next_ = std::clamp(file.bytes.data() + start, text.data(), end_);
}

void Scanner::skip_blanks() {
  while (next_ != end_) {
    if (is_newline(next_, end_)) {
      return;
    } else if (is_blank(*next_)) {
      ++next_;
    } else if (const auto length = continuation(next_, end_)) {
      next_ += length;
      ++line_;
    } else {
      return;
    }
  }
}

bool Scanner::at_line_end() {
  skip_blanks();
  return next_ == end_ || is_newline(next_, end_) || (comments_ == Comments::after_hash && *next_ == '#');
}

bool Scanner::at_end() {
  while (at_line_end()) {
    if (next_ == end_) return true;
    next_line();
  }
  return false;
}

void Scanner::next_line() {
  while (next_ != end_ && !is_newline(next_, end_)) ++next_;
  if (next_ == end_) return;
  ++next_;
  ++line_;
}

std::string_view Scanner::word(std::size_t most) {
  if (at_line_end()) return {};
  const char* const first = next_;
  const char* const last = most < static_cast<std::size_t>(end_ - first) ? first + most : end_;
  const auto is_comment = [&] {
    return comments_ == Comments::after_hash && *next_ == '#' && !is_inside_number(next_, first, end_);
  };
  while (next_ != last && !is_blank(*next_) && *next_ != '\n' && !is_comment() && !continuation(next_, end_)) ++next_;
  return {first, static_cast<std::size_t>(next_ - first)};
}

std::string_view Scanner::word_on_any_line(std::string_view what) {
  if (at_end()) fail("the file ends where " + std::string(what) + " is expected");
  return word();
}

double Scanner::real(std::string_view word, std::string_view what) const {
  const auto digits = without_plus(word);
  double value = 0;
  const auto [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  const std::string_view rest(stop, digits.data() + digits.size());
  if (rest.starts_with('#') && digits.find(".#") != std::string_view::npos)
    return rest.starts_with("#INF") ? std::copysign(kInfinity, value) : std::numeric_limits<double>::quiet_NaN();
  if (rest.size() > 1 && (rest[0] == 'd' || rest[0] == 'D')) {
    std::string in_c(digits);
    in_c[digits.size() - rest.size()] = 'e';
    return real(in_c, what);
  }
  const bool whole = stop == digits.data() + digits.size();
  if (whole && error == std::errc::result_out_of_range) return beyond_range(digits);
  if (!whole || error != std::errc{})
    fail(std::string(what) + " is expected, but found " + in_quotes(word) +
         (word.find(',') == std::string_view::npos ? "" : ": numbers need decimal points"));
  return value;
}

std::int64_t Scanner::integer(std::string_view word, std::string_view what) const {
  const auto digits = without_plus(word);
  std::int64_t value = 0;
  const auto [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (stop != digits.data() + digits.size() || error != std::errc{})
    fail(std::string(what) + " is expected, but found " + in_quotes(word));
  return value;
}

std::int64_t Scanner::count(std::string_view word, std::string_view what, std::size_t bytes_each) const {
  const auto value = integer(word, what);
  if (value < 0) fail(std::string(what) + " is negative: " + std::to_string(value));
  const auto capacity =
      static_cast<std::uint64_t>(end_ - next_) / bytes_each + 1;  // the last word may lack its separator
  if (static_cast<std::uint64_t>(value) > capacity)
    fail(std::string(what) + " is " + std::to_string(value) + ", more than the rest of the file can hold");
  return value;
}

void Scanner::fail(std::string_view reason) const {
  throw InvalidMesh(file_->name + ", line " + std::to_string(line_) + ": " + std::string(reason));
}

}  // namespace holomorph::mesh
