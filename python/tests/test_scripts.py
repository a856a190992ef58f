"""The scripts run in a short form and leave their pictures."""

import os
import subprocess
import sys

import pytest
from conftest import TOP

SCRIPTS = sorted((TOP / "python/scripts").glob("*.py"))


def test_there_are_scripts():
    assert len(SCRIPTS) >= 3


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda script: script.stem)
def test_a_script_runs(script, tmp_path):
    (tmp_path / "scenes").symlink_to(TOP / "scenes")
    environment = os.environ | {"LOOSELINK_SHORT": "1", "MPLBACKEND": "Agg"}
    done = subprocess.run([sys.executable, script], cwd=tmp_path, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    picture = tmp_path / f"{script.stem}.png"
    assert picture.read_bytes().startswith(b"\x89PNG")
    assert picture.stat().st_size > 10_000
    # cells, as notebooks show them
    assert script.read_text("utf-8").count("# %%") > 4
