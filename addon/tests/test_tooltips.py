"""Blender shows the docstring of a panel or menu as its tooltip: notes to programmers are comments there."""

from __future__ import annotations

import ast

from conftest import ROOT

SHOWN = ("bpy.types.Panel", "bpy.types.Menu", "Panel", "Menu")


def with_docstrings(source: str) -> list[str]:
    """The names of panels and menus whose docstring is their tooltip."""
    classes = [node for node in ast.walk(ast.parse(source)) if isinstance(node, ast.ClassDef)]
    shown = [c for c in classes if any(ast.unparse(base) in SHOWN for base in c.bases)]
    return [c.name for c in shown if ast.get_docstring(c) is not None]


def test_no_docstring_is_a_tooltip():
    paths = sorted((ROOT / "addon/velour").rglob("*.py"))
    assert len(paths) > 100
    found = {path.name: with_docstrings(path.read_text(encoding="utf-8")) for path in paths}
    assert {name: classes for name, classes in found.items() if classes} == {}


def test_a_docstring_is_found():
    panel = 'class VELOUR_PT_look(_Panel, bpy.types.Panel):\n    """{}"""\n    bl_label = "Look"\n'
    assert with_docstrings(panel.format("Replaces Blender's own panel.")) == ["VELOUR_PT_look"]
    assert with_docstrings(panel.replace('"""{}"""', "# Replaces Blender's own panel.")) == []
    assert with_docstrings('class Steps:\n    """Steps of a job."""\n') == []
