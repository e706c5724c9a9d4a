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
_ANGLES = ["roll", "pitch", "yaw"]


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


class SimulationResult(Result):
    """A simulated recording with its truth.

    Attributes:
        imu:   xarray.Dataset, increments in the sensor's axes, each with the time at its end
        gnss:  xarray.Dataset, positions of the antenna
               of both, `sow` are seconds of the week in attrs["gps_week"], as a coast.Table of them has to have
        truth: xarray.Dataset, states of the IMU at the start and at every IMU epoch: as coast.blocks.strapdown takes them, and in geographic terms
    """

    @functools.cached_property
    def imu(self) -> xarray.Dataset:
        a = self._outcome.imu()
        week, sow = _week_and_seconds(a["time_ns"])
        return _dataset(
            a,
            {
                "sow": ("time", sow, {"units": "s", "long_name": "GPS seconds of the week in attrs"}),
                "dt": ("time", a["dt"], {"units": "s", "long_name": "length of the interval"}),
                "dtheta": (("time", "sensor_axis"), a["dtheta"], {"units": "rad", "long_name": "integral of the rotation rate"}),
                "dv": (("time", "sensor_axis"), a["dv"], {"units": "m/s", "long_name": "integral of the specific force"}),
            },
            sensor_axis=["x", "y", "z"],
        ).assign_attrs(gps_week=week)

    @functools.cached_property
    def gnss(self) -> xarray.Dataset:
        return _fixes(self._outcome.gnss())

    @functools.cached_property
    def truth(self) -> xarray.Dataset:
        a = self._outcome.truth()
        return _dataset(
            a,
            {
                "r_eb_e": (("time", "ecef"), a["r_eb_e"], {"units": "m", "long_name": "position, Earth-centred, Earth-fixed"}),
                "v_eb_e": (("time", "ecef"), a["v_eb_e"], {"units": "m/s", "long_name": "velocity relative to the Earth"}),
                "C_b_e": (("time", "ecef", "body"), a["C_b_e"].reshape(-1, 3, 3), {"long_name": "attitude: turns body axes into Earth axes"}),
                **_geographic(a),
            },
            ecef=["x", "y", "z"],
            body=["forward", "right", "down"],
            axis=_AXES,
            angle=_ANGLES,
        )


def _dataset(a, variables, **axes):
    import xarray

    return xarray.Dataset(variables, coords={"time": ("time", _times(a["time_ns"]), {"long_name": "GPS time (without leap seconds)"}), **axes})


class PpkResult(Result):
    """Carrier-phase positions.

    Attributes:
        positions: xarray.Dataset, one row per solved epoch; quality 1 is fixed, 2 float, 5 single
    """

    @functools.cached_property
    def positions(self) -> xarray.Dataset:
        return _fixes(self._outcome.positions())


def _fixes(a):
    week, sow = _week_and_seconds(a["time_ns"])
    return _dataset(
        a,
        {
            "sow": ("time", sow, {"units": "s", "long_name": "GPS seconds of the week in attrs"}),
            "r_ea_e": (("time", "ecef"), a["r_ea_e"], {"units": "m", "long_name": "position of the antenna, Earth-centred, Earth-fixed"}),
            "position_sd": (("time", "axis"), a["sd_position_n"], {"units": "m", "long_name": "standard deviation in north, east, down"}),
            "quality": ("time", a["quality"], {"long_name": "as RTKLIB numbers it"}),
            "satellites": ("time", a["satellites"]),
        },
        ecef=["x", "y", "z"],
        axis=_AXES,
    ).assign_attrs(gps_week=week)


def _week_and_seconds(ns):
    """GPS week of the first time, and seconds since its beginning."""
    week = int(ns[0] // 604_800_000_000_000) if len(ns) else 0
    return week, (ns - week * 604_800_000_000_000) / 1e9


def _times(ns):
    return GPS_EPOCH + ns.astype("timedelta64[ns]")


def _vector(a, key, units, name, axes="axis"):
    return ("time", axes), a[key], {"units": units, "long_name": name}


def _geographic(a):
    return {
        "latitude": ("time", a["latitude"], {"units": "degrees_north", "datum": "of the GNSS positions"}),
        "longitude": ("time", a["longitude"], {"units": "degrees_east"}),
        "height": ("time", a["height"], {"units": "m", "long_name": "above the ellipsoid"}),
        "velocity": _vector(a, "velocity_n", "m/s", "velocity relative to the Earth, in north, east, down"),
        "attitude": _vector(a, "attitude", "degree", "roll, pitch, yaw of the body (forward, right, down) against north, east, down", "angle"),
    }


def _trajectory(a):
    deviations = {
        "position_sd": _vector(a, "sd_position_n", "m", "standard deviation of the position"),
        "velocity_sd": _vector(a, "sd_velocity_n", "m/s", "standard deviation of the velocity"),
        "attitude_sd": _vector(a, "sd_attitude", "degree", "standard deviation of roll, pitch, yaw", "angle"),
    }
    return _dataset(a, {**_geographic(a), **deviations}, axis=_AXES, angle=_ANGLES)
