#!/usr/bin/env python3
"""Compares the derivatives of forces, constraints and rates of internal states with central differences, at a state that each scene reaches:
make build/libreference.so && python3 checks/derivatives.py [SCENE]..."""
import pathlib
import sys

import numpy as np

from library import ROOT, Scene


def difference(function, x, h):
    columns = []
    for i in range(len(x)):
        step = np.zeros(len(x))
        step[i] = h
        columns.append((function(x + step) - function(x - step)) / (2 * h))
    return np.array(columns).T


def deviation(a, b, least=1e-30):
    return np.abs(a - b).max() / max(np.abs(a).max(), least) if a.size else 0.0


def at_states(scene, states, function):
    """The function at other internal states."""
    kept = scene.present_states()
    scene.set_states(states)
    value = function()
    scene.set_states(kept)
    return value


def of_forces(scene, t, q, v, z, step):
    """df/dq, df/dv."""
    f, k, d = scene.force(t, q, v, z)
    return [deviation(k, difference(lambda x: scene.force(t, x, v, z)[0], q, step)),
            deviation(d, difference(lambda x: scene.force(t, q, x, z)[0], v, 1e-5))]


def of_constraints(scene, t, q):
    """Phi_q, Phi_t."""
    phi, phi_q, phi_t = scene.rows(t, q)
    return [deviation(phi_q, difference(lambda x: scene.rows(t, x)[0], q, 1e-6)),
            deviation(phi_t, (scene.rows(t + 1e-7, q)[0] - scene.rows(t - 1e-7, q)[0]) / 2e-7, 1e-2)]


def of_states(scene, t, q, v, z):
    """df/dx, dg/dq, dg/dv, dg/dx of the internal states x' = g. What steady slip makes small is compared with the slip itself."""
    x = scene.present_states()
    rates, by_q, by_v, by_x = scene.state_rates(t, q, v, z)
    force = lambda y: at_states(scene, y, lambda: scene.force(t, q, v, z)[0])
    rate = lambda y: at_states(scene, y, lambda: scene.state_rates(t, q, v, z)[0])
    return [deviation(scene.force_by_states(t, q, v, z), difference(force, x, 1e-9)),
            deviation(by_q, difference(lambda y: scene.state_rates(t, y, v, z)[0], q, 1e-8), np.abs(v).max(initial=0.0)),
            deviation(by_v, difference(lambda y: scene.state_rates(t, q, y, z)[0], v, 1e-7), 1.0),
            deviation(by_x, difference(rate, x, 1e-9))]


def tangents(scene, t, q, v, z):
    """How far the derivatives by q, v and internal states are off."""
    return of_forces(scene, t, q, v, z, 1e-11) + of_states(scene, t, q, v, z)


def compare(path):
    scene = Scene(path)
    t = min(0.004137, 0.4 * scene.description.duration)
    q, v, z = scene.state_at(t)
    if z.max(initial=0.0) == 0.0 and not scene.description.is_static:  # no contact: any other state will do as well
        q = q + 1e-3 * np.sin(np.arange(scene.n))
        v = v + 1e-1 * np.sin(np.arange(scene.n))
    if scene.states > 0:  # away from the kink of friction at rest
        v = v + 1e-2 * np.sin(1 + np.arange(scene.n))
    step = 1e-11 if z.max(initial=0.0) > 0.0 else 1e-8  # penetrations are small
    results = of_forces(scene, t, q, v, z, step) + of_constraints(scene, t, q)
    names = ["df/dq", "df/dv", "Phi_q", "Phi_t"]
    if scene.states > 0:
        results += of_states(scene, t, q, v, z)
        names += ["df/dx", "dg/dq", "dg/dv", "dg/dx"]
    print(f"{path.stem:32} " + "  ".join(f"{name} {result:.1e}" for name, result in zip(names, results)))
    return max(results)


if __name__ == "__main__":
    worst = max(compare(path) for path in [pathlib.Path(name) for name in sys.argv[1:]] or sorted((ROOT / "scenes").rglob("*.toml")))
    print(f"largest relative deviation {worst:.1e}")
    sys.exit(bool(worst > 1e-4))
