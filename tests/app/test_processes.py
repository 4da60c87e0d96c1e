"""Answers in processes of their own: any of them can be ended, none outlives the program."""

import asyncio
import gc
import os
import signal
import subprocess
import sys
import time
from concurrent.futures import BrokenExecutor
from contextlib import suppress

import pytest

from beamdyn.common.results.one_line import few_digits, number
from beamdyn.common.screens import page_tasks
from beamdyn.common.screens.open_document import OpenDocument, ShownAnswer
from beamdyn.common.screens.page_tasks import outcome_of
from beamdyn.common.screens.processes import Processes, Share, TakesTooLong
from brakes.app.program import BRAKES
from brakes.cli.commands import make_program
from tests.app.serving import PATIENCE, ROOT

FORKLIFT = BRAKES.documents[0]
VEHICLE = FORKLIFT.screens[0]
ENTERED = []
ALL = [(document, screen) for document in BRAKES.documents for screen in document.screens]


# What processes are given to do; they import it from here.


def sleep(document, screen, seconds):
    time.sleep(seconds)
    return os.getpid()


def sleep_on(document, screen, seconds):
    """Sleep whatever comes."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        with suppress(BaseException):
            time.sleep(seconds)


def import_slowly(document, screen, folder):
    """Import a module that takes its time, and needs what it has defined at its end."""
    sys.path.insert(0, folder)
    import imported_slowly

    return imported_slowly.part.end, os.getpid()


def leave_few_digits(document, screen):
    """Enter `few_digits` and never leave it, as where an interruption comes between the two."""
    ENTERED.append(entered := few_digits())
    entered.__enter__()
    return number(66.0234)


def written(document, screen):
    return number(66.0234)


def threads_of_blas(document, screen):
    from threadpoolctl import threadpool_info

    return [library["num_threads"] for library in threadpool_info()]


def allocate(document, screen, megabytes):
    return len(bytearray(megabytes * 2**20))


def die(document, screen):
    os._exit(1)


def running(body, **options):
    """Run an async function with processes, which are ended after it."""

    async def main():
        processes = Processes(make_program, **options)
        try:
            async with asyncio.timeout(PATIENCE):
                await body(processes)
        finally:
            ids = processes.ids
            await processes.close()
        assert processes.ids == set()
        assert not any(alive(one) for one in ids)

    asyncio.run(main())


def alive(process):
    """Whether there is such a process, which is more than an entry that waits to be fetched."""
    try:
        os.kill(process, 0)
        with open(f"/proc/{process}/stat") as file:
            return file.read().rpartition(")")[2].split()[0] != "Z"
    except FileNotFoundError:
        return not os.path.exists("/proc/self")  # else it has ended meanwhile
    except ProcessLookupError:
        return False


def submit(processes, task, *rest):
    return processes.submit(task, FORKLIFT, VEHICLE, *rest)


def test_answers_of_all_screens_are_those_made_here():
    async def body(processes):
        for document, screen in ALL:
            work = OpenDocument(document)
            made = await processes.submit(page_tasks.solve, document, screen, work.entries)
            assert isinstance(made, ShownAnswer), made
            assert work.solve(screen)
            here = work.answered[screen.name]
            assert made.entries == here.entries and made.notes == here.notes
            assert [*screen.rows(made.answer)] == [*screen.rows(here.answer)]

    running(body)


def test_no_process_starts_before_it_is_needed_and_idle_ones_are_used_again():
    async def body(processes):
        assert processes.ids == set()
        first = await submit(processes, sleep, 0.0)
        assert await submit(processes, sleep, 0.0) == first
        assert first in processes.ids and first != os.getpid()

    running(body)


async def cancelled(processes, task, *given):
    """Cancel a task soon after it has begun; return how long that took [s]."""
    begun = submit(processes, task, *given)
    await asyncio.sleep(0.1)
    begin = time.perf_counter()
    begun.cancel()
    await asyncio.wait([begun])
    assert begun.cancelled()
    return time.perf_counter() - begin


def test_blas_has_one_thread():
    async def body(processes):
        counts = await submit(processes, threads_of_blas)
        assert counts and {*counts} == {1}

    running(body)


@pytest.mark.skipif(not hasattr(signal, "SIGUSR1"), reason="the system has no signal to interrupt a task")
def test_what_is_cancelled_is_interrupted_and_its_process_goes_on():
    async def body(processes):
        processes.most = 1
        first = await submit(processes, sleep, 0.0)
        await cancelled(processes, sleep, 10 * PATIENCE)
        assert [await submit(processes, sleep, 0.0) for _ in range(2)] == [first, first]

    running(body)


@pytest.mark.skipif(not hasattr(signal, "SIGUSR1"), reason="the system has no signal to interrupt a task")
def test_no_interruption_leaves_a_module_half_imported(tmp_path):
    package = tmp_path / "imported_slowly"
    package.mkdir()
    (package / "__init__.py").write_text("import imported_slowly.part\nimport time\ntime.sleep(0.2)\n")
    (package / "part.py").write_text("end = 1\n")

    async def body(processes):
        processes.most = 1
        first = await submit(processes, sleep, 0.0)
        await cancelled(processes, import_slowly, str(tmp_path))
        assert await submit(processes, import_slowly, str(tmp_path)) == (1, first)

    running(body)


def test_what_a_task_leaves_set_does_not_reach_the_next_one():
    async def body(processes):
        processes.most = 1
        assert await submit(processes, leave_few_digits) == "66"
        assert await submit(processes, written) == "66.02"

    running(body)


def test_what_heeds_no_interruption_ends_with_its_process_and_others_go_on():
    async def body(processes):
        processes.most = 1
        first = await submit(processes, sleep, 0.0)
        assert await cancelled(processes, sleep_on, 10 * PATIENCE) < 0.1 * PATIENCE
        assert await submit(processes, sleep, 0.0) != first
        assert not alive(first)

    running(body)


def test_a_long_task_does_not_hold_up_others():
    async def body(processes):
        long = submit(processes, sleep, 10 * PATIENCE)
        assert await submit(processes, sleep, 0.0) in processes.ids
        assert not long.done()

    running(body)


def test_what_takes_too_long_is_given_up_with_what_has_changed():
    async def body(processes):
        work = OpenDocument(FORKLIFT)
        assert work.solve(VEHICLE)
        work.put("stop.speed", "25 km/h")
        await submit(processes, sleep, 0.0)
        processes.longest = 0.5
        long = submit(processes, sleep, 10 * PATIENCE)
        await asyncio.wait([long])
        with pytest.raises(TakesTooLong, match=r"more than 0\.5 s"):
            long.result()
        said = outcome_of(long, work, VEHICLE)
        assert "Given up: it takes more than 0.5 s" in said[""][0]
        assert "it was 20 km/h" in said["stop.speed"][0]
        assert {*said} == {"", "stop.speed"}

    running(body)


@pytest.mark.skipif(not os.path.exists("/proc/self/statm"), reason="memory is limited where /proc tells it")
def test_what_takes_too_much_memory_is_given_up():
    async def body(processes):
        assert await submit(processes, allocate, 100) == 100 * 2**20
        with pytest.raises(TakesTooLong, match="MB of memory"):
            await submit(processes, allocate, 2000)
        assert await submit(processes, allocate, 1) == 2**20

    running(body)


def test_a_process_that_dies_is_replaced():
    async def body(processes):
        with pytest.raises(BrokenExecutor, match="died"):
            await submit(processes, die)
        assert await submit(processes, sleep, 0.0) in processes.ids

    running(body)


def die_at_start():
    """A program that cannot be made in a process, as when that is ended while it starts."""
    os._exit(1)


def test_a_process_that_dies_while_it_starts_fails_who_waits_for_it_and_nothing_else():
    unheard = []

    async def main():
        asyncio.get_running_loop().set_exception_handler(lambda _, context: unheard.append(context))
        processes = Processes(die_at_start)
        async with asyncio.timeout(PATIENCE):
            with pytest.raises(
                BrokenExecutor, match="no process can be started to compute the result: it ended"
            ):
                await submit(processes, sleep, 0.0)
        assert processes.ids == set()
        gc.collect()
        await processes.close()

    asyncio.run(main())
    assert unheard == []


async def tell_and_wait(processes):
    """Say which process is at a long task, and go on for long."""
    first = await submit(processes, sleep, 0.0)
    submit(processes, sleep, 10 * PATIENCE)
    await asyncio.sleep(0.2)
    print(first, flush=True)
    await asyncio.sleep(PATIENCE)


@pytest.mark.skipif(os.name == "nt", reason="there is no SIGKILL")
def test_processes_end_with_a_program_that_is_killed_in_the_middle_of_a_task():
    code = f"from {__name__} import running, tell_and_wait; running(tell_and_wait)"
    caller = subprocess.Popen([sys.executable, "-c", code], cwd=ROOT, stdout=subprocess.PIPE)
    with caller:
        process = int(caller.stdout.readline())
        assert alive(process)
        caller.kill()
    deadline = time.monotonic() + PATIENCE
    while alive(process) and time.monotonic() < deadline:
        time.sleep(0.1)
    assert not alive(process)


def test_a_page_at_many_long_answers_leaves_a_process_to_others():
    async def body(processes):
        busy, other = Share(processes, 2), Share(processes, 2)
        long = [busy.submit(sleep, FORKLIFT, VEHICLE, 60) for _ in range(4)]
        assert isinstance(await other.submit(sleep, FORKLIFT, VEHICLE, 0.0), int)
        assert not any(each.done() for each in long)
        long[2].cancel()  # while it waits
        long[0].cancel()
        await asyncio.wait([long[0], long[2]])
        assert isinstance(await other.submit(sleep, FORKLIFT, VEHICLE, 0.0), int)
        for each in long:
            each.cancel()
        await asyncio.wait(long)
        assert isinstance(await busy.submit(sleep, FORKLIFT, VEHICLE, 0.0), int)

    running(body, most=3)
