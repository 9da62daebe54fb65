"""A client of the action that pursues a goal, in bytes that it builds itself, and a session that only it is on."""

import struct

from tailor.schemas.ros2.action import achieve_goal
from tailor.schemas.ros2.profiles import KeyProfile
from tailor.schemas.typesystem import from_bytes

HEADER = b"\0\1\0\0"  # CDR, little-endian
PARTS = achieve_goal()


def send_request(goal_id, goal):
    text = goal.encode() + b"\0"
    return HEADER + goal_id + struct.pack("<I", len(text)) + text


def result_request(goal_id):
    return HEADER + goal_id


def cancel_request(goal_id, stamp_ns=0):
    return HEADER + goal_id + struct.pack("<iI", *divmod(stamp_ns, 10**9))


class Call:
    """A call that waits for its response."""

    def __init__(self, part, data):
        self.part, self.data, self.responses = part, data, []

    def respond(self, response):
        self.responses.append(from_bytes(response, f"{getattr(PARTS, self.part).type}_Response")[0])

    @property
    def response(self):
        (response,) = self.responses
        return response


class ClientSession:
    """A session on which calls wait until they are polled, and everything is heard."""

    keys = KeyProfile("rmw_zenoh", 0)

    def __init__(self):
        self.waiting, self._heard = {}, {}

    def ros_service(self, named, read):
        calls = self.waiting[named] = []
        return Source(calls, read)

    def ros_publisher(self, named):
        return Heard(self._heard.setdefault(named, []))

    def call(self, part, data):
        """Call one of the services; it is served when the server is polled."""
        call = Call(part, data)
        self.waiting[getattr(PARTS, part)].append(call)
        return call

    @property
    def feedback(self):
        """Ids and feedback that were published."""
        ros = [from_bytes(data, PARTS.feedback.type)[0] for data in self._heard[PARTS.feedback]]
        return [(bytes(each.goal_id.uuid), each.feedback) for each in ros]

    @property
    def published_states(self):
        """How often the states were published."""
        return len(self._heard[PARTS.status])

    @property
    def states(self):
        """States by id, as published last."""
        ros = from_bytes(self._heard[PARTS.status][-1], PARTS.status.type)[0]
        return {bytes(each.goal_info.goal_id.uuid): each.status for each in ros.status_list}


class Source:
    def __init__(self, calls, read):
        self._calls, self._read = calls, read

    def receive(self):
        return self._read(self._calls.pop(0)) if self._calls else None


class Heard:
    def __init__(self, published):
        self.publish_encoded = published.append
