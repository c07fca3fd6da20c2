"""Calls about files and servers. ``place`` has client, session, stream, mesh, reconstructor, and folder."""

import uuid

import meniscus

from .table import wrong

Bad, Server = meniscus.InvalidInput, meniscus.ServerError
nan, inf = float("nan"), float("inf")
nobody = str(uuid.UUID(int=5))


def _connect(*address, **options):
    return lambda place: meniscus.Client(*address, **options)


ADDRESSES = [
    wrong("address: empty", _connect(""), Bad, "address is empty", "HOST:PORT"),
    wrong("address: None", _connect(None), Bad, "."),
    wrong("address: a number", _connect(50051), Bad, "."),
    wrong("address: bytes that are no text", _connect(b"\xff\xff"), Bad, "."),
    wrong("address: none", _connect(), TypeError, "address"),
    wrong("address: a port of letters", _connect("localhost:grpc"), Bad, "localhost:grpc", "port"),
    wrong("address: port 0", _connect("localhost:0"), Bad, "localhost:0", "1 to 65535"),
    wrong("address: port 65536", _connect("localhost:65536"), Bad, "65536", "1 to 65535"),
    wrong("address: IPv6 without brackets", _connect("::1:50051"), Bad, "brackets"),
    wrong("address: a zero byte", _connect("localhost\0:1"), Bad, "zero byte"),
    wrong("address: a surrogate", _connect("\ud800:1"), (Bad, Server, UnicodeEncodeError), "."),
    wrong("address: nobody listens", _connect("127.0.0.1:1"), Server, "127.0.0.1:1"),
    wrong("address: no socket", _connect("unix:/nowhere/at/all"), Server, "/nowhere/at/all"),
    wrong("address: a path too long", _connect("unix:/" + "a" * 200), (Bad, Server), "a"),
    wrong("address: no such host", _connect("nowhere.invalid:1", timeout=5), Server, "nowhere.invalid", "be resolved"),
    wrong("address: of a page", _connect("http://127.0.0.1:9464"), Bad, "http://127", "HOST:PORT alone", "50051"),
    wrong("address: of a page with TLS", _connect("HTTPS://water.example/"), Bad, "HTTPS://water", "HOST:PORT alone"),
]

CONNECTIONS = {
    "tls_ca that is not there": ({"tls_ca": "/nowhere.pem"}, Bad, "/nowhere.pem", "PEM"),
    "tls_ca that is a folder": ({"tls_ca": "/"}, Bad, "PEM"),
    "tls_ca of another type": ({"tls_ca": object()}, Bad, "tls_ca"),
    "tls_cert without key": ({"tls_ca": "/etc/hosts", "tls_cert": "/etc/hosts"}, Bad, "."),
    "tls_cert without CA": ({"tls_cert": "/a.pem", "tls_key": "/a.key"}, Bad, "."),
    "token with a line": ({"token": "a\nb"}, Bad, "token", "ASCII"),
    "token with an umlaut": ({"token": "ä"}, Bad, "token", "ASCII"),
    "token to another machine": ({"token": "secret"}, Bad, "token", r"\(tls_ca, insecure\)"),
    "timeout negative": ({"timeout": -1}, Bad, "timeout", "-1"),
    "timeout NaN": ({"timeout": nan}, Bad, "timeout"),
    "timeout infinite": ({"timeout": inf}, Bad, "timeout"),
    "timeout text": ({"timeout": "soon"}, Bad, "timeout", "soon"),
    "wait negative": ({"wait": -0.5}, Bad, "wait", "-0.5"),
    "wait object": ({"wait": object()}, Bad, "wait"),
    "insecure text": ({"insecure": "maybe"}, Bad, "insecure", "true or false"),
    "unknown": ({"tls": True}, TypeError, "tls"),
}

SESSIONS = {
    "id no UUID": ({"id": "dam"}, Bad, "dam", "UUID"),
    "id empty": ({"id": ""}, (), "."),
    "id number": ({"id": 5}, Bad, "5"),
    "id object": ({"id": object()}, Bad, "id"),
    "name empty": ({"name": ""}, (), "."),
    "name of 65": ({"name": "n" * 65}, Bad, "name", "64"),
    "name with a control": ({"name": "a\nb"}, Bad, "name"),
    "name object": ({"name": object()}, Bad, "name"),
    "up_axis unknown": ({"up_axis": "w"}, Bad, "up_axis", "w", "x", "y", "z"),
    "up_axis number": ({"up_axis": 1}, Bad, "up_axis"),
    "length_unit of 17": ({"length_unit": "u" * 17}, Bad, "unit", "16"),
    "ephemeral text": ({"ephemeral": "no"}, Bad, "ephemeral", "true or false"),
    "of the machine": ({"threads": 2}, Bad, "threads"),
    "unknown": ({"nme": "dam"}, Bad, "nme", "name"),
}

STREAMS = {
    "meshes text": ({"meshes": "no"}, "meshes", "true or false"),
    "normal_bits 1": ({"normal_bits": 1}, "normal.bits", "2 to 16"),
    "normal_bits 17": ({"normal_bits": 17}, "normal.bits", "2 to 16"),
    "normal_bits negative": ({"normal_bits": -8}, "-8"),
    "normal_bits fraction": ({"normal_bits": 8.5}, "normal_bits", "8.5"),
    "normals_by unknown": ({"normals_by": "nobody"}, "normals_by", "nobody", "server or receiver"),
    "codec unknown": ({"codec": "zip"}, "codec", "zip", "entropy, packed or draco"),
    "attributes None": ({"attributes": None}, "attribute"),
    "attributes of numbers": ({"attributes": [3]}, "attribute name 3"),
    "attributes of a colon": ({"attributes": "age:3"}, "'age:3'"),
    "attributes with many bits": ({"attributes": {"age": 17}}, "17", "1 to 16"),
    "attributes with negative bits": ({"attributes": {"age": -1}}, "-1", "1 to 16"),
    "attributes with bits of no number": ({"attributes": {"age": "many"}}, "age|many|bits"),
    "attributes twice": ({"attributes": ["age", "age"]}, "age", "twice"),
    "attribute_bits 17": ({"attribute_bits": 17}, "attribute_bits", "17", "1 to 16"),
    "attribute_bits text": ({"attribute_bits": "many"}, "attribute_bits", "many"),
    "spray text": ({"spray": "all"}, "spray", "true or false"),
    "waiting_limit negative": ({"waiting_limit": -1}, "waiting_limit", "-1"),
    "policy unknown": ({"policy": "newest"}, "policy", "newest", "latest", "every-frame"),
    "nth zero": ({"policy": "every-nth", "nth": 0}, "nth"),
    "reconnect negative": ({"reconnect": -1}, "reconnect", "-1"),
    "reconnect NaN": ({"reconnect": nan}, "reconnect"),
    "reconnect None and unknown": ({"reconnect": None, "retries": 3}, "retries"),
    "route_check text": ({"route_check": "often"}, "route_check", "often"),
    "on_reconnect no function": ({"on_reconnect": 5}, "."),
    "of a watcher": ({"max_level": 2}, "max_level"),
}

WATCHERS = {
    "max_level 0": ({"max_level": 0}, "level", "0", "1 to 3|1, 2"),
    "max_level 4": ({"max_level": 4}, "level", "4", "1 to 3|1, 2"),
    "max_level fraction": ({"max_level": 1.5}, "max_level", "1.5"),
    "normal_bits 20": ({"normal_bits": 20}, "normal.bits", "20"),
    "normals_by number": ({"normals_by": 1}, "normals_by", "server or receiver"),
    "position_bits 0": ({"position_bits": 0}, "position.bits", "0"),
    "position_bits 40": ({"position_bits": 40}, "position.bits", "40"),
    "codec number": ({"codec": 1}, "codec", "entropy, packed or draco"),
    "region of a number": ({"region": 1.0}, "region", "6 numbers"),
    "region upside down": ({"region": ((1, 1, 1), (0, 0, 0))}, "region", "1 to 0"),
    "region NaN": ({"region": ((0, 0, 0), (1, 1, nan))}, "region", "finite"),
    "viewpoint of two": ({"viewpoint": (1, 2)}, "viewpoint", "3 numbers"),
    "viewpoint NaN": ({"viewpoint": (nan, 0, 0)}, "viewpoint"),
    "bytes_per_second negative": ({"bytes_per_second": -1}, "bytes_per_second|bytes per second", "-1"),
    "spray number": ({"spray": 2}, "spray", "true or false"),
    "attributes with many bits": ({"attributes": {"age": 99}}, "99", "1 to 16"),
    "reconnect text": ({"reconnect": "yes"}, "reconnect", "yes"),
    "on_reconnect a text": ({"on_reconnect": "tell me"}, "."),
    "of a stream": ({"policy": "latest"}, "policy"),
    "of watchers of particles": ({"max_particles": 10}, "max_particles"),
}

IDS = {
    "empty": ("", (Bad, Server)),
    "no UUID": ("dam", (Bad, Server)),
    "braces": ("{" + nobody + "}", (Bad, Server)),
    "nobody's": (nobody, Server),
    "None": (None, Bad),
    "a number": (5, Bad),
    "a surrogate": ("\ud800", (Bad, Server, UnicodeEncodeError)),
    "a zero byte": (nobody[:-1] + "\0", (Bad, Server)),
    "a line": (nobody + "\n", (Bad, Server)),
    "a million characters": ("a" * 1000000, meniscus.Error),
}

ID_CALLS = {
    "session_info": lambda place, name: place.client.session_info(name),
    "delete_session": lambda place, name: place.client.delete_session(name),
    "stream": lambda place, name: place.client.stream(name).next(30),
    "watch": lambda place, name: place.client.watch(name).next(30),
    "watch_particles": lambda place, name: place.client.watch_particles(name).next(30),
    "snapshot": lambda place, name: place.client.snapshot(name),
    "read_recording": lambda place, name: place.client.read_recording(name, 1).next(30),
    "delete_recording": lambda place, name: place.client.delete_recording(name, 1),
}

FILES = {
    "not there": ("nowhere.vtk", Bad, "nowhere.vtk"),
    "a folder": (".", Bad, "."),
    "unknown extension": ("frame.docx", Bad, r"\.docx", r"\.vtk"),
    "no extension": ("frame", Bad, "frame", r"\.vtk"),
    "empty": ("", Bad, "."),
    "None": (None, TypeError, "."),
    "a number": (5, TypeError, "."),
    "an object": (object(), TypeError, "."),
    "a zero byte": ("a\0b.vtk", (Bad, ValueError), "."),
    "a surrogate": ("\ud800.vtk", (Bad, UnicodeEncodeError), "."),
}

MESH_FILES = {
    "unknown extension": ("mesh.docx", Bad, r"\.docx", r"\.ply"),
    "no extension": ("mesh", Bad, r"\.ply"),
    "no folder": ("/nowhere/at/all/mesh.ply", Bad, "/nowhere"),
    "empty": ("", Bad, "."),
    "a folder": ("/tmp", Bad, "."),
    "None": (None, TypeError, "."),
    "a number": (3.5, TypeError, "."),
    "a zero byte": ("/tmp/a\0b.ply", (Bad, ValueError), "."),
}


def _of(method, given, *before):
    return lambda place: getattr(place, method[0]).__getattribute__(method[1])(*before, **given)


def _stream(given):
    """A session has one stream at a time. What the server refuses, the first wait raises."""

    def call(place):
        with place.client.session(particle_radius=0.05) as session:
            session.stream(**given).next(30)

    return call


def _id(call, name):
    return lambda place: call(place, name)


def _save(path):
    return lambda place: place.mesh.save(path)


def _read(path):
    return lambda place: meniscus.read_particles(path)


CALLS = [
    *ADDRESSES,
    *(
        wrong(f"connection: {name}", _connect("192.0.2.1:50051", **{"timeout": 0.2, **given}), error, *words)
        for name, (given, error, *words) in CONNECTIONS.items()
    ),
    *(
        wrong(f"session: {name}", _of(("client", "session"), given, 0.05), error, *words)
        for name, (given, error, *words) in SESSIONS.items()
        if error
    ),
    *(wrong(f"stream: {name}", _stream(given), (Bad, TypeError), *words) for name, (given, *words) in STREAMS.items()),
    *(
        wrong(
            f"watch: {name}", lambda place, given=given: place.session.watch(**given).next(30), (Bad, TypeError), *words
        )
        for name, (given, *words) in WATCHERS.items()
    ),
    *(
        wrong(f"{call} of {name}", _id(ID_CALLS[call], given), error, ".")
        for call in ID_CALLS
        for name, (given, error) in IDS.items()
    ),
    *(wrong(f"read_particles: {name}", _read(path), error, *words) for name, (path, error, *words) in FILES.items()),
    *(wrong(f"save: {name}", _save(path), error, *words) for name, (path, error, *words) in MESH_FILES.items()),
    wrong(
        "read_particles: max_bytes negative", lambda p: meniscus.read_particles("a", max_bytes=-1), Bad, "bytes is -1"
    ),
    wrong("read_particles: max_bytes text", lambda p: meniscus.read_particles("a", max_bytes="8G"), Bad, "'8G'"),
    wrong("coarser: 0", lambda p: p.reconstructor.coarser(0), Bad, "0", "1 to 3"),
    wrong("coarser: 4", lambda p: p.reconstructor.coarser(4), Bad, "4", "1 to 3"),
    wrong("coarser: -1", lambda p: p.reconstructor.coarser(-1), (Bad, TypeError), "."),
    wrong("coarser: huge", lambda p: p.reconstructor.coarser(1 << 80), (Bad, TypeError, OverflowError), "."),
    wrong("coarser: None", lambda p: p.reconstructor.coarser(None), Bad, "."),
    wrong("coarser: without a frame", lambda p: meniscus.Reconstructor(0.05).coarser(2), Bad, "frame first"),
    wrong("on device without a GPU", lambda p: p.cpu.reconstruct_on_device([[0, 0, 0]]), Bad, "cuda|CUDA|GPU"),
    wrong("next: negative", lambda p: p.stream.next(-1), Bad, "-1"),
    wrong("next: NaN", lambda p: p.stream.next(nan), Bad, "nan"),
    wrong("next: text", lambda p: p.stream.next("soon"), TypeError, "."),
    wrong("read_recording: number 0", lambda p: p.client.read_recording(nobody, 0).next(30), (Bad, Server), "."),
    wrong("read_recording: negative", lambda p: p.client.read_recording(nobody, -1), (Bad, TypeError), "."),
    wrong("read_recording: position", lambda p: p.client.read_recording(nobody, 1, position=-1), (Bad, TypeError), "."),
    wrong("read_recording: count", lambda p: p.client.read_recording(nobody, 1, count="all"), (Bad, TypeError), "."),
    wrong("watch_particles: negative", lambda p: p.session.watch_particles(max_particles=-1), Bad, "max_particles"),
    wrong("watch_particles: unknown", lambda p: p.session.watch_particles(max_level=1), Bad, "max_level"),
    wrong("snapshot: unknown", lambda p: p.client.snapshot(p.session.id, region=1), Bad, "region"),
    wrong("snapshot: level", lambda p: p.client.snapshot(p.session.id, max_level=9), Bad, "level", "9"),
    wrong("push: time a text", lambda p: p.stream.push([[0, 0, 0]], time="now"), TypeError, "."),
    wrong("push: time None", lambda p: p.stream.push([[0, 0, 0]], time=None), TypeError, "."),
    wrong("push: time NaN", lambda p: p.stream.push([[0, 0, 0]], time=nan), Bad, "time", "finite"),
    wrong("push: index negative", lambda p: p.stream.push([[0, 0, 0]], index=-1), (Bad, TypeError), "."),
    wrong("push: index huge", lambda p: p.stream.push([[0, 0, 0]], index=1 << 80), (Bad, TypeError), "."),
    wrong("push: index a fraction", lambda p: p.stream.push([[0, 0, 0]], index=1.5), Bad, "."),
    wrong("push: index a text", lambda p: p.stream.push([[0, 0, 0]], index="1"), Bad, "."),
    wrong("push: an earlier index", lambda p: p.stream.push([[0, 0, 0]], index=0), Bad, "0"),
]
