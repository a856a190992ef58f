"""What the checks share: scenes as text, runs of the driver, and the count of what is wrong."""
import csv
import pathlib
import subprocess
import tempfile

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
DRIVER = HERE.parent / "build/reference"
SPACE = tempfile.TemporaryDirectory()
FOLDER = pathlib.Path(SPACE.name)
TIGHT = ["--relative", "1e-11", "--position", "1e-12", "--velocity", "1e-10"]
failures = 0


def scene(duration, interval, body, gravity=(0.0, 0.0), clearance=False, analysis="dynamic"):
    onset = ", onset_tolerance = 1e-12" if clearance else ""
    return (f'format = 1\ntitle = "check"\n'
            f'simulation = {{ duration = {duration}, gravity = {list(gravity)}, analysis = "{analysis}" }}\n'
            f'integrator = {{ method = "bathe", step = {interval}, newton_tolerance = 1e-10{onset} }}\n'
            f'output = {{ interval = {interval}, channels = ["*"] }}\n{body}')


def path_of(name, text):
    path = FOLDER / f"{name}.toml"
    path.write_text(text)
    return path


def run(name, text, options=()):
    """Channels as arrays by name, and the onsets as a list of dictionaries."""
    out, onsets = FOLDER / "out.csv", FOLDER / "onsets.csv"
    result = subprocess.run([DRIVER, path_of(name, text), "--out", out, "--onsets", onsets, "--all", *TIGHT, *options],
                            capture_output=True, text=True)
    if result.returncode:
        raise RuntimeError(name + ": " + result.stderr)
    with open(out) as file:
        names = file.readline().strip().split(",")
        rows = np.loadtxt(file, delimiter=",", ndmin=2)
    with open(onsets) as file:
        events = [{k: v if k == "joint" else float(v) for k, v in row.items()} for row in csv.DictReader(file)]
    return dict(zip(names, rows.T)), events


def judge(good, what):
    global failures
    failures += not good
    print(f"{'ok    ' if good else 'WRONG '} {what}")


def expect(what, deviation, limit):
    deviation = float(np.max(np.abs(deviation)))
    judge(deviation <= limit, f"{what}: {deviation:.1e} (at most {limit:.0e})")


def refused(arguments, expected, what=""):
    """The driver must refuse, with a message that contains `expected`."""
    result = subprocess.run([DRIVER, *arguments, "--start"], capture_output=True, text=True)
    message = result.stderr.strip().replace(tempfile.gettempdir() + "/", "").replace(FOLDER.name + "/", "")
    judge(result.returncode == 1 and expected in message, f"{what}{message or 'accepted'}")
