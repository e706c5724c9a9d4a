"""Figs. 4 and 5: the manufacturer's error model against EM's in a GNSS outage, for two readings of the paper's estimate."""

import csv

from parts import axis, distribution, line, load, named, panel, panel_of, percent, quantile, section, sig, table

AXES = ["n", "e", "d", "horizontal"]
SOLUTIONS = ["forward", "smoothed"]
READINGS = {"": "sigma2 stationary", "-section2e": "section II.E"}  # folders end so: figure-5, figure-5-section2e
TRADITIONAL, EM = "manufacturer", "EM"
# Fig. 5, m: largest difference with the traditional and with the new model (section II.E of the paper); Fig. 4 has words alone.
PAPER = {4: {}, 5: {"n": (23.0, 10.0), "e": (6.0, 1.2), "d": (16.0, 4.2)}}
WORDS = {4: {"n": "significantly less", "e": "not less", "d": "significantly less"}, 5: {}}
SCENE = {4: ("20 s in a roundabout", "car_roundabout.yaml"), 5: ("130 s on a straight road", "car_straight.yaml")}


def share_of(gains, least):
    return sum(gain >= least for gain in gains) / len(gains)


def largest_errors(folder):
    """(error model, solution, axis) to the largest error of each seed, m, by seed."""
    found = {}
    with open(f"{folder}/outages.csv", encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            for solution in SOLUTIONS:
                for name in AXES:
                    column = f"{solution}_horizontal_max_m" if name == "horizontal" else f"{solution}_max_{name}_m"
                    found.setdefault((row["error_model"], solution, name), []).append(float(row[column]))
    return found


class Study:
    """What `coast outage` found with the sensors and EM's filter by one reading."""

    def __init__(self, folder):
        self.folder = folder
        self.outage = load(folder, "outage.json")["outages"][0]
        self.largest = largest_errors(folder)
        self.seeds = len(self.largest[EM, "forward", "n"])

    def run(self, model, solution):
        return named(self.outage["runs"], self.folder, error_model=model)[solution]

    def rms(self, model, solution, name):
        return self.run(model, solution)["largest"][name]["rms_m"]

    def paired(self, solution, name):
        """EM over traditional."""
        return named(self.outage["paired"], self.folder, second=EM, solution=solution)[name]

    def gains(self, solution, name):
        """Traditional over EM, seed by seed."""
        pairs = zip(self.largest[TRADITIONAL, solution, name], self.largest[EM, solution, name])
        return [traditional / em for traditional, em in pairs]

    def numbers(self):
        result = {}
        for solution in SOLUTIONS:
            for name in AXES:
                paired = self.paired(solution, name)
                result[f"{solution}_{name}"] = {
                    "traditional_rms_m": self.rms(TRADITIONAL, solution, name), "em_rms_m": self.rms(EM, solution, name),
                    "em_over_traditional": paired["ratio"], "interval_95": paired["interval_95"],
                    "share_gain_2": share_of(self.gains(solution, name), 2.0)}
            for model, key in ((TRADITIONAL, "traditional"), (EM, "em")):
                result[f"{solution}_inside_95_{key}"] = self.run(model, solution)["share_inside_95"]
        return result


def ratio_text(paired):
    return f"{paired['ratio']:.3f} ({paired['interval_95'][0]:.3f} to {paired['interval_95'][1]:.3f})"


def paper_cell(number, name):
    if name not in PAPER[number]:
        return WORDS[number].get(name, "-")
    traditional, em = PAPER[number][name]
    return f"{traditional:g} to {em:g} m, {traditional / em:.1f} times"


def drift_table(number, studies):
    rows = [["paper, one gap, forward", *(paper_cell(number, name) for name in AXES)]]
    for reading, study in studies.items():
        for solution in SOLUTIONS:
            rows.append([f"{reading}, {solution}: rms",
                         *(f"{sig(study.rms(TRADITIONAL, solution, name))} to {sig(study.rms(EM, solution, name))} m" for name in AXES)])
            rows.append([f"{reading}, {solution}: EM over traditional", *(ratio_text(study.paired(solution, name)) for name in AXES)])
        rows.append([f"{reading}, forward: seeds in which EM is better by 2 or more",
                     *(percent(share_of(study.gains("forward", name), 2.0)) for name in AXES)])
    stationary = studies[READINGS[""]]
    for run in stationary.outage["runs"]:
        floor = run["error_model"]
        if floor not in (TRADITIONAL, EM):
            rows.append([f"floor: {floor}, forward: rms", *(f"{sig(stationary.rms(floor, 'forward', name))} m" for name in AXES)])
    return table(f"fig-{number}-table", "Largest error inside the outage, traditional model to EM's",
                 "Over the seeds. EM over traditional: geometric mean over the pairs with its 95 % interval; below 1 EM drifts less. A "
                 "floor is simulated with that noise alone and processed by a filter that knows it.",
                 ["", "N", "E", "D", "horizontal"], rows)


def honesty_table(number, studies):
    columns = [(reading, study, solution) for reading, study in studies.items() for solution in SOLUTIONS]
    rows = [[name, *(f"{100.0 * study.run(model, solution)['share_inside_95']:.1f}" for _, study, solution in columns)]
            for model, name in ((TRADITIONAL, "traditional"), (EM, "EM"))]
    return table(f"fig-{number}-honesty", "Errors inside the stated 95 %, %", "Good: 95. Below it the filter is too sure of itself.",
                 ["model", *(f"{reading}, {solution}#" for reading, _, solution in columns)], rows)


def error_panel(number, studies, solution):
    """N, E, D of the first seed in rows, a column for each reading."""
    columns = []
    for reading, study in studies.items():
        plots = panel_of(study.folder, "outage-1-truth-1-ned")["plots"]
        first = SOLUTIONS.index(solution)  # N, E, D in rows, forward left, smoothed right
        if len(plots) != 6 or plots[first].get("title") != solution:
            raise SystemExit(f"{study.folder}: the panel of N, E, D does not have forward and smoothed side by side")
        columns.append([{**plot, "title": "", "height_px": 150, "link": f"fig-{number}"} for plot in plots[first::2]])
        columns[-1][0]["title"] = reading
    plots = [plot for row in zip(*columns) for plot in row]
    for plot in plots:
        for curve, name, tone in zip(plot["lines"], ("traditional model", "EM's model"), ("x", "y")):
            curve.update(label=name, tone=tone)
    title = f"Fig. {number}: position errors through the outage, {solution}"
    caption = "One seed, the first: as the paper's gap it is one draw. Traditional model in full, EM's dashed, as there."
    if solution == "smoothed":
        title = "The same outage, smoothed"
        caption = "Not in the paper. Both sides of the gap are used: the errors are small at both ends."
    return panel(f"fig-{number}-{solution}", title, caption, plots, 2)


def distribution_panel(number, studies):
    plots = []
    for reading, study in studies.items():
        for name in AXES[:3]:
            lines = [distribution("traditional model", study.largest[TRADITIONAL, "forward", name], "x"),
                     distribution("EM's model", study.largest[EM, "forward", name], "y", style="dashed")]
            if name in PAPER[number]:
                traditional, em = PAPER[number][name]
                lines.append(line("paper, traditional", [traditional, traditional], [0.0, 100.0], "x", width_px=1.0))
                lines.append(line("paper, EM", [em, em], [0.0, 100.0], "y", width_px=1.0, style="dashed"))
            plots.append({"title": f"{name.upper()}, {reading}", "x": axis("largest error", "m", "log"), "y": axis("seeds", "%"),
                          "lines": lines, "height_px": 220})
    marked = " The upright lines are the paper's two errors." if PAPER[number] else ""
    return panel(f"fig-{number}-distribution", f"Fig. {number} asked many times: largest forward error over the seeds",
                 "Share of the seeds with a smaller largest error. Where the curves lie on each other the error model makes no "
                 "difference." + marked, plots, 3)


def ratios(study):
    return ", ".join(f"{study.paired('forward', name)['ratio']:.2f}" for name in AXES[:3])


def summary_4(stationary, section2e):
    chance = quantile(section2e.gains("forward", "n"), 0.95)
    return [["4", "N, E, D with EM's model over the traditional, forward", "less, not less, less (words)",
             f"stationary {ratios(stationary)}; II.E {ratios(section2e)}",
             "D is the accelerometers': it gains as far as their models differ. White gyro noise sets N and E and is the same in both "
             f"models; by II.E one gap of twenty has N better by {chance:.1f} or more all the same."]]


def summary_of_axis(name, readings):
    traditional, em = PAPER[5][name]
    values = [f"{label}: {sig(study.rms(TRADITIONAL, 'forward', name))} to {sig(study.rms(EM, 'forward', name))} m rms, so much gain in "
              f"{percent(share_of(study.gains('forward', name), traditional / em))} of seeds" for label, study in readings]
    reached = [percent(share_of(study.largest[TRADITIONAL, "forward", name], traditional)) for _, study in readings]
    why = {"n": "White gyro noise alone drifts as far, and no accelerometer model takes it away.",
           "e": "As N.",
           "d": f"Gyros do not reach D to first order: it is the accelerometers'. The traditional model drifts {traditional:g} m or more "
                f"in {reached[0]} of seeds by the stationary reading, in {reached[1]} by II.E."}
    return ["5", f"{name.upper()}, traditional to EM", f"{traditional:g} to {em:g} m, {traditional / em:.1f} times", "; ".join(values),
            why[name]]


def summary_5(stationary, section2e):
    def times(study, solution):
        return 1.0 / study.paired(solution, "horizontal")["ratio"]

    def in_all(study):
        least = [min(gains) for gains in zip(*(study.gains("forward", name) for name in AXES[:3]))]
        return percent(share_of(least, 2.0))

    readings = (("stationary", stationary), ("II.E", section2e))
    rows = [summary_of_axis(name, readings) for name in AXES[:3]]
    rows.append(["5", "factor 2 to 4 at the end of the gap", "2 to 4 times, forward",
                 f"horizontal, forward: stationary {times(stationary, 'forward'):.2f} times, II.E {times(section2e, 'forward'):.2f}; "
                 f"2 or more in N, E and D at once in {in_all(stationary)} and {in_all(section2e)} of seeds; smoothed: stationary "
                 f"{times(stationary, 'smoothed'):.2f} times, II.E {times(section2e, 'smoothed'):.1f}",
                 "One gap is one draw, and gyro noise is most of it. What a model of the accelerometers is worth shows once smoothing has "
                 "taken the gyros' drift off: much by II.E, little by the stationary reading."])
    return rows


def figure(out, number):
    studies = {reading: Study(f"{out}/figure-{number}{ending}") for ending, reading in READINGS.items()}
    stationary, section2e = studies.values()
    what, scenario = SCENE[number]
    lead = (f"Paper: real, one gap of one drive, against the trajectory without the gap. Here: simulated, {what} ({scenario}), "
            f"{stationary.seeds} seeds, both models on the same recordings, GNSS and IMU alone, against the truth. The sensors err as EM "
            "found, by either reading of its numbers: with sigma2 the stationary variance (GM of 20 and 10 ug), or driven as section "
            "II.E writes it (204 and 102 ug).")
    part = section(f"fig-{number}", f"Fig. {number}: {what} without GNSS", lead,
                   [drift_table(number, studies), honesty_table(number, studies)],
                   [error_panel(number, studies, "forward"), distribution_panel(number, studies),
                    error_panel(number, studies, "smoothed")])
    summary = summary_4 if number == 4 else summary_5
    return {"section": part, "summary": summary(stationary, section2e),
            "numbers": {f"figure_{number}": {"stationary": stationary.numbers(), "section2e": section2e.numbers()}}}
