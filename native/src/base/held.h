// What may be missing is asked before it is read.
#pragma once

#include <ranges>
#include <source_location>
#include <stdexcept>
#include <string>

namespace holomorph {

/// Our own fault: what had to be there is not. Reading on would end the program, and Blender with it.
[[noreturn]] inline void throw_missing(const std::source_location& where) {
  throw std::logic_error(std::string("a value is missing: ") + where.function_name());
}

/// What an optional or a pointer holds. @throws std::logic_error where that is nothing
template <class Holder>
auto& held(Holder& holder, const std::source_location& where = std::source_location::current()) {
  if (!holder) throw_missing(where);
  return *holder;
}

/// What an iterator of a range leads to. @throws std::logic_error at its end
template <std::ranges::range Range>
auto& held(std::ranges::iterator_t<Range> found, Range& range,
           const std::source_location& where = std::source_location::current()) {
  if (found == std::ranges::end(range)) throw_missing(where);
  return *found;
}

}  // namespace holomorph
