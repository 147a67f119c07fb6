"""Where results are kept that can be made again."""

from pathlib import Path

from velour.core import cache


def test_an_extension_has_a_folder_of_its_own(tmp_path, monkeypatch):
    monkeypatch.setattr(cache, "_instead", None)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "xdg"))
    assert cache.user_cache_folder() == tmp_path / "xdg/velour"
    cache.keep_in(str(tmp_path / "extension"))
    assert cache.user_cache_folder() == Path(tmp_path / "extension")
