"""What a user can read in Blender's interface: of Velour, and of Blender itself."""

import ast
import importlib
import re
from pathlib import Path

import bpy

from .inputs import ADDON

_MENUS = {
    "File > Import": "TOPBAR_MT_file_import",
    "File > New": "TOPBAR_MT_file_new",
    "Add > Mesh": "VIEW3D_MT_mesh_add",
}
_PACKAGES = ("ui", "operators", "properties", "engine", "export")


def ours():
    """Labels of classes, names of their properties and choices, and the texts of panels and menus."""
    return {_without_endings(text) for text in our_texts(_PACKAGES)}


def our_texts(packages=("",)):
    """Every string in the add-on's sources."""
    root = Path(importlib.import_module(ADDON).__file__).parent
    files = [file for package in packages for file in (root / package).rglob("*.py")]
    trees = [ast.parse(file.read_text(encoding="utf-8")) for file in files]
    return {node.value for tree in trees for node in ast.walk(tree) if _is_text(node)}


def _is_text(node):
    return isinstance(node, ast.Constant) and isinstance(node.value, str)


def blenders():
    """Labels, names of properties and choices of types and operators, and texts in Blender's panels."""
    found = _written()
    operators = (
        getattr(getattr(bpy.ops, name), n) for name in dir(bpy.ops) for n in dir(getattr(bpy.ops, name))
    )
    for rna in (*(t.bl_rna for t in _types()), *(operator.get_rna_type() for operator in operators)):
        if _is_ours(rna.identifier):
            continue
        found.add(rna.name)
        for prop in rna.properties:
            found.add(prop.name)
            if prop.type == "ENUM":
                found.update(item.name for item in prop.enum_items)
    return found


def our_entries(path):
    """What Velour adds to a menu."""
    menu = getattr(bpy.types, _MENUS[path])
    recorder = _Recorder()
    for draw in menu.draw._draw_funcs:
        if draw.__module__.startswith(ADDON):
            draw(recorder, bpy.context)
    return {_without_endings(text) for text in recorder.texts}


def _without_endings(text):
    """Measured Material (.velour, ...) is called by its name."""
    return text.partition(" (.")[0]


class _Recorder:
    """A menu and its layout: remembers the texts that are put into it."""

    def __init__(self):
        self.texts, self.layout = [], self

    def __getattr__(self, _name):
        return lambda *names, text="", **_keywords: self.texts.append(text or _operator_label(*names))


def _operator_label(name="", *_):
    """Label of `velour.name`, which a menu shows without a text of its own."""
    group, _, operator = name.partition(".")
    return getattr(getattr(bpy.ops, group), operator).get_rna_type().name if operator else ""


def _types():
    found = (getattr(bpy.types, name) for name in dir(bpy.types))
    return [kind for kind in found if hasattr(kind, "bl_rna")]


def _is_ours(identifier):
    return identifier.upper().startswith("VELOUR")


def _written():
    """text="..." and bl_label of Blender's panels, also of its extensions': some names stand nowhere else."""
    scripts = Path(bpy.utils.system_resource("SCRIPTS"))
    folders = (scripts / "startup", scripts / "addons_core/bl_pkg")  # the latter in 4.2 and newer
    sources = [file.read_text(encoding="utf-8") for folder in folders for file in folder.rglob("*.py")]
    return {text for source in sources for text in re.findall(r'(?:text|bl_label)\s*=\s*"([^"]+)"', source)}
