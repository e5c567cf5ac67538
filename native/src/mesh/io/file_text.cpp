#include "mesh/io/file_text.h"

#include <algorithm>

#include "base/errors.h"

namespace holomorph::mesh {

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

}  // namespace holomorph::mesh
