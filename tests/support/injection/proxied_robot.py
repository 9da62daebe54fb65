"""The stand-in robot with sensors that may fail, driven by the real executive through a proxy."""

import json
import time
from contextlib import ExitStack, contextmanager

from tailor.schemas.messages import ArmRequest, ExecStatus
from tests.support.bus_system import bus_system, outputs
from tests.support.injection.tcp_proxy import tcp_proxy
from tests.support.patience import wait_until


class Robot:
    """The stand-in robot with faulty sensors, driven by `tailor executive` from waypoint to waypoint."""

    def __init__(self, session, endpoint, start, folder, proxy):
        self.trace, self.rates, self.proxy = folder / "trace", folder / "rates", proxy
        self.statuses = session.inbox(["status"], "agilo")
        self.arming = session.publisher("arm_request", "agilo")
        self.status, self.seed = None, 0
        self._start, self._children = start, []
        start("tests.support.stand_ins.faulty_sim", endpoint, self.trace, self.rates)

    def sensors(self, **rates_hz):
        """Limits the rates of the named topics and no others."""
        new = self.rates.with_suffix(".new")
        new.write_text(json.dumps(rates_hz))
        new.replace(self.rates)

    def starts(self):
        """A new executive with another start, which people arm; the robot moves by now."""
        for child in self._children:
            child.kill()
        self.sensors()
        self.seed += 1
        arguments = ("--scenario", "waypoints", "--seed", self.seed, "--connect", self.proxy.endpoint)
        self._children = [self._start("tailor.tools.main", "executive", "soccer", *arguments)]
        self.status = None
        wait_until(self.asks_to_be_armed, "executive")
        wait_until(self.moves_or_is_armed_again, "robot moves")

    def asks_to_be_armed(self):
        """Whether the new executive is there and not armed yet; people arm it then."""
        self.poll()
        if self.status is None or not self.status.reason.startswith("driver not armed"):
            return False
        self.arms()
        return True

    def moves_or_is_armed_again(self):
        """A loaded machine may stop the robot as it starts, for want of commands: then people arm it again."""
        if not self.moves() and self.status.reason.startswith("driver not armed"):
            self.arms()
            time.sleep(0.2)
        return self.moves()

    def arms(self):
        """Arms the executive, as people do; without effect while it is armed."""
        self.arming.publish(ArmRequest(True, False, self.status.sender, 0))

    def poll(self):
        for sample in self.statuses.drain():
            if isinstance(sample.message, ExecStatus):
                self.status = sample.message
        return self.status

    def moves(self):
        return self.poll() and self.status.mode == "EXECUTING" and outputs(self.trace)[-1][1] > 0.2

    def stands(self, reason):
        return lambda: self.poll() and self.status.reason == reason and outputs(self.trace)[-1][1] == 0.0

    def stopped_s(self, since_s):
        return wait_until(
            lambda: next((at for at, v in outputs(self.trace) if at > since_s and v == 0.0), None), "zero"
        )


@contextmanager
def robot_in(folder):
    with ExitStack() as stack:
        session, endpoint, start = stack.enter_context(bus_system())
        yield Robot(session, endpoint, start, folder, stack.enter_context(tcp_proxy(endpoint)))
