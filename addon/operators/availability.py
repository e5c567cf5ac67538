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

    needs_library = True

    @classmethod
    def poll(cls, context):
        sentence = (native.problem() if cls.needs_library else "") or cls.why_not(context)
        if sentence:
            cls.poll_message_set(sentence)
        return not sentence

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

    @classmethod
    def why_not(cls, context):
        if context.mode not in {"OBJECT", "EDIT_MESH"}:
            return "Go to Object Mode or Edit Mode"
        selected = context.view_layer.objects.selected
        if context.mode == "OBJECT" and not any(o.type == "MESH" for o in selected):
            return CONVERT if any(o.type in CONVERTIBLE for o in selected) else "Select a mesh"
        return ""
