#include "topology/homology.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "base/errors.h"

namespace holomorph::topology {

using mesh::edge_of;
using mesh::face_of;
using mesh::opposite;
using mesh::sign;

namespace {

constexpr double kLargest = 0x1p62;  // half of what fits: the bound below is rounded

std::int64_t checked_subtract_product(std::int64_t a, std::int64_t factor, std::int64_t b) {
  const double bound =
      std::abs(static_cast<double>(a)) + std::abs(static_cast<double>(factor) * static_cast<double>(b));
  if (bound > kLargest) throw Error("the canonical homology basis needs integers beyond 62 bits");
  return a - factor * b;
}

// Rows of S, and their products W(i, j) = S_i W S_j^T, kept up to date. Every step is a unimodular change of the rows.
class GramSchmidt {
 public:
  explicit GramSchmidt(const IntegerMatrix& W) : n_(W.rows()), rows_(IntegerMatrix::Identity(n_, n_)), W_(W) {}

  IntegerMatrix run() {
    for (Eigen::Index k = 0; k < n_; k += 2) {
      pair_ = k;
      make_pair(k);
      for (Eigen::Index i = k + 2; i < n_; ++i) {
        const std::int64_t with_e = W_(i, k), with_f = W_(i, k + 1);
        subtract(i, with_f, k);  // S_i - (S_i, f) e + (S_i, e) f is orthogonal to e and f, since (e, f) = 1
        subtract(i, -with_e, k + 1);
      }
    }
    IntegerMatrix S(n_, n_);
    for (Eigen::Index i = 0; i < n_ / 2; ++i) {
      S.row(i) = rows_.row(2 * i);
      S.row(n_ / 2 + i) = rows_.row(2 * i + 1);
    }
    return S;
  }

 private:
  // Makes (S_k, S_k+1) = 1: Euclid's algorithm on the products with S_k, whose greatest common divisor is 1.
  void make_pair(Eigen::Index k) {
    for (;;) {
      Eigen::Index least = -1, other = -1;
      for (Eigen::Index i = k + 1; i < n_; ++i) {
        if (W_(k, i) == 0) continue;
        if (least < 0 || std::abs(W_(k, i)) < std::abs(W_(k, least)))
          other = std::exchange(least, i);
        else if (other < 0)
          other = i;
      }
      if (least < 0) throw Error("the wedge matrix of the classes is not unimodular");
      if (std::abs(W_(k, least)) == 1) {
        swap(k + 1, least);
        if (W_(k, k + 1) < 0) negate(k + 1);
        return;
      }
      if (other < 0) throw Error("the wedge matrix of the classes is not unimodular");
      // The rest of the division is smaller than the least product: Euclid's algorithm goes on with it, until the least
      // is 1.
      subtract(other, W_(k, other) / W_(k, least), least);
    }
  }

  void subtract(Eigen::Index i, std::int64_t factor, Eigen::Index j) {
    if (factor == 0) return;
    for (Eigen::Index c = 0; c < n_; ++c) rows_(i, c) = checked_subtract_product(rows_(i, c), factor, rows_(j, c));
    // W stays the matrix of the products S_i W S_j^T, antisymmetric. Pairs before `pair_` are orthogonal to all rows.
    for (Eigen::Index c = pair_; c < n_; ++c) {
      if (W_(j, c) == 0 || c == i) continue;
      W_(i, c) = checked_subtract_product(W_(i, c), factor, W_(j, c));
      W_(c, i) = -W_(i, c);
    }
  }

  void swap(Eigen::Index i, Eigen::Index j) {
    if (i == j) return;
    rows_.row(i).swap(rows_.row(j));
    W_.row(i).swap(W_.row(j));
    W_.col(i).swap(W_.col(j));
  }

  void negate(Eigen::Index i) {
    rows_.row(i) *= -1;
    W_.row(i) *= -1;
    W_.col(i) *= -1;
  }

  Eigen::Index n_, pair_ = 0;
  IntegerMatrix rows_, W_;
};

using mesh::from_vertex;
using mesh::next;
using mesh::to_vertex;

void add_crossing(HalfedgeHandle leaving, int form, int direction, IntegerForms& forms) {
  forms.rows.edit(edge_of(leaving)).emplace_back(form, direction * sign(leaving));
}

// Adds the dual path inside D from one face to another: up to the common ancestor, then down.
void add_dual_path(const HalfEdges& half_edges, const FundamentalDomain& domain, int here, int there, int form,
                   IntegerForms& forms) {
  // Parents have lower ranks. So the face of higher rank is not an ancestor of the other one, and goes up.
  while (here != there) {
    if (domain.face_rank[here] > domain.face_rank[there]) {
      add_crossing(domain.to_parent_face[here], form, 1, forms);
      here = face_of(half_edges, opposite(domain.to_parent_face[here]));
    } else {
      add_crossing(domain.to_parent_face[there], form, -1, forms);
      there = face_of(half_edges, opposite(domain.to_parent_face[there]));
    }
  }
}

}  // namespace

IntegerForms::Row add(const IntegerForms::Row& a, const IntegerForms::Row& b, int factor) {
  IntegerForms::Row sum;
  auto x = a.begin();
  auto y = b.begin();
  while (x != a.end() || y != b.end()) {
    if (y == b.end() || (x != a.end() && x->first < y->first)) {
      sum.push_back(*x++);
    } else if (x == a.end() || y->first < x->first) {
      sum.emplace_back(y->first, factor * y->second);
      ++y;
    } else {
      const int value = x->second + factor * y->second;
      // Rows hold no zeros: equal rows are equal sheets.
      if (value != 0) sum.emplace_back(x->first, value);
      ++x;
      ++y;
    }
  }
  return sum;
}

IntegerForms concatenated(const IntegerForms& a, const IntegerForms& b) {
  IntegerForms both = a;
  both.form_count += b.form_count;
  for (const int e : b.rows.edges()) {
    for (const auto& [form, value] : b.rows[e]) both.rows.edit(e).emplace_back(a.form_count + form, value);
  }
  return both;
}

IntegerForms first_forms(const IntegerForms& forms, int count, int form_count) {
  IntegerForms first;
  first.form_count = form_count;
  first.rows.resize(forms.rows.size());
  for (const int e : forms.rows.edges()) {
    const auto part = forms_between(forms.rows[e], 0, count);
    first.rows.set(e, {part.begin(), part.end()});
  }
  return first;
}

void pull_back(const std::vector<mesh::Flip>& flips, IntegerForms& forms) {
  static const IntegerForms::Row kZero;
  for (const auto& [edge, a, b] : flips) {
    // -(value along a + value along b): closedness around the new triangle (mesh::Flip).
    const auto& row_a = forms.rows[mesh::edge_of(a)];
    const auto& row_b = forms.rows[mesh::edge_of(b)];
    forms.rows.set(
        edge, row_a.empty() && row_b.empty() ? kZero : add(add(kZero, row_a, -mesh::sign(a)), row_b, -mesh::sign(b)));
  }
}

IntegerMatrix product(const IntegerMatrix& A, const IntegerMatrix& B) {
  IntegerMatrix C = IntegerMatrix::Zero(A.rows(), B.cols());
  for (Eigen::Index i = 0; i < A.rows(); ++i) {
    for (Eigen::Index k = 0; k < A.cols(); ++k) {
      if (A(i, k) == 0) continue;
      for (Eigen::Index j = 0; j < B.cols(); ++j) C(i, j) = checked_subtract_product(C(i, j), -A(i, k), B(k, j));
    }
  }
  return C;
}

IntegerMatrix symplectic_basis(const IntegerMatrix& W) { return GramSchmidt(W).run(); }

CanonicalBasis canonical_basis(const IntegerMatrix& W) {
  const auto g = W.rows() / 2;
  CanonicalBasis basis;
  basis.classes = symplectic_basis(W);
  const IntegerMatrix& S = basis.classes;
  IntegerMatrix JS(2 * g, 2 * g);
  JS << S.bottomRows(g), -S.topRows(g);
  basis.intersection = product(S.transpose(), JS);  // -W^-1 = S^T J S, because S W S^T = J
  basis.cycles = product(-JS, W);                   // S^-T = -J S W, likewise
  return basis;
}

std::vector<std::vector<HalfedgeHandle>> homology_basis(const HalfEdges& half_edges, const FundamentalDomain& domain) {
  std::vector<std::vector<HalfedgeHandle>> loops;
  for (const int e : domain.left_over) {
    const HalfedgeHandle h(2 * e);
    int a = from_vertex(half_edges, h), b = to_vertex(half_edges, h);
    std::vector<HalfedgeHandle> from_b, towards_a;  // e, then b up to the common vertex, then down to a
    // As for faces: the vertex of higher rank goes up, until both paths meet.
    while (a != b) {
      if (domain.vertex_rank[b] > domain.vertex_rank[a]) {
        from_b.push_back(domain.to_parent_vertex[b]);
        b = to_vertex(half_edges, from_b.back());
      } else {
        towards_a.push_back(opposite(domain.to_parent_vertex[a]));
        a = from_vertex(half_edges, towards_a.back());
      }
    }
    std::vector<HalfedgeHandle> loop{h};
    loop.insert(loop.end(), from_b.begin(), from_b.end());
    loop.insert(loop.end(), towards_a.rbegin(), towards_a.rend());
    loops.push_back(std::move(loop));
  }
  return loops;
}

IntegerForms cohomology_basis(const HalfEdges& half_edges, const FundamentalDomain& domain) {
  IntegerForms forms;
  forms.rows.resize(half_edges.n_edges());
  for (const int e : domain.left_over) {  // out of the face at h, and back to it through D
    const HalfedgeHandle h(2 * e);
    const int i = forms.form_count++;
    add_crossing(h, i, 1, forms);
    add_dual_path(half_edges, domain, face_of(half_edges, opposite(h)), face_of(half_edges, h), i, forms);
  }
  return forms;
}

void add_paths_between_loops(const HalfEdges& half_edges, const FundamentalDomain& domain, IntegerForms& forms) {
  for (std::size_t k = 1; k < domain.gaps.size(); ++k) {
    // The dual path enters the surface at the gap of loop k, against the half-edge of the face there, and leaves it at
    // the gap of loop 0.
    const HalfedgeHandle in = opposite(domain.gaps[k]), out = opposite(domain.gaps[0]);
    const int i = forms.form_count++;
    add_crossing(in, i, -1, forms);
    add_dual_path(half_edges, domain, face_of(half_edges, in), face_of(half_edges, out), i, forms);
    add_crossing(out, i, 1, forms);
  }
}

void add_loop_indicators(const HalfEdges& half_edges, const mesh::BoundaryLoops& boundary, IntegerForms& forms) {
  const int first = forms.form_count - 1;  // loop k >= 1 is form first + k
  forms.form_count += boundary.count() - 1;
  for (int e = 0; e < static_cast<int>(half_edges.n_edges()); ++e) {
    const HalfedgeHandle h(2 * e);
    const int head = boundary.loop_of_vertex[to_vertex(half_edges, h)],
              tail = boundary.loop_of_vertex[from_vertex(half_edges, h)];
    if (head == tail) continue;
    auto& row = forms.rows.edit(e);
    if (head > 0) row.emplace_back(first + head, 1);
    if (tail > 0) row.emplace_back(first + tail, -1);
    // Rows ascend by form.
    if (head > 0 && tail > 0 && tail < head) std::swap(row.back(), row[row.size() - 2]);
  }
}

IntegerForms natural_classes(const HalfEdges& half_edges, const FundamentalDomain& domain) {
  auto classes = cohomology_basis(half_edges, domain);
  if (domain.boundary.count() > 1) add_paths_between_loops(half_edges, domain, classes);
  return classes;
}

IntegerForms relative_classes(const HalfEdges& half_edges, const mesh::BoundaryLoops& boundary,
                              const IntegerForms& natural) {
  const int handles = natural.form_count - (boundary.count() - 1);
  auto relative = first_forms(natural, handles, handles);
  add_loop_indicators(half_edges, boundary, relative);
  return relative;
}

IntegerMatrix pairing(const HalfEdges& half_edges, const IntegerForms& a, const IntegerForms& b) {
  // Twice the sum over faces of the wedge (a(h0) b(h1) - a(h1) b(h0)) / 2 (docs/method/conventions.md). It is even, as
  // W is an integer.
  IntegerMatrix twice = IntegerMatrix::Zero(a.form_count, b.form_count);
  for (int f = 0; f < static_cast<int>(half_edges.n_faces()); ++f) {
    const HalfedgeHandle h0 = half_edges.halfedge_handle(mesh::FaceHandle(f)), h1 = next(half_edges, h0);
    const int factor = sign(h0) * sign(h1), e0 = edge_of(h0), e1 = edge_of(h1);
    for (const auto& [i, x] : a.rows[e0]) {
      for (const auto& [j, y] : b.rows[e1]) twice(i, j) += factor * x * y;
    }
    for (const auto& [i, x] : a.rows[e1]) {
      for (const auto& [j, y] : b.rows[e0]) twice(i, j) -= factor * x * y;
    }
  }
  return twice / 2;
}

IntegerMatrix wedge_matrix(const HalfEdges& half_edges, const IntegerForms& forms, Execution& execution) {
  const int n = forms.form_count;
  IntegerMatrix twice = IntegerMatrix::Zero(n, n);
  std::vector<int> faces;  // where some form is not 0
  for (const int e : forms.rows.edges()) {
    for (const HalfedgeHandle h : {HalfedgeHandle(2 * e), HalfedgeHandle(2 * e + 1)}) {
      if (!half_edges.is_boundary(h)) faces.push_back(face_of(half_edges, h));
    }
  }
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  for (std::size_t i = 0; i < faces.size(); ++i) {
    execution.step(i, faces.size(), 0.0, 0.5);
    const int f = faces[i];
    const HalfedgeHandle h0 = half_edges.halfedge_handle(mesh::FaceHandle(f)), h1 = next(half_edges, h0);
    const int factor = sign(h0) * sign(h1);
    for (const auto& [i, x] : forms.rows[edge_of(h0)]) {
      for (const auto& [j, y] : forms.rows[edge_of(h1)]) {
        twice(i, j) += factor * x * y;
        twice(j, i) -= factor * x * y;
      }
    }
  }
  return twice / 2;
}

IntegerForms pole_classes(const HalfEdges& half_edges, const FundamentalDomain& domain,
                          const std::vector<mesh::Star>& stars) {
  const bool closed = domain.gaps.empty();
  const HalfedgeHandle out = closed ? stars.back().link[0] : opposite(domain.gaps[0]);
  IntegerForms forms;
  forms.form_count = static_cast<int>(stars.size()) - (closed ? 1 : 0);
  forms.rows.resize(half_edges.n_edges());
  for (int i = 0; i < forms.form_count; ++i) {
    int here = face_of(half_edges, stars[i].link[0]), there = face_of(half_edges, out);
    // Up from both ends to their common ancestor in D. Faces of stars are leaves of D, so no path crosses another star.
    while (here != there) {
      const bool leaving = domain.face_rank[here] > domain.face_rank[there];
      int& face = leaving ? here : there;
      const HalfedgeHandle h = domain.to_parent_face[face];
      forms.rows.edit(edge_of(h)).emplace_back(i, leaving ? sign(h) : -sign(h));
      face = face_of(half_edges, opposite(h));
    }
    // Through the gap of boundary loop 0, out of the surface.
    if (!closed) forms.rows.edit(edge_of(out)).emplace_back(i, sign(out));
  }
  return forms;
}

}  // namespace holomorph::topology
