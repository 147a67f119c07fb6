"""The zip of scripts/package: complete, and the same from the same files."""

from __future__ import annotations

import os
import re
import subprocess
import zipfile

import package as package_script
import pytest
from conftest import ROOT
from package import write_zip

OF_THE_SYSTEM = re.compile(r"(ld-linux-x86-64|libc|libm|libstdc\+\+|libgcc_s)\.so\.\d+")


@pytest.fixture(scope="module")
def package(tmp_path_factory):
    """The zip, and what the script said."""
    folder = tmp_path_factory.mktemp("package")
    done = subprocess.run(
        [ROOT / "scripts/package", "--output", folder], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    (path,) = folder.glob("velour-*-linux-x64.zip")
    return path, done.stdout


@pytest.fixture(scope="module")
def unpacked(package, tmp_path_factory):
    folder = tmp_path_factory.mktemp("unpacked")
    with zipfile.ZipFile(package[0]) as file:
        file.extractall(folder)
    return folder / "velour"


def _dynamic(file):
    return subprocess.run(["readelf", "-dW", file], check=True, capture_output=True, text=True).stdout


def test_the_same_files_make_the_same_bytes(tmp_path):
    """Whatever their dates, permissions and order in the folder are."""
    zips = []
    for number, names in enumerate((("b.py", "a.so"), ("a.so", "b.py"))):
        folder = tmp_path / str(number) / "velour"
        folder.mkdir(parents=True)
        for place, name in enumerate(names):
            (folder / name).write_bytes(name.encode() * 100)
            os.utime(folder / name, (10**9 + number, 10**9 + place))
            (folder / name).chmod(0o600 + 0o155 * number)
        zips.append(tmp_path / f"{number}.zip")
        write_zip(zips[-1], folder)
    assert zips[0].read_bytes() == zips[1].read_bytes()


def test_is_one_folder_that_older_and_newer_blenders_take(package, unpacked):
    assert {path.name for path in unpacked.parent.iterdir()} == {"velour"}
    assert (unpacked / "__init__.py").is_file()
    assert (unpacked / "blender_manifest.toml").is_file()
    assert not [*unpacked.rglob("__pycache__")]


def test_names_its_folder(package):
    """What Blender's Install removes before it extracts; else it writes over a library that is in use."""
    with zipfile.ZipFile(package[0]) as file:
        assert [name for name in file.namelist() if name.endswith("/")] == ["velour/"]


def test_every_library_is_inside(unpacked):
    inside = {path.name for path in (unpacked / "lib").iterdir()}
    assert {name for name in inside if name.startswith("libembree")}, inside
    for path in (unpacked / "lib").glob("*.so*"):
        needed = set(re.findall(r"\(NEEDED\).*\[(.+)\]", _dynamic(path)))
        assert not {name for name in needed - inside if not OF_THE_SYSTEM.fullmatch(name)}, path.name
    assert not [name for name in inside if "openimageio" in name.lower()]


def test_looks_for_them_in_its_own_folder_first(unpacked):
    text = _dynamic(unpacked / "lib/libvelour.so")
    assert re.search(r"\(RPATH\).*\[\$ORIGIN\]", text), text
    assert "RUNPATH" not in text


def test_shows_nothing_but_its_own_names(unpacked):
    text = subprocess.run(
        ["nm", "-D", "--defined-only", unpacked / "lib/libvelour.so"],
        check=True,
        capture_output=True,
        text=True,
    ).stdout
    names = {line.split()[-1] for line in text.splitlines()}
    assert names
    assert {name for name in names if not name.startswith("vlr_")} == set()


def test_every_library_has_its_licence(unpacked):
    """Its own: zlib and liblzma are in /lib to Debian's packages, and elsewhere in /usr/lib."""
    text = (unpacked / "lib/LICENSES.txt").read_text()
    headings = " ".join(re.findall(r"^(.+) \(Debian's [a-z0-9.+-]+\)\n=", text, re.MULTILINE))
    for path in (unpacked / "lib").glob("*.so*"):
        assert path.name == "libvelour.so" or path.name in headings.replace(",", " ").split()
    for owner in ("Jean-loup Gailly", "Lasse Collin"):
        assert owner in text


def test_a_library_without_a_licence_is_refused(tmp_path):
    (tmp_path / "libmine.so.1").touch()
    with pytest.raises(SystemExit, match=r"license of libmine\.so\.1"):
        package_script._write_licences([tmp_path / "libmine.so.1"], tmp_path / "LICENSES.txt")


def test_runs_on_what_the_documentation_names(package):
    glibc, runtime = re.search(
        r"needs glibc ([\d.]+) and libstdc\+\+ with GLIBCXX_([\d.]+)", package[1]
    ).groups()
    page = (ROOT / "docs/engine/packaging.md").read_text()
    assert f"glibc {glibc}" in page
    assert f"GLIBCXX_{runtime}" in page


def test_works_alone(unpacked, tmp_path):
    """The library finds its own Embree and OpenEXR with nothing on the path."""
    program = (
        "from velour.native import library; import json; s = library.system();"
        "print(json.dumps(s['embree'])); print(open('/proc/self/maps').read())"
    )
    done = subprocess.run(
        ["/usr/bin/python3", "-c", program],
        env={"PYTHONPATH": str(unpacked.parent), "HOME": str(tmp_path)},
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
    mapped = set(re.findall(r"(/\S+\.so\S*)", done.stdout))
    ours = {path for path in mapped if re.search(r"embree|tbb|OpenEXR|Imath|Iex|IlmThread", path)}
    assert ours
    assert {path for path in ours if not path.startswith(str(unpacked))} == set()
