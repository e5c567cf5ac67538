#include "tiling/rounding/rounding_problem.h"

#include "linear/dense.h"
#include "tiling/rounding/rounding_metric.h"

namespace holomorph::tiling {
namespace {

struct Sizes {
  Index n, loops, handles, k, l;  // `handles`: loops with v-periods besides, if boundary loops are straight
};

// Sets for each integer the period or residue that it belongs to, and the translation that it counts.
void set_integers(const TextureLattice& lattice, const Sizes& size, bool real, RoundingProblem& p) {
  const Index both = (real ? size.loops + size.handles : 2 * size.loops), D = both + (real ? 1 : 2) * size.k;
  p.periods = MatrixXcd::Zero(size.loops, D);
  p.residues = MatrixXcd::Zero(size.k, D);
  Index column = 0;
  for (Index j = 0; j < size.loops; ++j) {
    p.periods(j, column++) = lattice.a;
    if (!real || j < size.handles) p.periods(j, column++) = lattice.b;
  }
  for (Index i = 0; i < size.k; ++i) {
    p.residues(i, column++) = lattice.a;
    if (!real) p.residues(i, column++) = lattice.b;
  }
}

// A of the Dirichlet forms of the handles on the samples, up to the factor i. Forms of the loops, whose periods are
// free, are subtracted so that the energy is least.
MatrixXcd handle_forms(const PoleBasis& basis, const Sizes& size) {
  if (size.handles == 0) return MatrixXcd(static_cast<Index>(basis.samples().size()), 0);
  const MatrixXd& G = basis.structure().holomorphic().star.dirichlet_gram;
  const Index holes = size.n - size.handles;
  MatrixXd q = MatrixXd::Zero(size.n, size.handles);
  q.topRows(size.handles).setIdentity();
  if (holes > 0)
    q.bottomRows(holes) = -linear::solve_symmetric(MatrixXd(G.bottomRightCorner(holes, holes)),
                                                   MatrixXd(G.bottomLeftCorner(holes, size.handles)));
  return 0.5 * basis.derivatives(basis.samples()).rightCols(size.n) * q;
}

}  // namespace

RoundingProblem rounding_problem(const MeromorphicForm& form, const GreensFunctions& greens, uv::Coefficients kind,
                                 const TextureLattice& lattice, const MatrixXd& parts, const Jacobian* jacobian,
                                 Execution& execution) {
  const PoleBasis& basis = greens.basis();
  const bool real = kind == uv::Coefficients::real, closed = basis.closed();
  const auto& topology = basis.structure().topology;
  Sizes size{basis.form_count(), topology.families.natural, real ? 2 * topology.type.genus : 0, parts.cols(), 0};
  size.l = closed ? size.n : size.handles;
  RoundingProblem p;
  p.kind = kind;
  p.lattice = lattice;
  set_integers(lattice, size, real, p);

  const MatrixXcd at_poles = greens.pole_forms(form.poles);
  p.forms.resize(at_poles.rows(), size.n + size.k + size.l);
  p.target = VectorXcd::Zero(p.forms.cols());
  p.target.head(size.n) = form.coefficients;
  p.target.segment(size.n, size.k) = form.residues.head(size.k);

  // Columns: X and the residues for each integer. Z takes the integers on to coefficients.
  const MatrixXcd X = p.periods + parts * p.residues;
  p.Z = MatrixXcd::Zero(p.forms.cols(), p.periods.cols());
  p.Z.middleRows(size.n, size.k) = p.residues;
  if (closed) {
    // theta = M dz + N d conj(z), so conj(theta) has A = conj(N) and B = conj(M).
    p.forms << basis.holomorphic().M, at_poles, basis.holomorphic().N.conjugate();
    p.defects = basis.holomorphic().M.conjugate();
    if (jacobian) {
      const MatrixXcd split = product(jacobian->split(), X, execution);
      p.Z.topRows(size.n) = split.topRows(size.n);
      p.Z.bottomRows(size.l) = split.bottomRows(size.l);
    }
  } else {
    const MatrixXcd of_handles = handle_forms(basis, size);
    // A real form is A dz + conj(A) d conj(z), and v enters with i.
    p.forms << basis.holomorphic().M, at_poles, Complex(0, 1) * of_handles;
    p.defects = Complex(0, 1) * of_handles.conjugate();
    p.Z.topRows(size.n) = real ? MatrixXcd(X.real().cast<Complex>()) : X;
    const MatrixXd& star = basis.structure().holomorphic().star.star;
    if (size.l > 0) {
      p.Z.bottomRows(size.l) =
          (p.periods.topRows(size.l).imag() - (star.transpose() * X.real()).topRows(size.l)).cast<Complex>();
    }
  }
  p.target_density = (p.forms * p.target).cwiseAbs2().array();
  p.target_ratio = density_ratio(p.target_density);
  p.defect_metric = defect_metric(p.defects, p.target_density, execution);
  return p;
}

}  // namespace holomorph::tiling
