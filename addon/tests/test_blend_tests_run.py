"""blend-tests/run: which files run beside others."""

from __future__ import annotations

import importlib.util
import sys
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


def test_what_passed_is_kept_until_it_or_the_sources_change(tmp_path, monkeypatch):
    run = load()
    monkeypatch.setattr(sys.modules[run.Kept.__module__], "_ROOT", tmp_path)
    (tmp_path / "README.md").write_text("1")
    program, file = tmp_path / "test_a.py", tmp_path / "kept.json"
    program.write_text("1")
    passed, failed = run.report.Test("x", run.report.PASSED, 1.5), run.report.Test("y", run.report.FAILED)
    kept = run.Kept(file, "sources")
    kept.keep("test_a", program, [passed, failed])
    assert kept.tests("test_a", program) is None
    kept.keep("test_a", program, [passed])
    assert run.Kept(file, "sources").tests("test_a", program) == [passed]
    assert run.Kept(file, "others").tests("test_a", program) is None
    assert run.Kept(file, "sources").tests("test_b", program) is None
    assert run.Kept(None, "").tests("test_a", program) is None
    (tmp_path / "README.md").write_text("2")
    assert run.Kept(file, "sources").tests("test_a", program) == [passed]
    program.write_text("reads docs")
    assert run.Kept(file, "sources").tests("test_a", program) is None
    run.Kept(file, "sources").keep("test_a", program, [passed])
    assert run.Kept(file, "sources").tests("test_a", program) == [passed]
    (tmp_path / "README.md").write_text("3")
    assert run.Kept(file, "sources").tests("test_a", program) is None
    file.write_text("{")
    assert run.Kept(file, "sources").tests("test_a", program) is None
