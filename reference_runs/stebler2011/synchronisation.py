"""Fig. 8: when the samples of an array were taken, by packets that come when they come and by pulses."""

import csv
from bisect import bisect_left

from packets import FIRST_S
from parts import axis, curve_of, line, load, named, panel, panel_of, quantile, section, table

MASTER, SLAVES = "MTi-G", ["MTx-1", "MTx-2", "MTx-3"]
DRAWN = SLAVES[0]
WINDOW_S = (100.0, 120.0)  # of the mission, drawn
LEAST_MS = 1e-4  # drawn of errors that are smaller: the axis is logarithmic

LEAD = (
    "Paper: real, an MTi-G and an MTx logged on a computer. Here: simulated. Sampling, clocks and signals by `coast simulate`; "
    "arrivals by packets.py: a delay of 2 to 5.5 ms that a device's packets share, an exponential of 1 ms, and a computer that is "
    "busy every 2 s for 15 ms on average. In hardware mode a pulse restarts the sampling every second; between pulses each quartz "
    "runs by itself (-18 to 30 ppm). `coast synth` reads the packets in both modes.")


def truth_of(folder, name):
    """True time, and arrival in GPS time, of every sample, seconds of week."""
    with open(f"{folder}/{name}_truth.csv", encoding="utf-8", newline="") as file:
        rows = [(float(row["true_s"]), float(row["arrival_s"])) for row in csv.DictReader(file)]
    return [row[0] for row in rows], [row[1] for row in rows]


class Synchronised:
    """What `coast synth` made of the packets of one mode."""

    def __init__(self, out, mode):
        self.folder = f"{out}/figure-8-{mode}"
        self.packets = f"{out}/packets-{mode}"
        self.result = load(self.folder, "synth.json")
        self.names = [imu["name"] for imu in self.result["imus"]]
        self.intervals = panel_of(self.folder, "intervals")["plots"]

    def clock(self, name):
        """Times of samples by the clock that was found (of those that its page keeps), and the intervals before them, ms."""
        t, intervals = curve_of(self.intervals[self.names.index(name)], "clock")
        start = self.result["grid"]["start_s"]
        return [start + x for x in t], intervals

    def clock_errors(self, name):
        """True time, and time by the clock less true time, s. Errors are below half an interval: the nearest sample is meant."""
        true_s, _ = truth_of(self.packets, name)
        errors = []
        for t in self.clock(name)[0]:
            at = bisect_left(true_s, t)
            nearest = min(true_s[max(at - 1, 0):at + 1], key=lambda s, t=t: abs(s - t))
            errors.append((nearest, t - nearest))
        return errors

    def arrival_errors(self, name):
        """True time, and arrival less true time, s, the shortest delay taken off."""
        true_s, arrival_s = truth_of(self.packets, name)
        least = min(a - t for t, a in zip(true_s, arrival_s))
        return [(t, a - t - least) for t, a in zip(true_s, arrival_s)]

    def lag(self, name):
        return named(self.result["imus"], self.folder, name=name)["lag"]


def in_window(pairs, start):
    """Seconds of the mission and values, of the window."""
    kept = [(t - start, value) for t, value in pairs if WINDOW_S[0] <= t - start < WINDOW_S[1]]
    return [t for t, _ in kept], [value for _, value in kept]


def interval_plots(software, hardware, start):
    def arrivals(name):
        true_s, arrival_s = truth_of(software.packets, name)
        return [(t, 1e3 * (b - a)) for t, a, b in zip(true_s[1:], arrival_s, arrival_s[1:])]

    rows = [("Software mode: between arrivals", arrivals),
            ("Software mode: by the clocks that coast finds in the arrivals", lambda name: zip(*software.clock(name))),
            ("Hardware mode: by the pulses", lambda name: zip(*hardware.clock(name)))]
    plots = []
    for title, of in rows:
        lines = [line(name, *in_window(of(name), start), tone, width_px=1.2) for name, tone in ((DRAWN, "y"), (MASTER, "x"))]
        plots.append({"title": title, "x": axis("time", "s"), "y": axis("interval", "ms", limits=(-2.0, 42.0)), "lines": lines,
                      "height_px": 150, "link": "fig-8"})
    return plots


def timing_plot(software, hardware, start):
    def curve(label, errors, tone, taken_off=0.0, width_px=2.0):
        t, values = in_window(errors, start)
        return line(label, t, [max(1e3 * abs(value - taken_off), LEAST_MS) for value in values], tone, width_px=width_px)

    clock = software.clock_errors(DRAWN)
    lag = software.lag(DRAWN)["offset_s"]
    return {"x": axis("time", "s"), "y": axis("error of a time tag", "ms", "log"), "link": "fig-8", "height_px": 300, "lines": [
        curve("arrival, shortest delay taken off", software.arrival_errors(DRAWN), "faint", width_px=1.0),
        curve("clock from arrivals", clock, "y"),
        curve("clock from arrivals, lag by the signals taken off", clock, "z", lag),
        curve("clock from pulses", hardware.clock_errors(DRAWN), "x")]}


def numbers_of(software, hardware, name):
    arrival = [error for _, error in software.arrival_errors(name)]
    clock = [error for _, error in software.clock_errors(name)]
    middle, lag = quantile(clock, 0.5), software.lag(name)
    return {"arrival_max_s": max(arrival), "arrival_share_above_10ms": sum(a > 0.01 for a in arrival) / len(arrival),
            "clock_s": middle, "clock_spread_s": max(abs(error - middle) for error in clock),
            "lag_s": lag["offset_s"], "lag_sigma_s": lag["offset_sigma_s"], "after_lag_s": middle - lag["offset_s"],
            "pulses_max_s": max(abs(error) for _, error in hardware.clock_errors(name))}


def error_table(numbers):
    rows = []
    for name, n in numbers.items():
        rows.append([name, f"{1e3 * n['arrival_max_s']:.1f}", f"{100.0 * n['arrival_share_above_10ms']:.2f}",
                     f"{1e3 * n['clock_s']:.3f}", f"{1e3 * n['clock_spread_s']:.3f}",
                     f"{1e3 * n['lag_s']:.2f} +- {1e3 * n['lag_sigma_s']:.2f}", f"{1e3 * n['after_lag_s']:+.2f}",
                     f"{1e3 * n['pulses_max_s']:.3f}"])
    return table("fig-8-table", "Error of the time tags of the slaves, ms",
                 "Against the simulated truth. The clock is the lower edge of the arrivals; a delay that all packets of a device "
                 "share, beyond the master's, stays in it, and the signals tell it: what happened at t is tagged t + lag.",
                 ["device", "arrival, largest#", "above 10 ms, %#", "clock#", "its spread#", "lag by the signals#",
                  "left after lag#", "pulses, largest#"], rows)


def summary(numbers):
    def extreme(which, key):
        return 1e3 * which(n[key] for n in numbers.values())

    share = max(n["arrival_share_above_10ms"] for n in numbers.values())
    left = 1e3 * max(abs(n["after_lag_s"]) for n in numbers.values())
    return [
        ["8", "timing error, software mode", "can be above 10 ms",
         f"arrivals as tags: up to {extreme(max, 'arrival_max_s'):.0f} ms, {100.0 * share:.1f} % above 10 ms; clock from them: "
         f"{extreme(min, 'clock_s'):.1f} to {extreme(max, 'clock_s'):.1f} ms; lag by the signals taken off: {left:.1f} ms at most",
         "How late packets come is assumed here. What comes late does not move the lower edge of the arrivals; the delay that all "
         "packets share does, and the signals tell it."],
        ["8", "timing error, hardware mode", "below 1 ms", f"{extreme(max, 'pulses_max_s'):.3f} ms at most",
         "A quartz of 30 ppm runs by itself for a second. Delays of cable and trigger are not simulated."]]


def figure_8(out):
    software, hardware = Synchronised(out, "software"), Synchronised(out, "hardware")
    start = round(truth_of(software.packets, MASTER)[0][0]) - FIRST_S
    numbers = {name: numbers_of(software, hardware, name) for name in SLAVES}
    panels = [panel("fig-8-intervals", "Fig. 8: sampling intervals",
                    "20 s of the drive. The paper has two panels: the software mode above, the hardware mode below.",
                    interval_plots(software, hardware, start)),
              panel("fig-8-errors", f"Fig. 8, beside it: error of the time tags of {DRAWN}",
                    "Good: below 1 ms. So is the clock from arrivals once the signals have told how late all its packets are.",
                    [timing_plot(software, hardware, start)])]
    part = section("fig-8", "Fig. 8: sampling intervals in software and hardware synchronisation", LEAD, [error_table(numbers)], panels)
    return {"section": part, "summary": summary(numbers), "numbers": {"figure_8": numbers}}
