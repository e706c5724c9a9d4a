"""Numbers in memory where a configuration expects a file."""

import numpy as np


class Table:
    """Named columns of numbers, in place of a file in the dict of a configuration.

    >>> coast.process({"imu": {"file": coast.Table(imu_frame), "gps_week": 2374, ...}, "gnss": {"file": coast.Table(fixes), ...}})

    Without `columns` in the configuration they are named as in coast's own CSV files: time_s, gyro_x_radps .. accel_z_mps2
    of an IMU, time_s, lat_deg, lon_deg, height_m, sdn_m, sde_m, sdd_m of positions; units, axes and times are stated by the
    same keys as those of a file. Values are copied once, as float64; columns of text or dates are left out. A
    variable of two dimensions is a vector: `dtheta` over `sensor_axis` x, y, z is the columns dtheta_x, dtheta_y, dtheta_z.
    """

    coast_table = True

    def __init__(self, data, name="table in memory"):
        """`data`: a pandas.DataFrame, an xarray.Dataset, a dict of arrays, or a numpy structured array."""
        self.name = name
        self.columns = {}
        for key in _names(data):
            values = np.asarray(data[key])
            if values.dtype.kind not in "biuf":
                continue
            if values.ndim == 0 or values.ndim > 2:
                raise ValueError(f"{name}: {key} has {values.ndim} dimensions, a column has one, columns of a vector two")
            for column, part in zip(_columns(key, data[key], values), np.atleast_2d(values.T)):
                self.columns[column] = np.ascontiguousarray(part, dtype=np.float64)

    def __len__(self):
        return len(next(iter(self.columns.values()), ()))

    def __repr__(self):
        return f"<coast.Table {self.name!r}: {len(self)} rows of {', '.join(self.columns)}>"


def _columns(key, given, values):
    """Names of the columns of a variable: its own, or of a vector with the labels of its second dimension, else numbers from 0."""
    if values.ndim == 1:
        return [str(key)]
    labels = given[given.dims[1]].values if hasattr(given, "dims") else range(values.shape[1])
    return [f"{key}_{label}" for label in labels]


def _names(data):
    if getattr(getattr(data, "dtype", None), "names", None):
        return data.dtype.names
    if hasattr(data, "data_vars"):
        return [*data.coords, *data.data_vars]
    return list(data.keys())
