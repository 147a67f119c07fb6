"""The farm's reader of EXR headers, on files of another writer: whole ones pass, damaged ones do not."""

from __future__ import annotations

import shutil
import struct
import subprocess

import pytest
from velour.farm import exr

COMPRESSIONS = ["none", "rle", "zips", "zip", "piz", "pxr24", "b44", "b44a", "dwaa", "dwab"]
pytestmark = pytest.mark.skipif(not shutil.which("oiiotool"), reason="oiiotool is not installed")


def _write(path, *options):
    """Noise with a height that no chunk divides, and a half channel beside floats."""
    picture = ["--create", "37x75", "3", "--noise:type=uniform", "--attrib", "velour.version", "9.8.7"]
    subprocess.run(["oiiotool", *picture, *options, "-o", str(path)], check=True, capture_output=True)
    return path


@pytest.mark.parametrize("compression", COMPRESSIONS)
def test_every_compression(tmp_path, compression):
    path = _write(tmp_path / "picture.exr", "--compression", compression, "-d", "half")
    exr.check_whole(path)
    assert exr.text_attribute(path, "velour.version") == "9.8.7"
    assert exr.text_attribute(path, "velour.models") is None
    whole = path.read_bytes()
    exr.check_whole(path, unpack=False)
    for length in (0, 7, 100, len(whole) // 2, len(whole) - 1):
        path.write_bytes(whole[:length])
        for unpack in (True, False):
            with pytest.raises(exr.ExrError):
                exr.check_whole(path, unpack)


def test_several_parts(tmp_path):
    path = tmp_path / "parts.exr"
    one, other = (_write(tmp_path / f"{name}.exr", "--compression", name) for name in ("zip", "piz"))
    subprocess.run(["oiiotool", str(one), str(other), "--siappend", "-o", str(path)], check=True)
    exr.check_whole(path)
    assert exr.text_attribute(path, "velour.version") == "9.8.7"
    path.write_bytes(path.read_bytes()[:-1])
    with pytest.raises(exr.ExrError, match="ends too early"):
        exr.check_whole(path)


def test_scanlines_that_were_never_written(tmp_path):
    """What a writer that is killed leaves: the table of chunks is there, with zeros in it."""
    path = _write(tmp_path / "picture.exr", "--compression", "zip")
    data = bytearray(path.read_bytes())
    with open(path, "rb") as file:
        (part,) = exr._parts(file)
        table = file.tell()
    data[table + 8 : table + 16] = bytes(8)
    path.write_bytes(data)
    with pytest.raises(exr.ExrError, match="never written"):
        exr.check_whole(path)
    data[table + 8 : table + 16] = data[table : table + 8]
    path.write_bytes(data)
    with pytest.raises(exr.ExrError, match="scanlines are missing"):
        exr.check_whole(path)
    assert part.chunks == 5


@pytest.mark.parametrize("compression", ["zips", "zip"])
def test_packed_bytes_that_changed(tmp_path, compression):
    path = _write(
        tmp_path / "picture.exr", "--compression", compression, "--colorconvert", "linear", "linear"
    )
    subprocess.run(
        ["oiiotool", "--create", "64x64", "3", "--compression", compression, "-o", str(path)], check=True
    )
    exr.check_whole(path)
    data = bytearray(path.read_bytes())
    data[-3] ^= 0x55
    path.write_bytes(data)
    with pytest.raises(exr.ExrError, match="cannot be unpacked"):
        exr.check_whole(path)


def test_what_is_refused(tmp_path):
    tiled = _write(tmp_path / "tiled.exr", "--tile", "16", "16")
    with pytest.raises(exr.ExrError, match="tiles"):
        exr.check_whole(tiled)
    text = tmp_path / "text.exr"
    text.write_text("no picture at all")
    with pytest.raises(exr.ExrError, match="no OpenEXR file"):
        exr.check_whole(text)
    long = tmp_path / "long.exr"  # an attribute that claims more than any has
    long.write_bytes(struct.pack("<2i", exr.MAGIC, 2) + b"a\0string\0" + struct.pack("<i", 1 << 30))
    with pytest.raises(exr.ExrError, match="makes no sense"):
        exr.check_whole(long)
    tall = tmp_path / "tall.exr"
    window = struct.pack("<4i", 0, 0, 9, 2**31 - 1)
    header = (
        b"compression\0compression\0"
        + struct.pack("<ib", 1, 3)
        + b"dataWindow\0box2i\0"
        + struct.pack("<i", 16)
    )
    tall.write_bytes(struct.pack("<2i", exr.MAGIC, 2) + header + window + b"\0")
    with pytest.raises(exr.ExrError, match="data window makes no sense"):
        exr.check_whole(tall)


def test_what_a_later_version_may_write(tmp_path):
    """It may be whole: whoever removes broken files must be able to tell."""
    path = _write(tmp_path / "picture.exr", "--compression", "zip")
    data = path.read_bytes()
    kind = b"compression\0compression\0" + struct.pack("<i", 1)
    path.write_bytes(data.replace(kind + b"\3", kind + b"\x20"))
    with pytest.raises(exr.UnknownExrError, match="compression is not known"):
        exr.check_whole(path, unpack=False)
