// Closed one-forms with integer values, sparse: most edges have the value 0 in every form.
#pragma once

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "mesh/intrinsic_surface.h"

namespace holomorph::topology {

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

}  // namespace holomorph::topology
