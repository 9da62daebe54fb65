"""Fetching cups in a kitchen with the B21."""

from __future__ import annotations

from tailor.schemas.packages.spec import DomainSpec

SPEC = DomainSpec(
    name="kitchen",
    robot="b21",
    domain="tailor.executive.domains.kitchen:make",
    doubts="tailor.executive.domains.kitchen.doubts:DOUBTS",
    driver="tailor.simnodes.b21:driver.toml",
    body="tailor.simnodes.b21.profiles:body",
    topics="tailor.robots.kitchen_topics:TOPICS",
    sampler="tailor.tools.lockstep.samplers.kitchen:KitchenSampler",
    features="tailor.models.features.kitchen.spaces:SPACES",
    scenarios="tailor.executive.domains.kitchen:scenarios",
    draw="tailor.executive.domains.kitchen.scenario_sampling:sample_scenario",
    scene="tailor.robots.kitchen_scene",
    models="tailor.models:zoo",
)
