"""The schema that editors check scenes against takes what the program reads, and refuses what it refuses."""

import json
import sys

import jsonschema_rs
import pytest
from conftest import TOP

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

FOLDERS = ["scenes", "verify/scenes", "crates/cli/templates"]
SCENES = {
    str(path.relative_to(TOP)): tomllib.loads(path.read_text("utf-8"))
    for folder in FOLDERS
    for path in sorted((TOP / folder).rglob("*.toml"))
}
BOTH = (TOP / "scenes/slider-crank/both.toml").read_text("utf-8")
# Tables whose keys are names that the user chooses; a star is such a name.
NAMED = {
    "assumptions",
    "bodies",
    "bodies.*.points",
    "contacts",
    "drives",
    "forces",
    "initial.bodies",
    "initial.sketch",
    "initial.sketch.*",
    "initial.velocities",
    "joints",
    "materials",
    "sections",
}


@pytest.fixture(scope="module")
def schema(program):
    return jsonschema_rs.Draft202012Validator(json.loads(program("schema", stream="stdout")))


def test_scenes_of_the_project_satisfy_the_schema(schema):
    for path, scene in SCENES.items():
        assert schema.validate(scene) is None, path
    assert len(SCENES) > 45


@pytest.mark.parametrize(
    "old, new",
    [
        ("duration = ", "length = "),
        ('type = "revolute"', 'type = "hinge"'),
        ('model = "flexible"', "model = 3"),
        ("density = ", "density = -"),
        ('method = "', 'method = "x'),
        ("[bodies.", "[body."),
        ("exponent = 1.5", "exponent = 0.9"),
        ("restitution = 0.9", "restitution = -0.1"),
        ("restitution = 0.9", "restitution = 1.1"),
        ("poissons_ratio = 0.3", "poissons_ratio = 0.6"),
        ("poissons_ratio = 0.3", "poissons_ratio = -1"),
        ("channels = [", "channels = [1, "),
    ],
)
def test_faults_of_scenes_violate_the_schema(schema, old, new):
    assert schema.is_valid(tomllib.loads(BOTH))
    assert old in BOTH
    assert not schema.is_valid(tomllib.loads(BOTH.replace(old, new, 1)))


def misspelt(schema, scene, table, path=()):
    """Misspells each key of a table and of the tables below it: the table, and whether the scene is still valid."""
    for key, value in list(table.items()):
        table[key + "x"] = table.pop(key)
        valid = schema.is_valid(scene)
        table[key] = table.pop(key + "x")
        yield ".".join(path), valid
        if isinstance(value, dict):
            yield from misspelt(schema, scene, value, (*path, "*" if valid else key))


def test_only_keys_that_the_user_chooses_may_be_misspelt(schema):
    tried = [one for scene in SCENES.values() for one in misspelt(schema, scene, scene)]
    refused = [table for table, valid in tried if not valid]
    assert {table for table, valid in tried if valid} == NAMED
    assert NAMED.isdisjoint(refused)
    assert len(refused) > 4000
