#include "progressive/refinement.h"

#include <algorithm>
#include <string>

#include "base/errors.h"

namespace holomorph::progressive {
namespace {

std::size_t triangles_after(const ProgressiveMesh& mesh, int splits) {
  return mesh.base.triangles.size() + 2 * static_cast<std::size_t>(splits);
}

}  // namespace

Refinement::Refinement(const ProgressiveMesh& mesh, int splits)
    : mesh_(mesh),
      table_(mesh.base.triangles, mesh.base.triangle_edges, mesh.base.edges.size(), triangles_after(mesh, splits)) {
  leaving_ = leaving_sides(table_, mesh.base.vertex_count);
  leaving_.reserve(leaving_.size() + static_cast<std::size_t>(splits));
}

void Refinement::find_star(int v) {
  star_sides_.clear();
  star_vertices_.clear();
  const int start = leaving_[v];
  int side = start;
  do {
    star_sides_.push_back(side);
    star_vertices_.push_back(table_.to(side));
    if (table_.turn_left(side) < 0) star_vertices_.push_back(table_.apex(side));  // the last neighbour at a boundary
    side = table_.turn_left(side);
  } while (side >= 0 && side != start);
}

void Refinement::split() {
  const auto& [s, l, r, slot_l, slot_r] = mesh_.splits[made_];
  const int t = mesh_.base.vertex_count + made_;
  const auto check = [this](bool valid, const char* what) {
    if (!valid) throw InvalidMesh("vertex split " + std::to_string(made_) + " " + what);
  };
  check(s >= 0 && s < t && l >= -1 && l < t && r >= -1 && r < t, "names a vertex that is not there yet");
  check(slot_l < 3 && slot_r < 3, "names a corner beyond the third");
  check(l != r, "has the same vertex on both sides");
  find_star(s);
  const int n = static_cast<int>(star_sides_.size());
  const bool closed = static_cast<int>(star_vertices_.size()) == n;
  const auto place = [&](int v) {
    return static_cast<int>(std::find(star_vertices_.begin(), star_vertices_.end(), v) - star_vertices_.begin());
  };
  const int from = r < 0 ? 0 : place(r), to = l < 0 ? n : place(l), count = closed ? n : n + 1;
  check(from < count && to < count + (l < 0), "names a vertex that is no neighbour of v_s");
  check(closed ? l >= 0 && r >= 0 : from < to || ((l < 0 || r < 0) && from == to), "crosses the boundary");

  // Sides at the edges v_s v_l and v_s v_r: those that stay with v_s, and those that move to v_t.
  const auto leaving = [&](int i) { return closed || i < n ? star_sides_[i] : -1; };
  const auto arriving = [&](int i) {
    if (i == 0 && !closed) return -1;
    return CornerTable::previous(star_sides_[(i + n - 1) % n]);
  };
  const int s_to_l = l < 0 ? -1 : leaving(to), l_to_t = l < 0 ? -1 : arriving(to);
  const int t_to_r = r < 0 ? -1 : leaving(from), r_to_s = r < 0 ? -1 : arriving(from);
  const int start_of_rest = star_sides_[0];

  moved_.clear();
  const int end = to > from || !closed ? to : to + n;
  for (int i = from; i < end; ++i) {
    table_[star_sides_[i % n]].vertex = t;
    if (i > from || r < 0) moved_.push_back(star_vertices_[i % n]);
  }
  if (l < 0 && end > from) moved_.push_back(star_vertices_[n]);

  int left = -1, right = -1;  // v_s -> v_t and v_t -> v_s
  const auto add = [this](int a, int b, int c, int slot) {
    const int v[3] = {a, b, c};
    return table_.add(v[(3 - slot) % 3], v[(4 - slot) % 3], v[(5 - slot) % 3]) + slot;
  };
  if (l >= 0) left = add(s, t, l, slot_l);
  if (r >= 0) right = add(t, s, r, slot_r);
  if (left >= 0) {
    table_.link(CornerTable::next(left), l_to_t);
    table_.link(CornerTable::previous(left), s_to_l);
    if (s_to_l < 0) leaving_[l] = CornerTable::previous(left);
  }
  if (right >= 0) {
    table_.link(CornerTable::next(right), r_to_s);
    table_.link(CornerTable::previous(right), t_to_r);
    if (t_to_r < 0) leaving_[r] = CornerTable::previous(right);
  }
  table_.link(left, right);
  // A boundary vertex begins with the side that has no opposite.
  if (r < 0) {
    leaving_.push_back(end > from ? start_of_rest : CornerTable::next(left));
    leaving_[s] = left;
  } else if (l < 0) {
    leaving_.push_back(right);
    if (from == 0) leaving_[s] = CornerTable::next(right);
  } else {
    leaving_.push_back(CornerTable::next(left));
    if (closed) {
      leaving_[s] = left;
    } else if (from == 0) {
      leaving_[s] = CornerTable::next(right);
    }
  }
  ++made_;
}

std::vector<Triple> Refinement::triangles() const {
  std::vector<Triple> triangles(static_cast<std::size_t>(table_.triangle_count()));
  for (int t = 0; t < table_.triangle_count(); ++t) {
    triangles[t] = {table_.from(4 * t), table_.from(4 * t + 1), table_.from(4 * t + 2)};
  }
  return triangles;
}

}  // namespace holomorph::progressive
