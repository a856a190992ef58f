"""Ctrl-C ends what takes long, and other threads go on meanwhile."""

import os
import signal
import threading
import time

import numpy as np
import pytest
from conftest import OSCILLATOR

import looselink


def test_ctrl_c_ends_modes_and_other_threads_go_on(oscillator):
    oscillator.set("simulation.duration", 1e5).set("output.interval", 1e5)
    counts = []

    def interrupt():
        for _ in range(50):
            counts.append(time.monotonic())
            time.sleep(0.01)
        os.kill(os.getpid(), signal.SIGINT)

    thread = threading.Thread(target=interrupt)
    thread.start()
    with pytest.raises(KeyboardInterrupt):
        oscillator.modes(at=1e5)
    assert time.monotonic() - counts[-1] < 5.0
    assert np.diff(counts).max() < 1.0
    thread.join()


def hanging(links):
    """A chain that starts in its equilibrium, which takes seconds to find."""
    bodies = {"ground": {"type": "ground", "points": {"B": [0.0, 0.0]}}}
    joints, start = {}, {}
    for k in range(links):
        bodies[f"link{k}"] = {"type": "rigid_body", "mass": 1.0, "inertia": 0.1, "points": {"A": [0.0, 0.0], "B": [1.0, 0.0]}}
        bearing = f"link{k - 1}.B" if k else "ground.B"
        joints[f"pin{k}"] = {"type": "revolute", "bearing": bearing, "journal": f"link{k}.A", "model": "ideal"}
        start[f"link{k}"] = {"x": float(k), "y": 0.0, "theta": 0.0}
    simulation = {"duration": 0.01, "gravity": [0.0, -9.81]}
    initial = {"bodies": start, "equilibrium": True}
    return OSCILLATOR | {"simulation": simulation, "bodies": bodies, "joints": joints, "forces": {}, "initial": initial}


@pytest.mark.parametrize("action", ["inspect", "modes", "run"])
def test_ctrl_c_ends_the_assembly(action, tmp_path):
    scene = looselink.load(hanging(250))
    sent = []

    def interrupt():
        time.sleep(0.3)
        sent.append(time.monotonic())
        os.kill(os.getpid(), signal.SIGINT)

    thread = threading.Thread(target=interrupt)
    thread.start()
    out = {"out": tmp_path / "out"} if action == "run" else {}
    with pytest.raises(KeyboardInterrupt):
        getattr(scene, action)(**out)
    assert time.monotonic() - sent[0] < 1.0
    thread.join()
    # nothing is left behind
    short = looselink.load(hanging(3))
    assert short.run(**out).status == "complete"
