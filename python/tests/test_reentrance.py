"""Callables and progress that use the scene they belong to, and end in every way: never a crash, never a wrong result."""

import dataclasses
import os
import subprocess
import sys
import textwrap

import pytest
from conftest import OSCILLATOR
from test_callables import PUSH

import looselink


def pushed(function):
    """The oscillator with a force of time, whose check it calls as `function` before anything is armed."""
    return looselink.load(OSCILLATOR).set("forces.push", PUSH).set("forces.push.x", function)


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
