"""A cart on a rail with a gripper: two command outlets, messages from .msg files, a parameter with one value."""

from tailor.schemas.packages.spec import DomainSpec

SPEC = DomainSpec(
    name="depot",
    robot="porter-3",
    domain="porter.depot:Depot",
    body="porter.cart:Cart",
    messages="porter_msgs",
    topics="porter.topics:TOPICS",
    sampler="porter.tasks_of_depot:Tasks",
    features="porter.feature_spaces:SPACES",
    scenarios="tasks",
    draw="porter.tasks_of_depot:draw",
    scene="porter.looks",
)
