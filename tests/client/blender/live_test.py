"""Following a session, against servers that are played."""

import queue
import threading
from types import SimpleNamespace

import numpy as np
import pytest

from meniscus_blender.live import AmbiguousChoice, Follower, SessionChoice, Space, Target, chosen
from meniscus_blender.session_list import SessionList

PATIENCE = 20.0


def session(name="", id="1", **more):
    return SimpleNamespace(name=name, id=id, up_axis="y", length_unit="cm", frames=3, **more)


def frame(index, vertices=3):
    mesh = SimpleNamespace(
        vertices=np.full((vertices, 3), index, np.float64),
        triangles=np.array([[0, 1, 2]], np.uint32),
        normals=np.ones((vertices, 3), np.float32),
        attributes={"velocity": np.zeros((vertices, 3), np.float32)},
    )
    return SimpleNamespace(
        mesh=mesh, statistics=SimpleNamespace(warnings=(), particles=9), index=index, run_id=0, time=0.5 * index
    )


class Server:
    """Clients and watchers as those of the package. What is put into a queue is sent, None ends the session."""

    def __init__(self, *sessions):
        self.listed = list(sessions)
        self.frames = queue.Queue()
        self.watched = queue.Queue()
        self.ended = False
        self.connections = 0

    def connect(self):
        self.connections += 1
        return self

    def sessions(self):
        return self.listed

    def watch(self, id, **options):
        self.ended = False
        self.watched.put((id, options))
        return self

    def next(self, seconds):
        try:
            got = self.frames.get(timeout=seconds)
        except queue.Empty:
            return None
        if isinstance(got, Exception):
            raise got
        self.ended = got is None
        return got

    def cancel(self):
        self.frames.put(None)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        pass


def wait_state(follower, part, is_error):
    with follower._changed:
        assert follower._changed.wait_for(
            lambda: part in follower._state.text and follower._state.is_error == is_error, PATIENCE
        ), follower._state


@pytest.fixture
def follow():
    followers = []

    def begin(server, target=Target(), **more):
        followers.append(Follower(server.connect, target, **{"pause": 0.01, **more}))
        return followers[-1]

    yield begin
    for follower in followers:
        follower.stop(PATIENCE)
        assert follower.ended


def test_the_newest_frame_is_there_with_its_attributes(follow):
    server = Server(session("dam"))
    follower = follow(server, Target("dam"))
    server.frames.put(frame(7))
    got = follower.wait(PATIENCE)
    assert got.index == 7 and got.time == 3.5
    assert got.surface.vertices.dtype == np.float32 and got.surface.triangles.dtype == np.int32
    assert list(got.surface.attributes) == ["velocity"] and got.surface.normals is None
    wait_state(follower, "'dam': frame 7, 1 triangles of 9 particles", False)
    assert follower.space == Space("y", "cm")


def test_frames_of_one_number_differ(follow):
    server = Server(session())
    follower = follow(server)
    server.frames.put(frame(0))
    first = follower.wait(PATIENCE)
    server.frames.put(frame(0))
    with follower._changed:
        assert follower._changed.wait_for(lambda: follower._newest is not first, PATIENCE)
    assert follower.newest.key != first.key


def test_the_target_reaches_the_server(follow):
    server = Server(session("dam", "uuid"))
    follow(server, Target("dam", 2, ("velocity", "age"), True))
    id, options = server.watched.get(timeout=PATIENCE)
    assert id == "uuid" and options["max_level"] == 2 and options["attributes"] == ("velocity", "age")
    assert options["normal_bits"] > 0


def test_a_session_that_comes_later_is_followed(follow):
    server = Server()
    follower = follow(server, Target("dam"))
    wait_state(follower, "there is no session 'dam' yet", True)
    server.frames.put(frame(1))
    server.listed.append(session("dam"))
    assert follower.wait(PATIENCE).index == 1


def test_a_session_that_has_ended_is_followed_when_it_comes_again(follow):
    server = Server(session("dam"))
    follower = follow(server, Target("dam"))
    server.watched.get(timeout=PATIENCE)
    server.frames.put(None)
    server.watched.get(timeout=PATIENCE)
    server.frames.put(frame(3))
    assert follower.wait(PATIENCE).index == 3


def test_a_server_that_is_away_is_an_error_until_it_is_there(follow):
    server = Server(session("dam"))
    away = threading.Event()
    away.set()

    def connect():
        if away.is_set():
            raise ConnectionError("no server\nanswers at host:1")
        return server.connect()

    follower = follow(SimpleNamespace(connect=connect))
    wait_state(follower, "no server answers at host:1", True)
    assert not follower.ended
    away.clear()
    server.frames.put(frame(2))
    assert follower.wait(PATIENCE).index == 2


def test_the_last_frame_stays_when_the_server_breaks_off(follow):
    server = Server(session("dam"))
    follower = follow(server, pause=1000.0)
    server.frames.put(frame(2))
    assert follower.wait(PATIENCE).index == 2
    server.frames.put(ConnectionError("broken"))
    wait_state(follower, "broken", True)
    assert follower.newest.index == 2


def test_a_wrong_token_is_not_tried_again(follow):
    tries = []

    def connect():
        tries.append(1)
        raise PermissionError("the token is wrong")

    follower = follow(SimpleNamespace(connect=connect), final=lambda error: isinstance(error, PermissionError))
    assert follower.wait(PATIENCE) is None
    follower._thread.join(PATIENCE)
    assert follower.ended and len(tries) == 1
    assert follower.state.text == "the token is wrong" and follower.state.is_error


def test_several_sessions_of_which_none_is_chosen_are_not_waited_for(follow):
    follower = follow(Server(session("dam", "1"), session("lake", "2")), pause=1000.0)
    assert "choose a session; there are: dam (1)" in follower.wait_for_answer(PATIENCE)
    assert follower.wait(None) is None and follower.state.is_error
    with pytest.raises(AmbiguousChoice):
        chosen([session("dam", "1"), session("dam", "2")], "dam")


def test_a_session_that_may_come_is_no_refusal_and_waited_for_once(follow):
    server = Server()
    follower = follow(server, Target("dam"))
    assert follower.wait_for_answer(PATIENCE) == ""
    assert follower.wait(0.01) is None
    assert follower.wait(None) is None, "a second wait would have no end"
    server.frames.put(frame(1))
    server.listed.append(session("dam"))
    with follower._changed:
        assert follower._changed.wait_for(lambda: follower._newest is not None, PATIENCE)
    assert follower.wait(None).index == 1


def test_a_final_error_is_a_refusal(follow):
    def connect():
        raise PermissionError("the token is wrong")

    follower = follow(SimpleNamespace(connect=connect), final=lambda error: isinstance(error, PermissionError))
    assert follower.wait_for_answer(PATIENCE) == "the token is wrong"


def test_stopping_ends_a_wait_at_once(follow):
    waiting = follow(Server(session("dam")), pause=1000.0)
    waiting.stop(PATIENCE)
    pausing = follow(Server(), pause=1000.0)
    wait_state(pausing, "no session", True)
    pausing.stop(PATIENCE)
    assert waiting.ended and pausing.ended


def test_a_session_is_chosen_by_id_or_by_a_name_of_its_own():
    dam, lake, other_lake = session("dam", "1"), session("lake", "2"), session("lake", "3")
    assert chosen([dam], "") is dam
    assert chosen([dam, lake, other_lake], "dam") is dam
    assert chosen([dam, lake, other_lake], "3") is other_lake
    for sessions, wanted, text in (
        ([], "", "the server has no session yet"),
        ([], "dam", "no session 'dam' yet"),
        ([dam, lake], "", r"choose a session; there are: dam \(1\), lake \(2\)"),
        ([dam, lake, other_lake], "lake", "2 sessions are named 'lake': give the id"),
        ([dam], "sea", r"no session 'sea'; there are: dam \(1\)"),
    ):
        with pytest.raises(SessionChoice, match=text):
            chosen(sessions, wanted)


def test_the_list_names_each_session_by_what_chooses_it():
    sessions = [session("dam", "1"), session("lake", "2"), session("lake", "3"), session("", "4")]
    listed = SessionList(Server(*sessions).connect)
    listed.wait()
    assert listed.done and not listed.error
    for (key, text), wanted in zip(listed.entries(), sessions):
        assert chosen(sessions, key) is wanted
        assert (wanted.name or wanted.id) in text


def test_a_list_that_cannot_be_had_says_why():
    def connect():
        raise ConnectionError("away")

    listed = SessionList(connect)
    listed.wait()
    assert (listed.entries(), listed.error) == ([], "away")
