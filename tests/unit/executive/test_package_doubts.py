"""What the spec of a robot's package may name as its doubts."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tailor.executive import domains
from tailor.schemas.errors import UsageError
from tailor.schemas.installed import spec_of

GOOD = {"ball": lambda before, after: False}
UNKNOWN_TOPIC = {"bal": lambda before, after: False}
NO_FUNCTION = {"ball": 0.3}
NO_TABLE = ("ball",)


@pytest.fixture
def naming(monkeypatch):
    def name(attribute):
        spec = replace(spec_of("soccer"), doubts=f"{__name__}:{attribute}" if attribute else "")
        monkeypatch.setattr(domains, "spec_of", lambda _: spec)
        return domains.doubts("soccer")

    return name


def test_a_table_of_functions_by_topic_or_none(naming):
    assert naming("GOOD") is GOOD
    assert naming("") == {}


@pytest.mark.parametrize("wrong", ["UNKNOWN_TOPIC", "NO_FUNCTION", "NO_TABLE"])
def test_anything_else_is_refused_by_name(naming, wrong):
    with pytest.raises(UsageError, match=f"{wrong}': expected functions .before, after. by topic"):
        naming(wrong)


def test_robots_that_ship_doubt_topics_of_their_sensors():
    for name in ("soccer", "kitchen", "arm"):
        assert set(domains.doubts(name)) <= set(domains.load(name).sensors)
