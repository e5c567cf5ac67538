"""python -m holomorph MESHFILE --report report.json"""

import argparse
import json
import sys

from . import Error, Surface, __version__, conformal_structure
from .checks import SOLVERS, check_options
from .report import component_report, refused_report, repairs_report, skipped_report


def main(arguments=None):
    """Computes every component; exit 0 if some component was done, else 1 with one sentence."""
    parser = argparse.ArgumentParser(prog="python -m holomorph", description="Conformal structure of a mesh file.")
    parser.add_argument("mesh", help="OBJ, OFF, PLY or STL file")
    parser.add_argument("--report", metavar="FILE", help="write the report as JSON (default: print it)")
    parser.add_argument("--solver", default="auto", help=f"{', '.join(SOLVERS)}: as in holomorph.conformal_structure")
    parser.add_argument("--threads", type=int, help="number of threads (default: one per core)")
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
        print(f"holomorph: {error}", file=sys.stderr)
        return 1
    if any(part["done"] for part in report["components"]):
        return 0
    print(f"holomorph: {report['components'][0]['reason']}", file=sys.stderr)
    return 1


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
        "repairs": repairs_report(surface.repairs),
        "components": parts + [refused_report(refused) for refused in surface.refused],
    }


if __name__ == "__main__":
    sys.exit(main())
