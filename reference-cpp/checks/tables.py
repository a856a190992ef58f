#!/usr/bin/env python3
"""Monotone tables over time: make && make build/libreference.so && python3 checks/tables.py"""
import sys

import numpy as np

import driver
from driver import expect, judge, path_of, run, scene
from library import CONSTRAINT, COORDINATE, Scene


def curve(rows, times, duration=1.0):
    """Value and two derivatives of the monotone table at the times, in x of a path; y and theta have minus and twice the values."""
    poses = [[t, y, -y, 2 * y] for t, y in rows]
    library = Scene(path_of("curve", scene(duration, duration / 10, f"""bodies.ground = {{ type = "ground" }}
bodies.base = {{ type = "moving", path = {{ type = "table", shape = "monotone", rows = {poses} }} }}
""")))
    columns, lines = ([library.names(of).index("base." + k) for k in ("x", "y", "theta")] for of in (COORDINATE, CONSTRAINT))
    rest, found = np.zeros(library.n), []
    for t in times:
        phi, _, phi_t = library.rows(t, rest)
        all_of = np.array([-phi[lines], -phi_t[lines], library.acceleration(t, rest, rest, np.zeros(library.joints))[columns]])
        expect_same(all_of)
        found.append(all_of[:, 0])
    return np.array(found)


def expect_same(found):
    assert np.allclose(found[:, 1], -found[:, 0], atol=1e-13) and np.allclose(found[:, 2], 2 * found[:, 0], atol=1e-13)


times = np.linspace(0.0, 1.0, 101)

# between two dwells a smooth step, and flats that are exactly flat
step = curve([[0.0, 0.3], [0.2, 0.3], [0.6, 1.1], [1.0, 1.1]], times)
u = np.clip((times - 0.2) / 0.4, 0, 1)
exact = np.array([0.3 + 0.8 * (10 * u ** 3 - 15 * u ** 4 + 6 * u ** 5), 2 * (30 * u ** 2 - 60 * u ** 3 + 30 * u ** 4), 5 * (60 * u - 180 * u ** 2 + 120 * u ** 3)]).T
expect("dwell, rise, dwell: a smooth step", step - exact, 1e-12)
dwell = (times < 0.195) | (times > 0.605)
expect("dwells are flat to the last bit", step[dwell] - np.array([np.where(times[dwell] < 0.4, 0.3, 1.1), 0 * times[dwell], 0 * times[dwell]]).T, 0.0)


# a quartic that rises gently is reproduced
def quartic(t):
    return np.array([t + 0.3 * t ** 2 - 0.2 * t ** 3 + 0.1 * t ** 4, 1 + 0.6 * t - 0.6 * t ** 2 + 0.4 * t ** 3, 0.6 - 1.2 * t + 1.2 * t ** 2])


expect("a rising quartic is reproduced", curve([[t, float(quartic(t)[0])] for t in (0.0, 0.13, 0.35, 0.4, 0.62, 0.8, 1.0)], times) - quartic(times).T, 1e-11)

# order 5 of the value, order 3 of the acceleration
errors = []
for n in (20, 40):
    rows = [[float(t), float(np.sinh(2 * t))] for t in np.linspace(0, 1, n + 1)]
    errors.append(np.max(np.abs(curve(rows, times + 0.003 * (times < 0.5)) - np.array([f(2 * (times + 0.003 * (times < 0.5))) * 2 ** k for k, f in enumerate((np.sinh, np.cosh, np.sinh))]).T), axis=0))
orders = np.log2(errors[0] / errors[1])
judge(orders[0] > 4.5 and orders[2] > 2.5, f"orders of value, rate and acceleration: {np.round(orders, 2)}")

# rows that jump about: at rest where they turn, never outside two neighbouring rows, acceleration continuous
rng = np.random.default_rng(7)
for trial in range(20):
    t = np.concatenate([[0.0], np.sort(rng.uniform(0.01, 0.99, 9)), [1.0]])
    y = np.round(rng.normal(size=11) * 10.0 ** rng.integers(-2, 3, size=11), 1)
    rows = [[float(a), float(b)] for a, b in zip(t, y)]
    size = np.max(np.abs(y))
    dense = np.linspace(0, 1, 401)
    values = curve(rows, dense)[:, 0]
    place = np.clip(np.searchsorted(t, dense, side="right") - 1, 0, 9)
    low, high = np.minimum(y[place], y[place + 1]), np.maximum(y[place], y[place + 1])
    outside = np.max(np.maximum(low - values, values - high)) / size
    at_rows, before = curve(rows, t[1:-1]), curve(rows, np.nextafter(t[1:-1], 0))
    turning = (y[1:-1] - y[:-2]) * (y[2:] - y[1:-1]) <= 0
    scale = np.max(np.abs(at_rows), axis=0) + 1e-300
    good = outside < 1e-15 and np.all(at_rows[turning, 1] == 0) and np.max(np.abs(at_rows - before) / scale) < 1e-9
    judge(good, f"random rows {trial}: outside by {outside:.0e}, jumps {np.max(np.abs(at_rows - before) / scale):.0e}")

# as a function of time of a load
bob, _ = run("load", scene(1.0, 0.01, """bodies.ground = { type = "ground", points.o = [0.0, 0.0] }
bodies.bob = { type = "point_mass", mass = 0.5 }
forces.push = { type = "force", point = "bob.center", x = { type = "table", shape = "monotone", rows = [[0.0, 0.3], [0.2, 0.3], [0.6, 1.1], [1.0, 1.1]] }, y = 0.0, frame = "ground" }
initial.bodies.bob = { x = 0.0, y = 0.0 }
"""))
expect("a load: its value", bob["push.fx"] - exact[:, 0], 1e-14)
expect("a load: the momentum", 0.5 * bob["bob.vx"][-1] - (0.2 * 0.3 + 0.4 * 0.7 + 0.4 * 1.1), 1e-9)
sys.exit(driver.failures != 0)
