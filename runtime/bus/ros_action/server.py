"""Server of the action: its requests to pursue or drop a goal are requests of the executive's loop like any other."""

from __future__ import annotations

from tailor.runtime.bus.ros_action.goals import UNKNOWN, ClientGoal, ClientGoals
from tailor.runtime.bus.ros_wires import RosCall
from tailor.runtime.bus.service import ACCEPTED, ServiceRequest
from tailor.runtime.bus.session import Session
from tailor.runtime.clock import wall_ns
from tailor.schemas.errors import Rejected
from tailor.schemas.messages import ExecStatus
from tailor.schemas.ros2 import action_messages as messages
from tailor.schemas.ros2.action import achieve_goal
from tailor.schemas.ros2.action_messages import CancelCode, GoalInfo, GoalResult, GoalState
from tailor.schemas.ros_time import wrapped_ns
from tailor.schemas.services import DROP

MAX_WAITING = 16  # requests for the result of an open goal
STATES_TICKS = 10  # once a second, for who subscribes later: ROS 2's own servers keep the last message for them


class GoalAction:
    """The action of one executive, whose loop serves its requests and reports to it once a tick.

    It has no effect in a plain profile.
    """

    def __init__(self, session: Session) -> None:
        """Declare its services and topics, if the session is part of ROS 2's graph."""
        self._goals = ClientGoals()
        self._waiting: list[tuple[ClientGoal, RosCall]] = []  # open goals, and who waits for their result
        self._declared = session.keys.announces
        if self._declared:
            messages.prime()
            parts = achieve_goal()
            self._results = session.ros_service(parts.get_result, self._result)
            self._cancels = session.ros_service(parts.cancel_goal, self._cancel)
            self._sent = session.ros_service(parts.send_goal, self._send)
            self._feedback, self._states = session.ros_publisher(parts.feedback), session.ros_publisher(parts.status)

    def receive(self) -> ServiceRequest | None:
        """Next request to pursue or to drop a goal."""
        return self._cancels.receive() or self._sent.receive() if self._declared else None

    def report(self, status: ExecStatus) -> None:
        """Take the status after a tick: feedback about the open goal, and results of those that have ended."""
        goal = self._goals.pursued
        if goal is not None:
            self._feedback.publish_encoded(messages.feedback_message(goal.info.id, status))
        if self._goals.report(status) or (self._goals and status.tick % STATES_TICKS == 0):
            self._publish()
        self.answer()

    def answer(self) -> None:
        """Answer the requests for results that have come, of an open goal when it has ended."""
        if self._declared:
            for _ in range(MAX_WAITING):
                self._results.receive()

    def close(self) -> None:
        """The executive ends: whoever waits for a result gets one."""
        if self._goals.end(GoalResult("stopped")):
            self._publish()
        self.answer()

    def _send(self, call: RosCall) -> ServiceRequest | None:
        sent = messages.sent_goal(call.data)
        if isinstance(sent, Rejected) or self._goals.get(sent[0]) is not None:
            call.respond(messages.sent_response(False, wall_ns()))
            return None
        goal = GoalInfo(sent[0], wrapped_ns(wall_ns()))  # as its client reads it, and names it to cancel

        def respond(accepted: bool, text: str) -> None:
            # ROS 2 has no reason for a rejected goal: one that is refused is accepted, and aborted with the cause.
            if not accepted:
                self._goals.abort(goal, GoalResult("refused", detail=text))
            elif text == ACCEPTED:
                self._goals.accept(goal)
            else:  # it had no condition: nothing is pursued, and the status is still that of the goal before
                self._goals.abort(goal, GoalResult("cancelled", detail=text))
            call.respond(messages.sent_response(True, goal.stamp_ns))
            self._publish()

        return ServiceRequest(sent[1], respond)

    def _cancel(self, call: RosCall) -> ServiceRequest | None:
        named = messages.goals_to_cancel(call.data)
        if isinstance(named, Rejected):
            call.respond(messages.cancel_response(CancelCode.REJECTED, ()))
            return None
        code, goal = self._goals.to_cancel(named)
        if goal is None:
            call.respond(messages.cancel_response(code, ()))
            return None

        def respond(accepted: bool, _: str) -> None:
            if accepted:
                goal.state = GoalState.CANCELING
                call.respond(messages.cancel_response(CancelCode.NONE, [goal.info]))
                self._publish()
            else:
                call.respond(messages.cancel_response(CancelCode.REJECTED, ()))

        return ServiceRequest(DROP, respond)

    def _result(self, call: RosCall) -> None:
        wanted = messages.requested_result(call.data)
        goal = None if isinstance(wanted, Rejected) else self._goals.get(wanted)
        if goal is None:
            call.respond(messages.result_response(GoalState.UNKNOWN, UNKNOWN))
        elif goal.open:
            self._wait(goal, call)
        else:
            call.respond(messages.result_response(goal.state, goal.result))

    def _wait(self, goal: ClientGoal, call: RosCall) -> None:
        """Let a call wait for the end of a goal; of too many the oldest does no longer: its client may be dead."""
        self._waiting.append((goal, call))
        if len(self._waiting) > MAX_WAITING:
            old, oldest = self._waiting.pop(0)
            oldest.respond(messages.result_response(old.state, old.result))

    def _publish(self) -> None:
        """Publish the states of the goals, and answer who waits for the result of one that has ended."""
        self._states.publish_encoded(messages.states_message((goal.info, goal.state) for goal in self._goals))
        waiting, self._waiting = self._waiting, []
        for goal, call in waiting:
            if goal.open:
                self._waiting.append((goal, call))
            else:
                call.respond(messages.result_response(goal.state, goal.result))
