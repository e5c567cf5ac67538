"""python -m holomorph MESHFILE --report report.json; ... batch SOURCE... --out DIR; ... compare A B"""

import argparse
import json
import sys

from . import Error, Surface, Verdict, __version__, conformal_structure
from .checks import SOLVERS, check_options
from .compare_command import compare
from .report import component_report, overall_report, refused_report, repairs_report, skipped_report

EXIT_REFUSED, EXIT_STRICT = 1, 3


def main(arguments=None):
    """Computes every component; the exit status, other than 0 with one sentence: 1 if no component was done, 2 (of
    argparse) for options that cannot be, 3 with --strict if some component was not done or its map is not fit."""
    arguments = sys.argv[1:] if arguments is None else arguments
    if arguments[:1] == ["batch"]:
        from .batch import command

        return command.main(arguments[1:])
    if arguments[:1] == ["compare"]:
        return compare(arguments[1:])
    parser = argparse.ArgumentParser(
        prog="python -m holomorph",
        description="Conformal structure of a mesh file. A library of meshes is mapped by: holomorph batch --help. "
        "Two surfaces are compared by: holomorph compare --help",
    )
    parser.add_argument("mesh", help="OBJ, OFF, PLY or STL file")
    parser.add_argument("--report", metavar="FILE", help="write the report as JSON (default: print it)")
    parser.add_argument("--solver", default="auto", help=f"{', '.join(SOLVERS)}: as in holomorph.conformal_structure")
    parser.add_argument("--threads", type=int, help="number of threads (default: one per core)")
    parser.add_argument("--strict", action="store_true", help="end with 3 unless every map is good or fair")
    parser.add_argument("--version", action="version", version=__version__)
    options = parser.parse_args(arguments)
    try:
        report = mesh_report(options.mesh, options.threads, options.solver)
        text = json.dumps(report, indent=1, allow_nan=False)
        if options.report:
            with open(options.report, "w", encoding="utf-8") as file:
                file.write(text + "\n")
        else:
            print(text)
    except (Error, OSError, ValueError) as error:
        return failed(EXIT_REFUSED, error)
    not_done = [part for part in report["components"] if not part["done"]]
    if len(not_done) == len(report["components"]):
        return failed(EXIT_REFUSED, not_done[0]["reason"])
    found = Verdict(**report["verdict"])
    if options.strict and not_done:
        count = len(report["components"])
        return failed(EXIT_STRICT, f"{len(not_done)} of {count} parts have no map: {not_done[0]['reason']}")
    return failed(EXIT_STRICT, found.text) if options.strict and not found.is_fit else 0


def failed(status, sentence):
    """The exit status, after a sentence on the error stream."""
    print(f"holomorph: {sentence}", file=sys.stderr)
    return status


def mesh_report(path, threads=None, solver="auto"):
    """The report of all components of a mesh file, as plain data."""
    check_options(solver, threads)
    surface = Surface.read(path)
    parts = []
    for part in surface.components:
        try:
            parts.append(component_report(part, conformal_structure(part, solver=solver, threads=threads)))
        except Error as error:
            parts.append(skipped_report(part, error))
    return {
        "holomorph": __version__,
        "mesh": str(path),
        "faces": len(surface.face_offsets) - 1,
        "verdict": overall_report(parts, surface.is_unwelded),
        "repairs": repairs_report(surface.repairs),
        "components": parts + [refused_report(refused) for refused in surface.refused],
    }


if __name__ == "__main__":
    sys.exit(main())
