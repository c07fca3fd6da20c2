"""The viewer in a notebook."""

from __future__ import annotations

import html
from typing import Optional, Union
from urllib.parse import urlencode

from .errors import InvalidInput
from .information import SessionInfo
from .session import Session

#: Where a server on this machine has its viewer unless it is told otherwise.
DEFAULT_VIEWER = "http://127.0.0.1:9464"


class View:
    """A frame of the page that shows a session; a notebook shows it where it is the value of a cell."""

    def __init__(self, address: str, width: str, height: int) -> None:
        self.address = address  #: of the viewer's page
        self.width = width
        self.height = height

    def _repr_html_(self) -> str:
        address, width = html.escape(self.address), html.escape(self.width)
        return (
            f'<iframe src="{address}" style="width: {width}; height: {self.height}px; border: 0" allowfullscreen>'
            f'</iframe><br><a href="{address}" target="_blank">open alone</a>'
        )

    def __repr__(self) -> str:
        return f"<meniscus.View {self.address}>"


def show(
    session: Union[Session, SessionInfo],
    *,
    viewer: Optional[str] = None,
    color: Optional[str] = None,
    width: str = "100%",
    height: int = 400,
) -> View:
    """The session in the server's viewer, for a notebook.

    viewer: the viewer's page; None: that of the session's Server, otherwise http://127.0.0.1:9464. color: an attribute
    to color the surface by. The server must let the notebook's page show the viewer: a Server does so for Jupyter on
    this machine, another one with ``--web-frame-ancestors``. Raises InvalidInput for what is no session.
    """
    if not isinstance(session, (Session, SessionInfo)):
        given = repr(session)[:72]
        raise InvalidInput(
            f"session is {given}, must be a Session, or a SessionInfo as client.session_info(name) gives"
        )
    page = viewer or (session.viewer if isinstance(session, Session) else "") or DEFAULT_VIEWER
    if not page.startswith(("http://", "https://")):
        raise InvalidInput(f"viewer is {page!r}, must be the address of a page, such as {DEFAULT_VIEWER}")
    place = urlencode({"session": session.id, **({"color": color} if color else {})})
    return View(f"{page.rstrip('/')}/?embed#{place}", width, height)
