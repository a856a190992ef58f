"""Texts that could do harm are refused by their character, and no exception holds one that commands a terminal."""

import json
import sys
import unicodedata

import pytest
from conftest import OSCILLATOR, TOP

import looselink

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

CORPUS = tomllib.loads((TOP / "crates/cli/tests/hostile/corpus.toml").read_text(encoding="utf-8"))["texts"]
ESCAPE = "\x1b[2J\x07\x9b\u202e"
SHOWN = "U+001B[2JU+0007U+009BU+202E"

STUDY = """
title = "x"
scene = SCENE
parameters.x = { fields = ["bodies.bob.mass"], from = 1.0, to = 2.0, count = 2 }
measures.y = { of = "last", channels = ["bob.x"] }
"""


def harmless(text):
    kinds = {unicodedata.category(c) for c in text if c not in "\n\t"}
    return not kinds & {"Cc", "Zl", "Zp"} and "\u202e" not in text


@pytest.mark.parametrize("case", CORPUS, ids=lambda case: ascii(case["text"]))
def test_titles_are_refused_or_kept(case):
    title = case["text"]
    given = [lambda: looselink.load({**OSCILLATOR, "title": title}), lambda: looselink.load(OSCILLATOR).set("title", title)]
    if "refused" not in case:
        assert [read().title for read in given] == [title, title]
        return
    text = looselink.load(OSCILLATOR).text.replace("a mass on a spring", title)
    for read in [*given, lambda: looselink.loads(text)]:
        with pytest.raises(looselink.SceneError) as raised:
            read()
        assert harmless(str(raised.value)), str(raised.value)
        # in the text of a file a line feed ends a string, which is no TOML
        assert case["refused"] in str(raised.value) or case["refused"] == "U+000A" and read not in given


def test_exceptions_command_no_terminal(tmp_path):
    scene = looselink.load(OSCILLATOR)
    file = tmp_path / ESCAPE
    file.write_text("", "utf-8")
    study = tmp_path / "study.toml"
    study.write_text(STUDY.replace("SCENE", json.dumps(str(TOP / "scenes/pendulum.toml"))), "utf-8")
    for act in (
        lambda: looselink.load(tmp_path / f"{ESCAPE}.toml"),
        lambda: looselink.loads("format = ", name=ESCAPE),
        lambda: looselink.load({**OSCILLATOR, ESCAPE: object()}),
        lambda: scene.set(ESCAPE, object()),
        lambda: scene.set(f"forces.{ESCAPE}", {"type": "point_force"}),
        lambda: scene.run(out=file),
        lambda: looselink.sweep(tmp_path / f"{ESCAPE}.toml"),
        lambda: scene.sweep(parameters={ESCAPE: {}}, measures={}),
        lambda: scene.sweep(parameters={"x": {"fields": ["title"], "values": [ESCAPE]}}, measures={"m": {"of": ESCAPE}}),
        lambda: looselink.sweep(study, target=(ESCAPE, 1.0)),
    ):
        with pytest.raises((ValueError, TypeError, OSError)) as raised:
            act()
        assert harmless(str(raised.value)) and "U+001B" in str(raised.value), str(raised.value)
    named = looselink.loads(scene.text, name=ESCAPE)
    assert named.name == ESCAPE and SHOWN in repr(named)


def test_a_study_does_not_show_the_file_that_it_names(tmp_path):
    (tmp_path / "env").write_text("API_KEY=hunter2\n")
    study = tmp_path / "study.toml"
    study.write_text(STUDY.replace("SCENE", "'env'"), "utf-8")
    with pytest.raises(looselink.SceneError) as raised:
        looselink.sweep(study)
    assert "line 1" in str(raised.value) and "hunter2" not in str(raised.value) and "API_KEY" not in str(raised.value)
    assert raised.value.line == 1


def test_names_that_look_like_formulas_are_read_back():
    words = [case["text"] for case in CORPUS if "refused" not in case]
    scene = looselink.load(OSCILLATOR)
    result = scene.sweep(
        parameters={"=word": {"fields": ["title"], "values": words}, "-x": {"fields": ["forces.spring.damping"], "values": [1.0]}},
        measures={"@m": {"of": "last", "channels": ["mass.x"]}},
    )
    frame = result.to_pandas()
    assert list(frame["=word"]) == words
    assert {"-x", "@m [m]"} <= set(frame.columns)
    assert "'@m [m]" in (result.folder / "sweep.csv").read_text(encoding="utf-8")
