# SPDX-License-Identifier: GPL-3.0-or-later
"""How maps are made: a request, the solves, the maps, writing, the report."""

from ..maps import mapped
from ..results import write
from ..scene import targets
from ..solving import jobs


class Run:
    """What is asked for by properties of an operator, or by the headless command under the same names, of these
    `targets.Target`s. @throws ValueError there is nothing of what is asked for on one of them

    own : the `own.Own` that is their texture, None for one of ours
    """

    def __init__(self, properties, found, own=None):
        self.tasks, self._found, self._properties, self._own = targets.tasks(found), found, properties, own
        self._choices = properties.choices()
        self._options = [self._choices.options(properties, target, own) for target in found if not target.refused]

    def job(self, progress=None):
        """The `jobs.Job` that solves and maps."""
        return jobs.Job(self.tasks, progress, mapped.follow(self._options, self._properties.equal))

    @property
    def objects(self):
        """The objects that may be written to."""
        return targets.objects(self._found)

    def write(self, step, job, time_has_passed=False):
        """Writes the results of the job, in a `transaction.Step` of the objects. Returns the `outcome.Outcome`."""
        results = targets.align(self._found, job.results)
        options = self._choices.write_options(self._properties, self._own)
        return write.write(step, self._found, results, options, time_has_passed)
