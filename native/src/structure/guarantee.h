// What is promised of every result when it leaves, checked in one place.
#pragma once

#include "structure/structure.h"

namespace holomorph::structure {

/// Checks that invariants are finite, that the linear systems were solved to what is promised, and that bounds do not
/// cross. @throws SolverError
void require_guaranteed(const Structure& structure);

}  // namespace holomorph::structure
