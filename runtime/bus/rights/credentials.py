"""What a session proves itself with: the password of a role, or the certificate of a name (mutual TLS)."""

from __future__ import annotations

from base64 import b64encode
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tailor.schemas.errors import UsageError

AUTHORITY, CERTIFICATE, PRIVATE_KEY = "authority.pem", "certificate.pem", "key.pem"


class UnfitKeyError(UsageError):
    """A key with which no session opens, whatever the bus allows."""


@dataclass(frozen=True, slots=True)
class Password:
    """A role and its password in one run."""

    user: str
    password: str

    def auth(self, dictionary: Path | None = None) -> dict[str, Any]:
        """zenoh's `transport/auth`; with a dictionary, others must prove themselves by it, too."""
        own = {"user": self.user, "password": self.password}
        return {"usrpwd": own | ({"dictionary_file": str(dictionary)} if dictionary else {})}


@dataclass(frozen=True, slots=True)
class Identity:
    """A certificate, its private key, and the authority that both sides trust (PEM files in one folder)."""

    folder: Path

    def listening(self) -> dict[str, Any]:
        """zenoh's `transport/link/tls` of a router: it refuses whoever has no certificate of the authority."""
        return self._files("listen") | self._files("connect")

    def connecting(self) -> dict[str, Any]:
        """zenoh's `transport/link/tls` of a client: it checks the name of the router."""
        return self._files("connect") | {"verify_name_on_connect": True}

    def embedded(self) -> dict[str, Any]:
        """As `connecting`, with the files' contents instead of their names."""
        names = {
            "root_ca_certificate": AUTHORITY,
            "connect_private_key": PRIVATE_KEY,
            "connect_certificate": CERTIFICATE,
        }
        contents = {
            f"{key}_base64": b64encode((self.folder / name).read_bytes()).decode() for key, name in names.items()
        }
        return contents | {"enable_mtls": True, "verify_name_on_connect": True}

    def _files(self, side: str) -> dict[str, Any]:
        return {
            "root_ca_certificate": str(self.folder / AUTHORITY),
            "enable_mtls": True,
            f"{side}_private_key": str(self.folder / PRIVATE_KEY),
            f"{side}_certificate": str(self.folder / CERTIFICATE),
        }


def identity_in(folder: str) -> Identity:
    """Identity whose files are in a folder.

    Raises:
      UsageError: One is missing.
    """
    for name in (AUTHORITY, CERTIFICATE, PRIVATE_KEY):
        if not (Path(folder) / name).is_file():
            options = "--host ADDRESS" if Path(folder).name == "router" else "--role ROLE"
            made = f"tailor keys new {Path(folder).name} {options}"
            raise UsageError(f"{folder}: no {name}, expected a folder that `{made}` made")
    return Identity(Path(folder).resolve())
