"""The library's state, determined once at registration, since drawing must not block or call the library."""

from ..native import VelourError, library

_problem = ""
_lines = ()


def refresh():
    """Loads the library, or stores the reason why that fails."""
    global _problem, _lines
    try:
        library.load()
        _problem, _lines = "", _describe(library.system())
    except VelourError as error:
        _problem, _lines = str(error), ()


def problem():
    """One sentence on what is wrong with the library, or "" if it works."""
    return _problem


def lines():
    """Description of a working library for the preferences."""
    return _lines


def _describe(system):
    embree = system["embree"]
    return (
        f"Library: {library.library_path()}",
        f"Version: {system['version']} ({system['build_type']}, {system['simd']})",
        f"Embree: {embree['version']} ({embree['path']})",
    )
