"""Where results are kept that can be made again."""

import pwd
from pathlib import Path

from velour.core import cache


def test_an_extension_has_a_folder_of_its_own(tmp_path, monkeypatch):
    monkeypatch.setattr(cache, "_instead", None)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "xdg"))
    assert cache.user_cache_folder() == tmp_path / "xdg/velour"
    cache.keep_in(str(tmp_path / "extension"))
    assert cache.user_cache_folder() == Path(tmp_path / "extension")


def test_without_a_home_folder_there_is_none(monkeypatch):
    """Such as in containers whose user has no entry in the password file."""

    def getpwuid(user):
        raise KeyError(user)

    monkeypatch.setattr(cache, "_instead", None)
    monkeypatch.setattr(pwd, "getpwuid", getpwuid)
    for name in ("HOME", "XDG_CACHE_HOME"):
        monkeypatch.delenv(name, raising=False)
    assert cache.user_cache_folder() == ""
