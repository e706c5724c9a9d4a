"""Numbers in memory where a configuration expects a file."""

import numpy as np


class Table:
    """Named columns of numbers, in place of a file in the dict of a configuration.

    >>> coast.process({"imu": {"file": coast.Table(imu_frame), "gps_week": 2374, ...}, "gnss": {"file": coast.Table(fixes), ...}})

    Without `columns` in the configuration they are named as in coast's own CSV files: time_s, gyro_x_radps .. accel_z_mps2
    of an IMU, time_s, lat_deg, lon_deg, height_m, sdn_m, sde_m, sdd_m of positions; units, axes and times are stated by the
    same keys as those of a file. Values are copied once, as float64; columns of text or dates are left out.
    """

    coast_table = True

    def __init__(self, data, name="table in memory"):
        """`data`: a pandas.DataFrame, an xarray.Dataset, a dict of arrays, or a numpy structured array."""
        self.name = name
        self.columns = {}
        for key in _names(data):
            column = np.asarray(data[key])
            if column.dtype.kind not in "biuf":
                continue
            if column.ndim != 1:
                raise ValueError(f"{name}: {key} has {column.ndim} dimensions, a column has one")
            self.columns[str(key)] = np.ascontiguousarray(column, dtype=np.float64)

    def __len__(self):
        return len(next(iter(self.columns.values()), ()))

    def __repr__(self):
        return f"<coast.Table {self.name!r}: {len(self)} rows of {', '.join(self.columns)}>"


def _names(data):
    if getattr(getattr(data, "dtype", None), "names", None):
        return data.dtype.names
    if hasattr(data, "data_vars"):
        return [*data.coords, *data.data_vars]
    return list(data.keys())
