"""Callables and progress that use the scene they belong to, and end in every way: never a crash, never a wrong result."""

import dataclasses
import gc
import os
import subprocess
import sys
import textwrap
import threading
import time
import weakref

import numpy as np
import pytest
from conftest import OSCILLATOR
from test_callables import PUSH, same_bits

import looselink

CRANK = OSCILLATOR | {
    "bodies": {
        "ground": {"type": "ground", "points": {"O": [0.0, 0.0]}},
        "crank": {"type": "rigid_body", "mass": 1.0, "inertia": 0.1, "points": {"A": [-0.1, 0.0]}},
    },
    "joints": {"O": {"type": "revolute", "bearing": "ground.O", "journal": "crank.A", "model": "ideal"}},
    "drives": {"turn": {"type": "angle", "joint": "O", "angle": {"type": "polynomial", "coefficients": [0.1, 2.0]}}},
    "initial": {"sketch": {"O": [0.0, 0.0]}},
    "forces": {},
}


def pushed(function):
    """The oscillator with a force of time, whose check it calls as `function` before anything is armed."""
    return looselink.load(OSCILLATOR).set("forces.push", PUSH).set("forces.push.x", function)


class Nested:
    """A function of time that does something in each call, once it is told to."""

    def __init__(self, value=0.0):
        self.value = value
        self.act = None

    def __call__(self, t):
        if self.act is not None:
            self.act(t)
        return self.value


def load_again(function):
    looselink.load(OSCILLATOR | {"forces": OSCILLATOR["forces"] | {"push": PUSH | {"x": function}}})


ROUTES = {
    "run": lambda scene, function: scene.run(),
    "progress": lambda scene, function: scene.run(progress=lambda t, duration: None),
    "inspect": lambda scene, function: scene.inspect(),
    "modes": lambda scene, function: scene.modes(at=0.1),
    "set": lambda scene, function: scene.copy().set("forces.push.y", function),
    "load": lambda scene, function: load_again(function),
    "copy": lambda scene, function: scene.copy().run(),
}


@pytest.mark.parametrize("route", ROUTES)
@pytest.mark.parametrize("inside", [False, True], ids=["main", "thread"])
def test_a_callable_that_evaluates_its_own_scene_is_stopped(route, inside):
    function = Nested()
    scene = pushed(function)
    function.act = lambda t: ROUTES[route](scene, function)
    caught = []

    def call():
        try:
            ROUTES[route](scene, function)
        except RecursionError as error:
            caught.append(str(error))

    if inside:
        thread = threading.Thread(target=call)
        thread.start()
        thread.join()
    else:
        call()
    assert len(caught) == 1
    # where Python's own limit comes first it says so
    assert "does a callable run its own scene without end?" in caught[0] or "maximum recursion depth" in caught[0]
    # nothing is left behind
    function.act = None
    same_bits(scene.run(), pushed(lambda t: 0.0).run())


def test_motions_and_loads_that_run_their_own_scene_are_stopped(oscillator):
    def angle(t):
        if armed:
            crank.run()
        return 0.1 + 2.0 * t, 2.0, 0.0

    armed = False
    crank = looselink.load(CRANK).set("drives.turn.angle", angle)
    armed = True
    for call in (crank.run, crank.inspect, crank.modes, crank.copy().run):
        with pytest.raises(RecursionError, match="without end"):
            call()
    for tangent in (None, lambda *_: oscillator.run()):
        loaded = looselink.load(OSCILLATOR).add_load(
            "push", "mass.pin", lambda *_: (0.0, 0.0) if tangent else loaded.run(), tangent and (lambda *_: loaded.run())
        )
        with pytest.raises(RecursionError, match="without end"):
            loaded.run()


def test_two_scenes_that_run_each_other_are_stopped():
    a, b = Nested(), Nested()
    first, second = pushed(a), pushed(b)
    a.act, b.act = lambda t: second.run(), lambda t: first.run()
    with pytest.raises(RecursionError, match="without end"):
        first.run()


def test_progress_that_runs_its_own_scene_is_stopped(oscillator):
    oscillator.set("simulation.duration", 1000.0).set("output.interval", 10.0).set("output.motion", False)

    def show(t, duration):
        oscillator.run(progress=show)

    def call():
        with pytest.raises(RecursionError, match="without end"):
            oscillator.run(progress=show)
        caught.append(True)

    # every level takes a tenth of a second: a small stack
    caught = []
    before = threading.stack_size(1 << 20)
    try:
        thread = threading.Thread(target=call)
        thread.start()
    finally:
        threading.stack_size(before)
    thread.join()
    assert caught


def test_a_scene_runs_itself_to_a_finite_depth():
    """The force of every level is the last x of the level below; the force of the lowest one is 1 N."""
    one_step = OSCILLATOR | {
        "simulation": {"duration": 0.02},
        "integrator": OSCILLATOR["integrator"] | {"step": 0.02},
        "output": {"interval": 0.02, "channels": ["*"]},
    }

    def with_force(force):
        return looselink.load(one_step | {"forces": OSCILLATOR["forces"] | {"push": PUSH | {"x": force}}})

    def force(t):
        nonlocal depth
        if depth == 3:
            return 1.0
        depth += 1
        try:
            return float(scene.run()["mass.x"][-1])
        finally:
            depth -= 1

    depth = 3
    scene = with_force(force)
    depth = 0
    expected = 1.0
    for _ in range(3):
        expected = float(with_force(expected).run()["mass.x"][-1])
    same_bits(scene.run(), with_force(expected).run())


def test_what_an_inner_run_raises_is_for_its_caller():
    def fail(t):
        if t > 0.05:
            raise ZeroDivisionError
        return 0.0

    inner = pushed(fail)

    def caught(t):
        with pytest.raises(ZeroDivisionError):
            inner.run()
        return 3.0

    scene = pushed(caught).set("simulation.duration", 0.02)
    same_bits(scene.run(), pushed(lambda t: 3.0).set("simulation.duration", 0.02).run())


def test_what_a_callable_raises_leaves_no_trace(oscillator):
    """A tangent that the modes ask for first: the exception is theirs, and not that of the next run."""

    def tangent(*_):
        raise ZeroDivisionError

    loaded = oscillator.copy().add_load("push", "mass.pin", lambda *_: (0.0, 0.0), tangent)
    with pytest.raises(ZeroDivisionError):
        loaded.modes()
    assert oscillator.run().status == "complete"
    assert oscillator.inspect()["unknowns"] == 3


def change_itself(scene):
    scene.set("integrator.step", 5e-4)


def change_in_a_thread(scene):
    thread = threading.Thread(target=change_itself, args=(scene,))
    thread.start()
    thread.join()


@pytest.mark.parametrize("change", [change_itself, change_in_a_thread])
@pytest.mark.parametrize("by", ["callable", "progress"])
def test_a_run_does_not_notice_changes_of_its_scene(change, by):
    """It has a copy of its own; the change is that of the next run."""
    function = Nested(1.0)
    scene = pushed(function)
    changed = []

    def act(*_):
        if not changed:
            changed.append(True)
            change(scene)

    progress = None
    if by == "callable":
        function.act = act
    else:
        scene.set("simulation.duration", 40.0).set("output.interval", 4.0)
        progress = act
    twin = scene.copy()
    run = scene.run(progress=progress)
    assert changed
    function.act = None
    same_bits(run, twin.run())
    assert run.summary["steps"] == twin.run().summary["steps"]
    assert scene.overrides[-1] == "integrator.step=0.0005"
    assert scene.run().summary["steps"] == 2 * run.summary["steps"]


def test_a_callable_reads_its_scene_while_it_is_checked():
    seen = []

    def read(t):
        seen.append((scene.title, scene.overrides, repr(scene), scene.copy().run().status))
        return 0.0

    scene = looselink.load(OSCILLATOR).set("forces.push", PUSH)
    before = scene.overrides
    scene.set("forces.push.x", read)
    assert seen == [("a mass on a spring", before, repr(scene).replace("2 overrides", "1 override"), "complete")]


@pytest.mark.parametrize("change", [change_itself, change_in_a_thread])
def test_a_change_during_a_change_is_refused(change):
    scene = looselink.load(OSCILLATOR).set("forces.push", PUSH)

    def function(t):
        change(scene)
        return 0.0

    with pytest.raises(RuntimeError, match="the scene was changed while it was being changed"):
        scene.set("forces.push.x", function)
    # the inner change holds, the outer one does not
    assert [text.split("=")[0] for text in scene.overrides] == ["forces.push", "integrator.step"]
    assert scene.run().status == "complete"


def test_a_callable_is_checked_once():
    calls = []
    scene = pushed(lambda t: calls.append(t) or 0.0)
    assert calls == [0.0]
    scene.set("integrator.step", 5e-4).add_load("load", "mass.pin", lambda *_: (0.0, 0.0))
    assert calls == [0.0]


def test_cycles_of_scenes_and_callables_are_freed():
    """Scenes, runs, copies and partial functions that refer to each other."""
    import functools

    def partial():
        scene = looselink.load(OSCILLATOR).set("forces.push", PUSH)
        function = functools.partial(lambda holder, t: 0.0, [scene])
        return scene.set("forces.push.x", function), function

    def closure():
        def function(t):
            return 0.0 if holder else 1.0

        holder = [True]
        scene = pushed(function)
        holder += [scene, scene.copy(), scene.run()]
        return scene, function

    def instance():
        function = Nested()
        function.scene = pushed(function)
        function.run = function.scene.run()
        function.run.summary["itself"] = function.run
        return function.scene, function

    for make in (partial, closure, instance):
        scene, function = make()
        freed = weakref.ref(function)
        gc.collect()
        assert freed() is function
        assert scene.run().status == "complete"
        del scene, function
        gc.collect()
        assert freed() is None, make.__name__


def test_the_garbage_collector_may_come_at_any_call():
    """Whatever refers to callables counts its reference once: nothing that is in use is freed."""
    function = Nested(2.0)
    function.scene = pushed(function).set("simulation.duration", 0.01)
    function.act = lambda t: gc.collect()
    copies = [function.scene.copy() for _ in range(3)]
    runs = [scene.run() for scene in copies]
    scene = function.scene
    del function, copies
    gc.collect()
    same_bits(runs[0], scene.run())
    assert "callable" in runs[1].view().html


class Resigning(Nested):
    def __del__(self):
        # deleting a callable may use the scene that has lost it
        self.scene.set("integrator.step", 5e-4)


def test_a_callable_that_is_replaced_is_freed_and_may_change_the_scene():
    function = Resigning()
    scene = function.scene = pushed(function)
    freed = weakref.ref(function)
    del function
    gc.collect()
    assert scene.set("forces.push.x", 1.0) is scene
    assert freed() is None
    assert scene.overrides[-1] == "integrator.step=0.0005"
    twin = looselink.load(OSCILLATOR).set("forces.push", PUSH | {"x": 1.0}).set("integrator.step", 5e-4)
    same_bits(scene.run(), twin.run())


@pytest.mark.parametrize("raised", [KeyboardInterrupt, SystemExit])
def test_what_ends_a_program_ends_the_run(raised, tmp_path):
    def end(t):
        if t > 0.1:
            raise raised
        return 0.0

    with pytest.raises(raised) as caught:
        pushed(end).run(out=tmp_path / "out")
    assert 0.08 < caught.value.run.t[-1] <= 0.1
    assert caught.value.run.status == "failed"


@dataclasses.dataclass(frozen=True)
class Frozen(Exception):
    t: float


def test_an_exception_that_cannot_be_changed_is_raised_as_it_is():
    """It has no `run`."""

    def end(t):
        if t > 0.1:
            raise Frozen(t)
        return 0.0

    with pytest.raises(Frozen) as caught:
        pushed(end).run()
    assert 0.1 < caught.value.t < 0.11


def test_a_generator_that_calls_itself_raises():
    def values():
        t = yield 0.0
        while True:
            if t > 0.1:
                generator.send(t)
            t = yield t

    generator = values()
    next(generator)
    with pytest.raises(ValueError, match="generator already executing"):
        pushed(generator.send).run()


def test_threads_run_scenes_with_callables():
    def work(k):
        inner = pushed(lambda t: t).set("simulation.duration", 0.02)

        def function(t):
            return k + inner.run()["mass.x"][-1]

        runs[k] = pushed(function).set("simulation.duration", 0.02).run()

    runs = {}
    threads = [threading.Thread(target=work, args=(k,)) for k in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    inner = pushed(lambda t: t).set("simulation.duration", 0.02).run()["mass.x"][-1]
    for k in range(4):
        same_bits(runs[k], pushed(lambda t: k + inner).set("simulation.duration", 0.02).run())


@pytest.mark.skipif(not hasattr(os, "fork"), reason="the system has no fork")
def test_a_forked_process_leaves_the_files_to_its_parent(tmp_path):
    """In a callable: the child raises OSError, and the files of the parent are those of a run without it."""
    program = """
        import os, sys
        from test_reentrance import pushed

        def function(t):
            global child
            if child is None and t > 0.1:
                child = os.fork()
                if child == 0 and sys.argv[2] == "exit":
                    sys.exit(7)
            return 0.0

        child = 0
        scene = pushed(function).set("output.interval", 1e-3)
        scene.run(out=sys.argv[1] + "/whole")
        child = None
        try:
            scene.run(out=sys.argv[1] + "/forked")
        except OSError as error:
            assert child == 0 and "its parent writes the result" in str(error), error
            assert len(error.run.t) > 90
            os._exit(7)
        _, status = os.waitpid(child, 0)
        assert os.waitstatus_to_exitcode(status) == 7
    """
    for how in ("go on", "exit"):
        folder = tmp_path / how
        folder.mkdir()
        done = subprocess.run(
            [sys.executable, "-c", textwrap.dedent(program), folder, how],
            cwd=os.path.dirname(__file__), capture_output=True, text=True, timeout=60,
        )
        assert done.returncode == 0, done.stderr
        for name in ("channels.csv", "motion.bin", "summary.json"):
            assert (folder / "whole" / name).read_bytes() == (folder / "forked" / name).read_bytes()
