"""Tables of sweeps in other languages. The scripts for MATLAB and Julia are not run."""

import shutil
import subprocess

import pytest
from conftest import TOP

import looselink

EXAMPLES = TOP / "examples"


def test_octave_reads_the_table_of_a_sweep(tmp_path):
    assert shutil.which("octave-cli"), "install GNU Octave"
    play = {"fields": ["contacts.pin.clearance"], "values": [1e-4, 2e-4, 4e-4], "unit": "m"}
    scene = looselink.load(TOP / "scenes/slider-crank/loose.toml").set("simulation.duration", 0.004)
    restitution = {"fields": ["contacts.pin.restitution"], "values": [0.6, 1.5, 0.9]}
    result = scene.sweep(
        parameters={"play": play, "restitution": restitution},
        measures={"force": {"of": "largest", "channels": ["slider_pin.force"]}},
        out=tmp_path / "play",
    )
    script = f"folder = '{result.folder}'; source {EXAMPLES}/read_sweep_octave.m"
    printed = subprocess.run(["octave-cli", "--eval", script], check=True, capture_output=True, text=True).stdout
    means = result.to_pandas().groupby("play [m]")["force [N]"].mean()
    assert printed.splitlines() == [f"{play:g} m: {force:.6g} N" for play, force in means.items()]
    assert means.gt(1.0).all()


@pytest.mark.parametrize("script", sorted(EXAMPLES.glob("read_*")), ids=lambda script: script.name)
def test_scripts_are_short_and_say_whether_they_are_tested(script):
    lines = script.read_text("utf-8").splitlines()
    assert len(lines) <= 10
    assert ("not tested" in lines[0]) == ("octave" not in script.name)
