"""Sources that ask a server."""

from __future__ import annotations

import os

from .package import Refusal, meniscus_package
from .properties import path, text
from .source import Source

#: Seconds for a frame that is there, and for a server that does not answer.
PATIENCE = 10.0

CONNECTION = (
    text("Address", "Address", "HOST:PORT, HOST for port 50051, or unix:PATH", "127.0.0.1:50051")
    + path("TokenFile", "Token File", "With the token to call with. By default the variable MENISCUS_TOKEN is it.")
    + path("TlsCa", "TLS CA", "The authority's certificates, PEM: the connection is by TLS, then.")
    + path("TlsCert", "TLS Certificate", "Of this client, PEM, where the server asks for one.")
    + path("TlsKey", "TLS Key", "Of that certificate, PEM.")
    + text("TlsServerName", "TLS Server Name", "In the server's certificate; by default the host.", "",
           'panel_visibility="advanced"')
    + """
        <IntVectorProperty name="Insecure" command="SetInsecure" number_of_elements="1" default_values="0"
                           panel_visibility="advanced">
          <BooleanDomain name="bool"/>
          <Documentation>Let the token travel to another machine without TLS.</Documentation>
        </IntVectorProperty>"""
)  # fmt: skip


class ServerSource(Source):
    """A source that asks a server."""

    def __init__(self):
        super().__init__()
        self._address, self._token_file, self._tls_ca, self._tls_cert = "127.0.0.1:50051", "", "", ""
        self._tls_key, self._tls_server_name, self._insecure, self._session = "", "", 0, ""
        self._client = None

    def SetAddress(self, value):
        self._set("_address", value)

    def SetTokenFile(self, value):
        self._set("_token_file", value)

    def SetTlsCa(self, value):
        self._set("_tls_ca", value)

    def SetTlsCert(self, value):
        self._set("_tls_cert", value)

    def SetTlsKey(self, value):
        self._set("_tls_key", value)

    def SetTlsServerName(self, value):
        self._set("_tls_server_name", value)

    def SetInsecure(self, value):
        self._set("_insecure", value)

    def SetSession(self, value):
        self._set("_session", value)

    def forget(self):
        if self._client is not None:
            self._client.close()
        self._client = None

    def client(self):
        if self._client is None:
            self._client = meniscus_package().Client(
                self._address,
                tls_ca=self._tls_ca or None,
                tls_cert=self._tls_cert or None,
                tls_key=self._tls_key or None,
                tls_server_name=self._tls_server_name or None,
                token=self._token(),
                insecure=bool(self._insecure),
                timeout=PATIENCE,
            )
        return self._client

    def _token(self):
        if not self._token_file:
            return os.environ.get("MENISCUS_TOKEN") or None
        try:
            with open(self._token_file) as file:
                return file.read().strip()
        except (OSError, UnicodeDecodeError) as error:
            raise Refusal(f"the token file {self._token_file} cannot be read: {error}") from None


def chosen(wanted, things, name_of, what):
    """Those of the things that have this id or name; for "" all. name_of(thing): both. Raises Refusal where there are
    none."""
    found = [thing for thing in things if name_of(thing)[0] == wanted]
    found = found or [thing for thing in things if wanted in ("", name_of(thing)[1])]
    if not found and wanted:
        there = f"there are: {listed(things, name_of)}" if things else "there is none"
        raise Refusal(f"no {what} has the name or id {wanted!r}; {there}")
    if not found:
        raise Refusal(f"there is no {what}")
    return found


def listed(things, name_of):
    names = sorted(
        {"{0} ({1})".format(*name_of(thing)) if name_of(thing)[1] else name_of(thing)[0] for thing in things}
    )
    return ", ".join(names[:8]) + (", ..." if len(names) > 8 else "")
