#!/usr/bin/env python3
"""Compares the derivatives of force and constraints with central differences, at a state that each scene reaches:
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


worst = 0.0
for path in [pathlib.Path(name) for name in sys.argv[1:]] or sorted((ROOT / "scenes").rglob("*.toml")):
    scene = Scene(path)
    t = min(0.004137, 0.4 * scene.description.duration)
    q, v, z = scene.state_at(t)
    if z.max(initial=0.0) == 0.0 and not scene.description.is_static:  # no contact: any other state will do as well
        q = q + 1e-3 * np.sin(np.arange(scene.n))
        v = v + 1e-1 * np.sin(np.arange(scene.n))
    f, k, d = scene.force(t, q, v, z)
    phi, phi_q, phi_t = scene.rows(t, q)
    step = 1e-11 if z.max(initial=0.0) > 0.0 else 1e-8  # penetrations are small
    results = [deviation(k, difference(lambda x: scene.force(t, x, v, z)[0], q, step)),
               deviation(d, difference(lambda x: scene.force(t, q, x, z)[0], v, 1e-5)),
               deviation(phi_q, difference(lambda x: scene.rows(t, x)[0], q, 1e-6)),
               deviation(phi_t, (scene.rows(t + 1e-7, q)[0] - scene.rows(t - 1e-7, q)[0]) / 2e-7, 1e-2)]
    worst = max(worst, *results)
    print(f"{path.stem:32} df/dq {results[0]:.1e}  df/dv {results[1]:.1e}  Phi_q {results[2]:.1e}  Phi_t {results[3]:.1e}")
print(f"largest relative deviation {worst:.1e}")
sys.exit(bool(worst > 1e-4))
