"""Figs. 1 to 3: what the estimators make of signals that are known, and whether their estimates give the Allan curves back."""

from parts import axis, curve_of, load, named, panel, panel_of, percent, pieces_of, section, sig, table

# coast's names and those of Fig. 1, in the paper's order
FIGURE_1 = {"gauss_markov beta": "beta, 1/s", "gauss_markov sigma2": "sigma2 GM", "random_walk density2": "sigma2 RW",
            "white_noise density": "sigma2 WN", "slope": "omega, 1/s"}
EM, DEFAULT, WITHOUT_WALK = "EM", "default", "default without RW"
SHOWN = {EM: "EM, 500 iterations", DEFAULT: "coast", WITHOUT_WALK: "coast, no RW"}
MIDDLE_S = (30.0, 600.0)  # averaging times of Fig. 2 about the correlation time, 125 s

FIGURE_3 = {"gauss_markov beta 1": "beta 1, 1/s", "gauss_markov beta 2": "beta 2, 1/s",
            "gauss_markov sigma2 1": "sigma2 GM 1, (m/s^2)^2", "gauss_markov sigma2 2": "sigma2 GM 2, (m/s^2)^2",
            "white_noise density": "sigma2 WN, (m/s^2)^2 per sample"}
DT_S = 0.01  # of Fig. 3
LONG_TERM_S = 3.0  # averaging times of Fig. 3 from which on the GM processes show beside the white noise


def rows_of_shown(plot, title):
    """The boxes of SHOWN alone, in rows from the top."""
    names = [name for name in SHOWN if any(box["label"] == name for box in plot["boxes"])]
    boxes = []
    for row, name in enumerate(names):
        found = named(plot["boxes"], title, label=name)
        boxes.append({**found, "label": SHOWN[name], "boxes": [[-row, *found["boxes"][0][1:]]]})
    ticks = [[-row, SHOWN[name]] for row, name in enumerate(names)]
    bound = [{**interval, "label": ""} for interval in plot.get("intervals", [])]
    return {"title": title, "x": plot["x"], "y": axis("", ticks=ticks, limits=(0.4 - len(names), 0.6)), "boxes": boxes,
            "intervals": bound, "lines": [named(plot["lines"], title, label="truth")], "height_px": 190}


def row_of_parameter(study, name):
    """A row of the table of Fig. 1, and the numbers in it."""
    row, numbers = [FIGURE_1[name]], {}
    for estimator in SHOWN:
        parameters = named(study["estimators"], "figure-1", name=estimator)["parameters"]
        found = next((p for p in parameters if p["name"] == name), None)
        if found is None:
            row += ["not estimated", "-"]
            continue
        if estimator == EM:
            row += [sig(found["truth"]), sig(found["cramer_rao_sd"])]
        row += [sig(found["mean"]), f"{found['bias_to_bound']:+.2f}"]
        if estimator == EM:
            row += [f"{sig(found['q05'])} to {sig(found['q95'])}"]
        numbers[estimator] = {key: found[key] for key in ("mean", "sd", "q05", "q95", "bias_to_bound", "sd_to_bound", "cramer_rao_sd")}
    return row, numbers


def summary_1(numbers):
    beta, walk = numbers["gauss_markov beta"], numbers["random_walk density2"][EM]
    return [
        ["1", "beta of the GM process, 0.008 /s", "biased (drawn, no number)",
         ", ".join(f"{label} {sig(beta[name]['mean'])} ({beta[name]['bias_to_bound']:+.2f} bounds)" for name, label in SHOWN.items()),
         "A walk that is free to move takes from the GM process: at the top of the likelihood beta is biased. EM's walk has hardly moved "
         "from its start by 500 iterations, and its beta is hardly biased; nor is it without a walk. The paper took the drift off "
         "before; here level and drift are estimated beside the processes."],
        ["1", "sigma2 of the RW, 1e-8 per step", "biased (drawn, no number)",
         f"EM {sig(walk['mean'])} ({sig(walk['q05'])} to {sig(walk['q95'])})",
         f"6000 samples know it to {sig(walk['cramer_rao_sd'])}: it cannot be seen. EM stands where 500 iterations bring it from its "
         "start, 1e-10."]]


def figure_1(out):
    folder = f"{out}/figure-1"
    study = load(folder, "estimator_study.json")
    plots = [rows_of_shown(named(panel_of(folder, "estimates")["plots"], folder, title=name), title) for name, title in FIGURE_1.items()]
    rows, numbers = [], {}
    for name in FIGURE_1:
        row, numbers[name] = row_of_parameter(study, name)
        rows.append(row)
    lead = (f"Paper: simulated. Here: simulated, the same: {study['runs']} records of 6000 samples at 1 s from the same theta, EM from the "
            "same theta0. Beside it coast's default, restricted maximum likelihood, with the random walk and without.")
    tables = [table("fig-1-table", "True values and estimates",
                    "Bound: Cramer-Rao standard deviation of an unbiased estimate. Biases are in bounds. The paper prints no numbers of "
                    "Fig. 1; it says: biased, specially beta and the strength of the RW.",
                    ["parameter", "true#", "bound#", "EM, mean#", "bias#", "EM, 5 to 95 %", "coast, mean#", "bias#", "no RW, mean#",
                     "bias#"], rows)]
    panels = [panel("fig-1-boxes", f"Fig. 1: estimates of {study['runs']} runs",
                    "Boxes hold half of the runs, whiskers nine tenths; the line is the truth, the shaded stretch one Cramer-Rao standard "
                    "deviation about it. The paper's figure has the top row, EM, of each parameter.", plots, 2)]
    part = section("fig-1", f"Fig. 1: {study['runs']} runs of EM", lead, tables, panels)
    return {"section": part, "summary": summary_1(numbers), "numbers": {"figure_1": numbers}}


def share_above(plot, low_s, high_s):
    """Share of the realisations' deviations above the record's, averaging times from low_s to high_s."""
    record = dict(zip(*curve_of(plot, "record")))
    above = [deviation > record[tau] for x, y in pieces_of(plot, "realisations") for tau, deviation in zip(x, y)
             if low_s <= tau <= high_s and tau in record]
    return sum(above) / len(above)


def share_inside(plot, from_s=0.0):
    """Share of the averaging times at which the record lies among its realisations."""
    drawn = {}
    for x, y in pieces_of(plot, "realisations"):
        for tau, deviation in zip(x, y):
            drawn.setdefault(tau, []).append(deviation)
    inside = [min(drawn[tau]) <= deviation <= max(drawn[tau]) for tau, deviation in zip(*curve_of(plot, "record"))
              if tau in drawn and tau >= from_s]
    return sum(inside) / len(inside)


def figure_2(out):
    plots = panel_of(f"{out}/figure-1", "restitution")["plots"]
    above = [share_above(plot, *MIDDLE_S) for plot in plots]
    inside = [share_inside(plot) for plot in plots]
    lead = ("Paper: simulated, three of the 200 runs, chosen at random. Here: simulated, the first three; the thick curve is the record, "
            "the thin ones 20 realisations of what EM made of it.")
    rows = [["overbound in the middle part", "systematic (words)", ", ".join(percent(share) for share in above),
             f"of the realisations lie above the record at {MIDDLE_S[0]:g} to {MIDDLE_S[1]:g} s; without bias near 50 %, systematically "
             "near 100 %"],
            ["record among its realisations", "tight (words)", ", ".join(percent(share) for share in inside), "of the averaging times"]]
    part = section("fig-2", "Fig. 2: restitution of Allan curves", lead,
                   [table("fig-2-table", "Record against realisations, runs 1, 2, 3", "", ["what", "paper", "here", "meaning"], rows)],
                   [panel("fig-2-allan", "Fig. 2: records and 20 realisations of EM's estimates",
                          "Good: the record among its realisations. The paper's realisations lie above the records in the middle.",
                          [{**plot, "height_px": 280} for plot in plots], 3)])
    summary = [["2", "realisations above the record, middle part", "systematically", ", ".join(percent(share) for share in above),
                "Estimates that are hardly biased do not overbound. Three records are three draws, and neighbouring averaging times go "
                "together."]]
    return {"section": part, "summary": summary, "numbers": {"figure_2": {"share_above": above, "share_inside": inside}}}


def in_paper_units(name, value):
    """White noise as variance per sample."""
    return value / DT_S if name == "white_noise density" else value


def row_of_three_hours(default, by_em, name):
    """A row of the table of Fig. 3, and the numbers in it."""
    found = named(default["parameters"], "figure-3", name=name)
    first = default["by_run"]["values"][name][0]
    em = {e["name"]: named(e["parameters"], "figure-3-em", name=name)["mean"] for e in by_em}
    row = [FIGURE_3[name], sig(in_paper_units(name, found["truth"])), f"{sig(100.0 * found['cramer_rao_sd'] / found['truth'])} %",
           sig(in_paper_units(name, first)), ", ".join(sig(in_paper_units(name, found[q])) for q in ("q05", "median", "q95")),
           *(sig(in_paper_units(name, value)) for value in em.values())]
    return row, {"first": first, **{q: found[q] for q in ("q05", "median", "q95")}, **em}


def summary_3(rows, runs, inside, short):
    return [
        ["3", "sigma2 WN, (m/s^2)^2 per sample", "3.6e-5", rows["white_noise density"][3],
         "As in the paper, the left part of the curve is fitted by all."],
        ["3", "GM processes: beta 1, beta 2, 1/s", "4e-4, 0.10",
         f"{rows['gauss_markov beta 1'][4]}; {rows['gauss_markov beta 2'][4]} (5 %, median, 95 % of {runs} records)",
         "Three hours are 4.3 correlation times of the slow one: they know its order of magnitude. What one record gives is one draw."],
        ["3", "long-term part of the curve", "matched only approximately",
         f"record among 100 realisations from {LONG_TERM_S:g} s on: EM at {percent(inside['em'])} of averaging times, coast at "
         f"{percent(inside['coast'])}; EM from two starts ends {' and '.join(sig(s, 2) for s in short.values())} of log-likelihood short",
         "As the paper says, EM crawls where WN rules: where it ends depends on where it began. coast's search ends at the top."]]


def panels_3(ours, theirs, readings):
    return [
        panel("fig-3-allan", "Fig. 3: the record and 100 realisations of its estimate",
              "Left by EM, right by coast's default; one record, 100 realisations each, thin. Good: the record among them.",
              [{**theirs, "height_px": 340}, {**ours, "height_px": 340}], 2),
        {**readings, "id": "fig-3-readings", "title": "Three readings of the paper's numbers",
         "caption": "In theory, nothing drawn at random. The paper drives its GM processes with var w = 2 beta sigma2, with dt (Table I) "
                    "or without (sections II.B, II.E); neither keeps sigma2 the stationary variance, which is the truth of Fig. 3 here."}]


def figure_3(out):
    study, em = load(f"{out}/figure-3", "estimator_study.json"), load(f"{out}/figure-3-em", "estimator_study.json")
    default = named(study["estimators"], "figure-3", name="default")
    by_em = [e for e in em["estimators"] if e["kind"] == "em"]
    rows, numbers = {}, {}
    for name in FIGURE_3:
        rows[name], numbers[name] = row_of_three_hours(default, by_em, name)
    short = {e["name"]: e["log_likelihood_shortfall"]["largest"] for e in by_em}
    ours = {**panel_of(f"{out}/figure-3", "restitution")["plots"][0], "title": "coast"}
    theirs = {**panel_of(f"{out}/figure-3-em", "restitution")["plots"][0], "title": by_em[0]["name"]}
    inside = {"coast": share_inside(ours, LONG_TERM_S), "em": share_inside(theirs, LONG_TERM_S)}
    numbers.update(log_likelihood_short=short, share_inside=inside)
    lead = ("Paper: real, three hours at 100 Hz of the y accelerometer of an IMAR-FSAS at rest. Here: simulated, as long, drawn from the "
            "paper's estimate; that recording is not at hand. The paper does not say where EM began: two starts here.")
    tables = [table("fig-3-table", "Estimates",
                    f"The paper's estimate is the truth of these records. Spread over {study['runs']} records; the other columns are of the "
                    "first, EM's too.",
                    ["parameter", "paper's estimate#", "bound#", "coast, first#", "coast, 5 %, median, 95 %",
                     *(f"{e['name']}#" for e in by_em)], list(rows.values()))]
    part = section("fig-3", "Fig. 3: two GM processes and WN in three hours", lead, tables,
                   panels_3(ours, theirs, panel_of(f"{out}/figure-3", "reading-allan")))
    return {"section": part, "summary": summary_3(rows, study["runs"], inside, short), "numbers": {"figure_3": numbers}}
