#!/usr/bin/env python3
"""One page of the paper's figures beside ours, and all our numbers.

  page.py OUT    OUT: where `command` left its jobs; writes OUT/report.json (a page for `coast report`), OUT/stebler2011.json (the
                 numbers) and OUT/table.md (the table of README.md)
"""

import json
import sys

import calibration
import merging
import outages
import synchronisation
from parts import section, table

FIGURES = [calibration.figure_1, calibration.figure_2, calibration.figure_3, lambda out: outages.figure(out, 4),
           lambda out: outages.figure(out, 5), synchronisation.figure_8, merging.figure_10, merging.figure_11]
COLUMNS = ["fig.", "what", "paper", "here", "why they differ"]
LEAD = (
    "Y. Stebler, S. Guerrier, J. Skaloud and M.-P. Victoria-Feser, Improving Modeling of MEMS-IMUs Operating in GNSS-denied Conditions, "
    "ION GNSS 2011: its figures 1, 2, 3, 4, 5, 8, 10 and 11 again. Figs. 1 and 2 are of simulated signals there and here. The others are "
    "of real sensors there, whose recordings are not at hand; here they are simulated, with sensors that err as the paper found and with "
    "known truth: nothing on this page is a recording. The paper prints few numbers, and the text that was read has no axes of its "
    "figures: what stands in words there stands in words here.")


def tile(label, value, unit, explanation, where):
    return {"label": label, "value": value, "unit": unit, "explanation": explanation, "section": where}


def tiles(numbers):
    beta = numbers["figure_1"]["gauss_markov beta"]["default without RW"]["bias_to_bound"]
    stationary, section2e = numbers["figure_5"]["stationary"], numbers["figure_5"]["section2e"]
    pulses = max(device["pulses_max_s"] for device in numbers["figure_8"].values())
    mse = {name: merge["mse"] for name, merge in numbers["figure_10"].items()}
    return [
        tile("Fig. 1: bias of beta without a walk", f"{beta:+.2f}", "bounds",
             "Mean of the runs less the truth, in Cramer-Rao standard deviations. The paper's estimates are biased.", "fig-1"),
        tile("Fig. 5: EM over traditional, 130 s", f"{stationary['forward_horizontal']['em_over_traditional']:.2f}", "",
             f"Largest horizontal error, forward; by section II.E {section2e['forward_horizontal']['em_over_traditional']:.2f}, smoothed "
             f"{section2e['smoothed_horizontal']['em_over_traditional']:.2f}. The paper's one gap: a half to a quarter.", "fig-5"),
        tile("Fig. 8: error in hardware mode", f"{1e3 * pulses:.3f}", "ms", "Largest of three devices. The paper: below 1 ms.", "fig-8"),
        tile("Fig. 10: CS-IMU over S-IMU", f"{(mse['corrected by errors'] / mse['mean']) ** 0.5:.2f}", "",
             f"Noise, with models from a reference; from residuals {(mse['corrected'] / mse['mean']) ** 0.5:.2f}. The paper: 0.91.",
             "fig-10")]


def markdown(rows):
    lines = [COLUMNS, ["---"] * len(COLUMNS), *rows]
    return "".join("| " + " | ".join(cells) + " |\n" for cells in lines)


def main(out):
    found = [figure(out) for figure in FIGURES]
    rows = [row for part in found for row in part["summary"]]
    numbers = {key: value for part in found for key, value in part["numbers"].items()}
    first = section("summary", "Paper, ours, and why they differ", LEAD, [table("summary-table", "", "", COLUMNS, rows)], [])
    page = {"schema": "coast.page/1", "title": "Stebler et al. (2011) again", "subtitle": "Eight figures of the paper, from runs of coast",
            "tiles": tiles(numbers), "sections": [first, *(part["section"] for part in found)],
            "footer": "coast, reference_runs/stebler2011"}
    for name, text in (("report.json", json.dumps(page)), ("stebler2011.json", json.dumps(numbers)), ("table.md", markdown(rows))):
        with open(f"{out}/{name}", "w", encoding="utf-8") as file:
            file.write(text)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])
