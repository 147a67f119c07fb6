"""What a panel draws, where there is no window to draw it in."""

import types

import bpy


class Layout:
    """Remembers labels and operators; all else is taken and forgotten."""

    def __init__(self):
        self.texts, self.operators = [], []

    def __getattr__(self, _name):
        return lambda *_arguments, **_settings: self

    def label(self, text="", **_settings):
        self.texts.append(text)

    def operator(self, idname, **_settings):
        self.operators.append(idname)
        return types.SimpleNamespace()


def drawn(panel, **context):
    """The Layout after the panel class was drawn, with lines as long as sentences."""
    layout = Layout()
    context = types.SimpleNamespace(
        window_manager=bpy.context.window_manager,
        scene=bpy.context.scene,
        region=types.SimpleNamespace(width=10000),
        preferences=bpy.context.preferences,
        **context,
    )
    panel.draw(types.SimpleNamespace(layout=layout), context)
    return layout
