#!/usr/bin/env python3
"""Wound torsion springs, equilibria, static load paths and pressed journals, against closed forms: make && python3 checks/equilibria.py"""
import math
import sys

import numpy as np

import driver
from driver import expect, run, scene

# ---- torsion springs count turns ------------------------------------------------------------------------------------------------

STIFF, INERTIA = 0.3, 0.5 * 0.8 * 0.1 ** 2
COIL = """bodies.ground = {{ type = "ground", points.o = [0.0, 0.0] }}
bodies.wheel = {{ type = "disc", mass = 0.8, radius = 0.1 }}
joints.pin = {{ type = "revolute", bearing = "ground.o", journal = "wheel.center", model = "ideal" }}
forces.coil = {{ type = "torsion_spring", joint = "pin", stiffness = {k}, damping = 0.0, rest_angle = {rest} }}
{more}"""
WOUND = 4 * math.pi  # 720 degrees
for theta, start in ((0.0, 0.0), (-7.0, -7.0), (30.0, 30.0)):
    wheel, _ = run("wound", scene(1.0, 0.01, COIL.format(k=STIFF, rest=WOUND, more=f"initial.bodies.wheel = {{ x = 0.0, y = 0.0, theta = {theta} }}\n")))
    pace = math.sqrt(STIFF / INERTIA)
    exact = WOUND + (start - WOUND) * np.cos(pace * wheel["t"])
    expect(f"wound by {WOUND - start:.2f} rad: torque at the start", wheel["coil.torque"][0] - STIFF * (WOUND - start), 1e-12)
    expect(f"wound by {WOUND - start:.2f} rad: angle of the spring", wheel["coil.angle"] - exact, 1e-7)
    expect(f"wound by {WOUND - start:.2f} rad: angle of the wheel", wheel["wheel.theta"] - exact, 1e-7)
sketched, _ = run("sketched", scene(0.1, 0.01, COIL.format(k=STIFF, rest=WOUND + 0.5, more="initial.sketch.wheel = { rim = [0.1, 0.0] }\n")))
expect("a sketch gives no turns", sketched["coil.angle"][0] - WOUND, 1e-12)
driven, _ = run("driven", scene(0.1, 0.01, COIL.format(k=STIFF, rest=0.0, more='drives.turn = { type = "angle", joint = "pin", angle = "12.0 + t" }\n')))
expect("a drive gives the turns", driven["coil.torque"] + STIFF * (12.0 + driven["t"]), 1e-9)

sys.exit(driver.failures != 0)
