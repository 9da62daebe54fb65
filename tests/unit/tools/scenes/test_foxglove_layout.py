"""The layout for Foxglove: every panel shows a topic that exists, of a type that the panel takes, and a field of it."""

import json
import re
from pathlib import Path

import pytest

from tailor.schemas import messages as m
from tailor.schemas.topics import TOPICS, key_of
from tailor.schemas.typesystem import ros_type, typestore
from tailor.tools.main import main
from tailor.tools.scenes.foxglove_layout import layout

ROOT = Path(__file__).resolve().parents[4]
ROBOTS = {"soccer": "agilo", "arm": "powercube", "kitchen": "b21"}
TOPIC = re.compile(r"/[a-z0-9_/]+")


def strings(value):
    """All strings in a layout, keys included."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, dict):
        for key, each in value.items():
            yield from strings(key)
            yield from strings(each)
    elif isinstance(value, list):
        for each in value:
            yield from strings(each)


def type_at(ros_name, path):
    """Type of a field's value, found in the definitions that recordings carry."""
    for part in path:
        name, indexed, _ = part.partition("[")
        fields = dict(typestore().get_msgdef(ros_name).fields)
        assert name in fields, f"{ros_name} has no {name}"
        _, detail = fields[name]
        if indexed:
            (_, detail), _ = detail
        ros_name = detail if isinstance(detail, str) else detail[0]
    return ros_name


@pytest.mark.parametrize("domain", ROBOTS)
def test_every_path_leads_to_a_field_of_a_topic_that_exists(domain):
    topics = {f"/{key_of(name, ROBOTS[domain])}": topic for name, topic in TOPICS.items()}
    paths = [text for text in strings(layout(domain)["configById"]) if text.startswith("/")]
    assert len(paths) > 10
    for path in paths:
        key = TOPIC.match(path)[0]
        assert key in topics, path
        if path != key:
            leaf = type_at(ros_type(topics[key].type), path.removeprefix(f"{key}.").split("."))
            assert leaf in ("float64", "int64", "string"), (path, leaf)


@pytest.mark.parametrize("domain", ROBOTS)
def test_the_shipped_layouts_are_those_that_the_command_writes(domain):
    shipped = json.loads((ROOT / "examples" / "foxglove" / f"{domain}.json").read_text())
    assert shipped == layout(domain), f"run: tailor scene --layout {domain} -o examples/foxglove/{domain}.json"


@pytest.mark.parametrize("domain", ROBOTS)
def test_the_panels_show_topics_of_the_types_that_they_take(domain):
    panels = layout(domain)["configById"]
    types = {f"/{key_of(name, ROBOTS[domain])}": topic.type for name, topic in TOPICS.items()}
    assert {types[topic] for topic in panels["3D!scene"]["topics"]} == {m.SceneShapes}
    assert types[panels["RosOut!log"]["topicToRender"]] is m.LogLine
    assert m.LogLine.ROS_TYPE == "rcl_interfaces/msg/Log"


@pytest.mark.parametrize("domain", ROBOTS)
def test_every_panel_has_its_place_and_every_place_a_panel(domain):
    made = layout(domain)

    def leaves(node):
        return [node] if isinstance(node, str) else [*leaves(node["first"]), *leaves(node["second"])]

    assert sorted(leaves(made["layout"])) == sorted(made["configById"])


def test_the_command_writes_it(tmp_path, capsys):
    path = tmp_path / "arm.json"
    assert main(["scene", "--layout", "arm", "-o", str(path)]) == 0
    assert json.loads(path.read_text()) == layout("arm")
    assert main(["scene", "--layout", "nobody", "-o", str(path)]) == 2
    assert "no domain 'nobody'" in capsys.readouterr().err


def test_one_of_its_modes_has_to_be_named(capsys):
    assert main(["scene"]) == 2
    assert "--layout" in capsys.readouterr().err
