"""Jobs that Python runs on a thread."""

import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest
import velour
from velour.core.files import read_bytes, sha256, sha256_of
from velour.core.read_job import ReadJob, check, is_cancelled
from velour.native import Status, VelourError


def test_result_from_another_thread():
    job = ReadJob(threading.get_ident).start()
    assert job.wait()
    assert job.result() != threading.get_ident()
    assert (job.poll().state, job.poll().fraction) == ("done", 1.0)


def test_waits_no_longer_than_asked():
    go_on, seen = threading.Event(), []
    job = ReadJob(lambda: go_on.wait(10)).start()
    assert not job.wait(timeout=0.0)
    assert job.poll().running
    assert not job.wait(seen.append, timeout=0.25)
    assert len(seen) >= 2
    go_on.set()
    assert job.wait()
    assert job.result() is True


def test_error_belongs_to_who_waits_and_the_job_can_be_started_again():
    outcomes = [OSError("gone"), "there"]

    def read():
        outcome = outcomes.pop(0)
        if isinstance(outcome, Exception):
            raise outcome
        return outcome

    job = ReadJob(read).start()
    with pytest.raises(OSError, match="gone"):
        job.wait()
    assert job.poll().state == "failed"
    assert job.start().wait()
    assert job.result() == "there"


def test_cancel_does_not_wait_for_what_is_read():
    go_on = threading.Event()
    job = ReadJob(lambda: go_on.wait(10)).start()
    job.cancel()
    begun = time.monotonic()
    with pytest.raises(VelourError) as cancelled:
        job.wait()
    assert cancelled.value.status == Status.CANCELLED
    assert time.monotonic() - begun < 1.0
    go_on.set()


def _ended(job, seconds=60.0):
    """Whether the thread does, by itself."""
    end = time.monotonic() + seconds
    while job.poll().running and time.monotonic() < end:
        time.sleep(0.01)
    return not job.poll().running


def test_closing_cancels():
    """Closing ends the thread as well, at the next piece that it reads."""
    pieces, first = [], threading.Event()

    def read():
        for piece in range(10_000):
            check()
            pieces.append(piece)
            first.set()
            time.sleep(0.001)

    job = ReadJob(read).start()
    assert first.wait(10)
    job.close()
    assert _ended(job)
    assert job.poll().state == "cancelled"
    assert len(pieces) < 10_000
    with pytest.raises(VelourError) as cancelled:
        job.wait()
    assert cancelled.value.status == Status.CANCELLED


def test_what_was_cancelled_stays_so_when_the_job_is_started_again():
    go_on, seen = threading.Event(), []

    def read():
        go_on.wait(10)
        seen.append(is_cancelled())
        return len(seen)

    job = ReadJob(read).start()
    first = job._thread
    job.cancel()
    job.start()
    go_on.set()
    first.join()
    assert job.wait()
    assert sorted(seen) == [False, True]
    assert job.poll().state == "done"


def test_no_thread_but_that_of_a_job_is_cancelled():
    ReadJob(lambda: None).start().close()
    check()
    assert not is_cancelled()


@pytest.mark.parametrize("read", [sha256, read_bytes, lambda _path: sha256_of(bytes(1 << 26))])
def test_hashing_and_reading_end_between_two_pieces(tmp_path, read):
    path, go_on, ends = tmp_path / "large", threading.Event(), []
    path.touch()
    with open(path, "r+b") as file:
        file.truncate(1 << 35)  # zeros, which take no room

    def cancelled():
        go_on.wait(10)
        try:
            read(path)
        except VelourError as error:
            ends.append(error.status)

    job = ReadJob(cancelled).start()
    job.close()
    go_on.set()
    assert _ended(job)
    assert ends == [Status.CANCELLED]


def test_hashes_of_files_and_of_bytes(tmp_path):
    data = bytes(range(256)) * 9000  # more than a block
    (tmp_path / "data").write_bytes(data)
    assert read_bytes(tmp_path / "data") == data
    assert sha256(tmp_path / "data") == sha256_of(data)
    assert sha256_of(b"") == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855"


def test_a_process_does_not_wait_for_what_is_read():
    program = """
import time
from velour.core.read_job import ReadJob
ReadJob(lambda: time.sleep(60)).start()
"""
    root = str(Path(velour.__file__).parent.parent)
    begun = time.monotonic()
    subprocess.run([sys.executable, "-c", program], cwd=root, check=True, timeout=300)
    assert time.monotonic() - begun < 20
