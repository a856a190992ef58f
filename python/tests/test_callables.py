"""Callables in scenes: against the same functions in TOML, tangents, exceptions."""

import traceback

import numpy as np
import pytest
from conftest import OSCILLATOR, TOP

import looselink

PUSH = {"type": "force", "point": "mass.pin", "x": 0.0, "y": 0.0, "frame": "ground"}


def same_bits(a, b):
    assert a.channels == b.channels
    for name in a:
        assert a[name].tobytes() == b[name].tobytes(), name


def test_a_load_has_the_bits_of_its_twin(oscillator):
    oscillator.set("forces.push", PUSH)
    twin = oscillator.copy().set("forces.push.x", {"type": "polynomial", "coefficients": [1.0, 2.0, 3.0]})
    # Horner's rule, as the library evaluates it
    own = oscillator.set("forces.push.x", lambda t: ((0.0 * t + 3.0) * t + 2.0) * t + 1.0)
    same_bits(own.run(), twin.run())


def test_a_motion_has_the_bits_of_its_twin():
    crank = {
        "bodies": {
            "ground": {"type": "ground", "points": {"O": [0.0, 0.0]}},
            "crank": {"type": "rigid_body", "mass": 1.0, "inertia": 0.1, "points": {"A": [-0.1, 0.0]}},
        },
        "joints": {"O": {"type": "revolute", "bearing": "ground.O", "journal": "crank.A", "model": "ideal"}},
        "drives": {"turn": {"type": "angle", "joint": "O", "angle": {"type": "polynomial", "coefficients": [0.1, 2.0, 3.0]}}},
        "initial": {"sketch": {"O": [0.0, 0.0]}},
        "forces": {},
    }
    twin = looselink.load(OSCILLATOR | crank)

    def angle(t):
        # Horner's rule with derivatives, as the library evaluates it
        value, rate, second = 3.0, 0.0, 0.0
        for c in (2.0, 0.1):
            second, rate, value = second * t + 2.0 * rate, rate * t + value, value * t + c
        return value, rate, second

    own = twin.copy().set("drives.turn.angle", angle)
    same_bits(own.run(), twin.run())


def test_callables_stand_in_dicts(oscillator):
    scene = looselink.load(OSCILLATOR | {"forces": OSCILLATOR["forces"] | {"push": PUSH | {"x": lambda t: 5.0 * t}}})
    twin = oscillator.set("forces.push", PUSH | {"x": "5.0 * t"})
    a, b = scene.run(), twin.run()
    assert a.channels == b.channels
    assert all(np.array_equal(a[name], b[name]) for name in a)


def test_a_load_of_the_motion_is_a_spring_damper(oscillator):
    """A spring and a damper written in Python against those of the library: the same motion."""

    def pull(t, x, y, vx, vy):
        length = np.hypot(x, y)
        n = np.array([x, y]) / length
        return -(300.0 * (length - 0.4) + 0.5 * (n @ [vx, vy])) * n

    spring = OSCILLATOR["forces"]
    own = looselink.load(OSCILLATOR | {"forces": {}}).add_load("spring", "mass.pin", pull)
    assert list(own.run().select("spring.*")) == ["spring.fx", "spring.fy"]
    a, b = own.run(), oscillator.run()
    assert spring["spring"]["stiffness"] == 300.0
    for name in ("mass.x", "mass.y", "mass.theta", "mass.vx", "mass.omega"):
        size = np.abs(b[name]).max()
        # Newton's method stops at 1e-10 m/s a step: 200 steps
        assert np.abs(a[name] - b[name]).max() < 2e-8 * max(size, 1.0), name
    assert np.ptp(b["mass.x"]) > 0.01


def test_the_differenced_tangent_converges_as_the_exact_one(oscillator):
    calls = {"load": 0, "tangent": 0}

    def load(t, x, y, vx, vy):
        calls["load"] += 1
        return -40.0 * x**3 - vx * abs(vx), 7.0 * x * y - 3.0 * vy

    def tangent(t, x, y, vx, vy):
        calls["tangent"] += 1
        return [[-120.0 * x**2, 0.0, -2.0 * abs(vx), 0.0], [7.0 * y, 7.0 * x, 0.0, -3.0]]

    differenced = oscillator.copy().add_load("cubic", "mass.pin", load).run()
    of_differences = dict(calls)
    calls.update(load=0)
    exact = oscillator.copy().add_load("cubic", "mass.pin", load, tangent=tangent).run()
    assert calls["tangent"] > 0
    # four calls fewer an evaluation of the tangent
    assert calls["load"] == of_differences["load"] - 4 * calls["tangent"]
    work = ("steps", "newton_iterations", "rejected_steps")
    assert [exact.summary[key] for key in work] == [differenced.summary[key] for key in work]
    # a wrong tangent is noticed by the work
    wrong = oscillator.copy().add_load("cubic", "mass.pin", load, tangent=lambda *_: np.full((2, 4), 30.0)).run()
    assert wrong.summary["newton_iterations"] > exact.summary["newton_iterations"]
    for name in exact:
        size = max(np.abs(exact[name]).max(), 1.0)
        # both within the tolerance of Newton's method, 1e-10 m/s a step, of accelerations by the step 1e-3 s
        assert np.abs(exact[name] - differenced[name]).max() < 1e-6 * size, name


def test_the_energy_balance_knows_the_work_of_a_load(oscillator):
    run = oscillator.set("integrator.step", 1e-4).add_load("push", "mass.pin", lambda t, x, y, vx, vy: (3.0, -2.0 * t)).run()
    ledger = run.summary["ledger"]
    assert abs(ledger["work"]) > 0.01
    # order 2 of the trapezoidal rule: 1e-8 of the energies, with some factor
    assert abs(ledger["numerical"]) < 1e-5 * (abs(ledger["work"]) + ledger["initial"])


class Stop(Exception):
    pass


@pytest.mark.parametrize("method", ["trapezoidal", "bathe", "velocity_verlet", "dormand_prince", "esdirk3", "esdirk5"])
@pytest.mark.parametrize("kind", ["function", "load", "tangent"])
def test_an_exception_ends_the_run_and_is_raised(oscillator, kind, method, tmp_path):
    oscillator.set("integrator.method", method)
    calls = []
    # one tangent may serve a whole run, so only the first one is certain to be evaluated
    last = 0.0 if kind == "tangent" else 0.05

    def fail(t, *_):
        if t > last:
            calls.append(t)
            raise Stop("not here")
        return (0.0, 0.0) if kind == "load" else 0.0 if kind == "function" else np.zeros((2, 4))

    if kind == "function":
        oscillator.set("forces.push", PUSH | {"x": fail})
    elif kind == "load":
        oscillator.add_load("push", "mass.pin", fail)
    else:
        oscillator.add_load("push", "mass.pin", lambda *_: (0.0, 0.0), tangent=fail)
    if kind == "tangent" and method in ("velocity_verlet", "dormand_prince"):
        # explicit methods need no tangent
        assert oscillator.run().status == "complete"
        return
    with pytest.raises(Stop, match="not here") as caught:
        oscillator.run(out=tmp_path / "out")
    assert "in fail" in "".join(traceback.format_tb(caught.value.__traceback__))
    # it is not called again
    assert len(calls) == 1
    assert last - 0.02 < caught.value.run.t[-1] <= last
    assert caught.value.run.status == "failed"


def test_results_of_the_wrong_kind_are_refused(oscillator):
    oscillator.set("forces.push", PUSH)
    before = oscillator.overrides
    for function, kind, message in [
        (lambda t: "much", TypeError, "the callable of `forces.push.x` must return a number, not 'much'"),
        (lambda t: (1.0, 2.0, 3.0), TypeError, "must return a number"),
        (lambda t: float("nan"), ValueError, "returns NaN at t = 0 s"),
        (lambda: 1.0, TypeError, "positional argument"),
    ]:
        with pytest.raises(kind, match=message):
            oscillator.set("forces.push.x", function)
    assert oscillator.overrides == before
    for load, kind, message in [
        (lambda t, x, y, vx, vy: 1.0, TypeError, r"must return \(fx, fy\), not 1.0"),
        (lambda t, x, y, vx, vy: (float("inf"), 0.0), ValueError, "returns inf"),
    ]:
        with pytest.raises(kind, match=message):
            oscillator.copy().add_load("load", "mass.pin", load).run()
    with pytest.raises(TypeError, match="must return two rows"):
        oscillator.copy().add_load("load", "mass.pin", lambda *_: (0, 0), tangent=lambda *_: 3).run()
    with pytest.raises(TypeError, match="load cannot be called"):
        oscillator.add_load("load", "mass.pin", 3)
    with pytest.raises(looselink.SceneError, match="`tip`"):
        oscillator.add_load("load", "mass.tip", lambda *_: (0, 0))
    with pytest.raises(ValueError, match="has a force `spring` already"):
        oscillator.add_load("spring", "mass.pin", lambda *_: (0, 0))
    with pytest.raises(looselink.SceneError, match="names both"):
        oscillator.add_load("mass", "mass.pin", lambda *_: (0, 0))
    assert oscillator.overrides == before


def test_a_motion_needs_its_derivatives():
    scene = looselink.load(TOP / "scenes/harmonic-slider.toml")
    with pytest.raises(TypeError, match=r"`drives.motor.angle` must return \(value, rate, acceleration\), not 1.0"):
        scene.set("drives.motor.angle", lambda t: 1.0)


def test_callables_run_scenes_themselves(oscillator):
    inner = oscillator.copy()
    oscillator.set("forces.push", PUSH | {"x": lambda t: float(inner.run()["mass.x"][0])})
    oscillator.set("simulation.duration", 0.01)
    assert oscillator.run().status == "complete"


def test_scenes_with_callables_show_their_motion(oscillator):
    run = oscillator.set("forces.push", PUSH | {"x": lambda t: 5.0 * t}).run()
    assert "callable" in run.view().html


def test_the_command_line_does_not_know_callables(oscillator, program, tmp_path):
    oscillator.set("forces.push", PUSH | {"x": lambda t: 5.0 * t}).run(out=tmp_path / "out")
    assert 'cannot be "callable"' in program("view", tmp_path / "out", expect=2)
