"""The page of a run, in a notebook and in a file."""

import html
import re
import webbrowser

import pytest
from conftest import TOP

import looselink


def test_the_page_is_that_of_the_command_line(case3, program, tmp_path):
    run = case3.run(out=tmp_path / "out")
    program("view", tmp_path / "out")
    run.view().save(tmp_path / "own.html")
    assert (tmp_path / "own.html").read_bytes() == (tmp_path / "out/view.html").read_bytes()


def test_a_notebook_shows_the_page_in_a_frame(case3):
    view = case3.run().view(height=432)
    shown = view._repr_html_()
    frame = re.fullmatch(r'<iframe srcdoc="([^"]*)" width="100%" height="432" [^>]*></iframe>', shown)
    assert html.unescape(frame[1]) == view.html
    assert view.html.startswith("<!doctype html>")
    assert "http://" not in view.html.replace("http://www.w3.org/", "")


def test_a_browser_opens_a_file(case3, monkeypatch):
    opened = []
    monkeypatch.setattr(webbrowser, "open", opened.append)
    view = case3.run().view()
    path = view.open()
    assert opened == [f"file://{path}"]
    with open(path, encoding="utf-8") as file:
        assert file.read() == view.html


def test_a_failed_run_shows_how_far_it_came():
    scene = looselink.load(TOP / "scenes/stiff-spring-pendulum.toml")
    scene.set("integrator", {"method": "velocity_verlet", "step": 1e-2}).set("output.interval", 1e-2)
    with pytest.raises(looselink.RunError) as caught:
        scene.run()
    assert '"status":"failed"' in caught.value.run.view().html


def test_a_run_without_motion_has_no_page(case3):
    with pytest.raises(ValueError, match="no motion to show"):
        case3.set("output.motion", False).run().view()
