"""Elastodynamics of planar mechanisms with flexible links and joint clearance.

>>> import looselink
>>> run = looselink.load("scenes/pendulum.toml").run()
>>> run.t, run["points.rod.pivot.x"]

`load` and `loads` read a `Scene`; `Scene.set` changes it and `Scene.run` simulates it; a `Run` maps names of channels to NumPy
arrays. `sweep` runs a scene at many values of its fields. All quantities are in SI units.
"""

from . import _looselink
from ._looselink import (
    Run,
    RunError,
    RunWarning,
    Scene,
    SceneError,
    StudyError,
    View,
    __version__,
    load,
    loads,
)
from .sweeps import SweepResult, sweep

_looselink._program_is(_looselink.__file__)

__all__ = [
    "Run",
    "RunError",
    "RunWarning",
    "Scene",
    "SceneError",
    "StudyError",
    "SweepResult",
    "View",
    "__version__",
    "load",
    "loads",
    "sweep",
]
