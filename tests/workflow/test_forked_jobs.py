"""Scripts that begin as copies of one process: what they see, how they end, when Python starts instead."""

import gc
import os
import signal
import socket
import subprocess
import sys
import time
from contextlib import contextmanager, nullcontext
from pathlib import Path

import psutil
import pytest
from projects import ROOT

from workflow.process import forked_jobs, job_server
from workflow.process.engine import Script
from workflow.process.forked_jobs import ForkedJobs
from workflow.process.orphans import end_orphans

pytestmark = [
    pytest.mark.skipif(sys.platform != "linux", reason="copies of a process are made on Linux alone"),
    pytest.mark.xdist_group("forked_jobs"),
]


@pytest.fixture(scope="module")
def jobs(tmp_path_factory):
    """The server of a run in an empty folder."""
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(tmp_path_factory.mktemp("run"))
        patch.setenv("PYTHONPATH", str(ROOT))
        jobs = ForkedJobs(
            lambda rule: {"figures": ["colorsys"]}.get(rule, []),
            lambda rule: {
                "sweep": [("logging:addLevelName", {"level": 5, "levelName": "loaded"}), ("logging:none", {})]
            }.get(rule, []),
        )
        jobs.start()
        yield jobs


@pytest.fixture
def used():
    """What the script that ran last has used, at its end."""
    return []


@pytest.fixture
def run(jobs, tmp_path, monkeypatch, used):
    """Exit code of a text run as a script of this folder, and the processes that were watched."""
    monkeypatch.chdir(tmp_path)

    def run(text, rule="modal", threads=1, temporary=""):
        (tmp_path / "stage.py").write_text(text)
        watched = []
        used.clear()

        @contextmanager
        def watch(process):
            watched.append(psutil.Process(process))
            yield used.append

        return jobs.run(Script(rule, "stage.py", threads, temporary, watch)), watched

    return run


def test_a_script_sees_what_python_would_show_it(run, tmp_path, monkeypatch):
    monkeypatch.setenv("ASKED", "now")
    (tmp_path / "beside.py").write_text("")
    code, watched = run(
        """
import beside, os, signal, sys, threading
from pathlib import Path
blocked = signal.pthread_sigmask(signal.SIG_BLOCK, ())
told = [os.environ[name] for name in ("ASKED", "TMPDIR", "OMP_NUM_THREADS")]
found = [__name__, sys.argv, os.getcwd(), *told]
Path("seen").write_text(repr([*found, os.getpid(), signal.SIGINT in blocked, threading.active_count()]))
""",
        temporary="/elsewhere",
    )
    seen = ["__main__", ["stage.py"], str(tmp_path), "now", "/elsewhere", "1", watched[0].pid, True, 1]
    assert code == 0 and (tmp_path / "seen").read_text() == repr(seen)


def test_the_modules_of_a_rule_are_imported_once_for_all_its_jobs(run, tmp_path):
    text = "import sys; from pathlib import Path; Path('seen').write_text(str('colorsys' in sys.modules))"
    assert run(text)[0] == 0 and (tmp_path / "seen").read_text() == "False"
    assert run(text, rule="figures")[0] == 0 and (tmp_path / "seen").read_text() == "True"


def test_machine_code_of_a_rule_is_loaded_once_for_all_its_jobs_and_what_cannot_be_loaded_stops_none(
    run, tmp_path
):
    """Each of a dozen jobs read and linked that of the time integration, for a third of a second."""
    text = "import logging; from pathlib import Path; Path('seen').write_text(logging.getLevelName(5))"
    assert run(text, rule="sweep")[0] == 0
    assert (tmp_path / "seen").read_text() == "loaded"


def test_what_a_job_has_used_counts_from_its_begin_to_its_end(run, used):
    """Samples every half second missed all of a short job, and of any other what came after the last one."""
    text = """
import time
kept, start = b"1" * 400_000_000, time.process_time()
while time.process_time() < start + 0.3:
    pass
"""
    assert run(text)[0] == 0 and len(used) == 1
    assert used[0].processor >= 0.3 and used[0].memory >= 4e8


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("raise SystemExit(3)", 3),
        ("raise SystemExit('no')", 1),
        ("1 / 0", 1),
        ("import os, signal; os.kill(os.getpid(), signal.SIGKILL)", -9),
        ("import os; os._exit(7)", 7),
        ("import atexit, os; atexit.register(os._exit, 5)", 5),
        ("import threading, os; threading.Timer(0.2, lambda: os._exit(6)).start()", 6),
        ("import sys; sys.stdout.close()", 0),
        ("import sys; sys.stdout = None", 0),
        ("import sys; sys.stdout = object()", 120),
        ("import sys; sys.stdout = open('/dev/full', 'w'); print('lost')", 120),
    ],
)
def test_a_script_ends_as_it_would_by_itself(run, text, code):
    assert run(text)[0] == code


def test_the_server_serves_on_after_a_request_that_was_cut_short(jobs, run):
    """The server ended, and the jobs that were at work with it."""
    for part in (b"", b'{"script": "st'):
        ours, theirs = socket.socketpair()
        with ours, theirs:
            socket.send_fds(jobs._control, [b"."], [theirs.fileno()])
            ours.sendall(part)
    assert run("")[0] == 0


def test_no_copy_is_made_where_the_system_has_no_room_for_it(monkeypatch):
    """The server ended, and the jobs that were at work with it."""

    def no_room():
        raise BlockingIOError

    monkeypatch.setattr(os, "fork", no_room)
    monkeypatch.setattr(job_server, "_is_alone", lambda: True)
    ours, theirs = socket.socketpair()
    working = {}
    with ours, theirs:
        ours.sendall(b'{"modules": [], "machine_code": []}\n')
        job_server._begin(theirs, working, ())
        assert ours.recv(1) == b"" and not working
    gc.unfreeze()


def test_a_run_that_ended_before_it_heard_of_a_job_does_not_watch_it():
    """The job printed a traceback after the run had ended."""
    ours, theirs = socket.socketpair()
    with theirs:
        with ours:
            theirs.sendall(b"[17]\n")
        assert not job_server._is_watched(theirs)


CHILD_OF_AN_IMPORT = """
import os
from workflow.process import job_server
process = os.fork() or os._exit(0)
os.waitid(os.P_PID, process, os.WEXITED | os.WNOWAIT)
job_server._report_ended({})
"""


def test_the_end_of_what_an_import_has_started_is_no_job_s():
    subprocess.run([sys.executable, "-c", CHILD_OF_AN_IMPORT], cwd=ROOT, check=True)


def test_a_script_begins_when_it_is_watched(jobs, tmp_path, monkeypatch):
    """A short one ended before its benchmark had found it."""
    monkeypatch.chdir(tmp_path)
    Path("stage.py").write_text("open('begun', 'w')")

    @contextmanager
    def watch(process):
        time.sleep(0.3)
        assert psutil.pid_exists(process) and not Path("begun").exists()
        yield lambda used: None

    assert jobs.run(Script("modal", "stage.py", 1, "", watch)) == 0 and Path("begun").exists()


def test_a_job_on_two_threads_is_no_copy_of_a_process_with_one(run):
    assert run("", threads=2) == (None, [])


def test_python_is_started_where_there_is_no_server(tmp_path, monkeypatch):
    monkeypatch.setenv(forked_jobs.VARIABLE, "no")
    jobs = ForkedJobs(lambda rule: [])
    jobs.start()
    assert jobs.run(Script("modal", "stage.py", 1, "", None)) is None


def test_a_job_whose_server_is_killed_is_ended_and_the_next_one_is_python_s_own(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PYTHONPATH", str(ROOT))
    Path("stage.py").write_text("import time; time.sleep(60)")
    jobs = ForkedJobs(lambda rule: [])
    jobs.start()
    watched = []

    @contextmanager
    def watch(number):
        watched.append(process := psutil.Process(number))
        process.parent().kill()
        yield lambda used: pytest.fail("nobody knows what it has used")

    script = Script("modal", "stage.py", 1, "", watch)
    assert jobs.run(script) == -signal.SIGKILL
    psutil.wait_procs(watched, timeout=10)
    assert not watched[0].is_running() and jobs.run(script) is None


KILLED = """
from contextlib import nullcontext
from pathlib import Path
from workflow.process.engine import Script
from workflow.process.forked_jobs import ForkedJobs
jobs = ForkedJobs(lambda rule: [])
jobs.start()
watched = lambda process: nullcontext(Path("working").write_text(f"{process}.") and (lambda used: None))
jobs.run(Script("modal", "long.py", 1, "", watched))
"""


def test_a_job_that_a_killed_run_left_here_is_ended_and_our_own_server_is_not(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PYTHONPATH", str(ROOT))
    Path("long.py").write_text("import time; time.sleep(60)")
    Path("short.py").touch()
    killed = subprocess.Popen([sys.executable, "-c", KILLED])
    while not Path("working").exists() or not Path("working").read_text().endswith("."):
        assert killed.poll() is None
        time.sleep(0.02)
    killed.kill()
    killed.wait()
    own = ForkedJobs(lambda rule: [])
    own.start()
    assert end_orphans()
    assert not psutil.pid_exists(int(Path("working").read_text()[:-1])) and not end_orphans()
    assert own.run(Script("modal", "short.py", 1, "", lambda process: nullcontext(lambda used: None))) == 0
