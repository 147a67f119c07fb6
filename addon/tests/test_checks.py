"""scripts/test: cases are counted as they ended, a crash is never a pass, and --all goes on where it was."""

from __future__ import annotations

import shutil
import subprocess
import sys

import pytest
import test_run
from bench import page
from bench.pages import test_times
from checks import campaign, cases, groups, measured_pages, running
from checks.cases import FAILED, PASSED, SKIPPED, Case
from checks.sources import sources


def _report(path, *found):
    inner = "".join(
        f'<testcase name="{name}" status="{status}" time="1.5">{child}</testcase>'
        for name, status, child in found
    )
    path.parent.mkdir(exist_ok=True)
    path.write_text(f"<testsuite>{inner}</testsuite>")
    return path


@pytest.mark.parametrize(
    ("ctest_child", "inner", "expected"),
    [
        ("", [("a", "run", ""), ("b", "run", "<skipped/>"), ("c", "notrun", "")], (1, 0, 2)),
        ("<failure/>", [("a", "run", ""), ("b", "run", "<failure/>")], (1, 1, 0)),
        ("<failure/>", [("a", "run", "")], (0, 1, 0)),  # died after its report
        ("<failure/>", [], (0, 1, 0)),  # died before it
    ],
)
def test_counts(tmp_path, ctest_child, inner, expected):
    ctest = _report(tmp_path / "ctest.xml", ("sphere", "run", ctest_child))
    if inner:
        _report(tmp_path / "native/test_sphere.xml", *inner)
    counts = cases.count(cases.of_ctest(ctest, tmp_path / "native"))
    assert tuple(counts[outcome] for outcome in (PASSED, FAILED, SKIPPED)) == expected


def test_reasons_are_counted(tmp_path):
    skipped = '<skipped message="no test data: nickel"/>'
    report = _report(tmp_path / "python.xml", ("a", "run", skipped), ("b", "run", skipped))
    assert cases.reasons(cases.of_report(report)) == ["skipped: 2 x no test data: nickel"]


def test_times_are_read(tmp_path):
    (case,) = cases.of_report(_report(tmp_path / "one.xml", ("a", "run", "")))
    assert case == Case("a", PASSED, 1.5)
    assert cases.slowest([case, Case("b", PASSED, 2.0)], 1) == [Case("b", PASSED, 2.0)]
    names = "parity/test_sky.Sky.test_sun", "parity/test_sky.Sky.test_air", "addon.tests.test_btf.test_pairs"
    found = cases.by_file([Case(name, PASSED, 2.0) for name in (*names, "Lobe.Peaks")], 2)
    assert found == [("parity/test_sky", 2, 4.0), ("addon.tests.test_btf", 1, 2.0)]


def test_a_cut_report_has_no_cases(tmp_path):
    (tmp_path / "cut.xml").write_text("<testsuite><testcase")
    assert cases.of_report(tmp_path / "cut.xml") == cases.of_report(tmp_path / "none.xml") == []


def test_a_tool_that_fails_without_a_failed_test_is_a_failure(tmp_path, capsys):
    passed = [Case("a", PASSED)]
    judged = groups._judged("ctest", 8, passed, tmp_path / "none.log")
    assert cases.count(judged) == {PASSED: 1, FAILED: 1}
    assert groups._judged("ctest", 0, passed, tmp_path / "none.log") == passed
    assert cases.count(groups._judged("ctest", 0, [], tmp_path / "none.log")) == {FAILED: 1}


def test_a_check_that_fails_shows_its_log(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(groups.Run, "results", tmp_path)
    command = (sys.executable, "-c", "print('what is wrong'); raise SystemExit(1)")
    assert groups.check(groups.Run(), "style", *command).outcome == FAILED
    assert "what is wrong" in capsys.readouterr().out


def test_progress_is_read_from_the_log():
    assert running.last(r"\[ *(\d+%)\]", "of the tests")("... [ 12%]\n... [ 45%]\n") == "45% of the tests"
    assert running.matches(r": (ok|FAILED), ", "files")("a: ok, 3 passed\nb: FAILED, 1\nnoise\n") == "2 files"


def test_sources_are_what_gitignore_does_not_match(tmp_path):
    ignored = (".git/config", "build/a", "addon/__pycache__/a.py", "addon/a.pyc")
    kept = (".gitignore", "addon/a.py", "addon/build/a")
    for name in (*ignored, *kept):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).touch()
    (tmp_path / ".gitignore").write_text("/build/\n__pycache__/\n*.pyc\n")
    assert sources(tmp_path) == sorted(kept)


def test_a_campaign_repeats_only_what_a_change_may_break(tmp_path):
    for name in (
        ".gitignore",
        "native/src/a.cpp",
        "addon/velour/a.py",
        "native/tests/a_test.cpp",
        "docs/a.md",
        "scripts/lib/test_run.py",
    ):
        (tmp_path / "tree" / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / "tree" / name).write_text("1")
    file = tmp_path / "all.json"
    all_groups = {"native", "python", "blender", "blender 5.2", "fuzz"}
    run, beside = (campaign.Campaign(file, tmp_path / "tree") for _ in range(2))
    for name in all_groups:
        one = beside if name == "fuzz" else run
        assert one.kept(name) is None
        for outcomes in ([SKIPPED], [PASSED, FAILED]):  # what was not run, or has failed, is not kept
            one.keep(name, [Case(name, outcome, 1.0) for outcome in outcomes])
            assert campaign.Campaign(file, tmp_path / "tree").kept(name) is None
        one.keep(name, [Case(name, PASSED, 1.0)])

    def repeated():
        kept = campaign.Campaign(file, tmp_path / "tree")
        return {name for name in all_groups if kept.kept(name) != [Case(name, PASSED, 1.0)]}

    def after_a_change_of(name):
        (tmp_path / "tree" / name).write_text("2")
        found = repeated()
        (tmp_path / "tree" / name).write_text("1")
        return found

    assert repeated() == set()
    assert after_a_change_of("native/src/a.cpp") == all_groups
    assert after_a_change_of("addon/velour/a.py") == all_groups - {"native", "fuzz"}
    assert after_a_change_of("native/tests/a_test.cpp") == {"native", "python", "fuzz"}
    assert after_a_change_of("scripts/lib/test_run.py") == {"python"}
    assert after_a_change_of("docs/a.md") == {"python", "blender", "blender 5.2"}
    for new in ("docs/new.md", "README.md"):
        assert after_a_change_of(new) == {"python", "blender", "blender 5.2"}
        (tmp_path / "tree" / new).unlink()
    assert campaign.Campaign(file, tmp_path / "tree").kept("style") is None

    def hash_but_files():
        return run.sources_but_files("blender 5.2")

    # blend-tests/run itself sees changes of the files of tests and of documents.
    before, files = hash_but_files(), tmp_path / "tree/blend-tests"
    files.mkdir()
    (files / "test_a.py").write_text("1")
    (tmp_path / "tree/README.md").write_text("1")
    assert hash_but_files() == before
    (tmp_path / "tree/README.md").unlink()
    (files / "harness.py").write_text("1")
    assert hash_but_files() != before
    shutil.rmtree(files)
    file.write_text("{")
    assert repeated() == all_groups


def test_all_runs_every_group_and_resumes(tmp_path, monkeypatch, capsys):
    ran = []

    def passes(name):
        ran.append(name)
        return [Case(name, PASSED, 1.0)]

    monkeypatch.setattr(test_run, "GROUPS", {"style": lambda _run: passes("style")})
    monkeypatch.setattr(groups, "night", lambda _run: passes("night"))
    monkeypatch.setattr(groups, "other_blender", lambda _run, version: passes(version))
    monkeypatch.setattr(groups, "fuzz", lambda _run: passes("fuzz"))
    monkeypatch.setattr(groups.Run, "results", tmp_path)
    monkeypatch.setattr(test_run, "_build", lambda *_arguments: True)
    done = subprocess.CompletedProcess([], 0, stdout=b"")
    monkeypatch.setattr(subprocess, "run", lambda *_arguments, **_options: done)
    monkeypatch.setattr(sys, "argv", ["scripts/test", "--all"])
    for _ in range(2):
        assert test_run.main() == 0
        assert capsys.readouterr().out.splitlines()[-1] == "6 passed, 0 failed, 0 not run"
    assert ran == ["style", "night", "4.3", "5.2", "4.5", "fuzz"]
    (tmp_path / "all.json").unlink()
    monkeypatch.setattr(sys, "argv", ["scripts/test", "--all", "--blender", "5.2", "fuzz"])
    assert test_run.main() == 0
    assert ran[6:] == ["5.2", "fuzz"]


def test_the_table_of_times_has_groups_their_sum_and_the_slowest():
    groups = {
        "style": {
            "tests": 5,
            "seconds": 12.4,
            "processor": 20.0,
            "slowest": [("layers", 1.25)],
            "files": [("layers", 1, 1.25)],
        },
        "native": {
            "tests": 100,
            "seconds": 300.0,
            "processor": 590.0,
            "slowest": [("Lobe.Integrates", 30.0)],
            "files": [("Lobe", 7, 44.0)],
        },
    }
    conditions = {"date": "d", "commit": "c", "machine": "m", "threads": 2, "seed": 0, "shown": 10}
    found = {"conditions": conditions, "groups": groups, "demo": 300.4}
    text = page.text("test_times", conditions | test_times.values(found))
    for line in (
        "took\n300 s from nothing",
        "| style | 5 | 12 | 20 |",
        "| all | 105 | 312 | 610 |",
        "| native | Lobe | 7 | 44 |",
        "| native | Lobe.Integrates | 30.0 |",
    ):
        assert line in text


def _commit(root, name, text):
    path = root / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    settings = ["-c", "user.name=Test", "-c", "user.email=test@example.com"]
    for command in (["add", "."], [*settings, "commit", "-q", "-m", name]):
        subprocess.run(["git", "-C", root, *command], check=True)
    return subprocess.run(
        ["git", "-C", root, "rev-parse", "--short=12", "HEAD"], check=True, capture_output=True, text=True
    ).stdout.strip()


def test_pages_are_old_when_what_they_measure_has_changed(tmp_path):
    assert "no git history" in measured_pages.told(tmp_path)[0]
    subprocess.run(["git", "init", "-q", tmp_path], check=True)
    measured = _commit(tmp_path, "native/src/brdf/formats/load.cpp", "1")
    page = "docs/results/models.md"
    _commit(tmp_path, page, f"All numbers come from one run: 2026-11-20, commit {measured},\n")
    assert measured_pages.told(tmp_path) == []
    _commit(tmp_path, "native/src/render/render.cpp", "2")
    assert measured_pages.told(tmp_path) == []
    _commit(tmp_path, "native/src/brdf/formats/load.cpp", "3")
    (sentence,) = measured_pages.told(tmp_path)
    assert page in sentence
    assert "1 commits" in sentence
    _commit(tmp_path, page, "All numbers come from one run: 2026-11-20, commit 0123456789ab,\n")
    assert "not known" in measured_pages.told(tmp_path)[0]
