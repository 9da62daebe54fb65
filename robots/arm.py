"""Writing with the PowerCube arm."""

from __future__ import annotations

from tailor.schemas.packages.spec import DomainSpec

SPEC = DomainSpec(
    name="arm",
    robot="powercube",
    domain="tailor.executive.domains.arm:make",
    driver="tailor.simnodes.powercube:driver.toml",
    body="tailor.simnodes.powercube.body:PowerCubeBody",
    sampler="tailor.tools.lockstep.samplers.arm:ArmSampler",
    features="tailor.models.features.joints:SPACES",
    generator="tailor.executive.domains.arm.letters",
    scene="tailor.robots.arm_scene",
    models="tailor.models:zoo",
)
