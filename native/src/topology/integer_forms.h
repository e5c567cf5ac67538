// Closed one-forms with integer values, sparse: most edges have the value 0 in every form.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "mesh/intrinsic_triangulation.h"

namespace holomorph::topology {

/// Row e lists (form, value) with value != 0, ascending by form, for the direction of half-edge 2e.
struct IntegerForms {
  using Row = std::vector<std::pair<int, int>>;
  int form_count = 0;
  std::vector<Row> rows;  ///< #E
};

/// The part of a row that belongs to the forms begin .. end - 1, for a loop over its entries.
struct RowPart {
  IntegerForms::Row::const_iterator first, last;
  auto begin() const { return first; }
  auto end() const { return last; }
};
inline RowPart forms_between(const IntegerForms::Row& row, int begin, int end) {
  const auto before = [](const std::pair<int, int>& entry, int form) { return entry.first < form; };
  return {std::lower_bound(row.begin(), row.end(), begin, before),
          std::lower_bound(row.begin(), row.end(), end, before)};
}

/// a + factor * b
IntegerForms::Row add(const IntegerForms::Row& a, const IntegerForms::Row& b, int factor);

/// Both families as one: first the forms of `a`, then those of `b`.
IntegerForms beside(const IntegerForms& a, const IntegerForms& b);

/// The first `count` forms, and zeros up to `form_count`.
IntegerForms first_forms(const IntegerForms& forms, int count, int form_count);

/// The same closed forms on a triangulation that was flipped: exact, by closedness.
void carry_through(const std::vector<mesh::Flip>& flips, IntegerForms& forms);

}  // namespace holomorph::topology
