"""Surfaces as plain files, which any web host carries."""

from __future__ import annotations

import base64
import html
import http.client
import io
import os
import threading
import urllib.request
from typing import Any, Callable, Iterable, Iterator, Mapping, Optional, Union
from urllib.parse import urljoin, urlsplit

from . import _meniscus
from .errors import InvalidInput
from .frame import Frame
from .mesh import Mesh
from .options import names_text, option_texts
from .recording_file import RecordingFile
from .types import Real

_MANIFEST = "manifest.json"
#: Most bytes of a manifest, and seconds that a host may be silent.
_MOST_MANIFEST = 64 << 20
_SILENCE = 30
#: Most bytes of a publication that a notebook shows within itself.
_MOST_SHOWN = 50_000_000

Fetch = Callable[[str, int], bytes]


class Publication:
    """A surface as plain files, as ``meniscus publish`` and publish() write them; open() gives it.

    ``len()`` is the number of its frames, ``publication[i]`` one of them, and ``for frame in publication`` reads one
    after the other. Each file is held against its SHA-256. Raises InvalidInput for a file that was cut or changed. A
    notebook shows one of up to 50 MB that is the value of a cell.
    """

    def __init__(self, source: str, fetch: Fetch) -> None:
        self.source = source
        self._fetch = fetch
        self._lock = threading.Lock()
        self._segment: tuple[str, bytes] = ("", b"")
        self._raw = _meniscus.open_publication(source, fetch(_MANIFEST, _MOST_MANIFEST))
        self._info = self._raw.info()

    @property
    def name(self) -> str:
        """What people call it; "" where it has no name."""
        return str(self._info["name"])

    @property
    def length_unit(self) -> str:
        return str(self._info["length_unit"])

    @property
    def up_axis(self) -> str:
        """ "x", "y", "z" or "unspecified"."""
        return str(self._info["up_axis"])

    @property
    def settings(self) -> Optional[dict[str, Any]]:
        """The settings of the surface by name; None where they are not known."""
        settings: Optional[dict[str, Any]] = self._info["settings"]
        return settings

    @property
    def live(self) -> bool:
        """Whether more frames may come; refresh() finds them."""
        return bool(self._info["live"])

    @property
    def left_frames(self) -> int:
        """Frames before the first one here, which are no longer kept."""
        return int(self._info["left_frames"])

    @property
    def bytes(self) -> int:
        """Of all files but the manifest."""
        return int(self._info["bytes"])

    def refresh(self) -> None:
        """Reads the manifest again."""
        self._raw.refresh(self._fetch(_MANIFEST, _MOST_MANIFEST))
        self._info = self._raw.info()

    def frame(self, place: int) -> Frame:
        """The frame at the place, 0 to len() - 1."""
        count = len(self)
        if not 0 <= place < count:
            raise InvalidInput(f"{self.source}: there is no frame at the place {place}, but at 0 to {count - 1}")
        at = place + self.left_frames
        with self._lock:
            found = self._raw.segment_of(at)
            if found is None:
                raise InvalidInput(
                    f"{self.source}: the frame at the place {place} has left: refresh() says which are there"
                )
            name, size = found
            if self._segment[0] != name:
                self._segment = (name, self._fetch(name, size))
            return Frame(self._raw.frame(at, self._segment[1]))

    def __getitem__(self, place: int) -> Frame:
        if isinstance(place, int) and -len(self) <= place < len(self):
            return self.frame(place % len(self))
        raise IndexError(f"{self.source}: there is no frame at the place {place!r} of {len(self)}")

    def __len__(self) -> int:
        return int(self._info["frames"])

    def __iter__(self) -> Iterator[Frame]:
        return (self.frame(place) for place in range(len(self)))

    def single_page(self) -> str:
        """The viewer with all frames, as one page of HTML that opens without a server."""
        before, behind = _meniscus.single_page()
        files = [(_MANIFEST, _MOST_MANIFEST), *self._info["files"]]
        parts = (
            f'<script type="text/plain" data-file="{name}">'
            f"{base64.b64encode(self._fetch(name, size)).decode()}</script>\n"
            for name, size in files
        )
        return f"{before}{''.join(parts)}{behind}"

    def _repr_html_(self) -> str:
        if self.bytes > _MOST_SHOWN:
            return html.escape(f"{self!r}: more than {_MOST_SHOWN:,} bytes, which a notebook does not show")
        page = html.escape(self.single_page())
        return f'<iframe srcdoc="{page}" style="width: 100%; height: 400px; border: 0" allowfullscreen></iframe>'

    def __repr__(self) -> str:
        return f"<meniscus.Publication {self.source}: {len(self)} frames, {self.bytes:,} bytes>"


def open(source: Union[str, os.PathLike[str]]) -> Publication:
    """Opens a publication: a folder, or the address (http, https) of one or of its manifest.

    Files of an address are read when they are needed. Raises InvalidInput for what is no publication, for a file that
    is not there, and for an address that leads to another host.
    """
    text = os.fsdecode(source)
    if text.startswith(("http://", "https://")):
        return Publication(text, _from_address(text))
    folder = os.path.dirname(text) if os.path.basename(text) == _MANIFEST else text
    return Publication(text, _from_folder(folder))


def publish(
    frames: Union[Iterable[Union[Frame, Mesh]], RecordingFile, Publication],
    to: Union[str, os.PathLike[str]],
    *,
    name: str = "",
    up_axis: str = "",
    length_unit: str = "",
    frame_rate: Real = 25.0,
    keep: Optional[Real] = None,
    live: bool = False,
    page: bool = False,
    settings: Optional[Mapping[str, Any]] = None,
) -> Publication:
    """Writes frames as plain files to the folder ``to``, and returns the publication.

    frames: what gives frames of a server, a recording or a publication, published as they travelled; or meshes, encoded
    here, whose indices count from 0. frame_rate: how many are shown a second. keep: seconds of the newest frames that
    stay; None: all do. live: readers see the frames while they come, and that more may come. page: the viewer is put
    beside the files, so that the folder is a web site. settings: of the surface, for information; a recording's are
    known. A publication that is there goes on: frames that it has are passed over. Raises InvalidInput for other
    settings than those that are there.
    """
    if settings is None and isinstance(frames, (RecordingFile, Publication)):
        settings = frames.settings
    writer = _meniscus.make_publication_writer(
        os.fspath(to), _setting_texts(settings), name, up_axis, length_unit, live, None if keep is None else float(keep)
    )
    if page:
        _meniscus.write_site(os.fspath(to))
    seconds = 1.0 / float(frame_rate)
    for place, item in enumerate(frames):
        if isinstance(item, Mesh):
            if not writer.has(0, place):
                writer.add_mesh(item._raw, place, place * seconds, seconds)
        elif isinstance(item, Frame):
            if not writer.has(item.run_id, item.index):
                writer.add_frame(item._raw, seconds)
        else:
            raise InvalidInput(f"frames gave {item!r:.72}, must give a Frame or a Mesh each time")
    writer.finish()
    return open(to)


def _setting_texts(settings: Optional[Mapping[str, Any]]) -> Optional[dict[str, str]]:
    if settings is None:
        return None
    values = dict(settings)
    attributes = values.pop("attributes", ())
    texts = option_texts(values)
    texts["attribute"] = names_text(attributes)
    return texts


def _from_folder(folder: str) -> Fetch:
    def fetch(name: str, most: int) -> bytes:
        path = os.path.join(folder, name)
        try:
            with io.open(path, "rb") as file:
                return _bounded(file.read(most + 1), most, path)
        except OSError as error:
            raise InvalidInput(f"{path}: cannot be read: {error.strerror}") from None

    return fetch


class _NoOtherHost(urllib.request.HTTPRedirectHandler):
    """Follows redirects within a host, as from a folder's name to the same with a slash."""

    def redirect_request(self, req: Any, fp: Any, code: int, msg: str, headers: Any, newurl: str) -> Any:
        if urlsplit(newurl)[:2] != urlsplit(req.full_url)[:2]:
            raise InvalidInput(f"{req.full_url} leads to {newurl}, another host, which is not followed")
        return super().redirect_request(req, fp, code, msg, headers, newurl)


def _from_address(address: str) -> Fetch:
    opener = urllib.request.build_opener(_NoOtherHost)
    path = urlsplit(address).path
    manifest = address if path.endswith(".json") else urljoin(address.rstrip("/") + "/", _MANIFEST)

    def fetch(name: str, most: int) -> bytes:
        at = manifest if name == _MANIFEST else urljoin(manifest, name)
        try:
            with opener.open(at, timeout=_SILENCE) as answer:
                return _bounded(answer.read(most + 1), most, at)
        except (OSError, ValueError, http.client.HTTPException) as error:
            raise InvalidInput(f"{at}: cannot be read: {error}") from None

    return fetch


def _bounded(content: bytes, most: int, name: str) -> bytes:
    if len(content) > most:
        raise InvalidInput(f"{name}: it has more than the {most} bytes that are expected")
    return content
