"""holomorph batch SOURCE... --out DIR: the command line, the run from its options to its end, and its plan: what there
is to do in an output folder, and where the results of each asset are there.
"""

import contextlib
import hashlib
import importlib.util
import json
import os
import re
import sys
import time
from collections import Counter
from functools import partial
from pathlib import Path

from .. import __version__
from ..commands.console import Parser, failed, say, shown, tell
from ..core.value import counted
from ..files.names import marked, part, told_apart
from ..quality.verdicts import LEVELS
from . import DONE, EngineError, StorageError, UsageError, overview, recipe, sources, workers
from .journal import RECORD, Journal, noted, stored, storing
from .task import OBJECTS, Limits, Task, blender_program, objects

LONGEST = 1000  # of the whole path below the output folder; systems take 4096
ASSETS, SCENES = "assets", ".blend"  # folders of the results: of assets, and of what Blender read of scenes
ALL_DONE, SOME_FAILED, USAGE, STRICT, STORAGE, ENGINE, MACHINE = range(7)  # exit codes; see docs/batch/results.md
UNITS = {"": 1, "K": 2**10, "M": 2**20, "G": 2**30, "T": 2**40}
EVERY = 10.0  # seconds between lines about how far a batch is
UNFIT = LEVELS[LEVELS.index("fair") + 1 :]


def of_folder(name):
    """A folder of assets as one part of a path. Where it has a suffix of a source, an asset may have its name, too:
    its dot is told apart."""
    plain = part(name)
    stem, dot, suffix = plain.rpartition(".")
    return f"{stem}%2E{suffix}" if dot and f".{suffix.lower()}" in sources.WANTED else plain


def of_source(name):
    """The path of a source, whose parts between slashes are folders."""
    *folders, last = name.split("/")
    path = "/".join([*(of_folder(folder) for folder in folders), part(last)])
    return path if len(path) <= LONGEST else marked(part(last), name)


class Plan:
    """The tasks of a batch. `openings` come first: they read scenes, whose objects are then assets, too.

    found : all sources, which tell each other's folders apart; share : those of this run
    """

    def __init__(self, found, journal, recipe, limits, blender, share=slice(None)):
        self._journal, self._recipe, self._more = journal, recipe, {"blender": blender, "limits": limits}
        self._places = told_apart([source.name for source in found], of_source)
        tasks = [self._of_source(source) for source in found[share]]
        self.openings = [task for task in tasks if task.recipe is None]
        self._meshes = [task for task in tasks if task.recipe]

    def tasks(self):
        """The tasks of the mesh files, and of the objects of the scenes that were read."""
        opened = [opening for opening in self.openings if _is_read(opening)]
        return self._meshes + [task for opening in opened for task in self._objects(opening)]

    def unopened(self):
        """The scenes that were not read: each is an asset in itself, which is not done."""
        return [opening for opening in self.openings if not _is_read(opening)]

    def _of_source(self, source):
        problem, digest = _examined(source)
        is_scene = sources.is_scene(source.path)
        folder, recipe = (SCENES, None) if is_scene else (ASSETS, self._recipe)
        place = f"{folder}/{self._places[source.name]}"
        return self._task(source.name, digest, source.path, source.size, place, recipe, problem=problem)

    def _objects(self, opening):
        found = objects(opening.folder)
        folders = told_apart([name for name, *_ in found], part)
        for name, path, corners in found:
            shown = name.replace("%", "%25").replace("/", "%2F")
            place = f"{ASSETS}/{self._places[opening.name]}/{folders[name]}"
            scene = str(opening.path), name
            yield self._task(f"{opening.name}/{shown}", opening.key, path, corners, place, self._recipe, scene=scene)

    def _task(self, name, digest, path, size, place, recipe, **more):
        """digest : a hash of the bytes of the source"""
        parts = digest, name, recipe and recipe.canonical, __version__
        key = hashlib.sha256(json.dumps(parts).encode()).hexdigest()
        folders = self._journal.folder / place, self._journal.work
        return Task(name, key, path.absolute(), size, *folders, recipe, **self._more, **more)


def _is_read(opening):
    """Whether its objects are there, as they were listed: a record of another shape is that of another program."""
    is_own = noted(opening) is not None or not (opening.folder / RECORD).exists()
    return is_own and (opening.folder / OBJECTS).exists()


def _examined(source):
    """(why it cannot be read, or empty; a hash of its bytes, or of that)."""
    problem = source.problem
    if not problem:
        try:
            with open(source.path, "rb") as file:
                return "", hashlib.file_digest(file, "sha256").hexdigest()
        except OSError as error:
            problem = sources.cannot_be_read("file", error)
    return problem, hashlib.sha256(problem.encode()).hexdigest()


def main(arguments):
    """Runs the command and returns the exit code; if that is not 0, a sentence on the error stream says why."""
    try:
        return _run(_options(arguments))
    except UsageError as error:
        return failed(USAGE, error)
    except StorageError as error:
        return failed(STORAGE, f"{error}; finished assets are kept, and the same command continues")
    except EngineError as error:
        return failed(ENGINE, f"{error}; the same command continues")
    except (OSError, MemoryError, ImportError) as error:  # the last of a library that finds no memory
        told = f"this machine does not provide what the run needs: {_reason(error)}; the same command continues"
        return failed(MACHINE, told)


def _reason(error):
    return getattr(error, "strerror", None) or str(error) or "there is not enough memory"


def _options(arguments):
    parser = Parser("batch", description="Map a library of meshes; a second run does only what is missing.")
    parser.add_argument("source", nargs="+", help=sources.KINDS)
    parser.add_argument("--out", type=Path, required=True, metavar="DIR", help="folder for the results")
    parser.add_argument("--recipe", metavar="FILE", help="TOML file that chooses maps, tilings, levels and files")
    where = parser.add_mutually_exclusive_group()
    where.add_argument(
        "--workers", type=_positive, metavar="N", help="processes on this machine (default: one per core)"
    )
    where.add_argument(
        "--dask", metavar="ADDRESS", help="address of a Dask scheduler (tcp://...), or its scheduler file"
    )
    parser.add_argument("--memory", type=_bytes, metavar="SIZE", help="memory limit of each asset, such as 4G")
    parser.add_argument(
        "--time", type=_seconds, default=Limits.seconds, metavar="S", help="time limit of each asset, in seconds"
    )
    parser.add_argument("--blender", metavar="PROGRAM", help="program for .blend files (default: blender)")
    parser.add_argument("--retry", action="store_true", help="retry assets that were not done")
    parser.add_argument(
        "--share", type=_share, metavar="K/N", help="do the K-th of N shares only; run without it to sum up"
    )
    parser.add_argument("--report-only", action="store_true", help="exit with 0 even if assets were not done")
    parser.add_argument("--strict", action="store_true", help="exit with 3 unless every map is good or fair")
    return parser.parse_args(arguments)


def _run(options):
    found = sources.find(options.source, options.out)
    wanted = recipe.read(options.recipe) if options.recipe else recipe.Recipe()
    needs_blender = "blend" in wanted.output.formats or any(sources.is_scene(s.path) for s in found)
    program = blender_program(options.blender) if needs_blender else ""
    number, count = options.share or (1, 1)
    journal = Journal(os.path.realpath(options.out), "{}-of-{}".format(*options.share) if options.share else "")
    execute, limits = _engine(options)
    with journal.locked():
        plan = Plan(found, journal, wanted, limits, program, slice(number - 1, None, count))
        try:
            _do(plan.openings, "file", execute, options.retry)
            records = _do(plan.tasks(), "asset", execute, options.retry)
        finally:
            if not options.share:
                overview.write(journal, plan.tasks() + plan.unopened())
    return _exit_code(records + [stored(opening) for opening in plan.unopened()], options)


def _exit_code(records, options):
    """Says how many assets there are of each status."""
    counts = Counter(record["status"] for record in records)
    told = ", ".join(f"{counts[status]} {status}" for status in sorted(counts, key=lambda s: (s != DONE, s)))
    with storing():
        tell(f"{counted(len(records), 'asset')}: {told or 'none'}; see {shown(str(options.out / 'index.html'))}\n")
    if any(record["status"] != DONE for record in records) and not options.report_only:
        return SOME_FAILED
    unfit = [record["name"] for record in records if record.get("verdict") in UNFIT or record.get("skipped")]
    if not (options.strict and unfit):
        return ALL_DONE
    count = counted(len(unfit), "asset")
    return failed(STRICT, f"poor or unusable map, or parts without a map: {count}; the first is {unfit[0]}")


def _engine(options):
    """(function from tasks to records, limits). @throws UsageError"""
    if options.dask:
        if importlib.util.find_spec("distributed") is None:
            raise UsageError('--dask needs the library distributed: pip install "holomorph[dask]"')
        from .cluster import Cluster

        return Cluster(options.dask).run, Limits(options.memory or 0, options.time)
    cores = os.cpu_count() or 1
    count = options.workers or cores
    memory = options.memory or int(workers.MEMORY_SHARE * workers.machine_memory() / count)
    return partial(workers.run, count=count), Limits(memory, options.time, max(1, cores // count))


def _do(tasks, noun, execute, retries):
    """Does the tasks that have no record yet, the largest first, and returns the records of all."""
    records = {task.key: stored(task) for task in tasks}
    waiting = [
        task for task in tasks if (record := records[task.key]) is None or (retries and record["status"] != DONE)
    ]
    if waiting:
        waiting.sort(key=lambda task: (-task.size, task.name))
        said = time.monotonic()
        with contextlib.closing(execute(waiting)) as results, _bar(len(waiting), noun) as bar:
            for count, record in enumerate(results, 1):
                records[record["key"]] = record
                if bar is not None:
                    bar.update()
                elif time.monotonic() - said > EVERY:
                    said = time.monotonic()
                    say(f"holomorph: {count} of {len(waiting)} {noun}s")
                if record["status"] != DONE:
                    line = shown(f"{record['name']}: {record['status']}: {record['message']}")
                    say(line) if bar is None else bar.write(line, file=sys.stderr)
    return list(records.values())


def _bar(total, noun):
    """How far a batch is, with an estimate, on the error stream, by tqdm: None without it or a terminal."""
    if importlib.util.find_spec("tqdm") is None or sys.stderr is None or not sys.stderr.isatty():
        return contextlib.nullcontext()
    import tqdm

    return tqdm.tqdm(total=total, unit=noun, smoothing=0.05)


def _positive(text):
    number = int(text)
    if number < 1:
        raise ValueError
    return number


def _share(text):
    number, count = map(int, text.split("/"))
    if not 1 <= number <= count:
        raise ValueError
    return number, count


def _seconds(text):
    seconds = float(text)
    if not 0 < seconds < float("inf"):
        raise ValueError
    return seconds


def _bytes(text):
    match = re.fullmatch(r"(\d+(?:\.\d+)?)\s*([KMGT]?)i?B?", text, re.IGNORECASE)
    size = int(float(match[1]) * UNITS[match[2].upper()]) if match else 0
    if size < 1:
        raise ValueError
    return size
