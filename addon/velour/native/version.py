"""The version of this package. A test compares it with CMakeLists.txt, bl_info and the manifest."""

VERSION = (0, 1, 0)
ABI_VERSION = 13


def packed(version: tuple[int, int, int] = VERSION) -> int:
    """The version as one integer, packed like vlr_version()."""
    return version[0] * 10000 + version[1] * 100 + version[2]


def version_text(packed: int | None = None) -> str:
    """ "0.1.0" from VERSION, or from an integer packed like vlr_version()."""
    if packed is None:
        return ".".join(str(part) for part in VERSION)
    return f"{packed // 10000}.{packed // 100 % 100}.{packed % 100}"
