"""Results of jobs: numbers as dicts and xarray.Datasets, the page, and the files."""

from __future__ import annotations

import functools
import html
import json
import pathlib
import tempfile
import typing

import numpy as np

if typing.TYPE_CHECKING:
    import xarray

GPS_EPOCH = np.datetime64("1980-01-06T00:00:00", "ns")
_AXES = ["north", "east", "down"]


class Result:
    """What a job returns.

    Attributes:
        summary: the job's numbers, as in its .json file
        page:    the report as HTML, complete in itself; shown by notebooks
        files:   names of the files that the job writes where `out` is given
    """

    def __init__(self, outcome, told, warnings):
        self._outcome, self._told = outcome, told
        self.warnings = tuple(warnings)  #: what the input lets doubt, sentence by sentence
        self.inspection = tuple(told)  #: how the input was interpreted

    @property
    def files(self) -> tuple[str, ...]:
        return tuple(self._outcome.files)

    @functools.cached_property
    def _written(self):
        """The files that tell of the whole result, by name."""
        with tempfile.TemporaryDirectory() as folder:
            self._outcome.write(folder)
            return {file.name: file.read_text(encoding="utf-8") for file in pathlib.Path(folder).iterdir() if file.suffix in (".json", ".html", ".yaml")}

    @functools.cached_property
    def summary(self) -> dict:
        for name, text in self._written.items():
            if name.endswith(".json") and name != "report.json":
                return json.loads(text)
        return {}

    @property
    def page(self) -> str:
        return self._written.get("report.html", "")

    def text(self, name: str) -> str:
        """Content of one of the .json, .yaml and .html files."""
        return self._written[name]

    def __repr__(self):
        lines = self._outcome.told("").rstrip().split("\n")
        return "\n".join(line for line in lines if not line.startswith("report:"))

    def _repr_html_(self):
        return f'<iframe srcdoc="{html.escape(self.page)}" width="100%" height="700" style="border:0"></iframe>'


class ProcessResult(Result):
    """A trajectory, with everything that tells how good it is.

    Attributes:
        verdict:     "good", "doubtful" or "unusable"
        why:         the verdict in one line
        trajectory:  xarray.Dataset, smoothed (or forward where the configuration has no smoother)
        forward:     xarray.Dataset of the forward filter
        innovations: xarray.Dataset, one row per measurement
        states:      xarray.Dataset, estimated sensor errors over time
        outages:     list of dicts, one per outage: for pandas.DataFrame
        resolved:    the configuration with every value used: gives the same numbers again
    """

    @property
    def verdict(self) -> str:
        return self._outcome.verdict

    @property
    def why(self) -> str:
        return self._outcome.verdict_line

    @property
    def resolved(self) -> str:
        return self._outcome.resolved

    @functools.cached_property
    def trajectory(self) -> xarray.Dataset:
        return _trajectory(self._outcome.trajectory())

    @functools.cached_property
    def forward(self) -> xarray.Dataset:
        return _trajectory(self._outcome.forward())

    @functools.cached_property
    def innovations(self) -> xarray.Dataset:
        import xarray

        a = self._outcome.innovations()
        return xarray.Dataset(
            {
                "kind": ("time", np.array(a["kind"], dtype=str)),
                "used": ("time", a["used"]),
                "innovation": (("time", "component"), a["innovation"], {"long_name": "measured minus predicted", "frame": "north, east, down"}),
                "sd": (("time", "component"), a["sd"], {"long_name": "predicted standard deviation of the innovation"}),
                "nis": ("time", a["nis"], {"long_name": "normalised innovation squared"}),
                "dof": ("time", a["dof"], {"long_name": "degrees of freedom of the nis"}),
            },
            coords={"time": _times(a["time_ns"]), "component": [1, 2, 3]},
        )

    @functools.cached_property
    def states(self) -> xarray.Dataset:
        import xarray

        variables, seconds = {}, np.empty(0)
        for name, track in self._outcome.states().items():
            seconds = track["seconds"]  # the same knots for all
            for part in ("forward", "forward_sd", "smoothed", "smoothed_sd"):
                if len(track[part]) == len(seconds):
                    variables[f"{name}_{part}"] = ("seconds", track[part])
        return xarray.Dataset(variables, coords={"seconds": ("seconds", seconds, {"units": "s", "long_name": "since the start of the mission"})})

    @property
    def outages(self) -> list[dict]:
        return self.summary.get("outages", [])


def _times(ns):
    return GPS_EPOCH + ns.astype("timedelta64[ns]")


def _trajectory(a):
    import xarray

    def vector(key, units, name, axes="axis"):
        return ("time", axes), a[key], {"units": units, "long_name": name}

    return xarray.Dataset(
        {
            "latitude": ("time", a["latitude"], {"units": "degrees_north", "datum": "of the GNSS positions"}),
            "longitude": ("time", a["longitude"], {"units": "degrees_east"}),
            "height": ("time", a["height"], {"units": "m", "long_name": "above the ellipsoid"}),
            "velocity": vector("velocity_n", "m/s", "velocity relative to the Earth, in north, east, down"),
            "attitude": vector("attitude", "degree", "roll, pitch, yaw of the body (forward, right, down) against north, east, down", "angle"),
            "position_sd": vector("sd_position_n", "m", "standard deviation of the position"),
            "velocity_sd": vector("sd_velocity_n", "m/s", "standard deviation of the velocity"),
            "attitude_sd": vector("sd_attitude", "degree", "standard deviation of roll, pitch, yaw", "angle"),
        },
        coords={
            "time": ("time", _times(a["time_ns"]), {"long_name": "GPS time (without leap seconds)"}),
            "axis": _AXES,
            "angle": ["roll", "pitch", "yaw"],
        },
    )
