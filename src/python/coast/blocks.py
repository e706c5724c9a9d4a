"""Building blocks of the jobs, as functions on arrays. Units are SI: rad, rad/s, m/s^2; frames as in docs/notation.md.

Each has an example that a test runs. What they refuse is a ValueError.
"""

import os

import numpy as np

from . import _coast
from .results import GPS_EPOCH


def allan(values, dt, points_per_decade=12):
    """Allan and Hadamard deviation of samples of one axis at rest, with 95 % intervals.

    values: (n) mean rates or specific forces over equal intervals; dt: s between them. Returns an xarray.Dataset over `tau` (s): `allan`,
    `hadamard` [unit of values], each with `_low_95`, `_high_95`, and `_edf`, the degrees of freedom of the intervals (Greenhall & Riley 2003).

    >>> white = np.random.default_rng(1).normal(0.0, 1e-3, 100_000)     # rad/s at 100 Hz
    >>> curve = allan(white, dt=0.01)
    >>> round(float(curve.allan.sel(tau=1.0, method="nearest")) / 1e-4, 1)   # 1e-3 / sqrt(100)
    1.0
    """
    import xarray

    columns = _coast.allan(np.asarray(values, dtype=float), float(dt), points_per_decade)
    tau = columns.pop("tau")
    return xarray.Dataset({name: ("tau", column) for name, column in columns.items()}, {"tau": ("tau", tau, {"units": "s"})})


def process_parameters(process):
    """The parameters of a process that can be estimated, in their order: {name: unit}; `signal` stands for rad/s or m/s^2.

    >>> process_parameters("gauss_markov")
    {'beta': '1/s', 'sigma2': 'signal^2'}
    """
    return dict(_coast.process_parameters(process))


def sum_log_likelihood(values, dt, processes, mean="level"):
    """Exact Gaussian log-likelihood of samples at rest under a sum of processes; restricted, so without what the mean takes.

    values: (n); dt: s between them; processes: [(name, [parameters as process_parameters has them]), ..]; mean: zero, level or level_and_drift,
    estimated with them. Kalman filter from the stationary start; Patterson & Thompson (1971) for the mean.

    >>> y = np.random.default_rng(2).normal(0.0, 1.0, 1000)
    >>> right = sum_log_likelihood(y, 0.01, [("white_noise", [0.01])])     # variance 1 at 100 Hz: density 0.01 signal^2/Hz
    >>> right > sum_log_likelihood(y, 0.01, [("white_noise", [0.02])])
    True
    """
    stated = [(name, [float(p) for p in parameters]) for name, parameters in processes]
    return _coast.sum_log_likelihood(np.asarray(values, dtype=float), float(dt), stated, mean)


def arma_garch(y, orders=(1, 0, 1, 1), constant=True):
    """Quasi-maximum likelihood of an ARMA(d,h)-GARCH(p,q), Stebler et al. (2011) eqs. (8) and (9).

    y: (n); orders: d, h, p, q. Returns a dict: `value` and `sd` (robust) by the name of the parameter, `log_likelihood`, `aic`, `aicc`,
    `converged`, and for each sample `residual` and its `variance`. `sd` is empty where a parameter is not identified.

    >>> e = np.random.default_rng(3).normal(0.0, 1.0, 5000)
    >>> y = np.empty(5000); y[0] = e[0]
    >>> for t in range(1, 5000): y[t] = 0.6 * y[t - 1] + e[t]
    >>> fit = arma_garch(y, (1, 0, 0, 0))
    >>> abs(fit["value"]["alpha1"] - 0.6) < 3 * fit["sd"]["alpha1"]
    True
    """
    return _coast.arma_garch_fit(np.asarray(y, dtype=float), tuple(orders), constant)


def integer_least_squares(a, Q, count=2):
    """The integer vectors nearest to float ambiguities in the metric of their covariance (LAMBDA: Teunissen 1995; Chang, Yang & Zhou 2005).

    a: (n) cycles; Q: (n, n) cycles^2. Returns a dict: `candidates` (count, n), the best first; their `squared_norms`; `ratio`, the second over
    the first; `success_rate`, a lower bound if Q is right.

    >>> found = integer_least_squares([5.1, 2.9], [[0.04, 0.03], [0.03, 0.04]])
    >>> found["candidates"][0].astype(int).tolist()
    [5, 3]
    """
    return _coast.integer_least_squares(np.asarray(a, dtype=float), np.asarray(Q, dtype=float), count)


def single_points(observations, navigation, elevation_mask=10.0):
    """Positions of one receiver from its codes, epoch by epoch, to some metres.

    observations: file of observations (RINEX or a receiver's own); navigation: file or files of broadcast messages; elevation_mask: deg. Returns an
    xarray.Dataset over `time` (GPS): `r_e` (ECEF, m), `sd_e`, `clock` (receiver ahead of GPS time, s), `satellites`; NaN where there is no
    solution. Least squares with one clock per system, contradicting satellites left out (Teunissen 2000); GPS, Galileo, BeiDou, QZSS.

    >>> found = single_points(recording / "rover.obs", recording / "brdc.nav")
    >>> bool(np.abs(found.r_e[-1] - found.r_e[-2]).max() < 20.0)          # m: a car, a fraction of a second later
    True
    """
    import xarray

    a = _coast.single_points(observations, _files(navigation), np.radians(elevation_mask))
    return xarray.Dataset(
        {
            "r_e": (("time", "ecef"), a["r_e"], {"units": "m", "long_name": "position of the antenna, Earth-centred, Earth-fixed"}),
            "sd_e": (("time", "ecef"), a["sd_e"], {"units": "m"}),
            "clock": ("time", a["clock"], {"units": "s"}),
            "satellites": ("time", a["satellites"]),
        },
        coords={"time": GPS_EPOCH + a["time_ns"].astype("timedelta64[ns]"), "ecef": ["x", "y", "z"]},
    )


def double_differences(rover, base, navigation, base_position, elevation_mask=10.0):
    """Double differences of codes and phases between rover and base, against the highest satellite of each system and band.

    rover, base: files of observations; navigation: file or files; base_position: (3) ECEF, m; elevation_mask: deg. Returns a dict of columns, a
    row for each epoch, satellite and band: `time`, `satellite`, `reference`, `band`, `code` and `phase` (m, NaN where missing), `wavelength` (m),
    `arc` and `reference_arc`: new numbers mean new ambiguities. The base's ranges are those of base_position, so what is left are the rover's
    ranges, double-differenced, and ambiguities. pandas.DataFrame takes it as it is.

    >>> base_position = [4365683.1024, 503817.0518, 4607565.0345]
    >>> rows = double_differences(recording / "rover.obs", recording / "base.obs", recording / "brdc.nav", base_position)
    >>> one = (rows["satellite"] == "G02") & (rows["band"] == "1")
    >>> bool(np.nanstd((rows["phase"] - rows["code"])[one]) < 5.0)         # m: an ambiguity, and the noise of codes
    True
    """
    a = _coast.double_differences(rover, base, _files(navigation), np.asarray(base_position, dtype=float), np.radians(elevation_mask))
    time = GPS_EPOCH + a.pop("time_ns").astype("timedelta64[ns]")
    return {"time": time, **{name: np.asarray(column) for name, column in a.items()}}


def _files(given):
    return [given] if isinstance(given, (str, os.PathLike)) else list(given)


def strapdown(r_eb_e, v_eb_e, C_b_e, dtheta, dv, dt):
    """Strapdown navigation in the e-frame from increments, without a filter.

    r_eb_e: (3) m; v_eb_e: (3) m/s; C_b_e: (3, 3); dtheta, dv: (n, 3) integrals of rate and specific force over the intervals, rad and m/s, body
    axes; dt: s, one number or (n). Coning and sculling by the two-sample algorithm (Savage 1998), gravity of the ellipsoid. Returns positions
    (n + 1, 3), velocities (n + 1, 3) and attitudes (n + 1, 3, 3), the first those given.

    >>> r = [6378137.0, 0.0, 0.0]                       # on the equator, at rest; the body's z axis points down
    >>> C = [[0, 0, -1], [0, 1, 0], [1, 0, 0]]
    >>> earth, g = 7.292115e-5, 9.7803253359            # rad/s about north, the body's x axis; m/s^2
    >>> dtheta, dv = np.tile([0.01 * earth, 0, 0], (6000, 1)), np.tile([0, 0, -0.01 * g], (6000, 1))
    >>> positions, velocities, attitudes = strapdown(r, [0, 0, 0], C, dtheta, dv, 0.01)
    >>> bool(np.abs(positions[-1] - r).max() < 1e-3)    # m, after a minute
    True
    """
    r, v, C = _coast.strapdown(_motion(r_eb_e, v_eb_e, C_b_e, dtheta, dv, dt))
    return r, v, C.reshape(-1, 3, 3)


def error_state_transition(r_eb_e, v_eb_e, C_b_e, dtheta, dv, dt, error_model):
    """How errors of position, velocity and attitude at the end of some intervals follow from the errors at their start.

    Arguments as those of `strapdown`; error_model: an IMU error model in body axes, as a file or a dict. Returns a dict: `states`, their names: the nine of
    navigation and those of the sensors; `Phi` (9, states); `Q` (9, 9), what the white noise of the sensors adds. Errors are estimate minus truth,
    those of attitude psi in C_b_e(estimate) = (I + [psi x]) C_b_e; those of a sensor its estimated error minus the true one. Intervals of 0.05 s
    are folded to second order: Groves (2013) eq. (14.49).

    >>> r, C = [6378137.0, 0.0, 0.0], [[0, 0, -1], [0, 1, 0], [1, 0, 0]]
    >>> rest = np.tile([0, 0, -0.01 * 9.7803253359], (100, 1))
    >>> bias = {"process": "random_constant", "sigma": 1e-4}
    >>> model = {"schema": "coast.imu_error_model/1", "sensor": "biases", "gyro": {"all": [{**bias, "unit": "rad/s"}]},
    ...          "accel": {"all": [{**bias, "unit": "m/s^2"}]}}
    >>> found = error_state_transition(r, [0, 0, 0], C, np.zeros((100, 3)), rest, 0.01, model)
    >>> len(found["states"]), round(float(found["Phi"][0, 3]), 3)        # velocity to position, after a second
    (15, 1.0)
    """
    return _coast.error_state_transition(_motion(r_eb_e, v_eb_e, C_b_e, dtheta, dv, dt), error_model)


def _motion(r_eb_e, v_eb_e, C_b_e, dtheta, dv, dt):
    dtheta = np.asarray(dtheta, dtype=float)
    dt = np.broadcast_to(np.asarray(dt, dtype=float), (len(dtheta),))
    start = (np.asarray(given, dtype=float) for given in (r_eb_e, v_eb_e, C_b_e))
    return _coast.Motion(*start, dtheta, np.asarray(dv, dtype=float), dt)
