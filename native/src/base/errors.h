// The errors of the library. Each says whose fault it is; the message is one sentence that names the first bad element.
#pragma once

#include <ranges>
#include <source_location>
#include <stdexcept>
#include <string>

namespace holomorph {

class Error : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The input is not a valid polygon mesh, or a file is malformed.
class InvalidMesh : public Error {
  using Error::Error;
};

/// The mesh is valid, but its topology does not fit what was asked for.
class TopologyError : public Error {
  using Error::Error;
};

/// A linear system was not solved to the accuracy asked for, or would not fit into memory.
class SolverError : public Error {
  using Error::Error;
};

/// The caller's progress function asked to stop.
class Cancelled : public Error {
  using Error::Error;
};

// What may be missing is asked before it is read.

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
