"""Scenes: reading, changing, faults."""

import copy
import json
import subprocess
import sys

import numpy as np
import pytest
from conftest import OSCILLATOR, TOP

import looselink


def fault(action, *arguments):
    with pytest.raises(looselink.SceneError) as caught:
        action(*arguments)
    return caught.value


def test_a_scene_is_read_from_a_path_a_text_and_a_dict():
    path = TOP / "scenes/pendulum.toml"
    text = path.read_text("utf-8")
    scenes = [looselink.load(path), looselink.load(str(path)), looselink.loads(text)]
    assert len({scene.title for scene in scenes}) == 1
    assert all(scene.text == text for scene in scenes)
    assert looselink.load(OSCILLATOR).title == OSCILLATOR["title"]
    assert "pendulum.toml" in repr(scenes[0])


def test_faults_have_the_text_of_the_command_line(program, monkeypatch, tmp_path):
    monkeypatch.chdir(TOP)
    path = "scenes/pendulum.toml"
    wrong = tmp_path / "wrong.toml"
    wrong.write_text('format = 1\ntitle = "no more"\n', "utf-8")
    for arguments, python in [
        (["check", "absent.toml"], lambda: looselink.load("absent.toml")),
        (["check", "scenes"], lambda: looselink.load("scenes")),
        (["check", wrong], lambda: looselink.load(wrong)),
        (
            ["check", path, "--set", "integrator.stp=1"],
            lambda: looselink.load(path).set("integrator.stp", 1),
        ),
        (
            ["check", path, "--set", "integrator.method=bath"],
            lambda: looselink.load(path).set("integrator.method", "bath"),
        ),
        (
            ["check", path, "--set", "output.channels=[\"no.such\"]"],
            lambda: looselink.load(path).set("output.channels", ["no.such"]).inspect(),
        ),
    ]:
        expected = program(*arguments, expect=2).rstrip()
        assert str(fault(python)) == expected


def test_a_fault_knows_its_place():
    text = 'format = 1\ntitle = "x"\nsimulation = { duration = -1.0 }\n'
    error = fault(looselink.loads, text, "mine.toml")
    assert (error.file, error.line, error.column) == ("mine.toml", 3, 27)
    assert fault(looselink.load, "absent.toml").line is None
    assert isinstance(error, ValueError)


def test_a_refused_change_leaves_the_scene(oscillator):
    oscillator.set("integrator.step", 5e-4)
    before = (oscillator.overrides, oscillator.run()["mass.x"].tobytes())
    for path, value in [("integrator.step", -1.0), ("no.such", 1), ("integrator.step", "fast")]:
        fault(oscillator.set, path, value)
    for value, kind in [(None, TypeError), ({1: 2}, TypeError), (object(), TypeError), (2**70, ValueError)]:
        with pytest.raises(kind, match="`?simulation.duration"):
            oscillator.set("simulation.duration", value)
    with pytest.raises(ValueError, match="has a `=`"):
        oscillator.set("integrator.step=1e-6", 1)
    assert (oscillator.overrides, oscillator.run()["mass.x"].tobytes()) == before


def test_values_of_python_and_numpy(oscillator):
    returned = (
        oscillator.set("integrator.step", np.float64(2e-3))
        .set("output.channels", np.array(["mass.x", "t"]))
        .set("output.motion", np.bool_(False))
        .set("bodies.mass.points.pin", np.array([0.1, 0.0]))
        .set("bodies.mass.points.end", (np.int64(1), 0))
        .set("integrator.method", "bathe")
        .set("title", 'a "quoted"\ttitle, \\ and ∂')
        .set("forces.push", {"type": "force", "point": "mass.end", "x": "2 * t", "y": 0, "frame": "ground"})
    )
    assert returned is oscillator
    assert oscillator.title == 'a "quoted"\ttitle, \\ and ∂'
    for title, told in [("deleted\x7f", "`title` holds U+007F, a control character"), ("of two\nlines", "`title` holds U+000A, a line feed")]:
        with pytest.raises(looselink.SceneError) as raised:
            oscillator.set("title", title)
        assert told in str(raised.value)
    # what a command line would have
    assert oscillator.overrides[0] == "integrator.step=0.002"
    assert oscillator.overrides[5] == "integrator.method=bathe"
    assert oscillator.run().channels == ["t", "mass.x"]


@pytest.mark.parametrize("value", [1e-5, 0.1 + 0.2, 5e-324, 1.7976931348623157e308, -0.0, 1e22])
def test_numbers_keep_their_bits(oscillator, value):
    path = "initial.bodies.mass.y"
    if value > 1e20:
        # the springs cannot be integrated there: what is written is enough
        assert float(oscillator.set(path, value).overrides[0].partition("=")[2]) == value
    else:
        start = oscillator.set(path, value).set("simulation.duration", 1e-2).run()["mass.y"][0]
        assert start == value


def test_copies_are_independent(oscillator):
    for other in (oscillator.copy(), copy.copy(oscillator)):
        other.set("title", "another")
        assert oscillator.title == OSCILLATOR["title"]
        assert other.title == "another"


def test_a_dict_and_its_text_are_the_same_scene(oscillator, tmp_path):
    path = tmp_path / "oscillator.toml"
    path.write_text(oscillator.text, "utf-8")
    a, b = oscillator.run(), looselink.load(path).run()
    assert a.channels == b.channels
    assert all(a[name].tobytes() == b[name].tobytes() for name in a)


def test_faults_of_a_dict_name_the_field():
    for change, message in [
        ({"simulation": {"duration": [1.0]}}, "`simulation.duration` must be a number"),
        ({"simulation": {"duration": 1.0, "gravty": [0, 0]}}, "unknown key `gravty` in simulation"),
        ({"forces": {"f": {"type": "force", "point": "mass.tip", "x": 1, "y": 0, "frame": "ground"}}}, "`tip`"),
    ]:
        assert message in str(fault(looselink.load, OSCILLATOR | change))
    with pytest.raises(TypeError, match="`bodies.mass.points.pin.1` .* NoneType"):
        looselink.load(OSCILLATOR | {"bodies": {"mass": {"points": {"pin": [0.0, None]}}}})
    with pytest.raises(TypeError, match="a path .* or from a dict"):
        looselink.load(3)


def test_inspection_is_that_of_the_command_line(program):
    path = TOP / "scenes/3rrr/case4.toml"
    shown = program("inspect", path, "--json", stream="stdout")
    assert looselink.load(path).inspect() == json.loads(shown)


def test_modes_of_a_mass_on_two_springs():
    scene = looselink.load(
        OSCILLATOR
        | {
            "bodies": {
                "ground": {"type": "ground", "points": {"left": [0.0, 0.0], "below": [0.5, -0.5]}},
                "mass": {"type": "point_mass", "mass": 2.0},
            },
            "forces": {
                name: {
                    "type": "spring_damper",
                    "from": f"ground.{end}",
                    "to": "mass.center",
                    "stiffness": stiffness,
                    "damping": 0.0,
                    "rest_length": 0.5,
                }
                for name, end, stiffness in [("a", "left", 200.0), ("b", "below", 800.0)]
            },
            "initial": {"bodies": {"mass": {"x": 0.5, "y": 0.0}}},
        }
    )
    modes = scene.modes()
    expected = [np.sqrt(stiffness / 2.0) / (2 * np.pi) for stiffness in (200.0, 800.0)]
    # springs at their rest length act along their lines alone: rounding of a 2x2 eigenvalue problem
    assert np.allclose([mode["frequency"] for mode in modes], expected, rtol=1e-9, atol=0)
    assert set(modes[0]["shape"]) == set(scene.inspect()["coordinates"])
    assert [mode["frequency"] for mode in scene.modes(count=1)] == [modes[0]["frequency"]]
    with pytest.raises(ValueError, match="outside the duration"):
        scene.modes(at=1.0)
    with pytest.raises(ValueError, match='"as-is", "open" or "ideal"'):
        scene.modes(contacts="shut")


def test_modes_are_those_of_the_command_line(program):
    path = TOP / "scenes/3rrr/case4.toml"
    scene = looselink.load(path)
    for contacts in ["as-is", "open", "ideal"]:
        arguments = ["--contacts", contacts, "--at", "0.001", "--count", "5", "--json"]
        shown = json.loads(program("modes", path, *arguments, stream="stdout"))
        assert scene.modes(at=0.001, contacts=contacts, count=5) == shown["modes"]


def test_the_package_is_imported_without_its_extras():
    code = "import sys, looselink; assert not {'pandas', 'polars', 'matplotlib'} & set(sys.modules)"
    subprocess.run([sys.executable, "-c", code], check=True)
