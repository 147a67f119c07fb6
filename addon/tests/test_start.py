"""What a short command does not wait for: OpenImageIO's 260 libraries, and numpy."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys

import numpy as np
import pytest
from command_line import environment
from conftest import ADDONS
from velour.native import VelourError, images, library

MODULE = ADDONS / "velour/lib/libvelour_openimageio.so"

_INFO = """
from velour.core.cli.main import main
assert main(["info", argument, "--quiet"]) == 0
"""
_READ_PNG = """
from velour.native import images
images.read(argument)
"""
_TELL = """
print(*sys.modules)
print(open("/proc/self/maps").read())
"""


def _loaded(script: str, argument) -> tuple[set[str], set[str]]:
    """Python's modules and the shared libraries of a process that has run `script`."""
    program = f"import sys\nargument = sys.argv[1]\n{script}{_TELL}"
    done = subprocess.run(
        [sys.executable, "-P", "-c", program, argument], capture_output=True, text=True, env=environment()
    )
    assert done.returncode == 0, done.stderr
    modules, _, maps = done.stdout.partition("\n")
    return set(modules.split()), set(re.findall(r"/([^/\s]+?)\.so", maps))


@pytest.fixture
def png(tmp_path):
    path = tmp_path / "picture.png"
    images.write(path, np.ones((2, 2, 3), np.float32))
    return path


def test_info_waits_for_neither(model_file):
    modules, libraries = _loaded(_INFO, model_file)
    assert "libvelour" in libraries
    assert {name for name in libraries if "OpenImageIO" in name or "openimageio" in name} == set()
    assert "numpy" not in modules
    assert len(libraries) < 40  # Python's own and those that libvelour.so needs


def test_a_picture_opens_openimageio(png):
    modules, libraries = _loaded(_READ_PNG, png)
    assert {"libOpenImageIO", "libvelour_openimageio"} <= libraries
    assert "numpy" in modules


@pytest.fixture
def without_module(tmp_path, monkeypatch):
    shutil.copy(MODULE.with_name("libvelour.so"), tmp_path)
    monkeypatch.setenv("VELOUR_LIBRARY", str(tmp_path / "libvelour.so"))
    library.release()
    yield tmp_path
    library.release()


def test_without_the_module_a_picture_says_what_to_do(png, without_module):
    """Each time, and both ways."""
    for call in (images.read, images.read, lambda path: images.write(path, np.ones((2, 2, 3), np.float32))):
        with pytest.raises(VelourError) as caught:
            call(png)
        sentence = str(caught.value)
        assert sentence.startswith(f"{png}: requires OpenImageIO, but {MODULE.name} cannot be loaded")
        assert "scripts/build" in sentence
        assert "\n" not in sentence


def test_without_the_module_openexr_files_are_read(without_module):
    path = without_module / "picture.exr"
    images.write(path, np.ones((2, 2, 3), np.float32))
    assert images.read(path).shape == (2, 2, 3)


def test_the_module_exports_one_symbol():
    """Blender has an OpenImageIO of its own in the process."""
    done = subprocess.run(["nm", "-D", "--defined-only", MODULE], check=True, capture_output=True, text=True)
    assert [line.split()[-1] for line in done.stdout.splitlines()] == ["velour_openimageio_2"]
