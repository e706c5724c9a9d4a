"""coast.blocks: the examples in their docstrings, and each against something that it shares no code with."""

import doctest
import functools
import itertools
import pathlib
import tempfile
import unittest

import numpy as np
import yaml

import coast
from coast import blocks

ROOT = pathlib.Path(__file__).resolve().parents[2]


def cross(a):
    return np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])


KEEP = tempfile.TemporaryDirectory()


@functools.cache
def recording():
    """Simulated RINEX of rover and base, a few hundred metres apart."""
    coast.simulate(ROOT / "configs/scenarios/car_rinex.yaml", out=pathlib.Path(KEEP.name) / "recording")
    return pathlib.Path(KEEP.name) / "recording"


def tearDownModule():
    KEEP.cleanup()


class Examples(unittest.TestCase):
    def test_do_what_they_say(self):
        failed, tried = doctest.testmod(blocks, extraglobs={"recording": recording()})
        self.assertGreater(tried, 10)
        self.assertEqual(failed, 0)


class AgainstOthers(unittest.TestCase):
    def setUp(self):
        self.random = np.random.default_rng(7)

    def test_allan_deviation_is_that_of_its_definition(self):
        y = self.random.normal(size=2000)
        curve = blocks.allan(y, 0.5)
        total = np.concatenate([[0.0], np.cumsum(y)])
        for tau, value in zip(curve.tau.values, curve.allan.values):
            m = round(tau / 0.5)
            mean = (total[m:] - total[:-m]) / m
            self.assertAlmostEqual(value, np.sqrt(0.5 * np.mean((mean[m:] - mean[:-m]) ** 2)), delta=1e-12)
        self.assertTrue((curve.allan_low_95 < curve.allan).all() and (curve.allan < curve.allan_high_95).all())

    def test_likelihood_is_the_dense_one(self):
        dt, sigma2, beta, density = 0.2, 0.5, 0.8, 0.06
        lag = dt * np.abs(np.subtract.outer(np.arange(60), np.arange(60)))
        V = sigma2 * np.exp(-beta * lag) + density / dt * np.eye(60)
        y = np.linalg.cholesky(V) @ self.random.normal(size=60) + 3.0
        W, X = np.linalg.inv(V), np.ones((60, 1))
        information = (X.T @ W @ X).item()
        residual = y - (X.T @ W @ y).item() / information
        restricted = -0.5 * (59 * np.log(2 * np.pi) + np.linalg.slogdet(V)[1] + residual @ W @ residual + np.log(information / 60))
        given = blocks.sum_log_likelihood(y, dt, [("white_noise", [density]), ("gauss_markov", [beta, sigma2])])
        self.assertAlmostEqual(given, restricted, delta=1e-8 * abs(restricted))

    def test_autoregression_is_that_of_least_squares(self):
        y = np.empty(4000)
        y[0] = 0.0
        for t, e in enumerate(self.random.normal(size=3999), 1):
            y[t] = 0.3 + 0.7 * y[t - 1] + e
        fit = blocks.arma_garch(y, (1, 0, 0, 0))
        X = np.column_stack([np.ones(3999), y[:-1]])
        nu, alpha = np.linalg.lstsq(X, y[1:], rcond=None)[0]
        self.assertTrue(fit["converged"])
        self.assertAlmostEqual(fit["value"]["alpha1"], alpha, delta=2e-3)  # the first sample counts here: 1/n
        self.assertAlmostEqual(fit["value"]["nu"], nu, delta=5e-3)
        self.assertAlmostEqual(fit["variance"][100], fit["value"]["gamma0"])

    def test_integers_are_the_nearest_of_all(self):
        for _ in range(20):
            A = self.random.normal(size=(3, 3))
            Q, a = A @ A.T + 0.05 * np.eye(3), self.random.uniform(-2, 2, 3)
            W = np.linalg.inv(Q)
            near = [np.array(z) for z in itertools.product(range(-12, 13), repeat=3)]
            norms = np.array([(a - z) @ W @ (a - z) for z in near])
            found = blocks.integer_least_squares(a, Q)
            np.testing.assert_array_equal(found["candidates"][0], near[norms.argmin()])
            np.testing.assert_allclose(found["squared_norms"], np.sort(norms)[:2], rtol=1e-9)

    def test_single_points_are_where_the_antenna_is(self):
        found = blocks.single_points(recording() / "rover.obs", recording() / "brdc.nav")
        rows = [line.split() for line in (recording() / "gnss.pos").read_text().splitlines() if not line.startswith("%")]
        lat, lon, h = (np.array([float(row[k]) for row in rows]) for k in (2, 3, 4))
        times = np.array([f"{row[0].replace('/', '-')}T{row[1]}" for row in rows], dtype="datetime64[ns]")
        common, ours, theirs = np.intersect1d(found.time.values.astype("datetime64[ms]"), times.astype("datetime64[ms]"), return_indices=True)
        self.assertGreater(len(common), 100)
        a, e2 = 6378137.0, 0.00669437999014
        lat, lon = np.radians(lat), np.radians(lon)
        N = a / np.sqrt(1 - e2 * np.sin(lat) ** 2)
        truth = np.column_stack([(N + h) * np.cos(lat) * np.cos(lon), (N + h) * np.cos(lat) * np.sin(lon), (N * (1 - e2) + h) * np.sin(lat)])
        error = found.r_e.values[ours] - truth[theirs]
        self.assertLess(np.sqrt(np.nanmean(np.sum(error**2, axis=1))), 5.0)  # m: codes of some decimetres, atmosphere by models

    def test_carrier_phase_positions_are_as_written(self):
        out = pathlib.Path(KEEP.name) / "solved"
        positions = coast.ppk(recording() / "run-rinex.yaml", out=out).positions
        rows = [line.split() for line in (out / "ppk.pos").read_text().splitlines() if not line.startswith("%")]
        self.assertEqual(len(rows), positions.sizes["time"])
        np.testing.assert_array_equal(positions.quality, [int(row[5]) for row in rows])
        np.testing.assert_array_equal(positions.satellites, [int(row[6]) for row in rows])
        np.testing.assert_allclose(positions.position_sd.sel(axis="north"), [float(row[7]) for row in rows], atol=6e-5)
        self.assertGreater(float((positions.quality == 1).mean()), 0.5)

    def test_double_differences_of_two_bands_differ_by_ambiguities(self):
        base = [4365683.1024, 503817.0518, 4607565.0345]
        rows = blocks.double_differences(recording() / "rover.obs", recording() / "base.obs", recording() / "brdc.nav", base)
        spread = []
        for satellite in np.unique(rows["satellite"]):
            first, fifth = ((rows["satellite"] == satellite) & (rows["band"] == band) for band in "15")
            times, i, k = np.intersect1d(rows["time"][first], rows["time"][fifth], return_indices=True)
            arcs = [rows[name][of][at] for name in ("arc", "reference_arc", "reference") for of, at in ((first, i), (fifth, k))]
            whole = np.ones(len(times), dtype=bool)
            for column in arcs:
                whole &= column == column[0]
            free = (rows["phase"][first][i] - rows["phase"][fifth][k])[whole]
            if len(free) > 50:
                spread.append(np.nanstd(free))
        self.assertGreaterEqual(len(spread), 3)
        self.assertLess(max(spread), 0.03)  # m: phases of some millimetres, eight of them, and what the ionosphere leaves over 3 km

    def test_strapdown_follows_what_was_simulated(self):
        scenario = yaml.safe_load((ROOT / "configs/scenarios/car_roundabout.yaml").read_text())
        scenario["trajectory"]["duration_s"] = 360
        scenario.pop("outages", None)
        noise = {sensor: {"all": [{"process": "white_noise", "density": 1e-12, "unit": unit}]}
                 for sensor, unit in (("gyro", "rad/s/sqrt(Hz)"), ("accel", "m/s^2/sqrt(Hz)"))}
        with tempfile.NamedTemporaryFile("w", suffix=".yaml") as model:
            yaml.safe_dump({"schema": "coast.imu_error_model/1", "sensor": "of no errors", **noise}, model)
            model.flush()
            scenario["imu"]["error_model"] = model.name
            simulated = coast.simulate(scenario, seed=1, folder=ROOT / "configs/scenarios")
        imu = simulated.imu.isel(time=slice(6000, 18000))  # two minutes on the move
        truth = simulated.truth.isel(time=slice(6000, 18001))
        r, v, C = blocks.strapdown(truth.r_eb_e[0], truth.v_eb_e[0], truth.C_b_e[0], imu.dtheta, imu.dv, imu.dt)
        self.assertLess(np.abs(r - truth.r_eb_e.values).max(), 1e-3)  # m in two minutes
        np.testing.assert_allclose(C, truth.C_b_e.values, atol=1e-6)

    def test_strapdown_turns_as_told(self):
        dtheta = np.tile([0.0, 0.0, 0.01], (100, 1))
        _, _, C = blocks.strapdown([6378137.0, 0.0, 0.0], [0, 0, 0], np.eye(3), dtheta, np.zeros((100, 3)), 0.01)
        earth = 7.292115e-5  # about the same axis
        angle = 1.0 - earth
        turned = [[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]]
        np.testing.assert_allclose(C[-1], turned, atol=1e-10)

    def test_transition_is_that_of_differences(self):
        n, dt = 200, 0.01
        time = dt * np.arange(n)[:, None]
        dtheta = dt * np.sin(time * [[1.0, 1.7, 0.6]]) * [[0.2, 0.1, 0.4]]
        dv = dt * (np.cos(time * [[0.9, 0.4, 1.3]]) * [[2.0, 1.0, 0.5]] + [[0.0, 0.0, -9.8]])
        r, v, C = np.array([4.2e6, 5.0e5, 4.7e6]), np.array([3.0, -12.0, 5.0]), np.linalg.qr(self.random.normal(size=(3, 3)))[0]
        C *= np.linalg.det(C)
        model = {"schema": "coast.imu_error_model/1", "sensor": "biases", **{
            sensor: {"all": [{"process": "white_noise", "density": 1e-3, "unit": f"{unit}/sqrt(Hz)"},
                             {"process": "random_constant", "sigma": 1e-3, "unit": unit}]} for sensor, unit in (("gyro", "rad/s"), ("accel", "m/s^2"))}}
        found = blocks.error_state_transition(r, v, C, dtheta, dv, dt, model)

        def end(x):
            """Errors at the end, of errors x at the start."""
            turn = np.eye(3) + cross(x[6:9])
            ends = blocks.strapdown(r + x[0:3], v + x[3:6], turn @ C, dtheta - dt * x[9:12], dv - dt * x[12:15], dt)
            return [part[-1] for part in ends]

        r1, v1, C1 = end(np.zeros(15))
        steps = np.repeat([1.0, 1e-2, 1e-5, 1e-5, 1e-3], 3)
        numeric = np.empty((9, 15))
        for k, step in enumerate(steps):
            plus, minus = (end(sign * step * np.eye(15)[k]) for sign in (1.0, -1.0))
            D = (plus[2] - minus[2]) @ C1.T
            psi = 0.5 * np.array([D[2, 1] - D[1, 2], D[0, 2] - D[2, 0], D[1, 0] - D[0, 1]])
            numeric[:, k] = np.concatenate([plus[0] - minus[0], plus[1] - minus[1], psi]) / (2 * step)
        self.assertEqual(len(found["states"]), 15)
        scale = np.abs(numeric).max(axis=1, keepdims=True)
        np.testing.assert_allclose(found["Phi"] / scale, numeric / scale, atol=2e-3)  # folds of 0.05 s, second order
        np.testing.assert_allclose(found["Q"], found["Q"].T, atol=1e-18)
        np.testing.assert_allclose(np.diag(found["Q"])[6:], 1e-6 * n * dt, rtol=1e-3)  # attitude: a random walk

    def test_refusals_say_what_is_wrong(self):
        for refused in (lambda: blocks.allan([1.0, np.nan], 0.1), lambda: blocks.sum_log_likelihood([1.0, 2.0], 0.1, [("white", [1.0])]),
                        lambda: blocks.sum_log_likelihood([1.0, 2.0], 0.1, [("gauss_markov", [1.0])]),
                        lambda: blocks.strapdown([0, 0, 0], [0, 0, 0], np.eye(3), np.zeros((3, 3)), np.zeros((2, 3)), 0.1)):
            with self.assertRaises(ValueError):
                refused()


if __name__ == "__main__":
    unittest.main()
