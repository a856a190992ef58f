"""Pickles and copies of scenes, runs and sweeps: the same numbers and texts, or a refusal that says why."""

import copy
import functools
import gc
import multiprocessing
import pickle
import subprocess
import sys
import weakref
from concurrent.futures import ProcessPoolExecutor

import cloudpickle
import numpy as np
import pytest
from conftest import OSCILLATOR, TOP
from test_callables import PUSH, same_bits

import looselink

# the first that reduces objects as the others do, and the last
PROTOCOLS = 2, pickle.HIGHEST_PROTOCOL


def ramp(t):
    return 3.0 * t


def power(n, t):
    return t**n


def drag(t, x, y, vx, vy):
    return -0.3 * vx, -0.3 * vy


def drag_tangent(t, x, y, vx, vy):
    return [[0, 0, -0.3, 0], [0, 0, 0, -0.3]]


class Controller:
    """A load that may know the scene that it is a part of."""

    def __init__(self, gain):
        self.gain = gain
        self.scene = None

    def __call__(self, t):
        return self.gain * t


def pushed(function):
    return looselink.load(OSCILLATOR).set("forces.push", PUSH).set("forces.push.x", function)


SCENES = {
    "plain": lambda: looselink.load(OSCILLATOR).set("title", "∂ of `a`"),
    "changed": lambda: looselink.load(TOP / "scenes/bouncing-journal.toml").set("simulation.duration", 0.05),
    "function": lambda: pushed(ramp),
    "instance": lambda: pushed(Controller(3.0)),
    "partial": lambda: pushed(functools.partial(power, 2)),
    "load": lambda: looselink.load(OSCILLATOR).add_load("drag", "mass.pin", drag, drag_tangent),
    "replaced": lambda: pushed(lambda t: 1.0).set("forces.push.x", ramp),
}

WAYS = {
    **{f"protocol {p}": functools.partial(lambda p, thing: pickle.loads(pickle.dumps(thing, p)), p) for p in PROTOCOLS},
    "python": lambda thing: pickle._loads(pickle._dumps(thing)),
    "cloudpickle": lambda thing: cloudpickle.loads(cloudpickle.dumps(thing)),
    "copy": copy.copy,
    "deepcopy": copy.deepcopy,
}


def same_scene(a, b):
    assert (a.name, a.title, a.text, a.overrides, repr(a)) == (b.name, b.title, b.text, b.overrides, repr(b))


def same_run(a, b):
    same_bits(a, b)
    assert (repr(a), str(a), a.channels, a.units, a.summary) == (repr(b), str(b), b.channels, b.units, b.summary)
    assert (a.status, a.warnings, a.notes) == (b.status, b.warnings, b.notes)
    assert list(a.onsets) == list(b.onsets)
    for name, column in a.onsets.items():
        assert column.dtype == b.onsets[name].dtype
        assert np.array_equal(column, b.onsets[name], equal_nan=column.dtype == float)
    for array in [*dict(b).values(), *b.onsets.values()]:
        assert not array.flags.writeable


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("make", SCENES)
def test_a_scene_comes_back_as_it_was(make, way):
    scene = SCENES[make]()
    twin = WAYS[way](scene)
    assert type(twin) is looselink.Scene and twin is not scene
    same_scene(scene, twin)
    same_run(scene.run(), twin.run())
    before = scene.overrides
    twin.set("title", "another").set("simulation.duration", 0.04)
    assert scene.overrides == before and scene.title != twin.title
    same_scene(scene.set("title", "another").set("simulation.duration", 0.04), twin)


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("make", ["changed", "load"])
def test_a_run_comes_back_as_it_was(make, way, tmp_path):
    run = SCENES[make]().run(out=tmp_path / "out")
    same_run(run, WAYS[way](run))
    assert run.view().html == WAYS[way](run).view().html
    # the files of a run are not those of its pickle
    stored = pickle.dumps(run)
    for file in (tmp_path / "out").iterdir():
        file.unlink()
    same_run(run, pickle.loads(stored))


def test_a_pickle_does_not_call_callables():
    calls = []

    class Counter(Controller):
        def __call__(self, t):
            calls.append(t)
            return 0.0

    scene = pushed(Counter(1.0))
    calls.clear()
    cloudpickle.loads(cloudpickle.dumps(scene))
    copy.deepcopy(scene)
    assert calls == []


def test_a_deep_copy_has_callables_of_its_own_and_a_copy_has_not():
    controller = Controller(3.0)
    scene, twin = pushed(controller), pushed(Controller(3.0))
    shared, own = copy.copy(scene), copy.deepcopy(scene)
    controller.gain = 5.0
    same_run(shared.run(), scene.run())
    same_run(own.run(), twin.run())


@pytest.mark.parametrize("way", [way for way in WAYS if way != "copy"])
@pytest.mark.parametrize("first", ["scene", "callable", "run"])
def test_callables_that_know_their_scene(first, way):
    controller = Controller(3.0)
    scene = controller.scene = pushed(controller)
    run = scene.run()
    run.summary["itself"] = run
    controller.run = run
    thing = {"scene": scene, "callable": controller, "run": run}[first]
    twin = WAYS[way](thing)
    known = {"scene": lambda: None, "callable": lambda: twin.scene, "run": lambda: twin.summary["itself"]}[first]()
    if first == "callable":
        assert known.set("integrator.step", 5e-4) is twin.scene is not scene
        assert twin.run.summary["itself"] is twin.run
    if first == "run":
        assert known is twin
    # the twins are freed as the others are
    freed = weakref.ref(twin) if first == "callable" else None
    del twin, known
    gc.collect()
    assert freed is None or freed() is None
    assert scene.run().status == "complete"


def test_scenes_that_share_a_callable_share_it_afterwards():
    controller = Controller(3.0)
    a, b, twin = pickle.loads(pickle.dumps([pushed(controller), pushed(controller), controller]))
    twin.gain = 5.0
    expected = pushed(Controller(5.0)).run()
    same_run(a.run(), expected)
    same_run(b.run(), expected)


def local():
    return lambda t: 3.0 * t


@pytest.mark.parametrize("dumps", [pickle.dumps, pickle._dumps, functools.partial(pickle.dumps, protocol=2)])
def test_a_callable_that_cannot_be_pickled_is_named(dumps):
    holding = Controller(3.0)
    holding.values = (k for k in range(10))
    for refused, why in ((local(), "lambda"), (holding, "generator"), (holding.__call__, "generator")):
        scene = pushed(ramp).add_load("drag", "mass.pin", drag, drag_tangent).set("forces.push.y", refused)
        with pytest.raises(pickle.PicklingError, match=rf"the callable of `forces\.push\.y` cannot be pickled: .*{why}"):
            dumps(scene)
    loaded = looselink.load(OSCILLATOR).add_load("drag", "mass.pin", drag, lambda *_: [[0, 0, -0.3, 0], [0, 0, 0, -0.3]])
    with pytest.raises(pickle.PicklingError, match=r"the callable of `forces\.drag`"):
        dumps([loaded])
    # in a table of load(), and in another scene that a callable knows
    scene = looselink.load(OSCILLATOR | {"forces": {"push": PUSH | {"x": local()}}})
    with pytest.raises(pickle.PicklingError, match=r"the callable of `forces\.push\.x`"):
        dumps(scene)
    controller = Controller(1.0)
    controller.scene = scene
    with pytest.raises(pickle.PicklingError, match=r"the callable of `forces\.push\.x`"):
        dumps(pushed(controller))
    # it can be copied, and pickled by what takes functions by value
    same_run(scene.run(), copy.deepcopy(scene).run())
    same_run(scene.run(), cloudpickle.loads(cloudpickle.dumps(scene)).run())
    # nothing is left behind by a refusal
    same_run(pushed(ramp).run(), pickle.loads(dumps(pushed(ramp))).run())


def test_a_run_is_pickled_without_a_scene_that_cannot_be():
    run = pushed(local()).run()
    twin = pickle.loads(pickle.dumps(run))
    same_run(run, twin)
    with pytest.raises(ValueError, match=r"pickled without its scene: the callable of `forces\.push\.x` cannot be pickled"):
        twin.view()
    assert cloudpickle.loads(cloudpickle.dumps(run)).view().html == run.view().html
    assert copy.deepcopy(run).view().html == run.view().html
    same_run(run, pickle.loads(pickle.dumps(twin)))


def test_a_pickle_of_another_version_is_refused(tmp_path, oscillator):
    version = looselink.__version__.encode()
    result = sweep_of(oscillator, tmp_path)
    for thing in (oscillator, oscillator.run(), result):
        stored = pickle.dumps(thing)
        assert stored.count(version) >= 1
        with pytest.raises(ValueError, match=r"written by version 9\.9\.9 of Looselink, and this is version"):
            pickle.loads(stored.replace(version, b"9.9.9"))


def test_what_is_no_pickle_is_refused(oscillator):
    make, (version,), parts = oscillator.__reduce__()
    for wrong in (None, (), parts[:3], (*parts[:3], None), (*parts[:3], (1,)), (1, *parts[1:])):
        with pytest.raises((TypeError, ValueError)):
            make(version).__setstate__(wrong)
    with pytest.raises(looselink.SceneError):
        make(version).__setstate__(("a", "format = 2", [], ()))
    with pytest.raises(RuntimeError, match="a content already"):
        oscillator.__setstate__(parts)
    for call in (lambda blank: blank.run(), lambda blank: blank.title, copy.deepcopy, pickle.dumps):
        with pytest.raises(RuntimeError, match="no content"):
            call(make(version))
    run = oscillator.run()
    make, (version,), state = run.__reduce__()
    for name in state:
        with pytest.raises((TypeError, ValueError, KeyError)):
            make(version).__setstate__({key: value for key, value in state.items() if key != name})
    with pytest.raises(RuntimeError, match="a content already"):
        run.__setstate__(state)
    for call in (len, str, list, lambda blank: blank["t"], lambda blank: blank.view(), copy.copy, copy.deepcopy, pickle.dumps):
        with pytest.raises(RuntimeError, match="no content"):
            call(make(version))
    # rows that are not those of the scene
    width, numbers = state["motion"]
    odd = make(version)
    odd.__setstate__(state | {"motion": (width + 1, numbers)})
    with pytest.raises(ValueError, match="not those of the scene"):
        odd.view()


def simulate(scene):
    return scene.run()


def step_of(scene):
    return scene.set("integrator.step", 5e-4)


def test_processes_of_a_pool():
    """Scenes go to processes of their own, and runs come back."""
    scenes = [pushed(Controller(float(k))) for k in range(4)]
    expected = [scene.run() for scene in scenes]
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(2, mp_context=context) as pool:
        for run, twin in zip(expected, pool.map(simulate, scenes)):
            same_run(run, twin)
        same_run(expected[1], pool.submit(scenes[1].run).result())
        assert pool.submit(step_of, scenes[0]).result().overrides[-1] == "integrator.step=0.0005"
        assert len(scenes[0].overrides) == 2
        with pytest.raises(pickle.PicklingError, match=r"the callable of `forces\.push\.x`"):
            pool.submit(simulate, pushed(local())).result()
        # exceptions come back with what they say and have
        with pytest.raises(looselink.SceneError) as fault:
            pool.submit(looselink.loads, "format = ", "mine").result()
        assert (fault.value.file, fault.value.line) == ("mine", 1)
        stiff = looselink.load(TOP / "scenes/stiff-spring-pendulum.toml").set("output.interval", 1e-2)
        stiff.set("integrator", {"method": "velocity_verlet", "step": 1e-2})
        with pytest.raises(looselink.RunError) as failed:
            pool.submit(simulate, stiff).result()
        assert failed.value.run.status == "failed" and len(failed.value.run.t) > 0
    with context.Pool(1) as pool:
        same_run(expected[2], pool.apply(simulate, (scenes[2],)))


def test_another_program_reads_it(tmp_path, oscillator):
    """A pickle in a file, without a scene in sight."""
    run = oscillator.run()
    file = tmp_path / "run.pickle"
    file.write_bytes(pickle.dumps((oscillator, run)))
    program = "import pickle, sys; scene, run = pickle.load(open(sys.argv[1], 'rb')); print(scene.run()['mass.x'].tobytes() == run['mass.x'].tobytes())"
    done = subprocess.run([sys.executable, "-c", program, file], capture_output=True, text=True, check=True)
    assert done.stdout == "True\n"


def sweep_of(scene, folder=None):
    stiffness = {"fields": ["forces.spring.stiffness"], "values": [100.0, 200.0], "unit": "N/m"}
    measures = {"x": {"of": "largest", "channels": ["mass.x"]}}
    return scene.sweep(parameters={"k": stiffness}, measures=measures, threads=1, out=folder)


def test_results_of_sweeps(tmp_path, oscillator, monkeypatch):
    monkeypatch.chdir(tmp_path)
    result = sweep_of(oscillator, "out")
    table = result.to_pandas()
    stored = pickle.dumps(result)
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    twin = pickle.loads(stored)
    assert twin.summary == result.summary and twin.to_pandas().equals(table)
    (twin.folder / "sweep.csv").unlink()
    with pytest.raises(FileNotFoundError, match="sweep.csv"):
        pickle.loads(stored).to_pandas()
    kept = sweep_of(oscillator)
    with pytest.raises(pickle.PicklingError, match="a sweep with `out` can be pickled"):
        pickle.dumps(kept)
    copies = [copy.copy(kept), copy.deepcopy(kept)]
    del kept
    gc.collect()
    for twin in copies:
        assert twin.to_pandas()["k [N/m]"].tolist() == [100.0, 200.0]
