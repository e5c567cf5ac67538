// The errors of the library. Each says whose fault it is; the message is one sentence that names the first bad element.
#pragma once

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

}  // namespace holomorph
