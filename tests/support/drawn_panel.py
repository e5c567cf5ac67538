"""A panel drawn without a window."""

from types import SimpleNamespace

from loaded_addon import module

verdict_view = module("interface.verdict_view")


class Drawn:
    """A layout that notes what is drawn in it."""

    def __init__(self):
        self.texts, self.buttons, self.icons, self.calls, self.properties = [], [], [], [], {}

    def label(self, text="", icon="NONE"):
        self.texts.append(text)
        self.icons.append(icon)

    def operator(self, name, text="", icon="NONE"):
        self.buttons.append(text or name)
        self.calls.append((name, type("Properties", (), {})()))
        return self.calls[-1][1]

    def prop(self, _data, name, text="", **_options):
        self.properties[name] = text

    def column(self, **_options):
        return self

    def separator(self, **_options):
        pass

    row = split = column


def drawn(obj, width=220, is_edited=False):
    """Drawn in a region of so many pixels."""
    style = SimpleNamespace(widget=SimpleNamespace(points=11))
    preferences = SimpleNamespace(system=SimpleNamespace(ui_scale=1.0), ui_styles=[style])
    layout, context = Drawn(), SimpleNamespace(region=SimpleNamespace(width=width), preferences=preferences)
    verdict_view.draw(layout, context, obj.holomorph_map.made, is_edited)
    return layout
