// What follows from the harmonic forms (paper § 7, § 9).
#pragma once

#include <span>

#include "base/execution.h"
#include "structure/structure.h"

namespace holomorph::structure {

/// What follows from the harmonic forms: Gram matrices, star, holomorphic basis, period matrix (paper § 7, Eq. 13), and
/// the certificate.
/// @param triangulation,weights,classes what was solved on, and the classes there
/// @param errors mesh::energy_errors of the weights, or none
/// @param result with its topology and functions
/// @throws SolverError
void complete(const mesh::HalfEdges& triangulation, std::span<const double> weights, std::span<const double> errors,
              const topology::IntegerForms& classes, Structure& result, Execution& execution);

/// Gram matrices of forms, one for each family, and matrices that are certainly not below those of the surface.
struct CertainGram {
  std::vector<Eigen::MatrixXd> gram, certain;
};

/// @param errors mesh::energy_errors of the weights, or none. @param families numbers of forms
/// @throws SolverError where rounding leaves no digit
CertainGram certain_energies(const mesh::HalfEdges& triangulation, std::span<const double> weights,
                             std::span<const double> errors, const forms::ClosedForms& forms,
                             const std::vector<int>& families, Execution& execution);

/// The star, the holomorphic basis and the period matrix from the Gram matrices alone. @throws SolverError
void set_holomorphic_basis(Structure& result);

}  // namespace holomorph::structure
