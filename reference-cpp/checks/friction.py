#!/usr/bin/env python3
"""Friction with a Stribeck curve and with bristles, against closed forms and reference motions:
make && make build/libreference.so && python3 checks/friction.py"""
import math
import subprocess
import sys

import numpy as np

import driver
from derivatives import tangents
from library import STATE, Scene
from driver import expect, judge, path_of, refused, run, scene

# A block of 1 kg is pressed on a straight track by its weight of 10 N, which presses it in by 1e-6 m. It starts at rest across the
# track and stays so; the damping of the contact takes what rounding adds.
N, STIFF, PLAY = 10.0, 1e7, 1e-4
PRESSED = 0.5 * N * N / STIFF  # energy of the contact itself
TRACK = """contacts.track = {{ law = "hunt_crossley", clearance = 1e-4, stiffness = 1e7, exponent = 1.0, restitution = 0.5, impact_velocity_floor = 1e-2, friction = {{ {friction} }} }}
bodies.ground = {{ type = "ground", points.o = [0.0, 0.0], points.anchor = [-1.0, -1.01e-4] }}
bodies.belt = {{ type = "moving", points.line = [0.0, 0.0], path = {{ type = "coordinates", x = "{belt} * t", y = 0.0, theta = 0.0 }} }}
bodies.block = {{ type = "point_mass", mass = 1.0 }}
joints.track = {{ type = "loose_guide", guide = "belt.line", slider = "block.center", direction = [1.0, 0.0], contact = "track" }}
{rest}
initial.bodies.block = {{ x = 0.0, y = -1.01e-4, vx = {speed}, vy = 0.0 }}
"""


def track(friction, belt=0.0, rest="", speed=0.0):
    return TRACK.format(friction=friction, belt=belt, rest=rest, speed=speed)


def push(x):
    return f'forces.push = {{ type = "force", point = "block.center", x = {x}, y = 0.0, frame = "ground" }}'


def load(name, duration, interval, body, options=(), gravity=(0.0, -10.0)):
    return run(name, scene(duration, interval, body, gravity, clearance=True), options)


# ---- stick and slip on a belt ---------------------------------------------------------------------------------------

# Two integrators (LSODA and Radau) at tight tolerances, which differ by 2e-8 s; the equations of the block alone, without those of
# the contact. The deflection has the sign of the slip of the belt there, here that of the block.
LUGRE = 'law = "lugre", mu_c = 0.25, mu_s = 0.4, v_s = 0.01, s0 = 1e4, s1 = 3.0'
SLIP_STARTS = [0.46524078920986217, 1.2201500914509784, 1.97532180173601, 2.7304600211890007]
SLIP_ENDS = [0.020087516434559322, 0.8320242076469027, 1.586806707296831, 2.341994791685589]
SAMPLES = [(0.05, 0.0030222012849442743, 0.09968399429321352, -1.4145058077728554e-05),
           (0.2, 0.01796901391122598, 0.09973709709309499, 1.7280702448041175e-05),
           (0.4, 0.03787876650427336, 0.0985402472330826, 3.749588662832916e-05),
           (0.6, 0.03398479059697458, -0.16994864780033245, 2.4999999999999998e-05),
           (0.8, 0.005807621002327566, -0.010974877546375513, 2.5e-05),
           (1.0, 0.022512344768496992, 0.09996319409445154, 2.1746697568024467e-05),
           (1.5, 0.009157495372862241, -0.10968723482998935, 2.5e-05),
           (2.0, 0.044260820579585684, 0.003040889085229913, 2.5000000000000005e-05)]
SPRING = 'forces.spring = { type = "spring_damper", from = "ground.anchor", to = "block.center", stiffness = 100.0, damping = 0.0, rest_length = 1.0 }'


def passages(t, f, rate, rising):
    """Zeros of Hermite's cubic through values and rates at the rows."""
    found = []
    h = t[1] - t[0]
    for k in np.flatnonzero((f[:-1] < 0) & (f[1:] >= 0) if rising else (f[:-1] > 0) & (f[1:] <= 0)):
        a, b = rate[k] * h, rate[k + 1] * h
        difference = f[k + 1] - f[k]
        roots = np.roots([a + b - 2 * difference, 3 * difference - 2 * a - b, a, f[k]])
        found.append(t[k] + h * min(roots[np.abs(roots.imag) < 1e-9].real, key=lambda x: abs(x - 0.5)))
    return np.array(found)


for options in ([], ["--sparse"]):
    name = "sparse" if options else "dense"
    block, _ = load("belt", 2.8, 1e-4, track(LUGRE, 0.1, SPRING), options)
    slip = 0.1 - block["block.vx"] - 0.05
    expect(f"belt, {name}: slip rises through half the speed of the belt", passages(block["t"], slip, -block["block.ax"], True) - SLIP_STARTS, 1e-7)
    expect(f"belt, {name}: slip falls through it", passages(block["t"], slip, -block["block.ax"], False) - SLIP_ENDS, 1e-7)
    rows = [round(s[0] / 1e-4) for s in SAMPLES]
    for column, channel, sign, limit in ((1, "block.x", 1, 1e-8), (2, "block.vx", 1, 1e-6), (3, "track.bristle", -1, 1e-10)):
        expect(f"belt, {name}: {channel}", block[channel][rows] - [sign * s[column] for s in SAMPLES], limit)
    expect(f"belt, {name}: energy", block["energy.numerical"], 2e-9)
    expect(f"belt, {name}: the normal force does not vary", block["energy.normal_variation"], 1e-9)

# ---- constant slip -----------------------------------------------------------------------------------------------------

# Closed form, z = g/s0 (1 - exp(-s0 v t/g)): slip v, t, z, T, work, energy of the bristles, dissipated
CONSTANT_SLIP = [
    (0.0001, 0.001, 9.987509942195854e-08, 0.012980019028844, 7.992088762817557e-10, 4.987517742273052e-10, 3.004571020544505e-10),
    (0.0001, 0.01, 9.876030578623448e-07, 0.10168623277929595, 5.2548718275861755e-08, 4.87679899949527e-08, 3.780728280909052e-09),
    (0.0001, 0.1, 8.847928929230531e-06, 0.8871292733688718, 4.634655267845201e-06, 3.914292316835726e-06, 7.203629510094748e-07),
    (0.001, 0.001, 9.875574772126066e-07, 0.12801230559858176, 7.921110771047998e-08, 4.87634885399264e-08, 3.044761917055358e-08),
    (0.001, 0.01, 8.844000031881572e-06, 0.9077421606742891, 4.872066285627062e-06, 3.910816828196062e-06, 9.612494574309995e-07),
    (0.001, 0.1, 3.661008448482396e-05, 3.6634480486587084, 0.0002537118542982457, 6.70149142992974e-05, 0.00018669693999894828),
    (0.01, 0.001, 8.526834024888909e-06, 1.068862898327897, 7.05388635875938e-06, 3.635344924400159e-06, 3.4185414343592205e-06),
    (0.01, 0.01, 2.9366088783212258e-05, 2.947934282350369, 0.00022437175035621077, 4.3118358521175234e-05, 0.00018125339183503554),
    (0.01, 0.1, 3.051819161757145e-05, 3.0518191617571464, 0.002967838617281754, 4.656800098034041e-05, 0.0029212706163014137),
    (0.2, 0.001, 2.4991613434302437e-05, 2.5011741191976586, 0.0005874706470200586, 3.1229037102480304e-05, 0.0005562416099175783),
    (0.2, 0.01, 2.5e-05, 2.5, 0.005087500000000001, 3.125e-05, 0.005056250000000001),
    (0.2, 0.1, 2.5e-05, 2.5, 0.05008750000000001, 3.125e-05, 0.05005625000000001)]
HELD = 'drives.hold = { type = "point", point = "block.center", x = 0.0 }'
for slip in (0.0001, 0.001, 0.01, 0.2):
    block, _ = load("constant-slip", 0.1, 1e-3, track(LUGRE, slip, HELD), ["--position", "1e-15", "--velocity", "1e-13"])
    for column, channel, sign, offset, limit in (
            (2, "track.bristle", -1, 0.0, 1e-13), (3, "track.fx", 1, 0.0, 2e-9), (4, "energy.work", 1, 0.0, 1e-11),
            (5, "energy.contact", 1, PRESSED, 1e-13), (6, "energy.friction_dissipated", 1, 0.0, 1e-11)):
        exact = [(round(row[1] / 1e-3), sign * row[column] + offset) for row in CONSTANT_SLIP if row[0] == slip]
        expect(f"slip of {slip} m/s: {channel}", [block[channel][i] - value for i, value in exact], limit)
    expect(f"slip of {slip} m/s: energy", block["energy.numerical"], 1e-11)

# ---- a load that oscillates below break-away ------------------------------------------------------------------------------

# x at the ends of 20 cycles, two integrators that differ by 1e-14 m: LuGre's bristles drift, elasto-plastic ones do not
DRIFT = [3.3973557440536224e-05, 4.217082950866792e-05, 5.036810194110476e-05, 5.8565374373544256e-05, 6.676264680598373e-05,
         7.495991923842272e-05, 8.315719167085451e-05, 9.135446410330118e-05, 9.955173653574026e-05, 0.00010774900896818041,
         0.0001159462814006187, 0.0001241435538330619, 0.00013234082626550173, 0.00014053809869794134, 0.00014873537113037656,
         0.00015693264356281744, 0.00016512991599526038, 0.0001733271884276979, 0.00018152446086013694, 0.00018972173329257457]
REST = [1.1879084550434765e-05] + 19 * [1.18790829652081e-05]
CURVE = "mu_c = 0.3, mu_s = 0.4, v_s = 0.005, s0 = 1e4, s1 = 10.0"
cycle = 2 * math.pi / 20
for law, more, ends in (("lugre", "", DRIFT), ("elasto_plastic", ", breakaway = 0.8", REST)):
    block, _ = load("drift", 20 * cycle, cycle, track(f'law = "{law}", {CURVE}{more}', rest=push('"1.2 + 0.6 * sin(20 * t)"')),
                    ["--position", "1e-14", "--velocity", "1e-12"])
    expect(f"{law}, oscillating load: x at the ends of 20 cycles", block["block.x"][1:] - ends, 1e-10)
    expect(f"{law}, oscillating load: energy", block["energy.numerical"], 1e-10)

# below break-away elasto-plastic bristles are springs: a damped oscillator
block, _ = load("spring", 0.2, 1e-3, track(f'law = "elasto_plastic", {CURVE}, breakaway = 0.8', rest=push(1.0)), ["--position", "1e-14"])
decay, pace = 0.5 * N * 10.0, math.sqrt(N * 1e4 - (0.5 * N * 10.0) ** 2)
t = block["t"]
exact = 1e-5 * (1 - np.exp(-decay * t) * (np.cos(pace * t) + decay / pace * np.sin(pace * t)))
expect("elastic bristles: x", block["block.x"] - exact, 1e-11)
expect("elastic bristles: z", block["track.bristle"] - exact, 1e-11)
expect("elastic bristles: energy", block["energy.numerical"], 1e-11)

# the same damping where it falls with the slip, but not at the slip of this motion
same, _ = load("spring", 0.2, 1e-3, track(f'law = "elasto_plastic", {CURVE}, breakaway = 0.8, v_d = 1e6, s2 = 0.0', rest=push(1.0)),
               ["--position", "1e-14"])
expect("a damping that does not fall: every channel", [np.max(np.abs(same[k] - block[k])) for k in block], 1e-9)

# steady slip: T = F_n (g + s2 v) with bristles, and times tanh(v/v_r) without them; s1 is out of it
for law, more, factor in (("lugre", "s0 = 1e4, s1 = 2.0, v_d = 0.02", 1.0), ("elasto_plastic", "s0 = 1e4, s1 = 2.0, breakaway = 0.5", 1.0),
                          ("coulomb_stribeck", "v_r = 0.01", math.tanh(3.0))):
    text = f'law = "{law}", mu_c = 0.2, mu_s = 0.5, v_s = 0.02, {more}, s2 = 0.7'
    block, _ = load("steady", 0.1, 1e-3, track(text, 0.03, HELD))
    force = N * ((0.2 + 0.3 * math.exp(-2.25)) * factor + 0.7 * 0.03)
    expect(f"{law}: steady slip", block["track.fx"][-1] - force, 1e-8)
    expect(f"{law}: energy", block["energy.numerical"], 1e-10)

# falling damping during a steep rise of the slip: z' and T by hand at every row
text = 'law = "lugre", mu_c = 0.2, mu_s = 0.5, v_s = 0.02, s0 = 1e4, s1 = 20.0, v_d = 0.05, s2 = 0.3'
block, _ = load("falling", 0.05, 1e-4, track(text, rest=push('"400 * t"')))
v, z = block["block.vx"], block["track.bristle"]
rate = v - np.abs(v) * 1e4 * z / (0.2 + 0.3 * np.exp(-(v / 0.02) ** 2))
expect("falling damping: T", -block["track.fx"] - N * (1e4 * z + 20.0 * np.exp(-(v / 0.05) ** 2) * rate + 0.3 * v), 1e-9)
expect("falling damping: energy", block["energy.numerical"], 1e-9)

# the normal force varies: the integral of F_n' s0 z^2/2 from the rows, by the trapezoidal rule of d(F_n)
down = 'forces.down = { type = "force", point = "block.center", x = 0.0, y = "-4 * sin(300 * t)", frame = "ground" }\n'
block, _ = load("varied", 0.1, 1e-5, track(f'law = "elasto_plastic", {CURVE}, breakaway = 0.8', rest=down + push('"2 + 1.5 * cos(170 * t)"')))
normal, held = np.abs(block["track.fy"]), 0.5e4 * block["track.bristle"] ** 2
varied = np.concatenate([[0.0], np.cumsum(np.diff(normal) * (held[1:] + held[:-1]) / 2)])
expect(f"normal force of {normal.min():.1f} to {normal.max():.1f} N: variation up to {np.abs(varied).max():.1e} J", block["energy.normal_variation"] - varied, 1e-9)
expect("normal force varies: energy", block["energy.numerical"], 1e-10)

# without memory a body that should stick creeps
creep, _ = load("creep", 0.5, 1e-2, track('law = "coulomb_stribeck", mu_c = 0.4, mu_s = 0.4, v_s = 0.01, v_r = 1e-3', rest=push(3.0)))
expect("coulomb_stribeck: creep", creep["block.vx"][-1] - 1e-3 * math.atanh(3.0 / (0.4 * N)), 1e-9)
expect("coulomb_stribeck: energy", creep["energy.numerical"], 1e-8)
judge("energy.normal_variation" not in creep and "track.bristle" not in creep, "coulomb_stribeck: no channels of bristles")

# ---- contacts that close and open --------------------------------------------------------------------------------------------

BOUNCE = """contacts.pin = {{ law = "hunt_crossley", bearing_radius = 0.02, clearance = 1e-3, stiffness = 1e6, exponent = {n}, restitution = {e}, impact_velocity_floor = 1e-6, friction = {{ {friction} }} }}
bodies.ground = {{ type = "ground" }}
bodies.ring = {{ type = "rigid_body", mass = 0.3, inertia = 2e-4, points.o = [0.01, 0.0] }}
bodies.pin = {{ type = "rigid_body", mass = 0.2, inertia = 3e-5, points.o = [0.0, 0.0], points.rim = [0.0, 0.05] }}
joints.play = {{ {joint} }}
initial.bodies.ring = {{ x = -0.01, y = 0.0, theta = 0.0, vx = 0.0, vy = 0.0, omega = 6.0 }}
initial.bodies.pin = {{ x = 0.0, y = 0.0, theta = 0.0, vx = 0.5, vy = 0.3, omega = -20.0 }}
"""
JOINTS = {"revolute": 'type = "revolute", bearing = "ring.o", journal = "pin.o", model = "clearance", contact = "pin"',
          "guide": 'type = "loose_guide", guide = "ring.o", slider = "pin.o", direction = [1.0, 0.5], contact = "pin"'}
LAWS = {"lugre": 'law = "lugre", mu_c = 0.2, mu_s = 0.3, v_s = 0.05, s0 = 3e3, s1 = 0.05, s2 = 0.1',
        "lugre, falling damping": 'law = "lugre", mu_c = 0.2, mu_s = 0.3, v_s = 0.05, s0 = 3e3, s1 = 2.0, v_d = 0.1',
        "elasto_plastic": 'law = "elasto_plastic", mu_c = 0.2, mu_s = 0.3, v_s = 0.05, s0 = 3e3, s1 = 0.05, breakaway = 0.6',
        "coulomb_stribeck": 'law = "coulomb_stribeck", mu_c = 0.2, mu_s = 0.3, v_s = 0.05, v_r = 0.01, s2 = 0.1',
        "lugre, paper": 'law = "lugre", mu_c = 0.2, mu_s = 0.3, v_s = 0.05, s0 = 3e3, s1 = 0.05, slip = "paper"'}


def momentum(c):
    """Angular momentum about the origin, whose change would show a couple that is missing."""
    return sum(m * (c[b + ".x"] * c[b + ".vy"] - c[b + ".y"] * c[b + ".vx"]) + i * c[b + ".omega"] for b, m, i in (("ring", 0.3, 2e-4), ("pin", 0.2, 3e-5)))


for kind, joint in JOINTS.items():
    for law, friction in LAWS.items():
        if kind == "guide" and "paper" in law:
            continue
        both = [load("bounce", 0.05, 1e-4, BOUNCE.format(n=1.5, e=0.6, friction=friction, joint=joint), options, (0.0, 0.0))
                for options in ([], ["--sparse"])]
        c, events = both[0]
        what = f"{law} in a {kind}, {len(events)} events"
        expect(f"{what}: energy", c["energy.numerical"], 1e-9)
        for axis in "xy":
            total = 0.3 * c[f"ring.v{axis}"] + 0.2 * c[f"pin.v{axis}"]
            expect(f"{what}: momentum {axis}", total - total[0], 1e-10)
        if kind == "guide":
            expect(f"{what}: angular momentum", momentum(c) - momentum(c)[0], 1e-9)
        expect(f"{what}: dense and sparse", [both[0][0][k] - both[1][0][k] for k in ("pin.x", "pin.theta")], 1e-8)
        if "play.bristle" in c:
            apart = (c["play.contact"] == 0) & (c["play.penetration"] < -1e-9)
            judge(apart.any() and (c["play.contact"] == 1).any(), f"{what}: rows in contact and apart")
            expect(f"{what}: bristles while apart", c["play.bristle"][apart], 0.0)
            varied = c["energy.normal_variation"]
            print(f"       friction dissipated {c['energy.friction_dissipated'][-1]:.3e} J, normal variation {varied.min():.1e} to {varied.max():.1e} J")

# derivatives at states in every branch of the laws, and the list of states
for kind, joint in JOINTS.items():
    for law, friction in LAWS.items():
        if "coulomb" in law or (kind == "guide" and "paper" in law):
            continue
        library = Scene(path_of("tangents", scene(0.05, 1e-4, BOUNCE.format(n=1.5, e=0.6, friction=friction, joint=joint) +
                                'forces.element = { type = "maxwell", from = "ring.o", to = "pin.rim", stiffness = 50.0, damping = 3.0, rest_length = 0.1, elongation = 0.02 }\n',
                                clearance=True)))
        judge(library.names(STATE) == ["play.bristle", "element.elongation"] and list(library.present_states()) == [0.0, 0.02], f"{law} in a {kind}: its states")
        q = np.array([-0.01, 0.0, 0.1, 6e-4, 9e-4 + 1e-3, 0.2])
        q[3:5] += np.array([0.01 * math.cos(0.1) - 0.01, 0.01 * math.sin(0.1)])
        for speed in (-0.5, 0.4):
            v = np.array([0.1, -0.02, 0.3, 0.1 + speed, 0.05, -2.0])
            for deflection in (-1e-4, -7.5e-5, -5.5e-5, -1e-5, 2e-5, 5e-5, 8e-5, 1.5e-4):
                library.set_states([deflection, 0.02])
                worst = max(tangents(library, 0.0, q, v, np.array([0.3])))
                judge(worst < 1e-5, f"{law} in a {kind}, slip {speed}, z {deflection}: derivatives off by {worst:.0e}")
        at_rest = library.state_rates(0.0, q, v, np.zeros(1))
        judge(at_rest[0][0] == 0.0 and not any(m[0].any() for m in at_rest[1:]) and not library.force_by_states(0.0, q, v, np.zeros(1))[:, 0].any(),
              f"{law} in a {kind}: bristles of an open contact rest")

# the documented places of the channels
names = list(c := load("order", 1e-3, 1e-3, track(LUGRE))[0])
judge(names[names.index("track.contact") + 1] == "track.bristle", "place of the channel JOINT.bristle")
judge(names[names.index("energy.friction_dissipated"):][:3] == ["energy.friction_dissipated", "energy.normal_variation", "energy.damping_dissipated"],
      "place of the channel energy.normal_variation")

# ---- refusals --------------------------------------------------------------------------------------------------------------------

ELASTIC = f'law = "elasto_plastic", {CURVE}, breakaway = 0.8'
STRIBECK = 'law = "coulomb_stribeck", mu_c = 0.3, mu_s = 0.4, v_s = 0.01, v_r = 1e-3'
CASES = [(f'law = "lugre", {CURVE}', None), (STRIBECK, None), (ELASTIC, None)]
for base in (f'law = "lugre", {CURVE}', ELASTIC, STRIBECK):
    CASES += [(base.replace("mu_s = 0.4", "mu_s = 0.29"), "friction.mu_s: must be at least mu_c"),
              (base.replace("mu_c = 0.3", "mu_c = 0.0"), "friction.mu_c: must be positive"),
              (base.replace("mu_c = 0.3, ", ""), "`mu_c` is missing"),
              (base.replace("mu_s = 0.4, ", ""), "`mu_s` is missing"),
              (base.replace("v_s = 0.0", "v_s = -0.0"), "friction.v_s: must be positive"),
              (base + ", s2 = -1.0", "friction.s2: must not be negative"),
              (base + ", coefficient = 0.1", "`coefficient` has no meaning"),
              (base + ", v0 = 0.0", "`v0` has no meaning"),
              (base + ', slip = "paper"', 'slip "paper" is refused in a loose guide'),
              (base + ', slip = "true"', "none of")]
for base in (f'law = "lugre", {CURVE}', ELASTIC):
    CASES += [(base.replace("s0 = 1e4, ", ""), "`s0` is missing"),
              (base.replace("s0 = 1e4", "s0 = 0.0"), "friction.s0: must be positive"),
              (base.replace("s1 = 10.0", "s1 = -1.0"), "friction.s1: must not be negative"),
              (base + ", v_d = 0.0", "friction.v_d: must be positive"),
              (base + ", v_r = 1e-3", "`v_r` has no meaning")]
CASES += [(f'law = "lugre", {CURVE}, breakaway = 0.5', "`breakaway` has no meaning"),
          (ELASTIC.replace("breakaway = 0.8", "breakaway = 1.0"), "friction.breakaway: must be below 1"),
          (ELASTIC.replace("breakaway = 0.8", "breakaway = -0.1"), "friction.breakaway: must not be negative"),
          (ELASTIC.replace(", breakaway = 0.8", ""), "`breakaway` is missing"),
          (STRIBECK.replace(", v_r = 1e-3", ""), "`v_r` is missing"),
          (STRIBECK.replace("v_r = 1e-3", "v_r = 0.0"), "friction.v_r: must be positive"),
          (STRIBECK + ", s0 = 1e4", "`s0` has no meaning"),
          (STRIBECK + ", s1 = 1.0", "`s1` has no meaning"),
          (STRIBECK + ", v_d = 1.0", "`v_d` has no meaning"),
          ('law = "ambrosio", coefficient = 0.1, mu_c = 0.1', "`mu_c` has no meaning"),
          ('law = "dahl", mu_c = 0.1', "none of")]
for friction, message in CASES:
    path = path_of("refused", scene(1.0, 0.1, track(friction), (0.0, -10.0), clearance=True))
    if message is None:
        accepted = subprocess.run([driver.DRIVER, path, "--start"], capture_output=True, text=True)
        judge(accepted.returncode == 0, f"accepted: {friction}")
    else:
        refused([path], message)
outside = scene(1.0, 0.1, track(STRIBECK).replace("y = -1.01e-4, vx", "y = -2.1e-4, vx"), (0.0, -10.0), clearance=True)
refused([path_of("outside", outside)], "outside its guide")
print(f"{driver.failures} failures")
sys.exit(driver.failures != 0)
