# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether an operator can run here; Blender shows why not, where its button is grey."""

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
