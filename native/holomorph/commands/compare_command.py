"""python -m holomorph compare A B"""

import json

from .. import Error, Surface
from ..core.value import plain
from ..files import formats, whole_file
from ..mesh.checked_mesh import naming
from ..moduli.equivalence import VERDICTS, conformally_equivalent
from .console import Parser, failed, tell, warn

EXIT_CODES = dict(zip(VERDICTS, (0, 6, 3, 4, 5), strict=True))
"""The exit code of each verdict. 1: not compared, one sentence says why; 2: invalid options, or no such file."""


def compare(arguments):
    """Prints one sentence about two mesh files; the exit code is that of the verdict."""
    codes = ", ".join(f"{code} {verdict}" for verdict, code in EXIT_CODES.items())
    parser = Parser(
        "compare",
        description="Decide whether there is a conformal map between two surfaces.",
        epilog=f"Exit code: {codes}; 1 where a file cannot be compared, 2 for a mistake in the command.",
    )
    parser.add_argument("meshes", nargs=2, metavar="mesh", help=f"{formats.KINDS} file of one connected surface")
    parser.add_argument("--report", metavar="FILE", help="write verdict, integer matrix and distances as JSON")
    options = parser.parse_args(arguments)
    try:
        for mesh in options.meshes:
            formats.check_mesh(mesh)
        whole_file.check_places(options.meshes, None, [options.report], overwrite=False)
    except (Error, ValueError, OSError) as error:
        return failed(2, error)
    try:
        made = conformally_equivalent(*map(_surface, options.meshes))
        if options.report:
            whole_file.write(options.report, json.dumps(plain(vars(made)), indent=1, allow_nan=False).encode() + b"\n")
    except (Error, OSError) as error:
        return failed(1, error)
    tell(made.sentence + "\n")
    return EXIT_CODES[made.verdict]


def _surface(path):
    surface = Surface.read(path, strict=True)
    warn(path, surface.repairs.notes)
    with naming(path):
        surface.require_connected()
    return surface
