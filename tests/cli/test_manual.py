"""The manual pages and completions that a build writes, read by the programs that they are written for: groff, bash and zsh."""

import os
import re
import subprocess
import unittest

PROGRAM = os.environ["COAST_PROGRAM"]
MANUAL = os.environ["COAST_MANUAL"]


def output(*command):
    """What a program says; warnings on standard error are failures."""
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    if done.stderr:
        raise AssertionError(done.stderr)
    return done.stdout


def subcommands():
    listed = output(PROGRAM, "--help").split("Subcommands:\n")[1]
    return re.findall(r"^  ([a-z]+)  ", listed, re.MULTILINE)


def options(*words):
    return set(re.findall(r"--[a-z-]+", output(PROGRAM, *words, "--help").split("Example")[0]))


def rendered(page):
    return output("groff", "-man", "-Tascii", "-P-cbou", "-ww", os.path.join(MANUAL, "man", page + ".1"))


def bash(*words):
    """What bash offers for the last of the words."""
    script = f"""source {MANUAL}/completions/coast
COMP_WORDS=({" ".join(f"'{word}'" for word in words)}) COMP_CWORD={len(words) - 1}
_coast
printf '%s\\n' "${{COMPREPLY[@]}}" """
    return output("bash", "-c", script).split()


def zsh(*words):
    """What the completion of zsh tells its library about the subcommand."""
    script = f"""_describe() {{ print -rl -- ${{(P)2}} }}
_arguments() {{ print -rl -- "$@" }}
words=({" ".join(f"'{word}'" for word in words)}) CURRENT={len(words)}
source {MANUAL}/completions/_coast"""
    return output("zsh", "-f", "-c", script).splitlines()


class Pages(unittest.TestCase):
    def test_each_subcommand_has_a_page_with_all_its_options(self):
        for name in subcommands():
            page = rendered("coast-" + name)
            for option in options(name) | {"--help"}:
                self.assertIn(option, page, name)

    def test_the_program_has_a_page_with_all_its_subcommands(self):
        page = rendered("coast")
        for name in subcommands():
            self.assertRegex(page, rf"(?m)^ +{name}( |$)")
        self.assertIn("EXIT STATUS", page)

    def test_examples_stand_as_they_are_typed(self):
        page = rendered("coast-process")
        self.assertIn("columns: {time: 1, gyro: [2, 3, 4], accel: [5, 6, 7]}", page)
        self.assertIn("coast process run.yaml --out results", page)


class Completions(unittest.TestCase):
    def test_bash_offers_subcommands_and_their_options(self):
        self.assertEqual(bash("coast", "dia"), ["diagnose"])
        self.assertEqual(set(bash("coast", "")) - {"--help", "-h", "--version"}, set(subcommands()))
        for name in subcommands():
            self.assertEqual(set(bash("coast", name, "--")), options(name) | {"--help"}, name)

    def test_bash_offers_what_may_stand_behind_an_option(self):
        self.assertEqual(bash("coast", "convert", "a.nav", "b", "--to", "g"), ["gpx", "geojson", "grid", "gpkg"])
        self.assertEqual(bash("coast", "process", "--threads", ""), [])
        self.assertIn("/usr", bash("coast", "process", "--out", "/us"))

    def test_zsh_is_told_subcommands_and_their_options(self):
        self.assertEqual({line.split(":")[0] for line in zsh("coast", "")}, set(subcommands()))
        for name in subcommands():
            told = zsh("coast", name, "")
            self.assertEqual({option for line in told for option in re.findall(r"^(--[a-z-]+)\[", line)}, options(name) | {"--help"})
        self.assertTrue(any(line.startswith("--out[") and line.endswith(":_files -/") for line in zsh("coast", "process", "")))


if __name__ == "__main__":
    unittest.main()
