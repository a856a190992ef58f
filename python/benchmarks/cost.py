"""What a run costs in Python beside the command line, and how much memory it takes.

    cargo build --release -p looselink-cli
    python python/benchmarks/cost.py

Case 4 for 3 s with a step of 1e-5 s. The processor time (user and system) of `looselink run`, of `scene.run(out=...)` and of
`scene.run()`, each in a process of its own whose imports are not counted, alternating; the median of five of each, and of the ratio to the
`looselink run` just before. Then the peak
memory of a run with 82 channels at every step, and of the arrays that it returns.
"""

import json
import os
import resource
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
SCENE = TOP / "scenes/3rrr/case4.toml"
REPEATS = 5
OVERRIDES = {"integrator.step": 1e-5, "simulation.duration": 3.0}


def used(who):
    usage = resource.getrusage(who)
    return usage.ru_utime + usage.ru_stime


def child():
    """Runs in a process of its own and prints what it took."""
    import looselink

    settings = json.loads(sys.argv[2])
    scene = looselink.load(SCENE)
    for path, value in settings["overrides"].items():
        scene.set(path, value)
    scene.copy().set("simulation.duration", 1e-3).run()
    memory, begun = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss, used(resource.RUSAGE_SELF)
    run = scene.run(out=settings["out"])
    took = used(resource.RUSAGE_SELF) - begun
    memory = (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - memory) * 1024
    arrays = sum(run[name].nbytes for name in run)
    print(json.dumps({"seconds": took, "memory": memory, "arrays": arrays, "channels": len(run), "rows": len(run.t)}))


def in_python(overrides, out=None):
    settings = json.dumps({"overrides": overrides, "out": out})
    done = subprocess.run(
        [sys.executable, "-W", "ignore", __file__, "child", settings], capture_output=True, text=True, check=True
    )
    return json.loads(done.stdout)


def command_line(out):
    program = os.environ.get("LOOSELINK_PROGRAM", TOP / "target/release/looselink")
    overrides = [part for path, value in OVERRIDES.items() for part in ("--set", f"{path}={value}")]
    before = used(resource.RUSAGE_CHILDREN)
    subprocess.run([program, "run", SCENE, *overrides, "--out", out, "--quiet"], stderr=subprocess.DEVNULL, check=True)
    return used(resource.RUSAGE_CHILDREN) - before


def names(count):
    """The first channels of the scene, with the time as many as this."""
    import looselink

    scene = looselink.load(SCENE).set("output.channels", ["*"]).set("simulation.duration", 1e-4)
    return scene.run().channels[1:count]


def main():
    series = {"looselink run": [], "scene.run(out=...)": [], "scene.run()": []}
    with tempfile.TemporaryDirectory() as folder:
        for k in range(REPEATS):
            series["looselink run"].append(command_line(f"{folder}/c{k}"))
            series["scene.run(out=...)"].append(in_python(OVERRIDES, f"{folder}/p{k}")["seconds"])
            series["scene.run()"].append(in_python(OVERRIDES)["seconds"])
    for name, times in series.items():
        ratio = statistics.median(time / beside for time, beside in zip(times, series["looselink run"]))
        print(f"{name:20} {statistics.median(times):6.2f} s, ratio {ratio:.3f} (from {min(times):.2f} to {max(times):.2f} s)")
    for motion in (False, True):
        overrides = OVERRIDES | {"output": {"interval": 1e-5, "channels": names(82), "motion": motion}}
        seen = in_python(overrides)
        kept = "with its motion" if motion else "without its motion"
        print(
            f"{seen['channels']} channels, {seen['rows']} rows, {kept}: {seen['memory'] / 1e6:.0f} MB more at the peak, "
            f"of which {seen['arrays'] / 1e6:.0f} MB are the arrays"
        )


if __name__ == "__main__":
    child() if sys.argv[1:2] == ["child"] else main()
