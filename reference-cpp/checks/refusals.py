#!/usr/bin/env python3
"""Scenes that must be refused, with a part of the message that must name the place: python3 checks/refusals.py"""
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
DRIVER = ROOT / "reference-cpp/build/reference"

# scene, text to replace, replacement, what the message must contain
EDITS = [
    ("pendulum", "inertia = 0.1875", "inertias = 0.1875", "inertia"),
    ("pendulum", "inertia = 0.1875", "inertia = 0.1875\ninertias = 1", ":inertias"),
    ("pendulum", "mass = 1.0", 'mass = "1.0"', "must be a number, not a string"),
    ("pendulum", "mass = 1.0", "mass = -1.0", "must be positive"),
    ("pendulum", "mass = 1.0", "mass = inf", "must be finite"),
    ("pendulum", "mass = 1.0", "mass = 1.0.0", ""),
    ("pendulum", "format = 1", "format = 2", "format"),
    ("pendulum", "[bodies.ground]", "[bodies.ground2]\ntype = \"ground\"\n[bodies.ground]", "exactly one"),
    ("pendulum", "[bodies.ground]", "[whatever]\na = 1\n[bodies.ground]", "whatever"),
    ("pendulum", 'journal = "rod.pivot"', 'journal = "rod.pivo"', "no point `pivo`"),
    ("pendulum", 'journal = "rod.pivot"', 'journal = "stick.pivot"', "no body `stick`"),
    ("pendulum", 'journal = "rod.pivot"', 'journal = "ground.origin"', "same body"),
    ("pendulum", "joints.pivot", "joints.rod", "another body, joint or force"),
    ("pendulum", "joints.pivot", "joints.energy", "reserved"),
    ("pendulum", '"points.*"', '"pionts.*"', "matches no channel"),
    ("pendulum", "theta = 3.141592653589793", "theta = 3.1", "pivot."),
    ("pendulum", "theta = 3.141592653589793", "theta = 3.141592653589793, vx = 0.0", "`vy` is missing"),
    ("pendulum", "interval = 1e-2", "interval = 1.00005e-2", "whole multiple"),
    ("pendulum", "newton_tolerance = 1e-11", "", "newton_tolerance"),
    ("pendulum", "duration = 10.0", "duration = 10.0\nanalysis = \"modal\"", "none of"),
    ("bouncing-journal", "onset_tolerance = 1e-13", "", "onset_tolerance"),
    ("bouncing-journal", "onset_tolerance = 1e-13", "onset_tolerance = 1e-3", "below every clearance"),
    ("bouncing-journal", "poissons_ratio = 0.33", "", "needs youngs_modulus and poissons_ratio"),
    ("bouncing-journal", 'law = "lankarani_nikravesh"', 'law = "hertz"', "must be 1 with Hertz's law"),
    ("bouncing-journal", "restitution = 0.9", "restitution = -0.1", "must not be negative"),
    ("bouncing-journal", "restitution = 0.9", "restitution = 1.1", "at most 1"),
    ("bouncing-journal", "x = 0.0, y = 0.0", "x = 0.0, y = 0.001", "outside its bearing"),
    ("double-pendulum-flexible", "elements = 4", "elements = 4\npoints.middle = 0.3", "not at a node"),
    ("double-pendulum-flexible", "elements = 4", "elements = 2.5", "must be an integer"),
    ("double-pendulum-flexible", "youngs_modulus = 70e9", "", "needs its youngs_modulus"),
    ("pendulum", "{ x = -0.75", '{ point = "tip", x = -0.75', "no point `tip`"),
    ("pendulum", "{ x = -0.75", '{ point = "pivot", x = -0.75', "pivot."),
    ("pendulum", "{ x = -0.75", "{ strain = 1e-3, x = -0.75", "`strain` has no meaning"),
    ("pendulum", "{ x = -0.75", "{ bending_rate = 0.0, x = -0.75", "`bending_rate` has no meaning"),
    ("double-pendulum-flexible", "{ x = 0.25", "{ strain = -0.5, x = 0.25", "above -0.5"),
    ("double-pendulum-flexible", "{ x = 0.25", "{ strain = 1.1, x = 0.25", "at most 1"),
    ("double-pendulum-flexible", "{ x = 0.25", "{ strain = 1e-3, x = 0.25", "violate"),
    ("double-pendulum-flexible", "{ x = 0.25", "{ bending_rate = 1.0, x = 0.25", "velocities violate"),
    ("double-pendulum-flexible", "bodies.upper = { x", "velocities.lower = { omega = 1.0 }\nbodies.upper = { strain = 1e-3, x", "cannot be assembled"),
    ("double-pendulum-flexible", "bodies.upper = { x", "sketch.knee = [0.5, 0.0]\nbodies.upper = { bending_rate = 1.0, x", "cannot be assembled"),
    ("double-pendulum-flexible", "{ x = 0.25, y = 0.0, theta = 0.0 }\nbodies.lower = { x = 0.75, y = 0.0, theta = 0.0 }",
     "{ x = 0.25, y = 0.0, theta = 0.0, strain = 1e-3 }", "cannot be assembled"),
    ("three-spring", "bodies.node2 = { x", 'bodies.node2 = { point = "center", x', "`point` has no meaning"),
    ("andrews-squeezer", "H = [-0.0315, -0.0155]", "H = [-0.04, -0.0155]", "from its sketch"),
    ("andrews-squeezer", "G = [-0.034, 0.0165], ", "", "K4"),
    ("andrews-squeezer", "sketch = {", "velocities = { K1 = { omega = 1.0 }, K2 = { omega = 1.0 } }\nsketch = {", "velocit"),
    ("n-four-bar", "velocities.coupler1 = { vx = 1.0 }", "velocities.coupler1 = { vx = 1.0 }\nvelocities.coupler2 = { vx = 1.0 }",
     "determine this velocity already"),
    ("n-four-bar", "velocities.coupler1 = { vx = 1.0 }", "velocities.coupler1 = { vx = 1.0 }\nvelocities.coupler2 = { vx = 2.0 }",
     "contradicts"),
    ("n-four-bar", "sketch.B0 = [0.0, 1.0]\nsketch.B1 = [1.0, 1.0]\nsketch.B2 = [2.0, 1.0]\nvelocities.coupler1 = { vx = 1.0 }",
     "sketch.B0 = [1.0, 0.0]\nsketch.B1 = [2.0, 0.0]\nsketch.B2 = [3.0, 0.0]", "singular"),
    ("quick-return", "[joints.guide]", "[drives.other]\ntype = \"angle\"\njoint = \"motor\"\nangle = 0.0\n[joints.guide]", "at most one drive"),
    ("ramped-cantilever", "[10.0, -500.0]", "[9.0, -500.0]", "reach the duration"),
    ("ramped-cantilever", "[2.001, -500.0]", "[1.0, -500.0]", "must increase"),
    ("3rrr/case1", "radius = 0.1,", "radius = 0.3,", "cannot be closed"),
    ("3rrr/case1", '"contacts.pin.restitution" =', '"contacts.pin.restitutio" =', "no field"),
    ("3rrr/case1", 'joints = ["A1", "A2", "A3"]', 'joints = ["A1", "A2", "B3"]', "chain of actuated joints"),
]
OVERRIDES = [
    ("pendulum", "bodies.rod.mas=2", "mas"),
    ("pendulum", "bodies.rod.mass", "path.of.a.key=value"),
    ("pendulum", "bodies.rod.mass=", "override"),
    ("pendulum", "bodies.rod.mass.x=1", "not a table"),
    ("pendulum", "simulation.gravity=[1]", "2 numbers"),
    ("bouncing-journal", 'contacts.aluminium={ law = "flores", bearing_radius = 0.01, clearance = 2e-5, stiffness = 1e10, exponent = 1.5, '
     "restitution = 0, impact_velocity_floor = 1e-6 }", "above 0"),
    ("ramped-cantilever", 'forces.tip.y={ type = "piecewise", rows = [[0.0, 0.0]] }', "two rows or more"),
    ("ramped-cantilever", 'forces.tip.y={ type = "piecewise", rows = [[0.0, 0.0], [9.0, 1.0]] }', "reach the duration"),
    ("ramped-cantilever", 'forces.tip.y={ type = "piecewise", rows = [[0.1, 0.0], [10.0, 1.0]] }', "0 or earlier"),
    ("ramped-cantilever", 'forces.tip.y={ type = "piecewise", rows = [[0.0, 0.0], [2.0, 1.0], [2.0, 2.0], [10.0, 1.0]] }', "must increase"),
    ("ramped-cantilever", 'forces.tip.y={ type = "piecewise", rows = [[0.0, 0.0, 1.0], [10.0, 1.0, 1.0]] }', "2 numbers"),
    ("quick-return", 'drives.motor.angle={ type = "piecewise", rows = [[0.0, 1.5], [2.0, 3.0]] }', "its rate jumps"),
    ("quick-return", 'drives.motor.angle={ type = "ramp", from = 1.5, to = 2.0, start = 0.0, duration = 1.0 }', "its rate jumps"),
]

failures = 0


def check(name, arguments, expected):
    global failures
    run = subprocess.run([DRIVER, *arguments, "--start"], capture_output=True, text=True)
    message = run.stderr.strip().replace(f"{tempfile.gettempdir()}/", "")
    good = run.returncode == 1 and expected.lstrip(":") in message
    failures += not good
    print(f"{'ok    ' if good else 'WRONG '} {name}: {message or 'accepted'}")


for scene, old, new, expected in EDITS:
    text = (ROOT / "scenes" / f"{scene}.toml").read_text()
    assert old in text, (scene, old)
    with tempfile.NamedTemporaryFile("w", suffix=".toml") as file:
        file.write(text.replace(old, new, 1))
        file.flush()
        check(scene, [file.name], expected)
for scene, override, expected in OVERRIDES:
    check(scene, [str(ROOT / "scenes" / f"{scene}.toml"), "--set", override], expected)
print(f"{failures} failures")
sys.exit(failures != 0)
