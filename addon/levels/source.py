# SPDX-License-Identifier: GPL-3.0-or-later
"""The object whose levels of detail are made: read, and written at the end."""

from .. import native
from ..results import write
from ..scene import targets
from ..writing import transaction
from . import level_objects, levels, transfer


class Source:
    """The object as it was when the work began."""

    def __init__(self, obj):
        (self.target,) = targets.collect([obj])
        self._data = None if self.target.refused else transfer.read(obj.data, self.target.polygons)

    def work(self, options, progress=None):
        """The `levels.LevelsWork`."""
        (task,) = targets.tasks([self.target])
        needs_map = not set(self._data.own_maps) & set(self._data.maps)
        return levels.LevelsWork(task, self._data.maps, self._data.uv, needs_map, options, progress)

    def write(self, step, work, presentation, time_has_passed=False):
        """(objects of the levels, sentences about the map that they needed), or the one sentence why there are none.

        step : the `transaction.Step` of the object
        """
        problem = self.problem(work, time_has_passed)
        if problem:
            return [], [problem]
        told = []
        if work.mapped is not None:
            outcome = write.write(step, [self.target], [work.mapped], write.WriteOptions(checker=False))
            told = outcome.problems + outcome.notes
        return level_objects.write(step, self.target.find(), self._data, work, presentation), told

    def problem(self, work, time_has_passed):
        if work.error is not None:
            return native.sentence(work.error)
        if self.target.has_changed(time_has_passed):
            return "it changed while its levels were made; please run it again"
        if not work.names:
            reasons = {part.skipped for part in work.mapped.parts}
            return f"there is no UV map, and none could be made: {'; '.join(sorted(reasons))}"
        return "" if work.levels else "it cannot be made coarser"


def make(context, obj, options, presentation):
    """What `Source.write` gives, here and now."""
    source = Source(obj)
    if source.target.refused:
        return [], [source.target.refused]
    work = source.work(options)
    work.run()
    with transaction.one_step(context, [obj]) as step:
        return source.write(step, work, presentation)
