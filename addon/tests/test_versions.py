"""One version everywhere."""

from __future__ import annotations

import ast
import re

from conftest import ROOT
from velour.native.version import VERSION, version_text


def _cmake_version() -> str:
    return re.search(r"project\(velour VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text())[1]


def test_package_agrees_with_cmake():
    assert version_text() == _cmake_version()


def test_packed_version():
    assert version_text(10203) == "1.2.3"


def test_bl_info_agrees():
    tree = ast.parse((ROOT / "addon/velour/__init__.py").read_text())
    assigned = [n for n in tree.body if isinstance(n, ast.Assign) and n.targets[0].id == "bl_info"]
    assert ast.literal_eval(assigned[0].value)["version"] == VERSION


def test_manifest_agrees():
    manifest = (ROOT / "addon/velour/blender_manifest.toml").read_text()
    assert re.search(r'^version = "(.*)"', manifest, flags=re.MULTILINE)[1] == version_text()


def test_changelog_knows_the_version():
    assert f"## {version_text()}" in (ROOT / "CHANGELOG.md").read_text()
