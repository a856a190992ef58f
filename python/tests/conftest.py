"""Where the tests find scenes and the command line."""

import os
import subprocess
import warnings
from pathlib import Path

import pytest

import looselink

TOP = Path(__file__).resolve().parents[2]

# A scene without contacts, whose run takes a millisecond.
OSCILLATOR = {
    "format": 1,
    "title": "a mass on a spring",
    "simulation": {"duration": 0.2},
    "integrator": {"method": "trapezoidal", "step": 1e-3, "newton_tolerance": 1e-10},
    "output": {"interval": 1e-2, "channels": ["*"]},
    "bodies": {
        "ground": {"type": "ground", "points": {"wall": [0.0, 0.0]}},
        "mass": {"type": "rigid_body", "mass": 2.0, "inertia": 0.1, "points": {"pin": [0.1, 0.0]}},
    },
    "forces": {
        "spring": {
            "type": "spring_damper",
            "from": "ground.wall",
            "to": "mass.pin",
            "stiffness": 300.0,
            "damping": 0.5,
            "rest_length": 0.4,
        },
    },
    "initial": {"bodies": {"mass": {"x": 0.5, "y": 0.2, "theta": 0.3, "vx": 0.0, "vy": 0.1, "omega": 2.0}}},
}


@pytest.fixture
def oscillator():
    return looselink.load(OSCILLATOR)


@pytest.fixture
def case3():
    """The first impacts of the 3-RRR mechanism."""
    scene = looselink.load(TOP / "scenes/3rrr/case3.toml")
    return scene.set("simulation.duration", 0.006)


@pytest.fixture(autouse=True)
def quiet():
    """Tests of warnings ask for them."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", looselink.RunWarning)
        yield


@pytest.fixture(scope="session")
def program():
    """Calls the command line in the folder of the sources; returns what it wrote to one of its streams."""
    places = [TOP / "target/debug/looselink", TOP / "target/release/looselink"]
    path = os.environ.get("LOOSELINK_PROGRAM") or next(str(place) for place in places if place.exists())

    def call(*arguments, expect=0, stream="stderr"):
        done = subprocess.run([path, *map(str, arguments)], cwd=TOP, capture_output=True, text=True)
        assert done.returncode == expect, done.stderr
        return getattr(done, stream)

    return call
