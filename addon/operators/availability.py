# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether an operator can run here, which Blender shows where its button is grey; and what it says in the end."""

import bpy

from .. import native

CONVERTIBLE = {"FONT", "CURVE", "SURFACE", "META"}
CONVERT = "Object > Convert > Mesh makes this a mesh"


class Explained:
    """A mixin for operators. One of them defines

    why_not(context) : class method; why it cannot run here, one sentence, or ""
    """

    bl_options = {"REGISTER", "UNDO"}
    needs_library = True
    modes = {"OBJECT": "Object Mode"}  # in which it can run, as menus name them; none for any

    @classmethod
    def poll(cls, context):
        sentence = native.problem() if cls.needs_library else ""
        sentence = sentence or cls._other_mode(context) or cls.why_not(context)
        if sentence:
            cls.poll_message_set(sentence)
        return not sentence

    @classmethod
    def _other_mode(cls, context):
        is_right = context.mode in cls.modes or not cls.modes
        return "" if is_right else f"Go to {' or '.join(cls.modes.values())}"

    def refuse(self, sentence):
        """Says why nothing is done; what the operator returns."""
        self.report({"ERROR"}, str(sentence))
        return {"CANCELLED"}

    def tell(self, outcome):
        """Reports an `outcome.Outcome`; what the operator returns."""
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


class OnMeshes(Explained):
    """A mixin: an operator on the selected meshes, or on those in edit mode."""

    modes = {"OBJECT": "Object Mode", "EDIT_MESH": "Edit Mode"}

    @classmethod
    def why_not(cls, context):
        selected = context.view_layer.objects.selected
        if context.mode == "OBJECT" and not any(o.type == "MESH" for o in selected):
            return CONVERT if any(o.type in CONVERTIBLE for o in selected) else "Select a mesh"
        return ""


class AtOnce(OnMeshes):
    """A mixin: an operator whose work is so quick that it is done at once. One of them defines

    act(step, objects) : changes these mesh objects in a `transaction.Step`, out of edit mode; returns whether there was
        something to do
    """

    def read(self, context):
        """The objects that `act` may change; what it needs of edit mode is read here."""
        from ..scene import targets

        return targets.mesh_objects(context)

    def execute(self, context):
        from ..writing import transaction

        objects = self.read(context)
        with transaction.one_step(context, objects) as step:
            has_acted = self.act(step, objects)
        return {"FINISHED"} if has_acted else {"CANCELLED"}
