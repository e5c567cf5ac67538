#include "choice/candidate.h"

#include "base/constants.h"

namespace holomorph::choice {

MapPointer least(const std::vector<Candidate>& candidates, MapPointer best, Budget& budget, Execution& execution) {
  double all = 0, done = 0;
  for (const Candidate& each : candidates) all += each.work;
  for (const Candidate& each : candidates) {
    const double from = done / all, to = (done += each.work) / all;
    nested(execution, from, from, [&] { execution.report(0); });
    const double bound = nested(execution, from, from, [&] { return each.bound(best, execution); });
    if (!(bound < (best ? best->cost() : kInfinity))) continue;
    if (best && !budget.goes_on(each.work, each.times)) continue;
    const MapPointer made = nested(execution, from, to, [&] { return each.make(best, execution); });
    best = each.judges && made ? made : cheaper(best, made);
  }
  return best;
}

}  // namespace holomorph::choice
