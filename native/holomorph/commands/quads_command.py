"""python -m holomorph quads MESH --faces 2000 --output OUT"""

from .. import Error, Surface
from ..files import formats, whole_file
from ..mesh.checks import check_options, real_number
from .console import Parser, failed, shown, tell, warn

EXIT_REFUSED, EXIT_USAGE = 1, 2


def quads(arguments):
    """Writes a mesh of quads over a mesh file, and tells what it is; the exit status, other than 0 with one sentence: 1
    if nothing was done, 2 for options that cannot be."""
    options = _parser().parse_args(arguments)
    try:
        real_number(options.faces, "faces", positive=True)
        formats.check_mesh(options.mesh)
        formats.of_path(options.output)
        whole_file.check_places([options.mesh], options.output, [], options.overwrite)
        check_options("auto", options.threads)
    except (Error, ValueError, OSError) as error:
        return failed(EXIT_USAGE, error)
    try:
        surface = Surface.read(options.mesh)
        warn(options.mesh, surface.repairs.notes)
        made = surface.quads(options.faces, lines=options.lines, mirror=options.mirror, threads=options.threads)
        mesh = made.positions, made.corner_vertices, made.face_offsets
        Surface.from_polygons(*mesh, strict=False).write(options.output, made.uv)
    except (Error, ValueError, OSError) as error:
        return failed(EXIT_REFUSED, error)
    warn(options.mesh, made.notes)
    tell(f"{shown(str(options.mesh))}: {made.sentence}\n")
    return 0


def _parser():
    parser = Parser(
        "quads",
        description="Make a mesh of quads of nearly one size over a mesh: its topology and its hard edges stay.",
        epilog="Exit status: 1 if nothing was done (a message says why), 2 for a mistake in the command.",
    )
    parser.add_argument("mesh", help=f"{formats.KINDS} file")
    parser.add_argument("--output", metavar="FILE", required=True, help="file to write: .obj, .ply or .glb")
    parser.add_argument("--faces", type=float, default=2000, help="about how many (default 2000)")
    text = "whole (default): edges run along hard edges and borders; free: rows do, but may be cut there; none"
    parser.add_argument("--lines", choices=("whole", "free", "none"), default="whole", help=text)
    parser.add_argument("--mirror", action="store_true", help="two halves that are alike")
    parser.add_argument("--overwrite", action="store_true", help="allow --output to replace the input")
    parser.add_argument("--threads", type=int, help="number of threads (default: one per core)")
    return parser
