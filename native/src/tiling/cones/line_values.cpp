#include "tiling/cones/line_values.h"

#include <utility>

namespace holomorph::tiling {

std::optional<LineValues::Value> LineValues::find(int part) {
  if (!parent_[part]) return std::nullopt;
  std::vector<int> path;
  int root = part;
  for (; root >= 0 && above(root).part != root; root = above(root).part) path.push_back(root);
  // From the root's child on, so that each is by the root when the next asks.
  for (std::size_t i = path.size(); i-- > 0;) {
    Value& own = above(path[i]);
    if (own.part < 0 || own.part == root) continue;
    const Value& next = above(own.part);
    add_to(own.offset, next.offset, own.factor);
    own.factor *= next.factor;
    own.part = next.part;
  }
  return parent_[part];
}

LineValues::Value LineValues::resolved(const Value& value) {
  if (value.part < 0) return value;
  if (!parent_[value.part]) parent_[value.part] = Value{value.part, 1, {}};
  const std::optional<Value> found = find(value.part);
  Value result = held(found);
  for (auto& [number, multiple] : result.offset) multiple *= value.factor;
  result.factor *= value.factor;
  add_to(result.offset, value.offset);
  return result;
}

void LineValues::equate(const Value& first, const Value& second) {
  Value a = resolved(first), b = resolved(second);
  if (a.part < 0) std::swap(a, b);
  Multiples less = b.offset;  // what a's part is to be, beside that of b
  add_to(less, a.offset, -1);
  if (a.part < 0 || (a.part == b.part && a.factor == b.factor)) {
    equations_.push_back({{}, std::move(less)});
  } else if (a.part == b.part && whole_) {
    for (auto& [number, multiple] : less) multiple = -multiple;
    equations_.push_back({{{a.part, 2.0 * a.factor}}, std::move(less)});
  } else {
    const double part = a.part == b.part ? 0.5 * a.factor : a.factor;  // the factors are 1 or -1
    for (auto& [number, multiple] : less) multiple *= part;
    parent_[a.part] = Value{a.part == b.part ? -1 : b.part, a.factor * b.factor, std::move(less)};
  }
}

void LineValues::vanish(const Multiples& parts, Multiples offset) {
  for (const auto& [part, multiple] : parts) {
    if (!parent_[part]) parent_[part] = Value{part, 1, {}};
  }
  equations_.push_back({parts, std::move(offset)});
}

std::vector<int> LineValues::roots() {
  std::vector<int> result;
  for (int p = 0; p < static_cast<int>(parent_.size()); ++p) {
    if (parent_[p] && above(p).part == p) result.push_back(p);
  }
  return result;
}

std::vector<LineValues::Equation> LineValues::equations() {
  std::vector<Equation> result;
  for (const Equation& equation : equations_) {
    Equation& resolved = result.emplace_back(Equation{{}, equation.offset});
    for (const auto& [part, multiple] : equation.roots) {
      const std::optional<Value> found = find(part);
      const Value& value = held(found);
      add_to(resolved.offset, value.offset, multiple);
      if (value.part >= 0) resolved.roots[value.part] += multiple * value.factor;
    }
  }
  return result;
}

}  // namespace holomorph::tiling
