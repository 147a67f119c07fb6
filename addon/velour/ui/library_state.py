"""The library's state in words."""

from ..native import VelourError, library


def problem():
    """One sentence on what is wrong with the library, or "" when it works."""
    try:
        library.load()
        return ""
    except VelourError as error:
        return str(error)


def lines():
    """What the preferences show of a library that works."""
    system = library.system()
    embree = system["embree"]
    return (
        f"Library: {library.library_path()}",
        f"Version: {system['version']} ({system['build_type']}, {system['simd']})",
        f"Embree: {embree['version']} ({embree['path']})",
    )
