#include "choice/candidate.h"

#include "base/constants.h"
#include "base/errors.h"

namespace holomorph::choice {

MapPointer least(const std::vector<Candidate>& candidates, MapPointer best, Budget& budget, Execution& execution) {
  double all = 0, done = 0;
  for (const Candidate& each : candidates) all += each.work;
  for (const Candidate& each : candidates) {
    const double from = done / all, to = (done += each.work) / all;
    nested(execution, from, from, [&] { execution.report(0); });
    const double bound =
        unless_refused([&] { return nested(execution, from, from, [&] { return each.bound(best, execution); }); },
                       [](const Error&) { return 0.0; });
    if (!(bound < (best ? best->cost() : kInfinity))) continue;
    if (best && !budget.goes_on(each.work, each.times)) continue;
    const MapPointer made =
        unless_refused([&] { return nested(execution, from, to, [&] { return each.make(best, execution); }); },
                       [](const Error&) { return MapPointer(); });
    best = each.judges && made ? made : cheaper(best, made);
  }
  return best;
}

}  // namespace holomorph::choice
