#!/usr/bin/env python3
"""The channel JOINT.acceleration of driven joints against differences of JOINT.speed: make && python3 checks/accelerations.py"""
import sys

import numpy as np

import driver
from driver import ROOT, expect, run, scene


def compare(what, channels, joints, limit):
    """Five-point differences; the limit is relative to the largest acceleration."""
    h = channels["t"][1] - channels["t"][0]
    for joint in joints:
        speed, acceleration = channels[joint + ".speed"], channels[joint + ".acceleration"][2:-2]
        slope = (8 * (speed[3:-1] - speed[1:-3]) - (speed[4:] - speed[:-4])) / (12 * h)
        largest = np.max(np.abs(acceleration))
        expect(f"{what}, {joint}, up to {largest:.3g} rad/s2", (slope - acceleration) / largest, limit)


LINK = 'type = "link", length = 0.3, section = "strip", material = "steel", model = '
BODIES = {
    "rigid body": 'type = "rigid_body", mass = 0.3, inertia = 2e-3, points.start = [-0.15, 0.0], points.end = [0.15, 0.0]',
    "disc": 'type = "disc", mass = 0.3, radius = 0.15, rim = 0.0, points.start = [-0.15, 0.0], points.end = [0.15, 0.0]',
    "rigid link": LINK + '"rigid"',
    "flexible link": LINK + '"flexible", elements = 2, kelvin_voigt = 1e-4',
}
# on the ground or a moving base two bodies, from rest; one joint is driven
CHAIN = """materials.steel = {{ density = 7850.0, youngs_modulus = 2e9 }}
sections.strip = {{ width = 0.01, height = 0.02 }}
contacts.pin = {{ law = "hunt_crossley", bearing_radius = 0.01, clearance = 1e-3, stiffness = 1e6, exponent = 1.5, restitution = 0.5, impact_velocity_floor = 1e-6 }}
bodies.ground = {{ type = "ground", points.p = [0.0, 0.0] }}
bodies.base = {{ type = "moving", points.p = [0.0, 0.0], path = {{ type = "coordinates", x = "0.1*sin(3*t)^2", y = 0.0, theta = "sin(2.5*t)^2" }} }}
bodies.one = {{ {one} }}
bodies.two = {{ {two} }}
joints.a = {{ type = "revolute", bearing = "{bearing}.p", journal = "one.start", model = {model} }}
joints.b = {{ type = "revolute", bearing = "one.end", journal = "two.start", model = "ideal" }}
drives.turn = {{ type = "angle", joint = "{driven}", angle = "sin(4*t)^2" }}
initial.bodies = {{ one = {{ x = 0.15, y = 0.0, theta = 0.0 }}, two = {{ x = 0.45, y = 0.0, theta = 0.0 }} }}
"""


def chain(what, one, two, bearing="ground", driven="a", loose=False):
    model = '"clearance", contact = "pin"' if loose else '"ideal"'
    text = CHAIN.format(one=BODIES[one], two=BODIES[two], bearing=bearing, driven=driven, model=model)
    channels, events = run("chain", scene(0.2, 2e-4, text, (0.0, -9.81), clearance=loose))
    what += f", {len(events)} events" if loose else ""
    compare(what, channels, [driven], 1e-6)
    expect(f"{what}: as prescribed", channels[driven + ".acceleration"] - 32 * np.cos(8 * channels["t"]), 1e-8)


for name in BODIES:
    chain(f"{name} on the ground", name, "rigid body")
    chain(f"{name} on a moving base", name, "rigid link", bearing="base")
    chain(f"{name} in a loose joint", name, "rigid body", bearing="base", loose=True)
    for other in BODIES:
        chain(f"{other} on a {name}", name, other, driven="b")

# scenes whose drives do not turn at constant speed; inverse kinematics in closed form, and along the path for a passive slider
SWING = ["--set", 'drives.motor.angle="{} + sin(10*t)"']
for name, joints, until, interval, options in (
        ("3rrr/case1", ["A1", "A2", "A3"], 0.3, 1e-3, []), ("3rrr/case2", ["A1", "A2", "A3"], 0.01, 1e-5, []), ("hard/type-2-singularity", ["A1", "A2", "A3"], 0.2, 1e-3, []),
        ("rod-linkage", ["axle"], 0.45, 5e-3, []), ("quick-return", ["motor"], 0.5, 2e-3, [SWING[0], SWING[1].format("pi/2")]),
        ("slider-crank/flexible", ["main"], 0.002, 1e-5, [SWING[0], SWING[1].format("500*t")])):
    channels, _ = run("scene", (ROOT / "scenes" / f"{name}.toml").read_text(), ["--until", str(until), "--set", f"output.interval={interval}", *options])
    compare(name, channels, joints, 1e-4)
SLOT = """materials.steel = { density = 7850.0 }
sections.strip = { width = 0.01, height = 0.02 }
bodies.ground = { type = "ground", points.p = [0.0, 0.0], points.rail = [0.0, 0.2] }
bodies.lever = { type = "link", model = "rigid", length = 0.3, section = "strip", material = "steel" }
bodies.block = { type = "rigid_body", mass = 0.3, inertia = 2e-3, points.c = [0.0, 0.0] }
joints.a = { type = "revolute", bearing = "ground.p", journal = "lever.start", model = "ideal" }
joints.slot = { type = "prismatic", guide = "lever.start", direction = [1.0, 0.0], slider = "block.c", rotation = "free" }
joints.rail = { type = "prismatic", guide = "ground.rail", direction = [1.0, 0.0], slider = "block.c", rotation = "locked" }
drives.draw = { type = "inverse_kinematics", joints = ["a"], body = "block", path = { type = "coordinates", x = "0.05 + 0.1*sin(4*t)", y = 0.2, theta = 0.0 } }
initial.sketch.lever = { end = [0.07, 0.29] }
"""
channels, _ = run("slot", scene(0.5, 1e-3, SLOT))
compare("lever with a slot", channels, ["a"], 1e-6)
expect("lever with a slot: angle", channels["a.angle"] - np.arctan2(0.2, 0.05 + 0.1 * np.sin(4 * channels["t"])), 1e-9)

print(f"{driver.failures} failures")
sys.exit(driver.failures != 0)
