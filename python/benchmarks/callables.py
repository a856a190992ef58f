"""What callables cost: microseconds a call, and a run beside the same load written in TOML.

    python python/benchmarks/callables.py
"""

import resource
import statistics
import warnings

import looselink

REPEATS = 5
SCENE = {
    "format": 1,
    "title": "a mass on a spring that is pushed",
    "simulation": {"duration": 20.0},
    "integrator": {"method": "trapezoidal", "step": 1e-3, "newton_tolerance": 1e-10},
    "output": {"interval": 1e-2, "channels": ["mass.*"]},
    "bodies": {
        "ground": {"type": "ground", "points": {"wall": [0.0, 0.0]}},
        "mass": {"type": "rigid_body", "mass": 2.0, "inertia": 0.1, "points": {"pin": [0.1, 0.0]}},
    },
    "initial": {"bodies": {"mass": {"x": 0.5, "y": 0.2, "theta": 0.3}}},
}
SPRING = {"type": "spring_damper", "from": "ground.wall", "to": "mass.pin", "stiffness": 300.0, "damping": 0.5, "rest_length": 0.0}


def pushed(x):
    push = {"type": "force", "point": "mass.pin", "x": x, "y": 0.0, "frame": "ground"}
    return looselink.load(SCENE | {"forces": {"spring": SPRING, "push": push}})


def pull(t, x, y, vx, vy):
    return -300.0 * x - 0.5 * vx, -300.0 * y - 0.5 * vy


def tangent(t, x, y, vx, vy):
    return [[-300.0, 0.0, -0.5, 0.0], [0.0, -300.0, 0.0, -0.5]]


class Counted:
    """Counts the calls of a function."""

    def __init__(self, function):
        self.function, self.calls = function, 0

    def __call__(self, *arguments):
        self.calls += 1
        return self.function(*arguments)


def seconds(scene):
    def once():
        begun = resource.getrusage(resource.RUSAGE_SELF)
        scene.run()
        ended = resource.getrusage(resource.RUSAGE_SELF)
        return ended.ru_utime + ended.ru_stime - begun.ru_utime - begun.ru_stime

    return statistics.median(once() for _ in range(REPEATS))


def compare(name, toml, scene_of, *functions):
    counted = [Counted(function) for function in functions]
    scene_of(*counted).run()
    calls = sum(function.calls for function in counted)
    written, called = seconds(toml), seconds(scene_of(*functions))
    each = 1e6 * (called - written) / calls
    print(f"{name:38} {calls:7} calls, {each:.2f} µs a call; the run takes {called / written:.1f} times as long ({written:.3f} s in TOML)")


def main():
    warnings.simplefilter("ignore", looselink.RunWarning)
    compare("a function of time", pushed("5 * t"), pushed, lambda t: 5.0 * t)
    spring = looselink.load(SCENE | {"forces": {"spring": SPRING}})
    free = looselink.load(SCENE)
    compare("a load, its derivatives differenced", spring, lambda f: free.copy().add_load("spring", "mass.pin", f), pull)
    compare("a load with its tangent", spring, lambda f, g: free.copy().add_load("spring", "mass.pin", f, tangent=g), pull, tangent)


if __name__ == "__main__":
    main()
