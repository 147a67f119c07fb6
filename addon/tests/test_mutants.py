"""scripts/mutants reads, plants and judges faults, takes them back, and continues a campaign that stopped."""

from __future__ import annotations

import contextlib
import re
import subprocess
from pathlib import Path

import mutant_faults
import mutant_tree
import mutants
import pytest
from conftest import ROOT
from mutant_faults import Entry, MutantsError, Outcome, Run
from mutants import LONG, MISSED, SEEN, UNPLANTED, Results

_HEADER = "Fault: the number is wrong.\nReason: everybody suffers.\nNearest: python:test_mutants.py\n"
_DIFF = "\n--- a/value.txt\n+++ b/value.txt\n@@ -1 +1 @@\n-one\n+two\n"


def _patch(folder: Path, name: str = "wrong-number", text: str = _HEADER + _DIFF) -> Path:
    folder.mkdir(exist_ok=True)
    path = folder / f"{name}.patch"
    path.write_text(text)
    return path


def test_pages_agree_with_the_faults():
    names = {fault.name for fault in mutant_faults.read_all(mutants.FAULTS)}
    page = (ROOT / "docs/engine/testing.md").read_text(encoding="utf-8")
    assert f"`scripts/lib/mutants` holds {len(names)} faults" in page
    table = (ROOT / "docs/results/planted_faults.md").read_text(encoding="utf-8")
    rows = {
        name
        for row in re.findall(r"^\| [\w-]+/[\w/-]+ \| (.+) \|$", table, flags=re.M)
        for name in row.split(", ")
    }
    assert len(rows) > 80
    assert rows - names == set()


def test_a_tree_with_a_fault_is_not_checked(monkeypatch, tmp_path, capsys):
    monkeypatch.setattr(mutants, "FAULTS", tmp_path)  # has none
    monkeypatch.delenv(mutant_tree.PLANTED, raising=False)  # this may be such a tree
    assert mutants.main(["--check"]) == mutants.FAILED
    monkeypatch.setenv(mutant_tree.PLANTED, "wrong-number")
    assert mutants.main(["--check"]) == mutants.DONE
    assert "no fault is planted in native/src/render" in capsys.readouterr().err


def test_a_header_is_read(tmp_path):
    header = _HEADER + "Nearest: native:capi/job_test.cpp,unit/base/job_test.cpp=Job.*\n"
    fault = mutant_faults.read(_patch(tmp_path, text=header + _DIFF))
    assert (fault.name, fault.planted, fault.reason) == (
        "wrong-number",
        "the number is wrong.",
        "everybody suffers.",
    )
    names = ["python:test_mutants.py", "native:capi/job_test.cpp", "native:unit/base/job_test.cpp=Job.*"]
    assert list(map(str, fault.nearest)) == names
    assert fault.files == ("value.txt",)


@pytest.mark.parametrize(
    ("wrong", "word"),
    [
        (_HEADER.replace("Reason: everybody suffers.\n", "") + _DIFF, "'Reason'"),
        (_HEADER + "Fault: another one\n" + _DIFF, "'Fault'"),
        (_HEADER + "Author: nobody\n" + _DIFF, "Author"),
        (_HEADER.replace("python:", "ruby:") + _DIFF, "ruby"),
        (_HEADER, "no diff"),
    ],
)
def test_wrong_headers_are_named(tmp_path, wrong, word):
    path = _patch(tmp_path, text=wrong)
    with pytest.raises(MutantsError, match=word) as refused:
        mutant_faults.read(path)
    assert path.name in str(refused.value)


def _tree(folder: Path) -> Path:
    """A root with one folder of code, one test and a file to plant a fault in."""
    for name, text in {
        "native/src/base/job.h": "",
        "addon/velour/a.py": "",
        "addon/tests/test_mutants.py": "",
        "value.txt": "one\n",
    }.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text)
    return folder


def test_the_check_names_what_is_wrong(tmp_path, monkeypatch):
    root, folder = _tree(tmp_path), tmp_path / "faults"
    monkeypatch.setattr(mutant_faults, "LEAST_FAULTS", 1)
    _patch(folder, "good")
    uncovered = [f"no fault is planted in {name}" for name in ("addon/velour", "native/src/base")]
    assert list(mutant_faults.problems(root, folder)) == uncovered
    _patch(folder, "old", _HEADER + _DIFF.replace("-one", "-three"))
    _patch(folder, "lost", _HEADER.replace("test_mutants", "test_nothing") + _DIFF)
    _patch(folder, "empty", "")
    found = list(mutant_faults.problems(root, folder))
    assert [sentence.split()[0].rstrip(":") for sentence in found[:3]] == [
        "empty.patch",
        "lost.patch",
        "old.patch",
    ]
    assert "does not apply" in found[2]
    monkeypatch.setattr(mutant_faults, "LEAST_FAULTS", 40)
    assert "there are 3 faults, and 40 are needed" in list(mutant_faults.problems(root, folder))


_CMAKE = """
velour_test(first FILES a_test.cpp
                        $<TARGET_OBJECTS:other> b_test.cpp LINK velour_job LABEL unit)
velour_test(second FILES ../far/c_test.cpp LINK velour_job LABEL unit)
"""


@pytest.fixture
def native(tmp_path) -> Path:
    folder = tmp_path / "native/tests/unit/job"
    folder.mkdir(parents=True)
    (folder / "CMakeLists.txt").write_text(_CMAKE)
    (folder / "b_test.cpp").write_text(
        "TEST(Plain, A) {}\nTEST_P(\n    Many, B) {}\nTYPED_TEST(Typed, C)\n// TEST(No, D)\nTEST_F(Plain, E)"
    )
    (folder / "lost_test.cpp").write_text("TEST(Lost, A) {}")
    (folder / "none_test.cpp").write_text("")
    (folder.parent / "far").mkdir()
    (folder.parent / "far/c_test.cpp").write_text("TEST(Far, A) {}")
    return tmp_path


def test_native_tests_are_found_by_their_file(native):
    run = mutant_faults.run_of(native, Entry("native", "unit/job/b_test.cpp"))
    assert run.targets == ("test_first",)
    assert run.command[0] == "build/release/native/tests/unit/job/test_first"
    suites = run.command[1].removeprefix("--gtest_filter=").split(":")
    assert suites == [f"{left}{name}{right}" for name in ("Plain", "Many", "Typed") for left, right in _FORMS]
    far = mutant_faults.run_of(native, Entry("native", "unit/far/c_test.cpp=Far.A"))
    assert far.targets == ("test_second",)
    assert far.command[1] == "--gtest_filter=Far.A"


_FORMS = (("", ".*"), ("", "/*"), ("*/", ".*"))


@pytest.mark.parametrize(
    "entry",
    [
        Entry("native", "unit/job/gone_test.cpp"),
        Entry("native", "unit/job/lost_test.cpp"),  # no program compiles it
        Entry("python", "test_gone.py"),
        Entry("python", ""),
        Entry("blender", "test_gone"),
        Entry("scenes", "gone"),
    ],
    ids=str,
)
def test_tests_that_are_not_there_are_named(native, entry):
    with pytest.raises(MutantsError, match=entry.what):
        mutant_faults.run_of(native, entry)


_JUNIT = """<testsuites><testsuite><testcase classname="addon.tests.test_a" name="good"/>
<testcase classname="addon.tests.test_a" name="bad"><failure/></testcase>
<testcase classname="addon.tests.test_a" name="left"><skipped/></testcase></testsuite></testsuites>"""


@pytest.mark.parametrize(
    ("report", "said", "status", "expected"),
    [
        (_JUNIT, "", 1, Outcome(1, ("test_a.bad",))),
        (None, "[ RUN      ] Job.Ends\n[ RUN      ] Job.Dies\n", -11, Outcome(0, ("Job.Dies",))),
        (None, "[ RUN      ] Job.Hangs\n", None, Outcome(0, ("Job.Hangs did not end",))),
        ("<testsuites>", "", 139, Outcome(0, ("the run as a whole",))),
        (None, "", 0, Outcome(0, ())),
    ],
)
def test_the_case_that_failed_is_named(tmp_path, report, said, status, expected):
    if report:
        (tmp_path / "report.xml").write_text(report)
    (tmp_path / "log.txt").write_text(said)
    run = Run((), (), "report.xml", 1)
    assert mutant_faults.outcome(tmp_path, run, status, tmp_path / "log.txt") == expected


def test_reports_of_a_group_are_read_together(tmp_path):
    folder = tmp_path / "tests/native"
    folder.mkdir(parents=True)
    (folder / "test_a.xml").write_text(_JUNIT)
    (folder.parent / "scenes.xml").write_text(
        '<testsuite><testcase name="lens"><error/></testcase></testsuite>'
    )
    found = mutant_faults.outcome(tmp_path, Run((), (), "tests", 1), 1, tmp_path / "log.txt")
    assert found == Outcome(1, ("test_a.bad", "lens"))


def test_the_long_suite_is_not_judged_by_the_style_of_a_fault(tmp_path):
    (tmp_path / "log.txt").write_text("clang-format failed")
    run = mutant_faults.run_of_group(mutant_faults.LONG_SUITE)
    assert mutant_faults.outcome(tmp_path, run, 1, tmp_path / "log.txt") == Outcome(0, ())
    assert mutant_faults.outcome(
        tmp_path, mutant_faults.run_of_group("native"), 1, tmp_path / "log.txt"
    ).failed


def _git(folder: Path, *arguments: str) -> None:
    identity = ("-c", "user.name=nobody", "-c", "user.email=nobody@nowhere")
    subprocess.run(["git", *identity, *arguments], cwd=folder, check=True, capture_output=True)


@pytest.fixture
def repository(tmp_path) -> Path:
    root = tmp_path / "root"
    (root / "scripts").mkdir(parents=True)
    (root / "value.txt").write_text("one\n")
    (root / ".gitignore").write_text("/build/\n")
    build = root / "scripts/build"
    build.write_text("#!/bin/sh\ngrep -q three value.txt && exit 1\nexit 0\n")
    build.chmod(0o755)
    _git(root, "init", "--quiet")
    _git(root, "add", ".")
    _git(root, "commit", "--quiet", "-m", "first")
    return root


def test_a_fault_is_planted_in_a_copy_and_taken_back(repository, tmp_path, monkeypatch):
    tree = mutant_tree.Tree(repository, repository / "build/mutants/tree")
    tree.prepare(mutant_tree.head(repository))
    run = Run(("test_x",), ("sh", "-c", "echo $VELOUR_MUTANT; grep one value.txt"), "report.xml", 60)
    log, patch = tmp_path / "logs/log.txt", _patch(tmp_path)
    assert tree.run(run, log) == Outcome(0, ())
    with tree.planted(patch):
        assert tree.run(run, log, "wrong-number").failed
        assert (repository / "value.txt").read_text() == "one\n"
    assert "wrong-number" in log.read_text()
    assert not tree.run(run, log).failed
    assert mutant_faults.refusal(tree.folder, _patch(tmp_path, "old", _DIFF.replace("-one", "-none")))
    broken = _patch(tmp_path, "broken", _DIFF.replace("+two", "+three"))
    with tree.planted(broken), pytest.raises(mutant_tree.BuildError):
        tree.run(run, log)
    # A campaign that was killed while a fault was planted, and a commit that came meanwhile.
    (tree.folder / "value.txt").write_text("two\n")
    (repository / "value.txt").write_text("one and a half\n")
    _git(repository, "commit", "--quiet", "-am", "second")
    tree.prepare(mutant_tree.head(repository))
    assert (tree.folder / "value.txt").read_text() == "one and a half\n"


def test_a_test_that_hangs_is_ended(repository, tmp_path):
    tree = mutant_tree.Tree(repository, repository)
    run = Run((), ("sh", "-c", "sleep 600 & sleep 600"), "report.xml", 0.1)
    assert tree.run(run, tmp_path / "log.txt").failed == ("the run as a whole did not end",)


def test_a_copy_that_is_not_clean_is_refused(repository):
    (repository / "left.txt").write_text("")
    with pytest.raises(MutantsError, match=r"left\.txt"):
        mutant_tree.Tree(repository, repository).restore()


class _FakeTree:
    """Plants nothing: `sees` says which case of which tests fails with which fault; "" is no fault."""

    def __init__(self, folder: Path, sees: dict[tuple[str, str], str]):
        self.folder, self.sees = folder, sees
        self.ran: list[tuple[str, str]] = []  # tests and fault
        self.interrupted_at = ""  # a fault

    @contextlib.contextmanager
    def planted(self, _patch: Path):
        yield

    def run(self, run: Run, _log: Path, fault: str = "") -> Outcome:
        if fault and fault == self.interrupted_at:
            raise KeyboardInterrupt
        self.ran.append((run.command[-1], fault))
        case = self.sees.get((run.command[-1], fault)) or self.sees.get((run.command[-1], ""))
        return Outcome(5, (case,) if case else ())


@pytest.fixture
def campaign(tmp_path, monkeypatch):
    """campaign(tree, *names): has these faults judged; the results."""
    monkeypatch.setitem(mutant_faults.KINDS, "python", lambda _root, what: Run((), (what,), "", 1))
    monkeypatch.setattr(mutant_faults, "refusal", lambda _root, patch: patch.stem == "old")

    def judge(tree: _FakeTree, *names: str, commit: str = "1", minutes: float = 1) -> dict[str, str | None]:
        faults = [mutant_faults.read(_patch(tmp_path / "faults", name, _two_nearest())) for name in names]
        results = Results(tmp_path / "results.json", commit)
        mutants.Campaign(tree, results, faults, minutes).run()
        return {fault.name: results.state(fault) for fault in faults}

    return judge


def _two_nearest() -> str:
    return _HEADER.replace("test_mutants.py", "near,next") + _DIFF


def test_faults_meet_tests_until_one_sees_them(campaign, tmp_path):
    tree = _FakeTree(
        tmp_path,
        {
            ("near", "a"): "A.first",
            ("next", "b"): "B.second",
            ("python", ""): "always red",
            ("blender", "c"): "C.third",
            ("--all", "d"): "D.fourth",
        },
    )
    states = campaign(tree, "a", "b", "c", "d", "e", "old")
    assert states == {"a": SEEN, "b": SEEN, "c": SEEN, "d": LONG, "e": MISSED, "old": UNPLANTED}
    assert tree.ran[:2] == [("near", ""), ("next", "")]
    assert ("next", "a") not in tree.ran
    assert ("scenes", "c") not in tree.ran
    assert ("native", "c") not in tree.ran  # it changes no native code
    results = Results(tmp_path / "results.json", "1")
    table = mutants.table(results, mutant_faults.read_all(tmp_path / "faults"))
    assert "| . | a, b, c |" in table
    assert "- d: only the long suite: D.fourth\n- e: missed\n- old: does not apply\n" in table


def test_a_test_that_is_red_without_a_fault_is_no_evidence(campaign, tmp_path):
    tree = _FakeTree(tmp_path, {("near", ""): "always", ("near", "a"): "A", ("next", "a"): "A.next"})
    assert campaign(tree, "a") == {"a": SEEN}
    results = Results(tmp_path / "results.json", "1")
    assert results.faults["a"]["by"] == "python:next"
    assert results.unusable() == ["not usable: python:near: always fails without a fault, too"]


def test_the_next_run_continues_where_one_was_interrupted(campaign, tmp_path):
    sees = {("near", name): name for name in "abc"}
    tree = _FakeTree(tmp_path, sees)
    tree.interrupted_at = "b"
    with pytest.raises(KeyboardInterrupt):
        campaign(tree, "a", "b", "c")
    tree = _FakeTree(tmp_path, sees)
    assert campaign(tree, "a", "b", "c") == dict.fromkeys("abc", SEEN)
    assert tree.ran == [("near", "b"), ("near", "c")]
    tree = _FakeTree(tmp_path, sees)
    assert campaign(tree, "a", commit="2") == {"a": SEEN}
    assert tree.ran == [("near", ""), ("next", ""), ("near", "a")]


def test_a_patch_that_changed_is_judged_again(tmp_path):
    results = Results(tmp_path / "results.json", "1")
    fault = mutant_faults.read(_patch(tmp_path))
    results.keep(fault, SEEN, 1.0, "python:near", "a")
    assert Results(tmp_path / "results.json", "1").state(fault) == SEEN
    changed = mutant_faults.read(_patch(tmp_path, text=_HEADER + _DIFF.replace("two", "three")))
    assert Results(tmp_path / "results.json", "1").state(changed) is None


def test_no_fault_is_begun_once_the_time_is_over(campaign, tmp_path):
    with pytest.raises(mutants.TimeOverError):
        campaign(_FakeTree(tmp_path, {}), "a", minutes=0)


def test_unknown_names_are_refused(capsys):
    assert mutants.main(["--table", "no-such-fault"]) == mutants.FAILED
    assert "no-such-fault" in capsys.readouterr().err
