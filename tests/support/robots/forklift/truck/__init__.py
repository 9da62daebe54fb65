"""A fork-lift truck on omnidirectional wheels: no name, message, feature or controller of it is one of Tailor's."""

from tailor.schemas.packages.spec import DomainSpec

SPEC = DomainSpec(
    name="warehouse",
    robot="truck-7",
    domain="truck.warehouse:Warehouse",
    driver="interface.toml",
    body="truck.simulator:Simulator",
    topics="truck.topics:TOPICS",
    sampler="truck.warehouse_tasks:Tasks",
    features="truck.feature_spaces:SPACES",
    scenarios="tasks",
    draw="truck.warehouse_tasks:draw",
)
