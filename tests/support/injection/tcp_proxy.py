"""A TCP proxy between bus endpoints that delays or holds up what it forwards, one direction at a time."""

from __future__ import annotations

import asyncio
import random
import threading
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field

from tailor.tools.launch.hosting import free_endpoint
from tests.support.bus_system import address

POLL_S = 0.002  # of the release of delayed bytes
CHUNK = 65536


@dataclass
class Direction:
    """What happens to the bytes of one direction; may be changed at any time."""

    delay_s: float = 0.0
    jitter_s: float = 0.0  # uniform, added to the delay; bytes keep their order
    blocked: bool = False  # held back; forwarded in order when the direction is open again, as TCP does


@dataclass
class Proxy:
    """Connections to `endpoint` lead to the endpoint behind it."""

    endpoint: str
    to_router: Direction = field(default_factory=Direction)
    from_router: Direction = field(default_factory=Direction)

    def block(self, blocked=True, *, to_router=True, from_router=True):
        """Interrupt the chosen directions, or open them again."""
        if to_router:
            self.to_router.blocked = blocked
        if from_router:
            self.from_router.blocked = blocked

    def delay(self, delay_s, jitter_s=0.0):
        """Delay both directions."""
        for direction in (self.to_router, self.from_router):
            direction.delay_s, direction.jitter_s = delay_s, jitter_s


@contextmanager
def tcp_proxy(behind):
    """A proxy before the endpoint `behind`; it runs in a thread and ends with the block."""
    proxy, loop, ready = Proxy(free_endpoint()), asyncio.new_event_loop(), threading.Event()
    stop = asyncio.Event()
    thread = threading.Thread(target=loop.run_until_complete, args=(_serve(proxy, behind, stop, ready),))
    thread.start()
    try:
        assert ready.wait(10.0)
        yield proxy
    finally:
        loop.call_soon_threadsafe(stop.set)
        thread.join()
        loop.close()


async def _serve(proxy, behind, stop, ready):
    tasks = set()

    async def connect(reader, writer):
        tasks.add(asyncio.current_task())
        try:
            far_reader, far_writer = await asyncio.open_connection(*address(behind))
        except OSError:
            writer.close()
            return
        both = (
            _forward(reader, far_writer, proxy.to_router),
            _forward(far_reader, writer, proxy.from_router),
        )
        with suppress(asyncio.CancelledError):  # the proxy ends
            await asyncio.gather(*both, return_exceptions=True)

    server = await asyncio.start_server(connect, *address(proxy.endpoint))
    ready.set()
    await stop.wait()
    server.close()
    await asyncio.sleep(0)  # connections accepted just now become tasks
    for task in tasks:
        task.cancel()
    await asyncio.gather(*tasks, return_exceptions=True)


async def _forward(reader, writer, direction):
    """Forward until an end is closed; then close the other one, when everything before has been forwarded."""
    queue, loop, random_s = asyncio.Queue(), asyncio.get_running_loop(), random.Random(1)

    async def read():
        due = 0.0
        while True:
            data = await _read(reader)
            delay_s = direction.delay_s + random_s.uniform(0.0, direction.jitter_s)
            due = max(due, loop.time() + delay_s)
            queue.put_nowait((due, data))
            if not data:
                return

    reading = asyncio.ensure_future(read())
    try:
        while True:
            due, data = await queue.get()
            while direction.blocked or loop.time() < due:
                await asyncio.sleep(POLL_S)
            if not data:
                return
            writer.write(data)
            await writer.drain()
    finally:
        reading.cancel()
        writer.close()


async def _read(reader):
    try:
        return await reader.read(CHUNK)
    except OSError:  # reset by the other end
        return b""
