// Harmonic forms with what is certified of them: energies with their rounding, invariants (paper § 7, § 9), errors.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/execution.h"
#include "forms/certificates.h"
#include "forms/closed_forms.h"
#include "forms/gram_matrices.h"
#include "forms/holomorphic_basis.h"
#include "mesh/components.h"
#include "mesh/delaunay.h"
#include "topology/homology.h"
#include "topology/pulled_back_classes.h"
#include "uv/balance.h"
#include "uv/uv_map.h"

namespace holomorph::structure {

// What is known of a surface from its triangles alone, in exact integers (paper § 4, § 5).

/// The families of a basis of harmonic forms, in the order of its forms.
struct Families {
  int natural = 0;    ///< dual to the homology basis, d* h = 0 at every vertex
  int dirichlet = 0;  ///< with boundary as many: zero along the boundary. The 2g handle classes, then the harmonic
                      ///< measures of the loops 1 .. b-1
  int poles = 0;      ///< pairs of the third kind: u_1 .. u_k, then v_1 .. v_k

  int harmonic() const { return natural + dirichlet; }
  int count() const { return harmonic() + 2 * poles; }
};

struct Topology {
  mesh::TopologicalType type;
  mesh::BoundaryLoops boundary;                                   ///< none on a closed surface
  std::vector<std::vector<mesh::HalfedgeHandle>> homology_basis;  ///< 2g loops zeta_i, then boundary loops 1 .. b-1
  topology::IntegerMatrix pairing;     ///< W_ij = int h_i ^ h^D_j, |det| 1; closed: the wedge matrix; with boundary
                                       ///< [[J_h, 0], [X, 1]]
  topology::CanonicalBasis canonical;  ///< only on a closed surface with handles
  Families families;
  topology::IntegerForms classes;  ///< classes of the whole basis, on the edges of the surface
  std::vector<int> seams;          ///< edges of the cut graph, and of the spokes of poles
  uv::CoveringSheets sheets;       ///< integer potentials of the classes
};

/// Finds fundamental domain, homology basis, dual classes, pairing and cut.
/// @param given lifted loops and pulled-back dual classes of a progressive mesh's base
/// @param stars of poles
/// @pre connected, no isolated vertices
/// @throws Cancelled. Cost: near-linear; see topology::fundamental_domain
Topology find_topology(const mesh::Surface& surface, const mesh::HalfEdges& half_edges, Execution& execution,
                       std::optional<topology::DualBases> given = {}, const std::vector<mesh::Star>& stars = {});

/// Returns the classes whose harmonic forms are solved for, on any triangulation of the same vertices. They are the
/// natural ones, and with boundary the Dirichlet ones: those of the handles and d(1 on loop k, 0 elsewhere).
/// @param half_edges,flips of that triangulation, flipped from the surface's own
topology::IntegerForms classes_on(const Topology& topology, const mesh::HalfEdges& half_edges,
                                  const std::vector<mesh::Flip>& flips);

/// Adds 1 on boundary loop k to the function of its Dirichlet form, whose class in `Topology::classes` is 0. The
/// results are the harmonic measures of the loops.
void add_loop_indicators(const Topology& topology, Eigen::Ref<forms::RowMajorMatrix> functions);

/// Errors of the solution, relative; see the functions that measure them.
struct Certificate {
  forms::Residuals residuals;  ///< largest of all forms, on the triangulation that was solved on
  double periods = 0;          ///< largest |int_{zeta_i} h_j - delta_ij|; with poles also |int over a link - residue|
  double pairing = 0;          ///< with boundary: largest |int h^N_i ^ h - (W c)_i| of one h = sum_j c_j h^D_j
  double asymmetry = 0;        ///< the asymmetry of the Gram matrix of streamed forms, before it was made symmetric
  double metric = 0;           ///< largest relative error of a triangle's energy from rounding; 1 if unknown
};

/// The relative amount by which bounds may cross: rounding, where no triangle is thin.
inline constexpr double kCertain = 1e-11;
/// The largest relative change of an energy by rounding that is accepted: beyond it, not even the first digit is
/// certain.
inline constexpr double kMostUncertain = 0.5;

/// Gram matrices of forms, one for each family, and matrices that are certainly not below those of the surface.
struct CertainGram {
  std::vector<Eigen::MatrixXd> gram, certain;
};

/// Adds to each Gram matrix the bound of its rounding: G + E.
/// @param errors E for each of `gram`, or none where they are negligible
/// @throws SolverError where E is more than kMostUncertain of G
CertainGram certain_gram(std::vector<Eigen::MatrixXd> gram, const std::vector<Eigen::MatrixXd>& errors);

/// The same of measured Gram matrices, one for each family.
CertainGram certain_energies(const std::vector<forms::GramMatrix>& measured);

/// Measures the energies of forms on a discretisation. @param families numbers of forms
/// @throws SolverError where rounding leaves no digit
CertainGram certain_energies(const mesh::Discretisation& discretisation, const forms::ClosedForms& forms,
                             const std::vector<int>& families, Execution& execution);

/// Checks that lower <= upper as quadratic forms. @param allowed amount by which they may cross, relative to the upper
/// bound
/// @throws SolverError where bounds are not finite or cross
void require_ordered(const Eigen::MatrixXd& lower, const Eigen::MatrixXd& upper, double allowed = kCertain);

/// Reports a failure that triangles too thin for double precision cause. @throws SolverError always
[[noreturn]] void refuse(const std::string& what, double size, double allowed);

struct Invariants {
  CertainGram energies;                 ///< energies of the natural and, with boundary, the Dirichlet forms
  forms::HolomorphicBasis holomorphic;  ///< star, holomorphic basis and period matrix (Eq. 13) with its bounds
};

/// @throws SolverError, Cancelled
Invariants invariants(const Topology& topology, CertainGram energies, Execution& execution);

/// The harmonic forms eta_j + d f_j of a surface, measured.
struct HarmonicForms {
  std::shared_ptr<const forms::RowMajorMatrix> functions;  ///< #V x #forms; null if streamed
  uv::FormSamples samples;                                 ///< samples of streamed forms, for the balance
  Invariants invariants;
  Certificate certificate;
};

/// Measures functions that were solved for: energies and what follows from them, and the certificate.
/// @param classes those of the topology on the discretisation, see classes_on
/// @param functions #V x #forms. @throws SolverError
HarmonicForms measured(const mesh::Surface& surface, const Topology& topology,
                       const mesh::Discretisation& discretisation, const topology::IntegerForms& classes,
                       forms::RowMajorMatrix functions, Execution& execution);

}  // namespace holomorph::structure
