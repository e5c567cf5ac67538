// Harmonic forms for the artist's triangles.
#pragma once

#include <memory>
#include <optional>

#include "pipeline/bounded_structure.h"
#include "pipeline/conformal_structure.h"

namespace holomorph::pipeline {

/// The harmonic representatives of the same classes on the artist's own triangulation, for UVs.
///
/// Invariants are sharpest on the intrinsic Delaunay triangulation, but its functions are linear on other triangles
/// than the artist's: across a sliver the UVs made of them may collapse or turn over. The functions here have the least
/// conformal energy on the triangles that the UVs are drawn on. Where the intrinsic functions come within 1e-9 of that
/// (relative; their energy on the artist's triangles bounds the gain from above), they are taken as they are.
/// @throws SolverError, Cancelled
HarmonicForms artist_forms(const mesh::Surface& surface, const BoundedStructure& structure, const Options& options,
                           Execution& execution);

/// sum_k p_k f_k, #V x 2: real and imaginary part.
uv::UvArray combination(const forms::RowMajorMatrix& functions, const Eigen::VectorXcd& p, Workers& workers);

/// Writes the values of these forms on all edges, one row each.
void write_edge_values(const mesh::EdgeEnds& ends, const forms::ClosedForms& forms,
                       Eigen::Ref<forms::RowMajorMatrix> rows);

/// The forms for UVs of a structure that has an overload of artist_forms, solved for when first asked for.
/// Each call may throw SolverError and Cancelled, and may be asked again. The arguments outlive this.
template <class Value>
class KeptForms {
 public:
  KeptForms(const mesh::Surface& surface, const Value& structure, const Options& options)
      : surface_(surface), structure_(structure), options_(options) {}

  /// Does what all calls below need; they do it themselves otherwise.
  void prepare(Execution& execution) {
    if (!forms_) forms_ = artist_forms(surface_, structure_, options_, execution);
  }
  /// sum_k p_k f_k, #V x 2: real and imaginary part.
  uv::UvArray function(const Eigen::VectorXcd& p, Execution& execution) {
    prepare(execution);
    return combination(forms_->forms.functions, p, execution.workers());
  }
  /// Writes the values of all forms on the edges, #forms x #E row by row, to `values`.
  void edge_values(double* values, Execution& execution) {
    prepare(execution);
    const auto count = forms_->forms.functions.cols(), edges = static_cast<Eigen::Index>(surface_.edges.size());
    write_edge_values(surface_, forms_->forms, Eigen::Map<forms::RowMajorMatrix>(values, count, edges));
  }
  /// What the balance needs.
  uv::FormSamples samples(Execution& execution) {
    prepare(execution);
    auto triangles = uv::sample_triangles(surface_);
    auto values = uv::values_on_sides(surface_, forms_->forms, triangles);
    return {std::move(triangles), std::move(values)};
  }
  const SolverReport& solver() const { return forms_->solver; }

 private:
  const mesh::Surface& surface_;
  const Value& structure_;
  const Options& options_;
  std::optional<HarmonicForms> forms_;
};

/// The same of a closed surface, whose plan says whether the forms are kept. Where they are not, each call solves for
/// what it is asked for; the factor or hierarchy is kept between calls, and samples are those of the intrinsic
/// triangulation. Where they are, the functions of `structure` are taken over or given up.
class ArtistForms {
 public:
  ArtistForms(const mesh::Surface& surface, ConformalStructure& structure, const Options& options)
      : surface_(surface), structure_(structure), options_(options) {}

  void prepare(Execution& execution);
  uv::UvArray function(const Eigen::VectorXcd& p, Execution& execution);
  void edge_values(double* values, Execution& execution);
  uv::FormSamples samples(Execution& execution);
  const SolverReport& solver() const { return report_; }

 private:
  void prepare_all(Execution& execution);
  void prepare_solver(Execution& execution);
  forms::RowMajorMatrix solve(const Eigen::MatrixXd& right_hand_sides, Execution& execution);

  const mesh::Surface& surface_;
  ConformalStructure& structure_;
  const Options& options_;
  bool ready_ = false, given_up_ = false;  // the second: the functions of the intrinsic triangulation
  SolverReport report_;
  // Of streamed forms alone:
  solver::Choice choice_;
  Array<double> weights_;
  std::unique_ptr<solver::LaplaceSolver> solver_;
};

}  // namespace holomorph::pipeline
