"""The stubs agree with the module, and programs are checked by them."""

import subprocess
import sys

PROGRAM = """
import numpy as np
import looselink

scene: looselink.Scene = looselink.load("scene.toml").set("integrator.step", 1e-5).add_load("a", "b.c", lambda t, x, y, vx, vy: (x, y))
run: looselink.Run = scene.run(progress=lambda t, duration: None, out="out")
largest: np.float64 = np.abs(run["error.x"]).max()
names: list[str] = [name for name in run] + list(run.select("error.*"))
velocities = run.onsets["impact_velocity"][run.onsets["joint"] == "B1"]
run.view(height=400).save("view.html")
try:
    scene.run()
except looselink.RunError as error:
    rows: int = len(error.run.t)
"""


def test_the_stubs_are_those_of_the_module():
    subprocess.run([sys.executable, "-m", "mypy.stubtest", "looselink"], check=True)


def test_a_program_is_checked(tmp_path):
    def check(text):
        file = tmp_path / "program.py"
        file.write_text(text, "utf-8")
        return subprocess.run([sys.executable, "-m", "mypy", "--strict", file], cwd=tmp_path, capture_output=True, text=True)

    good = check(PROGRAM)
    assert good.returncode == 0, good.stdout
    assert 'has no attribute "runn"' in check(PROGRAM + "scene.runn()\n").stdout
