"""A fit of a node group that several materials share asks which of them get the model."""

import bpy

from support import plots, scenes, window


def start(folder):
    """Called by the harness once the window is there."""
    window.run(folder, (asked, answered))


def _trees(*materials):
    return [scenes.velour_node(material).group.node_tree for material in materials]


def asked(folder):
    """The dialog is open, and nothing runs."""
    material = plots.material()
    copy = material.copy()
    with window.override():
        assert bpy.ops.velour.fit("INVOKE_DEFAULT", material=copy.name) == {"RUNNING_MODAL"}
    yield 0.5
    assert not bpy.context.window_manager.velour.running
    window.screenshot(folder, "dialog")
    assert len(set(_trees(material, copy))) == 1


def answered(_folder):
    material = plots.material()
    copy = material.copy()
    for users, count in (("ALL", 1), ("SINGLE", 2)):
        with window.override():
            fit = {"material": copy.name, "max_lobes": 2, "tolerance": 0.2}
            assert bpy.ops.velour.fit("INVOKE_DEFAULT", users=users, **fit) == {"RUNNING_MODAL"}
        yield from window.until(lambda: not bpy.context.window_manager.velour.running, "the end of the fit")
        assert len(set(_trees(material, copy))) == count, users
