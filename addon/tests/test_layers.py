"""scripts/check_layers finds what it looks for."""

from __future__ import annotations

import importlib.machinery
import importlib.util

import pytest
from conftest import ROOT


@pytest.fixture(scope="module")
def check():
    loader = importlib.machinery.SourceFileLoader("check_layers", str(ROOT / "scripts/check_layers"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("check_layers", loader))
    loader.exec_module(module)
    return module


def _write(root, name, text):
    """Writes a file of a tree that has Velour's layers."""
    layers = root / "native/src/layers.cmake"
    for path, content in ((layers, (ROOT / "native/src/layers.cmake").read_text()), (root / name, text)):
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(content)


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("native/src/math/sphere/a.cpp", '#include "math/srbf/kernel.h"\n'),
        ("native/src/math/srbf/a.cpp", '#include "brdf/measure/measurement.h"\n'),
        ("native/src/render/a.h", '#include "capi/guard.h"\n'),
        ("native/src/model/a.cpp", "#include <OpenImageIO/imageio.h>\n"),
        ("native/src/brdf/formats/a.cpp", "#include <ImfHeader.h>\n"),
        ("native/src/scene/scene.cpp", "#include <embree3/rtcore.h>\n"),
        ("native/src/capture/btf/a.cpp", "#include <sys/mman.h>\n"),
        ("native/src/image/a.cpp", "#include <unistd.h>\n"),
        ("native/src/attic/a.cpp", "int a;\n"),
        ("addon/velour/core/a.py", "import bpy\n"),
        ("addon/velour/native/a.py", "def f():\n    from bpy.types import Object\n"),
        ("addon/velour/native/a.py", "from ..core import files\n"),
        ("addon/velour/core/cli/a.py", "from ...engine import engine\n"),
        ("addon/velour/export/a.py", "from ..ui import panels\n"),
    ],
)
def test_a_breach_is_found(check, tmp_path, name, text):
    _write(tmp_path, name, text)
    found = check.violations(tmp_path)
    assert len(found) == 1
    assert name in found[0]


def test_layers_without_an_order_are_found(check, tmp_path):
    _write(
        tmp_path, "native/src/layers.cmake", "layer(image BELOW base)  # layer(base)\nlayer(base BATCH 3)\n"
    )
    assert check.violations(tmp_path) == [
        "native/src/layers.cmake: image is listed before base, which is below it"
    ]


def test_what_is_allowed_passes(check, tmp_path):
    _write(tmp_path, "native/src/image/a.cpp", "#include <OpenImageIO/imageio.h>\n#include <ImfHeader.h>\n")
    _write(tmp_path, "native/src/scene/embree_scene.cpp", "#include <embree3/rtcore.h>\n")
    _write(tmp_path, "native/src/base/a.cpp", "#include <sys/mman.h>\n")
    _write(tmp_path, "native/src/render/a.cpp", '#include "scene/scene.h"\n#include "render/film/film.h"\n')
    _write(tmp_path, "addon/velour/ui/a.py", "import bpy\nfrom ..engine import engine\n")
    assert check.violations(tmp_path) == []
