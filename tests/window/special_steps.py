"""Runs inside Blender with a window and simulated events: an artist's next minutes with bones that a modifier makes a
character, a terrain, a pipe and a text."""

import bpy
from artist import prepare, press, report_of, seen, then
from objects import figure, look_at, pipe, terrain
from running import run
from screen import area, close_popup, inside, picture
from sidebar import press_button


def press_in_vain(step, name):
    """The large button, which says why not."""
    look_at(name)
    yield 0.25
    yield from press_button("VIEW_3D")
    yield 0.5
    seen[step] = report_of(name)
    picture(f"five_{step}.png")
    yield from close_popup()


def figure_of_bones():
    figure("Figure")
    yield from press_in_vain("figure", "Figure")
    yield from then("figure mapped", "Figure Mapped", bpy.ops.uv.holomorphic_maps, on="Figure", modifiers=True)


def ground_and_pipe():
    terrain("Terrain")
    yield from press("terrain", "Terrain")
    pipe("Pipe")
    yield from press("pipe", "Pipe")


def letters():
    with inside(area("VIEW_3D")):
        bpy.ops.object.text_add()
        words = bpy.context.object.data
        words.body, words.extrude = "Mesh", 0.1
    yield from press_in_vain("text", "Text")
    with inside(area("VIEW_3D")):
        bpy.ops.object.convert(target="MESH")
    yield from press("text as mesh", "Text")
    yield from then("text in islands", "Text", bpy.ops.uv.holomorphic_islands)


run((prepare, figure_of_bones, ground_and_pipe, letters), seen)
