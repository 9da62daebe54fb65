"""A person and an executive at a robot's driver: armed when it is ready, driven to the goal."""

from tailor.schemas.messages import ArmRequest
from tests.support.patience import wait_until

LONG_S = 240.0  # a scenario takes 20 s on a quiet machine


def newest(inbox, matches=lambda message: True):
    """The newest message that matches, or None."""
    return next((sample.message for sample in reversed(inbox.drain()) if matches(sample.message)), None)


def ready(session, robot):
    """Waits for a driver that can be armed."""
    states = session.inbox(["driver"], robot)
    return wait_until(lambda: newest(states, lambda m: "not ready" not in m.detail), "driver is ready")


def executive_on(start, endpoint, domain, scenario, *flags):
    """Starts an executive that ends with the goal."""
    flags = ("--scenario", scenario, "--once", "--connect", endpoint, *flags)
    return start("tailor.tools.main", "executive", domain, *flags)


def arm(session, robot):
    """Arms the driver for the executive that is heard."""
    statuses, states = session.inbox(["status"], robot), session.inbox(["driver"], robot)
    requests = session.publisher("arm_request", robot)
    sender = wait_until(lambda: next((sample.sender for sample in statuses.drain()), None), "executive")

    def armed():
        requests.publish(ArmRequest(True, False, sender, 0))
        return newest(states, lambda m: m.mode == "armed" and m.armed_sender == sender)

    wait_until(armed, "armed")


def achieved(executive):
    """Whether the executive reaches its goal."""
    wait_until(lambda: executive.exit_code() is not None, "goal", LONG_S)
    return executive.exit_code() == 0
