"""The library's state in words, found out once at registration: drawing must neither wait nor call out."""

from ..native import VelourError, library

_problem = ""
_lines = ()


def refresh():
    """Opens the library, or learns why that fails."""
    global _problem, _lines
    try:
        library.load()
        _problem, _lines = "", _describe(library.system())
    except VelourError as error:
        _problem, _lines = str(error), ()


def problem():
    """One sentence on what is wrong with the library, or "" when it works."""
    return _problem


def lines():
    """What the preferences show of a library that works."""
    return _lines


def _describe(system):
    embree = system["embree"]
    return (
        f"Library: {library.library_path()}",
        f"Version: {system['version']} ({system['build_type']}, {system['simd']})",
        f"Embree: {embree['version']} ({embree['path']})",
    )
