"""Why a key does not believe the router at an address, in words: zenoh tells only that no session opens."""

from __future__ import annotations

import socket

from tailor.runtime.bus.rights.credentials import AUTHORITY, CERTIFICATE, PRIVATE_KEY, Identity

OTHER_HOST = (62, 64)  # OpenSSL's X509_V_ERR_HOSTNAME_MISMATCH and X509_V_ERR_IP_ADDRESS_MISMATCH


def fault_of_router(identity: Identity, host: str, port: int, timeout_s: float) -> str:
    """What is wrong with the certificate that answers at an address; empty: nothing, or nobody says.

    Args:
      identity: Key of this process, whose files are sound.
      host: Name or address that this process connects to.
      port: TCP port.
      timeout_s: For the connection, and for each step of the handshake.
    """
    import ssl  # loaded only where no session has opened

    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    try:
        context.load_verify_locations(identity.folder / AUTHORITY)
        context.load_cert_chain(identity.folder / CERTIFICATE, identity.folder / PRIVATE_KEY)
        with socket.create_connection((host, port), timeout_s) as plain:
            context.wrap_socket(plain, server_hostname=host).close()
    except ssl.SSLCertVerificationError as error:
        if error.verify_code in OTHER_HOST:
            return (
                f"the certificate there is not for {host}, expected one of the names or addresses that "
                "`tailor keys new router --host …` was given"
            )
        return f"the certificate there is not of {identity.folder / AUTHORITY}: {error.verify_message}"
    except OSError:  # also other errors of TLS: another program answers there, say
        return ""
    return ""
