"""Figs. 10 and 11: four IMUs merged into one, and the variance that GARCH tracks."""

from parts import axis, curve_of, line, load, named, panel, panel_of, percent, quantile, section, sig, table

# coast's names and those of Fig. 10
BOXES = {"single 1": "device 1", "single 2": "device 2", "single 3": "device 3", "single 4": "device 4",
         "mean": "S-IMU, plain mean", "corrected": "CS-IMU, models from residuals",
         "corrected by errors": "CS-IMU, models from a reference"}
MERGES = {"mean": "S-IMU, plain mean", "weighted": "constant weights", "garch": "GARCH weights alone",
          "corrected": "CS-IMU, models from residuals, Eq. (11)", "corrected by errors": "CS-IMU, models from a reference",
          "oracle weights": "limit: true variances as weights", "oracle": "limit: true models"}
PAPER_MSE = {"mean": "4.8e-5", "corrected by errors": "4.0e-5"}  # section III.D; the root of their ratio is 0.91
PAPER_ROOT = {"mean": "1", "corrected by errors": "0.91"}
DRAWN_S = 12.0  # of the 30 s that the panel `tracking` holds

LEAD_10 = (
    "Paper: real, three MTx and an MTi-G on a moving platform, errors against an Airins INS. Here: simulated, 40 runs of 200 s of four "
    "gyros of 0.01 to 0.02 rad/s of noise, each ARMA(3,2)-GARCH(1,1) of its own, turning with 0.3 rad/s rms, errors against the truth. "
    "The paper took the errors y from its reference; a user without one has residuals against the mean, Eq. (11). Both are here.")
LEAD_11 = (
    "Paper: real, the MTi-G. Here: simulated, device 1 of four: the gyro of Fig. 10, and an accelerometer by the same kind of model with "
    "twice the figures, in m/s^2. These sensors are GARCH themselves, so that a GARCH model can be right; the variance of real sensors "
    "follows what moves them.")


def box_plot(folder, label, unit):
    source = panel_of(folder, "boxes")["plots"][0]
    names = [tick[1] for tick in source["y"]["ticks"]]
    if names != list(BOXES):
        raise SystemExit(f"{folder}: the boxes are of {names}, not of {list(BOXES)}")
    quantiles = [box[1:] for box in source["boxes"][0]["boxes"]]
    groups = (("devices", "muted", range(4)), ("S-IMU", "x", range(4, 5)), ("CS-IMU", "y", range(5, 7)))
    boxes = [{"label": group, "tone": tone, "boxes": [[-row, *quantiles[row]] for row in rows]} for group, tone, rows in groups]
    ticks = [[-row, BOXES[name]] for row, name in enumerate(names)]
    return {"x": axis(label, unit), "y": axis("", ticks=ticks, limits=(-6.6, 0.6)), "boxes": boxes, "height_px": 290}


def figure_10(out):
    folder = f"{out}/figure-10"
    case = load(folder, "array_study.json")["merges"]["cases"][0]
    mse = {name: named(case["merges"], folder, name=name)["mse"] for name in MERGES}
    root = {name: (value / mse["mean"]) ** 0.5 for name, value in mse.items()}
    rows = [[label, PAPER_MSE.get(name, "-"), PAPER_ROOT.get(name, "-"), sig(mse[name]), f"{root[name]:.3f}"]
            for name, label in MERGES.items()]
    tables = [table("fig-10-table", "Mean square error of the merged gyro",
                    "The paper: noise of 0.0070 rad/s for the S-IMU and of 0.0063 rad/s for the CS-IMU. Limits are what nobody "
                    "reaches: the true variance of every sample, the true models.",
                    ["merged", "paper, (rad/s)^2#", "root over S-IMU's#", "here, (rad/s)^2#", "root over S-IMU's#"], rows)]
    panels = [panel("fig-10-boxes", "Fig. 10: errors of the four devices and of what is merged",
                    "Gyro z of the first run. Boxes hold half, whiskers nine tenths.", [box_plot(folder, "error", "rad/s")])]
    summary = [
        ["10", "noise of the S-IMU", "0.0070 rad/s, 4.8e-5 (rad/s)^2", f"{mse['mean'] ** 0.5:.4f} rad/s, {sig(mse['mean'])} (rad/s)^2",
         "The simulated gyros were made to be of this size."],
        ["10", "noise of the CS-IMU over the S-IMU's", "0.91 (0.0063 rad/s)",
         f"with a reference {root['corrected by errors']:.2f}; from residuals {root['corrected']:.2f}; GARCH weights alone "
         f"{root['garch']:.2f}",
         "How much can be predicted is the sensors' own. A prediction from residuals gives back less than one from errors: a "
         "residual holds the other sensors' errors too."]]
    numbers = {name: {"mse": mse[name], "ratio_95": named(case["merges"], folder, name=name)["ratio_95"]} for name in MERGES}
    part = section("fig-10", "Fig. 10: four gyros, the S-IMU and the CS-IMU", LEAD_10, tables, panels)
    return {"section": part, "summary": summary, "numbers": {"figure_10": numbers}}


def tracking(folder, title, unit):
    """The plot; and of its samples, tracked over true standard deviation, and the share of residuals within 1.96 tracked ones."""
    source = panel_of(folder, "tracking")["plots"][0]
    _, residuals = curve_of(source, "residuals", "points")
    t, tracked = curve_of(source, "predicted")
    _, true = curve_of(source, "true")
    if not len(residuals) == len(tracked) == len(true):
        raise SystemExit(f"{folder}: the curves of the panel `tracking` are not of the same samples")
    ratio = [p / s for p, s in zip(tracked, true)]
    inside = sum(abs(r) <= 1.96 * p for r, p in zip(residuals, tracked)) / len(residuals)
    numbers = {"ratio_05": quantile(ratio, 0.05), "ratio_50": quantile(ratio, 0.5), "ratio_95": quantile(ratio, 0.95),
               "inside_95": inside}
    dots = {**named(source["points"], folder, label="residuals"), "tone": "x", "radius_px": 1.1}
    plot = {"title": title, "x": axis("time", "s", limits=(0.0, DRAWN_S)), "y": axis("residual", unit), "points": [dots],
            "lines": [line("true sd", t, true, "reference", width_px=2.2), line("GARCH sd", t, tracked, "y", width_px=1.4)],
            "height_px": 230, "link": "fig-11"}
    return plot, numbers


def figure_11(out):
    plots, numbers = [], {}
    for folder, title, unit in (("figure-10", "Gyro z", "rad/s"), ("figure-11", "Accelerometer x", "m/s^2")):
        plot, numbers[title] = tracking(f"{out}/{folder}", title, unit)
        plots.append(plot)
    rows = [[title, f"{n['ratio_50']:.3f}", f"{n['ratio_05']:.2f} to {n['ratio_95']:.2f}", f"{100.0 * n['inside_95']:.1f}"]
            for title, n in numbers.items()]
    tables = [table("fig-11-table", "The tracked standard deviation against the true one",
                    "Over 30 s. Good: ratios near 1; 95 % of residuals within 1.96.",
                    ["sensor", "tracked over true, median#", "5 to 95 %", "residuals within 1.96, %#"], rows)]
    panels = [panel("fig-11-tracking", "Fig. 11: residuals and tracked standard deviation",
                    f"What the ARMA model leaves of the errors, as dots; {DRAWN_S:g} s.", plots)]
    here = [f"{title}: {n['ratio_50']:.2f} of the true sd ({n['ratio_05']:.2f} to {n['ratio_95']:.2f}), {percent(n['inside_95'])} of "
            "residuals within 1.96" for title, n in numbers.items()]
    summary = [["11", "variance tracked by GARCH", "\"seems to be appropriate\" (by eye)", "; ".join(here),
                "Here the true variance is known, and is of the model's own kind."]]
    part = section("fig-11", "Fig. 11: residuals and the standard deviation that GARCH tracks", LEAD_11, tables, panels)
    return {"section": part, "summary": summary, "numbers": {"figure_11": numbers}}
