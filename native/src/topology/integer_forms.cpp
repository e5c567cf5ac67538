#include "topology/integer_forms.h"

#include <algorithm>

namespace holomorph::topology {

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

}  // namespace holomorph::topology
