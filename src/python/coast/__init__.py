"""coast: post-mission INS/GNSS trajectories.

>>> import coast
>>> result = coast.process("run.yaml")
>>> result.verdict
'good'
>>> result.trajectory.position_sd.max("time")
"""

from . import blocks
from ._coast import __version__
from .errors import CoastError, InputError, NumericalError, OutputError, UnusableResult
from .jobs import calibrate, compare, diagnose, inspect, outage, ppk, process, simulate, synth
from .results import PpkResult, ProcessResult, Result, SimulationResult
from .tables import Table

__all__ = [
    "CoastError", "InputError", "NumericalError", "OutputError", "PpkResult", "ProcessResult", "Result", "SimulationResult", "Table", "UnusableResult",
    "__version__", "blocks", "calibrate", "compare", "diagnose", "inspect", "outage", "ppk", "process", "simulate", "synth",
]
