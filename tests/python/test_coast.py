"""The Python package, against the program: the same files to the byte, the same numbers to the bit."""

import functools
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import warnings

import numpy as np
import yaml

import coast

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = os.environ["COAST_PROGRAM"]


def read_table(file):
    return np.genfromtxt(file, delimiter=",", names=True, comments=None)


def read_positions(file):
    """RTKLIB's .pos as columns of coast's CSV."""
    rows = [line.split() for line in pathlib.Path(file).read_text().splitlines() if not line.startswith("%")]
    dates = np.array([f"{row[0].replace('/', '-')}T{row[1]}" for row in rows], dtype="datetime64[ns]")
    values = np.array([[float(field) for field in row[2:]] for row in rows])
    columns = {"time_s": (dates - np.datetime64("1980-01-06", "ns")).astype(np.int64) % 604_800_000_000_000 / 1e9}
    names = ["lat_deg", "lon_deg", "height_m", "quality", "satellites", "sdn_m", "sde_m", "sdd_m"]
    columns.update({name: values[:, k] for k, name in enumerate(names)})
    for k, axis in enumerate("ned"):
        columns[f"v{axis}_mps"] = values[:, 13 + k] * (-1.0 if axis == "d" else 1.0)
        columns[f"sdv{axis}_mps"] = values[:, 16 + k]
    return columns


KEEP = tempfile.TemporaryDirectory()


@functools.cache
def recorded():
    """A simulated recording, and what the program makes of it: folder and scenario."""
    folder = pathlib.Path(KEEP.name)
    scenario = yaml.safe_load((ROOT / "configs/scenarios/car_roundabout.yaml").read_text())
    scenario["trajectory"]["duration_s"] = 360
    scenario["outages"] = [{"elapsed_s": 250, "duration_s": 20}]
    coast.simulate(scenario, seed=5, out=folder / "recording", folder=ROOT / "configs/scenarios")
    subprocess.run([PROGRAM, "process", folder / "recording/run.yaml", "--out", folder / "by-program", "--quiet"], check=True)
    return folder, scenario


def tearDownModule():
    KEEP.cleanup()


class Recorded(unittest.TestCase):
    def setUp(self):
        self.folder, self.scenario = recorded()
        self.run_yaml = self.folder / "recording/run.yaml"

    def run_dict(self):
        return yaml.safe_load(self.run_yaml.read_text())

    def assert_same_files(self, first, second, names):
        for name in names:
            self.assertEqual((first / name).read_bytes(), (second / name).read_bytes(), name)


class Process(Recorded):
    def test_writes_what_the_program_writes(self):
        result = coast.process(self.run_yaml, out=self.folder / "by-python")
        names = [n for n in result.files if not n.startswith("report.")]  # reports tell the folder
        self.assertGreaterEqual(len(names), 5)
        self.assert_same_files(self.folder / "by-python", self.folder / "by-program", names)
        self.assertEqual(result.summary, json.loads((self.folder / "by-program/summary.json").read_text()))

    def test_arrays_are_the_files_numbers(self):
        result = coast.process(self.run_yaml)
        table = read_table(self.folder / "by-program/trajectory.csv")
        t = result.trajectory
        self.assertEqual(t.sizes["time"], len(table))
        # Half a unit of the last digit of the file.
        np.testing.assert_allclose(t.latitude, table["lat_deg"], rtol=0, atol=0.51e-11)
        np.testing.assert_allclose(t.height, table["height_m"], rtol=0, atol=0.51e-5)
        np.testing.assert_allclose(t.velocity[:, 2], table["vd_mps"], rtol=0, atol=0.51e-6)
        np.testing.assert_allclose(t.attitude[:, 1], table["pitch_deg"], rtol=0, atol=0.51e-9)
        np.testing.assert_allclose(t.attitude_sd[:, 0], table["sd_roll_deg"], rtol=0, atol=0.51e-8)
        ns = (t.time.values - np.datetime64("1980-01-06", "ns")).astype(np.int64)
        np.testing.assert_array_equal(ns // 604_800_000_000_000, table["gps_week"])
        self.assertEqual(t.velocity.attrs["units"], "m/s")
        self.assertEqual(result.innovations.used.sum() + result.summary["gnss"]["rejected"], result.innovations.sizes["time"])
        self.assertEqual(len(result.outages), 1)
        self.assertIn("gyro", " ".join(result.states.data_vars))
        self.assertGreater(result.states.sizes["seconds"], 100)

    def test_arrays_in_memory_give_the_same_bits(self):
        stated = self.run_dict()
        recording = self.folder / "recording"
        stated["imu"]["file"] = coast.Table(read_table(recording / stated["imu"]["file"]), "imu")
        stated["gnss"]["file"] = coast.Table(read_positions(recording / stated["gnss"]["file"]), "gnss")
        stated["gnss"]["gps_week"] = np.int64(self.scenario["start_gps"]["week"])
        stated["gnss"]["use_velocity"] = np.True_
        stated.pop("reference", None)
        from_memory = coast.process(stated, folder=self.folder / "recording")
        plain = self.run_dict()
        plain.pop("reference", None)
        from_files = coast.process(plain, folder=self.folder / "recording")
        for name in from_files.trajectory.variables:
            np.testing.assert_array_equal(from_memory.trajectory[name], from_files.trajectory[name], name)

    def test_shows_itself(self):
        result = coast.process(self.run_yaml)
        self.assertEqual(result.verdict, "good")
        self.assertTrue(repr(result).startswith("verdict: good"), repr(result))
        self.assertTrue(result.page.startswith("<!doctype html>") or result.page.startswith("<!DOCTYPE html>"))
        self.assertIn("srcdoc", result._repr_html_())
        self.assertTrue(any("IMU" in line for line in result.inspection), result.inspection)
        self.assertIn("error_model", yaml.safe_load(result.resolved)["imu"])

    def test_tells_progress(self):
        seen = []
        coast.process(self.run_yaml, progress=lambda stage, fraction: seen.append((stage, fraction)))
        self.assertTrue(seen)
        self.assertTrue(all(0.0 <= fraction <= 1.0 for _, fraction in seen))

    def test_an_exception_of_the_listener_ends_the_job(self):
        def fail(stage, fraction):
            raise LookupError("enough")

        with self.assertRaises(LookupError):
            coast.process(self.run_yaml, progress=fail)

    def test_warns_of_what_is_unusable(self):
        stated = self.run_dict()
        stated["imu"]["lever_arm_m"] = [20.0, 0.0, 0.0]
        stated["imu"]["lever_arm_sd_m"] = 0.0
        stated["imu"]["noise"] = "stated"
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            result = coast.process(stated, folder=self.folder / "recording")
        self.assertEqual(result.verdict, "unusable")
        self.assertEqual([w.category for w in caught], [coast.UnusableResult])


class BadInput(Recorded):
    def test_names_file_line_and_what_to_do(self):
        file = self.folder / "recording/misspelt.yaml"
        file.write_text(self.run_yaml.read_text().replace("lever_arm_m", "lever_arms_m"))
        with self.assertRaises(coast.InputError) as raised:
            coast.process(file)
        error = raised.exception
        self.assertIsInstance(error, ValueError)
        self.assertEqual(error.file, str(file))
        self.assertGreater(error.line, 0)
        self.assertIn("lever_arm_m", str(error))

    def test_what_was_simulated_is_processed_without_files(self):
        drive = coast.simulate(self.scenario, seed=5, folder=ROOT / "configs/scenarios")
        result = coast.process({
            "imu": {"file": coast.Table(drive.imu), "gps_week": drive.imu.gps_week, "values": "increments",
                    "error_model": str(self.folder / "recording/error_model.yaml"), "lever_arm_m": [0.3, -0.2, -1.1],
                    "columns": {"time": "sow", "gyro": ["dtheta_x", "dtheta_y", "dtheta_z"], "accel": ["dv_x", "dv_y", "dv_z"]}},
            "gnss": {"file": coast.Table(drive.gnss), "gps_week": drive.gnss.gps_week, "frame": "ecef",
                     "columns": {"time": "sow", "position": ["r_ea_e_x", "r_ea_e_y", "r_ea_e_z"],
                                 "sd": ["position_sd_north", "position_sd_east", "position_sd_down"]}},
        })
        self.assertEqual(result.verdict, "good")
        truth = drive.truth.sel(time=result.trajectory.time, method="nearest")
        self.assertLess(float(np.abs(result.trajectory.height - truth.height.values).max()), 0.1)  # m: sigma 0.02 m at each fix

    def test_a_file_for_another_job_is_named(self):
        for scenario in (ROOT / "configs/scenarios/car_roundabout.yaml", self.scenario):
            with self.assertRaisesRegex(coast.InputError, "coast simulate"):
                coast.process(scenario)
            with self.assertRaisesRegex(coast.InputError, "coast simulate"):
                coast.diagnose(scenario)

    def test_names_the_key_of_a_dict(self):
        stated = self.run_dict()
        stated["imu"]["lever_arm_m"] = [0.0, 1.0]
        with self.assertRaisesRegex(coast.InputError, "imu.lever_arm_m"):
            coast.process(stated, folder=self.folder / "recording")

    def test_names_the_row_of_a_table(self):
        stated = self.run_dict()
        imu = read_table(self.folder / "recording" / stated["imu"]["file"])
        imu["gyro_x_radps"][7] = 1e9
        stated["imu"]["file"] = coast.Table(imu, "my frame")
        with self.assertRaisesRegex(coast.InputError, "my frame:8: "):
            coast.process(stated, folder=self.folder / "recording")

    def test_refuses_tables_that_are_none(self):
        stated = self.run_dict()
        with self.assertRaisesRegex(ValueError, "dimensions"):
            coast.Table({"time_s": [[[1.0, 2.0]]]})
        for columns, told in (
            ({"time_s": np.empty(0)}, "no row"),
            ({"time_s": [1.0], "lat_deg": [1.0, 2.0]}, "equal lengths"),
            ({"t": [1.0]}, "time_s"),
            ({"time_s": ["monday"]}, "no row"),
        ):
            stated["gnss"]["file"] = coast.Table(columns)
            with self.assertRaisesRegex(coast.InputError, told):
                coast.process(stated, folder=self.folder / "recording")

    def test_no_results_over_somebody_elses_files(self):
        folder = self.folder / "own"
        folder.mkdir()
        (folder / "summary.json").write_text("mine")
        with self.assertRaises(coast.CoastError):
            coast.process(self.run_yaml, out=folder)
        self.assertEqual((folder / "summary.json").read_text(), "mine")


class Beside(Recorded):
    """The interpreter goes on while a job runs."""

    def test_other_threads_run(self):
        beats, done = [], threading.Event()

        def count():
            while not done.wait(0.01):
                beats.append(time.monotonic())

        counter = threading.Thread(target=count)
        counter.start()
        begin = time.monotonic()
        coast.process(self.run_yaml, progress=False)
        seconds = time.monotonic() - begin
        done.set()
        counter.join()
        self.assertGreater(len(beats), 2.0 * seconds)  # of a hundred a second; with the lock held there is none

    def test_interrupt_ends_a_job_and_leaves_nothing(self):
        out = self.folder / "interrupted"
        program = (
            "import coast, sys\n"
            "def told(stage, fraction):\n"
            "    print(stage, flush=True)\n"
            f"coast.diagnose({str(self.run_yaml)!r}, out={str(out)!r}, progress=told)\n"
        )
        process = subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        process.stdout.readline()
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=60)
        self.assertIn("KeyboardInterrupt", errors)
        self.assertEqual([file.name for file in out.iterdir() if not file.name.startswith(".")], [])


class OtherJobs(Recorded):
    def test_diagnose(self):
        result = coast.diagnose(self.run_yaml, quick=True)
        self.assertIn("effects", result.summary)

    def test_calibrate_a_table(self):
        rng = np.random.default_rng(1)
        n, rate, density = 20_000, 100.0, 1e-4
        data = {"time_s": np.arange(1, n + 1) / rate}
        for sensor, unit, level in (("gyro", "radps", 0.0), ("accel", "mps2", 9.8)):
            for axis in "xyz":
                data[f"{sensor}_{axis}_{unit}"] = (level if axis == "z" else 0.0) + density * np.sqrt(rate) * rng.standard_normal(n)
        result = coast.calibrate({"records": [{"file": coast.Table(data)}], "axes": ["gyro_x"], "processes": {"gyro": {"sum": ["white_noise"]}}})
        text = json.dumps(result.summary)
        self.assertIn("white_noise", text)

    def test_compare(self):
        same = self.folder / "by-program/trajectory.csv"
        self.assertEqual(coast.compare(same, same).summary["position_rms_m"], [0.0, 0.0, 0.0])

    def test_inspect(self):
        self.assertIn("Hz", coast.inspect(self.folder / "recording/imu.csv", gps_week=1570))


if __name__ == "__main__":
    unittest.main()
