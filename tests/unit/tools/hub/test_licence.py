"""The licence of a robot's models is that of its package."""

from __future__ import annotations

from tailor.tools.hub import licence


def test_distributions_are_read_once_a_process(monkeypatch):
    reads = []
    monkeypatch.setattr(licence, "packages_distributions", lambda: reads.append(None) or {"tailor": ["tailor"]})
    licence._distributions.cache_clear()
    assert {licence.licence_of(robot) for robot in ("agilo", "powercube")} == {"apache-2.0"}
    assert len(reads) == 1
    licence._distributions.cache_clear()
