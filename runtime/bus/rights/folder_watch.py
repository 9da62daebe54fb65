"""Notices that the folder of a bus was removed: then nobody stops its robots from a shell any more, so the bus ends.

The end of a login session removes $XDG_RUNTIME_DIR, also below a bus that outlives the session, e.g. in tmux.
"""

from __future__ import annotations

from tailor.runtime.bus.rights.run_folder import SOCKET, VARIABLE, RunFolder, run_folder


class RunFolderWatch:
    """Watches the folder of a bus that runs. Who connects to an open bus needs none."""

    def __init__(self, endpoint: str) -> None:
        """`endpoint`: names the bus, whose folder has been made."""
        self._folder = run_folder(endpoint)
        self._run = self._folder.run
        self._secured = self._folder.secured

    def failure(self) -> str:
        """Failure of the bus if its folder lacks what a session needs, or ""."""
        if not self._secured or _is_whole(self._folder, self._run):
            return ""
        path = self._folder.path
        return f"failed: {path} was removed, so no `tailor estop` reaches the bus; expected it to stay, see {VARIABLE}"


def _is_whole(folder: RunFolder, run: tuple[int, int] | None) -> bool:
    return folder.run == run and folder.secured and (folder.path / SOCKET).exists()
