"""The jobs of coast as functions.

Each takes its configuration as a file name or as a dict with the keys of that file (docs/reference), in which a coast.Table may
stand for a file of numbers, and in common:

    out       a folder for the files that the program of the same name would write; none are written without it
    folder    from which relative paths in a dict count
    threads   0: all
    progress  None: a bar where somebody looks at it; False: nothing; or a function of (stage, fraction)

They raise InputError (bad input, with file, line and a hint), NumericalError or OutputError. Ctrl-C ends a job; nothing that it
began to write is left behind. The interpreter's lock is released while they run.
"""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable, Sequence

from . import _coast
from .errors import UnusableResult
from .progress import listener
from .results import PpkResult, ProcessResult, Result, SimulationResult


Configuration = str | os.PathLike | dict
Path = str | os.PathLike
Progress = bool | Callable[[str, float], None] | None


class _Listener:
    """What a job says is kept; progress goes on to whoever wants it."""

    def __init__(self, progress):
        self._to = listener(progress)
        self.said, self.warned = [], []

    def stage(self, what, fraction):
        self._to.stage(what, fraction)

    def say(self, line):
        self.said.append(line)
        self._to.say(line)

    def warn(self, line):
        self.warned.append(line)
        self._to.warn(line)

    def close(self):
        getattr(self._to, "close", lambda: None)()


def _run(kind, function, common, *args, **more):
    out, threads, progress = common
    told = _Listener(progress)
    try:
        outcome = function(*args, call=_coast.Call(told, threads, None if out is None else os.fspath(out)), **more)
    finally:
        told.close()
    return kind(outcome, told.said, told.warned)


def process(config: Configuration, *, out: Path | None = None, folder: Path = ".", threads: int = 0, progress: Progress = None) -> ProcessResult:
    """IMU and GNSS to the best trajectory: forward filter, smoother, outages, verdict.

    A result that contradicts its input is returned all the same, with a warning UnusableResult.
    """
    result = _run(ProcessResult, _coast.process, (out, threads, progress), config, os.fspath(folder))
    if result.verdict == "unusable" and not result._outcome.accepted:
        warnings.warn(result.why, UnusableResult, stacklevel=2)
    return result


def diagnose(config: Configuration, *, twins: int = 20, quick: bool = False, simulation: Path = "", out: Path | None = None, folder: Path = ".", threads: int = 0, progress: Progress = None) -> Result:
    """What the model of a run leaves out: effects, sizes, and how much likelier the recording becomes with them."""
    return _run(Result, _coast.diagnose, (out, threads, progress), config, os.fspath(folder), twins=twins, quick=quick, simulation=os.fspath(simulation))


def calibrate(config: Configuration, *, out: Path | None = None, folder: Path = ".", threads: int = 0, progress: Progress = None) -> Result:
    """Static records to an IMU error model; rests in many poses to scale, misalignment and bias; or a study of estimators."""
    return _run(Result, _coast.calibrate, (out, threads, progress), config, os.fspath(folder))


def synth(config: Configuration, *, out: Path | None = None, folder: Path = ".", threads: int = 0, progress: Progress = None) -> Result:
    """Several IMUs merged into a synthetic one, or a study of such merges."""
    return _run(Result, _coast.synth, (out, threads, progress), config, os.fspath(folder))


def ppk(config: Configuration, *, out: Path | None = None, folder: Path = ".", threads: int = 0, progress: Progress = None) -> PpkResult:
    """RINEX of rover and base to carrier-phase positions."""
    return _run(PpkResult, _coast.ppk, (out, threads, progress), config, os.fspath(folder))


def outage(config: Configuration, *, out: Path | None = None, folder: Path = ".", threads: int = 0, progress: Progress = None) -> Result:
    """Outages times error models to tables of drift, of a recording or of simulated seeds."""
    return _run(Result, _coast.outage, (out, threads, progress), config, os.fspath(folder))


def simulate(config: Configuration, *, seed: int | None = None, out: Path | None = None, folder: Path = ".", threads: int = 0, progress: Progress = None) -> SimulationResult:
    """A trajectory and its sensors to a recording with its truth."""
    return _run(SimulationResult, _coast.simulate, (out, threads, progress), config, os.fspath(folder), seed=seed)


def compare(first: Path, second: Path, *, lever_arm: Sequence[float] = (0.0, 0.0, 0.0), out: Path | None = None, threads: int = 0, progress: Progress = None) -> Result:
    """Differences of two trajectories, first minus second, at the epochs of the second.

    lever_arm: from the first's point to the second's, forward, right, down, m
    """
    return _run(Result, _coast.compare, (out, threads, progress), os.fspath(first), os.fspath(second), lever_arm=list(lever_arm))


def inspect(file: Path, *, gps_week: int | None = None, threads: int = 0, progress: Progress = None) -> str:
    """What is in a file of a recording: kind, span, rates, satellites, gaps, damage; as text."""
    told = _Listener(progress)
    try:
        return _coast.inspect(os.fspath(file), gps_week, _coast.Call(told, threads, None))
    finally:
        told.close()
