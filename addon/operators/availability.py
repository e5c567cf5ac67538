# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether an operator can run here, which Blender shows where its button is grey; and what it says in the end."""

import functools

import bpy

from .. import native

CONVERTIBLE = {"FONT", "CURVE", "SURFACE", "META"}
CONVERT = "Convert this to a mesh first: Object > Convert > Mesh"
INSTANCES = "Turn these into meshes first: Object > Apply > Make Instances Real"
PAINTING = {"SCULPT", "PAINT_VERTEX", "PAINT_WEIGHT", "PAINT_TEXTURE", "PARTICLE"}  # modes that are left meanwhile
DYNTOPO = "Turn Dyntopo off: it does not keep UV maps"


class Explained:
    """A mixin for operators. One of them defines

    why_not(context) : class method; why it cannot run here, one sentence, or ""
    """

    bl_options = {"REGISTER", "UNDO"}
    needs_library = True
    modes = {"OBJECT": "Object Mode"}  # in which it can run, as menus name them; none for any
    left_modes = PAINTING  # further ones: it leaves them and comes back

    @classmethod
    def poll(cls, context):
        sentence = native.problem() if cls.needs_library else ""
        sentence = sentence or cls._other_mode(context) or cls.why_not(context)
        if sentence:
            cls.poll_message_set(sentence)
        return not sentence

    @classmethod
    def _other_mode(cls, context):
        if not cls.modes or context.mode in cls.modes:
            return ""
        if context.mode in cls.left_modes:
            return DYNTOPO if context.object.use_dynamic_topology_sculpting else ""
        return f"Switch to {' or '.join(cls.modes.values())}"

    def __init_subclass__(cls, **options):
        """What Blender calls is the outer door: an error that nothing foresaw is told there."""
        super().__init_subclass__(**options)
        for name in ("execute", "invoke", "modal"):
            if name in cls.__dict__:
                setattr(cls, name, _guarded(cls.__dict__[name]))

    def refuse(self, sentence):
        """Says why nothing is done, and gives what the operator returns."""
        self.report({"ERROR"}, str(sentence))
        return {"CANCELLED"}

    def tell(self, outcome):
        """Reports an `outcome.Outcome`, and gives what the operator returns."""
        for window in bpy.context.window_manager.windows:  # sidebars do not see that there is a report, nor editors UVs
            for area in window.screen.areas:
                area.tag_redraw()
        if not outcome.done:
            return self.refuse("; ".join(outcome.problems) or "No mesh selected")
        for sentence in outcome.problems:
            self.report({"WARNING"}, sentence)
        for sentence in outcome.notes:
            self.report({"INFO"}, sentence)
        if not outcome.problems and not outcome.notes:
            self.report({"INFO"}, f"Holomorphic UV maps written: {', '.join(outcome.done)}")
        return {"FINISHED"}


def _guarded(method):
    """The method, with as many arguments, for Blender counts them; after an error it refuses in one sentence."""

    def call(operator, *arguments):
        try:
            return method(operator, *arguments)
        except MemoryError as error:
            return operator.refuse(" ".join(["There is not enough memory.", *getattr(error, "__notes__", ())]))
        except Exception as error:  # noqa: BLE001  nobody is left to raise it to
            return operator.refuse(native.fault(error))

    if method.__code__.co_argcount == 2:
        return functools.wraps(method)(lambda self, context: call(self, context))
    return functools.wraps(method)(lambda self, context, event: call(self, context, event))


class OnMeshes(Explained):
    """A mixin: an operator on the selected meshes, or on those in edit mode."""

    modes = {"OBJECT": "Object Mode", "EDIT_MESH": "Edit Mode"}

    @classmethod
    def why_not(cls, context):
        from .. import compatibility
        from ..scene import gathering

        if any(True for _ in gathering.candidates(context)):
            return ""
        selected = compatibility.selected_in(context.view_layer)
        if any(o.instance_type == "COLLECTION" for o in selected):
            return INSTANCES
        return CONVERT if any(o.type in CONVERTIBLE for o in selected) else "Select a mesh"


class AtOnce(OnMeshes):
    """A mixin: an operator whose work is so quick that it is done at once. One of them defines

    act(step, objects) : changes these mesh objects in a `transaction.Step`, in object mode; returns whether there was
        something to do
    """

    nothing = ""  # what is said where there was nothing to do; "" where `act` says it

    def read(self, _context, objects):
        """The objects among these that `act` may change. Whatever it needs of edit mode is read here."""
        return objects

    def execute(self, context):
        from ..scene import gathering
        from ..writing import transaction

        reasons = {obj: gathering.why_fixed(obj) for obj in gathering.mesh_objects(context)}
        for obj, reason in reasons.items():
            if reason:
                self.report({"WARNING"}, f"{obj.name}: {reason}")
        objects = self.read(context, [obj for obj, reason in reasons.items() if not reason])
        with transaction.one_step(context, objects) as step:
            has_acted = self.act(step, objects)
        if objects and not has_acted and self.nothing:
            self.report({"INFO"}, self.nothing)
        return {"FINISHED"} if has_acted else {"CANCELLED"}
