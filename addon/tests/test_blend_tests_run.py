"""blend-tests/run: which files run beside others."""

from __future__ import annotations

import importlib.util
from importlib.machinery import SourceFileLoader
from pathlib import Path

from conftest import ROOT


def load():
    loader = SourceFileLoader("blend_tests_run", str(ROOT / "blend-tests/run"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(loader.name, loader))
    loader.exec_module(module)
    return module


def test_files_that_run_alone_come_last_one_by_one(tmp_path, monkeypatch):
    run, rounds = load(), []

    def noted(paths, _where, jobs, windows):
        rounds.append(([path.stem for path in paths], jobs, windows))
        yield from paths

    for name, text in (
        ("a", 'ALONE = "reason"\n'),
        ("b", ""),
        ("c", '# ALONE = "x"\n'),
        ("d", 'ALONE = "y"\n'),
    ):
        (tmp_path / f"{name}.py").write_text(text)
    paths = sorted(Path(tmp_path).iterdir())
    monkeypatch.setattr(run, "_run_all", noted)
    assert set(run._run_in_turn(paths, None, 2, 3)) == set(paths)
    assert rounds == [(["b", "c"], 2, 3), (["a"], 1, 1), (["d"], 1, 1)]


def test_journeys_run_alone_and_are_long():
    run = load()
    journeys = [path for path in run._programs() if path.stem.startswith("window_journey_")]
    assert len(journeys) == 3
    for path in journeys:
        text = path.read_text(encoding="utf-8")
        assert run._ALONE.search(text), path
        assert run._LONG.search(text), path
        assert run._OWN_PROCESS.search(text), path
