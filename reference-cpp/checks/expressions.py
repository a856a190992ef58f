#!/usr/bin/env python3
"""Expressions as functions of time: make && make build/libreference.so && python3 checks/expressions.py"""
import math
import sys

import numpy as np

import driver
from driver import ROOT, expect, path_of, refused, run, scene
from library import CONSTRAINT, COORDINATE, Scene

# ---- derivatives: of analytic functions by differences on a circle in the complex plane, which are exact ---------------------------

SMOOTH = [
    "3", "pi * t", "-t", "+t - -t", "1e-3 * t + 2.5E1", "3 - t - 2*t + t", "(t - 1)*(t + 2)*t", "t/(1 + t^2)/3", "2/(3 - t)", "1/(1 + t)/(2 + t)",
    "t^1", "t^2", "t**3 - 2*t^2", "-t^2", "2 * -t", "(t - 0.4)^5", "(1 + t)^-1.5", "(1 + t)^0.5", "(t + 2)^(1/3)", "(t - 3)^-2", "t^0",
    "2^t", "2^-t", "2^3^t", "(1 + t)^t", "(2 + cos(t))^sin(3*t)", "(1 + t)**(2 - t)", "(0.1 + 3*t)^2^t + t", "pi^(t/pi)",
    "sin(3*t + 0.2)", "cos(t^2 - 1)", "tan(0.9*t)", "asin(0.6*t)", "acos(0.5*t - 0.1)", "atan(4*t - 1)", "sinh(2*t)", "cosh(2*t - 1)",
    "tanh(3*t - 1)", "exp(-t^2)", "log(1 + t)", "sqrt(0.1 + t)", "atan2(1 + t, 0.3 - t)", "atan2(-2 - t, sin(t))", "atan2(t - 2, -1)",
    "atan2(1, 2)*t", "asin(0.1 * sin(10 * t))", "exp(sin(t)/(1 + t^2))*tanh(t)", "sqrt(1 + sin(t)^2)", "log(cosh(t))", "cos(sin(cos(3*t)))",
    "asin(tanh(t))", "tan(atan(t)*0.5)", "smooth_step(0.3 + 0.5*t)", "smooth_step(sin(t))^2*t", "smooth_step(1 + t)*t", "t + smooth_step(-t)", "sin(t)*cos(t)*exp(t)*t", "1/(1 + exp(-40*(t - 0.5)))", "+".join(["t*t*sin(t)"] * 90), "*".join(["t"] * 500),
]


def smooth_step(u):
    """Also of complex arguments."""
    return np.where(np.real(u) <= 0, 0, np.where(np.real(u) >= 1, 1, u ** 3 * (10 - 15 * u + 6 * u * u)))


ANALYTIC = dict(sin=np.sin, cos=np.cos, tan=np.tan, asin=np.arcsin, acos=np.arccos, atan=np.arctan, sinh=np.sinh, cosh=np.cosh, tanh=np.tanh,
                exp=np.exp, log=np.log, sqrt=np.sqrt, smooth_step=smooth_step, atan2=lambda y, x: np.log((x + 1j * y) / np.sqrt(x * x + y * y + 0j)) / 1j, pi=np.pi)
REAL = dict(ANALYTIC, atan2=np.arctan2, abs=np.abs, min=np.minimum, max=np.maximum)


def python(formula, functions):
    """The operators are those of Python."""
    return eval("lambda t: " + formula.replace("^", "**"), dict(functions))


def taylor(function, t, radius=0.01, points=32):
    """Value and two derivatives."""
    turn = np.exp(2j * math.pi * np.arange(points) / points)
    values = np.array([function(t + radius * z) for z in turn])
    return [math.factorial(k) * (values * turn ** -k).mean().real / radius ** k for k in range(3)]


def prescribed(formulas, times):
    """Values and two derivatives by time, formula and order: Phi = x - f(t) at x = 0, and the acceleration."""
    library = Scene(path_of("moving", scene(1.0, 1e-2, 'bodies.ground = { type = "ground" }\n' + "".join(
        f'bodies.b{i} = {{ type = "moving", path = {{ type = "coordinates", x = "{f}", y = 0.0, theta = 0.0 }} }}\n' for i, f in enumerate(formulas)))))
    names = [f"b{i}.x" for i in range(len(formulas))]
    rows, columns = ([library.names(of).index(name) for name in names] for of in (CONSTRAINT, COORDINATE))
    rest = np.zeros(library.n)
    found = []
    for t in times:
        phi, _, phi_t = library.rows(t, rest)
        found.append(np.array([-phi[rows], -phi_t[rows], library.acceleration(t, rest, rest, np.zeros(library.joints))[columns]]).T)
    return np.array(found)


times = [0.037, 0.21, 0.55, 0.83, 0.96]
found = prescribed(SMOOTH, times)
for i, formula in enumerate(SMOOTH):
    exact = np.array([taylor(python(formula, ANALYTIC), t) for t in times])
    errors = np.max(np.abs(found[:, i] - exact) / (1 + np.abs(exact)), axis=0)
    name = formula if len(formula) < 50 else f"{formula[:20]}... of {len(formula)} characters"
    expect(f"{name}: value and first derivative", errors[:2], 1e-12)
    expect(f"{name}: second derivative", errors[2], 1e-9)

# where a general rule would multiply zero by infinity
START = {"t^0": (1, 0, 0), "t^1": (0, 1, 0), "t^2": (0, 0, 2), "t^3": (0, 0, 0), "t^2.5": (0, 0, 0), "t^(4/2)": (0, 0, 2), "(2*t)^(1 + 1)": (0, 0, 8),
         "(t^2)^2": (0, 0, 0), "(sin(t))^1": (0, 1, 0), "t^2^1": (0, 0, 2), "t*t": (0, 0, 2), "atan2(t, 1)": (0, 1, 0), "0*sqrt(1 - t)": (0, 0, 0)}
expect("at t = 0: " + ", ".join(START), prescribed(START, [0.0])[0] - np.array(list(START.values())), 0.0)

# motions that switch smoothly, away from the switch as if there were none
SWITCHING = {"max(0, t - 0.4)^3": lambda t: (t - 0.4) ** 3 * (np.real(t) > 0.4), "abs(t - 0.3)^3": lambda t: (t - 0.3) ** 3 * np.sign(np.real(t) - 0.3),
             "min(t, 0.5)^2 + max(0, t - 0.5)^4 + max(0, t - 0.5) + max(0, t - 0.5)^2": lambda t: np.where(np.real(t) < 0.5, t ** 2, t ** 2 + (t - 0.5) ** 4),
             "abs(sin(10*t))^3": lambda t: np.sin(10 * t) ** 3 * np.sign(np.sin(10 * np.real(t))), "abs(t - t)*t + t": lambda t: t}
found = prescribed(SWITCHING, times)
for i, (formula, function) in enumerate(SWITCHING.items()):
    exact = np.array([taylor(function, t) for t in times])
    expect(f"{formula}: value and derivatives", found[:, i] - exact, 1e-9)
for formula, what in (("max(0, t - 0.7)^2", "acceleration"), ("max(0, t - 0.7)", "velocity"), ("abs(t - 0.7)^2*sin(t) + abs(cos(20*t))", "velocity"),
                      ("t + max(0, sin(2*pi*t) - 0.9999999999)", "velocity"), ("max(0, 1e-9 - (t - 0.12345)^2)*1e6", "velocity"),
                      ("0.5*t^2 + min(t, 0.123456789)^2", "velocity")):
    moving = 'bodies.ground = {{ type = "ground" }}\nbodies.b = {{ type = "moving", path = {{ type = "coordinates", x = "{0}", y = 0.0, theta = 0.0 }} }}\n'
    refused([path_of("jump", scene(1.0, 1e-2, moving.format(formula)))], f"the {what} of a prescribed motion must not jump")
end = "smooth_step((t - 0.1) / 0.1) - smooth_step((t - 0.3) / 0.1)"
u = lambda t, start: (t - start) / 0.1
for t in (0.05, 0.1, 0.13, 0.19, 0.2, 0.25, 0.33, 0.4, 0.5):
    steps = [np.array([smooth_step(x), 10 * 30 * x ** 2 * (1 - x) ** 2 * (0 < x < 1), 100 * 60 * x * (1 - x) * (1 - 2 * x) * (0 < x < 1)]) for x in (u(t, 0.1), u(t, 0.3))]
    expect(f"{end} at {t}", prescribed([end], [t])[0][0] - (steps[0] - steps[1]), 1e-9)

# ---- values of loads: the grammar, and kinks ----------------------------------------------------------------------------------------

GRAMMAR = {"2^3^2": 512, "2**3^2": 512, "-2^2": -4, "2^-1": 0.5, "2^-2^2": 0.0625, "(-2)^2": 4, "(-2)^3": -8, "8/4/2": 1, "8/4*2": 4, "2 - 3 - 4": -5,
           "2 - -3": 5, "2 + +3": 5, "--2": 2, "-+-2": 2, "2*-3": -6, "2/-4": -0.5, "-2*-3": 6, "1 + 2*3^2": 19, "(1 + 2)*3": 9, "((7))": 7,
           "1e-3": 0.001, "1.5e+2": 150, "2E2": 200, "1e3*2": 2000, "3-1": 2, "3e0-1": 2, "0.5": 0.5, ".5": 0.5, "5.": 5, "pi": math.pi, "-pi^2": -math.pi ** 2,
           "atan2(1, -1)": 0.75 * math.pi, "max(1, 2)": 2, "min(1, 2)": 1, "min(max(1, 2), 3 - 4)": -1, "abs(-3)": 3, "abs (3)": 3, "  1\\t+\\n 2  ": 3, "0^0": 1,
           "log(exp(2))": 2, "sqrt(16)": 4, "exp(0)": 1, "4^0.5": 2, "(" * 400 + "1" + ")" * 400: 1, "-" * 998 + "1": 1}
KINKS = ["abs(t - 0.3)", "abs(sin(20*t))", "min(t, 0.2)", "max(t, 0.2)", "max(0, min(1, (t - 0.1237)*7))", "abs(abs(t - 0.2) - 0.1)",
         "min(t^2, 0.3*t) - max(-t, -0.1)", "sqrt(abs(t - 0.25))", "sqrt(0.5 - t)", "sqrt(t)", "log(1 + t)^2 + t^1.5", "atan(1/(t - 0.333))", "asin(2*t)",
         "exp(-t)*abs(cos(30*t))", *SMOOTH]


def on_held_point(formulas):
    return scene(0.5, 0.1, 'bodies.ground = { type = "ground" }\nbodies.bob = { type = "point_mass", mass = 1.0 }\n'
                 'drives.hold = { type = "point", point = "bob.center", x = 0.0, y = 0.0 }\n' + "".join(
                     f'forces.f{i} = {{ type = "force", point = "bob.center", frame = "ground", x = "{f}", y = 0.0 }}\n' for i, f in enumerate(formulas)))


held, _ = run("grammar", on_held_point(GRAMMAR))
for i, (formula, value) in enumerate(GRAMMAR.items()):
    expect((formula if len(formula) < 50 else f"{len(formula)} characters") + f" = {value:g}", held[f"f{i}.fx"] - value, 1e-14)
held, _ = run("loads", on_held_point(KINKS))
expect(f"{len(KINKS)} loads, up to the end of the run", [np.max(np.abs(held[f"f{i}.fx"] - python(formula, REAL)(np.minimum(held["t"], 0.5))))
                                                          for i, formula in enumerate(KINKS)], 1e-12)

# ---- motion under loads: the same as with tables, and closed forms ---------------------------------------------------------------------

PUSH = """bodies.ground = {{ type = "ground", points.o = [0.0, 0.0] }}
bodies.bob = {{ type = "rigid_body", mass = 0.5, inertia = 2e-3, points.c = [0.0, 0.0] }}
forces.push = {{ type = "force", point = "bob.c", x = {push}, y = 0.0, frame = "ground" }}
initial.bodies.bob = {{ x = 0.0, y = 0.0, theta = 0.0 }}
"""
HARMONIC = '{ type = "harmonic", mean = 0.4, amplitude = 0.1, frequency = 2.0, phase = 0.3 }'
for table, expression in ((HARMONIC, "0.4 + 0.1*sin(4*pi*t + 0.3)"),
                          ('{ type = "ramp", from = 2.0, to = -3.0, start = 0.1237, duration = 0.2 }', "2 - 5*max(0, min(1, (t - 0.1237)/0.2))"),
                          ('{ type = "piecewise", rows = [[0.0, 0.3], [0.3, 0.0], [1.0, 0.7]] }', "abs(t - 0.3)"),
                          ('{ type = "polynomial", coefficients = [1.0, 0.0, -3.0] }', "1 - 3*t^2")):
    one, other = (run("push", scene(0.5, 0.01, PUSH.format(push=push)))[0] for push in (table, f'"{expression}"'))
    expect(f"{expression} as the table: every channel", [one[k] - other[k] for k in one], 1e-9)
bob, _ = run("rectified", scene(1.0, 0.01, PUSH.format(push='"abs(sin(20*t))"')))
t = bob["t"]
expect("abs(sin(20*t)): velocity", 0.5 * bob["bob.vx"] - (2 * np.floor(20 * t / math.pi) + 1 - np.cos(20 * t % math.pi)) / 20, 1e-8)
expect("abs(sin(20*t)): energy", bob["energy.numerical"], 1e-8)
bob, _ = run("short-knock", scene(1.0, 0.01, PUSH.format(push='"max(0, 1 - 400*abs(t - 0.7))"')))
expect("a knock of 5 ms after rest: velocity", 0.5 * bob["bob.vx"][-1] - 1 / 400, 1e-11)
bob, _ = run("ends", scene(0.3, 0.1, PUSH.format(push='"sqrt(0.3 - t)"')))
expect("without a value beyond the end, 3 * 0.1 > 0.3: velocity", 0.5 * bob["bob.vx"][-1] - 0.3 ** 1.5 / 1.5, 1e-7)

text = (ROOT / "scenes/ramped-cantilever.toml").read_text()
text = text[:text.index("[forces.tip.y]")] + text[text.index("[initial]"):]
beam, _ = run("cantilever", text.replace("x = 0.0\nframe", 'x = 0.0\ny = "-250*(1 - cos(pi*min(t, 2)/2))"\nframe'), ["--until", "3"])
expect("ramped cantilever: tip at 3 s", [beam["points.beam.end.x"][-1] - 1.41566743, beam["points.beam.end.y"][-1] + 4.22148239], 2e-8)

STATIC = PUSH.replace("initial", """joints.line = {{ type = "prismatic", guide = "ground.o", direction = [1.0, 0.0], slider = "bob.c", rotation = "locked" }}
forces.spring = {{ type = "spring_damper", from = "ground.o", to = "bob.c", stiffness = 80.0, damping = 0.0, rest_length = 0.2 }}
initial""").replace("bob = {{ x = 0.0", "bob = {{ x = 0.2")
for push, load in (('"4"', lambda t: 4 + 0 * t), ('"2 + abs(t - 0.3)"', lambda t: 2 + np.abs(t - 0.3)), ("4", lambda t: 4 * t / 0.5)):
    bob, _ = run("static", scene(0.5, 0.0625, STATIC.format(push=push), analysis="static"))
    expect(f"static analysis under {push}", 80 * (bob["bob.x"] - 0.2) - load(bob["t"]), 1e-10)

# ---- motions: the same as with tables ---------------------------------------------------------------------------------------------------

DRIVEN = """bodies.ground = {{ type = "ground", points.o = [0.0, 0.0] }}
bodies.base = {{ type = "moving", points.p = [0.1, 0.0], path = {{ type = "coordinates", x = {motion}, y = 0.0, theta = {motion} }} }}
bodies.bar = {{ type = "rigid_body", mass = 0.5, inertia = 2e-3, points.p = [-0.1, 0.0], points.q = [0.1, 0.0] }}
bodies.end = {{ type = "rigid_body", mass = 0.3, inertia = 1e-3, points.q = [0.0, 0.0], points.r = [0.3, 0.0] }}
joints.p = {{ type = "revolute", bearing = "base.p", journal = "bar.p", model = "ideal" }}
joints.q = {{ type = "revolute", bearing = "bar.q", journal = "end.q", model = "ideal" }}
drives.turn = {{ type = "angle", joint = "p", angle = {motion} }}
drives.draw = {{ type = "point", point = "end.r", x = {motion} }}
initial.sketch.end = {{ r = [0.43, 0.4] }}
"""
for table, expression in ((HARMONIC, "0.4 + 0.1*sin(4*pi*t + 0.3)"), ('{ type = "polynomial", coefficients = [0.4, 0.1, -0.3] }', "0.4 + t/10 - 0.3*t^2")):
    one, other = (run("driven", scene(0.5, 0.01, DRIVEN.format(motion=motion)))[0] for motion in (table, f'"{expression}"'))
    expect(f"{expression} as the table: every channel", [one[k] - other[k] for k in one], 1e-7)

text = (ROOT / "scenes/3rrr/case1.toml").read_text()
circle = next(line for line in text.splitlines() if line.startswith("path = "))
turn = "cos({0})", "sin({0})"
numbers = dict(part.strip().split(" = ") for part in circle[circle.index("radius"):].rstrip(" }").split(","))
center = eval(circle[circle.index("["):circle.index("]") + 1])
x, y = (f'"{c} + {numbers["radius"]}*{f.format("2*pi*" + numbers["frequency"] + "*t + " + numbers["phase"])}"' for c, f in zip(center, turn))
path = f'path = {{ type = "coordinates", x = {x}, y = {y}, theta = {numbers["theta"]} }}'
one, other = (run("circle", text.replace(circle, p), ["--until", "0.5"])[0] for p in (circle, path))
expect(f"inverse kinematics, {path}: every channel", [np.max(np.abs(one[k] - other[k])) / (1 + np.max(np.abs(one[k]))) for k in one], 1e-8)

print(f"{driver.failures} failures")
sys.exit(driver.failures != 0)
