// Homology: bases of loops and of classes, with handles, boundary loops and poles.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/execution.h"
#include "mesh/intrinsic_surface.h"
#include "topology/domain.h"

namespace holomorph::topology {

// Closed one-forms with integer values, sparse: most edges have the value 0 in every form.

/// For each edge a list of (form, value), value != 0, ascending by form. Most lists are empty, so memory is kept by
/// pages of edges: a page whose lists are all empty takes one number.
class EdgeRows {
 public:
  using Row = std::vector<std::pair<int, int>>;

  std::size_t size() const { return size_; }
  void resize(std::size_t edges) {
    size_ = edges;
    page_of_.resize((edges + kPage - 1) / kPage, 0);
  }

  const Row& operator[](std::size_t edge) const { return rows_[pages_[page_of_[edge / kPage]][edge % kPage]]; }
  /// Returns the row, to be changed. The first call for an edge invalidates references to rows.
  Row& edit(std::size_t edge) {
    int& place = page(edge / kPage)[edge % kPage];
    if (place == 0) {
      place = static_cast<int>(rows_.size());
      rows_.emplace_back();
      edges_.push_back(static_cast<int>(edge));
    }
    return rows_[place];
  }
  void set(std::size_t edge, Row row) {
    if (!row.empty() || !(*this)[edge].empty()) edit(edge) = std::move(row);
  }

  /// The edges whose rows are not empty, and perhaps some others; ascending.
  std::vector<int> edges() const {
    std::vector<int> ascending = edges_;
    std::sort(ascending.begin(), ascending.end());
    return ascending;
  }

 private:
  static constexpr std::size_t kPage = 64;
  using Page = std::array<int, kPage>;  // number of each edge's row; 0 is the empty one

  Page& page(std::size_t number) {
    if (page_of_[number] == 0) {
      page_of_[number] = static_cast<int>(pages_.size());
      pages_.push_back({});
    }
    return pages_[page_of_[number]];
  }

  std::size_t size_ = 0;
  std::vector<int> page_of_;    // page of each group of kPage edges
  std::vector<Page> pages_{1};  // one of empty rows, then those with rows
  std::vector<Row> rows_{1};    // an empty one, then those of edges_
  std::vector<int> edges_;
};

/// m closed forms. The values in row e belong to the direction of half-edge 2e, from the lower to the higher vertex.
struct IntegerForms {
  using Row = EdgeRows::Row;
  int form_count = 0;
  EdgeRows rows;  ///< #E
};

/// The entries of a row that belong to the forms begin .. end - 1.
struct RowPart {
  IntegerForms::Row::const_iterator first, last;
  auto begin() const { return first; }
  auto end() const { return last; }
};
inline RowPart forms_between(const IntegerForms::Row& row, int begin, int end) {
  if (row.empty()) return {row.end(), row.end()};
  const auto before = [](const std::pair<int, int>& entry, int form) { return entry.first < form; };
  return {std::lower_bound(row.begin(), row.end(), begin, before),
          std::lower_bound(row.begin(), row.end(), end, before)};
}

/// a + factor * b
IntegerForms::Row add(const IntegerForms::Row& a, const IntegerForms::Row& b, int factor);

/// The forms of `a`, followed by those of `b`.
IntegerForms concatenated(const IntegerForms& a, const IntegerForms& b);

/// The first `count` forms, and zeros up to `form_count`.
IntegerForms first_forms(const IntegerForms& forms, int count, int form_count);

/// Replaces the forms by the same closed forms on a triangulation that was flipped: exact, by closedness.
void pull_back(const std::vector<mesh::Flip>& flips, IntegerForms& forms);

// Canonical bases, in exact integers.

using IntegerMatrix = Eigen::Matrix<std::int64_t, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// A B. Its cost is in proportion to the numbers of A other than 0.
/// @throws holomorph::Error if an entry leaves 64 bits
IntegerMatrix product(const IntegerMatrix& A, const IntegerMatrix& B);

/// Computes integer S with S W S^T = J = [[0, I], [-I, 0]], |det S| = 1, by symplectic Gram-Schmidt. Its rows are a
/// canonical basis.
/// @param W antisymmetric, |det| 1. @throws holomorph::Error if an entry leaves 64 bits
IntegerMatrix symplectic_basis(const IntegerMatrix& W);

struct CanonicalBasis {
  IntegerMatrix intersection;  ///< zeta_i . zeta_j = -W^-1
  IntegerMatrix cycles;        ///< R: rows a_1..a_g, b_1..b_g written in the zeta; R intersection R^T = J
  IntegerMatrix classes;       ///< S = R^-T: rows alpha_1..alpha_g, beta_1..beta_g written in the eta
};

CanonicalBasis canonical_basis(const IntegerMatrix& wedge);

/// Returns 2g closed loops zeta_i of consecutive half-edges: e_i in its own direction, closed through T. The common
/// part of both paths to the root cancels.
std::vector<std::vector<HalfedgeHandle>> homology_basis(const HalfEdges& half_edges, const FundamentalDomain& domain);

/// Returns 2g closed integer forms eta_i with eta_i(zeta_j) = delta_ij. The value on an edge is the signed number of
/// times it is crossed by the dual loop that closes e_i in D. Leaving a face through a half-edge counts +1 along it.
/// The paper's § 5 recursion gives a form of the same class; this one is its special case with all free choices 0.
IntegerForms cohomology_basis(const HalfEdges& half_edges, const FundamentalDomain& domain);

/// Appends b - 1 classes: the signed crossings of the dual path that enters through e_k, runs in D and leaves through
/// e_0, k = 1 .. b-1. Class k has the period 1 over boundary loop k, the hole on its left, and -1 over loop 0. Its
/// periods over the other loops and the zeta are 0.
void add_paths_between_loops(const HalfEdges& half_edges, const FundamentalDomain& domain, IntegerForms& forms);

/// Appends b - 1 classes of H^1(M, dM): d(1 on loop k, 0 at all other vertices), k = 1 .. b-1. The triangulation may be
/// any one of the same vertices.
void add_loop_indicators(const HalfEdges& half_edges, const mesh::BoundaryLoops& boundary, IntegerForms& forms);

/// Returns a basis of H^1(M), dual to the loops zeta, then to the boundary loops 1 .. b-1.
IntegerForms natural_classes(const HalfEdges& half_edges, const FundamentalDomain& domain);

/// Returns a basis of H^1(M, dM): the natural classes of the handles, which are zero along the boundary, then the loop
/// indicators. @param boundary of the surface, with at least one loop. @param natural as above
IntegerForms relative_classes(const HalfEdges& half_edges, const mesh::BoundaryLoops& boundary,
                              const IntegerForms& natural);

/// Computes W_ij = int a_i ^ b_j of closed integer forms, b zero along the boundary. It depends on the classes only,
/// and is an integer.
IntegerMatrix pairing(const HalfEdges& half_edges, const IntegerForms& a, const IntegerForms& b);

/// Computes W_ij = int eta_i ^ eta_j. It is an integer, because both are integer classes, and exact on any
/// triangulation.
IntegerMatrix wedge_matrix(const HalfEdges& half_edges, const IntegerForms& forms, Execution& execution);

/// Counts the signed crossings of dual paths through D, each from the face of a star's link[0]. A class has the period
/// +1 counter-clockwise around its star. It is closed on every face outside the stars, and 0 on all spokes and on all
/// link edges but link[0]. A closed surface has one class for each star but the last, with the period -1 around the
/// last, where the path ends. With boundary there is one for each star, and its path leaves through the gap of boundary
/// loop 0.
/// @param domain made with these stars
IntegerForms pole_classes(const HalfEdges& half_edges, const FundamentalDomain& domain,
                          const std::vector<mesh::Star>& stars);

}  // namespace holomorph::topology
