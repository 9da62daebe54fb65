"""Folder of one running bus: its local socket and the passwords of this run, readable by the user who started it.

Processes of the same user find it by the bus's endpoint. Whoever cannot read it opens no session. If TAILOR_RUN_DIR is
set, as for a service, the group of that folder may read it as well.
"""

from __future__ import annotations

import os
import re
import socket
import stat
import tempfile
from dataclasses import dataclass
from pathlib import Path

from tailor.schemas.errors import UsageError
from tailor.schemas.ros2.profiles import PLAIN, PROFILES, KeyProfile

VARIABLE = "TAILOR_RUN_DIR"  # replaces the folder of all runs, e.g. with a service's /run/tailor
SOCKET, USERS, LOCK, CERTIFICATE_USERS = "bus.sock", "users", "lock", "certificate-users"
PROFILE = "key-profile"
CERTIFICATE_USER = "certificate:none"
GATEWAY = "gateway"  # user of the process that listens for other machines; it has applied the access rules already


@dataclass(frozen=True, slots=True)
class RunFolder:
    """One bus on this machine.

    Attributes:
      path: The folder.
    """

    path: Path

    @property
    def socket_endpoint(self) -> str:
        """zenoh's endpoint of the local socket."""
        return f"unixsock-stream/{self.path / SOCKET}"

    @property
    def users_file(self) -> Path:
        """zenoh's dictionary of users and passwords; missing on an open bus."""
        return self.path / USERS

    @property
    def certificate_users_file(self) -> Path:
        """zenoh's dictionary where a certificate decides; its password is no secret."""
        return self.path / CERTIFICATE_USERS

    @property
    def secured(self) -> bool:
        """Whether the bus runs with passwords."""
        return self.users_file.exists()

    def running(self) -> bool:
        """Whether a router of this bus listens on this machine.

        False for a folder in a place where everybody may make one, if it is not ours: another user's router there
        would take our e-stops, and report them as done.
        """
        if _named() is None and not all(is_private(each) for each in (self.path.parent, self.path)):
            return False
        with socket.socket(socket.AF_UNIX) as probe:
            probe.setblocking(False)
            try:
                probe.connect(str(self.path / SOCKET))
            except BlockingIOError:  # a router that stands still: as many wait for it as may, and one more never ends
                return True
            except OSError:
                return False
        return True

    @property
    def run(self) -> tuple[int, int] | None:
        """What tells one run of this bus from the next, whose passwords are others; None if its folder is gone."""
        try:
            status = (self.path / PROFILE).stat()  # every run writes it anew
        except OSError:
            return None
        return status.st_ino, status.st_mtime_ns

    def key_profile(self) -> KeyProfile:
        """Keys of this bus; the plain ones if its folder does not name any."""
        try:
            profile, domain = (self.path / PROFILE).read_text().split()
        except (OSError, ValueError):
            return PLAIN
        return next((KeyProfile(each, int(domain)) for each in PROFILES if each == profile), PLAIN)

    def password(self, user: str) -> str | None:
        """Password of a role in this run; None on an open bus.

        Raises:
          UsageError: The bus has passwords, but none for this role or none that this user may read.
        """
        try:
            lines = self.users_file.read_text().splitlines()
        except FileNotFoundError:
            return None
        except OSError as error:
            raise UsageError(f"{self.users_file}: {error.strerror}, expected a bus of the same user") from error
        found = dict(line.split(":", 1) for line in lines).get(user)
        if found is None:
            raise UsageError(f"{self.users_file}: no password for the role {user}")
        return found


def run_folder(endpoint: str) -> RunFolder:
    """Folder of the bus that listens at `endpoint`, whether it runs or not."""
    return RunFolder(_base() / re.sub(r"[^A-Za-z0-9.]+", "-", endpoint).strip("-"))


def _base() -> Path:
    return _named() or Path(tempfile.gettempdir()) / f"tailor-{os.getuid()}"


def _named() -> Path | None:
    """The folder of all runs that the environment names; the XDG specification ignores a path that is not absolute.

    A relative one would be another folder, with other passwords, for a command that is started elsewhere.
    """
    if os.environ.get(VARIABLE):
        return Path(os.environ[VARIABLE])
    session = Path(os.environ.get("XDG_RUNTIME_DIR", ""))
    return session / "tailor" if session.is_absolute() else None


def is_private(path: Path) -> bool:
    """Whether it is a folder of this user or root, no link, that nobody else may write."""
    try:
        status = path.lstat()
    except OSError:
        return False
    return stat.S_ISDIR(status.st_mode) and status.st_uid in (0, os.getuid()) and not status.st_mode & 0o022
