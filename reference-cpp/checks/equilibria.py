#!/usr/bin/env python3
"""Wound torsion springs, equilibria, static load paths and pressed journals, against closed forms: make && python3 checks/equilibria.py"""
import io
import math
import re
import subprocess
import sys

import numpy as np

import driver
from driver import expect, judge, path_of, refused, run, scene

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

# ---- equilibria at the start ----------------------------------------------------------------------------------------------------

G, L, M = 9.81, 0.4, 0.3
BAR = """bodies.ground = {{ type = "ground", points.o = [0.0, 0.0] }}
bodies.bar = {{ type = "rigid_body", mass = {m}, inertia = {j}, points.p = [-{s}, 0.0] }}
joints.pin = {{ type = "revolute", bearing = "ground.o", journal = "bar.p", model = "ideal" }}
{more}
"""
J = M * L * L / 12


def start_of(text):
    """What the driver says of the equilibrium at the start, and the coordinates."""
    result = subprocess.run([driver.DRIVER, path_of("rest", text), "--start"], capture_output=True, text=True)
    judge(result.returncode == 0, "equilibrium found" + result.stderr)
    lines = result.stdout.splitlines()
    said = re.search(r"equilibrium: (\w+), smallest eigenvalue ([-+.e\d]+)", result.stdout)
    judge((said[1] != "stable") == ("note: the equilibrium" in result.stdout), "a note says where it is not stable")
    places = {words[0]: float(words[1]) for words in (line.split() for line in lines) if len(words) == 3 and "." in words[0]}
    return said[1], float(said[2]), places


def bar(angle, kind, more=""):
    place = f"initial.bodies.bar = {{ x = {L / 2 * math.cos(angle)!r}, y = {L / 2 * math.sin(angle)!r}, theta = {angle!r} }}\n"
    return scene(1.0, 0.01, BAR.format(m=M, j=J, s=L / 2, more=f"initial.equilibrium = {kind}\n{more}{place}"), (0.0, -G))


pace = 1.5 * G / L  # of small vibrations, squared
for angle in (0.3, math.pi / 2, 1.5, -2.0, math.pi):
    kind, value, places = start_of(bar(angle, "true"))
    expect(f"a bar from {angle:.2f} rad hangs", [math.sin(places["bar.theta"]) + 1, places["bar.x"], places["bar.y"] + L / 2], 1e-12)
    judge(kind == "stable" and abs(value / pace - 1) < 1e-12, f"its eigenvalue is 3 g/(2 l): {value / pace - 1:.0e}, {kind}")
kind, value, places = start_of(bar(1.3, '"nearest"'))
expect("the nearest equilibrium of a bar near its summit is the summit", places["bar.theta"] - math.pi / 2, 1e-12)
judge(kind == "unstable" and abs(value / pace + 1) < 1e-12, f"its eigenvalue is -3 g/(2 l): {value / pace + 1:.0e}, {kind}")
kind, value, _ = start_of(scene(1.0, 0.01, BAR.format(m=M, j=J, s=L / 2, more="initial.equilibrium = true\ninitial.bodies.bar = { x = 0.2, y = 0.0, theta = 0.0 }")))
judge(kind == "neutral", f"without weight it is neutral: {kind}, {value}")
held = 'forces.coil = { type = "torsion_spring", joint = "pin", stiffness = 0.2, damping = 0.0, rest_angle = 20.0 }\n'
kind, value, places = start_of(bar(0.0, "true", held))
theta = places["bar.theta"]
expect(f"a wound coil turns the bar to {theta:.3f} rad, in balance with its weight", 0.2 * (20.0 - theta) - M * G * L / 2 * math.cos(theta), 1e-12)

# ---- statics of driven mechanisms: no freedom, no elasticity ---------------------------------------------------------------------------

arm = """bodies.ground = { type = "ground", points.o = [0.0, 0.0] }
bodies.bar = { type = "rigid_body", mass = 0.3, inertia = 1e-3, points.p = [-0.2, 0.0], points.q = [0.2, 0.0] }
joints.pin = { type = "revolute", bearing = "ground.o", journal = "bar.p", model = "ideal" }
drives.turn = { type = "angle", joint = "pin", angle = "0.5 + t" }
forces.pull = { type = "force", point = "bar.q", x = 2.0, y = 0.0, frame = "ground" }
"""
text = scene(1.0, 0.125, arm, (0.0, -G), analysis="static")
text = text.replace('method = "bathe", ', "").replace(", newton_tolerance = 1e-10", "")
bar_of, _ = run("arm", text)
t = bar_of["t"]
expect("a driven arm: torque", bar_of["pin.torque"] - t * (0.3 * G * 0.2 * np.cos(0.5 + t) + 2.0 * 0.4 * np.sin(0.5 + t)), 1e-12)
expect("a driven arm: reactions", [bar_of["pin.fx"] + 2.0 * t, bar_of["pin.fy"] - 0.3 * G * t], 1e-12)

# a chain without weight at first, sketched upwards, comes down as soon as its weight acts; its links stretch
CHAIN = """bodies.ground = { type = "ground", points.o = [0.0, 0.0] }
bodies.a = { type = "link", model = "flexible", length = 0.5, section = "s", material = "m", elements = 3 }
bodies.b = { type = "rigid_body", mass = 0.1, inertia = 1e-4, points.p = [0.0, 0.1] }
materials.m = { density = 2700.0, youngs_modulus = 1e8 }
sections.s = { width = 0.004, height = 0.02 }
joints.o = { type = "revolute", bearing = "ground.o", journal = "a.start", model = "ideal" }
joints.p = { type = "revolute", bearing = "a.end", journal = "b.p", model = "ideal" }
initial.bodies.a = { x = 0.0, y = 0.25, theta = 1.5707963267948966 }
initial.bodies.b = { x = 0.0, y = 0.6, theta = 3.141592653589793 }
"""
chain, _ = run("chain", scene(1.0, 0.1, CHAIN, (0.0, -G), analysis="static"))
t = chain["t"][1:]
expect("a chain sketched upwards hangs", [chain["a.x"][1:], chain["b.x"][1:]], 1e-12)
expect("its tension", chain["o.fy"][1:] - t * G * (0.1 + 2700.0 * 0.004 * 0.02 * 0.5), 1e-9)
stretch = t * G * (0.1 + 2700.0 * 0.004 * 0.02 * 0.25) / (1e8 * 0.004 * 0.02)
expect("it stretches, to first order", -0.6 - chain["b.y"][1:] - 0.5 * stretch, 1e-7)

# ---- static load paths ------------------------------------------------------------------------------------------------------------------

HALF, RISE, K = 0.5, 0.2, 300.0
L0 = math.hypot(HALF, RISE)
TRUSS = f"""bodies.ground = {{ type = "ground", points.a = [-{HALF}, 0.0], points.b = [{HALF}, 0.0], points.o = [0.0, 0.0] }}
bodies.top = {{ type = "rigid_body", mass = 0.1, inertia = 1e-4, points.c = [0.0, 0.0] }}
joints.line = {{ type = "prismatic", guide = "ground.o", direction = [0.0, 1.0], slider = "top.c", rotation = "locked" }}
forces.left = {{ type = "spring_damper", from = "ground.a", to = "top.c", stiffness = {K}, damping = 0.0, rest_length = {L0!r} }}
forces.right = {{ type = "spring_damper", from = "ground.b", to = "top.c", stiffness = {K}, damping = 0.0, rest_length = {L0!r} }}
forces.load = {{ type = "force", point = "top.c", x = 0.0, y = -10.0, frame = "ground" }}
initial.bodies.top = {{ x = 0.0, y = {RISE}, theta = 0.0 }}
"""


def truss_load(y):
    return 2 * K * y * (L0 / np.hypot(HALF, y) - 1)


y_limit = math.sqrt((L0 * HALF * HALF) ** (2 / 3) - HALF * HALF)
limit = truss_load(y_limit) / 10.0


def critical_points(name, text, options=(), fails=False):
    result = subprocess.run([driver.DRIVER, path_of(name, text), "--out", driver.FOLDER / "out.csv", "--unstable", driver.FOLDER / "unstable.csv", "--all", *options],
                            capture_output=True, text=True)
    judge((result.returncode != 0) == fails, f"{name}: {result.stderr.strip().split('toml')[-1] or 'complete'}")
    found = re.findall(r"(limit point|bifurcation) at t = ([-+.e\d]+), .* load, (\S+)", result.stdout)
    tables = []
    for path in ("out.csv", "unstable.csv"):
        with open(driver.FOLDER / path) as file:
            names = file.readline().strip().split(",")
            rows = file.read()
        tables.append(dict(zip(names, np.loadtxt(io.StringIO(rows), delimiter=",", ndmin=2).T)) if rows else {})
    return [(kind, float(t), what) for kind, t, what in found], *tables, result.stdout


truss = scene(1.0, 0.05, TRUSS, analysis="static")
found, rows, _, _ = critical_points("truss", truss, fails=True)
judge([p[0] for p in found] == ["limit point"] and found[0][2] == "top.y", f"a truss stops at a limit point: {found}")
expect("its load", found[0][1] - limit, 1e-9)
expect("the path up to it", truss_load(rows["top.y"]) - 10 * rows["t"], 1e-9)
found, rows, unstable, said = critical_points("truss-follow", truss.replace('analysis = "static"', 'analysis = "static", at_limit = "follow"'))
judge([p[0] for p in found] == ["limit point"] * 2 and "stable" in said, f"a truss that is followed snaps through: {found}")
expect("the loads of its limit points", [found[0][1] - limit, found[1][1] + limit], 1e-9)
expect(f"{len(unstable['t'])} unstable steps on the path", truss_load(unstable["top.y"]) - 10 * unstable["t"], 1e-9)
expect("rows on the path", truss_load(rows["top.y"]) - 10 * rows["t"], 1e-9)
judge(rows["top.y"][-1] < -RISE and np.all(np.diff(unstable["top.y"]) < 0), f"it ends below, at {rows['top.y'][-1]:.3f} m")

pushed = truss.replace('forces.load = { type = "force", point = "top.c", x = 0.0, y = -10.0, frame = "ground" }', f'drives.push = {{ type = "point", point = "top.c", y = "{RISE} - 0.4*t" }}')
rows, _ = run("pushed-truss", pushed)
expect("a truss that is pushed through has no critical point", rows["top.y"] - RISE + 0.4 * rows["t"], 1e-12)

COIL_COLUMN = """bodies.ground = { type = "ground", points.o = [0.0, 0.0] }
bodies.bar = { type = "link", model = "rigid", length = 0.5, section = "strip", material = "steel" }
materials.steel = { density = 7850.0, youngs_modulus = 2e9 }
sections.strip = { width = 0.006, height = 0.02 }
joints.pin = { type = "revolute", bearing = "ground.o", journal = "bar.start", model = "ideal" }
forces.coil = { type = "torsion_spring", joint = "pin", stiffness = 3.0, damping = 0.0, rest_angle = 1.5707963267948966 }
forces.load = { type = "force", point = "bar.end", x = 0.0, y = -10.0, frame = "ground" }
initial.bodies.bar = { x = 0.0, y = 0.25, theta = 1.5707963267948966 }
"""
found, _, _, _ = critical_points("column", scene(1.0, 0.05, COIL_COLUMN, analysis="static"), fails=True)
judge([p[0] for p in found] == ["bifurcation"], f"a hinged column buckles: {found}")
expect("its load k/l", 10 * found[0][1] - 3.0 / 0.5, 1e-9)
found, rows, unstable, said = critical_points("column-follow", scene(1.0, 0.05, COIL_COLUMN, analysis="static").replace('analysis = "static"', 'analysis = "static", at_limit = "follow"'))
judge(len(found) == 1 and "unstable" in said, f"followed, it stays straight and unstable: {found}")
expect("straight", rows["bar.x"], 1e-9)
imperfect, _ = run("imperfect", scene(1.0, 0.05, COIL_COLUMN, analysis="static").replace("x = 0.0, y = -10.0", "x = 0.3, y = -10.0"))
theta = math.pi / 2 - imperfect["coil.angle"]
expect("with a small side load it bends instead", 3.0 * theta - imperfect["t"] * 0.5 * (10 * np.sin(theta) + 0.3 * np.cos(theta)), 1e-10)

# a flexible column, clamped at its foot: P_c of EQUATIONS.md
E_A, E_I, HIGH = 2e9 * 0.006 * 0.02, 2e9 * 0.006 ** 3 * 0.02 / 12, 0.5
BEAM_COLUMN = """bodies.ground = { type = "ground", points.o = [0.0, 0.0] }
bodies.bar = { type = "link", model = "flexible", length = 0.5, section = "strip", material = "steel", elements = 8 }
materials.steel = { density = 7850.0, youngs_modulus = 2e9 }
sections.strip = { width = 0.006, height = 0.02 }
joints.clamp = { type = "weld", first = "ground.o", second = "bar.start", angle = 1.5707963267948966 }
forces.load = { type = "force", point = "bar.end", x = 0.0, y = -10.0, frame = "ground" }
initial.bodies.bar = { x = 0.0, y = 0.25, theta = 1.5707963267948966 }
"""
euler = (math.pi / 2) ** 2 * E_I / HIGH ** 2
exact = euler * math.sqrt(1 - 2 * euler / E_A)
for elements, limit in ((8, 4e-6), (16, 3e-7)):
    text = scene(1.0, 0.05, BEAM_COLUMN, analysis="static").replace("elements = 8", f"elements = {elements}")
    found, _, _, _ = critical_points("beam-column", text, fails=True)
    judge([p[0] for p in found] == ["bifurcation"], f"a flexible column buckles: {found}")
    expect(f"its load, {elements} elements", 10 * found[0][1] / exact - 1, limit)

# ---- journals that start pressed --------------------------------------------------------------------------------------------------------

PIN = """contacts.pin = {{ law = "{law}", bearing_radius = 0.01, clearance = 1e-4, stiffness = 1e8, exponent = 1.5{rest} }}
bodies.ground = {{ type = "ground", points.o = [0.1, 0.2] }}
bodies.bob = {{ type = "rigid_body", mass = 0.5, inertia = 2e-3, points.p = [0.0, 0.3] }}
joints.pin = {{ type = "revolute", bearing = "ground.o", journal = "bob.p", model = "clearance", contact = "pin" }}
{start}
"""
damped = ", restitution = 0.8, impact_velocity_floor = 1e-3"
hanging = PIN.format(law="hunt_crossley", rest=damped, start="initial.journals = \"pressed\"\ninitial.bodies.bob = { x = 0.1, y = -0.1, theta = 0.0 }")
bob, events = run("pressed", scene(0.05, 1e-3, hanging, (0.0, -G), clearance=True))
delta = (0.5 * G / 1e8) ** (1 / 1.5)
expect("a bob hangs pressed: penetration", bob["pin.penetration"][0] / delta - 1, 1e-6)
expect("its eccentricity", [bob["pin.ex"][0], bob["pin.ey"][0] + 1e-4 + delta], 1e-15)
expect("its force is the weight, and stays so", [np.max(np.abs(bob["pin.fx"])), np.max(np.abs(bob["pin.fy"] - 0.5 * G))], 1e-6)
expect("it stays at rest", [np.max(np.abs(bob["bob.vx"])), np.max(np.abs(bob["bob.vy"]))], 1e-9)
judge(len(events) == 0, f"without events: {len(events)}")

# a bob that swings: the force is that of the ideal pendulum, to the ratio of the clearance to its length
angle, spin = 0.7, 6.0
state = f"x = {0.1 + 0.3 * math.sin(angle)!r}, y = {0.2 - 0.3 * math.cos(angle)!r}, theta = {angle}, vx = {spin * 0.3 * math.cos(angle)!r}, vy = {spin * 0.3 * math.sin(angle)!r}, omega = {spin}"
swinging = PIN.format(law="hertz", rest="", start=f"initial.journals = \"pressed\"\ninitial.bodies.bob = {{ {state} }}")
bob, _ = run("pressed-swing", scene(0.01, 1e-3, swinging, (0.0, -G), clearance=True))
ideal, _ = run("ideal-swing", scene(0.01, 1e-3, swinging.replace('model = "clearance"', 'model = "ideal"'), (0.0, -G)))
size = ideal["pin.force"][0]
expect("a bob swings pressed: force of the ideal joint", [bob["pin.fx"][0] - ideal["pin.fx"][0], bob["pin.fy"][0] - ideal["pin.fy"][0]], 1e-9 * size)
expect("the surfaces rest on each other", [bob["pin.ex_rate"][0], bob["pin.ey_rate"][0]], 1e-12)
expect("it moves no farther than the clearance", [bob["bob.x"][0] - ideal["bob.x"][0], bob["bob.y"][0] - ideal["bob.y"][0]], 2e-4)
light = hanging.replace("mass = 0.5", "mass = 1e-12")
bob, _ = run("pressed-light", scene(0.001, 1e-4, light, (0.0, -G), clearance=True).replace("onset_tolerance = 1e-12", "onset_tolerance = 1e-9"))
expect("what needs no penetration stays in the middle", bob["pin.eccentricity"][0], 1e-15)
refused([path_of("deep", scene(0.05, 1e-3, hanging.replace("stiffness = 1e8", "stiffness = 1e3"), (0.0, -G), clearance=True))], "more than its clearance")

# a pin in a guide
SLOT = f"""contacts.wall = {{ law = "hertz", clearance = 1e-3, stiffness = 1e6, exponent = 1.0 }}
bodies.ground = {{ type = "ground", points.o = [0.0, 0.0] }}
bodies.pin = {{ type = "point_mass", mass = 0.2 }}
joints.slot = {{ type = "loose_guide", guide = "ground.o", direction = [{math.cos(0.5)}, {math.sin(0.5)}], slider = "pin.center", contact = "wall" }}
initial.journals = "pressed"
initial.bodies.pin = {{ x = 0.0, y = 0.0 }}
"""
pin, _ = run("pressed-slot", scene(0.1, 1e-2, SLOT, (0.0, -G), clearance=True))
press = 0.2 * G * math.cos(0.5)
expect("a pin slides pressed: penetration", pin["slot.penetration"] - press / 1e6, 1e-11)
expect("along the guide g sin", pin["slot.travel"] + 0.5 * G * math.sin(0.5) * pin["t"] ** 2, 1e-8)

# flexible links count as rigid ones for the forces
RODS = """contacts.pin = { law = "hunt_crossley", bearing_radius = 0.01, clearance = 2e-5, stiffness = 1e9, exponent = 1.5, restitution = 0.8, impact_velocity_floor = 1e-3 }
materials.steel = { density = 7850.0, youngs_modulus = 210e9 }
sections.strip = { width = 0.01, height = 0.02 }
bodies.ground = { type = "ground", points.a = [0.0, 0.0], points.b = [0.5, 0.0] }
bodies.crank = { type = "link", model = "rigid", length = 0.15, section = "strip", material = "steel" }
bodies.rod = { type = "link", model = "flexible", length = 0.45, section = "strip", material = "steel", elements = 2 }
bodies.block = { type = "rigid_body", mass = 0.3, inertia = 1e-3, points.p = [0.0, 0.0] }
joints.pivot = { type = "revolute", bearing = "ground.a", journal = "crank.start", model = "ideal" }
joints.elbow = { type = "revolute", bearing = "crank.end", journal = "rod.start", model = "clearance", contact = "pin" }
joints.wrist = { type = "revolute", bearing = "rod.end", journal = "block.p", model = "ideal" }
joints.rail = { type = "prismatic", guide = "ground.b", direction = [1.0, 0.0], slider = "block.p", rotation = "locked" }
drives.spin = { type = "angle", joint = "pivot", angle = "0.8 + 20*t" }
initial = { journals = "pressed", sketch = { elbow = [0.1, 0.1], wrist = [0.5, 0.0] } }
"""
loose, _ = run("pressed-rods", scene(1e-3, 1e-4, RODS, (0.0, -G), clearance=True))
ideal, _ = run("ideal-rods", scene(1e-3, 1e-4, RODS.replace('model = "clearance"', 'model = "ideal"').replace('model = "flexible"', 'model = "rigid"'), (0.0, -G)))
force = np.array([ideal["elbow.fx"][0], ideal["elbow.fy"][0]])
delta = (np.linalg.norm(force) / 1e9) ** (1 / 1.5)
expect("a crank and a flexible rod: eccentricity against the ideal force",
       np.array([loose["elbow.ex"][0], loose["elbow.ey"][0]]) + (2e-5 + delta) * force / np.linalg.norm(force), 1e-12)
expect("at rest on each other", [loose["elbow.ex_rate"][0], loose["elbow.ey_rate"][0]], 1e-10)

print(f"{driver.failures} failures")
sys.exit(driver.failures != 0)
