"""A layout for Foxglove: the run in 3D, the belief and the ticks over time, modes and actions, log and subgoals.

It names topics as recordings have them, so it fits recordings and bridges alike. `tailor scene --layout DOMAIN` writes
it.
"""

from __future__ import annotations

from typing import Any

from tailor.executive import domains
from tailor.schemas.topics import key_of

Panel = dict[str, Any]

MAX_VALUES = 9  # of the belief in one plot
ABOVE, ASIDE = {"distance": 7.0, "phi": 40.0, "thetaOffset": 90.0}, {"distance": 3.0, "phi": 80.0, "thetaOffset": 90.0}


def layout(domain: str) -> dict[str, Any]:
    """The layout of a domain's robot, JSON values.

    Raises:
      UsageError: There is no such domain.
    """
    loaded = domains.load(domain)
    robot = loaded.robot
    panels: dict[str, Panel] = {
        "3D!scene": _scene(robot, ABOVE if {"x (m)", "y (m)"} <= set(loaded.belief_names) else ASIDE),
        "Plot!belief": _plot(_belief_paths(robot, loaded.belief_names)),
        "Plot!durations": _plot(
            {f"{_topic('status', robot)}.action_{each}_s": f"action {each} (s)" for each in ("elapsed", "predicted")}
        ),
        "Plot!ticks": _plot({f"{_topic('tick', robot)}.{each}": each for each in ("work_ns", "lateness_ns")}),
        "StateTransitions!modes": _transitions(robot),
        "RosOut!log": {"topicToRender": _topic("log", robot), "minLogLevel": 1, "searchTerms": []},
        "RawMessages!subgoals": {"topicPath": _topic("subgoals", robot), "diffEnabled": False, "expansion": {}},
    }
    return {
        "configById": panels,
        "globalVariables": {},
        "userNodes": {},
        "playbackConfig": {"speed": 1},
        "layout": _arranged(),
    }


def _topic(name: str, robot: str) -> str:
    return f"/{key_of(name, robot)}"


def _scene(robot: str, camera: dict[str, float]) -> Panel:
    grid = {"visible": True, "layerId": "foxglove.Grid", "instanceId": "grid", "size": 10, "divisions": 10, "order": 1}
    return {
        "cameraState": {"perspective": True, "target": [0, 0, 0], "targetOffset": [0, 0, 0], "fovy": 45, **camera},
        "followMode": "follow-none",
        "followTf": "map",
        "scene": {"transforms": {"showLabel": True, "axisScale": 0.3}},
        "topics": {_topic(name, robot): {"visible": True} for name in ("scene", "scene_truth")},
        "transforms": {},
        "layers": {"grid": grid | {"frameId": "map", "color": "#88888880", "lineWidth": 1}},
    }


def _belief_paths(robot: str, names: tuple[str, ...]) -> dict[str, str]:
    status = _topic("status", robot)
    return {f"{status}.belief[{place}]": name for place, name in enumerate(names[:MAX_VALUES])}


def _plot(paths: dict[str, str]) -> Panel:
    rows = [
        {"value": path, "label": label, "enabled": True, "timestampMethod": "receiveTime"}
        for path, label in paths.items()
    ]
    return {"paths": rows, "xAxisVal": "timestamp", "isSynced": True, "showLegend": True, "legendDisplay": "floating"}


def _transitions(robot: str) -> Panel:
    status, driver = _topic("status", robot), _topic("driver", robot)
    paths = (f"{status}.mode", f"{status}.action", f"{driver}.mode")
    return {"paths": [{"value": path, "timestampMethod": "receiveTime"} for path in paths], "isSynced": True}


def _arranged() -> dict[str, Any]:
    """The scene on the left above the modes, all else on the right."""
    plots = _split("column", "Plot!belief", _split("column", "Plot!durations", "Plot!ticks", 50), 40)
    texts = _split("column", "RosOut!log", "RawMessages!subgoals", 50)
    left = _split("column", "3D!scene", "StateTransitions!modes", 78)
    return _split("row", left, _split("column", plots, texts, 60), 58)


def _split(direction: str, first: Any, second: Any, percentage: int) -> dict[str, Any]:
    return {"direction": direction, "first": first, "second": second, "splitPercentage": percentage}
