#!/usr/bin/env python3
"""Runs every example of docs/scene.md and every scene for a few milliseconds: python3 checks/examples.py [DRIVER OPTION]..."""
import pathlib
import re
import subprocess
import sys
import tempfile
import tomllib

ROOT = pathlib.Path(__file__).resolve().parents[2]
DRIVER = ROOT / "reference-cpp/build/reference"
TABLES = ("initial",)  # their entries are tables of named entries themselves


def toml(value):
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'
    if isinstance(value, list):
        return "[" + ", ".join(map(toml, value)) + "]"
    if isinstance(value, dict):
        return "{ " + ", ".join(f'"{k}" = {toml(v)}' for k, v in value.items()) + " }"
    return repr(value)


def merged(base, change):
    """Each entry of the tables of `change` replaces that of the same name or is added."""
    result = {section: dict(entries) if isinstance(entries, dict) else entries for section, entries in base.items()}
    for section, entries in change.items():
        if isinstance(entries, dict):
            result.setdefault(section, {}).update(entries)
        else:
            result[section] = entries
    return result


def examples():
    base = None
    text = (ROOT / "docs/scene.md").read_text()
    for match in re.finditer(r"```toml\n(.*?)```", text, re.S):
        example = tomllib.loads(match.group(1))
        line = text.count("\n", 0, match.start()) + 2
        if "format" in example:
            base = base or example
        else:
            example = merged(base, example)
        yield f"docs/scene.md:{line}", "\n".join(f"{k} = {toml(v)}" for k, v in example.items()), 1.0


def scenes():
    for path in sorted((ROOT / "scenes").rglob("*.toml")):
        yield str(path.relative_to(ROOT)), path.read_text(), 0.005


failures = 0
for name, text, until in [*examples(), *scenes()]:
    with tempfile.NamedTemporaryFile("w", suffix=".toml") as file:
        file.write(text)
        file.flush()
        run = subprocess.run([DRIVER, file.name, "--until", str(until), *sys.argv[1:]], capture_output=True, text=True)
    lines = (run.stdout + run.stderr).strip().splitlines()
    failures += run.returncode != 0
    print(f"{name}: {' | '.join(lines[1:])}" if run.returncode == 0 else f"{name}: FAILED: {' | '.join(lines)}")
print(f"{failures} failures")
sys.exit(failures != 0)
