"""The examples of the README run, one after the other, as a reader types them."""

import re
from pathlib import Path

import matplotlib
from conftest import TOP

README = Path(__file__).resolve().parents[1] / "README.md"


def test_the_examples_of_the_readme_run(tmp_path, monkeypatch):
    matplotlib.use("Agg")
    (tmp_path / "scenes").symlink_to(TOP / "scenes")
    monkeypatch.chdir(tmp_path)
    blocks = re.findall(r"^```python\n(.*?)^```$", README.read_text("utf-8"), re.DOTALL | re.MULTILINE)
    assert len(blocks) > 10
    # as a script: parts that start processes ask for it
    names = {"__name__": "__main__"}
    for block in blocks:
        exec(compile(block, str(README), "exec"), names)
    assert (tmp_path / "eccentricity.png").stat().st_size > 1000
    assert (tmp_path / "journal.html").exists()
    assert (tmp_path / "out/spring/summary.json").exists()
    assert (tmp_path / "out/clearance/sweep.json").exists()
    assert (tmp_path / "copied/sweep.parquet").exists()


def test_the_example_of_the_project_runs(tmp_path, monkeypatch):
    matplotlib.use("Agg")
    (tmp_path / "scenes").symlink_to(TOP / "scenes")
    monkeypatch.chdir(tmp_path)
    (block,) = re.findall(r"^```python\n(.*?)^```$", (TOP / "README.md").read_text("utf-8"), re.DOTALL | re.MULTILINE)
    exec(compile(block, "README.md", "exec"), {})
    assert (tmp_path / "force.png").stat().st_size > 1000
    assert (tmp_path / "out/slider-play/sweep.png").stat().st_size > 1000


def test_the_readme_names_everything():
    import looselink

    text = README.read_text("utf-8")
    for kind in (looselink.Scene, looselink.Run, looselink.View, looselink.SweepResult):
        for name in vars(kind):
            if not name.startswith("_") and name not in ("keys", "html"):
                assert re.search(rf"\b{name}\b", text), f"{kind.__name__}.{name}"


def test_the_example_of_the_package_runs(monkeypatch):
    import looselink

    monkeypatch.chdir(TOP)
    lines = [line[4:] for line in looselink.__doc__.splitlines() if line.startswith(">>> ")]
    assert lines
    exec("\n".join(lines), {})
