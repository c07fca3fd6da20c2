"""asyncio: waits that end with their tasks, and lose nothing."""

import asyncio
import threading
import time
from types import SimpleNamespace

import meniscus
import pytest
from support.scripts import run_script


def run(what):
    return asyncio.run(asyncio.wait_for(what, 60))


def test_frames_are_pushed_and_taken(session, positions):
    async def main():
        with session.stream() as stream:
            indices = [await stream.apush(positions, time=0.5 * i) for i in range(5)]
            stream.finish()
            return indices, [(frame.index, frame.time) async for frame in stream]

    indices, frames = run(main())
    assert indices == list(range(5)) and frames == [(i, 0.5 * i) for i in range(5)]


def test_a_wrong_frame_raises_in_the_task_and_the_stream_goes_on(session, positions):
    async def main():
        with session.stream() as stream:
            with pytest.raises(meniscus.InvalidInput, match="shape"):
                await stream.apush([1, 2, 3])
            assert await stream.apush(positions) == 0
            return (await stream.anext()).index

    assert run(main()) == 0


def test_a_session_is_watched(client, session, positions):
    async def main():
        found = []

        async def follow(frames):
            async for frame in frames:
                found.append(type(frame).__name__)
                break
            await frames.aclose()

        following = [follow(client.awatch(session.id, max_level=2)), follow(client.awatch_particles(session.id))]
        with session.stream() as stream:
            await stream.apush(positions)
            await asyncio.gather(*following)
        return found

    assert sorted(run(main())) == ["Frame", "ParticleFrame"]


def test_a_task_that_is_cancelled_loses_no_frame(session, positions):
    async def main():
        taken = []
        with session.stream() as stream:
            for i in range(10):
                waiting = asyncio.create_task(stream.anext())
                await asyncio.sleep(0)
                await stream.apush(positions)
                if i % 2:
                    await asyncio.sleep(0.02)
                waiting.cancel()
                try:
                    taken.append((await waiting).index)
                except asyncio.CancelledError:
                    pass
            stream.finish()
            async for frame in stream:
                taken.append(frame.index)
        return taken

    assert run(main()) == list(range(10))


class SlowFirstFrame:
    """A stream's C++ side with two frames, of which the thread that receives the first is held up."""

    def __init__(self):
        self._frames = [
            SimpleNamespace(index=i, run_id=0, time=0.0, cell_size=1.0, changed=(), vanished=(), dropped=())
            for i in range(2)
        ]
        self.taken = threading.Event()

    def next(self, _seconds):
        if not self._frames:
            return None, True
        frame = self._frames.pop(0)
        if frame.index == 0:
            self.taken.set()
            time.sleep(0.2)
        return frame, False

    def finish(self):
        pass

    def cancel(self):
        pass


def test_the_frame_of_a_cancelled_wait_is_the_first_after_the_block():
    async def main():
        async with meniscus.Stream(SlowFirstFrame(), True) as stream:
            waiting = asyncio.create_task(stream.anext())
            await asyncio.sleep(0)
            assert stream._source.taken.wait(60)
            waiting.cancel()
        return [frame.index for frame in stream.ready()]

    assert run(main()) == [0, 1]


def test_a_wait_with_a_limit_of_asyncio_loses_no_frame(session, positions):
    async def main():
        with session.stream() as stream:
            for _ in range(3):
                with pytest.raises(asyncio.TimeoutError):
                    await asyncio.wait_for(stream.anext(), 0.05)
            await stream.apush(positions)
            return (await stream.anext()).index

    assert run(main()) == 0


def test_a_cancelled_push_has_pushed_all_the_same(session, positions):
    async def main():
        with session.stream() as stream:
            pushing = asyncio.create_task(stream.apush(positions))
            await asyncio.sleep(0)
            pushing.cancel()
            with pytest.raises(asyncio.CancelledError):
                await pushing
            assert await stream.apush(positions) == 1
            return [(await stream.anext()).index for _ in range(2)]

    assert run(main()) == [0, 1]


def test_the_loop_goes_on_while_a_task_waits(session, positions):
    async def main():
        turns = 0
        with session.stream() as stream:
            waiting = asyncio.create_task(stream.anext())
            for _ in range(100):
                await asyncio.sleep(0)
                turns += 1
            await stream.apush(positions)
            await waiting
        return turns

    assert run(main()) == 100


def test_waits_end_with_the_stream(session):
    async def main():
        stream = session.stream()
        waiting = asyncio.create_task(stream.anext())
        await asyncio.sleep(0.05)
        stream.cancel()
        try:
            return await waiting
        except meniscus.ServerError as error:
            return error.code

    assert run(main()) in (None, "canceled")


def test_sources_of_several_loops_one_after_the_other(session, positions):
    stream = session.stream()
    for i in range(3):

        async def one():
            await stream.apush(positions)
            return (await stream.anext()).index

        assert run(one()) == i
    stream.close()


PROGRAM = """
    import asyncio, sys
    import numpy as np, meniscus

    async def simulate(stream):
        for step in range(3):
            await stream.apush(np.random.random((200, 3)), time=step)

    async def watch(client, session):
        async for frame in client.awatch(session.id, max_level=2):
            frame.mesh.triangles

    async def main():
        client = meniscus.Client(sys.argv[1])
        with client.session(particle_radius=0.05) as session:
            stream = session.stream()
            watching = asyncio.create_task(watch(client, session))
            particles = asyncio.create_task(client.awatch_particles(session.id).__anext__())
            await simulate(stream)
            async for frame in stream:
                if frame.index == 2:
                    break
            {end}

    asyncio.run(main())
"""


@pytest.mark.parametrize("end", ["pass", "sys.exit(0)", "watching.cancel(); client.close()"])
def test_a_program_ends_at_once_without_a_warning(end, server):
    code, out, err = run_script(PROGRAM.format(end=end), server.address, flags=["-W", "error"])
    assert (code, out, err) == (0, "", "")
