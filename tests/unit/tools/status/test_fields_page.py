"""docs/deployment.md documents every field of `tailor status --json`."""

import json
import re
from dataclasses import asdict

from tailor.schemas.messages import ProcessState, ProcessStates
from tests.support.bus_system import ROOT
from tests.unit.tools.status.bus_feed import OTHER, Feed, driver

BY_NAME = {"realtime", "required", "unknown", "refused"}  # their keys are data


def names(value):
    """Names of all fields in a JSON value, at any depth."""
    if isinstance(value, list):
        return {name for item in value for name in names(item)}
    if not isinstance(value, dict):
        return set()
    return set(value) | {name for key, item in value.items() if key not in BY_NAME for name in names(item)}


def test_the_page_names_exactly_the_fields():
    feed = Feed()
    feed.put("processes", ProcessStates(0, (ProcessState("sim", 17, "running", 1, 0.1, "", OTHER),)))
    state = json.loads(json.dumps(asdict(feed.run(2.0, driver=driver("estopped")))))
    page = (ROOT / "docs" / "deployment.md").read_text(encoding="utf-8")
    table = page.partition("\n## Health\n")[2].partition("| field |")[2].partition("\n\n")[0]
    assert names(state) == set(re.findall(r"`([a-z_0-9]+)`", table))
