"""Runs: the same bits as the command line, arrays without copies, other threads, signals, failures."""

import csv
import json
import signal
import subprocess
import sys
import threading
import time
import tracemalloc
import warnings

import numpy as np
import pandas
import polars
import pytest
from conftest import TOP

import looselink

# Files of a result that a repeated run writes with the same bytes.
FILES = ["channels.csv", "motion.bin", "onsets.csv", "scene.toml", "summary.json"]


def columns(path):
    """The columns of a table as text."""
    with open(path, newline="", encoding="utf-8") as file:
        header, *rows = csv.reader(file)
    return dict(zip(header, zip(*rows)))


@pytest.mark.parametrize(
    ("scene", "settings"),
    [
        ("3rrr/case3.toml", {"simulation.duration": 0.006}),
        ("3rrr/case4.toml", {"simulation.duration": 0.004, "integrator.method": "esdirk3"}),
        ("pendulum.toml", {"simulation.duration": 0.5}),
        ("cantilever-static.toml", {}),
        ("bouncing-journal.toml", {"integrator.accuracy": {"position": 1e-9, "horizon": 0.01}}),
    ],
)
def test_files_and_arrays_have_the_bits_of_the_command_line(scene, settings, program, tmp_path):
    path = TOP / "scenes" / scene
    scene = looselink.load(path)
    for key, value in settings.items():
        scene.set(key, value)
    overrides = [part for override in scene.overrides for part in ("--set", override)]
    program("run", path, *overrides, "--out", tmp_path / "a", "--quiet")
    run = scene.run(out=tmp_path / "b")
    for file in FILES:
        assert (tmp_path / "a" / file).read_bytes() == (tmp_path / "b" / file).read_bytes(), file
    assert json.loads((tmp_path / "a/timing.json").read_text()).keys() == json.loads((tmp_path / "b/timing.json").read_text()).keys()
    in_memory = scene.run()
    stored = columns(tmp_path / "a/channels.csv")
    assert [f"{name} [{run.units[name]}]" for name in run] == list(stored)
    for name, text in zip(run, stored.values()):
        values = np.array([float(number) for number in text])
        assert values.tobytes() == run[name].tobytes() == in_memory[name].tobytes(), name
    assert run.summary == json.loads((tmp_path / "a/summary.json").read_text("utf-8"))
    onsets = columns(tmp_path / "a/onsets.csv")
    for heading, text in onsets.items():
        column = run.onsets[heading.split(" [")[0]]
        if heading == "joint":
            assert list(column) == list(text)
        else:
            assert column.tobytes() == np.array([float(number or "nan") for number in text]).tobytes()


def test_arrays_are_the_memory_of_the_solver(case3):
    run = case3.set("output.interval", 1.25e-6).run()
    x = run["error.x"]
    assert x.dtype == np.float64
    assert x.flags.c_contiguous
    assert x.shape == run.t.shape == (4801,)
    # NumPy does not own it, and it is the same memory every time
    assert not x.flags.owndata
    assert type(x.base).__name__ == "PySliceContainer"
    assert run["error.x"].__array_interface__["data"] == x.__array_interface__["data"]
    tracemalloc.start()
    arrays = [run[name] for name in run]
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    # less than one of the 38 columns
    assert peak < arrays[0].nbytes
    frame = run.to_pandas()
    assert np.shares_memory(frame["error.x [m]"].to_numpy(), x)


def test_arrays_are_read_only_and_outlive_the_run(case3):
    run = case3.run()
    x, onsets = run["error.x"], run.onsets
    for array in (x, run.t, *onsets.values()):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0
    kept = x.copy()
    del run
    assert kept.tobytes() == x.tobytes()


def test_a_run_is_a_mapping(case3):
    run = case3.run()
    assert list(run) == run.channels == run.keys() == list(dict(run))
    assert len(run) == len(run.channels)
    assert run.channels[0] == "t"
    assert "error.x" in run
    assert "error.X" not in run
    assert 3 not in run
    assert run.units["error.x"] == "m"
    assert list(run.select("error.*")) == [name for name in run if name.startswith("error.")]
    assert list(run.select("error.x")) == ["error.x"]
    with pytest.raises(KeyError, match='did you mean \\\\?"error.x\\\\?"'):
        run["eror.x"]
    with pytest.raises(KeyError, match="no channel"):
        run.select("nothing.*")
    assert run.status == "complete"
    assert "complete" in repr(run)


def test_a_printed_run_has_the_closing_table(case3):
    run = case3.run()
    shown = str(run)
    assert shown.startswith(repr(run) + "\n")
    assert {"errors", "forces", "drives", "contacts"} <= set(run.summary["closing"])
    for words in ["error of platform", "force of A1", "torque in A1", "contact of B1: ", "energy: "]:
        assert f"\n{words}" in shown


def test_frames_are_those_of_the_file(case3, tmp_path):
    run = case3.run(out=tmp_path / "out")
    stored = pandas.read_csv(tmp_path / "out/channels.csv", dtype=str).astype(float)
    frame = run.to_pandas()
    pandas.testing.assert_frame_equal(frame, stored, check_exact=True)
    assert frame.attrs["units"] == run.units
    assert run.to_polars().equals(polars.from_pandas(stored))


def test_an_earlier_result_is_not_overwritten(oscillator, tmp_path, program):
    oscillator.run(out=tmp_path / "out")
    with pytest.raises(FileExistsError, match="holds a result already .*; choose another folder, or replace it with force=True"):
        oscillator.run(out=tmp_path / "out")
    oscillator.run(out=str(tmp_path / "out"), force=True)
    file = tmp_path / "file"
    file.touch()
    with pytest.raises(NotADirectoryError):
        oscillator.run(out=file)


def test_warnings_are_those_of_the_summary(case3):
    # steps that do not resolve the impacts
    case3.set("simulation.duration", 0.012).set("integrator.step", 1e-5)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        run = case3.run()
    assert [str(warning.message) for warning in caught] == run.warnings == run.summary["warnings"]
    assert run.warnings
    assert all(warning.category is looselink.RunWarning for warning in caught)
    # where the user wrote it
    assert all(warning.filename == __file__ for warning in caught)
    with warnings.catch_warnings():
        warnings.simplefilter("error", looselink.RunWarning)
        with pytest.raises(looselink.RunWarning) as error:
            case3.run()
    # it is the first of them, and the run is not lost
    assert str(error.value) == run.warnings[0] == error.value.run.warnings[0]


def test_a_run_that_fails_keeps_its_rows(program, tmp_path):
    path = TOP / "scenes/stiff-spring-pendulum.toml"
    scene = looselink.load(path).set("integrator", {"method": "velocity_verlet", "step": 1e-2})
    scene.set("output.interval", 1e-2)
    overrides = [part for override in scene.overrides for part in ("--set", override)]
    expected = program("run", path, *overrides, "--out", tmp_path / "a", "--quiet", expect=3)
    with pytest.raises(looselink.RunError) as caught:
        scene.run(out=tmp_path / "b")
    assert f"error: {caught.value}; the results up to that time are in" in expected
    run = caught.value.run
    assert run.status == "failed"
    assert 0 < len(run.t) < 1000
    for file in FILES:
        assert (tmp_path / "a" / file).read_bytes() == (tmp_path / "b" / file).read_bytes(), file


def test_other_threads_run_meanwhile(case3):
    case3.set("simulation.duration", 0.1)
    ended = threading.Event()
    counted = []

    def count():
        while not ended.is_set():
            counted.append(time.perf_counter())

    thread = threading.Thread(target=count)
    thread.start()
    begun = time.perf_counter()
    case3.run()
    done = time.perf_counter()
    ended.set()
    thread.join()
    during = [t for t in counted if begun < t < done]
    # with the lock held there would be none; a loaded machine gives each thread a share
    assert len(during) > 1000
    gaps = np.diff(during)
    assert gaps.max() < 0.5 * (done - begun)


def test_runs_in_threads_are_independent(case3):
    expected = case3.run()["error.x"].tobytes()
    results = [None, None]

    def run(place):
        results[place] = case3.run()["error.x"].tobytes()

    threads = [threading.Thread(target=run, args=(place,)) for place in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert results == [expected, expected]


def test_progress_is_shown_as_asked(case3, capsys):
    case3.set("simulation.duration", 0.1)
    seen = []
    case3.run(progress=lambda t, duration: seen.append((t, duration)))
    assert all(duration == 0.1 for _, duration in seen)
    times = [t for t, _ in seen]
    assert times == sorted(times)
    assert times[-1] == 0.1
    assert capsys.readouterr().err == ""
    case3.run(progress=True)
    lines = capsys.readouterr().err.splitlines()
    assert all("s of 0.1 s, " in line and "x real time, closed contacts: " in line for line in lines)
    case3.run(progress=False)
    assert capsys.readouterr().err == ""
    with pytest.raises(TypeError, match="progress"):
        case3.run(progress=3)


def test_an_exception_of_the_progress_ends_the_run(case3):
    def stop(t, duration):
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough") as caught:
        case3.set("simulation.duration", 3.0).run(progress=stop)
    run = caught.value.run
    assert run.status == "incomplete"
    assert run.t[-1] < 3.0


INTERRUPTED = """
import sys, time
import looselink
scene = looselink.load("scenes/3rrr/case3.toml").set("simulation.duration", 60.0)
scene.set("output", {"interval": 1e-2, "channels": ["error.x"], "motion": False})
try:
    scene.run(progress=lambda t, duration: print("under way", flush=True))
except KeyboardInterrupt as stopped:
    print(f"stopped {time.time()} {stopped.run.status} {len(stopped.run.t)}", flush=True)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="sends a signal of POSIX")
def test_ctrl_c_ends_a_run():
    process = subprocess.Popen([sys.executable, "-c", INTERRUPTED], cwd=TOP, stdout=subprocess.PIPE, text=True)
    for _ in range(5):
        assert process.stdout.readline() == "under way\n"
    sent = time.time()
    process.send_signal(signal.SIGINT)
    rest, _ = process.communicate(timeout=60)
    assert process.returncode == 0
    _, when, status, rows = rest.splitlines()[-1].split()
    # looked for every tenth of a second; the rest is for a loaded machine
    assert float(when) - sent < 0.5
    assert status == "incomplete"
    assert int(rows) >= 1


def test_long_runs_keep_no_second_copy():
    """The peak of the process grows by the arrays and little else."""
    if not sys.platform.startswith("linux"):
        pytest.skip("reads /proc")
    code = """
import resource, looselink
scene = looselink.load("scenes/pendulum.toml").set("simulation.duration", 100.0)
scene.set("integrator.method", "bathe").set("integrator.step", 1e-3)
scene.set("output", {"interval": 1e-3, "channels": ["*"], "motion": False})
scene.copy().set("simulation.duration", 1.0).run()
before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
run = scene.run()
after = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
print((after - before) * 1024, sum(run[name].nbytes for name in run))
"""
    done = subprocess.run([sys.executable, "-c", code], cwd=TOP, capture_output=True, text=True, check=True)
    grown, arrays = map(int, done.stdout.split())
    assert arrays > 10e6
    # a second copy of one array would be a twentieth
    assert grown < arrays + 0.5e6
