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
      if (value != 0) sum.emplace_back(x->first, value);
      ++x;
      ++y;
    }
  }
  return sum;
}

IntegerForms beside(const IntegerForms& a, const IntegerForms& b) {
  IntegerForms both = a;
  both.form_count += b.form_count;
  for (std::size_t e = 0; e < b.rows.size(); ++e) {
    for (const auto& [form, value] : b.rows[e]) both.rows[e].emplace_back(a.form_count + form, value);
  }
  return both;
}

IntegerForms first_forms(const IntegerForms& forms, int count, int form_count) {
  IntegerForms first;
  first.form_count = form_count;
  first.rows.resize(forms.rows.size());
  for (std::size_t e = 0; e < forms.rows.size(); ++e) {
    const auto& row = forms.rows[e];
    const auto end = std::find_if(row.begin(), row.end(), [count](const auto& entry) { return entry.first >= count; });
    first.rows[e].assign(row.begin(), end);
  }
  return first;
}

void carry_through(const std::vector<mesh::Flip>& flips, IntegerForms& forms) {
  static const IntegerForms::Row kZero;
  for (const auto& [edge, a, b] : flips) {
    const auto& row_a = forms.rows[mesh::edge_of(a)];
    const auto& row_b = forms.rows[mesh::edge_of(b)];
    if (row_a.empty() && row_b.empty()) {
      forms.rows[edge].clear();
    } else {
      forms.rows[edge] = add(add(kZero, row_a, -mesh::sign(a)), row_b, -mesh::sign(b));
    }
  }
}

}  // namespace holomorph::topology
