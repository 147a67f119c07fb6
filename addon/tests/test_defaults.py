"""Each setting has one default, the library's: panels and help texts, which must repeat it, agree."""

from __future__ import annotations

import argparse
import ast
import ctypes
import importlib
import re

import pytest
from conftest import ROOT
from velour.native import library, structs

# (file of properties, property, options of the library, field). The samples of renders are not among them, a
# Blender scene has more by default; nor are the sizes of captures, which are smaller in Blender.
PROPERTIES = [
    *(("material_settings", name, "Fit", name) for name in ("tolerance", "max_lobes", "seed")),
    ("material_settings", "use_limit_albedo", "Fit", "limit_albedo"),
    ("material_settings", "use_symmetric", "Fit", "symmetric"),
    ("material_settings", "use_all_data", "Fit", "all_data"),
    *(("tile_settings", name, "Capture", name) for name in ("bounces", "held_out")),
    ("render_settings", "share", "Render", "share"),
]
# (verb, option, options of the library, field)
HELP_TEXTS = [
    ("fit", "--tolerance", "Fit", "tolerance"),
    ("fit", "--max-lobes", "Fit", "max_lobes"),
    ("render", "--spp", "Render", "spp"),
    ("render", "--split", "Render", "split"),
    ("render", "--share", "Render", "share"),
    ("capture", "--texels", "Capture", "texels"),
    ("capture", "--samples", "Capture", "samples"),
    ("capture", "--bounces", "Capture", "bounces"),
    ("votf", "--texels", "Votf", "texels"),
    ("votf", "--check-views", "Votf", "check_views"),
    ("votf", "--surface", "Votf", "surface"),
]


def in_library(options: str, field: str) -> float:
    raw = getattr(structs, f"{options}Options")()
    getattr(library.load(), f"vlr_{options.lower()}_options_init")(ctypes.byref(raw))
    value = getattr(raw, field)
    return value[0] if hasattr(value, "__len__") else value


def defaults_of(source: str) -> dict[str, object]:
    """Defaults of the properties in a file."""
    found = {}
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.AnnAssign) and isinstance(node.annotation, ast.Call):
            given = {k.arg: k.value for k in node.annotation.keywords}
            if isinstance(given.get("default"), ast.Constant):
                found[node.target.id] = given["default"].value
    return found


def in_help(verb: str, option: str) -> float:
    parser = argparse.ArgumentParser()
    importlib.import_module(f"velour.core.cli.{verb}").add_arguments(parser)
    (text,) = (action.help for action in parser._actions if option in action.option_strings)
    return float(re.search(r"default: ([\d.]*\d)", text)[1])


@pytest.mark.parametrize(("file", "name", "options", "field"), PROPERTIES)
def test_panels_have_the_defaults_of_the_library(file, name, options, field):
    source = (ROOT / f"addon/velour/properties/{file}.py").read_text(encoding="utf-8")
    assert defaults_of(source)[name] == pytest.approx(in_library(options, field))


@pytest.mark.parametrize(("verb", "option", "options", "field"), HELP_TEXTS)
def test_help_texts_have_the_defaults_of_the_library(verb, option, options, field):
    assert in_help(verb, option) == pytest.approx(in_library(options, field))


def test_another_default_is_found():
    other = 'class Settings:\n    max_lobes: IntProperty(name="Max Lobes", default=8)\n'
    assert defaults_of(other)["max_lobes"] != in_library("Fit", "max_lobes")
