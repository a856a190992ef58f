"""Sweeps: the tables of the command line, with threads of this process and with workers that die."""

import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

import looselink

TOP = Path(__file__).resolve().parents[2]
FILES = ["sweep.csv", "sweep.parquet", "sweep.json", "sweep.md", "sweep.svg", "sweep.png", "points.csv"]

STUDY = f"""
title = "many short runs"
scene = "{TOP}/scenes/slider-crank/loose.toml"
set = ["simulation.duration=0.002"]
parameters.clearance = {{ fields = ["contacts.pin.clearance"], from = 1e-4, to = 5e-4, count = 5, unit = "m" }}
parameters.restitution = {{ fields = ["contacts.pin.restitution"], values = [0.6, 1.5, 0.9] }}
starts = {{ count = 4, velocity = 1e-6 }}
measures.force = {{ of = "largest", channels = ["slider_pin.force"] }}
"""
RUNS = 60


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    path = tmp_path_factory.mktemp("study") / "study.toml"
    path.write_text(STUDY)
    return path


@pytest.fixture(scope="module")
def expected(study, program):
    """The bytes that the command line writes."""
    out = study.parent / "expected"
    program("sweep", study, "--out", out, "--quiet")
    return contents(out)


def contents(folder):
    return {name: (Path(folder) / name).read_bytes() for name in FILES}


def test_threads_write_the_bytes_of_the_command_line(study, expected, tmp_path):
    told = []
    result = looselink.sweep(study, out=tmp_path / "out", threads=2, progress=lambda done, left: told.append((done, left)))
    assert contents(tmp_path / "out") == expected
    assert told[-1] == (RUNS, 0)
    assert result.summary["status"] == {"complete": 40, "failed": 0, "refused": 20}
    frame = result.to_pandas()
    assert len(frame) == RUNS and frame["clearance [m]"][0] == 1e-4
    assert frame.attrs["units"]["force"] == "N"
    assert frame["fault"][4].startswith("`contacts.pin.restitution`")
    table = result.to_polars()
    assert table["force"].to_list()[:4] == frame["force [N]"].to_list()[:4]
    assert "## " not in result.page and "Runs without results" in result.page
    assert result._repr_svg_().startswith("<svg")


def test_a_scene_with_its_changes_is_swept():
    scene = looselink.load(TOP / "scenes/pendulum.toml").set("simulation.duration", 0.1)
    result = scene.sweep(
        parameters={"gravity": {"fields": ["simulation.gravity.1"], "values": [-9.81, -1.62], "unit": "m/s2"}},
        measures={"kinetic": {"of": "largest", "channels": ["energy.kinetic"]}},
    )
    frame = result.to_pandas()
    assert list(frame["t [s]"]) == [0.1, 0.1]
    assert frame["kinetic [J]"][0] > frame["kinetic [J]"][1] > 0.0
    one = scene.set("output.channels", ["energy.kinetic"]).run()
    assert one["energy.kinetic"].max() == frame["kinetic [J]"][0]


def test_a_target_is_found():
    scene = looselink.load(TOP / "scenes/pendulum.toml").set("simulation.duration", 0.1)
    result = scene.sweep(
        parameters={"gravity": {"fields": ["simulation.gravity.1"], "from": -20.0, "to": -1.0}},
        measures={"kinetic": {"of": "last", "channels": ["energy.kinetic"]}},
        target=("kinetic", 0.01),
    )
    low, high = result.summary["crossing"]["means"]
    assert low > 0.01 > high


def test_faults_are_those_of_the_command_line(study, program, tmp_path):
    bad = study.parent / "bad.toml"
    bad.write_text(STUDY.replace("starts", "start"))
    with pytest.raises(looselink.StudyError) as error:
        looselink.sweep(bad, out=tmp_path)
    text = program("sweep", bad, "--out", tmp_path, expect=2)
    assert str(error.value) == text.removeprefix("error: ").strip()
    bad.write_text(STUDY.replace("loose.toml", "losse.toml"))
    with pytest.raises(looselink.SceneError, match="did you mean"):
        looselink.sweep(bad, out=tmp_path)
    spring = looselink.load(TOP / "scenes/pendulum.toml")
    spring.add_load("push", "rod.end", lambda t, x, y, vx, vy: (0.0, 0.0))
    with pytest.raises(ValueError, match="callables cannot be swept"):
        spring.sweep(parameters={}, measures={})


INTERRUPTED = """
import sys, looselink
looselink.sweep(sys.argv[1], out=sys.argv[2], threads=1)
"""


def test_an_interrupted_sweep_goes_on(study, expected, tmp_path):
    out = tmp_path / "out"
    child = subprocess.Popen([sys.executable, "-P", "-c", INTERRUPTED, study, out], stderr=subprocess.PIPE, text=True)
    rows = out / "runs.jsonl"
    deadline = time.monotonic() + 60
    while not (rows.exists() and rows.read_bytes().count(b"\n") > 3):
        assert time.monotonic() < deadline and child.poll() is None
        time.sleep(0.002)
    child.send_signal(signal.SIGINT)
    assert "KeyboardInterrupt" in child.communicate(timeout=60)[1]
    made = rows.read_bytes().count(b"\n") - 1
    assert 0 < made < RUNS
    looselink.sweep(study, out=out)
    assert contents(out) == expected


def test_workers_that_die_make_the_same_table(study, expected, tmp_path):
    import dask
    import distributed

    # a worker may be lost several times before its task is given up

    with dask.config.set({"distributed.scheduler.allowed-failures": 20}):
        with distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None, silence_logs=50
        ) as cluster, distributed.Client(cluster) as client:
            killed = []

            def kill(done, left):
                # two of the workers of the cluster, which starts others
                if done in (10, 30):
                    pids = list(client.run(os.getpid).values())
                    os.kill(pids[0], signal.SIGKILL)
                    killed.append(pids[0])

            result = looselink.sweep(study, client, out=tmp_path / "out", batch=2, progress=kill)
            assert len(killed) == 2
            assert contents(tmp_path / "out") == expected
            # a bisection, one point after the other, with tasks of a length that follows the runs
            gravity = {"fields": ["simulation.gravity.1"], "from": -20.0, "to": -1.0}
            scene = looselink.load(TOP / "scenes/pendulum.toml").set("simulation.duration", 0.02)
            study_of = dict(parameters={"g": gravity}, measures={"v": {"of": "last", "channels": ["energy.kinetic"]}})
            target = ("v", 4e-4)
            found = scene.sweep(client, target=target, **study_of)
            alone = scene.sweep(target=target, **study_of)
            assert contents_of(found) == contents_of(alone)
            assert result.summary["runs"] == RUNS

            def stop(done, left):
                raise LookupError("enough")

            with pytest.raises(LookupError):
                looselink.sweep(study, client, out=tmp_path / "stopped", batch=1, progress=stop)
            deadline = time.monotonic() + 20
            while client.run_on_scheduler(open_tasks):
                assert time.monotonic() < deadline
                time.sleep(0.05)


def open_tasks(dask_scheduler):
    return sum(task.state not in ("memory", "released", "forgotten") for task in dask_scheduler.tasks.values())


def test_what_is_no_client_or_another_version_is_refused(study):
    with pytest.raises(TypeError, match="tables of a study are keyword arguments"):
        looselink.load(TOP / "scenes/pendulum.toml").sweep({"parameters": {}})
    with pytest.raises(RuntimeError, match="install the same"):
        looselink._looselink._make_tasks("0.0.0", "", [])
    with pytest.raises(Exception, match="nowhere"):
        # refused before the runs are made
        looselink.sweep(study, copy_to="nowhere://bucket", progress=lambda done, left: pytest.fail("a run was made"))


def test_a_sweep_warns_of_runs_without_results(study):
    with pytest.warns(looselink.RunWarning, match="60 runs, 20 refused"):
        result = looselink.sweep(study)
    assert "60 runs, 20 refused" in repr(result)


def contents_of(result):
    return {file.name: file.read_bytes() for file in result.folder.iterdir() if file.suffix in (".csv", ".json") and file.name != "times.csv"}


def test_a_sweep_that_was_broken_off_goes_on_in_the_same_process(study, expected, tmp_path):
    def stop(done, left):
        if done >= 5:
            raise LookupError("enough")

    with pytest.raises(LookupError) as kept:
        looselink.sweep(study, out=tmp_path, threads=1, progress=stop)
    looselink.sweep(study, out=tmp_path)
    assert contents(tmp_path) == expected and kept.value.args == ("enough",)
    with pytest.raises(ValueError, match="batch must be 1"):
        looselink.sweep(study, out=tmp_path, batch=0)


def test_results_are_copied_to_any_place_that_pyarrow_reaches(study, tmp_path):
    pytest.importorskip("pyarrow")
    looselink.sweep(study, out=tmp_path / "out", copy_to=f"file://{tmp_path}/elsewhere/results")
    copied = contents(tmp_path / "elsewhere/results")
    assert copied == contents(tmp_path / "out")


def test_other_threads_go_on_meanwhile(study):
    count, stop = 0, threading.Event()

    def turn():
        nonlocal count
        while not stop.is_set():
            count += 1
            time.sleep(0.001)

    other = threading.Thread(target=turn)
    other.start()
    looselink.sweep(study, threads=1)
    stop.set()
    other.join()
    assert count > 20


def test_progress_of_a_sweep_is_not_called_again_once_it_has_raised(oscillator):
    calls = []

    def show(done, left):
        calls.append((done, left))
        raise ZeroDivisionError

    stiffness = {"fields": ["forces.spring.stiffness"], "values": [100.0 + k for k in range(20)], "unit": "N/m"}
    with pytest.raises(ZeroDivisionError):
        oscillator.sweep(
            parameters={"k": stiffness}, measures={"x": {"of": "largest", "channels": ["mass.x"]}}, threads=2, progress=show
        )
    assert len(calls) == 1
