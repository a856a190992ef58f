"""Work-precision curves of Exudyn with the studied mechanisms.

    measure.py --out FILE.json [--repeats 3] [--only case3] [--looselink PROGRAM]

It needs Python 3.11, `pip install exudyn==1.13.6 numpy`, and about two minutes with three repeats.

Every curve is a method with a list of steps or tolerances. The first run of a point records the studied positions. Its
error is the largest difference from Exudyn's own reference, over all recorded times and coordinates. Then `--repeats`
runs without sensors are timed. The time is the processor time of the solver, without building and assembling the model.

The reference is the finer one of two runs, and `floor` is the largest difference between them: smaller errors have no
meaning. With `--looselink` the reference is also compared with the finest run of Looselink that the study names.
"""

import argparse
import csv
import json
import subprocess
import tempfile

import numpy as np

import rrr
import slider_crank
from mechanism import EXPLICIT, ROOT, Failed, exu, item, read_study, settings, solve

# Methods for loose joints. "contacts located": steps are cut where a contact closes or opens.
STEPS = [1e-4, 5e-5, 2e-5, 1e-5, 5e-6, 2e-6, 1e-6, 5e-7, 2.5e-7]
TOLERANCES = [1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11]
ALPHA = {"solver": "GeneralizedAlpha"}
ROUGHLY = {"cut": True, "contact": 100.0}
LOOSE = [
    ("Dormand-Prince, error controlled, contacts located", {"solver": "DOPRI5", "cut": True}, TOLERANCES),
    ("Dormand-Prince, error controlled, contacts located roughly", {"solver": "DOPRI5", **ROUGHLY}, TOLERANCES),
    ("ODE23, error controlled, contacts located", {"solver": "ODE23", "cut": True}, TOLERANCES[:8]),
    ("RK67, contacts located", {"solver": "RK67", "cut": True}, STEPS),
    ("RK44, contacts located", {"solver": "RK44", "cut": True}, STEPS),
    ("RK44", {"solver": "RK44"}, STEPS),
    ("explicit midpoint, contacts located", {"solver": "ExplicitMidpoint", "cut": True}, STEPS),
    ("velocity Verlet, contacts located", {"solver": "VelocityVerlet", "cut": True}, STEPS),
    ("velocity Verlet", {"solver": "VelocityVerlet"}, STEPS),
    ("generalised-alpha 0.9", {**ALPHA, "spectral_radius": 0.9, "newton": 1e-3}, STEPS),
    ("generalised-alpha 0.8", {**ALPHA, "spectral_radius": 0.8, "newton": 1e-3}, STEPS),
    ("generalised-alpha 0.6", {**ALPHA, "spectral_radius": 0.6, "newton": 1e-3}, STEPS),
    ("generalised-alpha 0.8, contacts located roughly", {**ALPHA, "spectral_radius": 0.8, **ROUGHLY}, STEPS),
    ("trapezoidal, index 2", {"solver": "TrapezoidalIndex2", "newton": 1e-3}, STEPS),
]
LOOSE_REFERENCE = [
    {"solver": "DOPRI5", "cut": True, "contact": 0.01, "tolerance": 1e-12},
    {"solver": "RK67", "cut": True, "contact": 0.01, "step": 2e-7},
]

# Explicit methods of Exudyn do not take ideal joints.
IDEAL_STEPS = [5e-4, 2.5e-4, 1e-4, 5e-5, 2e-5, 1e-5, 5e-6, 2e-6, 1e-6]


def ideal(steps=IDEAL_STEPS, **options):
    """Return the curves for ideal joints."""
    methods = [(f"generalised-alpha {rho}", {**ALPHA, "spectral_radius": rho}) for rho in [0.9, 0.8, 0.6]]
    methods.append(("trapezoidal, index 2", {"solver": "TrapezoidalIndex2"}))
    return [(label, {**method, "newton": 1e-2, **options}, steps) for label, method in methods]


def ideal_reference(*steps, **options):
    """Return the two runs of the reference for ideal joints."""
    return [{"solver": "TrapezoidalIndex2", "newton": 1e-6, "step": step, **options} for step in steps]


# the study, its curves, and the two runs of its reference
MODELS = [
    ("case2", ideal(), ideal_reference(2e-7, 1e-7)),
    ("case2-16elements", ideal(sparse=True), ideal_reference(4e-7, 2e-7, sparse=True)),
    ("case2-64elements", ideal(IDEAL_STEPS[:7], sparse=True), ideal_reference(2e-6, 1e-6, sparse=True)),
    ("case3", LOOSE, LOOSE_REFERENCE),
    ("case4", LOOSE, LOOSE_REFERENCE),
    ("slider-crank", LOOSE, LOOSE_REFERENCE),
]


class Model:
    """A study and the mechanism of its scene."""

    def __init__(self, name):
        self.name = name
        self.study, self.scene = read_study(name)
        self.module = slider_crank if name == "slider-crank" else rrr
        self.times = np.arange(round(self.study["duration"] / self.study["interval"]) + 1) * self.study["interval"]

    def build(self, method):
        """Return the parts of a new system for a method."""
        return self.module.build(self.study, self.scene, force_driven=method["solver"] in EXPLICIT)

    def run(self, method):
        """Run without recording and return the processor time in seconds."""
        container, system, *_ = self.build(method)
        system.Assemble()
        return solve(system, settings(self.study, method), method)

    def positions(self, method):
        """Run and return the studied positions, one row for each time."""
        container, system, nodes, origin = self.build(method)
        kinds = exu.OutputVariableType
        sensors = [
            [
                system.AddSensor(
                    item.SensorNode(nodeNumber=node, storeInternal=True, writeToFile=False, outputVariableType=kind)
                )
                for node in nodes
            ]
            for kind in [kinds.Coordinates, kinds.Coordinates_t, kinds.Coordinates_tt]
        ]
        system.Assemble()
        run_settings = settings(self.study, method)
        run_settings.solution.sensors.active = True
        own_steps = "tolerance" in method or method.get("cut", False)
        run_settings.solution.sensors.writePeriod = 1e-15 if own_steps else self.study["interval"]
        run_settings.timeIntegration.explicit.computeEndOfStepAccelerations = True
        solve(system, run_settings, method)
        tables = [np.mean([system.GetSensorStoredData(sensor) for sensor in kind], axis=0) for kind in sensors]
        if own_steps:
            values = hermite(self.times, tables[0][:, 0], *[table[:, 1:] for table in tables])
        else:
            assert len(tables[0]) == len(self.times) and np.abs(tables[0][:, 0] - self.times).max() < 1e-12
            values = tables[0][:, 1:]
        if not np.all(np.isfinite(values)):
            raise Failed("the motion is not finite")
        # the studied positions: those of the platform less its path, or the place of the slider
        if self.module is rrr:
            start = np.array([origin(0.0)])
            return values[:, :2] + start - origin(self.times).T
        return values + origin


def hermite(times, t, x, v, a):
    """Interpolate by the quintic polynomials that agree with places, velocities and accelerations."""
    k = np.clip(np.searchsorted(t, times, side="right") - 1, 0, len(t) - 2)
    h = (t[k + 1] - t[k])[:, None]
    s = (times - t[k])[:, None] / h
    d = x[k + 1] - x[k] - h * v[k] - 0.5 * h * h * a[k]
    e = h * (v[k + 1] - v[k] - h * a[k])
    f = h * h * (a[k + 1] - a[k])
    cubic = 10.0 * d - 4.0 * e + 0.5 * f
    quartic = -15.0 * d + 7.0 * e - f
    quintic = 6.0 * d - 3.0 * e + 0.5 * f
    return x[k] + s * (h * v[k] + s * (0.5 * h * h * a[k] + s * (cubic + s * (quartic + s * quintic))))


def looselink(program, model):
    """Return the studied positions of the finest run that the study names for its reference."""
    study = model.study
    reference = study["reference"]
    changes = [
        *study.get("set", []),
        *reference["set"],
        f"integrator.step={min(reference['steps'])}",
        f"simulation.duration={study['duration']}",
        f"output.interval={study['interval']}",
        f"output.channels={json.dumps(study['position'])}",
    ]
    scene = (ROOT / "studies" / study["scene"]).resolve()
    with tempfile.TemporaryDirectory() as folder:
        command = [program, "run", scene, "--quiet", "--out", f"{folder}/run"]
        for change in changes:
            command += ["--set", change]
        subprocess.run(command, check=True)
        with open(f"{folder}/run/channels.csv", newline="") as file:
            rows = list(csv.reader(file))
    columns = [[name.split(" [")[0] for name in rows[0]].index(channel) for channel in study["position"]]
    return np.array([[float(row[column]) for column in columns] for row in rows[1:]])


def measure_point(model, method, reference, repeats):
    """Return the point of a curve: its step or tolerance, error and times."""
    key = "tolerance" if "tolerance" in method else "step"
    point = {key: method[key], "error": None, "seconds": [], "failed": None}
    try:
        point["error"] = float(np.abs(model.positions(method) - reference).max())
        point["seconds"] = [model.run(method) for _ in range(repeats)]
    except Failed as failure:
        point["failed"] = str(failure)
    return point


def measure_model(name, curves, reference_methods, repeats, program):
    """Return all curves of a model."""
    model = Model(name)
    coarse, fine = [model.positions(method) for method in reference_methods]
    options = dict(reference_methods[1])
    label = options.pop("solver")
    result = {
        "name": name,
        "duration": model.study["duration"],
        "interval": model.study["interval"],
        "channels": model.study["position"],
        "reference": {"method": label, **options, "floor": float(np.abs(fine - coarse).max())},
        "difference_from_looselink": None,
        "curves": [],
    }
    if program:
        result["difference_from_looselink"] = float(np.abs(fine - looselink(program, model)).max())
    for label, method, values in curves:
        key = "tolerance" if method["solver"] in {"DOPRI5", "ODE23"} else "step"
        points = [measure_point(model, {**method, key: value}, fine, repeats) for value in values]
        result["curves"].append({"solver": label, "points": points})
    return result


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", required=True, help="the JSON file that is written")
    parser.add_argument("--repeats", type=int, default=3, help="timed runs of every point")
    parser.add_argument("--only", choices=[name for name, *_ in MODELS], help="measure this model only")
    parser.add_argument("--looselink", metavar="PROGRAM", help="compare the references with this program")
    arguments = parser.parse_args()
    models = [
        measure_model(*model, arguments.repeats, arguments.looselink)
        for model in MODELS
        if arguments.only in (None, model[0])
    ]
    with open(arguments.out, "w") as file:
        json.dump({"exudyn": exu.config.Version(), "models": models}, file, indent=1)
        file.write("\n")


if __name__ == "__main__":
    main()
