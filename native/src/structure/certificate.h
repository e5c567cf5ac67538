// The measured errors of a solution.
#pragma once

#include "forms/certificates.h"

namespace holomorph::structure {

/// Errors of the solution, relative; see the functions that measure them.
struct Certificate {
  forms::Residuals residuals;  ///< largest of all forms, on the triangulation that was solved on
  double periods = 0;          ///< largest |int_{zeta_i} h_j - delta_ij|; with poles also |int over a link - residue|
  double pairing = 0;          ///< with boundary: largest |int h^N_i ^ h - (W c)_i| of one h = sum_j c_j h^D_j
  double asymmetry = 0;        ///< the asymmetry of the Gram matrix of streamed forms, before it was made symmetric
  double metric = 0;           ///< largest relative error of a triangle's energy from rounding; 1 if unknown
};

}  // namespace holomorph::structure
