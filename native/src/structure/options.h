// What a caller chooses about the solution.
#pragma once

#include <cstdint>
#include <string>

namespace holomorph::structure {

/// How the forms of a surface with boundary are found: on the surface itself, or over its double (paper § 8).
enum class Boundary { natural, double_cover };

struct Options {
  std::string solver = "auto";    ///< "auto", "direct" or "multigrid"
  std::int64_t memory_limit = 0;  ///< bytes, 0: none; see plan_memory
  Boundary boundary = Boundary::natural;
};

}  // namespace holomorph::structure
