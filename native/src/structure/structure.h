// The conformal structure of a surface: harmonic forms, differentials made of them, and the conformal invariants.
#pragma once

#include <complex>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/execution.h"
#include "mesh/half_edges.h"
#include "structure/certified_forms.h"
#include "structure/harmonic_solver.h"
#include "uv/uv_map.h"

namespace holomorph::structure {

// Which vertices become poles, with which residues.

/// theta has the residue residues[i] / (2 pi i) at vertices[i]: UV changes by residues[i] around it, counter-clockwise.
struct Poles {
  std::vector<int> vertices;
  std::vector<std::complex<double>> residues;
  std::vector<int> labels;  ///< #V what a vertex is called in messages; empty: its index
};

/// Finds two vertices far apart. Takes the vertex farthest from vertex 0 along the edges, then the one farthest from
/// that, and goes on as long as the distance grows. Their stars are apart; ties go to the lower index.
/// @throws TopologyError if no two stars are apart
std::vector<int> far_apart(const mesh::Surface& surface, const mesh::HalfEdges& half_edges);

/// Finds the vertex farthest from the boundary, along edges, among those whose star does not touch the boundary.
/// @throws TopologyError if there is none
int deepest_vertex(const mesh::Surface& surface, const mesh::HalfEdges& half_edges);

/// Returns the default residues: 1 and -1 for two poles of a closed surface. For more poles, the one with the largest
/// sum of distances to the others takes minus the number of the others, which have 1. With a boundary all have 1.
/// @throws Cancelled
/// Cost: for more than two poles of a closed surface, a search over the whole surface from each.
std::vector<std::complex<double>> default_residues(const mesh::Surface& surface, const mesh::HalfEdges& half_edges,
                                                   const std::vector<int>& vertices, bool closed, Execution& execution);

/// @throws TopologyError for vertices repeated or out of range, and for another number of residues than poles. A
/// residue must be finite and not 0. A closed surface needs two poles at least, and residues that sum to 0
void check_poles(const Poles& poles, int vertex_count, bool closed);

/// Solves for the harmonic forms of the topology's classes on the discretisation of `solver`, keeps or streams them as
/// its plan says, and measures them.
/// @pre the surface has handles or at least two boundary loops. @throws SolverError, Cancelled
HarmonicForms harmonic_forms(const mesh::Surface& surface, const Topology& topology, HarmonicSolver& solver,
                             Execution& execution);

/// Solves for the functions alone, #V x #forms. Those of the loops' harmonic measures are 1 on their loops.
/// @throws SolverError, Cancelled
forms::RowMajorMatrix harmonic_functions(const Topology& topology, HarmonicSolver& solver, Execution& execution);

/// What belongs to the poles of a differential of the third kind.
struct PoleData {
  Poles chosen;
  std::vector<mesh::Star> stars;
  Eigen::MatrixXd harmonic_part;  ///< #natural x #pole forms: C, with omega_i = d(u_i - sum_j C_ji h_j) + i dv_i
};

/// How a structure was solved for.
struct SolveRecord {
  SolverReport solver;
  MemoryPlan memory;
  double mollification = 0;  ///< added to some lengths; with 0 energies are of the surface's metric
  int flip_count = 0;        ///< flips to the intrinsic Delaunay triangulation
  std::vector<std::pair<std::string, double>> seconds;  ///< per stage
};

/// One connected surface of any kind: closed with handles, with boundary, with poles. A differential is a column of
/// complex coefficients of the real harmonic forms. UVs, values on edges and balance are the same few products for all
/// kinds.
struct Structure {
  std::shared_ptr<const mesh::Surface> surface;  ///< diagonals that ended at poles are flipped
  Topology topology;
  std::optional<PoleData> poles;
  /// With poles, the functions of the pole forms, u_1 .. u_k, v_1 .. v_k, follow the others in `harmonic.functions`.
  HarmonicForms harmonic;
  Eigen::MatrixXcd differentials;  ///< #forms x n: with poles theta_0 of the chosen residues, then holomorphic ones
  SolveRecord record;

  /// The stars of the poles.
  std::span<const mesh::Star> stars() const {
    return poles ? std::span<const mesh::Star>(poles->stars) : std::span<const mesh::Star>();
  }
  const forms::HolomorphicBasis& holomorphic() const { return harmonic.invariants.holomorphic; }
};

/// Writes the UVs, #C x 2, of the real and imaginary part of sum_k p_k h_k, from its function sum_k p_k f_k, #V x 2.
/// Triangles of the stars of poles have an apex each (mesh/stars.h).
/// @throws SolverError where a UV is not finite
void write_uv_map(const Structure& structure, const uv::UvArray& function, const Eigen::VectorXcd& p,
                  Eigen::Ref<uv::UvArray> corners, Workers& workers);

/// Computes the UV area of the surface under a holomorphic form sum_k p_k h_k: the energy <r, r> of its real part r.
double uv_area(const Structure& structure, const Eigen::VectorXcd& p);

/// Cuts the structure along the caller's polygon edges instead; the spokes of poles are cut in any case.
/// @param labels what a vertex is called in messages; empty: its index
/// @throws TopologyError where the map still jumps elsewhere
Structure cut_along(Structure structure, std::vector<int> edges, const std::vector<int>& labels, Execution& execution);

/// The edges between poles and their links, ascending.
std::vector<int> spokes(const Structure& structure);

/// Checks that invariants are finite, that the linear systems were solved to what is promised, and that bounds do not
/// cross. @throws SolverError
void require_guaranteed(const Structure& structure);

}  // namespace holomorph::structure
