"""Finds, opens and checks libvelour.

The library lies in `lib/` of this package; VELOUR_LIBRARY names another file. Every failure is a
LibraryError with the file, the cause and the remedy. Nothing is opened before the first load().
"""

from __future__ import annotations

import ctypes
import json
import os
import platform
from pathlib import Path

from . import table
from .errors import LibraryError, VelourError
from .mapped_file import is_replaced
from .version import ABI_VERSION, packed, version_text

_FILE_NAMES = {"Linux": "libvelour.so", "Darwin": "libvelour.dylib", "Windows": "velour.dll"}
_loaded: ctypes.CDLL | None = None


def library_path() -> Path:
    """The file that load() opens."""
    chosen = os.environ.get("VELOUR_LIBRARY")
    if chosen:
        return Path(chosen)
    name = _FILE_NAMES.get(platform.system(), "libvelour.so")
    return Path(__file__).resolve().parent.parent / "lib" / name


def load() -> ctypes.CDLL:
    """The library with its types bound; opened and checked once."""
    global _loaded
    if _loaded is None:
        _loaded = _open(library_path())
    return _loaded


def release() -> None:
    """Forgets the library: the next load() looks for the file again. Existing handles keep theirs open."""
    global _loaded
    _loaded = None


def system() -> dict:
    """Information on the library: version, embree, simd, simd_targets, threads, build_type."""
    return json_of(load().vlr_system_json)


def select_simd(name: str) -> None:
    """Pins the instruction set of all kernels: "auto", or one of system()["simd_targets"]."""
    load().vlr_select_simd(name.encode("utf-8", "replace"))


def denoiser() -> dict:
    """Opens Open Image Denoise. Returns its version and path; raises VelourError if it is missing."""
    return json_of(load().vlr_denoiser_json)


def set_denoiser(path: str | os.PathLike) -> None:
    """Sets the file of Open Image Denoise to try first; VELOUR_OIDN wins. No effect once one is open."""
    load().vlr_set_denoiser_file(os.fsencode(os.environ.get("VELOUR_OIDN") or path))


def json_of(function, *arguments) -> dict:
    """Calls `function(*arguments, &text)` and parses the text."""
    text = ctypes.c_char_p()
    function(*arguments, ctypes.byref(text))
    return json.loads(text.value.decode("utf-8"))


def file_info(path: str | os.PathLike) -> dict:
    """info() of the Measurement, Btf, Model or Observation in a file."""
    return json_of(load().vlr_file_info_json, os.fsencode(path))


def _open(path: Path) -> ctypes.CDLL:
    where = f"{path} ({platform.system()} {platform.machine()}, Python {platform.python_version()})"
    remedy = "build it with scripts/build, install the package for this platform, or unset VELOUR_LIBRARY"
    if not path.is_file():
        raise LibraryError(f"The Velour library {where} does not exist; {remedy}.")
    try:
        library = ctypes.CDLL(str(path))
    except OSError as error:
        raise LibraryError(f"The Velour library {where} cannot be loaded ({error}); {remedy}.") from error
    _check_version(library, path, where, remedy)
    try:
        table.bind(library)
    except AttributeError as error:
        raise LibraryError(
            f"The Velour library {where} has a missing function ({error}); {remedy}."
        ) from error
    library.vlr_set_denoiser_file(os.fsencode(os.environ.get("VELOUR_OIDN", "")))
    try:
        library.vlr_self_test()
    except VelourError as error:
        raise LibraryError(f"The Velour library {where} failed its self-test: {error}") from error
    return library


def _check_version(library: ctypes.CDLL, path: Path, where: str, remedy: str) -> None:
    # Checked before anything else is bound: a foreign library may lack everything.
    try:
        version, abi = library.vlr_version, library.vlr_abi_version
    except AttributeError as error:
        raise LibraryError(f"{where} is not a Velour library ({error}); {remedy}.") from error
    if is_replaced(path, version):  # the loader returns what it has mapped by this name
        raise LibraryError(
            f"The Velour library {where} was replaced, for example by an update, but Blender still uses"
            " the previous one; restart Blender."
        )
    version.restype = abi.restype = ctypes.c_uint32
    if (version(), abi()) != (packed(), ABI_VERSION):
        raise LibraryError(
            f"The Velour library {where} is version {version_text(version())} (interface {abi()}), but this"
            f" package needs {version_text()} (interface {ABI_VERSION}); {remedy}."
        )
