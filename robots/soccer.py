"""Robot soccer with AGILO."""

from __future__ import annotations

from tailor.schemas.packages.spec import DomainSpec

SPEC = DomainSpec(
    name="soccer",
    robot="agilo",
    domain="tailor.executive.domains.soccer:make",
    doubts="tailor.executive.domains.soccer.doubts:DOUBTS",
    driver="tailor.simnodes.agilo:driver.toml",
    body="tailor.simnodes.agilo.body:AgiloBody",
    topics="tailor.robots.soccer_topics:TOPICS",
    sampler="tailor.tools.lockstep.samplers.soccer:SoccerSampler",
    features="tailor.models.features.obstacle:SPACES",
    scenarios="tailor.executive.domains.soccer:scenarios",
    draw="tailor.executive.domains.soccer.scenario_sampling:sample_scenario",
    scene="tailor.robots.soccer_scene",
    models="tailor.models:zoo",
)
